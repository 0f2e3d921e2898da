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
mod check;
mod compare;
mod history;
mod json;
mod lines;
mod past;
mod places;
mod printable;
mod record;
mod svg;
mod text;
mod value;
mod vcd;
mod watch;
mod waves;
mod why;

pub use check::{CauseFault, CauseFinding};
pub use compare::{Comparison, Reading};
pub use history::Trace;
pub use lines::{AlarmLine, Line, LineKind, SignalLine};
pub use past::Past;
pub use printable::Shown;
pub use record::{By, Change, Recorder, Row};
pub use text::{Head, difference, difference_in_sequence};
pub use watch::Watch;
pub use why::Story;

use crate::variables::Describe;

impl Trace {
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

#[cfg(test)]
mod tests;
