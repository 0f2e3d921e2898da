//! Monitoring of the synchronism difference (G1 2.2): warning and trip limit of each synchronous axis.
//!
//! Called once per cycle for each grouping, so that a difference, its alarm and its bits appear in one cycle. A difference is
//! tested while the grouping is closed and not in follow-up, also while it is jammed in "hold".
//!
//! | the grouping | warns above | trips above |
//! |---|---|---|
//! | is synchronised | MD37110 | MD37120 (MON-04) |
//! | is not | MD37110 | MD37130 (MON-05) |
//! | has lost synchronism in operation (MON-08) | base + MD37110 | base + MD37120, and MD37130 |
//!
//! The base is the amount of the difference when position control came back, if synchronism did not come back with it
//! (G1 2.7.4: both limits are additional tolerances then). A smaller difference never warns or trips by it. It ends when the
//! grouping is synchronised, or opened, or a new reference gives the positions other values. Choice where the manuals leave one:
//! MD37110 alone does not warn as well, or the base would mean nothing to it.

use crate::sinumerik::alarms;
use crate::sinumerik::gantry::state::Phase;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::Gantry;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, Position};
use crate::variables::{EventId, Input, Parameter, Place, Quantity};

/// A limit, the rule behind it, and what it consists of.
struct Limit {
    at: Position,
    exceeded: Rule,
    inputs: [Input; 2],
}

impl Limit {
    fn new(at: Position, datum: u32, axis: AxisNumber, exceeded: Rule) -> Self {
        Self { at, exceeded, inputs: [Input::Datum(datum, Some(axis), at.user()), Input::None] }
    }

    /// The same as an additional tolerance.
    fn beyond(self, base: Position, axis: AxisNumber, exceeded: Rule) -> Self {
        let inputs = [self.inputs[0], Input::Length(Quantity::Distance, axis, base)];
        Self { at: self.at + base, exceeded, inputs }
    }
}

/// The warning limit, if there is one, and the trip limit that count for a synchronous axis (DEF-12: its own).
fn limits(axis: AxisNumber, own: &Gantry, synchronised: bool, base: Option<Position>) -> (Option<Limit>, Limit) {
    // MON-03: 0 is no warning limit.
    let warning =
        Some(Limit::new(own.warning_limit, 37110, axis, Rule::WarningLimit)).filter(|limit| limit.at > Position::ZERO);
    let synchronised_trip = Limit::new(own.trip_limit, 37120, axis, Rule::TripLimitSynchronised);
    if synchronised {
        return (warning, synchronised_trip);
    }
    let trip = Limit::new(own.trip_limit_not_synchronised, 37130, axis, Rule::TripLimitNotSynchronised);
    let Some(base) = base else { return (warning, trip) };
    let warning = warning.map(|limit| limit.beyond(base, axis, Rule::WarningLimitBeyondBase));
    let second = synchronised_trip.beyond(base, axis, Rule::TripLimitBeyondBase);
    (warning, if second.at < trip.at { second } else { trip })
}

impl State {
    pub(in crate::sinumerik) fn monitor_grouping(&mut self, index: usize, parameters: &Parameters) {
        let grouping = &mut self.groupings[index];
        let following_up = grouping.coupling.members().any(|axis| self.axes[axis].enabling.follow_up);
        let monitored = grouping.phase != Phase::Open && !following_up;
        let synchronised = grouping.phase == Phase::Synchronised;
        let coupling = grouping.coupling.clone();
        for (slot, follower) in coupling.followers().enumerate() {
            let difference = coupling.difference(follower, &self.axes).unwrap_or_default();
            let base = self.groupings[index].monitored[slot].base;
            let (warning_limit, trip_limit) = limits(follower, &parameters.axes[follower].gantry, synchronised, base);
            let warning_at = warning_limit.as_ref().map_or(Position::ZERO, |limit| limit.at);
            let first = warning_at > Position::ZERO && difference.abs() > warning_at;
            let (warning, trip) = (monitored && first, monitored && difference.abs() > trip_limit.at);
            let before = self.groupings[index].monitored[slot];
            let mut after = before;
            if warning != before.warning {
                after.warning_cause = self.note_limit(
                    follower,
                    difference,
                    warning_limit.as_ref(),
                    warning,
                    monitored,
                    Rule::WarningGone,
                );
            }
            if trip != before.trip {
                after.trip_cause =
                    self.note_limit(follower, difference, Some(&trip_limit), trip, monitored, Rule::TripGone);
            }
            (after.difference, after.warning, after.trip) = (difference, warning, trip);
            self.groupings[index].monitored[slot] = after;
            let channel = Parameter::Channel(parameters.axes[follower].channel);
            let shown = [channel, Parameter::Axis(follower), Parameter::None, Parameter::None];
            let place = Place::Axis(follower);
            if warning {
                self.alarms.raise(alarms::GANTRY_WARNING_LIMIT, place, shown, after.warning_cause);
            }
            if trip {
                self.alarms.raise(alarms::GANTRY_TRIP_LIMIT, place, shown, after.trip_cause);
            }
        }
    }

    /// Why a warning or a trip came or went.
    fn note_limit(
        &mut self,
        axis: AxisNumber,
        difference: Position,
        limit: Option<&Limit>,
        exceeded: bool,
        monitored: bool,
        gone: Rule,
    ) -> EventId {
        let measured = Input::Length(Quantity::SynchronismDifference, axis, difference);
        let (rule, inputs) = match limit {
            Some(limit) if monitored => (if exceeded { limit.exceeded } else { gone }, limit.inputs),
            Some(_) | None if monitored => (gone, [Input::None; 2]),
            Some(_) | None => (Rule::NotMonitored, [Input::None; 2]),
        };
        self.log.note(Place::Axis(axis), rule, [measured, inputs[0], inputs[1]], EventId::NONE)
    }

    /// Position control is back: where synchronism is not, what is apart now is the base of the limits (MON-08).
    pub(in crate::sinumerik) fn set_bases(&mut self, index: usize) {
        let grouping = &mut self.groupings[index];
        if !grouping.lost_in_operation {
            return;
        }
        let coupling = grouping.coupling.clone();
        for (slot, follower) in coupling.followers().enumerate() {
            let difference = coupling.difference(follower, &self.axes).unwrap_or_default();
            grouping.monitored[slot].base = Some(difference.abs());
        }
    }

    /// The limits count from 0 again, until synchronism is lost in operation another time.
    pub(in crate::sinumerik) fn clear_bases(&mut self, index: usize) {
        self.groupings[index].lost_in_operation = false;
        self.groupings[index].monitored.iter_mut().for_each(|monitored| monitored.base = None);
    }
}
