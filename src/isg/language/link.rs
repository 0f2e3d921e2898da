//! Definitions of axis couplings with values: groups, pairs, factors (isg.md 3.2, 3.3).

use serde::{Deserialize, Serialize};

use super::fault::{FaultCode, NUMERATOR, SLAVE_AND_MASTER, SLAVE_IS_MASTER, SLAVE_TWICE};

/// A coupling group of `#SET AX LINK` or `#AX LINK`. The channel judges the number of the group (20461) and how many pairs there may be.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Link {
    /// The number of the group.
    pub group: i64,
    /// The pairs, at least one.
    pub pairs: Vec<Pair>,
}

/// Slave and master.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pair {
    /// The axis that follows.
    pub slave: AxisReference,
    /// The axis that it follows.
    pub master: AxisReference,
    /// How the pair was written.
    pub form: Form,
}

/// An axis in a command.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum AxisReference {
    /// Its name in the channel.
    Name(String),
    /// Its logical number.
    Number(u32),
}

/// How a pair was written.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Form {
    /// `Y2 = Y1`
    Bare,
    /// `[Y2 = Y1]`
    Standard,
    /// `[Y2 = Y1,G]`: monitored.
    Gantry {
        /// `[Y2 = Y1,G,0.01,0.25]`: both limits in mm, or degrees of a rotary axis; none: those of the slave's list.
        limits: Option<[f64; 2]>,
    },
    /// `[Y2 = Y1,1,-1]`
    Factor {
        /// Not 0.
        numerator: i64,
        /// Not 0.
        denominator: i64,
    },
}

/// What `#DISABLE AX LINK` or `#AX LINK OFF` ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum LinkOff {
    /// No number: the group that was activated last.
    Last,
    /// One group.
    Group(i64),
    /// ALL.
    All,
}

impl Form {
    /// Whether the difference of the positions is monitored.
    #[must_use]
    pub fn is_monitored(self) -> bool {
        matches!(self, Self::Gantry { .. })
    }

    /// The factor that becomes effective: −1 if numerator and denominator differ only in their signs, else 1.
    #[must_use]
    pub fn factor(self) -> i8 {
        match self {
            Self::Factor { numerator, denominator } if numerator.checked_neg() == Some(denominator) => -1,
            Self::Bare | Self::Standard | Self::Gantry { .. } | Self::Factor { .. } => 1,
        }
    }

    /// Whether the factor was written as something other than −1 or 1 and became 1: warning 21111.
    #[must_use]
    pub fn is_scaled(self) -> bool {
        match self {
            Self::Factor { numerator, denominator } => {
                numerator != denominator && numerator.checked_neg() != Some(denominator)
            }
            Self::Bare | Self::Standard | Self::Gantry { .. } => false,
        }
    }
}

/// The error of a factor: 0 in either place. The control looks at the numerator first.
pub(super) fn factor_error(numerator: i64, denominator: i64) -> Option<(FaultCode, String)> {
    if numerator == 0 {
        return Some((
            FaultCode::Number(NUMERATOR),
            "the numerator of the coupling factor is 0; allowed are factors -1 and 1".to_owned(),
        ));
    }
    (denominator == 0).then(|| {
        (
            FaultCode::LinkDenominator,
            "the denominator of the coupling factor is 0; allowed are factors -1 and 1".to_owned(),
        )
    })
}

/// The first pair that cannot be with those before it, the axis that is the reason, and why. Logical number 0 is no axis: it stands for a number that is not known.
pub(super) fn conflict(pairs: &[Pair]) -> Option<(usize, FaultCode, AxisReference, String)> {
    let is_same = |one: &AxisReference, other: &AxisReference| one == other && *one != AxisReference::Number(0);
    for (index, pair) in pairs.iter().enumerate() {
        let found = |number, axis: &AxisReference, text: &str| {
            Some((index, FaultCode::Number(number), axis.clone(), format!("{axis} {text}")))
        };
        if is_same(&pair.slave, &pair.master) {
            return found(SLAVE_IS_MASTER, &pair.slave, "is its own master");
        }
        let before = &pairs[..index];
        if before.iter().any(|other| is_same(&other.slave, &pair.slave)) {
            return found(SLAVE_TWICE, &pair.slave, "is a slave twice");
        }
        let both = before.iter().find_map(|other| {
            [(&other.master, &pair.slave), (&other.slave, &pair.master)]
                .into_iter()
                .find(|(one, two)| is_same(one, two))
        });
        if let Some((axis, _)) = both {
            return found(SLAVE_AND_MASTER, axis, "is both master and slave");
        }
    }
    None
}

impl AxisReference {
    /// The name, or the number alone: for texts that say "axis" before it.
    #[must_use]
    pub fn bare(&self) -> String {
        match self {
            Self::Name(name) => name.clone(),
            Self::Number(number) => number.to_string(),
        }
    }
}

impl std::fmt::Display for AxisReference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Name(name) => f.write_str(name),
            Self::Number(number) => write!(f, "axis {number}"),
        }
    }
}
