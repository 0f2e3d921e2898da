//! THE RECORD: what changed when, by whom and why; as text for people, as JSON lines for programs.
//!
//! The machine writes plain rows ([`Recorder`]); a [`Trace`] keeps them together with notes, watched values and
//! the events that caused them. Only when somebody prints it do numbers become names. The same trace prints
//! the same bytes on every machine: nothing in it depends on a clock or on the order of a hash.

mod because;
mod json;
mod lines;
mod places;
mod record;
mod text;
mod value;
mod watch;

pub use because::place_name;
pub use lines::{AlarmLine, Line, LineKind, SignalLine};
pub use places::Shown;
pub use record::{By, Change, Recorder, Row};
pub use text::{Head, difference, difference_in_sequence};
pub use value::{AxisValue, six_decimals};
pub use watch::Watch;

use crate::image::Memory;
use crate::units::{AxisNumber, Time};
use crate::variables::{Describe, Event, EventId, Variables};

/// A record that grows while a machine runs.
#[derive(Clone, Debug)]
pub struct Trace {
    /// The memory before the first row.
    start: Memory,
    first_cycle: u64,
    cycle_time: Time,
    rows: Vec<Row>,
    events: Vec<Event>,
    notes: Vec<(u64, String)>,
    watched: Vec<WatchedValue>,
    values: Vec<ValueRow>,
    lost: u64,
}

/// A value that is noted in every cycle in which it changes.
#[derive(Clone, Copy, Debug)]
struct WatchedValue {
    axis: AxisNumber,
    value: AxisValue,
    /// In millionths, as it is shown.
    last: Option<i64>,
}

#[derive(Clone, Copy, Debug)]
struct ValueRow {
    cycle: u64,
    index: usize,
    old: Option<i64>,
    new: i64,
}

impl Trace {
    /// An empty trace that begins with this memory after cycle `cycle`, which counts as time zero.
    #[must_use]
    pub fn begin(memory: &Memory, cycle_time: Time, cycle: u64) -> Self {
        Self {
            start: memory.clone(),
            first_cycle: cycle,
            cycle_time,
            rows: Vec::new(),
            events: Vec::new(),
            notes: Vec::new(),
            watched: Vec::new(),
            values: Vec::new(),
            lost: 0,
        }
    }

    /// Notes these values from now on, in every cycle in which they change.
    pub fn watch_values(&mut self, watch: &Watch, cycle: u64, variables: &Variables) {
        self.watched = watch.values().map(|(axis, value)| WatchedValue { axis, value, last: None }).collect();
        self.values.clear();
        self.note_values(cycle, variables);
    }

    /// Takes over what the recorder holds.
    pub fn extend(&mut self, recorder: &Recorder) {
        self.rows.extend_from_slice(recorder.rows());
        self.events.extend_from_slice(recorder.new_events());
        self.lost = recorder.lost();
    }

    /// Notes the watched values after a cycle.
    pub fn note_values(&mut self, cycle: u64, variables: &Variables) {
        for (index, watched) in self.watched.iter_mut().enumerate() {
            let new = millionths(watched.value.of(watched.axis, variables));
            if watched.last != Some(new) {
                self.values.push(ValueRow { cycle, index, old: watched.last, new });
                watched.last = Some(new);
            }
        }
    }

    /// Notes a text that belongs to a cycle.
    pub fn note(&mut self, cycle: u64, text: impl Into<String>) {
        self.notes.push((cycle, text.into()));
    }

    /// The rows as the machine wrote them.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// The event of this number that was there at the end of a cycle; numbers may begin anew at a power on.
    #[must_use]
    pub fn event(&self, id: EventId, cycle: u64) -> Option<&Event> {
        let so_far = self.events.partition_point(|event| event.cycle <= cycle);
        if !id.is_some() {
            return None;
        }
        self.events[..so_far].iter().rev().find(|event| event.id == id)
    }

    /// How many rows the recorder lost because nobody drained it.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// The time at the end of a cycle.
    fn time(&self, cycle: u64) -> Time {
        self.cycle_time.times(cycle.saturating_sub(self.first_cycle))
    }

    /// The trace for people: one row a change, aligned columns, with causes or without.
    #[must_use]
    pub fn text(&self, describe: &dyn Describe, watch: &Watch, causes: bool) -> String {
        text::rows(&self.lines(describe, watch), causes)
    }

    /// The trace for programs: JSON lines in order of time.
    #[must_use]
    pub fn json_lines(&self, describe: &dyn Describe, watch: &Watch) -> String {
        self.lines(describe, watch).iter().map(json::line).collect()
    }
}

/// A value in millionths, as six decimals show it.
#[expect(clippy::cast_possible_truncation, reason = "float to integer casts saturate")]
fn millionths(value: f64) -> i64 {
    (value * 1e6).round() as i64
}

/// Six decimals from millionths.
fn decimals(millionths: i64) -> String {
    let sign = if millionths < 0 { "-" } else { "" };
    let digits = millionths.unsigned_abs();
    format!("{sign}{}.{:06}", digits / 1_000_000, digits % 1_000_000)
}

#[cfg(test)]
mod tests;
