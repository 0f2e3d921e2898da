//! The rows: bits as waves, numbers as lanes, values as curves, alarms as bars.

use std::fmt::Write as _;

use super::drawing::{Drawing, LETTER, MARGIN, SMALL_LETTER, Tenths, escaped, px, width_of};
use super::scale::Scale;
use crate::trace::record::by_in_words;
use crate::trace::value::decimals;
use crate::trace::waves::{Level, Step, Wave, WaveKind, Waves};
use crate::trace::{By, Shown};

/// The height of the row of a signal, and of the wave in it.
const ROW: Tenths = 230;
const WAVE: Tenths = 120;
/// The height of the row of a curve, and of the curve in it.
const CURVE_ROW: Tenths = 680;
const CURVE: Tenths = 500;
/// The gap between the rows of two owners.
const OWNER_GAP: Tenths = 70;

/// The name of a row.
pub(super) fn name(wave: &Wave) -> String {
    match wave.kind {
        WaveKind::Alarm => format!("{}.{}", wave.owner, wave.name),
        _ if wave.owner == "memory" => wave.name.clone(),
        _ => format!("{}.{}", wave.owner, wave.name),
    }
}

const fn row_height(kind: WaveKind) -> Tenths {
    match kind {
        WaveKind::Bit | WaveKind::Number(_) | WaveKind::Alarm => ROW,
        WaveKind::Real | WaveKind::Value => CURVE_ROW,
    }
}

/// The height of all rows.
pub(super) fn height(waves: &Waves) -> Tenths {
    let owners = waves.rows.chunk_by(|one, next| one.owner == next.owner).count();
    let rows: Tenths = waves.rows.iter().map(|wave| row_height(wave.kind)).sum();
    rows + OWNER_GAP * i64::try_from(owners).unwrap_or(0)
}

pub(super) fn draw(drawing: &mut Drawing, waves: &Waves, scale: &Scale) {
    for (index, of_owner) in waves.rows.chunk_by(|one, next| one.owner == next.owner).enumerate() {
        let height = of_owner.iter().map(|wave| row_height(wave.kind)).sum::<Tenths>() + OWNER_GAP;
        if index % 2 == 0 {
            // The band is drawn behind the names only, so that the grid stays uniform.
            drawing.rect("band", (MARGIN - 100, drawing.y), (drawing.left - MARGIN + 20, height), "");
        }
        drawing.y += OWNER_GAP / 2;
        for wave in of_owner {
            row(drawing, waves, wave, scale);
        }
        drawing.y += OWNER_GAP / 2;
    }
}

fn row(drawing: &mut Drawing, waves: &Waves, wave: &Wave, scale: &Scale) {
    let height = row_height(wave.kind);
    let middle = drawing.y + height / 2;
    let class = if wave.kind == WaveKind::Alarm { "alarm-name" } else { "name" };
    drawing.text(class, (MARGIN, middle + 40), &name(wave));
    if wave.kind != WaveKind::Alarm && height == ROW {
        drawing.text("small right", (drawing.left - 140, middle + 40), &wave.beside);
    }
    match wave.kind {
        WaveKind::Bit => bit(drawing, waves, wave, scale, middle),
        WaveKind::Alarm => alarm(drawing, waves, wave, scale, middle),
        WaveKind::Number(_) => number(drawing, waves, wave, scale, middle),
        WaveKind::Real | WaveKind::Value => curve(drawing, wave, scale, middle),
    }
    drawing.y += height;
}

/// The colour of a signal depends on its writer.
fn colour(wave: &Wave) -> &'static str {
    // Presets at power on do not identify the later writer.
    let by = wave.changes.iter().filter_map(|step| step.by).find(|by| *by != By::PowerOn);
    match by {
        Some(By::Nck) => "nck",
        Some(By::Plc | By::Outside | By::Force) => "plc",
        Some(By::Plant) => "plant",
        Some(By::PowerOn) | None => "still",
    }
}

/// The tooltip of a change.
fn told(waves: &Waves, wave: &Wave, step: &Step) -> String {
    let what = match step.level {
        Level::Signal(value) if wave.kind != WaveKind::Alarm => format!("becomes {value}"),
        Level::Signal(_) if step.level.is_high() => "raised".to_owned(),
        Level::Signal(_) => "cleared".to_owned(),
        Level::Value(value) => decimals(value),
    };
    let by = step.by.map(|by| format!(" by {}", by_in_words(by))).unwrap_or_default();
    let because = step.because.as_ref().map(|because| format!(": {because}")).unwrap_or_default();
    format!("{} s  {} {what}{by}{because}", waves.time(step.cycle), name(wave))
}

fn touches(drawing: &mut Drawing, waves: &Waves, wave: &Wave, scale: &Scale, middle: Tenths) {
    for step in &wave.changes {
        let title = told(waves, wave, step);
        drawing.rect("touch", (scale.x(step.cycle) - 30, middle - WAVE / 2 - 20), (60, WAVE + 40), &title);
    }
}

/// The intervals between changes: from, to, and the value.
fn stretches(wave: &Wave, scale: &Scale) -> Vec<(Tenths, Tenths, Level)> {
    let mut stretches = Vec::with_capacity(wave.changes.len() + 1);
    let (mut from, mut level) = (scale.left(), wave.start);
    for step in &wave.changes {
        let to = scale.x(step.cycle);
        stretches.push((from, to, level));
        (from, level) = (to, step.level);
    }
    stretches.push((from, scale.right(), level));
    stretches
}

fn bit(drawing: &mut Drawing, waves: &Waves, wave: &Wave, scale: &Scale, middle: Tenths) {
    let colour = colour(wave);
    let (high, low) = (middle - WAVE / 2, middle + WAVE / 2);
    let mut path = String::new();
    for (from, to, level) in stretches(wave, scale) {
        let y = if level.is_high() { high } else { low };
        if path.is_empty() {
            let _ = write!(path, "M{} {}", px(from), px(y));
        } else {
            let _ = write!(path, "V{}", px(y));
        }
        let _ = write!(path, "H{}", px(to));
        if level.is_high() && to > from {
            drawing.rect(&format!("{colour}-fill"), (from, high), (to - from, WAVE), "");
        }
    }
    let _ = writeln!(drawing.text, r#"<path class="wave {colour}" d="{path}"/>"#);
    touches(drawing, waves, wave, scale, middle);
}

fn alarm(drawing: &mut Drawing, waves: &Waves, wave: &Wave, scale: &Scale, middle: Tenths) {
    drawing.line("grid", (scale.left(), middle), (scale.right(), middle));
    let number = wave.name.strip_prefix("alarm ").unwrap_or(&wave.name);
    let wide = width_of(number, SMALL_LETTER);
    for (from, to, level) in stretches(wave, scale) {
        if !level.is_high() {
            continue;
        }
        // An alarm of one cycle must be visible, too.
        let width = (to - from).max(30);
        drawing.rect("alarm", (from, middle - WAVE / 2 - 10), (width, WAVE + 20), "");
        let (left, right) = scale.clear(from, from + width);
        let beside = from + width + 40;
        let is_free = beside + wide < scale.right() && scale.clear(beside, beside + wide) == (beside, beside + wide);
        if right - left >= wide + 20 {
            drawing.text("alarm-text middle", (i64::midpoint(left, right), middle + 36), number);
        } else if is_free {
            drawing.text("alarm-name", (beside, middle + 38), number);
        } else {
            // Far enough to the left for a section that can contain the number, even if a break is near.
            let end = scale.clear(from - 4 * wide, from - 40).1;
            drawing.text("alarm-name right", (end, middle + 38), number);
        }
    }
    touches(drawing, waves, wave, scale, middle);
}

fn number(drawing: &mut Drawing, waves: &Waves, wave: &Wave, scale: &Scale, middle: Tenths) {
    let colour = colour(wave);
    let (high, low) = (middle - WAVE / 2, middle + WAVE / 2);
    for (from, to, level) in stretches(wave, scale) {
        let Level::Signal(value) = level else {
            continue;
        };
        if to <= from {
            continue;
        }
        let bevel = ((to - from) / 2).min(30);
        let path = format!(
            "M{} {}L{} {}H{}L{} {}L{} {}H{}Z",
            px(from),
            px(middle),
            px(from + bevel),
            px(high),
            px(to - bevel),
            px(to),
            px(middle),
            px(to - bevel),
            px(low),
            px(from + bevel)
        );
        let _ = writeln!(drawing.text, r#"<path class="wave {colour} {colour}-fill" d="{path}"/>"#);
        let text = value.to_string();
        let (left, right) = scale.clear(from, to);
        if right - left > width_of(&text, LETTER) + 60 {
            drawing.text("small middle", (i64::midpoint(left, right), middle + 36), &text);
        }
    }
    touches(drawing, waves, wave, scale, middle);
}

/// The value of a curve, in millionths.
#[expect(clippy::cast_possible_truncation, reason = "float to integer casts saturate")]
pub(super) fn millionths(level: Level) -> i64 {
    match level {
        Level::Value(value) => value,
        Level::Signal(Shown::Number(number)) => (number * 1e6).round() as i64,
        Level::Signal(Shown::Unsigned(number)) => i64::try_from(number).unwrap_or(i64::MAX).saturating_mul(1_000_000),
        Level::Signal(Shown::Bit(bit)) => i64::from(bit) * 1_000_000,
    }
}

fn curve(drawing: &mut Drawing, wave: &Wave, scale: &Scale, middle: Tenths) {
    let values = || std::iter::once(wave.start).chain(wave.changes.iter().map(|step| step.level)).map(millionths);
    let (least, most) = (values().min().unwrap_or(0), values().max().unwrap_or(0));
    let (high, low) = (middle - CURVE / 2, middle + CURVE / 2);
    let y = |value: i64| {
        if most == least {
            return middle;
        }
        let above = i128::from(value) - i128::from(least);
        low - i64::try_from(above * i128::from(CURVE) / (i128::from(most) - i128::from(least))).unwrap_or(0)
    };
    let label = drawing.left - 140;
    if most == least {
        drawing.text("small right", (label, middle + 36), &three_decimals(least));
    } else {
        drawing.text("small right", (label, high + 60), &three_decimals(most));
        drawing.text("small right", (label, middle + 36), &wave.beside);
        drawing.text("small right", (label, low + 10), &three_decimals(least));
        if least < 0 && most > 0 {
            drawing.line("zero", (scale.left(), y(0)), (scale.right(), y(0)));
        }
    }
    for edge in [high, low] {
        drawing.line("grid", (scale.left() - 60, edge), (scale.left(), edge));
    }
    let path = path(wave, scale, y);
    let class = if wave.kind == WaveKind::Value { "value" } else { colour(wave) };
    let _ = writeln!(drawing.text, r#"<path class="wave {class}" d="{path}"><title>{}</title></path>"#, {
        let range = format!("{}: {} to {} {}", name(wave), decimals(least), decimals(most), wave.beside);
        escaped(range.trim_end())
    });
}

/// The curve of a row as the path of an element.
pub(super) fn path(wave: &Wave, scale: &Scale, y: impl Fn(i64) -> Tenths) -> String {
    let mut points = vec![(scale.left(), y(millionths(wave.start)))];
    let mut last = (0, wave.start);
    for step in &wave.changes {
        if step.cycle > last.0 + 1 {
            // The value was constant until the previous cycle.
            points.push((scale.x(step.cycle - 1), y(millionths(last.1))));
        }
        points.push((scale.x(step.cycle), y(millionths(step.level))));
        last = (step.cycle, step.level);
    }
    points.push((scale.right(), y(millionths(last.1))));
    let mut path = String::new();
    for (x, y) in thinned(&points) {
        let _ = write!(path, "{}{} {}", if path.is_empty() { 'M' } else { 'L' }, px(x), px(y));
    }
    path
}

/// Of the points in one pixel column: the first, the lowest, the highest, the last.
fn thinned(points: &[(Tenths, Tenths)]) -> Vec<(Tenths, Tenths)> {
    let mut kept: Vec<(Tenths, Tenths)> = Vec::new();
    for column in points.chunk_by(|one, next| one.0 / 10 == next.0 / 10) {
        let ends = [0, column.len() - 1];
        let lowest = (0..column.len()).max_by_key(|index| column[*index].1).unwrap_or(0);
        let highest = (0..column.len()).min_by_key(|index| column[*index].1).unwrap_or(0);
        let mut wanted = [ends[0], lowest, highest, ends[1]];
        wanted.sort_unstable();
        for index in wanted {
            if kept.last() != Some(&column[index]) {
                kept.push(column[index]);
            }
        }
    }
    kept
}

/// Millionths with three decimals, rounded.
fn three_decimals(millionths: i64) -> String {
    let thousandths = (millionths.unsigned_abs() + 500) / 1000;
    let sign = if millionths < 0 && thousandths > 0 { "-" } else { "" };
    format!("{sign}{}.{:03}", thousandths / 1000, thousandths % 1000)
}
