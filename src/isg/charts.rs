//! The state machines of both kinds of gantry, as tables: what is drawn as a flowchart, and which rows a run has used.

use super::combination::Combination;
use super::groups::Group;
use super::homing::run;
use super::phases::{GANTRY, GANTRY_STEPS, GantryPhase, LINK, LINK_STEPS, LinkPhase};
use super::rules::Why;
use super::state::{AxisError, State};
use crate::control::{Chart, ChartPosition, Rows, Transition, next};
use crate::motion::coupling::Coupling;

/// Goes to a phase by the first row that leads there; without one the phase changes, and no row is used.
fn to<P: Copy + PartialEq + Default + std::fmt::Debug>(
    table: &[Transition<P, Why>],
    taken: &mut Rows,
    phase: &mut P,
    now: P,
) {
    if *phase == now {
        return;
    }
    match table.iter().find(|row| row.from == *phase && row.to == now) {
        Some(row) => *phase = next(table, taken, *phase, row.by),
        None => *phase = now,
    }
}

impl State {
    /// Where both kinds of gantry are in the charts.
    pub(super) fn chart_positions(&self) -> Vec<ChartPosition> {
        let hard = self.combinations.iter().map(|one| ChartPosition {
            chart: "hard_gantry",
            axes: one.coupling.members().collect(),
            phase: format!("{:?}", one.phase),
            aim: "gantry_coupled",
        });
        let soft = self.channels.iter().flat_map(|channel| &channel.groups).map(|group| ChartPosition {
            chart: "soft_gantry",
            axes: group.couplings.iter().flat_map(Coupling::members).collect(),
            phase: format!("{:?}", group.phase),
            aim: "gantry_coupled",
        });
        hard.chain(soft).collect()
    }

    /// Notes the phases at the end of a cycle.
    pub(super) fn note_phases(&mut self) {
        for index in 0..self.combinations.len() {
            let now = self.phase_of(&self.combinations[index]);
            to(GANTRY_STEPS, &mut self.log.taken.0[GANTRY], &mut self.combinations[index].phase, now);
        }
        let Self { channels, axes, log, .. } = self;
        for group in channels.iter_mut().flat_map(|channel| &mut channel.groups) {
            let error =
                group.couplings.iter().flat_map(Coupling::followers).filter_map(|slave| axes[slave].error).max();
            let now = match error {
                _ if group.ending => LinkPhase::Clearing,
                Some(AxisError::Locked) => LinkPhase::Locked,
                Some(AxisError::Resettable) => LinkPhase::Stopped,
                None => LinkPhase::Active,
            };
            if group.phase != LinkPhase::Inactive {
                to(LINK_STEPS, &mut log.taken.0[LINK], &mut group.phase, now);
            }
        }
    }

    /// Notes that a group is switched on or off.
    pub(super) fn note_group(taken: &mut Rows, group: &mut Group, why: Why) {
        if LINK_STEPS.iter().any(|row| row.from == group.phase && row.by == why) {
            group.phase = next(LINK_STEPS, taken, group.phase, why);
        }
    }

    /// The rows of the chart of coupling groups.
    pub(super) fn link_rows(&mut self) -> &mut Rows {
        &mut self.log.taken.0[LINK]
    }

    fn phase_of(&self, one: &Combination) -> GantryPhase {
        let error = one.coupling.followers().filter_map(|slave| self.axes[slave].error).max();
        let is_homed = one.coupling.members().all(|member| self.axes[member].homed);
        match error {
            _ if one.coupling.is_open() && !one.homes_at_once => GantryPhase::Open,
            Some(AxisError::Locked) => GantryPhase::Locked,
            _ if !one.coupling.is_closed() && !one.homes_at_once => GantryPhase::Clearing,
            Some(AxisError::Resettable) => GantryPhase::Stopped,
            None if is_homed => GantryPhase::Homed,
            None => GantryPhase::NotHomed,
        }
    }
}

/// The charts, in the order of their places.
pub(super) fn charts() -> Vec<Chart> {
    let gantry = |phase| match phase {
        GantryPhase::NotHomed => "coupled, not all axes are homed",
        GantryPhase::Homed => "coupled and homed",
        GantryPhase::Stopped => "stopped by the resettable limit",
        GantryPhase::Locked => "stopped by the limit that no reset clears",
        GantryPhase::Clearing => "the slaves move to their offset",
        GantryPhase::Open => "opened by a program",
    };
    let link = |phase| match phase {
        LinkPhase::Inactive => "not active",
        LinkPhase::Active => "active",
        LinkPhase::Stopped => "stopped by limit_1",
        LinkPhase::Locked => "stopped by limit_2",
        LinkPhase::Clearing => "the slaves move to their offset",
    };
    vec![
        Chart::of("homing", "Homing of an axis", run::STEPS, run::text, |_| None),
        Chart::of("hard_gantry", "Hard gantry: a combination", GANTRY_STEPS, gantry, |_| None)
            .with_step_from_anywhere(Why::PowerOn, GantryPhase::NotHomed),
        Chart::of("soft_gantry", "Soft gantry: a coupling group", LINK_STEPS, link, |_| None)
            .with_step_from_anywhere(Why::PowerOn, LinkPhase::Inactive),
    ]
}
