//! Conditions of the signals of an axis that is positioned alone: 63.0 to 63.2, 76.5, 104.0 to 104.7.

use crate::control::{Condition, Fact, fact, yes};
use crate::image::{axis_from_nck, axis_to_nck, nck_from_nck};
use crate::sinumerik::publish::conditions::look::{Look, Row, length};
use crate::sinumerik::single_axis::state::{OrderedBy, Outcome, SpindleOrder};
use crate::units::{AxisNumber, Position};
use crate::variables::Place;

/// The signals.
pub(super) const ROWS: &[Row<AxisNumber>] = &[
    Row::new(axis_from_nck::reset_executed, |look, axis| {
        let what = format!("reset of {}, which the PLC controls, is complete", look.axis_name(axis));
        fact(what, look.state.single.axes[axis].independence.reset)
            .after(|| look.axis(axis, axis_to_nck::plc_controlled_axis_reset, true))
    }),
    Row::new(axis_from_nck::plc_controlled_axis, |look, axis| {
        let what = format!("the PLC controls {}", look.axis_name(axis));
        fact(what, look.state.single.axes[axis].independence.taken).after(|| {
            // set while a block uses the axis, 28.7 takes effect when no block uses it any more.
            let is_free = look.state.unit_of(axis).is_some_and(|unit| look.state.is_free_of_programs(&unit));
            let free = fact(format!("no block of a program uses {}", look.axis_name(axis)), is_free);
            Condition::All(vec![look.axis(axis, axis_to_nck::plc_controls_axis, true), free.into()])
        })
    }),
    Row::new(axis_from_nck::axis_stop_active, |look, axis| {
        let what = format!("stop of {}, which the PLC controls", look.axis_name(axis));
        fact(what, look.state.single.axes[axis].independence.stopped)
            .after(|| look.axis(axis, axis_to_nck::stop_along_braking_ramp, true))
    }),
    Row::new(axis_from_nck::handwheel_override_active, |look, axis| {
        let by_handwheel = look.state.axes[axis].by_handwheel.filter(|one| one.is_axial && one.is_active);
        fact(format!("a handwheel overrides the positioning of {}", look.axis_name(axis)), by_handwheel.is_some())
            .after(|| look.override_begins(axis, true))
    }),
    Row::with(
        axis_from_nck::positioning_axis,
        |look, axis| look.positioned(axis, true),
        |look, axis| look.positioned(axis, false),
    ),
    Row::with(
        axis_from_nck::positioning_active,
        |look, axis| look.by_plc(axis, true).after(|| look.start_by_plc(axis)),
        |look, axis| look.by_plc(axis, false).after(|| look.end_by_plc(axis)),
    ),
    Row::with(
        axis_from_nck::position_reached,
        |look, axis| look.outcome(axis, "reached", |outcome| outcome == Outcome::Reached),
        |look, axis| look.outcome_is_over(axis, "reached", |outcome| outcome == Outcome::Reached),
    ),
    Row::with(
        axis_from_nck::positioning_error,
        |look, axis| look.outcome(axis, "failed", |outcome| matches!(outcome, Outcome::Failed(_))),
        |look, axis| look.outcome_is_over(axis, "failed", |outcome| matches!(outcome, Outcome::Failed(_))),
    ),
    Row::with(
        axis_from_nck::positioning_not_started,
        |look, axis| look.outcome(axis, "refused", |outcome| matches!(outcome, Outcome::Refused(_))),
        |look, axis| look.outcome_is_over(axis, "refused", |outcome| matches!(outcome, Outcome::Refused(_))),
    ),
];

impl Look<'_> {
    fn by_plc(self, axis: AxisNumber, wanted: bool) -> Fact {
        let one = &self.state.single.axes[axis];
        let active = one.spindle.is_some() || one.order.is_some_and(|order| order.by == OrderedBy::Plc);
        let what = format!("order of the PLC for {} (FC 18)", self.axis_name(axis));
        let word = |runs| if runs { "runs" } else { "none" };
        Fact::new(what, word(active), word(wanted), active == wanted)
    }

    /// The PLC starts the positioning of a PLC axis, or a function of a spindle: its start rises.
    pub(super) fn start_by_plc(self, axis: AxisNumber) -> Condition {
        let one = &self.state.single.axes[axis];
        let mut all = vec![self.axis(axis, axis_from_nck::plc_axis, true)];
        if self.spindle(axis).is_some() {
            let starts = SpindleOrder::ALL.map(|order| self.axis(axis, order.start(), true));
            let what = format!("the start of a function of {} rises: all were 0 before", self.axis_name(axis));
            all.extend([Condition::Any(starts.into()), fact(what, one.spindle_was.is_none()).into()]);
        } else {
            let start = axis_to_nck::start_positioning_axis;
            all.extend([self.axis(axis, start, true), self.rises(Place::Axis(axis), start, one.start_was)]);
        }
        Condition::All(all)
    }

    /// What ends an order of the PLC before its end.
    fn end_by_plc(self, axis: AxisNumber) -> Condition {
        let one = &self.state.single.axes[axis];
        match (one.order, one.spindle) {
            (Some(order), _) if order.ending.is_some() => self.setpoint_rests(axis),
            (Some(_), _) => {
                let start = self.axis(axis, axis_to_nck::start_positioning_axis, false);
                let ends = self.ends_positioning(axis, &self.unit(axis));
                Condition::Any(std::iter::once(start).chain(ends).collect())
            }
            (None, _) => Condition::Any(self.ends_of_spindle_function(axis)),
        }
    }

    /// What ends a function of the PLC for a spindle.
    pub(super) fn ends_of_spindle_function(self, axis: AxisNumber) -> Vec<Condition> {
        let one = &self.state.single.axes[axis];
        let place = Place::Axis(axis);
        let pressed = |signal, was| Condition::All(vec![self.axis(axis, signal, true), self.rises(place, signal, was)]);
        let own = match one.spindle {
            Some(SpindleOrder::Rotate) => pressed(axis_to_nck::stop_spindle_rotation, one.spindle_stop_was),
            Some(SpindleOrder::Oscillate) => pressed(axis_to_nck::stop_spindle_oscillation, one.spindle_stop_was),
            Some(SpindleOrder::Position) | None => self.axis(axis, axis_to_nck::start_spindle_positioning, false),
        };
        let reset_was = self.state.spindles[axis].as_deref().is_some_and(|spindle| spindle.reset_was);
        let reset = pressed(axis_to_nck::delete_distance_to_go_spindle_reset, reset_was);
        vec![own, reset, self.nck(nck_from_nck::emergency_stop_active, true)]
    }

    /// 76.5.
    fn positioned(self, axis: AxisNumber, wanted: bool) -> Condition {
        let found = self.state.single.positioning.contains(axis);
        let what = format!("the PLC, a synchronised action, POS or POSA positions {}", self.axis_name(axis));
        Fact::new(what, yes(found), yes(wanted), found == wanted).after(|| {
            let channel = self.state.owners.of(axis).channel;
            let order = self.state.single.axes[axis].order;
            match (wanted, order) {
                (true, _) => {
                    let by_program = self.reaches(channel, "one with POS or POSA of the axis");
                    Condition::Any(vec![by_program, self.start_by_plc(axis)])
                }
                (false, Some(order)) => {
                    let ends = self.ends_positioning(axis, &self.unit(axis));
                    Condition::Any(std::iter::once(self.way_left(axis, Some(order.target))).chain(ends).collect())
                }
                (false, None) => {
                    let run = self.state.programs[channel].run.as_deref();
                    let one = run.and_then(|run| run.positionings.iter().find(|one| one.axis == axis));
                    self.way_left(axis, one.map(|one| one.target))
                }
            }
        })
    }

    /// A positioning ends at its target.
    fn way_left(self, axis: AxisNumber, target: Option<Position>) -> Condition {
        let position = self.state.axes[axis].setpoint.position;
        let left = target.map_or(Position::ZERO, |target| (target - position).abs());
        let what = format!("distance of {} from its target", self.axis_name(axis));
        Fact::new(what, length(left), "0, in exact stop", false).into()
    }

    fn shown_outcome(self, axis: AxisNumber, wanted: String, holds: bool) -> Fact {
        let found = match self.state.single.axes[axis].outcome {
            Outcome::None => "none",
            Outcome::Reached => "reached",
            Outcome::Failed(_) => "failed",
            Outcome::Refused(_) => "refused",
        };
        Fact::new(format!("outcome of the positioning of {}", self.axis_name(axis)), found, wanted, holds)
    }

    /// The outcome of an order of the PLC: it needs one that runs.
    fn outcome(self, axis: AxisNumber, wanted: &str, is: impl Fn(Outcome) -> bool) -> Condition {
        let one = &self.state.single.axes[axis];
        self.shown_outcome(axis, wanted.to_owned(), is(one.outcome)).after(|| {
            if one.order.is_none() && one.spindle.is_none() {
                return self.start_by_plc(axis);
            }
            let what = format!("end of the order of the PLC for {}", self.axis_name(axis));
            Fact::new(what, "not there", wanted, false).into()
        })
    }

    /// An outcome stays until the PLC takes its start back.
    fn outcome_is_over(self, axis: AxisNumber, left: &str, is: impl Fn(Outcome) -> bool) -> Condition {
        let holds = !is(self.state.single.axes[axis].outcome);
        self.shown_outcome(axis, format!("not {left}"), holds).after(|| {
            if self.spindle(axis).is_none() && !self.state.single.axes[axis].start_was {
                let what = format!("order of the PLC for {} after this outcome", self.axis_name(axis));
                return Fact::new(what, "none", "one", false).into();
            }
            if self.spindle(axis).is_none() {
                return self.axis(axis, axis_to_nck::start_positioning_axis, false);
            }
            Condition::All(SpindleOrder::ALL.map(|order| self.axis(axis, order.start(), false)).into())
        })
    }
}
