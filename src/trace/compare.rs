//! The first difference between two traces, in words: the signal, the time, the expected and the found change, and the last changes before
//! it.
//!
//! This module reads the output of the program: the text table (also of golden files) and JSON lines.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde_json::Value;

use super::printable::is_bit;
use crate::source::Problem;
use crate::units::Time;

/// The number of changes that are shown before the difference.
const BEFORE: usize = 4;

/// One row of a trace, as read from its text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Entry {
    /// The line in the text, from one.
    pub(super) line: usize,
    /// `None` for the lines above the rows.
    time: Option<Time>,
    /// The signal, value or alarm; the text of a note.
    what: String,
    /// The address, or the place of an alarm.
    address: String,
    /// `0 -> 1`, `raised`.
    change: String,
    /// The new value, if the text contains only that.
    new: String,
    by: String,
    /// The text and the parameters of an alarm.
    rest: String,
    /// The text of the cause; equal traces can differ in it.
    because: String,
}

/// A trace that was read from its text.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    pub(super) entries: Vec<Entry>,
    is_json: bool,
}

/// The result of comparing two traces.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// All rows and all causes are equal.
    Same,
    /// All rows are equal; the first different cause, in words.
    OtherCauses(String),
    /// The first difference, in words.
    Different(String),
}

impl Reading {
    /// Reads a trace: JSON lines, or the table that `opennck run` prints and that golden files contain (without the header of the latter).
    ///
    /// # Errors
    /// The text has neither form; the problem comes with its line, or with 0 for the whole text.
    pub fn read(text: &str) -> Result<Self, (usize, Problem)> {
        if text.trim_start().starts_with('{') {
            return json(text);
        }
        table(text).ok_or_else(|| {
            let cure = "write JSON lines with `opennck run --trace`, golden files with `opennck test --accept`";
            (0, Problem::new("expected a trace as JSON lines or as a table, found neither", cure))
        })
    }

    /// Whether the trace was read from JSON lines.
    #[must_use]
    pub fn is_json(&self) -> bool {
        self.is_json
    }

    /// Compares this trace (expected) with another trace (found). Events are treated as causes.
    #[must_use]
    pub fn compare(&self, found: &Self) -> Comparison {
        let mut other_causes = None;
        for index in 0..self.entries.len().max(found.entries.len()) {
            let (one, other) = (self.entries.get(index), found.entries.get(index));
            match (one, other) {
                (Some(one), Some(other)) if one.is_same(other) => {
                    if one.because != other.because && other_causes.is_none() {
                        other_causes = Some(causes_in_words(one, other));
                    }
                }
                _ => return Comparison::Different(in_words(self, found, index)),
            }
        }
        other_causes.map_or(Comparison::Same, Comparison::OtherCauses)
    }
}

impl Entry {
    /// Whether both rows have the same change by the same writer at the same time.
    fn is_same(&self, other: &Self) -> bool {
        self.time == other.time && self.by == other.by && self.rest == other.rest && self.is_same_change(other)
    }

    fn is_same_change(&self, other: &Self) -> bool {
        self.what == other.what && self.address == other.address && self.change == other.change
    }

    fn is_note(&self) -> bool {
        self.what.starts_with("# ")
    }

    /// The signal with its address.
    fn name(&self) -> String {
        match self.address.as_str() {
            "" => self.what.clone(),
            address if self.what.starts_with("alarm ") => format!("{} of {address}", self.what),
            address => format!("{} ({address})", self.what),
        }
    }

    /// The name of the row in a sentence.
    fn called(&self) -> String {
        if self.is_note() {
            format!("the note `{}`", &self.what[2..])
        } else {
            format!("{} {}", self.name(), self.change)
        }
    }

    fn row(&self) -> String {
        let time = self.time.map(|time| format!("{time:>9} s")).unwrap_or_default();
        let by = if self.by.is_empty() { String::new() } else { format!("by {}", self.by) };
        let because = if self.because.is_empty() { String::new() } else { format!("({})", self.because) };
        let name = if self.address.is_empty() { self.what.clone() } else { self.name() };
        let parts = [time, name, self.change.clone(), by, self.rest.clone(), because];
        parts.iter().filter(|part| !part.is_empty()).map(String::as_str).collect::<Vec<_>>().join("  ")
    }
}

/// The difference at this row, with the last rows that are equal in both traces.
pub(super) fn in_words(expected: &Reading, found: &Reading, index: usize) -> String {
    let (one, other) = (expected.entries.get(index), found.entries.get(index));
    let line = |entry: Option<&Entry>, all: &Reading| {
        entry.map_or_else(|| all.entries.last().map_or(1, |last| last.line + 1), |entry| entry.line)
    };
    let (first, second) = (line(one, expected), line(other, found));
    let mut text = format!("first difference in line {first}");
    if first != second {
        let _ = write!(text, " (line {second} of the other)");
    }
    let time = one.and_then(|entry| entry.time).into_iter().chain(other.and_then(|entry| entry.time)).min();
    if let Some(time) = time {
        let _ = write!(text, ", at {time} s");
    }
    for sentence in sentences(expected, found, index) {
        let _ = write!(text, "\n  {sentence}");
    }
    let shown =
        |entry: Option<&Entry>| entry.map_or_else(|| "(the end)".to_owned(), |entry| entry.row().trim().to_owned());
    let _ = write!(text, "\n  expected  {}\n  found     {}", shown(one), shown(other));
    let before = found.entries.get(..index).unwrap_or_default();
    let changes: Vec<_> = before.iter().rev().filter(|entry| entry.time.is_some()).take(BEFORE).collect();
    if !changes.is_empty() {
        text.push_str("\n  before it, the same in both:");
        for entry in changes.into_iter().rev() {
            let _ = write!(text, "\n  {}", entry.row());
        }
    }
    text
}

fn sentences(expected: &Reading, found: &Reading, index: usize) -> Vec<String> {
    let (one, other) = (expected.entries.get(index), found.entries.get(index));
    match (one, other) {
        (Some(one), Some(other)) => {
            if one.time.is_none() || other.time.is_none() {
                return vec!["the heads differ".to_owned()];
            }
            if one.is_same_change(other) {
                return vec![same_change(one, other)];
            }
            if one.what == other.what && one.address == other.address && one.time == other.time {
                return vec![format!("{}: expected {}, found {}", one.name(), one.change, other.change)];
            }
            missing(one, found, index).into_iter().chain(unexpected(other, expected, index)).collect()
        }
        (Some(one), None) => vec![format!("the other trace ends before {}", one.called())],
        (None, Some(other)) => vec![format!("{} is after the expected end", other.called())],
        (None, None) => Vec::new(),
    }
}

/// Both rows have the same change; time, writer or text differ.
fn same_change(one: &Entry, other: &Entry) -> String {
    match (one.time, other.time) {
        (Some(expected), Some(found)) if expected != found => {
            format!("{} is {} ({found} s instead of {expected} s)", one.called(), apart(expected, found))
        }
        _ if one.by != other.by => {
            format!("{}: expected writer {}, found {}", one.called(), one.by, other.by)
        }
        _ => format!("{} has a different text", one.called()),
    }
}

/// Describes a row that was expected here.
fn missing(one: &Entry, found: &Reading, index: usize) -> Option<String> {
    let time = one.time?;
    let later = found.entries[index..].iter().find(|entry| entry.is_same_change(one));
    Some(match later.and_then(|entry| entry.time) {
        Some(later) if later == time => format!("{} is in a different order within the same cycle", one.called()),
        Some(later) => format!("{} is {} ({later} s instead of {time} s)", one.called(), apart(time, later)),
        None => format!("{} is missing", one.called()),
    })
}

/// Describes a row that was not expected here; `None` if it only moved up because another row is late.
fn unexpected(other: &Entry, expected: &Reading, index: usize) -> Option<String> {
    let time = other.time?;
    let later = expected.entries[index..].iter().find(|entry| entry.is_same_change(other));
    match later.and_then(|entry| entry.time) {
        Some(later) if later == time => None,
        Some(later) => Some(format!("{} is {} ({time} s instead of {later} s)", other.called(), apart(later, time))),
        None => Some(format!("{} is new", other.called())),
    }
}

/// `0.004 s later`.
fn apart(expected: Time, found: Time) -> String {
    if found > expected { format!("{} s later", found - expected) } else { format!("{} s earlier", expected - found) }
}

fn causes_in_words(one: &Entry, other: &Entry) -> String {
    let shown = |text: &str| if text.is_empty() { "(no cause)".to_owned() } else { text.to_owned() };
    let time = one.time.unwrap_or(Time::ZERO);
    let (expected, found) = (shown(&one.because), shown(&other.because));
    format!(
        "different cause in line {}, at {time} s: {}\n  expected  {expected}\n  found     {found}",
        one.line,
        one.called()
    )
}

/// Reads the text table; the first row that begins with `time` defines the columns.
fn table(text: &str) -> Option<Reading> {
    let mut lines = text.lines().enumerate();
    let mut entries = Vec::new();
    let columns = loop {
        let (index, line) = lines.next()?;
        if let Some(columns) = columns(line) {
            break columns;
        }
        if !line.trim().is_empty() {
            entries.push(Entry { line: index + 1, what: line.trim().to_owned(), ..Entry::default() });
        }
    };
    for (index, line) in lines {
        let (line_number, trimmed) = (index + 1, line.trim());
        let time = trimmed.split_whitespace().next().and_then(|time| time.parse().ok()).map(Time::from_seconds);
        let Some(time) = time else {
            if !trimmed.is_empty() {
                entries.push(Entry { line: line_number, what: trimmed.to_owned(), ..Entry::default() });
            }
            continue;
        };
        let rest = trimmed.split_once(char::is_whitespace).map_or("", |(_, rest)| rest.trim_start());
        let mut entry = Entry { line: line_number, time: Some(time), ..Entry::default() };
        if rest.starts_with('#') {
            rest.clone_into(&mut entry.what);
        } else {
            let [what, address, change, by] = columns;
            let cell = |from: usize, to: Option<usize>| {
                let to = to.map_or(usize::MAX, |to| to - from);
                line.chars().skip(from).take(to).collect::<String>().trim().to_owned()
            };
            entry.what = cell(what, Some(address));
            entry.address = cell(address, Some(change));
            entry.change = cell(change, Some(by));
            let tail = cell(by, None);
            // `power on` is a writer, too; two spaces end it.
            let (by, rest) = tail.split_once("  ").unwrap_or((&tail, ""));
            by.clone_into(&mut entry.by);
            let rest = rest.trim();
            if entry.what.starts_with("alarm ") {
                let (text, because) = rest.split_once("  (").unwrap_or((rest, ""));
                text.clone_into(&mut entry.rest);
                because.trim_end_matches(')').clone_into(&mut entry.because);
            } else {
                rest.clone_into(&mut entry.because);
            }
        }
        entries.push(entry);
    }
    Some(Reading { entries, is_json: false })
}

/// The positions of `what`, `address`, `change` and `by`, in characters.
fn columns(line: &str) -> Option<[usize; 4]> {
    let mut words = line.split_whitespace();
    let is_head = ["time", "what", "address", "change", "by"].iter().all(|word| words.next() == Some(word));
    let place = |word: &str| line.find(word);
    is_head.then(|| Some([place(" what ")? + 1, place(" address ")? + 1, place(" change ")? + 1, place(" by")? + 1]))?
}

fn json(text: &str) -> Result<Reading, (usize, Problem)> {
    let mut entries = Vec::new();
    let mut last: BTreeMap<String, String> = BTreeMap::new();
    for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let wrong = |found: String| {
            let cure = "write the trace again with `opennck run SCENARIO --trace F.jsonl`";
            (index + 1, Problem::new(format!("expected one line of a trace, found {found}"), cure))
        };
        let value: Value = serde_json::from_str(line).map_err(|error| wrong(format!("invalid JSON: {error}")))?;
        let time = value.get("t").and_then(Value::as_f64).ok_or_else(|| wrong("a line without the time `t`".into()))?;
        let mut entry = entry(index + 1, Time::from_seconds(time), &value);
        if let Some(entry) = entry.as_mut().filter(|entry| !entry.new.is_empty()) {
            // JSON lines contain only the new value; the old value is in an earlier line.
            let old = last.insert(entry.what.clone(), entry.new.clone());
            let address = if entry.address.is_empty() { &entry.what } else { &entry.address };
            let opposite = || is_bit(address).then(|| if entry.new == "1" { "0" } else { "1" }.to_owned());
            let new = &entry.new;
            entry.change = old.or_else(opposite).map_or_else(|| new.clone(), |old| format!("{old} -> {new}"));
        }
        entries.extend(entry);
    }
    Ok(Reading { entries, is_json: true })
}

/// The entry of a line with a change; `None` for an event, which only explains changes.
fn entry(line: usize, time: Time, value: &Value) -> Option<Entry> {
    let text = |key: &str| match value.get(key) {
        Some(Value::String(text)) => text.clone(),
        Some(other) => other.to_string(),
        None => String::new(),
    };
    let mut entry = Entry { line, time: Some(time), by: text("by"), because: text("because"), ..Entry::default() };
    if value.get("note").is_some() {
        entry.what = format!("# {}", text("note"));
    } else if value.get("happened").is_some() {
        let object = ["machine_data", "fault", "handwheel"].map(text).concat();
        let amount = ["value", "amount", "pulses"].map(text).concat();
        entry.what = [text("happened"), object, amount].join(" ").trim_end().to_owned();
        entry.address = text("where");
        entry.change = "happened".to_owned();
    } else if value.get("alarm").is_some() {
        entry.what = format!("alarm {}", text("alarm"));
        entry.address = text("where");
        entry.change = text("state");
        entry.rest = [text("text"), text("parameters")].join(" ");
    } else if value.get("value").is_some() {
        let (symbol, address) = (text("symbol"), text("signal"));
        (entry.what, entry.address) = if symbol.is_empty() { (address, String::new()) } else { (symbol, address) };
        entry.new = text("value");
    } else {
        return None;
    }
    Some(entry)
}
