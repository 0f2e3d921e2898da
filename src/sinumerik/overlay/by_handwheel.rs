//! Handwheel override in AUTOMATIC and MDA: FD on a path, FDA of a positioning axis, functions 7 and 8 of FC 18.
//!
//! The handwheel of an axis (DB31.DBX4.0 to 4.2, or the selection of the HMI) adds its pulses, weighted with the increment of the machine
//! function, to the velocity, at most MD32082; the velocity does not turn round. With FDA = 0 the pulses move the axis between its start and its
//! target. A path has the handwheel of its first geometry axis. 20080 is shown while no handwheel is assigned: the block runs without. Only
//! leading axes can be programmed, so the handwheel of a synchronous axis has no effect (MIS-02).
//!
//! Choices where the manuals leave one: the velocity is averaged over 100 ms (K-31); pulses that come while something holds the movement are dropped, as
//! MD20624 and MD32084 have it by default.

use crate::image::ToNck;
use crate::sinumerik::alarms::programs::NO_HANDWHEEL;
use crate::sinumerik::jog::handwheels::active_handwheel;
use crate::sinumerik::jog::state::Function;
use crate::sinumerik::overlay::state::HandwheelOverride;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, AxisSet, Position};
use crate::variables::{EventId, Input, Parameter, Place, RaisedAlarm};

/// The time over which the velocity of a handwheel is averaged, in seconds.
const AVERAGE: f64 = 0.1;

impl State {
    /// One cycle of the override of an axis: what its handwheel adds to the velocity, or `None` without a handwheel.
    pub(in crate::sinumerik) fn override_by_handwheel(
        &mut self,
        axis: AxisNumber,
        is_axial: bool,
        is_held: bool,
        (parameters, to_nck): (&Parameters, &ToNck),
    ) -> Option<f64> {
        let (way, handwheel) = self.turned_way(axis, parameters, to_nck);
        let cycle = parameters.cycle.seconds();
        let own = &parameters.axes[axis];
        let before = self.axes[axis].by_handwheel.unwrap_or_default();
        let mut now = HandwheelOverride { is_axial, is_active: handwheel.is_some(), ..before };
        let wanted = (way / cycle).clamp(-own.handwheel_velocity, own.handwheel_velocity);
        now.velocity += (if is_held { 0.0 } else { way / cycle } - now.velocity) * (cycle / AVERAGE).min(1.0);
        now.velocity = if now.velocity.abs() < 1.0 && wanted == 0.0 { 0.0 } else { now.velocity };
        let start = self.axes[axis].setpoint.position;
        let (start, moved) = before.way.unwrap_or((start, 0.0));
        now.way = Some((start, if is_held { moved } else { moved + way }));
        if now.is_active != before.is_active || self.axes[axis].by_handwheel.is_none() {
            let wheel = handwheel.unwrap_or(Input::None);
            let rule = if now.is_active { Rule::HandwheelOverrides } else { Rule::HandwheelMissing };
            now.cause = self.log.note_one(Place::Axis(axis), rule, wheel, EventId::NONE);
            let alarm = self.handwheel_alarm(axis);
            if now.is_active {
                self.alarms.end(&alarm, now.cause);
            } else {
                self.alarms.raise(alarm.number, alarm.place, alarm.parameters, now.cause);
            }
        }
        self.axes[axis].by_handwheel = Some(now);
        self.single.overridden.set(axis, true);
        let limit = own.handwheel_velocity;
        now.is_active.then(|| now.velocity.clamp(-limit, limit))
    }

    /// The overrides of all other axes have ended.
    pub(in crate::sinumerik) fn keep_handwheel_overrides(&mut self, kept: AxisSet) {
        let ended: Vec<_> =
            self.axes.iter().filter(|(axis, one)| one.by_handwheel.is_some() && !kept.contains(*axis)).collect();
        let ended: Vec<AxisNumber> = ended.into_iter().map(|(axis, _)| axis).collect();
        for axis in ended {
            let event = self.log.note_plain(Place::Axis(axis), Rule::HandwheelOverrideEnds, EventId::NONE);
            let alarm = self.handwheel_alarm(axis);
            self.alarms.end(&alarm, event);
            self.axes[axis].by_handwheel = None;
            self.single.axes[axis].handwheel_cause = event;
            self.log.news.set(axis, true);
        }
    }

    fn handwheel_alarm(&self, axis: AxisNumber) -> RaisedAlarm {
        let channel = Parameter::Channel(self.owners.of(axis).channel);
        let parameters = [channel, Parameter::Axis(axis), Parameter::None, Parameter::None];
        RaisedAlarm { number: NO_HANDWHEEL, place: Place::Axis(axis), parameters }
    }

    /// How far the pulses of this cycle move the axis, in increments, and its handwheel.
    fn turned_way(&self, axis: AxisNumber, parameters: &Parameters, to_nck: &ToNck) -> (f64, Option<Input>) {
        let signals = &to_nck.axes[axis];
        let mut active = signals.activated_handwheels();
        for (bit, handwheel) in self.handwheels.iter().enumerate() {
            active |= u8::from(handwheel.selected == Some(axis)) << bit;
        }
        // The first one counts.
        active &= active.wrapping_neg();
        if active == 0 {
            return (0.0, None);
        }
        let own = &parameters.axes[axis];
        let mut increment = Function::requested(signals.requested_machine_functions()).way(own);
        if own.handwheel_maximum != Position::ZERO {
            let most = own.handwheel_maximum.increments();
            increment = Position::new(increment.increments().clamp(-most, most));
        }
        let bit = active.trailing_zeros() as usize;
        let detents = self.handwheels.get(bit).map_or(0.0, |handwheel| {
            let per_detent = parameters.handwheel_pulses[bit];
            if per_detent.abs() > 0.0 { handwheel.moved as f64 / per_detent } else { 0.0 }
        });
        let sign = if signals.invert_handwheel_direction_of_rotation() { -1.0 } else { 1.0 };
        let way = (detents * increment.increments() as f64 * sign).clamp(-1e12, 1e12);
        (way, Some(active_handwheel(axis, active)))
    }
}

impl HandwheelOverride {
    /// FDA = 0: where the handwheel wants the axis, between its start and its target.
    pub(in crate::sinumerik) fn place(&self, target: Position) -> Position {
        let Some((start, moved)) = self.way else { return target };
        let (least, most) = if start < target { (start, target) } else { (target, start) };
        #[expect(
            clippy::cast_possible_truncation,
            reason = "the cast saturates, and the result is between two positions"
        )]
        let wanted = Position::new(start.increments().saturating_add(moved.round() as i64));
        wanted.max(least).min(most)
    }
}
