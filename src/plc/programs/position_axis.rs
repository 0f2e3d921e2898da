//! `position_axis`: enables every axis, and positions one by FC 18 (SpinCtrl). Flags are its inputs and outputs:
//!
//! | flag | meaning |
//! |---|---|
//! | M120.0, M120.1 | Start, Stop |
//! | MB121, MB122 | Funct (5: mm), Mode (0: absolute, 1: incremental, 2: shortest way, 3: in plus, 4: in minus direction) |
//! | MW124 | AxisNo, 1 to 31 |
//! | MD126, MD130 | Pos and FRate, as REAL, of a rotary axis degrees and rev/min; FRate of 0 or less: MD32060 |
//! | M134.0, M134.1 | InPos, Error |
//! | MB135 | State |
//!
//! The number of the axis is taken over while Start is 0. A number without an axis ends with Error and State 100.

use serde::{Deserialize, Serialize};

use crate::plc::{ClosureProgram, SpinCtrl, SpinCtrlInputs, program};
use crate::units::AxisNumber;

use super::enable_all::enable;

const STARTS: usize = 120;
const FUNCTION: usize = 121;
const MODE: usize = 122;
const AXIS: usize = 124;
const POSITION: usize = 126;
const FEEDRATE: usize = 130;
const RESULTS: usize = 134;
const STATE: usize = 135;

/// State: a wrong value, as for a position or a feed that is none.
const NO_AXIS: u8 = 100;

/// The state: FC 18, and the axis that it positions.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct PositionAxis {
    block: SpinCtrl,
    axis: Option<AxisNumber>,
}

/// Enables every axis; FC 18 positions the axis that flags name.
#[must_use]
pub fn position_axis() -> ClosureProgram<PositionAxis> {
    program("position_axis", PositionAxis::default(), |state, io| {
        enable(io);
        let start = io.flags.bit(STARTS, 0);
        if !start || state.axis.is_none() {
            state.axis = u8::try_from(io.flags.word(AXIS))
                .ok()
                .and_then(AxisNumber::new)
                .filter(|axis| io.axes().any(|known| known == *axis));
        }
        let Some(axis) = state.axis else {
            io.flags.set_bit(RESULTS, 0, false);
            io.flags.set_bit(RESULTS, 1, start);
            io.flags.set_byte(STATE, if start { NO_AXIS } else { 0 });
            return;
        };
        let real = |at: usize| io.flags.real(at);
        let inputs = SpinCtrlInputs {
            start,
            stop: io.flags.bit(STARTS, 1),
            function: io.flags.byte(FUNCTION),
            mode: io.flags.byte(MODE),
            axis,
            position: real(POSITION),
            feedrate: real(FEEDRATE),
        };
        let outputs = state.block.scan(io, &inputs);
        io.flags.set_bit(RESULTS, 0, outputs.in_position);
        io.flags.set_bit(RESULTS, 1, outputs.error);
        io.flags.set_byte(STATE, outputs.state);
    })
}
