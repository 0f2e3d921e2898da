//! Commands to a machine from outside. A command is checked when it is queued and takes effect at the edge of the next step.

use serde::{Deserialize, Serialize};

use super::Fault;
use crate::control::FunctionGenerator;
use crate::control::SearchKind;
use crate::control::Value;
use crate::image::Location;
use crate::units::{AxisNumber, ChannelNumber};

/// A command to a machine from outside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Command {
    /// Writes bits once.
    Write {
        /// The bits.
        location: Location,
        /// Raw value.
        value: u64,
    },
    /// Writes bits after every PLC scan, until released.
    Force {
        /// The bits.
        location: Location,
        /// Raw value.
        value: u64,
    },
    /// Ends every force that shares a bit with this location.
    Release {
        /// The bits.
        location: Location,
    },
    /// Stores a machine datum. It takes effect as its class defines.
    MachineDatum {
        /// `34090[XF]`, `34100[2,XF]`, `11300`, an identifier.
        target: String,
        /// Its value.
        value: Value,
    },
    /// Writes an R parameter.
    RParameter {
        /// The channel.
        channel: ChannelNumber,
        /// `R number`.
        number: u16,
        /// Its value.
        value: f64,
    },
    /// Selects the NC program of a channel, which must be in memory ([`Machine::load_programs`](super::Machine::load_programs)).
    SelectProgram {
        /// The channel.
        channel: ChannelNumber,
        /// Its path among the programs in memory.
        path: String,
    },
    /// Gives blocks to a channel, for manual data input (MDA).
    EnterBlocks {
        /// The channel.
        channel: ChannelNumber,
        /// The blocks, one a line.
        text: String,
    },
    /// Gives an axis another actual value at the place where it stands (PRESET).
    Preset {
        /// The axis.
        axis: AxisNumber,
        /// Its new actual value, in millimetres or degrees.
        value: f64,
    },
    /// Searches a block of the selected program, from which the program goes on.
    Search {
        /// The channel.
        channel: ChannelNumber,
        /// The block: `N50`, `:50`, or a label.
        block: String,
        /// How.
        kind: SearchKind,
    },
    /// Gives the function generator a signal for an axis. NC start in JOG begins it.
    FunctionGenerator(FunctionGenerator),
    /// "Set machine data active".
    NewConf,
    /// Power off and on.
    PowerOn,
    /// The PLC stops: its outputs are 0, and so are its signals to a SINUMERIK.
    PlcStop,
    /// The PLC restarts: OB100, then OB1.
    PlcRun,
    /// The PLC restarts from the beginning: flags, timers, counters, outputs, its own blocks and its half of the interface return to their
    /// initial values, and the program starts again.
    PlcColdRestart,
    /// The operator's alarm-cancel key.
    Cancel,
    /// Turns a handwheel. The pulses are spread evenly over the cycles.
    Handwheel {
        /// Number, 1 to 3.
        number: u8,
        /// Number of pulses, with sign.
        pulses: i32,
        /// Duration in cycles.
        cycles: u64,
    },
    /// Causes a fault.
    Fault(Fault),
    /// Clears a fault.
    ClearFault(Fault),
}

impl Command {
    /// The bits that it writes, forces or releases.
    #[must_use]
    pub const fn location(&self) -> Option<Location> {
        match self {
            Self::Write { location, .. } | Self::Force { location, .. } | Self::Release { location } => Some(*location),
            Self::MachineDatum { .. }
            | Self::RParameter { .. }
            | Self::SelectProgram { .. }
            | Self::EnterBlocks { .. }
            | Self::Preset { .. }
            | Self::Search { .. }
            | Self::FunctionGenerator(_)
            | Self::NewConf
            | Self::PowerOn
            | Self::PlcStop
            | Self::PlcRun
            | Self::PlcColdRestart
            | Self::Cancel
            | Self::Handwheel { .. }
            | Self::Fault(_)
            | Self::ClearFault(_) => None,
        }
    }

    /// The operating state of the PLC that it orders.
    #[must_use]
    pub const fn plc_order(&self) -> Option<PlcOrder> {
        match self {
            Self::PlcStop => Some(PlcOrder::Stop),
            Self::PlcRun => Some(PlcOrder::WarmRestart),
            Self::PlcColdRestart => Some(PlcOrder::ColdRestart),
            Self::Write { .. }
            | Self::Force { .. }
            | Self::Release { .. }
            | Self::MachineDatum { .. }
            | Self::RParameter { .. }
            | Self::SelectProgram { .. }
            | Self::EnterBlocks { .. }
            | Self::Preset { .. }
            | Self::Search { .. }
            | Self::FunctionGenerator(_)
            | Self::NewConf
            | Self::PowerOn
            | Self::Cancel
            | Self::Handwheel { .. }
            | Self::Fault(_)
            | Self::ClearFault(_) => None,
        }
    }
}

/// What a command orders the PLC to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlcOrder {
    /// STOP.
    Stop,
    /// OB100, then OB1; the memory stays.
    WarmRestart,
    /// The same with the initial memory.
    ColdRestart,
}
