//! What can be done to a machine from outside. A command is checked when it is queued and acts at the edge of the next step.

use serde::{Deserialize, Serialize};

use super::Fault;
use crate::control::Value;
use crate::image::Location;
use crate::units::ChannelNumber;

/// Something that is done to a machine from outside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Command {
    /// Writes bits once.
    Write {
        /// Which.
        location: Location,
        /// Raw value.
        value: u64,
    },
    /// Writes bits after every PLC scan, until released.
    Force {
        /// Which.
        location: Location,
        /// Raw value.
        value: u64,
    },
    /// Ends every force that shares a bit with this place.
    Release {
        /// Where.
        location: Location,
    },
    /// Stores a machine datum, which acts when its class says.
    MachineDatum {
        /// `34090[XF]`, `34100[2,XF]`, `11300`, an identifier.
        target: String,
        /// Its value.
        value: Value,
    },
    /// Writes an R parameter.
    RParameter {
        /// Whose.
        channel: ChannelNumber,
        /// `R number`.
        number: u16,
        /// Its value.
        value: f64,
    },
    /// "Set machine data active".
    NewConf,
    /// Power off and on.
    PowerOn,
    /// The PLC stops.
    PlcStop,
    /// The PLC restarts: OB100, then OB1.
    PlcRun,
    /// The PLC restarts from the beginning: flags, timers, counters, outputs, own blocks and its half of the interface have their first
    /// values again, and so has its program.
    PlcColdRestart,
    /// The operator's alarm-cancel key.
    Cancel,
    /// Somebody turns a handwheel; the pulses spread evenly over the cycles.
    Handwheel {
        /// 1 to 3.
        number: u8,
        /// How far, with its sign.
        pulses: i32,
        /// How long it takes.
        cycles: u64,
    },
    /// Something breaks.
    Fault(Fault),
    /// Something is repaired.
    ClearFault(Fault),
}
