//! A combination of the hard gantry, and the policy of both kinds of gantry.

use serde::{Deserialize, Serialize};

use super::phases::GantryPhase;
use crate::motion::coupling::{BeforeReference, Coupling, GroupStop, Policy, Reaction, Release};
use crate::variables::EventId;

/// The reactions of both kinds of gantry: stage 1 stops until a reset, stage 2 until a restart (HG-07, SG-04).
pub(super) const POLICY: Policy = Policy {
    first: Reaction::Stop,
    second: Reaction::Lock,
    before_reference: BeforeReference::Relative,
    release: Release::CountAnew,
    stop: GroupStop::Leading,
};

/// A combination of a master and its slaves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Combination {
    pub coupling: Coupling,
    /// Its axes home at once, each for itself.
    pub homes_at_once: bool,
    /// What it is doing, for the chart.
    pub phase: GantryPhase,
    /// The event with which it was opened or closed.
    pub cause: EventId,
}
