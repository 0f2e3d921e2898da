//! The phases of both kinds of gantry, and the transitions between them.

use serde::{Deserialize, Serialize};

use super::rules::Why;
use crate::control::{Transition, row};

/// The places of the charts in the rows that were used.
pub(super) const HOMING: usize = 0;
pub(super) const GANTRY: usize = 1;
pub(super) const LINK: usize = 2;

/// What a combination of the hard gantry is doing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum GantryPhase {
    /// Coupled; not all members are homed.
    #[default]
    NotHomed,
    /// Coupled, and the difference counts from the offset of the list.
    Homed,
    /// Stopped by stage 1.
    Stopped,
    /// Stopped by stage 2.
    Locked,
    /// Slaves move to their offset.
    Clearing,
    /// Opened by a program.
    Open,
}

/// The transitions of a combination.
pub(super) const GANTRY_STEPS: &[Transition<GantryPhase, Why>] = &[
    row(GantryPhase::NotHomed, Why::AllHomed, GantryPhase::Homed),
    row(GantryPhase::NotHomed, Why::StageOne, GantryPhase::Stopped),
    row(GantryPhase::NotHomed, Why::StageTwo, GantryPhase::Locked),
    row(GantryPhase::NotHomed, Why::ClearingBegins, GantryPhase::Clearing),
    row(GantryPhase::NotHomed, Why::CombinationOff, GantryPhase::Open),
    row(GantryPhase::Homed, Why::HomingBegins, GantryPhase::NotHomed),
    row(GantryPhase::Homed, Why::StageOne, GantryPhase::Stopped),
    row(GantryPhase::Homed, Why::StageTwo, GantryPhase::Locked),
    row(GantryPhase::Homed, Why::ClearingBegins, GantryPhase::Clearing),
    row(GantryPhase::Homed, Why::CombinationOff, GantryPhase::Open),
    row(GantryPhase::Clearing, Why::ClearingEnds, GantryPhase::Homed),
    row(GantryPhase::Clearing, Why::ClearedUnhomed, GantryPhase::NotHomed),
    row(GantryPhase::Clearing, Why::StageOne, GantryPhase::Stopped),
    row(GantryPhase::Clearing, Why::StageTwo, GantryPhase::Locked),
    row(GantryPhase::Stopped, Why::ClearingBegins, GantryPhase::Clearing),
    row(GantryPhase::Stopped, Why::Cleared, GantryPhase::Homed),
    row(GantryPhase::Stopped, Why::ClearedUnhomed, GantryPhase::NotHomed),
    row(GantryPhase::Stopped, Why::StageTwo, GantryPhase::Locked),
    row(GantryPhase::Open, Why::CombinationOn, GantryPhase::Homed),
    row(GantryPhase::Open, Why::ClosedUnhomed, GantryPhase::NotHomed),
];

/// What a coupling group of the soft gantry is doing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum LinkPhase {
    /// Not active.
    #[default]
    Inactive,
    /// Active.
    Active,
    /// Stopped by limit_1.
    Stopped,
    /// Stopped by limit_2.
    Locked,
    /// A reset has switched it off, and slaves move to their offset.
    Clearing,
}

/// The transitions of a coupling group.
pub(super) const LINK_STEPS: &[Transition<LinkPhase, Why>] = &[
    row(LinkPhase::Inactive, Why::GroupOn, LinkPhase::Active),
    row(LinkPhase::Inactive, Why::GroupRestored, LinkPhase::Active),
    row(LinkPhase::Active, Why::GroupOff, LinkPhase::Inactive),
    row(LinkPhase::Active, Why::GroupEnds, LinkPhase::Inactive),
    row(LinkPhase::Active, Why::SoftStageOne, LinkPhase::Stopped),
    row(LinkPhase::Active, Why::SoftStageTwo, LinkPhase::Locked),
    row(LinkPhase::Active, Why::ClearingBegins, LinkPhase::Clearing),
    row(LinkPhase::Stopped, Why::SoftStageTwo, LinkPhase::Locked),
    row(LinkPhase::Stopped, Why::ClearingBegins, LinkPhase::Clearing),
    row(LinkPhase::Stopped, Why::Cleared, LinkPhase::Active),
    row(LinkPhase::Stopped, Why::GroupEnds, LinkPhase::Inactive),
    row(LinkPhase::Locked, Why::GroupEnds, LinkPhase::Inactive),
    row(LinkPhase::Clearing, Why::GroupEnds, LinkPhase::Inactive),
];
