//! The active user alarms, and the values that the PLC requests.

use serde::{Deserialize, Serialize};

use crate::image::user_alarm;
use crate::sinumerik::inputs::nck_signal;
use crate::variables::{EventId, Input};

/// The first user alarm.
pub(in crate::sinumerik) const FIRST_ALARM: u32 = 700_000;

/// A reaction of a user alarm: the number of its bit in MD14516 and in DB1600.DBB2000.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sinumerik) enum UserReaction {
    /// NC start disable.
    NcStart,
    /// Read-in disable.
    ReadIn,
    /// Feed disable of all axes.
    Feed,
    /// Emergency stop.
    EmergencyStop,
    /// PLC stop.
    PlcStop,
}

impl UserReaction {
    /// All reactions, in the order of their bits.
    pub(in crate::sinumerik) const ALL: [Self; 5] =
        [Self::NcStart, Self::ReadIn, Self::Feed, Self::EmergencyStop, Self::PlcStop];
}

/// An active user alarm.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct ActiveAlarm {
    /// Its number from 700000 on.
    pub index: u8,
    /// Its variable when it began.
    pub variable: i32,
    /// The event with which it began.
    pub cause: EventId,
}

/// A message that the PLC program shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct PlcMessage {
    /// Its number.
    pub number: u32,
    /// The event with which it began.
    pub cause: EventId,
}

/// The user alarms, and the values that the PLC requests.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct User {
    /// The active alarms, ascending.
    pub active: Vec<ActiveAlarm>,
    /// The first active alarm with each reaction.
    pub reactions: [Option<ActiveAlarm>; 5],
    /// The event with which the last alarm ended.
    pub ended: EventId,
    /// DB2600.DBX1.1 and 1.2: the PLC requests actual values, and distances to go.
    pub requests: [bool; 2],
    /// The messages of the PLC program, in the order in which they came.
    pub messages: Vec<PlcMessage>,
}

impl User {
    /// The first active alarm with a reaction.
    #[must_use]
    pub(in crate::sinumerik) fn alarm(&self, reaction: UserReaction) -> Option<u32> {
        self.reactions[reaction as usize].map(|alarm| FIRST_ALARM + u32::from(alarm.index))
    }

    /// The first active alarm with a reaction, as an input.
    #[must_use]
    pub(in crate::sinumerik) fn input(&self, reaction: UserReaction) -> Option<Input> {
        self.alarm(reaction).map(Input::Alarm)
    }
}

/// The input that says that a user alarm has ended: the PLC has reset its bit.
#[must_use]
pub(in crate::sinumerik) fn ended(number: u32) -> Input {
    let index = number.checked_sub(FIRST_ALARM).and_then(|index| u8::try_from(index).ok());
    index.map_or(Input::None, |index| nck_signal(user_alarm(index), false))
}
