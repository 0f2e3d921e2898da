//! Conditions of the signals of an axis that is positioned alone: 63.0 to 63.2, 76.5, 104.0 to 104.7.

use crate::control::{Condition, Fact};
use crate::image::{axis_from_nck, axis_to_nck};
use crate::sinumerik::publish::conditions::look::{Look, Row, fact};
use crate::sinumerik::single_axis::state::{OrderedBy, Outcome};
use crate::units::AxisNumber;
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
        fact(what, look.state.single.axes[axis].independence.taken)
            .after(|| look.axis(axis, axis_to_nck::plc_controls_axis, true))
    }),
    Row::new(axis_from_nck::axis_stop_active, |look, axis| {
        let what = format!("stop of {}, which the PLC controls", look.axis_name(axis));
        fact(what, look.state.single.axes[axis].independence.stopped)
            .after(|| look.axis(axis, axis_to_nck::stop_along_braking_ramp, true))
    }),
    Row::new(axis_from_nck::handwheel_override_active, |look, axis| {
        let by_handwheel = look.state.axes[axis].by_handwheel.filter(|one| one.is_axial && one.is_active);
        fact(format!("a handwheel overrides the positioning of {}", look.axis_name(axis)), by_handwheel.is_some())
            .into()
    }),
    Row::new(axis_from_nck::positioning_axis, |look, axis| {
        let what = format!("the PLC, a synchronised action, POS or POSA positions {}", look.axis_name(axis));
        fact(what, look.state.single.positioning.contains(axis)).into()
    }),
    Row::new(axis_from_nck::positioning_active, |look, axis| {
        let order = look.state.single.axes[axis].order;
        let active = order.is_some_and(|order| order.by == OrderedBy::Plc);
        fact(format!("the PLC positions {}", look.axis_name(axis)), active).after(|| look.start_of_positioning(axis))
    }),
    Row::new(axis_from_nck::position_reached, |look, axis| look.ended(axis, "reached", Outcome::Reached)),
    Row::new(axis_from_nck::positioning_error, |look, axis| {
        let outcome = look.state.single.axes[axis].outcome;
        let what = format!("the positioning of {} has failed", look.axis_name(axis));
        fact(what, matches!(outcome, Outcome::Failed(_))).into()
    }),
    Row::new(axis_from_nck::positioning_not_started, |look, axis| {
        let outcome = look.state.single.axes[axis].outcome;
        let what = format!("the positioning of {} was refused", look.axis_name(axis));
        fact(what, matches!(outcome, Outcome::Refused(_))).into()
    }),
];

impl Look<'_> {
    /// The PLC starts a positioning: its start rises.
    pub(super) fn start_of_positioning(self, axis: AxisNumber) -> Condition {
        let was = self.state.single.axes[axis].start_was;
        let start = self.axis(axis, axis_to_nck::start_positioning_axis, true);
        Condition::All(vec![start, self.rises(Place::Axis(axis), axis_to_nck::start_positioning_axis, was)])
    }

    fn ended(self, axis: AxisNumber, wanted: &str, outcome: Outcome) -> Condition {
        let found = match self.state.single.axes[axis].outcome {
            Outcome::None => "none",
            Outcome::Reached => "reached",
            Outcome::Failed(_) => "failed",
            Outcome::Refused(_) => "refused",
        };
        let holds = self.state.single.axes[axis].outcome == outcome;
        Fact::new(format!("outcome of the positioning of {}", self.axis_name(axis)), found, wanted, holds).into()
    }
}
