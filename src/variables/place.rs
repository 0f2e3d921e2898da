//! The places of a control: the control itself, its mode groups, channels and machine axes, and their names.

use serde::{Deserialize, Serialize};

use crate::image::{Block, Names};
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber};

/// The owner of an alarm, an event or a signal.
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

impl Place {
    /// The place that owns a block of the interface; `None` for an invalid number.
    #[must_use]
    pub fn of_block(block: Block, number: u8) -> Option<Self> {
        Some(match block {
            Block::Nck => Self::Nck,
            Block::ModeGroup => Self::ModeGroup(ModeGroupNumber::new(number)?),
            Block::Channel => Self::Channel(ChannelNumber::new(number)?),
            Block::Axis => Self::Axis(AxisNumber::new(number)?),
        })
    }

    /// The block of the interface that the place owns: its kind and its number.
    #[must_use]
    pub fn block(self) -> (Block, u8) {
        match self {
            Self::Nck => (Block::Nck, 1),
            Self::ModeGroup(group) => (Block::ModeGroup, group.number()),
            Self::Channel(channel) => (Block::Channel, channel.number()),
            Self::Axis(axis) => (Block::Axis, axis.number()),
        }
    }
}

/// The name of a place: `X`, `CHAN1`, `mode_group_1`, `nck`.
#[must_use]
pub fn place_name(place: Place, names: &Names) -> String {
    let (block, number) = place.block();
    if let Some(name) = names.owner(block, number) {
        return name.to_owned();
    }
    match place {
        Place::Nck => "nck".to_owned(),
        Place::ModeGroup(group) => format!("mode_group_{group}"),
        Place::Channel(channel) => format!("CHAN{channel}"),
        Place::Axis(axis) => axis_name(axis, names),
    }
}

/// The name of a machine axis; `AX` and its number if it has no name.
#[must_use]
pub fn axis_name(axis: AxisNumber, names: &Names) -> String {
    names.axes[axis].clone().unwrap_or_else(|| format!("AX{axis}"))
}
