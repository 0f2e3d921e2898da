//! The stop of the group: no member stops alone. The members of an open coupling are not a group and stop individually.

use super::policy::GroupStop;
use super::state::Coupling;
use crate::units::AxisNumber;

impl<const FOLLOWERS: usize> Coupling<FOLLOWERS> {
    /// The members that brake and their decelerations, in increments per second squared. `deceleration` returns the deceleration available
    /// to each member.
    pub fn stop(&self, deceleration: impl Fn(AxisNumber) -> f64) -> impl Iterator<Item = (AxisNumber, f64)> {
        let slowest = self.members().map(&deceleration).fold(f64::INFINITY, f64::min);
        let brakes = move |axis| match self.policy.stop {
            GroupStop::AllAtTheSlowest => Some((axis, slowest)),
            GroupStop::EachAtItsOwn => Some((axis, deceleration(axis))),
            GroupStop::Leading => (axis == self.leads_now).then(|| (axis, deceleration(axis))),
        };
        self.members().filter_map(brakes)
    }
}
