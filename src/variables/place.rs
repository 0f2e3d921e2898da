//! The places of a control: itself, its mode groups, channels and machine axes.

use serde::{Deserialize, Serialize};

use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber};

/// Whose it is: the place of an alarm, of an event, of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Place {
    /// The whole control.
    Nck,
    /// A mode group.
    ModeGroup(ModeGroupNumber),
    /// A channel.
    Channel(ChannelNumber),
    /// A machine axis.
    Axis(AxisNumber),
}
