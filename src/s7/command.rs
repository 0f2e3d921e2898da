//! The commands that clients give to the machine.

use crate::image::Location;
use crate::s7::station::Restart;
use crate::s7::wire::date_and_time::DateAndTime;
use crate::units::ChannelNumber;
use crate::variables::Place;

/// A command of a client, to be executed at the start of the next step.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Writes bits once.
    Write {
        /// The address.
        location: Location,
        /// Raw value.
        value: u64,
    },
    /// Stores a machine datum.
    MachineDatum {
        /// The NCK, mode group, channel or axis that has the datum.
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
        /// The channel.
        channel: ChannelNumber,
        /// The number: `5` for `R5`.
        number: u16,
        /// Its value.
        value: f64,
    },
    /// Stops the PLC.
    PlcStop,
    /// Restarts the PLC.
    PlcStart(Restart),
    /// Sets the clock of the CPU.
    SetClock(DateAndTime),
}
