//! The time axis: uniform sections, and breaks in long intervals without changes.

use std::fmt::Write as _;

use super::drawing::{Drawing, SMALL_LETTER, Tenths, px, width_of};
use crate::trace::calendar::Calendar;
use crate::trace::waves::Waves;
use crate::units::Time;

/// The width of a shortened interval.
const BREAK: Tenths = 520;
/// The maximum number of shortened intervals.
const BREAKS: usize = 8;
/// An interval is shortened only if its full width is at least this.
const WORTH_IT: Tenths = 3 * BREAK;
/// If half of the intervals between changes have at least this width, no further interval is shortened.
const LEGIBLE: Tenths = 300;
/// An interval with fewer of the first cycles is never shortened.
const LONG: u64 = 25;
/// Half the width of the gap at a break.
const TEAR: Tenths = 75;
/// The minimum distance of two ticks.
const TICKS: Tenths = 640;

/// Converts cycles to positions, in proportion to their times.
pub(super) struct Scale {
    calendar: Calendar,
    /// In order, without gaps.
    stretches: Vec<Stretch>,
    left: Tenths,
    right: Tenths,
}

struct Stretch {
    /// In nanoseconds.
    from: u64,
    to: u64,
    left: Tenths,
    right: Tenths,
    is_break: bool,
}

impl Scale {
    pub(super) fn new(waves: &Waves, left: Tenths, right: Tenths) -> Self {
        let nanos = |cycle: u64| waves.time(cycle).nanos().unsigned_abs();
        let (first, last) = (nanos(waves.first), nanos(waves.last.max(waves.first + 1)));
        let long = waves.calendar.first_length().times(LONG).nanos().unsigned_abs();
        let mut busy: Vec<u64> = waves
            .rows
            .iter()
            .flat_map(|wave| wave.changes.iter().map(|step| step.cycle))
            .chain(waves.notes.iter().map(|(cycle, _)| *cycle))
            .map(|cycle| nanos(cycle).min(last))
            .chain([first, last])
            .collect();
        busy.sort_unstable();
        busy.dedup();
        let mut quiet: Vec<(u64, u64)> = busy.windows(2).map(|pair| (pair[0], pair[1])).collect();
        // The longest interval first; of equal intervals, the first.
        quiet.sort_by_key(|(from, to)| (u64::MAX - (to - from), *from));
        let width = right - left;
        let mut broken: Vec<(u64, u64)> = Vec::new();
        let mut rest = i64::try_from(last - first).unwrap_or(i64::MAX);
        for &(from, to) in quiet.iter().take(BREAKS) {
            let length = i64::try_from(to - from).unwrap_or(i64::MAX);
            let even = width - BREAK * i64::try_from(broken.len()).unwrap_or(0);
            // The width of this interval if the intervals before it were shortened and this one were not.
            let would_be = i128::from(length) * i128::from(even) / i128::from(rest.max(1));
            // The intervals are ordered by length, so the middle one of the rest is the median.
            let middle = quiet.get(usize::midpoint(broken.len(), quiet.len()));
            let median =
                middle.map_or(0, |(from, to)| i128::from(to - from) * i128::from(even) / i128::from(rest.max(1)));
            let is_legible = median >= i128::from(LEGIBLE);
            if would_be < i128::from(WORTH_IT) || rest == length || to - from < long || is_legible {
                break;
            }
            rest -= length;
            broken.push((from, to));
        }
        broken.sort_unstable();
        let even = width - BREAK * i64::try_from(broken.len()).unwrap_or(0);
        let mut stretches = Vec::new();
        let (mut at, mut x, mut passed) = (first, left, 0_i64);
        let breaks = i64::try_from(broken.len()).unwrap_or(0);
        for (index, (from, to)) in broken.into_iter().chain([(last, last)]).enumerate() {
            if from > at {
                passed += i64::try_from(from - at).unwrap_or(0);
                // Always computed from the left end, so that rounding errors do not accumulate.
                let done = i64::try_from(i128::from(passed) * i128::from(even) / i128::from(rest.max(1))).unwrap_or(0);
                let end = left + done + BREAK * i64::try_from(index).unwrap_or(0).min(breaks);
                stretches.push(Stretch { from: at, to: from, left: x, right: end, is_break: false });
                x = end;
            }
            if to > from {
                stretches.push(Stretch { from, to, left: x, right: x + BREAK, is_break: true });
                x += BREAK;
            }
            at = to;
        }
        Self { calendar: waves.calendar.clone(), stretches, left, right }
    }

    /// The position of the end of a cycle.
    pub(super) fn x(&self, cycle: u64) -> Tenths {
        let nanos = self.calendar.time(cycle).nanos().unsigned_abs();
        let Some(stretch) = self.stretches.iter().find(|stretch| nanos <= stretch.to) else {
            return self.right;
        };
        let (passed, length) = (nanos.saturating_sub(stretch.from), (stretch.to - stretch.from).max(1));
        let width = i128::from(stretch.right - stretch.left);
        stretch.left + i64::try_from(width * i128::from(passed) / i128::from(length)).unwrap_or(0)
    }

    pub(super) const fn left(&self) -> Tenths {
        self.left
    }

    pub(super) const fn right(&self) -> Tenths {
        self.right
    }

    /// The widest part of a span without a break.
    pub(super) fn clear(&self, from: Tenths, to: Tenths) -> (Tenths, Tenths) {
        let (mut best, mut start) = ((from, from), from);
        let tears = self.stretches.iter().filter(|stretch| stretch.is_break).map(|stretch| {
            let middle = i64::midpoint(stretch.left, stretch.right);
            (middle - TEAR, middle + TEAR)
        });
        for (left, right) in tears.chain([(to, to)]).filter(|(left, right)| *right > from && *left <= to) {
            let end = left.min(to);
            if end - start > best.1 - best.0 {
                best = (start, end);
            }
            start = right;
        }
        best
    }

    /// The ticks: position and time.
    fn ticks(&self) -> Vec<(Tenths, String)> {
        let even = self.stretches.iter().filter(|stretch| !stretch.is_break);
        let Some(widest) = even.clone().max_by_key(|stretch| stretch.right - stretch.left) else {
            return Vec::new();
        };
        let span = i128::from(widest.to - widest.from).max(1);
        let least = span * i128::from(TICKS) / i128::from((widest.right - widest.left).max(1));
        let step = round_step(least).max(i128::from(self.calendar.first_length().nanos()));
        let mut ticks: Vec<(Tenths, String)> = Vec::new();
        // The ends of every break have exact labels; round times only have labels where they fit.
        for stretch in self.stretches.iter().filter(|stretch| stretch.is_break) {
            for (x, nanos) in [(stretch.left, stretch.from), (stretch.right, stretch.to)] {
                ticks.push((x, time(nanos).to_string()));
            }
        }
        ticks.dedup();
        ticks.retain({
            let mut before = None;
            move |(x, text)| {
                let fits = before.is_none_or(|before| x - before >= width_of(text, SMALL_LETTER) + 40);
                before = if fits { Some(*x) } else { before };
                fits
            }
        });
        for stretch in even {
            let (from, to) = (i128::from(stretch.from), i128::from(stretch.to));
            let width = i128::from(stretch.right - stretch.left);
            let place = |at: i128| stretch.left + i64::try_from(width * (at - from) / (to - from).max(1)).unwrap_or(0);
            let mut at = (from + step - 1) / step * step;
            while at <= to {
                let (x, text) = (place(at), time_text(at, step));
                let wide = width_of(&text, SMALL_LETTER) + 160;
                if ticks.iter().all(|(other, _)| (x - other).abs() >= wide) {
                    ticks.push((x, text));
                }
                at += step;
            }
        }
        ticks.sort();
        ticks
    }

    pub(super) fn draw_grid(&self, drawing: &mut Drawing, top: Tenths, bottom: Tenths) {
        for (x, _) in self.ticks() {
            drawing.line("grid", (x, top), (x, bottom));
        }
    }

    /// Draws a gap across all rows for each break.
    pub(super) fn draw_breaks(&self, drawing: &mut Drawing, top: Tenths, bottom: Tenths) {
        for stretch in self.stretches.iter().filter(|stretch| stretch.is_break) {
            let middle = i64::midpoint(stretch.left, stretch.right);
            let (left, right) = (middle - 40, middle + 40);
            let zigzag = |x: Tenths| {
                let mut path = format!("M{} {}", px(x), px(top));
                let (mut y, mut side) = (top, 0);
                while y < bottom {
                    y = (y + 60).min(bottom);
                    side = 30 - side;
                    let _ = write!(path, "L{} {}", px(x + side), px(y));
                }
                path
            };
            drawing.rect("gap", (left + 15, top), (right - left, bottom - top), "");
            for x in [left, right] {
                let _ = writeln!(drawing.text, r#"<path class="tear" d="{}"/>"#, zigzag(x));
            }
        }
    }

    /// Draws the axis below the rows, with the length of every break.
    pub(super) fn draw_axis(&self, drawing: &mut Drawing) {
        let y = drawing.y + 40;
        for stretch in &self.stretches {
            if stretch.is_break {
                let length = time(stretch.to - stretch.from);
                let middle = i64::midpoint(stretch.left, stretch.right);
                drawing.text("small middle", (middle + 15, y + 300), shortened(&length.to_string()));
                drawing.text("small middle", (middle + 15, y + 40), "//");
            } else {
                drawing.line("axis", (stretch.left, y), (stretch.right, y));
            }
        }
        for (x, text) in self.ticks() {
            drawing.line("axis", (x, y), (x, y + 50));
            drawing.text("small middle", (x, y + 160), &text);
        }
        drawing.text("small right", (drawing.left - 280, y + 160), "time in s");
        if self.stretches.iter().any(|stretch| stretch.is_break) {
            drawing.text("small right", (drawing.left - 280, y + 300), "left out, s");
            drawing.y += 140;
        }
        drawing.y += 260;
    }
}

fn time(nanos: u64) -> Time {
    Time::from_nanos(i64::try_from(nanos).unwrap_or(i64::MAX))
}

/// The next of 1, 2, 5, 10 … units.
pub(super) fn round_step(least: i128) -> i128 {
    let mut decade = 1;
    loop {
        for step in [1, 2, 5] {
            if decade * step >= least {
                return decade * step;
            }
        }
        decade *= 10;
    }
}

/// A time with the number of decimals that the step needs.
fn time_text(nanos: i128, step: i128) -> String {
    let mut decimals = 0;
    let mut unit: i128 = 1_000_000_000;
    while step % unit != 0 && decimals < 9 {
        unit /= 10;
        decimals += 1;
    }
    let (whole, part) = (nanos / 1_000_000_000, nanos % 1_000_000_000 / unit);
    if decimals == 0 { whole.to_string() } else { format!("{whole}.{part:0decimals$}") }
}

/// `1.020` as `1.02`, with at least one digit after the point.
fn shortened(seconds: &str) -> &str {
    let text = seconds.trim_end_matches('0');
    if text.ends_with('.') { &seconds[..text.len() + 1] } else { text }
}
