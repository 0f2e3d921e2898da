//! The trace as a timing diagram, as a manual would print it.
//!
//! Coordinates are whole tenths of a pixel, so that the same trace is the same bytes on every machine. Widths of texts are
//! estimated from a font in which every letter is as wide as the next.

mod legend;
mod rows;
mod scale;
mod style;

use std::fmt::Write as _;

use super::Head;
use super::waves::{WaveKind, Waves};
use legend::Legend;
use scale::Scale;

/// Tenths of a pixel, in which everything here is counted.
type Tenths = i64;

/// Width of the whole drawing.
const WIDTH: Tenths = 13_200;
/// Room at every side.
const MARGIN: Tenths = 240;
/// Between the names and the waves.
const GAP: Tenths = 140;
/// Width of a letter of the names (11 px), and of the small texts (10 px).
const LETTER: Tenths = 67;
const SMALL_LETTER: Tenths = 61;

/// A number of tenths as pixels with one decimal.
fn px(tenths: Tenths) -> String {
    let sign = if tenths < 0 { "-" } else { "" };
    let digits = tenths.unsigned_abs();
    match digits % 10 {
        0 => format!("{sign}{}", digits / 10),
        tenth => format!("{sign}{}.{tenth}", digits / 10),
    }
}

/// A text as XML takes it; what XML cannot hold at all becomes the sign for it.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\n' | '\r' | '\t' => escaped.push(' '),
            letter if letter.is_control() || matches!(letter, '\u{FFFE}' | '\u{FFFF}') => escaped.push('\u{FFFD}'),
            letter => escaped.push(letter),
        }
    }
    escaped
}

/// A count of letters as a width.
fn width_of(text: &str, letter: Tenths) -> Tenths {
    i64::try_from(text.chars().count()).unwrap_or(i64::MAX / 1000) * letter
}

/// A text in lines of at most so many letters, broken between words.
fn wrapped(text: &str, letters: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= letters => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// The drawing while it grows.
struct Drawing {
    text: String,
    /// Where the next thing begins.
    y: Tenths,
    /// Left end of the waves.
    left: Tenths,
}

impl Drawing {
    fn line(&mut self, class: &str, from: (Tenths, Tenths), to: (Tenths, Tenths)) {
        let (x1, y1, x2, y2) = (px(from.0), px(from.1), px(to.0), px(to.1));
        let _ = writeln!(self.text, r#"<path class="{class}" d="M{x1} {y1}L{x2} {y2}"/>"#);
    }

    fn text(&mut self, class: &str, (x, y): (Tenths, Tenths), text: &str) {
        let _ = writeln!(self.text, r#"<text class="{class}" x="{}" y="{}">{}</text>"#, px(x), px(y), escaped(text));
    }

    fn rect(&mut self, class: &str, (x, y): (Tenths, Tenths), (width, height): (Tenths, Tenths), title: &str) {
        let place = format!(r#"x="{}" y="{}" width="{}" height="{}""#, px(x), px(y), px(width), px(height));
        let _ = if title.is_empty() {
            writeln!(self.text, r#"<rect class="{class}" {place}/>"#)
        } else {
            writeln!(self.text, r#"<rect class="{class}" {place}><title>{}</title></rect>"#, escaped(title))
        };
    }
}

/// The whole file.
pub(super) fn document(waves: &Waves, head: &Head) -> String {
    let names = waves.rows.iter().map(|wave| width_of(&rows::name(wave), LETTER)).max().unwrap_or(0);
    let beside = waves.rows.iter().filter(|wave| wave.kind != WaveKind::Alarm);
    let beside = beside.map(|wave| width_of(&wave.beside, SMALL_LETTER)).max().unwrap_or(0);
    let left = (MARGIN + names + 120 + beside + GAP).clamp(2400, WIDTH / 2);
    let scale = Scale::new(waves, left, WIDTH - MARGIN);
    let mut drawing = Drawing { text: String::new(), y: MARGIN, left };
    title(&mut drawing, head);
    let legend = Legend::new(waves);
    let top = drawing.y;
    drawing.y += legend.lane_height(&scale);
    let first_row = drawing.y;
    // Lines through all rows lie below the rows, but their lower end is known only now.
    let bottom = first_row + rows::height(waves);
    scale.draw_grid(&mut drawing, first_row, bottom);
    legend.draw_flags(&mut drawing, &scale, top, bottom);
    rows::draw(&mut drawing, waves, &scale);
    scale.draw_breaks(&mut drawing, first_row, bottom);
    drawing.y = bottom;
    scale.draw_axis(&mut drawing);
    legend.draw(&mut drawing, waves);
    let height = px(drawing.y + MARGIN - 60);
    let width = px(WIDTH);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" role=\"img\">\n<title>{}</title>\n{}<rect class=\"paper\" width=\"{width}\" height=\"{height}\"/>\n{}</svg>\n",
        escaped(&head.title),
        style::STYLE,
        drawing.text,
    )
}

fn title(drawing: &mut Drawing, head: &Head) {
    for line in wrapped(&head.title, 120) {
        drawing.y += 190;
        drawing.text("title", (MARGIN, drawing.y), &line);
    }
    let profile = head.profile.as_ref().map(|profile| format!(" \u{b7} profile {profile}")).unwrap_or_default();
    let machine = format!("machine {}{profile} \u{b7} cycle {} ms", head.machine, head.cycle_time.seconds() * 1e3);
    drawing.y += 190;
    drawing.text("small", (MARGIN, drawing.y), &machine);
    drawing.y += 160;
}

#[cfg(test)]
mod tests;
