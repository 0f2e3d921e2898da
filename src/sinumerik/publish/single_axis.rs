//! The signals of an axis that is positioned alone: 63.0 to 63.2, 76.5, DBD78, and those of FC 18 (DBB104 to 107).

use crate::image::axis_from_nck;
use crate::sinumerik::publish::rows::{Rows, Why};
use crate::sinumerik::single_axis::state::{OrderedBy, Outcome};
use crate::sinumerik::state::State;
use crate::units::AxisNumber;

impl State {
    pub(super) fn show_single_axis(&self, number: AxisNumber, rows: &mut impl Rows) {
        let one = &self.single.axes[number];
        let control = || Why::Event(one.independence.cause);
        rows.bit(axis_from_nck::reset_executed, one.independence.reset, control);
        rows.bit(axis_from_nck::plc_controlled_axis, one.independence.taken, control);
        rows.bit(axis_from_nck::axis_stop_active, one.independence.stopped, control);
        let by_handwheel = self.axes[number].by_handwheel.filter(|one| one.is_axial && one.is_active);
        let handwheel = || {
            let cause = self.axes[number].by_handwheel.map_or(one.handwheel_cause, |by_handwheel| by_handwheel.cause);
            Why::Event(cause)
        };
        rows.bit(axis_from_nck::handwheel_override_active, by_handwheel.is_some(), handwheel);
        let positioning = || Why::Event(one.positioning_cause);
        rows.bit(axis_from_nck::positioning_axis, self.single.positioning.contains(number), positioning);
        rows.bytes(axis_from_nck::positioning_axis_f_function.byte, &one.feed.to_be_bytes(), positioning);
        let order = || Why::Event(one.cause);
        let active = one.spindle.is_some() || one.order.is_some_and(|order| order.by == OrderedBy::Plc);
        rows.bit(axis_from_nck::positioning_not_started, matches!(one.outcome, Outcome::Refused(_)), order);
        rows.bit(axis_from_nck::positioning_error, matches!(one.outcome, Outcome::Failed(_)), order);
        rows.bit(axis_from_nck::position_reached, one.outcome == Outcome::Reached, order);
        rows.bit(axis_from_nck::positioning_active, active, order);
        rows.number(axis_from_nck::positioning_error_number, one.outcome.error(), order);
    }
}
