//! Why a command of a program is refused: its message and what the message names.

use super::messages;
use super::pending::Detail;
use crate::units::AxisNumber;
use crate::variables::AlarmNumber;

/// A refused command: the message, and its third and fourth parameter.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Refused(pub AlarmNumber, pub Detail, pub Detail);

impl Refused {
    pub(super) const fn new(number: AlarmNumber) -> Self {
        Self(number, Detail::None, Detail::None)
    }

    pub(super) const fn axis(number: AlarmNumber, axis: AxisNumber) -> Self {
        Self(number, Detail::Axis(axis), Detail::None)
    }

    pub(super) fn group(number: AlarmNumber, group: i64) -> Self {
        Self(number, Detail::Number(group), Detail::None)
    }
}

/// A value that is not possible.
pub(super) fn value(text: &str) -> Refused {
    Refused(messages::NC_VALUE, Detail::Text(text.to_owned()), Detail::None)
}

/// An axis that the channel does not have.
pub(super) fn unknown(name: &str) -> Refused {
    Refused(messages::AXIS_UNKNOWN, Detail::Text(format!("the channel has no axis {name}")), Detail::None)
}
