//! What clients ask of the machine.

use crate::image::Location;
use crate::s7::station::Restart;
use crate::s7::wire::date_and_time::DateAndTime;
use crate::units::ChannelNumber;
use crate::variables::Place;

/// What a client asks of the machine, for the edge of its next step.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Writes bits once.
    Write {
        /// Which.
        location: Location,
        /// Raw value.
        value: u64,
    },
    /// Stores a machine datum.
    MachineDatum {
        /// Whose.
        place: Place,
        /// Its number.
        number: u16,
        /// The index in its array, from 0.
        index: u16,
        /// Its value.
        value: f64,
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
    /// The PLC stops.
    PlcStop,
    /// The PLC restarts.
    PlcStart(Restart),
    /// The clock of the CPU is set.
    SetClock(DateAndTime),
}
