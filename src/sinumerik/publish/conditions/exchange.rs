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
    Row::with(
        axis_from_nck::axis_replacement_possible,
        |look, axis| look.free_for_exchange(axis, true),
        |look, axis| look.free_for_exchange(axis, false),
    ),
    Row::with(
        axis_from_nck::neutral_axis,
        |look, axis| look.held_by(axis, Holder::Neutral),
        |look, axis| look.held_by_another(axis, Holder::Neutral),
    ),
    Row::with(
        axis_from_nck::plc_axis,
        |look, axis| look.held_by(axis, Holder::Plc),
        |look, axis| look.held_by_another(axis, Holder::Plc),
    ),
];

impl Look<'_> {
    fn holder(self, axis: AxisNumber, wanted: Holder, is: bool) -> Fact {
        let found = self.state.owners.of(axis).holder;
        let not = if is { "" } else { "not " };
        let what = format!("type of {}", self.axis_name(axis));
        Fact::new(what, found.text(), format!("{not}{}", wanted.text()), (found == wanted) == is)
    }

    fn held_by(self, axis: AxisNumber, wanted: Holder) -> Condition {
        self.holder(axis, wanted, true).after(|| match wanted {
            Holder::Plc => self.asked_by_plc(axis, true),
            Holder::Neutral | Holder::Program | Holder::Command => {
                self.by_program(axis, "one that releases the axis (RELEASE, WAITP)")
            }
        })
    }

    fn held_by_another(self, axis: AxisNumber, left: Holder) -> Condition {
        self.holder(axis, left, false).after(|| match left {
            Holder::Plc => self.asked_by_plc(axis, false),
            Holder::Neutral | Holder::Program | Holder::Command => Condition::Any(vec![
                self.asked_by_plc(axis, true),
                self.by_program(axis, "one that takes the axis (GET), or moves it"),
            ]),
        })
    }

    /// The PLC asks for an axis, or gives it back.
    fn asked_by_plc(self, axis: AxisNumber, takes: bool) -> Condition {
        let strobe = axis_to_nck::replacement_activation_signal;
        let waits = self.state.owners.of(axis).request.is_some_and(|request| request.by.is_by_plc());
        if waits {
            let what = format!("exchange of {} that the PLC asks for", self.axis_name(axis));
            return Condition::All(vec![
                self.axis(axis, axis_from_nck::axis_replacement_possible, true),
                Fact::new(what, "waits", "done", false).into(),
            ]);
        }
        Condition::All(vec![
            self.axis(axis, axis_to_nck::request_plc_axis, takes),
            self.axis(axis, strobe, true),
            self.rises(Place::Axis(axis), strobe, self.state.owners.of(axis).strobe_was),
        ])
    }

    /// A block of a program of the channel of an axis.
    pub(super) fn by_program(self, axis: AxisNumber, what: &str) -> Condition {
        self.reaches(self.state.owners.of(axis).channel, what)
    }

    /// 68.5.
    fn free_for_exchange(self, axis: AxisNumber, wanted: bool) -> Condition {
        let possible = self.state.exchange_status(axis).possible;
        let unit = self.unit(axis);
        let one = &self.state.single.axes[unit.leader()];
        let alone = one.order.is_some() || one.spindle.is_some();
        let found = match (possible, alone) {
            (true, _) => "nothing",
            (false, true) => "its positioning alone",
            (false, false) => "a block of a program",
        };
        let what = format!("what uses {}", self.axis_name(axis));
        let expected = if wanted { "nothing" } else { "a block, or a positioning alone" };
        Fact::new(what, found, expected, possible == wanted).after(|| match (wanted, alone) {
            (true, true) => Fact::new("order for this axis", "runs", "ended", false).into(),
            (true, false) => self.by_program(axis, "one that does not use the axis"),
            (false, _) => {
                Condition::Any(vec![self.start_by_plc(axis), self.by_program(axis, "one that moves the axis")])
            }
        })
    }
}
