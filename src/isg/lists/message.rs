//! Messages that the start-up checks give: a published number, or the ID of a parameter where no number is published (O-18).

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::source::Place;

use super::parameter::id;

/// What a message is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Code {
    /// A published number: 21020.
    Number(u32),
    /// The number of the parameter that is out of its range, or was taken from the master: 72 for 'P-AXIS-00072'.
    Parameter(u32),
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => number.fmt(f),
            Self::Parameter(number) => f.pad(&id(*number)),
        }
    }
}

/// Reaction class 1: a warning.
pub const WARNING: u8 = 1;
/// Reaction class 3: the value is not used as it stands.
pub const ERROR: u8 = 3;

/// A message of the control at time 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Message {
    /// Its number or name.
    pub code: Code,
    /// Its reaction class: [`WARNING`] or [`ERROR`].
    pub class: u8,
    /// The axis that it is about: of a pair, the slave.
    pub axis: Option<u16>,
    /// The other axis of a pair.
    pub other_axis: Option<u16>,
    /// The channel that it is about.
    pub channel: Option<u16>,
    /// What was found, what is allowed and which value is used, with ID, file and line.
    pub text: String,
    /// The entry, or the list without the entry.
    #[serde(with = "super::place")]
    pub place: Place,
}

impl Message {
    /// Whether it is a warning; all others are errors.
    #[must_use]
    pub const fn is_warning(&self) -> bool {
        self.class == WARNING
    }

    /// A message about an axis. The place is added to the text.
    pub(super) fn new(code: Code, class: u8, place: &Place, text: &str) -> Self {
        let text = format!("{text} ({})", short(place));
        Self { code, class, axis: None, other_axis: None, channel: None, text, place: place.clone() }
    }

    pub(super) fn of_axis(self, axis: u16) -> Self {
        Self { axis: Some(axis), ..self }
    }

    pub(super) fn with_axis(self, other: u16) -> Self {
        Self { other_axis: Some(other), ..self }
    }

    pub(super) fn of_channel(self, channel: u16) -> Self {
        Self { channel: Some(channel), ..self }
    }
}

/// `21020 axis 5 …`
impl fmt::Display for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.code {
            Code::Number(number) => write!(f, "{number} {}", self.text),
            // The text begins with the ID.
            Code::Parameter(_) => f.write_str(&self.text),
        }
    }
}

/// The name of a file without its folders, and the line.
pub(super) fn short(place: &Place) -> String {
    let place = place.to_string();
    place.rsplit(['/', '\\']).next().unwrap_or_default().to_owned()
}
