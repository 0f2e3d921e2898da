//! The variables that a block sees: those that it wrote itself, those of the interpreter, those of the channel.

use std::collections::BTreeMap;

use super::evaluate::Values;
use super::variables::Variables;

/// Variables of the interpreter by name.
pub(super) type Store = BTreeMap<String, f64>;

/// Whose variable it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Owner {
    /// P parameters and `V.P.`: all levels of a program.
    Program,
    /// `V.L.`: one level.
    Level,
    /// All others.
    Channel,
}

pub(super) fn owner(name: &str) -> Owner {
    if name.starts_with('P') || name.starts_with("V.P.") {
        Owner::Program
    } else if name.starts_with("V.L.") {
        Owner::Level
    } else {
        Owner::Channel
    }
}

/// Whether no channel can let a program write it (SG-24).
pub(super) fn is_read_only(name: &str) -> bool {
    ["V.G.AX_LINK.NR", "V.G.AX_LINK.ACTIVE"].contains(&name)
}

/// The variables of a block.
pub(super) struct Scope<'a> {
    pub(super) program: &'a Store,
    pub(super) level: &'a Store,
    /// None inside the check: nothing is known.
    pub(super) channel: Option<&'a dyn Variables>,
    /// What the block assigned, in its order. It becomes valid for all when the whole block is known to be right.
    pub(super) written: Vec<(String, f64, usize)>,
}

impl Values for Scope<'_> {
    fn value(&self, name: &str) -> Option<f64> {
        if let Some((_, value, _)) = self.written.iter().rev().find(|(written, ..)| written == name) {
            return Some(*value);
        }
        let Some(channel) = self.channel else {
            let exists = owner(name) != Owner::Channel || is_read_only(name);
            return exists.then_some(f64::NAN);
        };
        match owner(name) {
            Owner::Program => self.program.get(name).copied(),
            Owner::Level => self.level.get(name).copied(),
            Owner::Channel => channel.read(name).filter(|value| value.is_finite()),
        }
    }
}
