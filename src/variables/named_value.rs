//! The names of all values in scenarios and traces: `X.position`, `CHAN1.block`, `R5`.

use super::{AxisValue, Place, Variables, place_name};
use crate::image::Names;
use crate::source::{Problem, did_you_mean};
use crate::units::{AxisNumber, ChannelNumber};

/// A value that is not a signal, with its owner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum NamedValue {
    /// `X.position`
    Axis(AxisNumber, AxisValue),
    /// `CHAN1.block`
    Block(ChannelNumber),
    /// `CHAN1.program`, a text.
    Program(ChannelNumber),
    /// `R5`, `R5[CHAN2]`
    RParameter(ChannelNumber, u16),
}

impl NamedValue {
    /// The values of a channel: name after the name of the channel, and meaning.
    pub const OF_CHANNEL: [(&'static str, &'static str); 2] = [
        ("block", "The block that runs: its N number, else its line; 0 without a program."),
        ("program", "The program of this block, else the selected one: a text, for `watch` only."),
    ];

    /// The names of the values of a channel.
    pub fn names_of_channel() -> impl Iterator<Item = &'static str> {
        Self::OF_CHANNEL.into_iter().map(|(name, _)| name)
    }

    /// The value with this name; `None` if it is not the name of a value. `count` is the number of R parameters of a channel.
    ///
    /// # Errors
    /// It is an R parameter that the channel does not have.
    pub fn named(name: &str, names: &Names, count: impl Fn(ChannelNumber) -> usize) -> Result<Option<Self>, Problem> {
        if let Some((channel, number)) = r_parameter(name, names)? {
            let own = count(channel);
            return match u16::try_from(number).ok().filter(|number| usize::from(*number) < own) {
                Some(number) => Ok(Some(Self::RParameter(channel, number))),
                None => Err(missing(name, channel, own, names)),
            };
        }
        let Some((head, tail)) = name.rsplit_once('.') else { return Ok(None) };
        if let Some(axis) = names.axis(head) {
            return Ok(AxisValue::named(tail).map(|value| Self::Axis(axis, value)));
        }
        let Some(channel) = names.channel(head) else { return Ok(None) };
        Ok(match tail {
            "block" => Some(Self::Block(channel)),
            "program" => Some(Self::Program(channel)),
            _ => None,
        })
    }

    /// Its name in scenarios and traces.
    #[must_use]
    pub fn name(self, names: &Names) -> String {
        let of_channel = |channel| place_name(Place::Channel(channel), names);
        match self {
            Self::Axis(axis, value) => {
                format!("{}.{}", place_name(Place::Axis(axis), names), value.name(names.interface()))
            }
            Self::Block(channel) => format!("{}.block", of_channel(channel)),
            Self::Program(channel) => format!("{}.program", of_channel(channel)),
            Self::RParameter(ChannelNumber::FIRST, number) => format!("R{number}"),
            Self::RParameter(channel, number) => format!("R{number}[{}]", of_channel(channel)),
        }
    }

    /// Its owner.
    #[must_use]
    pub fn place(self) -> Place {
        match self {
            Self::Axis(axis, _) => Place::Axis(axis),
            Self::Block(channel) | Self::Program(channel) | Self::RParameter(channel, _) => Place::Channel(channel),
        }
    }

    /// The number now; `None` for a text.
    #[must_use]
    pub fn number(self, variables: &Variables) -> Option<f64> {
        match self {
            Self::Axis(axis, value) => Some(value.of(axis, variables)),
            Self::Block(channel) => Some(variables.channels[channel].block.into()),
            Self::Program(_) => None,
            // A machine whose data have changed can have fewer of them than before.
            Self::RParameter(channel, number) => Some(variables.r_parameters.get(channel, number).unwrap_or(0.0)),
        }
    }
}

/// Whether a text is `R5` or begins like `R5[`.
#[must_use]
pub fn is_r_parameter(name: &str) -> bool {
    let digits = name.strip_prefix('R').map(|rest| rest.split('[').next().unwrap_or_default());
    digits.is_some_and(|digits| !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit()))
}

/// Channel and number of an R parameter: `R5` of the first channel, `R5[CHAN2]` of channel 2, also with the name of the channel. `None` if the
/// text is not the name of one.
///
/// # Errors
/// The channel does not exist.
pub fn r_parameter(name: &str, names: &Names) -> Result<Option<(ChannelNumber, u32)>, Problem> {
    if !is_r_parameter(name) {
        return Ok(None);
    }
    let (number, inside) = match name[1..].split_once('[') {
        Some((number, rest)) => (number, rest.strip_suffix(']')),
        None => (&name[1..], Some("")),
    };
    let number = number.parse().unwrap_or(u32::MAX);
    let by_number = |inside: &str| inside.strip_prefix("CHAN")?.parse().ok().and_then(ChannelNumber::new);
    let channel = match inside {
        Some("") if !name.contains('[') => Some(ChannelNumber::FIRST),
        Some(inside) => names.channel(inside).or_else(|| by_number(inside)),
        None => None,
    };
    let Some(channel) = channel else {
        let known: Vec<_> = names.channels.iter().filter_map(|(_, name)| name.as_deref()).collect();
        let fallback = format!("write R5[{}]; channels are {}", known.first().unwrap_or(&"CHAN2"), known.join(", "));
        let cure = did_you_mean(inside.unwrap_or_default(), known.iter().copied(), &fallback);
        return Err(Problem::new(format!("expected the R parameter of a channel, found `{name}`"), cure));
    };
    Ok(Some((channel, number)))
}

fn missing(name: &str, channel: ChannelNumber, count: usize, names: &Names) -> Problem {
    let known = if count == 0 { "no R parameter".to_owned() } else { format!("R0 to R{}", count - 1) };
    let channel = place_name(Place::Channel(channel), names);
    Problem::new(
        format!("expected an R parameter of {channel}, which has {known}, found `{name}`"),
        "MD28050 is the number of R parameters of a channel",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_digits_after_r_make_an_r_parameter() {
        for (name, is) in [
            ("R5", true),
            ("R0[CHAN2]", true),
            ("R5[", true),
            ("R", false),
            ("R5a", false),
            ("r5", false),
            ("RX", false),
        ] {
            assert_eq!(is_r_parameter(name), is, "{name}");
        }
    }
}
