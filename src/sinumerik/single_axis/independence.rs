//! The independent single axis: the PLC takes an axis out of the stop and the reset of its channel.
//!
//! | signal | effect | shown |
//! |---|---|---|
//! | 28.7 = 1 | NC stop, RESET and alarms of the channel do not act on the axis; its own alarms and those of the NCK do | 63.1 |
//! | 28.6 = 1 | it stops on its ramp, and keeps the rest of its way | 63.2 |
//! | 28.2 rises, 28.6 = 0 | it goes on | 63.2 = 0 |
//! | 28.1 = 1 | it stops, and drops the rest | 63.0 until 28.1 = 0 |
//! | 28.7 = 0 | axial reset; the channel rules again. With an alarm of the axis 26074, and the PLC keeps it until the alarm has gone | 63.x = 0 |

use crate::image::{AxisToNck, axis_to_nck};
use crate::sinumerik::alarms::{Reaction, axis_exchange as alarms};
use crate::sinumerik::exchange::state::Holder;
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::single_axis::state::{Independence, Outcome};
use crate::sinumerik::state::{State, Unit};
use crate::units::AxisNumber;
use crate::variables::{EventId, Input, Place};

impl State {
    /// 28.7, 28.6, 28.2 and 28.1 of one axis.
    pub(super) fn watch_independence(&mut self, axis: AxisNumber, signals: &AxisToNck) {
        let before = self.single.axes[axis].independence;
        let asks = signals.plc_controls_axis();
        self.single.axes[axis].independence.waits = asks && !before.taken;
        if !asks && !before.taken {
            return;
        }
        let Some(unit) = self.unit_of(axis) else { return };
        if !before.taken {
            if self.is_free_of_programs(&unit) {
                let pressed = axis_signal(axis, axis_to_nck::plc_controls_axis, true);
                self.note_independence(axis, Rule::PlcControls, pressed, |one| {
                    (one.taken, one.waits) = (true, false);
                });
            }
            return;
        }
        if !asks {
            self.give_control_back(axis, &unit);
            return;
        }
        self.stop_or_resume(axis, signals, before);
        let reset = signals.plc_controlled_axis_reset();
        self.single.axes[axis].independence.reset_was = reset;
        if reset && !before.reset_was {
            self.drop_order(axis, axis_signal(axis, axis_to_nck::plc_controlled_axis_reset, true));
        }
        // The reset is complete when the axis stands.
        let done = reset && self.single.axes[axis].order.is_none() && self.axes[axis].setpoint.is_at_rest();
        if done != before.reset {
            let pressed = axis_signal(axis, axis_to_nck::plc_controlled_axis_reset, reset);
            self.note_independence(axis, Rule::PlcResets, pressed, |one| {
                one.reset = done;
                one.stopped &= !done;
            });
        }
    }

    fn stop_or_resume(&mut self, axis: AxisNumber, signals: &AxisToNck, before: Independence) {
        let (stop, resume) = (signals.stop_along_braking_ramp(), signals.plc_controlled_axis_resume());
        self.single.axes[axis].independence.resume_was = resume;
        if stop && !before.stopped {
            let pressed = axis_signal(axis, axis_to_nck::stop_along_braking_ramp, true);
            self.note_independence(axis, Rule::PlcStops, pressed, |one| one.stopped = true);
        } else if before.stopped && !stop && resume && !before.resume_was {
            let pressed = axis_signal(axis, axis_to_nck::plc_controlled_axis_resume, true);
            self.note_independence(axis, Rule::PlcResumes, pressed, |one| one.stopped = false);
        }
    }

    /// 28.7 = 0.
    fn give_control_back(&mut self, axis: AxisNumber, unit: &Unit) {
        let released = axis_signal(axis, axis_to_nck::plc_controls_axis, false);
        let is_of_axis = |place: Place| matches!(place, Place::Axis(of) if unit.set.contains(of));
        let is_own = |place, alarm: &crate::sinumerik::Alarm| {
            is_of_axis(place)
                && alarm.reaction.has(Reaction::INTERFACE_SIGNALS)
                && alarm.number != alarms::NOT_GIVEN_BACK
        };
        if let Some((number, cause)) = self.alarms.first_alarm(is_own) {
            if !self.alarms.is_pending(alarms::NOT_GIVEN_BACK, Place::Axis(axis)) {
                let inputs = [released, Input::Alarm(number.0), Input::None];
                let event = self.log.note(Place::Axis(axis), Rule::ControlNotGivenBack, inputs, cause);
                self.raise_axis_alarm(alarms::NOT_GIVEN_BACK, axis, event);
            }
            return;
        }
        self.drop_order(axis, released);
        self.note_independence(axis, Rule::PlcControlsNoMore, released, |one| *one = Independence::default());
    }

    /// The rest of the way is dropped.
    fn drop_order(&mut self, axis: AxisNumber, input: Input) {
        if let Some(order) = &mut self.single.axes[axis].order {
            order.ending = Some(Outcome::None);
            self.single.axes[axis].cause =
                self.log.note_one(Place::Axis(axis), Rule::OrderDropped, input, EventId::NONE);
        }
    }

    fn note_independence(
        &mut self,
        axis: AxisNumber,
        rule: Rule,
        input: Input,
        change: impl FnOnce(&mut Independence),
    ) {
        let event = self.log.note_one(Place::Axis(axis), rule, input, EventId::NONE);
        let one = &mut self.single.axes[axis].independence;
        change(one);
        one.cause = event;
    }

    /// Whether no block of a program uses the axes of a unit: the PLC has them, and may be positioning them, or nothing uses them.
    pub(in crate::sinumerik) fn is_free_of_programs(&self, unit: &Unit) -> bool {
        let leader = unit.leader();
        self.owners.of(leader).holder == Holder::Plc || !self.owners.used.contains(leader)
    }
}
