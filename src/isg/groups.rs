//! Coupling groups: their definitions, and those that are active.

use serde::{Deserialize, Serialize};

use super::language::Pair;
use super::phases::LinkPhase;
use crate::motion::coupling::Coupling;

/// The pairs of a group, as they were defined.
pub(super) type Definition = Vec<Pair>;

/// An active group.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Group {
    pub number: u16,
    /// One for each master.
    pub couplings: Vec<Coupling>,
    /// A reset has switched it off; its differences are still being cleared.
    pub ending: bool,
    /// What it is doing, for the chart.
    pub phase: LinkPhase,
}
