//! FC 18 (SpinCtrl) for PLC programs in Rust: positions an axis or a spindle by the PLC, and lets a spindle rotate or oscillate. On the NCK's side it is DB31.DBB32 to 43 and 104 to 107, on the 828D
//! DB380x.DBB3000 to 3011 and DB390x.DBB3000 to 3003, which a program can also write by itself.
//!
//! | step | what the block does |
//! |---|---|
//! | Start rises | it takes over its inputs. An axis that is no PLC axis yet is requested (8.7, 8.4) |
//! | 68.7 = 1 | it writes the target and the start bit |
//! | position reached, or an error | InPos, or Error and State; they stay while Start is 1 |
//! | Stop rises, or Start falls before that | the start bit goes: the axis stops on its ramp and drops the rest; InPos and Error stay 0 |
//! | Start = 0 | InPos = Error = State = 0; an axis that the block has requested goes back to its channel |
//!
//! A spindle that rotates or oscillates (functions 2, 3, 9) does so until Stop rises: InPos is 1 while Start is 1 and its speed is in range, and
//! Start = 0 changes nothing. Then it goes back to its channel, if the block has requested it.

use serde::{Deserialize, Serialize};

use crate::plc::{Link, PlcIo};
use crate::units::{AxisNumber, Time};

/// How long the NCK takes to answer a request at most: with neither 68.4 nor 68.7 after this time it has refused it.
const ANSWER: Time = Time::from_millis(100);

/// Error numbers of the block; those from 100 on are those of the NCK.
const SEVERAL_FUNCTIONS: u8 = 1;
const STARTED_TOO_EARLY: u8 = 20;
const GIVEN_AWAY: u8 = 30;
const NOT_AVAILABLE: u8 = 40;
const WRONG_VALUE: u8 = 100;

/// The inputs of a call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpinCtrlInputs {
    /// Starts with its rising edge; stays until InPos or Error.
    pub start: bool,
    /// Its rising edge stops.
    pub stop: bool,
    /// 1, 2, 3 position, rotate, oscillate a spindle; 4 indexing axis; 5, 6 positioning axis in mm, inch; 7, 8 the same with handwheel override; 9,
    /// 10, 11 rotate with automatic gear stage, with constant cutting rate in m/min, in feet/min.
    pub function: u8,
    /// 0 absolute, 1 incremental, 2 shortest way, 3 from plus, 4 from minus; 5 direction of rotation as M4.
    pub mode: u8,
    /// The axis.
    pub axis: AxisNumber,
    /// The target in mm or degrees, or inches.
    pub position: f32,
    /// The velocity in mm/min or rev/min, or inches/min; 0 or less: MD32060.
    pub feedrate: f32,
}

/// The outputs of a call.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SpinCtrlOutputs {
    /// The target is reached.
    pub in_position: bool,
    /// An error has ended the function, or prevents it.
    pub error: bool,
    /// Its number; 0 without an error.
    pub state: u8,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
enum Step {
    #[default]
    Idle,
    /// Waits for 68.7, since this time.
    Requests(Time),
    /// The start bit is set, and the NCK has not answered yet.
    Starts,
    /// The NCK positions the axis.
    Runs,
    /// InPos, or Error with its number.
    Done(u8),
    /// Start is 0, and the spindle rotates or oscillates on.
    Turns,
    /// Stopped by Stop: waits for Start = 0.
    Stopped,
    /// The start bit is 0, and the axis brakes.
    Ends,
    /// Gives the axis back: 8.4 rises in the next scan, and falls in the one after it.
    GivesBack,
    GivenBack,
}

/// FC 18: one for each axis, called once per scan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SpinCtrl {
    step: Step,
    start_was: bool,
    stop_was: bool,
    /// The block has requested the axis, and gives it back.
    requested: bool,
    /// The function lets a spindle rotate or oscillate.
    turns: bool,
}

impl SpinCtrl {
    /// One call.
    pub fn scan(&mut self, io: &mut PlcIo<'_>, inputs: &SpinCtrlInputs) -> SpinCtrlOutputs {
        self.run(&mut io.link(), inputs)
    }

    /// One call, for a block that has only a part of the memory.
    pub fn run(&mut self, io: &mut Link<'_>, inputs: &SpinCtrlInputs) -> SpinCtrlOutputs {
        let starts = inputs.start && !std::mem::replace(&mut self.start_was, inputs.start);
        self.start_was = inputs.start;
        if matches!(self.step, Step::GivesBack | Step::GivenBack) {
            // A Start that comes now counts when the axis is given back.
            self.start_was = false;
        }
        let stops = inputs.stop && !std::mem::replace(&mut self.stop_was, inputs.stop);
        self.stop_was = inputs.stop;
        let axis = inputs.axis;
        let turns = self.turns && matches!(self.step, Step::Starts | Step::Runs | Step::Done(0) | Step::Turns);
        if turns && stops {
            stop(io, axis);
            stop_turning(io, axis);
            self.step = if inputs.start { Step::Stopped } else { Step::Ends };
        } else if turns && !inputs.start && self.step != Step::Starts {
            stop(io, axis);
            self.step = Step::Turns;
        } else if !inputs.start && !matches!(self.step, Step::Idle | Step::Ends | Step::GivesBack | Step::GivenBack) {
            stop(io, axis);
            if self.turns && self.step == Step::Starts {
                stop_turning(io, axis);
            }
            self.step = Step::Ends;
        } else if stops && matches!(self.step, Step::Requests(_) | Step::Starts | Step::Runs) {
            stop(io, axis);
            self.step = Step::Stopped;
        }
        match self.step {
            Step::Idle | Step::Turns if starts => self.begin(io, inputs),
            Step::Done(0) if self.turns => self.watch(io, axis),
            Step::Turns if !io.from_nck.axis(axis).positioning_active() => self.step = Step::Ends,
            Step::Idle | Step::Done(_) | Step::Stopped | Step::Turns => {}
            Step::Requests(since) => self.wait_for_axis(io, inputs, since),
            Step::Starts | Step::Runs => self.watch(io, axis),
            Step::Ends if starts => self.step = Step::Done(STARTED_TOO_EARLY),
            Step::Ends => self.end(io, axis),
            Step::GivesBack => {
                io.to_nck.axis(axis).set_replacement_activation_signal(true);
                (self.step, self.requested) = (Step::GivenBack, false);
            }
            Step::GivenBack => {
                io.to_nck.axis(axis).set_replacement_activation_signal(false);
                self.step = Step::Idle;
            }
        }
        let error = if let Step::Done(error) = self.step { error } else { 0 };
        let in_position = self.step == Step::Done(0);
        SpinCtrlOutputs { in_position, error: error != 0, state: error }
    }

    fn begin(&mut self, io: &mut Link<'_>, inputs: &SpinCtrlInputs) {
        let of_axis = matches!(inputs.function, 4..=8);
        self.turns = matches!(inputs.function, 2 | 3 | 9..=11);
        if !matches!(inputs.function, 1..=11) {
            self.step = Step::Done(SEVERAL_FUNCTIONS);
        } else if inputs.mode > 5 || of_axis && inputs.mode == 5 {
            self.step = Step::Done(WRONG_VALUE);
        } else if io.from_nck.axis(inputs.axis).plc_axis() {
            self.start(io, inputs);
        } else {
            let signals = io.to_nck.axis(inputs.axis);
            signals.set_replacement_channel_number(0);
            signals.set_request_plc_axis(true);
            signals.set_replacement_activation_signal(true);
            (self.step, self.requested) = (Step::Requests(io.time), true);
        }
    }

    fn wait_for_axis(&mut self, io: &mut Link<'_>, inputs: &SpinCtrlInputs, since: Time) {
        let shown = io.from_nck.axis(inputs.axis);
        if shown.plc_axis() {
            io.to_nck.axis(inputs.axis).set_replacement_activation_signal(false);
            self.start(io, inputs);
        } else if !shown.axis_replacement_requested() && io.time - since >= ANSWER {
            let signals = io.to_nck.axis(inputs.axis);
            signals.set_replacement_activation_signal(false);
            signals.set_request_plc_axis(false);
            (self.step, self.requested) = (Step::Done(NOT_AVAILABLE), false);
        }
    }

    /// Writes the target and the start bit.
    fn start(&mut self, io: &mut Link<'_>, inputs: &SpinCtrlInputs) {
        let (function, mode) = (inputs.function, inputs.mode);
        let signals = io.to_nck.axis(inputs.axis);
        signals.set_incremental_position(mode == 1);
        signals.set_shortest_distance(mode == 2);
        signals.set_approach_in_plus_direction(mode == 3);
        signals.set_approach_in_minus_direction(mode == 4);
        signals.set_direction_of_rotation_as_m4(mode == 5);
        signals.set_indexing_position(function == 4);
        signals.set_position_in_inches(matches!(function, 6 | 8));
        signals.set_positioning_with_handwheel_override(matches!(function, 7 | 8));
        signals.set_automatic_gear_selection(function == 9);
        signals.set_constant_cutting_rate(matches!(function, 10 | 11));
        signals.set_stop_spindle_rotation(false);
        signals.set_stop_spindle_oscillation(false);
        signals.set_positioning_target(inputs.position);
        signals.set_positioning_feedrate(inputs.feedrate);
        match function {
            1 => signals.set_start_spindle_positioning(true),
            3 => signals.set_start_spindle_oscillation(true),
            2 | 9..=11 => signals.set_start_spindle_rotation(true),
            _ => signals.set_start_positioning_axis(true),
        }
        self.step = Step::Starts;
    }

    /// Until the NCK has reached the position, or has failed.
    fn watch(&mut self, io: &Link<'_>, axis: AxisNumber) {
        let shown = io.from_nck.axis(axis);
        if self.turns && shown.positioning_active() {
            self.step = if shown.position_reached() { Step::Done(0) } else { Step::Runs };
        } else if shown.positioning_active() {
            self.step = Step::Runs;
        } else if shown.position_reached() {
            self.step = Step::Done(0);
        } else if shown.positioning_error() || shown.positioning_not_started() {
            self.step = Step::Done(shown.positioning_error_number());
        } else if self.step == Step::Runs {
            // Delete distance-to-go: neither InPos nor Error.
            self.step = Step::Stopped;
        }
        if matches!(self.step, Step::Starts | Step::Runs) && !shown.plc_axis() {
            self.step = Step::Done(GIVEN_AWAY);
        }
    }

    fn end(&mut self, io: &mut Link<'_>, axis: AxisNumber) {
        if io.from_nck.axis(axis).positioning_active() {
            return;
        }
        self.step = Step::Idle;
        let signals = io.to_nck.axis(axis);
        signals.set_stop_spindle_rotation(false);
        signals.set_stop_spindle_oscillation(false);
        if self.requested {
            signals.set_request_plc_axis(false);
            signals.set_replacement_activation_signal(false);
            self.step = Step::GivesBack;
        }
    }
}

/// All start bits go.
fn stop(io: &mut Link<'_>, axis: AxisNumber) {
    let signals = io.to_nck.axis(axis);
    signals.set_start_positioning_axis(false);
    signals.set_start_spindle_positioning(false);
    signals.set_start_spindle_rotation(false);
    signals.set_start_spindle_oscillation(false);
}

/// The stops of rotation and oscillation come.
fn stop_turning(io: &mut Link<'_>, axis: AxisNumber) {
    let signals = io.to_nck.axis(axis);
    signals.set_stop_spindle_rotation(true);
    signals.set_stop_spindle_oscillation(true);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plc::bench::Bench;

    const INPUTS: SpinCtrlInputs = SpinCtrlInputs {
        start: true,
        stop: false,
        function: 5,
        mode: 0,
        axis: AxisNumber::FIRST,
        position: 120.5,
        feedrate: 1000.0,
    };

    fn call(block: &mut SpinCtrl, bench: &mut Bench, inputs: SpinCtrlInputs) -> (bool, bool, u8) {
        bench.time += Time::from_millis(10);
        let mut io = bench.io();
        let outputs = block.scan(&mut io.typed().unwrap(), &inputs);
        (outputs.in_position, outputs.error, outputs.state)
    }

    /// The bytes of the 828D: DB3800.DBX3000.7 start, 3002.0 incremental, DBD3004 and DBD3008 the REALs 120.5 and 1000.
    #[test]
    fn a_plc_axis_is_started_with_the_bits_of_the_828d() {
        let (mut block, mut bench) = (SpinCtrl::default(), Bench::with_axes(&["X"]));
        bench.set("DB31.DBX68.7", 1);
        assert_eq!(call(&mut block, &mut bench, SpinCtrlInputs { mode: 1, ..INPUTS }), (false, false, 0));
        assert_eq!((bench.get("DB31.DBB32"), bench.get("DB31.DBB34"), bench.get("DB31.DBB35")), (0x80, 0x01, 0));
        let reals = [120.5_f32, 1000.0].map(|value| u64::from(value.to_bits()));
        assert_eq!([bench.get("DB31.DBD36"), bench.get("DB31.DBD40")], reals);
        bench.set("DB31.DBB104", 0x80);
        assert_eq!(call(&mut block, &mut bench, INPUTS), (false, false, 0));
        bench.set("DB31.DBB104", 0x40);
        assert_eq!(call(&mut block, &mut bench, INPUTS), (true, false, 0));
        assert_eq!(call(&mut block, &mut bench, SpinCtrlInputs { start: false, ..INPUTS }), (false, false, 0));
        assert_eq!(bench.get("DB31.DBB32"), 0, "the start bit goes with Start");
    }

    #[test]
    fn an_axis_of_a_program_is_requested_and_given_back() {
        let (mut block, mut bench) = (SpinCtrl::default(), Bench::with_axes(&["X"]));
        let off = SpinCtrlInputs { start: false, ..INPUTS };
        call(&mut block, &mut bench, INPUTS);
        assert_eq!((bench.get("DB31.DBB8"), bench.get("DB31.DBB32")), (0x90, 0), "8.7 and 8.4");
        bench.set("DB31.DBX68.7", 1);
        call(&mut block, &mut bench, INPUTS);
        assert_eq!((bench.get("DB31.DBB8"), bench.get("DB31.DBB32")), (0x80, 0x80));
        call(&mut block, &mut bench, off);
        assert_eq!((bench.get("DB31.DBB8"), bench.get("DB31.DBB32")), (0, 0));
        call(&mut block, &mut bench, off);
        assert_eq!(bench.get("DB31.DBB8"), 0x10, "the edge of 8.4 with 8.7 = 0");
        bench.set("DB31.DBX68.7", 0);
        call(&mut block, &mut bench, INPUTS);
        assert_eq!(bench.get("DB31.DBB8"), 0, "8.4 falls");
        call(&mut block, &mut bench, INPUTS);
        assert_eq!(bench.get("DB31.DBB8"), 0x90, "the next Start requests it again");
    }

    /// A request that shows neither 68.4 nor 68.7 after 100 ms, ten scans, was refused: State 40.
    #[test]
    fn a_refused_request_is_error_40() {
        let (mut block, mut bench) = (SpinCtrl::default(), Bench::with_axes(&["X"]));
        let mut found = (false, false, 0);
        for _ in 0..10 {
            found = call(&mut block, &mut bench, INPUTS);
            assert_eq!(found, (false, false, 0));
        }
        assert_eq!(call(&mut block, &mut bench, INPUTS), (false, true, 40), "after {found:?}");
    }

    #[test]
    fn errors_of_the_nck_stop_and_a_start_too_early_are_shown() {
        let (mut block, mut bench) = (SpinCtrl::default(), Bench::with_axes(&["X"]));
        let off = SpinCtrlInputs { start: false, ..INPUTS };
        bench.set("DB31.DBX68.7", 1);
        call(&mut block, &mut bench, INPUTS);
        bench.set("DB31.DBB104", 0x01);
        bench.set("DB31.DBB107", 130);
        assert_eq!(call(&mut block, &mut bench, INPUTS), (false, true, 130));
        bench.set("DB31.DBB104", 0);
        assert_eq!(call(&mut block, &mut bench, off), (false, false, 0));
        // Start falls in motion; the next Start comes while the axis still brakes.
        call(&mut block, &mut bench, INPUTS);
        bench.set("DB31.DBB104", 0x80);
        call(&mut block, &mut bench, INPUTS);
        call(&mut block, &mut bench, off);
        assert_eq!(call(&mut block, &mut bench, INPUTS), (false, true, 20));
        bench.set("DB31.DBB104", 0);
        call(&mut block, &mut bench, off);
        // Stop: neither InPos nor Error.
        call(&mut block, &mut bench, INPUTS);
        assert_eq!(call(&mut block, &mut bench, SpinCtrlInputs { stop: true, ..INPUTS }), (false, false, 0));
        assert_eq!(bench.get("DB31.DBB32"), 0);
        for function in [0, 12] {
            let mut block = SpinCtrl::default();
            assert_eq!(call(&mut block, &mut bench, SpinCtrlInputs { function, ..INPUTS }), (false, true, 1));
        }
        assert_eq!(
            call(&mut SpinCtrl::default(), &mut bench, SpinCtrlInputs { mode: 5, ..INPUTS }),
            (false, true, 100)
        );
    }
}
