//! Which value is meant: a machine datum, whose it is, and which of several.
//!
//! People write `34090[XF]`, `34100[2,XF]`, `20700[CHAN1]`, `11300`, `$MA_REFP_SET_POS[2,AX3]` or `REFP_SET_POS[2,XF]`.
//! An axis is meant by its machine axis name (MD10000, exact case) or by `AXn`, a channel by its name (MD20000) or by
//! `CHANn`; without a channel it is channel 1, without an index it is index 0.

use std::fmt;

use crate::source::{Problem, did_you_mean};
use crate::units::{AxisNumber, ChannelNumber};

use super::MachineData;
use super::catalogue::{by_identifier, by_number, nearest_identifier};
use super::table::{Datum, Scope};

/// Whose value it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Owner {
    /// The NC's: general machine data and general setting data.
    Nck,
    /// A channel's.
    Channel(ChannelNumber),
    /// A machine axis'.
    Axis(AxisNumber),
}

/// One value of one machine datum. It exists: number, owner and index were checked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    datum: &'static Datum,
    owner: Owner,
    index: u8,
}

impl Eq for Target {}

impl PartialOrd for Target {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// By scope, number, owner, index: the order in which the control exports.
impl Ord for Target {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let key = |target: &Self| (target.datum.scope, target.datum.number, target.owner, target.index);
        key(self).cmp(&key(other))
    }
}

impl Target {
    /// The value `index` of the datum `number` of `owner`.
    ///
    /// # Errors
    /// There is no such datum, it has another kind of owner, or fewer values.
    pub fn new(number: u32, owner: Owner, index: u8) -> Result<Self, Problem> {
        let datum = by_number(number).ok_or_else(|| unknown_number(number))?;
        let fits = match datum.scope {
            Scope::General | Scope::Setting => owner == Owner::Nck,
            Scope::Channel => matches!(owner, Owner::Channel(_)),
            Scope::Axis => matches!(owner, Owner::Axis(_)),
        };
        if !fits {
            return Err(Problem::new(
                format!("expected {} for {datum}", owner_in_words(datum.scope)),
                "write the axis or channel in the brackets only where the datum has one",
            ));
        }
        if index >= datum.count {
            return Err(bad_index(datum, &index.to_string()));
        }
        Ok(Self { datum, owner, index })
    }

    /// The datum.
    #[must_use]
    pub const fn datum(&self) -> &'static Datum {
        self.datum
    }

    /// Whose value.
    #[must_use]
    pub const fn owner(&self) -> Owner {
        self.owner
    }

    /// Which of several values; 0 where there is one.
    #[must_use]
    pub const fn index(&self) -> u8 {
        self.index
    }
}

/// As the control exports it: `$MA_REFP_SET_POS[2,AX3]`; the channel is not shown.
impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.datum.scope.prefix(), self.datum.identifier)?;
        match (self.owner, self.datum.count) {
            (Owner::Axis(axis), 1) => write!(f, "[AX{axis}]"),
            (Owner::Axis(axis), _) => write!(f, "[{},AX{axis}]", self.index),
            (Owner::Nck | Owner::Channel(_), 1) => Ok(()),
            (Owner::Nck | Owner::Channel(_), _) => write!(f, "[{}]", self.index),
        }
    }
}

/// Reads a target; names of axes and channels are those of `data`.
pub(super) fn parse(text: &str, data: &MachineData) -> Result<Target, Problem> {
    let text = text.trim();
    let (name, indices) = split_indices(text).ok_or_else(|| {
        Problem::new(
            format!("expected a machine datum such as `34090[XF]`, found `{text}`"),
            "write the number or identifier, then the index and axis in brackets",
        )
    })?;
    let datum = match name.parse() {
        Ok(number) => by_number(number).ok_or_else(|| unknown_number(number))?,
        Err(_) => by_identifier(name).ok_or_else(|| unknown_identifier(name))?,
    };
    resolve(datum, &indices, ChannelNumber::FIRST, data)
}

/// Takes `NAME[a,b]` apart; `None` where the brackets are not closed or hold more than two.
pub(super) fn split_indices(text: &str) -> Option<(&str, Vec<&str>)> {
    let Some((name, rest)) = text.split_once('[') else {
        return (!text.is_empty() && !text.contains(']')).then(|| (text, Vec::new()));
    };
    let inside = rest.trim_end().strip_suffix(']')?;
    let indices: Vec<_> = inside.split(',').map(str::trim).collect();
    let sound = !name.trim().is_empty() && indices.len() <= 2 && indices.iter().all(|index| !index.is_empty());
    (sound && !inside.contains(['[', ']'])).then(|| (name.trim(), indices))
}

/// The target that the brackets mean; `channel` is meant where they name none.
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
        (Scope::Channel, None) => Owner::Channel(channel),
        (Scope::Channel, Some(name)) => Owner::Channel(data.channel(name).ok_or_else(|| unknown_channel(datum, name))?),
        (Scope::Axis, Some(name)) => Owner::Axis(data.axis(name).ok_or_else(|| unknown_axis(datum, name, data))?),
        (Scope::General | Scope::Setting, Some(name)) => return Err(bad_index(datum, name)),
        (Scope::Axis, None) => {
            return Err(Problem::new(
                format!("expected a machine axis in the brackets of {datum}, found none"),
                format!("write `{}[AX1]`, or the name of the machine axis", datum.identifier),
            ));
        }
    };
    let index = number.parse().ok().filter(|index| *index < datum.count).ok_or_else(|| bad_index(datum, number))?;
    Ok(Target { datum, owner, index })
}

fn owner_in_words(scope: Scope) -> &'static str {
    match scope {
        Scope::General | Scope::Setting => "no axis and no channel",
        Scope::Channel => "a channel",
        Scope::Axis => "a machine axis",
    }
}

fn bad_index(datum: &Datum, found: &str) -> Problem {
    let expected = if datum.count == 1 {
        "no index, or index 0,".to_owned()
    } else {
        format!("an index from 0 to {}", datum.count - 1)
    };
    Problem::new(format!("expected {expected} for {datum}, found `{found}`"), "correct the index")
}

fn unknown_number(number: u32) -> Problem {
    Problem::new(
        format!("expected the number of a known machine datum, found {number}"),
        "the catalogue of machine data lists the known ones",
    )
}

fn unknown_identifier(name: &str) -> Problem {
    let cure = nearest_identifier(name).map_or_else(
        || "the catalogue of machine data lists the known ones".to_owned(),
        |near| format!("did you mean `{near}`?"),
    );
    Problem::new(format!("expected a known machine datum, found `{name}`"), cure)
}

fn unknown_axis(datum: &Datum, name: &str, data: &MachineData) -> Problem {
    let names = data.general.axconf_machax_name_tab.iter().map(String::as_str);
    Problem::new(
        format!("expected a machine axis name (MD10000) or AX1 to AX31 for {datum}, found `{name}`"),
        did_you_mean(name, names, "names are compared in exact case"),
    )
}

fn unknown_channel(datum: &Datum, name: &str) -> Problem {
    Problem::new(
        format!("expected a channel name (MD20000) or CHAN1 to CHAN10 for {datum}, found `{name}`"),
        "names are compared in exact case",
    )
}
