//! Monitoring of the synchronism difference (G1 2.2): warning and trip limit of each synchronous axis.
//!
//! Called once per cycle for each grouping, so that a difference, its alarm and its bits appear in one cycle. A difference is monitored
//! while the grouping is closed and not in follow-up, also while the axes are held in "hold".
//!
//! | the grouping | warns above | trips above |
//! |---|---|---|
//! | is synchronised | MD37110 | MD37120 (MON-04) |
//! | is not | MD37110 | MD37130 (MON-05) |
//! | has lost synchronism in operation (MON-08) | MD37110 from the base | MD37120 from the base, or MD37130 if that is smaller |
//! | has lost it, in extended monitoring (`extended.rs`) | MD37110 | MD37130 |
//!
//! The base is the difference, with its sign, when position control came back without synchronism, or when the opened grouping was closed
//! (E-14, G1 2.7.4: both limits are then additional tolerances). It counts in both directions. During a synchronising motion it follows the
//! difference towards 0; otherwise the motion itself would trip. It ends when the grouping is synchronised or opened, or when the reference
//! of one of its axes is set anew. A grouping that has not been synchronised since it was referenced has no base. The base concerns
//! monitoring alone: the comparison of section 3, readiness (E-13), the return of synchronism (SYN-06) and the displayed difference do not
//! count from it.

use crate::control::Log;
use crate::motion::coupling::{CouplingEvent, Events, Limit, TwoStage, What};
use crate::sinumerik::alarms;
use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::gantry::state::{Grouping, Phase};
use crate::sinumerik::gantry::view::{View, Want, Wants};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::Gantry;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, PerAxis, Position};
use crate::variables::{EventId, Input, Parameter, Place, Quantity};

/// The limits that apply to a synchronous axis (DEF-12: its own). MON-03: 0 means no warning limit.
fn limits(own: &Gantry, synchronised: bool, extended: bool) -> TwoStage {
    let first = Some(own.warning_limit).filter(|&limit| limit > Position::ZERO);
    if synchronised {
        TwoStage::new(first, own.trip_limit)
    } else if extended {
        TwoStage::new(first, own.trip_limit_not_synchronised)
    } else {
        TwoStage { first, second: own.trip_limit_not_synchronised, second_beyond_base: Some(own.trip_limit) }
    }
}

/// The rule by which a limit was exceeded, and its machine datum.
fn warning(limit: Limit) -> (Rule, u32) {
    (if limit.base.is_some() { Rule::WarningLimitBeyondBase } else { Rule::WarningLimit }, 37110)
}

fn trip(limit: Limit, own: &Gantry, synchronised: bool, extended: bool) -> (Rule, u32) {
    if limit.base.is_some() {
        (Rule::TripLimitBeyondBase, if limit.at == own.trip_limit { 37120 } else { 37130 })
    } else if extended {
        (Rule::TripLimitExtended, if synchronised { 37120 } else { 37130 })
    } else if synchronised {
        (Rule::TripLimitSynchronised, 37120)
    } else {
        (Rule::TripLimitNotSynchronised, 37130)
    }
}

impl State {
    /// The actual value of an axis changed without a movement. This causes no synchronism difference, unless both axes are
    /// referenced (O-12).
    pub(in crate::sinumerik) fn value_shifted(&mut self, number: AxisNumber, shift: Position) {
        for grouping in &mut self.groupings {
            grouping.coupling.value_shifted(number, shift, &self.axes);
        }
    }

    /// A reference that was lost in this cycle, differences, their alarms, and the messages of section 3.
    pub(in crate::sinumerik) fn monitor_grouping(&mut self, index: usize, parameters: &Parameters) {
        let defined = self.definition_cause;
        self.ask(index, parameters, |grouping, view, log, wants| {
            grouping.count_shown();
            grouping.lose_synchronism(view, log, wants);
            grouping.monitor(view, defined, log, wants);
            wants.extend(grouping.message(view));
        });
    }
}

impl Grouping {
    /// The limit in effect that sets 101.2 (`trip`) or 101.3 of a synchronous axis, and its machine datum; `None` while its difference is not
    /// monitored or has no such limit.
    pub(in crate::sinumerik) fn limit(
        &self,
        axis: AxisNumber,
        is_trip: bool,
        axes: &PerAxis<Axis>,
        parameters: &Parameters,
    ) -> Option<(Limit, u32)> {
        let (first, second) = self.coupling.limits(axis, axes)?;
        if !is_trip {
            return first.map(|limit| (limit, warning(limit).1));
        }
        let (own, extended) = (&parameters.axes[axis].gantry, self.extended.acts(axis, parameters));
        Some((second, trip(second, own, self.phase == Phase::Synchronised, extended).1))
    }

    fn monitor(&mut self, view: &View<'_>, defined: EventId, log: &mut Log, wants: &mut Wants) {
        let followed_up = self.coupling.members().any(|axis| view.axes[axis].enabling.follow_up);
        let synchronised = self.phase == Phase::Synchronised;
        let own = |axis: AxisNumber| &view.parameters.axes[axis].gantry;
        let extended = |axis| self.extended.acts(axis, view.parameters);
        self.coupling.set_limits(|axis| (!followed_up).then(|| limits(own(axis), synchronised, extended(axis))));
        let monitored = !followed_up && self.phase != Phase::Open;
        let mut events = Events::new();
        self.coupling.compare(view.axes, &mut events);
        for event in &events {
            self.note_limit(event, synchronised, monitored, view, log);
        }
        for found in self.monitored() {
            let place = Place::Axis(found.axis);
            let channel = Parameter::Channel(view.owners.of(found.axis).channel);
            let shown = [channel, Parameter::Axis(found.axis), Parameter::None, Parameter::None];
            let raise = |alarm, cause| Want::Raise { alarm, place, shown, cause };
            wants.extend(found.warning.then(|| raise(alarms::GANTRY_WARNING_LIMIT, found.causes.warning)));
            wants.extend(found.trip.then(|| raise(alarms::GANTRY_TRIP_LIMIT, found.causes.trip)));
        }
        self.hold_trips(view, defined, log, wants);
    }

    /// Records the event that set or reset a warning or a trip.
    fn note_limit(
        &mut self,
        event: &CouplingEvent,
        synchronised: bool,
        monitored: bool,
        view: &View<'_>,
        log: &mut Log,
    ) {
        let axis = event.follower;
        let (own, extended) = (&view.parameters.axes[axis].gantry, self.extended.acts(axis, view.parameters));
        let trip = |limit| trip(limit, own, synchronised, extended);
        let gone = |rule| if monitored { rule } else { Rule::NotMonitored };
        let (is_trip, rule, limit) = match event.what {
            What::FirstExceeded(limit) => (false, warning(limit).0, Some(limit)),
            What::FirstBack(limit) => (false, gone(Rule::WarningGone), limit),
            What::SecondExceeded(limit) => (true, trip(limit).0, Some(limit)),
            What::SecondBack(limit) => (true, gone(Rule::TripGone), limit),
            What::Realigned | What::Released | What::Closed => return,
        };
        let datum = |limit| if is_trip { trip(limit).1 } else { warning(limit).1 };
        let measured = Input::Length(Quantity::SynchronismDifference, axis, event.difference);
        let inputs = match limit {
            None => [measured, Input::None, Input::None],
            Some(limit) => {
                let allowed = Input::Datum(datum(limit), Some(axis), limit.at.user());
                let base = limit.base.map(|base| Input::Length(Quantity::Base, axis, base));
                [measured, allowed, base.unwrap_or(Input::None)]
            }
        };
        let behind = self.coupling.members().map(|axis| view.axes[axis].causes.movement()).max();
        let cause = log.note(Place::Axis(axis), rule, inputs, behind.unwrap_or(EventId::NONE));
        let place = self.coupling.followers().position(|follower| follower == axis);
        if let Some(causes) = place.and_then(|place| self.limit_causes.get_mut(place)) {
            *(if is_trip { &mut causes.trip } else { &mut causes.warning }) = cause;
        }
        if extended && matches!(event.what, What::SecondExceeded(_)) {
            self.extended.trip(axis, event.difference);
        }
    }
}
