//! Conditions of 101.x: definition, limits of the difference, ready, synchronised.

use crate::control::{Condition, Fact, fact, yes};
use crate::image::{axis_from_nck, axis_to_nck, channel_from_nck};
use crate::sinumerik::gantry::state::{Grouping, Phase};
use crate::sinumerik::parameters::dynamics::StopLimit;
use crate::sinumerik::publish::conditions::look::{Look, Row, length};
use crate::sinumerik::state::Unit;
use crate::units::AxisNumber;
use crate::variables::Place;

/// The signals.
pub(super) const ROWS: &[Row<AxisNumber>] = &[
    Row::new(axis_from_nck::gantry_trip_limit_exceeded, |look, axis| look.beyond(axis, true)),
    Row::new(axis_from_nck::gantry_warning_limit_exceeded, |look, axis| look.beyond(axis, false)),
    Row::with(
        axis_from_nck::gantry_synchronization_ready_to_start,
        |look, owner| look.ready(owner),
        |look, owner| look.ready_no_more(owner),
    ),
    Row::with(
        axis_from_nck::gantry_grouping_is_synchronized,
        |look, owner| look.synchronised(owner),
        |look, owner| look.synchronised_no_more(owner),
    ),
    Row::new(axis_from_nck::gantry_leading_axis, |look, owner| look.leads(owner)),
    Row::new(axis_from_nck::gantry_axis, |look, axis| {
        let name = look.axis_name(axis);
        fact(format!("{name} belongs to a gantry grouping (MD37100 at power on)"), look.grouping(axis).is_some()).into()
    }),
];

impl<'a> Look<'a> {
    fn leads(self, axis: AxisNumber) -> Condition {
        let leads = self.led_by(axis).is_some();
        fact(format!("{} leads a gantry grouping (MD37100 at power on)", self.axis_name(axis)), leads).into()
    }

    fn led_by(self, axis: AxisNumber) -> Option<&'a Grouping> {
        self.state.groupings.iter().find(|grouping| grouping.coupling.leader() == axis)
    }

    fn beyond(self, number: AxisNumber, trip: bool) -> Condition {
        let name = self.axis_name(number);
        let found = self.state.groupings.iter().find_map(|grouping| {
            let found = grouping.monitored().find(|monitored| monitored.axis == number)?;
            Some((grouping, found))
        });
        let Some((grouping, found)) = found else {
            return fact(format!("{name} is a synchronous axis (MD37100 at power on)"), false).into();
        };
        let Some((limit, datum)) = grouping.limit(number, trip, &self.state.axes, self.parameters) else {
            if grouping.coupling.limits(number, &self.state.axes).is_some() {
                return fact(format!("{name} has a warning limit (MD37110 above 0)"), false).into();
            }
            let what = format!("the difference of {name} is monitored: the grouping is closed and not in follow-up");
            return fact(what, false).into();
        };
        let what = limit.base.map_or_else(
            || format!("synchronism difference of {name}"),
            |base| format!("distance of {name} from its base {}", length(base)),
        );
        let shown = limit.base.map_or(found.difference, |_| limit.distance(found.difference));
        let wanted = format!("above {} (MD{datum})", length(limit.at));
        Fact::new(what, length(shown), wanted, if trip { found.trip } else { found.warning }).into()
    }

    fn phase(self, grouping: &Grouping, wanted: &str, holds: bool) -> Fact {
        Fact::new(format!("gantry grouping {}", grouping.number), grouping.phase.text(), wanted, holds)
    }

    /// 101.4 of the leading axis.
    fn ready(self, number: AxisNumber) -> Condition {
        let Some(grouping) = self.led_by(number) else { return self.leads(number) };
        let started = grouping.phase == Phase::Synchronising && grouping.waited_for;
        let holds = grouping.phase == Phase::WaitingForStart || started;
        self.phase(grouping, Phase::WaitingForStart.text(), holds).after(|| match grouping.phase {
            Phase::NotSynchronised => self.can_wait(grouping),
            Phase::ReferencingLeadingAxis | Phase::ReferencingSynchronousAxis => self.next_section(grouping),
            Phase::Synchronising => {
                fact("the grouping waited before it started (an automatic start does not)", false).into()
            }
            Phase::Synchronised => fact("the grouping has lost its synchronism", false).into(),
            Phase::WaitingForStart => Condition::NOTHING,
            Phase::Open => self.closes(grouping),
        })
    }

    /// E-13: all referenced, not in follow-up, every difference within MD37130.
    fn can_wait(self, grouping: &Grouping) -> Condition {
        let coupling = &grouping.coupling;
        let mut all: Vec<_> = coupling.members().map(|axis| self.reference_signal(axis)).collect();
        all.extend(coupling.members().map(|axis| self.no_follow_up(axis)));
        for axis in coupling.followers() {
            let limit = self.parameters.axes[axis].gantry.trip_limit_not_synchronised;
            if let Some(apart) = coupling.misalignment(axis, &self.state.axes) {
                let what = format!("distance of {} from the leading axis", self.axis_name(axis));
                let wanted = format!("at most {} (MD37130)", length(limit));
                all.push(Fact::new(what, length(apart), wanted, apart.abs() <= limit).into());
            }
            all.push(self.axis(axis, axis_from_nck::gantry_trip_limit_exceeded, false));
        }
        Condition::All(all)
    }

    /// A parked axis does not show its follow-up, which the grouping still reads.
    fn no_follow_up(self, axis: AxisNumber) -> Condition {
        if self.state.axes[axis].measuring_system.is_none() {
            return self.not_parked(axis);
        }
        self.axis(axis, axis_from_nck::follow_up_active, false)
    }

    /// Sections 1 and 2 go on when their axis is referenced.
    fn next_section(self, grouping: &Grouping) -> Condition {
        let left = grouping.coupling.followers().skip(usize::from(grouping.turn) + 1);
        let now = grouping.referencing();
        let open: Vec<_> = match grouping.phase {
            Phase::ReferencingLeadingAxis => grouping.coupling.members().collect(),
            Phase::NotSynchronised
            | Phase::ReferencingSynchronousAxis
            | Phase::WaitingForStart
            | Phase::Synchronising
            | Phase::Synchronised
            | Phase::Open => now.into_iter().chain(left).collect(),
        };
        Condition::All(open.into_iter().map(|axis| self.reference_signal(axis)).collect())
    }

    fn closes(self, grouping: &Grouping) -> Condition {
        let open = grouping.coupling.members().find(|&axis| self.parameters.axes[axis].gantry.broken_up);
        let found = open.map_or_else(|| "0".to_owned(), |axis| format!("1 on {}", self.axis_name(axis)));
        let datum = Fact::new("MD37140 of the grouping", found, "0", open.is_none());
        Condition::All(vec![
            datum.into(),
            Fact::new("a movement was pending at closing (10658)", yes(grouping.kept_open), "no", !grouping.kept_open)
                .into(),
        ])
    }

    /// 101.5 of the leading axis.
    fn synchronised(self, number: AxisNumber) -> Condition {
        let Some(grouping) = self.led_by(number) else { return self.leads(number) };
        let holds = grouping.phase == Phase::Synchronised;
        self.phase(grouping, Phase::Synchronised.text(), holds).after(|| match grouping.phase {
            Phase::NotSynchronised => self.axis(number, axis_from_nck::gantry_synchronization_ready_to_start, true),
            Phase::ReferencingLeadingAxis | Phase::ReferencingSynchronousAxis => self.next_section(grouping),
            Phase::WaitingForStart => Condition::Any(vec![self.starts(grouping), self.restores(grouping)]),
            Phase::Synchronising => self.arrives(grouping),
            Phase::Synchronised => Condition::NOTHING,
            Phase::Open => self.closes(grouping),
        })
    }

    /// SYN-06: synchronism that follow-up took in operation returns with position control of all axes.
    fn restores(self, grouping: &Grouping) -> Condition {
        let leader = grouping.coupling.leader();
        let mut all = vec![
            fact("synchronism was lost in operation, by follow-up", grouping.lost_in_operation).into(),
            fact("the grouping returns from follow-up", grouping.returning).into(),
            self.axis(leader, axis_to_nck::no_automatic_synchronization, false),
        ];
        all.extend(grouping.coupling.members().map(|axis| self.in_control(axis)));
        for axis in grouping.coupling.followers() {
            let Some(apart) = grouping.coupling.misalignment(axis, &self.state.axes) else { continue };
            let set = self.state.axes[axis].active_set(&self.parameters.axes[axis]);
            let (window, data) = set.window(StopLimit::Standstill);
            let what = format!("distance of {} from the leading axis", self.axis_name(axis));
            all.push(
                Fact::new(what, length(apart), format!("at most {} ({data})", length(window)), apart.abs() <= window)
                    .into(),
            );
        }
        Condition::All(all)
    }

    /// 29.4 rises while a synchronising motion may run.
    pub(super) fn starts(self, grouping: &Grouping) -> Condition {
        let leader = grouping.coupling.leader();
        let unit = self.unit(leader);
        let start = self.axis(leader, axis_to_nck::start_gantry_synchronization, true);
        let rises = self.rises(Place::Axis(leader), axis_to_nck::start_gantry_synchronization, grouping.start_was);
        let channel = self.channel(unit.channel, channel_from_nck::referencing_active, false);
        Condition::All(vec![start, rises, channel, self.permit(&unit)])
    }

    /// Referencing is allowed, every axis is in position control, nothing stops, no limit switch is pressed.
    fn permit(self, unit: &Unit) -> Condition {
        let mut all = vec![self.may_reference(unit), self.can_move(unit)];
        for axis in unit.members() {
            all.push(self.axis(axis, axis_to_nck::hardware_limit_switch_minus, false));
            all.push(self.axis(axis, axis_to_nck::hardware_limit_switch_plus, false));
        }
        Condition::All(all)
    }

    /// The synchronising motion of each axis ends within exact stop fine.
    fn arrives(self, grouping: &Grouping) -> Condition {
        let unit = self.unit(grouping.coupling.leader());
        let mut all = vec![self.permit(&unit), self.not_held(&unit)];
        for axis in grouping.coupling.members() {
            let arrived = self.state.axes[axis].arrived;
            let what = format!("{} has reached the common position", self.axis_name(axis));
            all.push(fact(what, arrived).into());
            all.push(self.deviation(axis, StopLimit::Fine));
        }
        Condition::All(all)
    }

    /// 101.5 is lost by follow-up, by a lost reference, by a new approach, or by opening.
    fn synchronised_no_more(self, number: AxisNumber) -> Condition {
        let Some(grouping) = self.led_by(number) else { return self.leads(number).opposite() };
        let holds = grouping.phase != Phase::Synchronised;
        self.phase(grouping, "not synchronised", holds).after(|| {
            let mut any = self.losses(grouping);
            any.push(fact("a new approach of the leading axis begins", false).into());
            Condition::Any(any)
        })
    }

    fn losses(self, grouping: &Grouping) -> Vec<Condition> {
        let members = || grouping.coupling.members();
        let mut any: Vec<_> = members().map(|axis| self.no_follow_up(axis).opposite()).collect();
        any.extend(members().map(|axis| self.reference_signal(axis).opposite()));
        let open = members().any(|axis| self.parameters.axes[axis].gantry.broken_up);
        any.push(fact("MD37140 = 1 of an axis of the grouping", open).into());
        any
    }

    fn ready_no_more(self, number: AxisNumber) -> Condition {
        let Some(grouping) = self.led_by(number) else { return self.leads(number).opposite() };
        let ready =
            grouping.phase == Phase::WaitingForStart || grouping.phase == Phase::Synchronising && grouping.waited_for;
        self.phase(grouping, "not waiting", !ready).after(|| {
            let mut any = self.losses(grouping);
            let trips = |axis| self.axis(axis, axis_from_nck::gantry_trip_limit_exceeded, true);
            any.extend(grouping.coupling.followers().map(trips));
            if grouping.phase == Phase::Synchronising {
                any.push(self.axis(number, axis_from_nck::gantry_grouping_is_synchronized, true));
            } else {
                any.push(fact("the grouping is synchronised or a new approach begins", false).into());
            }
            Condition::Any(any)
        })
    }
}
