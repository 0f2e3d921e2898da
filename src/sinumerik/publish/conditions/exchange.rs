//! Conditions of the exchange of axes: 68.4 to 68.7.

use crate::control::{Condition, Fact, fact};
use crate::image::{axis_from_nck, axis_to_nck};
use crate::sinumerik::exchange::state::Holder;
use crate::sinumerik::publish::conditions::look::{Look, Row};
use crate::units::AxisNumber;
use crate::variables::Place;

/// The signals.
pub(super) const ROWS: &[Row<AxisNumber>] = &[
    Row::new(axis_from_nck::axis_replacement_requested, |look, axis| {
        let of = look.state.owners.of(axis);
        let waits = of.request.is_some_and(|request| request.by.is_by_plc());
        let what = format!("the PLC has asked for an exchange of {} that is not carried out", look.axis_name(axis));
        let rises = look.rises(Place::Axis(axis), axis_to_nck::replacement_activation_signal, of.strobe_was);
        let strobe = look.axis(axis, axis_to_nck::replacement_activation_signal, true);
        fact(what, waits).after(|| Condition::All(vec![strobe, rises]))
    }),
    Row::new(axis_from_nck::axis_replacement_possible, |look, axis| {
        let possible = look.state.exchange_status(axis).possible;
        fact(format!("no block uses {}, and nothing positions it alone", look.axis_name(axis)), possible).into()
    }),
    Row::new(axis_from_nck::neutral_axis, |look, axis| look.held_by(axis, Holder::Neutral)),
    Row::new(axis_from_nck::plc_axis, |look, axis| look.held_by(axis, Holder::Plc)),
];

impl Look<'_> {
    fn held_by(self, axis: AxisNumber, wanted: Holder) -> Condition {
        let found = self.state.owners.of(axis).holder;
        Fact::new(format!("type of {}", self.axis_name(axis)), found.text(), wanted.text(), found == wanted).into()
    }
}
