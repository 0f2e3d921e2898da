//! Curves with one scale: a panel has a grid with values, the curves, and limits in both directions.

use super::drawing::{Drawing, MARGIN, SMALL_LETTER, Tenths, WIDTH, escaped, width_of};
use super::rows::{millionths, name, path};
use super::scale::{Scale, round_step};
use crate::trace::Limit;
use crate::trace::value::{decimals, millionths as in_millionths};
use crate::trace::waves::{Wave, Waves};

/// The left end of the curves: the values of the grid stand before it.
pub(super) const LEFT: Tenths = 1_400;
/// The height of a panel, and of the curves in it.
const PANEL: Tenths = 3_400;
const CURVES: Tenths = 3_200;
/// The minimum distance of two lines of the grid.
const LINES: Tenths = 360;
/// The classes of the curves, in turn.
const CLASSES: [&str; 4] = ["nck", "plc", "plant", "value"];

/// The height of all panels.
pub(super) fn height(panels: usize) -> Tenths {
    PANEL * i64::try_from(panels).unwrap_or(0)
}

/// The rows of each panel, with its limits.
fn of_panels<'a>(
    waves: &'a Waves,
    panels: &'a [(usize, &'a [Limit])],
) -> impl Iterator<Item = (&'a [Wave], &'a [Limit])> {
    let mut rest = &waves.rows[..];
    panels.iter().map(move |(count, limits)| {
        let (own, others) = rest.split_at(rest.len().min(*count));
        rest = others;
        (own, *limits)
    })
}

/// The values of a row.
fn values(wave: &Wave) -> impl Iterator<Item = i64> + '_ {
    std::iter::once(wave.start).chain(wave.changes.iter().map(|step| step.level)).map(millionths)
}

pub(super) fn draw(drawing: &mut Drawing, waves: &Waves, panels: &[(usize, &[Limit])], scale: &Scale) {
    for (own, limits) in of_panels(waves, panels) {
        panel(drawing, own, limits, scale);
        drawing.y += PANEL;
    }
}

fn panel(drawing: &mut Drawing, own: &[Wave], limits: &[Limit], scale: &Scale) {
    let levels = || limits.iter().map(|limit| in_millionths(limit.value).abs());
    let all =
        || own.iter().flat_map(values).chain(levels()).chain(levels().map(|level| -level)).chain([0]).map(i128::from);
    let (least, most) = (all().min().unwrap_or(0), all().max().unwrap_or(0));
    // A tenth of the range stays free above and below.
    let free = ((most - least) / 10).max(1);
    let (least, most) = (least - free, most + free);
    let low = drawing.y + (PANEL + CURVES) / 2;
    let y = |value: i128| low - i64::try_from((value - least) * i128::from(CURVES) / (most - least)).unwrap_or(0);
    let step = round_step((most - least) * i128::from(LINES) / i128::from(CURVES));
    let mut at = least.div_euclid(step) * step + step;
    while at < most {
        let class = if at == 0 { "axis" } else { "grid" };
        drawing.line(class, (scale.left(), y(at)), (scale.right(), y(at)));
        drawing.text("small right", (scale.left() - 80, y(at) + 36), &shortened(at, step));
        at += step;
    }
    if let Some(wave) = own.first() {
        drawing.text("small right", (scale.left() - 80, low - CURVES + 10), &wave.beside);
    }
    for (index, limit) in limits.iter().enumerate() {
        let value = i128::from(in_millionths(limit.value));
        for value in [value, -value] {
            drawing.line("level", (scale.left(), y(value)), (scale.right(), y(value)));
        }
        // Two limits can be near each other: the lower one has its text below its line.
        let beside = if index == 0 && limits.len() > 1 { 120 } else { -40 };
        drawing.text("alarm-name right", (scale.right() - 40, y(value) + beside), &limit.text);
    }
    for (wave, class) in own.iter().zip(CLASSES.iter().cycle()) {
        let path = path(wave, scale, |value| y(value.into()));
        let title = escaped(&extremes(wave));
        drawing.text.push_str(&format!("<path class=\"wave {class}\" d=\"{path}\"><title>{title}</title></path>\n"));
    }
}

/// A value of the grid, with the decimals that its step needs.
fn shortened(value: i128, step: i128) -> String {
    let text = decimals(i64::try_from(value).unwrap_or(i64::MAX));
    let zeros = (0..6).take_while(|zeros| step % 10_i128.pow(zeros + 1) == 0).count();
    let text = &text[..text.len() - zeros];
    text.strip_suffix('.').unwrap_or(text).to_owned()
}

/// The name of a curve with its smallest and its largest value.
fn extremes(wave: &Wave) -> String {
    let (least, most) = (values(wave).min().unwrap_or(0), values(wave).max().unwrap_or(0));
    format!("{}: {} to {} {}", name(wave), decimals(least), decimals(most), wave.beside).trim_end().to_owned()
}

/// The names of the curves below the time axis.
pub(super) fn names(drawing: &mut Drawing, waves: &Waves, panels: &[(usize, &[Limit])]) {
    drawing.y += 180;
    let mut x = MARGIN;
    for (own, _) in of_panels(waves, panels) {
        for (wave, class) in own.iter().zip(CLASSES.iter().cycle()) {
            let text = extremes(wave);
            let width = 320 + width_of(&text, SMALL_LETTER) + 320;
            if x > MARGIN && x + width > WIDTH {
                (x, drawing.y) = (MARGIN, drawing.y + 180);
            }
            drawing.line(&format!("wave {class}"), (x, drawing.y - 40), (x + 240, drawing.y - 40));
            drawing.text("small", (x + 320, drawing.y), &text);
            x += width;
        }
    }
    drawing.y += 60;
}
