//! The stop of the group: no member stops alone. The members of an open coupling are no group, and stop by themselves.

use super::policy::GroupStop;
use super::state::Coupling;
use crate::units::AxisNumber;

impl<const FOLLOWERS: usize> Coupling<FOLLOWERS> {
    /// Which members brake, and with which deceleration, in increments per second squared; `deceleration` is what each can
    /// do.
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
