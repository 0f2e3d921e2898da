//! Terms that only some controls fill: counts of messages, active coupling groups, parameters in effect.

use super::view::Moment;
use crate::units::ChannelNumber;
use crate::variables::{AlarmNumber, Describe, MessageCount, Place, ShortText, place_name};

/// What an expression asks a control.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum OfControl {
    /// `message(21111, ax8)`: how many of these there have been.
    Message(AlarmNumber, Option<Place>),
    /// `warnings()`, `errors(ax5)`.
    Messages { warnings: bool, place: Option<Place> },
    /// `active_group(2, channel_1)`.
    ActiveGroup(u8, ChannelNumber),
    /// `parameter(ax5, 'getriebe[0].dynamik.a_max')`, or whether it is a word.
    Parameter { number: u32, index: [u16; 2], place: Place, name: String, word: Option<ShortText> },
}

impl OfControl {
    pub(super) fn value(&self, now: &Moment<'_>) -> f64 {
        let count = |counts: &dyn Fn(&MessageCount) -> bool| -> f64 {
            f64::from(now.variables.messages.iter().filter(|count| counts(count)).map(|count| count.count).sum::<u32>())
        };
        let is_of = |count: &MessageCount, place: &Option<Place>| {
            place.is_none_or(|place| count.place == place || count.other.map(Place::Axis) == Some(place))
        };
        match self {
            Self::Message(number, place) => count(&|count| count.number == *number && is_of(count, place)),
            Self::Messages { warnings, place } => count(&|count| count.is_warning == *warnings && is_of(count, place)),
            Self::ActiveGroup(group, channel) => {
                f64::from(now.variables.channels[*channel].coupling_groups >> *group & 1)
            }
            Self::Parameter { number, index, place, word, .. } => {
                let key = (*number, *index, *place);
                let mut values = now.variables.parameters.iter();
                let found = values.find(|value| (value.number, value.index, value.place) == key);
                match (found, word) {
                    (None, _) => f64::NAN,
                    (Some(value), None) => value.value,
                    (Some(value), Some(word)) => f64::from(u8::from(value.word == Some(*word))),
                }
            }
        }
    }

    /// The term as users write it.
    pub(super) fn name(&self, describe: &dyn Describe) -> String {
        let names = describe.names();
        let of = |place: &Option<Place>| place.map_or_else(String::new, |place| place_name(place, names));
        match self {
            Self::Message(number, None) => format!("message({})", describe.alarm_name(*number)),
            Self::Message(number, place) => format!("message({}, {})", describe.alarm_name(*number), of(place)),
            Self::Messages { warnings: true, place } => format!("warnings({})", of(place)),
            Self::Messages { warnings: false, place } => format!("errors({})", of(place)),
            Self::ActiveGroup(group, channel) => {
                format!("active_group({group}, {})", place_name(Place::Channel(*channel), names))
            }
            Self::Parameter { place, name, word: None, .. } => {
                format!("parameter({}, '{name}')", place_name(*place, names))
            }
            Self::Parameter { place, name, word: Some(word), .. } => {
                format!("parameter({}, '{name}', '{word}')", place_name(*place, names))
            }
        }
    }
}
