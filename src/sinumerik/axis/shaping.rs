//! Filters and delays between the commanded movement and position control, used if machine data require them.

use serde::{Deserialize, Serialize};

use crate::motion::{DeadTime, JerkFilter, Pt1};
use crate::sinumerik::parameters::dynamics::{Dynamics, FeedForward, Jerk, ParameterSet};

/// The filters and delays of an axis between the commanded movement and position control.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Shaping {
    /// The jerk filter of the setpoint.
    pub jerk: Option<JerkFilter>,
    pub branch: Option<SetpointBranch>,
}

/// The delays in the setpoint branch of an axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct SetpointBranch {
    pub matching: Pt1,
    pub balancing: Pt1,
    pub dead_time: DeadTime,
}

impl SetpointBranch {
    pub(in crate::sinumerik) fn reset(&mut self) {
        self.matching.reset();
        self.balancing.reset();
        self.dead_time.reset();
    }

    /// Whether the delayed setpoint differs from the setpoint.
    pub(in crate::sinumerik) fn is_behind(&self) -> bool {
        [self.matching.behind(), self.balancing.behind(), self.dead_time.behind()].iter().any(|way| way.abs() > 0.0)
    }

    /// One position-control cycle. Returns the lag of the position-control setpoint behind the interpolator's setpoint,
    /// in increments, and the velocity for feedforward.
    pub(in crate::sinumerik) fn pass(
        &mut self,
        mode: FeedForward,
        set: &ParameterSet,
        movement: f64,
        cycle: f64,
    ) -> (f64, f64) {
        let before = self.matching.behind();
        let matched = self.matching.delay(movement, set.matching_time, cycle);
        let feed_forward = set.feed_forward_weight * matched / cycle;
        match mode {
            FeedForward::Off => (before, 0.0),
            FeedForward::Pt1 => {
                let behind = before + self.balancing.behind();
                self.balancing.delay(matched, set.balancing_time, cycle);
                (behind, feed_forward)
            }
            FeedForward::DeadTime => {
                let behind = before + self.dead_time.behind();
                self.dead_time.delay(matched, set.balancing_time / cycle);
                (behind, feed_forward)
            }
        }
    }
}

impl Shaping {
    pub(in crate::sinumerik) fn prepare_jerk(&mut self, jerk: &Jerk) {
        let windows = [jerk.longest, jerk.window];
        if !jerk.is_limited() {
            self.jerk = None;
        } else if !self.jerk.as_ref().is_some_and(|filter| filter.has_windows_of(windows)) {
            self.jerk = Some(JerkFilter::new(windows));
        }
    }

    pub(in crate::sinumerik) fn prepare_branch(&mut self, dynamics: &Dynamics, by_program: bool, cycle: f64) {
        if !dynamics.delays_setpoints(by_program) {
            self.branch = None;
            return;
        }
        let dead_time = DeadTime::new(dynamics.longest_dead_time() / cycle);
        let branch = self.branch.get_or_insert_default();
        if branch.dead_time.cycles() != dead_time.cycles() {
            branch.dead_time = dead_time;
        }
    }
}
