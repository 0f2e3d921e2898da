//! The record of all changes with time, writer and cause: as text, waveform and timing diagram for readers, as JSON lines for programs.
//!
//! The machine writes plain rows ([`Recorder`]). A [`Trace`] collects them together with notes, watched values and the events that caused
//! them. Numbers are converted to names only when the trace is printed. The same trace prints the same bytes on every computer, because
//! it depends neither on a clock nor on a hash order.
//!
//! # JSON lines
//!
//! One object per line, in order of time `t` (seconds). Order within one time: notes, happenings, writes by address, events, bits of the
//! NCK by address, alarms by number, values. Readers must ignore keys and kinds of lines that they do not know.
//!
//! | line | keys after `t` |
//! |---|---|
//! | a signal changed | `signal` (address), `symbol` if it has one, `value`, `by`, `because` (text), `event` |
//! | an alarm was raised or cleared | `alarm`, `state`, `where`, `parameters`, `text`, `because`, `event` |
//! | a note | `note` |
//! | something else happened | `happened`, its object, `where`, `by`, `because`, `event` |
//! | a watched value changed | `symbol`, `value` |
//! | an event of the control, or a statement of the PLC program that changed a bit (`where` is `PLC`) | `event`, `where`, `rule`, `because`, `inputs`, `parent` |
//!
//! What happens in addition to changes of signals is a line, too, with or without `watch`: one line for one thing. The power on that opens
//! a machine is the start of its trace and has no line; a datum that becomes active in the cycle in which it was written has only the
//! second of its two lines. In the text, a happening is a row (`power`, `MD37110 = 0.1`, `fault push = 0.3`); in VCD and SVG it stands
//! among the notes. So does a watched text, `CHAN1.program`; its line has `symbol` and a text as `value`.
//!
//! | `happened` | keys of its object |
//! |---|---|
//! | `power_on`, `set_machine_data_active`, `cancel_key`, `plc_stopped`, `plc_started`, `plc_cold_restart` | |
//! | `machine_datum_stored`, `machine_datum_active` | `machine_data` (`34100[2,XF]`), `value` unless it is a text |
//! | `fault_set`, `fault_cleared` | `fault` (`push`), `amount` if it has one |
//! | `handwheel_turned` | `handwheel`, `pulses` |
//! | `program_selected` | `program` (`PART.MPF`) |
//! | `blocks_entered` | |
//!
//! `event` is a unique number in a trace. A change names the event that caused it, an event names the event that led to it as `parent`. A
//! trace contains only events that caused changes in it. `inputs` lists what the event tested: objects with `signal`, `symbol` and `value`,
//! with `machine_data` (`37110[XF]`) and `value`, with `symbol` and `value` for a length, a velocity or an operation of the PLC program, with `alarm`, with `fault`, or with
//! `timer` (`T5`, `C3`) and the `value` of its status.
//! The event of a happening is the root of what follows from it. So the chain of
//! causes can be followed without the machine ([`Story`], `opennck why`), as far as the trace watches its signals. [`Reading`] compares two
//! traces (`opennck diff`).
//!
//! ```text
//! {"t":7.596,"signal":"DB31.DBX29.4","symbol":"X.start_gantry_synchronization","value":1,"by":"outside"}
//! {"t":7.596,"event":57,"where":"X","rule":"REF-14","because":"REF-14: start, X.start_gantry_synchronization = 1",
//!  "inputs":[{"signal":"DB31.DBX29.4","symbol":"X.start_gantry_synchronization","value":1}],"parent":55}
//! {"t":7.596,"signal":"DB31.DBX64.6","symbol":"X.traverse_command_minus","value":1,"by":"nck","because":"REF-14: ...","event":57}
//! ```

mod because;
mod bits;
mod calendar;
mod causes;
mod check;
mod compare;
mod curves;
mod happened;
mod history;
mod json;
mod lines;
mod measured;
mod misplaced;
mod past;
mod places;
mod printable;
mod record;
mod seen;
mod svg;
mod text;
mod value;
mod vcd;
mod watch;
mod waves;
mod why;
mod window;

pub use because::because;
pub use check::{CauseFault, CauseFinding};
pub use compare::{Comparison, Reading};
pub use curves::{Curves, Limit, Panel};
pub use happened::{Detail, HappeningLine};
pub use history::{ProgramRow, Trace};
pub use lines::{AlarmLine, Line, LineKind, SignalLine};
pub use misplaced::{nearest_signal, value_as_signal};
pub use past::Past;
pub use printable::Shown;
pub use record::{By, Change, NoEffect, Recorder, Row};
pub use text::{Head, difference, difference_in_sequence};
pub use watch::Watch;
pub use why::Story;
pub use window::Window;

use crate::variables::Describe;

impl Trace {
    /// The trace as text: one row per change, aligned columns, with or without causes.
    #[must_use]
    pub fn text(&self, describe: &dyn Describe, watch: &Watch, causes: bool) -> String {
        text::rows(&self.lines(describe, watch), causes)
    }

    /// The trace as JSON lines in order of time, for programs.
    #[must_use]
    pub fn json_lines(&self, describe: &dyn Describe, watch: &Watch) -> String {
        let lines = self.lines(describe, watch);
        json::lines(&lines, &self.causes_of(&lines, describe))
    }

    /// The trace as a waveform (Value Change Dump, IEEE 1364) for viewers such as GTKWave.
    ///
    /// Each owner of signals (`nck`, `mode_group_1`, a channel, an axis) is a scope; signals without an owner are in `memory`. Bits are
    /// wires, numbers are vectors, REALs and watched values are reals. An alarm is a wire, `alarm_10654`, in the scope of its axis or
    /// channel; `note` in scope `scenario` is a string. The time unit is the largest decimal unit of which the cycles are multiples. Time 0
    /// shows the memory before the first cycle. `watch` selects the contents: its signals and values, even those that never change. Of a
    /// pattern for a whole owner or block (`X.*`), and without a selection, only the signals that changed have rows.
    #[must_use]
    pub fn vcd(&self, describe: &dyn Describe, watch: &Watch, window: Window) -> String {
        vcd::text(&self.waves(describe, watch).within(window))
    }

    /// The trace as a timing diagram (SVG 1.1 with a light and a dark style) of the signals and values that `watch` selects, with the same
    /// rows as a waveform.
    ///
    /// Bits are waves, values are curves with their extremes, alarms are bars with their number, notes are numbered flags with a legend
    /// below. Long intervals without a visible change are shortened at a visible break, which shows their length. A tooltip at each edge
    /// shows its time, its writer and its cause.
    #[must_use]
    pub fn svg(&self, describe: &dyn Describe, watch: &Watch, window: Window, head: &Head) -> String {
        svg::document(&self.waves(describe, watch).within(window), head)
    }

    /// Curves of the same run as a diagram in the style of [`Trace::svg`]: each panel has one scale for its curves. Notes are numbered
    /// flags.
    #[must_use]
    pub fn plot(
        &self,
        describe: &dyn Describe,
        curves: &Curves,
        panels: &[Panel],
        window: Window,
        head: &Head,
    ) -> String {
        let mut waves = self.waves(describe, &Watch::default());
        let counts = curves.rows(panels, &mut waves, self.first_cycle, describe);
        svg::plot(&waves.within(window), &counts, head)
    }
}

#[cfg(test)]
mod tests;
