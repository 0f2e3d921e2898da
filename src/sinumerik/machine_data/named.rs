//! Parses the name of a machine datum value.
//!
//! Accepted forms are `34090[XF]`, `MD34090[XF]`, `34100[2,XF]`, `20700[CHAN1]`, `11300`, `SD41110`, `$MA_REFP_SET_POS[2,AX3]` and
//! `REFP_SET_POS[2,XF]`. An axis is given by its machine axis name (MD10000, exact case) or by `AXn`, a channel by its
//! name (MD20000) or by `CHANn`. The default channel is channel 1, the default index is 0.

use super::MachineData;
use super::catalogue::{by_identifier, by_number, meant};
use super::table::{Datum, Scope};
use super::target::{Target, bad_index, unknown_number};
use crate::control::Owner;
use crate::source::{Problem, did_you_mean};
use crate::units::ChannelNumber;

impl MachineData {
    /// Parses the name of a value: `34090[XF]`, `MD34090[XF]`, `34100[2,XF]`, `20700[CHAN1]`, `11300`, `$MA_REFP_SET_POS[2,AX3]`,
    /// `REFP_SET_POS[2,XF]`. The default index is 0, the default channel is channel 1.
    ///
    /// # Errors
    /// The datum, axis, channel or index is unknown; the problem names the nearest known one.
    pub fn parse_target(&self, text: &str) -> Result<Target, Problem> {
        parse(text, self)
    }
}

/// Parses a target with the names of axes and channels in `data`.
fn parse(text: &str, data: &MachineData) -> Result<Target, Problem> {
    let text = text.trim();
    let (name, indices) = split_indices(text).ok_or_else(|| {
        Problem::new(
            format!("expected a machine datum such as `34090[XF]`, found `{text}`"),
            "write the number or identifier, then the index and axis in brackets",
        )
    })?;
    let datum = match without_letters(name).parse() {
        Ok(number) => by_number(number).ok_or_else(|| unknown_number(number))?,
        Err(_) => by_identifier(name).ok_or_else(|| unknown_identifier(name))?,
    };
    resolve(datum, &indices, ChannelNumber::FIRST, data)
}

/// A number without the letters that manuals write before it: `MD34090`, `SD41110`.
fn without_letters(name: &str) -> &str {
    let number = name.strip_prefix("MD").or_else(|| name.strip_prefix("SD"));
    number.filter(|number| number.starts_with(|c: char| c.is_ascii_digit())).unwrap_or(name)
}

/// Splits `NAME[a,b]`; `None` if the brackets are not closed or contain more than two items.
pub(super) fn split_indices(text: &str) -> Option<(&str, Vec<&str>)> {
    let Some((name, rest)) = text.split_once('[') else {
        return (!text.is_empty() && !text.contains(']')).then(|| (text, Vec::new()));
    };
    let inside = rest.trim_end().strip_suffix(']')?;
    let indices: Vec<_> = inside.split(',').map(str::trim).collect();
    let sound = !name.trim().is_empty() && indices.len() <= 2 && indices.iter().all(|index| !index.is_empty());
    (sound && !inside.contains(['[', ']'])).then(|| (name.trim(), indices))
}

/// The target given by the brackets; `channel` is the default channel.
pub(super) fn resolve(
    datum: &'static Datum,
    indices: &[&str],
    channel: ChannelNumber,
    data: &MachineData,
) -> Result<Target, Problem> {
    let is_number = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    let (number, name) = match *indices {
        [] => ("0", None),
        [number] if is_number(number) => (number, None),
        [name] => ("0", Some(name)),
        [number, name, ..] => (number, Some(name)),
    };
    let owner = match (datum.scope, name) {
        (Scope::General | Scope::Setting, None) => Owner::Nck,
        (Scope::Channel | Scope::ChannelSetting, None) => Owner::Channel(channel),
        (Scope::Channel | Scope::ChannelSetting, Some(name)) => {
            Owner::Channel(data.channel(name).ok_or_else(|| unknown_channel(datum, name))?)
        }
        (Scope::Axis | Scope::AxisSetting, Some(name)) => {
            Owner::Axis(data.axis(name).ok_or_else(|| unknown_axis(datum, name, data))?)
        }
        (Scope::General | Scope::Setting, Some(name)) => return Err(bad_index(datum, name)),
        (Scope::Axis | Scope::AxisSetting, None) => {
            return Err(Problem::new(
                format!("expected a machine axis in the brackets of {datum}, found none"),
                format!("write `{}[AX1]`, or the name of the machine axis", datum.identifier),
            ));
        }
    };
    let index =
        number.parse().ok().filter(|index| u16::from(*index) < datum.count).ok_or_else(|| bad_index(datum, number))?;
    Ok(Target { datum, owner, index })
}

fn unknown_axis(datum: &Datum, name: &str, data: &MachineData) -> Problem {
    let names = data.general.axconf_machax_name_tab.iter().map(String::as_str);
    Problem::new(
        format!("expected a machine axis name (MD10000) or AX1 to AX31 for {datum}, found `{name}`"),
        did_you_mean(name, names, "names are case-sensitive"),
    )
}

fn unknown_identifier(name: &str) -> Problem {
    let cure = meant(name).unwrap_or_else(|| "`opennck machine-data list` shows the known ones".to_owned());
    Problem::new(format!("expected a known machine datum, found `{name}`"), cure)
}

fn unknown_channel(datum: &Datum, name: &str) -> Problem {
    Problem::new(
        format!("expected a channel name (MD20000) or CHAN1 to CHAN10 for {datum}, found `{name}`"),
        "names are case-sensitive",
    )
}
