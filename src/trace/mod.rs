//! THE RECORD: what changed when, by whom and why; as text, waveform and timing diagram for people, as JSON lines for programs.
//!
//! The machine writes plain rows ([`Recorder`]); a [`Trace`] keeps them together with notes, watched values and
//! the events that caused them. Only when somebody prints it do numbers become names. The same trace prints
//! the same bytes on every machine: nothing in it depends on a clock or on the order of a hash.
//!
//! # JSON lines
//!
//! One object a line, in order of time `t` (seconds); within one time notes, writes by address, events, bits of the NCK by
//! address, alarms by number, values. Readers skip keys and kinds of lines that they do not know.
//!
//! | line | keys behind `t` |
//! |---|---|
//! | a signal changed | `signal` (address), `symbol` where there is one, `value`, `by`, `because` (words), `event` |
//! | an alarm came or went | `alarm`, `state`, `where`, `parameters`, `text`, `because`, `event` |
//! | a note | `note` |
//! | a watched value changed | `symbol`, `value` |
//! | an event of the control | `event`, `where`, `rule`, `because`, `inputs`, `parent` |
//!
//! `event` is a number that is given once in a trace; a change names the event behind it, an event names as `parent` the one that
//! led to it. Only events behind changes that the trace shows are in it. `inputs` is what the event tested: objects
//! with `signal`, `symbol` and `value`, with `machine_data` (`37110[XF]`) and `value`, with `symbol` and `value` for a length or a
//! velocity, or with `alarm`. So the chain of causes can be followed without the machine ([`Story`], `opennck why`), as far as
//! the trace watches the signals in it. [`Reading`] compares two traces (`opennck diff`).
//!
//! ```text
//! {"t":7.596,"signal":"DB31.DBX29.4","symbol":"X.start_gantry_synchronization","value":1,"by":"outside"}
//! {"t":7.596,"event":57,"where":"X","rule":"REF-14","because":"REF-14: start, X.start_gantry_synchronization = 1",
//!  "inputs":[{"signal":"DB31.DBX29.4","symbol":"X.start_gantry_synchronization","value":1}],"parent":55}
//! {"t":7.596,"signal":"DB31.DBX64.6","symbol":"X.traverse_command_minus","value":1,"by":"nck","because":"REF-14: ...","event":57}
//! ```

mod because;
mod causes;
mod compare;
mod json;
mod lines;
mod places;
mod record;
mod svg;
mod text;
mod value;
mod vcd;
mod watch;
mod waves;
mod why;

pub use because::place_name;
pub use compare::{Comparison, Reading};
pub use lines::{AlarmLine, Line, LineKind, SignalLine};
pub use places::Shown;
pub use record::{By, Change, Recorder, Row};
pub use text::{Head, difference, difference_in_sequence};
pub use value::{AxisValue, six_decimals};
pub use watch::Watch;
pub use why::Story;

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
    /// The last cycle that was noted.
    last_cycle: u64,
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
            last_cycle: cycle,
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
        self.last_cycle = self.last_cycle.max(cycle);
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
        self.events.get(self.event_index(id, cycle)?)
    }

    fn event_index(&self, id: EventId, cycle: u64) -> Option<usize> {
        let so_far = self.events.partition_point(|event| event.cycle <= cycle);
        if !id.is_some() {
            return None;
        }
        self.events[..so_far].iter().rposition(|event| event.id == id)
    }

    /// The number of an event in this trace, in which numbers never begin anew: from one; zero for none.
    fn event_number(&self, id: EventId, cycle: u64) -> u32 {
        self.event_index(id, cycle).map_or(0, |index| u32::try_from(index + 1).unwrap_or(0))
    }

    /// The event of this number in this trace.
    fn event_numbered(&self, number: u32) -> Option<&Event> {
        self.events.get((number as usize).checked_sub(1)?)
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
        let lines = self.lines(describe, watch);
        json::lines(&lines, &self.causes_of(&lines, describe))
    }

    /// The trace as a waveform (Value Change Dump, IEEE 1364) for viewers such as GTKWave.
    ///
    /// Each owner of signals (`nck`, `mode_group_1`, a channel, an axis) is a scope; what has no owner is in `memory`. Bits are
    /// wires, numbers vectors, REALs and watched values reals. An alarm is a wire, `alarm_10654` in the scope of its
    /// axis or channel; `note` in scope `scenario` is a string. The time unit is the largest decimal one that the cycle is a whole
    /// number of; at time 0 stands what the memory held before the first cycle. What is in it follows `watch`: every signal that
    /// changed and that it shows, signals that it names one by one even if they did not, and its values.
    #[must_use]
    pub fn vcd(&self, describe: &dyn Describe, watch: &Watch) -> String {
        vcd::text(&self.waves(describe, watch))
    }

    /// The trace as a timing diagram (SVG 1.1 with a style for light and one for dark), showing what `watch` shows.
    ///
    /// Bits are waves and values curves with their extremes; alarms are bars with their number; notes are numbered flags with a
    /// legend below. Stretches in which nothing that is shown changes are shortened at a visible break, which says how long
    /// they are. Whoever points at an edge reads its time, its writer and its cause.
    #[must_use]
    pub fn svg(&self, describe: &dyn Describe, watch: &Watch, head: &Head) -> String {
        svg::document(&self.waves(describe, watch), head)
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
