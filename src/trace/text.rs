//! The trace as text: a head, then one row per change in aligned columns; and the first difference of two traces, in words.

use super::compare::{self, Reading};
use super::record::by_in_words;
use super::{Line, LineKind};
use crate::source::printable;
use crate::units::Time;

/// The lines above the rows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Head {
    /// The title of the scenario.
    pub title: String,
    /// The machine, as named in the scenario.
    pub machine: String,
    /// The profile, if it is not the default.
    pub profile: Option<String>,
    /// The values of the case, if the scenario has a matrix.
    pub case: Option<String>,
    /// The cycle time.
    pub cycle_time: Time,
}

impl std::fmt::Display for Head {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "scenario  {}", printable(&self.title))?;
        writeln!(f, "machine   {}", printable(&self.machine))?;
        if let Some(profile) = &self.profile {
            writeln!(f, "profile   {profile}")?;
        }
        if let Some(case) = &self.case {
            writeln!(f, "case      {}", printable(case))?;
        }
        writeln!(f, "cycle     {} ms", self.cycle_time.seconds() * 1e3)
    }
}

/// The columns of one row.
struct Columns {
    time: String,
    what: String,
    address: String,
    change: String,
    by: String,
    rest: String,
}

impl Columns {
    fn widths(&self) -> [usize; 5] {
        [&self.time, &self.what, &self.address, &self.change, &self.by].map(|column| column.chars().count())
    }
}

/// All rows, with the column names above them.
pub(super) fn rows(lines: &[Line], causes: bool) -> String {
    let head = Columns {
        time: "time".to_owned(),
        what: "what".to_owned(),
        address: "address".to_owned(),
        change: "change".to_owned(),
        by: "by".to_owned(),
        rest: if causes { "because".to_owned() } else { String::new() },
    };
    let rows: Vec<Result<Columns, &Line>> = lines.iter().map(|line| columns(line, causes)).collect();
    let mut widths = head.widths();
    for row in &rows {
        match row {
            Ok(row) => {
                for (width, own) in widths.iter_mut().zip(row.widths()) {
                    *width = own.max(*width);
                }
            }
            Err(note) => widths[0] = widths[0].max(note.time.to_string().len()),
        }
    }
    // Rounded up, so that one longer name in a changed trace rarely moves every row.
    for width in &mut widths[..4] {
        *width = width.next_multiple_of(4);
    }
    let mut text = String::new();
    for row in std::iter::once(Ok(head)).chain(rows) {
        let line = match row {
            Ok(row) => format!(
                "{:>1$}  {2:<3$}  {4:<5$}  {6:<7$}  {8:<9$}  {10}",
                row.time,
                widths[0],
                row.what,
                widths[1],
                row.address,
                widths[2],
                row.change,
                widths[3],
                row.by,
                widths[4],
                row.rest
            ),
            Err(Line { time, kind: LineKind::Note(note) }) => {
                // A note of several lines is printed in one row.
                let note = note.lines().collect::<Vec<_>>().join(" / ");
                format!("{:>1$}  # {2}", time.to_string(), widths[0], printable(&note))
            }
            Err(_) => continue,
        };
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

/// The columns of a line; the line itself for a note, which has no columns.
fn columns(line: &Line, causes: bool) -> Result<Columns, &Line> {
    let time = line.time.to_string();
    let row = match &line.kind {
        LineKind::Note(_) => return Err(line),
        LineKind::Happening(happening) => {
            let because = happening.because.clone().filter(|_| causes);
            Columns {
                time,
                what: happening.what.clone(),
                address: happening.place.clone(),
                change: happening.change.to_owned(),
                by: by_in_words(happening.by).to_owned(),
                rest: because.unwrap_or_default(),
            }
        }
        LineKind::Signal(signal) => {
            let (what, address) = match &signal.symbol {
                Some(symbol) => (symbol.clone(), signal.address.clone()),
                None => (signal.address.clone(), String::new()),
            };
            let because = signal.because.clone().filter(|_| causes);
            Columns {
                time,
                what,
                address,
                change: format!("{} -> {}", signal.old, signal.new),
                by: by_in_words(signal.by).to_owned(),
                rest: because.unwrap_or_default(),
            }
        }
        LineKind::Alarm(alarm) => {
            let because = alarm.because.as_ref().filter(|_| causes);
            let because = because.map(|because| format!("  ({because})")).unwrap_or_default();
            Columns {
                time,
                what: format!("alarm {}", alarm.name),
                address: alarm.place.clone(),
                change: if alarm.raised { "raised" } else { "cleared" }.to_owned(),
                by: "nck".to_owned(),
                rest: format!("{}{because}", alarm.text),
            }
        }
        LineKind::Value(name, old, new) | LineKind::Text(name, old, new) => Columns {
            time,
            what: name.clone(),
            address: String::new(),
            change: old.as_ref().map_or_else(|| new.clone(), |old| format!("{old} -> {new}")),
            by: String::new(),
            rest: String::new(),
        },
    };
    Ok(row)
}

/// The first difference of two texts, in words; `None` if they are equal. Tables of traces are compared row by row.
#[must_use]
pub fn difference(expected: &str, found: &str) -> Option<String> {
    first_difference(expected, found, |one, other| one == other)
}

/// The first difference of two traces in the order of their rows. Times may differ by `tolerance`, or by any amount without it.
#[must_use]
pub fn difference_in_sequence(expected: &str, found: &str, tolerance: Option<Time>) -> Option<String> {
    first_difference(expected, found, |one, other| match (timed(one), timed(other)) {
        (Some((one, expected)), Some((other, found))) => {
            let apart = Time::from_nanos((one - other).nanos().abs());
            expected.eq(found) && tolerance.is_none_or(|tolerance| apart <= tolerance)
        }
        _ => one.split_whitespace().eq(other.split_whitespace()),
    })
}

fn first_difference(expected: &str, found: &str, same: impl Fn(&str, &str) -> bool) -> Option<String> {
    let (mut ones, mut others) = (expected.lines(), found.lines());
    let mut line = 0;
    loop {
        line += 1;
        match (ones.next(), others.next()) {
            (None, None) => return None,
            (Some(one), Some(other)) if same(one, other) => {}
            (one, other) => return Some(told(expected, found, line).unwrap_or_else(|| in_words(line, one, other))),
        }
    }
}

/// The difference as rows of traces, if both texts are tables and each has a row at this line or has ended.
fn told(expected: &str, found: &str, line: usize) -> Option<String> {
    let (expected, found) = (Reading::read(expected).ok()?, Reading::read(found).ok()?);
    let row = |all: &Reading| all.entries.iter().position(|entry| entry.line >= line).unwrap_or(all.entries.len());
    let index = row(&expected);
    let differs = expected.entries.get(index) != found.entries.get(index);
    (index == row(&found) && differs && !expected.is_json()).then(|| compare::in_words(&expected, &found, index))
}

/// A row, split into its time and the words after it.
fn timed(row: &str) -> Option<(Time, std::str::SplitWhitespace<'_>)> {
    let mut words = row.split_whitespace();
    let time = words.next()?.parse().ok()?;
    Some((Time::from_seconds(time), words))
}

fn in_words(line: usize, expected: Option<&str>, found: Option<&str>) -> String {
    let shown = |text: Option<&str>| text.map_or_else(|| "(the end)".to_owned(), str::to_owned);
    format!("first difference in line {line}\n  expected  {}\n  found     {}", shown(expected), shown(found))
}
