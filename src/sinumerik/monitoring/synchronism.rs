//! Monitoring of the synchronism difference (G1 2.2): warning and trip limit of each synchronous axis.
//!
//! Called once per cycle for each grouping, so that a difference, its alarm and its bits appear in one cycle. A difference is tested while the grouping is closed and not in follow-up, also while it is jammed in "hold".

use crate::sinumerik::State;
use crate::sinumerik::alarms;
use crate::sinumerik::gantry::Phase;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::variables::{EventId, Input, Parameter, Place, Quantity};

impl State {
    pub(super) fn monitor_grouping(&mut self, index: usize, parameters: &Parameters) {
        let grouping = &mut self.groupings[index];
        let leader = grouping.coupling.leader();
        let following_up = grouping.coupling.members().any(|axis| self.axes[axis].enabling.follow_up);
        let monitored = grouping.phase != Phase::Open && !following_up;
        let synchronised = grouping.phase == Phase::Synchronised;
        let coupling = grouping.coupling.clone();
        for (slot, follower) in coupling.followers().enumerate() {
            let difference = coupling.difference(follower, self.axes[leader].actual, self.axes[follower].actual);
            let limits = &parameters.axes[follower].gantry;
            // MON-04, MON-05; the synchronous axis' own limits count (DEF-12).
            let (trip_limit, datum, rule) = if synchronised {
                (limits.trip_limit, 37120, Rule::TripLimitSynchronised)
            } else {
                (limits.trip_limit_not_synchronised, 37130, Rule::TripLimitNotSynchronised)
            };
            let stage = difference.stage(limits.warning_limit, trip_limit);
            let (warning, trip) = (monitored && stage.first, monitored && stage.second);
            let place = Place::Axis(follower);
            let measured = Input::Length(Quantity::SynchronismDifference, follower, difference.0);
            let before = self.groupings[index].monitored[slot];
            let mut after = before;
            if warning != before.warning {
                let rule = if warning { Rule::WarningLimit } else { Rule::WarningGone };
                let limit = Input::Datum(37110, Some(follower), limits.warning_limit.user());
                after.warning_cause = self.log.note(place, rule, [measured, limit, Input::None], EventId::NONE);
            }
            if trip != before.trip {
                let rule = if trip { rule } else { Rule::TripGone };
                let limit = Input::Datum(datum, Some(follower), trip_limit.user());
                after.trip_cause = self.log.note(place, rule, [measured, limit, Input::None], EventId::NONE);
            }
            (after.difference, after.warning, after.trip) = (difference.0, warning, trip);
            self.groupings[index].monitored[slot] = after;
            let shown = [
                Parameter::Channel(parameters.axes[follower].channel),
                Parameter::Axis(follower),
                Parameter::None,
                Parameter::None,
            ];
            if warning {
                self.alarms.raise(alarms::GANTRY_WARNING_LIMIT, place, shown, after.warning_cause);
            }
            if trip {
                self.alarms.raise(alarms::GANTRY_TRIP_LIMIT, place, shown, after.trip_cause);
            }
        }
    }
}
