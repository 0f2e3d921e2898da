//! The explanations beside the rows: notes as numbered flags, alarms with their texts, the colours.

use super::drawing::{Drawing, MARGIN, SMALL_LETTER, Tenths, WIDTH, px, width_of, wrapped};
use super::scale::Scale;
use crate::trace::By;
use crate::trace::waves::{WaveKind, Waves};

/// The size of a flag.
const FLAG: Tenths = 150;
/// The distance between lines.
const LINE: Tenths = 180;
/// The number of characters in a line of the legend.
const LETTERS: usize = 150;

/// The notes with their flags, and the alarms.
pub(super) struct Legend {
    notes: Vec<(u64, String)>,
    /// Name and text.
    alarms: Vec<(String, String)>,
}

impl Legend {
    pub(super) fn new(waves: &Waves) -> Self {
        let mut alarms: Vec<(String, String)> = waves
            .rows
            .iter()
            .filter(|wave| wave.kind == WaveKind::Alarm)
            .map(|wave| (wave.name.clone(), wave.beside.clone()))
            .collect();
        alarms.sort();
        alarms.dedup();
        Self { notes: waves.notes.clone(), alarms }
    }

    /// Height of the lane of the flags.
    pub(super) fn lane_height(&self, _: &Scale) -> Tenths {
        if self.notes.is_empty() { 40 } else { FLAG + 180 }
    }

    /// The position of each flag: above its time, moved aside if another flag is there.
    fn flags(&self, scale: &Scale) -> Vec<Tenths> {
        let pitch = FLAG + 20;
        let mut places: Vec<Tenths> = self.notes.iter().map(|(cycle, _)| scale.x(*cycle)).collect();
        let mut least = Tenths::MIN;
        for place in &mut places {
            *place = (*place).max(least);
            least = *place + pitch;
        }
        let mut most = scale.right();
        for place in places.iter_mut().rev() {
            *place = (*place).min(most);
            most = *place - pitch;
        }
        places
    }

    pub(super) fn draw_flags(&self, drawing: &mut Drawing, scale: &Scale, top: Tenths, bottom: Tenths) {
        let lane = top + FLAG + 20;
        for (index, ((cycle, text), place)) in self.notes.iter().zip(self.flags(scale)).enumerate() {
            let x = scale.x(*cycle);
            let pole = [(place, lane - 10), (x, lane + 110), (x, bottom)];
            let path: Vec<_> = pole.iter().map(|(x, y)| format!("{} {}", px(*x), px(*y))).collect();
            drawing.text.push_str(&format!("<path class=\"pole\" d=\"M{}\"/>\n", path.join("L")));
            drawing.rect("flag", (place - FLAG / 2, lane - FLAG - 10), (FLAG, FLAG), text);
            drawing.text("flag-text", (place, lane - 50), &(index + 1).to_string());
        }
    }

    pub(super) fn draw(&self, drawing: &mut Drawing, waves: &Waves) {
        self.draw_notes(drawing, waves);
        if !self.notes.is_empty() && !self.alarms.is_empty() {
            drawing.y += 60;
        }
        for (name, text) in &self.alarms {
            drawing.y += LINE;
            let number = name.strip_prefix("alarm ").unwrap_or(name);
            drawing.text("alarm-name right", (MARGIN + 820, drawing.y), number);
            paragraph(drawing, text);
        }
        colours(drawing, waves);
    }

    /// The notes with the numbers of their flags.
    pub(super) fn draw_notes(&self, drawing: &mut Drawing, waves: &Waves) {
        drawing.y += 60;
        for (index, (cycle, text)) in self.notes.iter().enumerate() {
            drawing.y += LINE;
            let y = drawing.y;
            drawing.rect("flag", (MARGIN, y - 120), (FLAG + 30, FLAG), "");
            drawing.text("flag-text", (MARGIN + 90, y - 10), &(index + 1).to_string());
            drawing.text("small right", (MARGIN + 820, y), &format!("{} s", waves.time(*cycle)));
            paragraph(drawing, text);
        }
    }
}

fn paragraph(drawing: &mut Drawing, text: &str) {
    for (index, line) in wrapped(text, LETTERS).iter().enumerate() {
        if index > 0 {
            drawing.y += LINE - 20;
        }
        drawing.text("words", (MARGIN + 960, drawing.y), line);
    }
}

fn colours(drawing: &mut Drawing, waves: &Waves) {
    let writes = |wanted: fn(By) -> bool| {
        waves
            .rows
            .iter()
            .any(|wave| wave.kind != WaveKind::Alarm && wave.changes.iter().any(|step| step.by.is_some_and(wanted)))
    };
    let known = [
        ("nck", "written by the NCK", writes(|by| by == By::Nck)),
        ("plc", "by the PLC or from outside", writes(|by| matches!(by, By::Plc | By::Outside | By::Force))),
        ("plant", "by cams and switches of the machine", writes(|by| by == By::Plant)),
        ("value", "value", waves.rows.iter().any(|wave| wave.kind == WaveKind::Value)),
    ];
    drawing.y += LINE + 80;
    let mut x = MARGIN;
    for (class, text, _) in known.iter().filter(|(.., is_there)| *is_there) {
        drawing.line(&format!("wave {class}"), (x, drawing.y - 40), (x + 240, drawing.y - 40));
        drawing.text("small", (x + 320, drawing.y), text);
        x += 320 + width_of(text, SMALL_LETTER) + 320;
        debug_assert!(x < WIDTH, "the colours must fit into one line");
    }
}
