//! The address of a machine datum value: datum, owner and index.

use std::fmt;

use crate::control::Owner;
use crate::image::{Block, SINUMERIK};
use crate::source::Problem;

use super::catalogue::by_number;
use super::table::{Datum, Scope};

/// One value of one machine datum. It exists: number, owner and index were checked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    pub(super) datum: &'static Datum,
    pub(super) owner: Owner,
    pub(super) index: u8,
}

impl Eq for Target {}

impl PartialOrd for Target {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// By scope, number, owner, index: the export order of the control.
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
    /// The datum does not exist, has another kind of owner, or has fewer values.
    pub fn new(number: u32, owner: Owner, index: u8) -> Result<Self, Problem> {
        let datum = by_number(number).ok_or_else(|| unknown_number(number))?;
        let fits = match datum.scope {
            Scope::General | Scope::Setting => owner == Owner::Nck,
            Scope::Channel | Scope::ChannelSetting => matches!(owner, Owner::Channel(_)),
            Scope::Axis | Scope::AxisSetting => {
                matches!(owner, Owner::Axis(axis) if axis.number() <= SINUMERIK.count(Block::Axis))
            }
        };
        if !fits {
            return Err(Problem::new(
                format!("expected {} for {datum}", owner_in_words(datum.scope)),
                "write an axis or channel in the brackets only if the datum has one",
            ));
        }
        if u16::from(index) >= datum.count {
            return Err(bad_index(datum, &index.to_string()));
        }
        Ok(Self { datum, owner, index })
    }

    /// The datum.
    #[must_use]
    pub const fn datum(&self) -> &'static Datum {
        self.datum
    }

    /// The owner of the value.
    #[must_use]
    pub const fn owner(&self) -> Owner {
        self.owner
    }

    /// The index; 0 if there is only one value.
    #[must_use]
    pub const fn index(&self) -> u8 {
        self.index
    }
}

/// In the export form of the control: `$MA_REFP_SET_POS[2,AX3]`. The channel is not shown.
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

fn owner_in_words(scope: Scope) -> &'static str {
    match scope {
        Scope::General | Scope::Setting => "no axis and no channel",
        Scope::Channel | Scope::ChannelSetting => "a channel",
        Scope::Axis | Scope::AxisSetting => "a machine axis",
    }
}

pub(super) fn bad_index(datum: &Datum, found: &str) -> Problem {
    let expected = if datum.count == 1 {
        "no index, or index 0,".to_owned()
    } else {
        format!("an index from 0 to {}", datum.count - 1)
    };
    Problem::new(format!("expected {expected} for {datum}, found `{found}`"), "correct the index")
}

pub(super) fn unknown_number(number: u32) -> Problem {
    Problem::new(
        format!("expected the number of a known machine datum, found {number}"),
        "`opennck machine-data list` shows the known ones",
    )
}
