//! What happens to a machine in addition to changes of its memory: power on, machine data, faults, operator keys, selected programs. Each is a row of the
//! trace, and the events that follow from it name it as their cause.

use serde::{Deserialize, Serialize};

use super::{Place, ProgramName, ShortText};
use crate::units::{AxisNumber, ChannelNumber};

/// The name of a kind of fault, as scenarios write it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum FaultName {
    /// The slide cannot move.
    Block,
    /// The slide was displaced.
    Push,
    /// An encoder gained or lost counts.
    EncoderSlip,
    /// The encoders send no zero marks.
    ZeroMarkMissing,
    /// The drive reports a fault.
    DriveFault,
    /// An encoder sends no values.
    EncoderFault,
    /// The motor is slower than its command.
    Friction,
    /// The slide moves without power.
    Drift,
    /// A switch is stuck.
    SwitchStuck,
    /// The slide is held away from where its drive wants it.
    Hold,
    /// The slide was moved while its drive was off.
    MovedByHand,
    /// The drive is not ready.
    DriveNotReady,
}

impl FaultName {
    /// The name in a scenario: `encoder_slip`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Block => "block",
            Self::Push => "push",
            Self::EncoderSlip => "encoder_slip",
            Self::ZeroMarkMissing => "zero_mark_missing",
            Self::DriveFault => "drive_fault",
            Self::EncoderFault => "encoder_fault",
            Self::Friction => "friction",
            Self::Drift => "drift",
            Self::SwitchStuck => "switch_stuck",
            Self::Hold => "hold",
            Self::MovedByHand => "moved_by_hand",
            Self::DriveNotReady => "drive_not_ready",
        }
    }
}

/// A machine datum or parameter with a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DatumValue {
    /// Its number.
    pub number: u32,
    /// Its owner.
    pub place: Place,
    /// Its index; `None` for a datum with one value.
    pub index: Option<u8>,
    /// The value; `None` if it is a text.
    pub value: Option<f64>,
    /// The word of a parameter that is none of numbers.
    pub word: Option<ShortText>,
}

/// What happened. It consists of numbers; the trace prints it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Happening {
    /// Power off and on. The power on with which a machine opens is the start of its trace and no row of it.
    PowerOn,
    /// A machine datum was written and waits until its class becomes active. One that becomes active in the same cycle has only that row.
    DatumStored(DatumValue),
    /// A machine datum became active.
    DatumActive(DatumValue),
    /// "Set machine data active".
    DataSetActive,
    /// A fault began or ended.
    Fault {
        /// The axis.
        axis: AxisNumber,
        /// The kind.
        name: FaultName,
        /// Its amount: a distance, a velocity in units per minute, a share.
        by: Option<f64>,
        /// Whether it began.
        begins: bool,
    },
    /// The operator's alarm-cancel key.
    CancelKey,
    /// A handwheel began to turn.
    HandwheelTurned {
        /// Its number, from 1.
        number: u8,
        /// The pulses, with sign.
        pulses: i32,
    },
    /// The NC program of a channel was selected.
    ProgramSelected {
        /// The channel.
        channel: ChannelNumber,
        /// The name of the program.
        program: ProgramName,
    },
    /// Blocks were entered for manual data input (MDA).
    BlocksEntered {
        /// The channel.
        channel: ChannelNumber,
    },
    /// The PLC stopped.
    PlcStopped,
    /// The PLC restarted.
    PlcStarted,
    /// The PLC restarted with its initial memory.
    PlcColdRestart,
}
