//! Handwheel override in AUTOMATIC and MDA: FD on a path, FDA of a positioning axis, functions 7 and 8 of FC 18.
//!
//! Called by the movement of a program and of an axis that is positioned alone, once per cycle for each axis whose block or order asks for
//! it. The handwheel of an axis (DB31.DBX4.0 to 4.2, or the selection of the HMI) adds its pulses, weighted with the increment of the machine
//! function, to the velocity, at most MD32082. With FDA = 0 the pulses move the axis between its start and its target. Without a handwheel
//! 20080 is shown, and the block runs as programmed. Writes DB31.DBX62.1 and DB21.DBX33.3. Only leading axes can be programmed, so the
//! handwheel of a synchronous axis has no effect (MIS-02).
//!
//! Choices where the manuals leave one are K-31 of `docs/decisions.md`.

use crate::image::{Signal, ToNck, axis_to_nck};
use crate::sinumerik::alarms::programs::NO_HANDWHEEL;
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::jog::handwheels::limited;
use crate::sinumerik::jog::state::Function;
use crate::sinumerik::overlay::state::HandwheelOverride;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, AxisSet, Position};
use crate::variables::{EventId, Parameter, Place};

/// None of them is 1 without a handwheel.
const NOT_ACTIVATED: [Signal; 3] =
    [axis_to_nck::activate_handwheel_1, axis_to_nck::activate_handwheel_2, axis_to_nck::activate_handwheel_3];
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
        let (turned, active) = self.turned_way(axis, parameters, to_nck);
        let turned = if is_held { 0.0 } else { turned };
        let cycle = parameters.cycle.seconds();
        let before = self.axes[axis].by_handwheel;
        let mut now = HandwheelOverride { is_axial, is_active: active != 0, turned, ..before.unwrap_or_default() };
        now.velocity += (turned / cycle - now.velocity) * (cycle / AVERAGE).min(1.0);
        // Less than an increment per second is nothing.
        now.velocity = if now.velocity.abs() < 1.0 && turned == 0.0 { 0.0 } else { now.velocity };
        if before.is_none_or(|before| before.is_active != now.is_active) {
            let (rule, inputs) = if now.is_active {
                (Rule::HandwheelOverrides, self.selection_inputs(axis, active, &to_nck.axes[axis]))
            } else {
                (Rule::HandwheelMissing, NOT_ACTIVATED.map(|signal| axis_signal(axis, signal, false)))
            };
            now.cause = self.log.note(Place::Axis(axis), rule, inputs, EventId::NONE);
        }
        if !now.is_active {
            // It ends by itself when this is not called in a cycle.
            let channel = Parameter::Channel(self.owners.of(axis).channel);
            let parameters = [channel, Parameter::Axis(axis), Parameter::None, Parameter::None];
            self.alarms.raise(NO_HANDWHEEL, Place::Axis(axis), parameters, now.cause);
        }
        self.axes[axis].by_handwheel = Some(now);
        self.single.overridden.set(axis, true);
        self.log.news.set(axis, true);
        let limit = parameters.axes[axis].handwheel_velocity;
        now.is_active.then(|| now.velocity.clamp(-limit, limit))
    }

    /// FDA = 0: where the handwheel wants an axis that goes to a target. It keeps between its start and the target.
    pub(in crate::sinumerik) fn place_by_handwheel(&mut self, axis: AxisNumber, target: Position) -> Position {
        let here = self.axes[axis].setpoint.position;
        let Some(now) = self.axes[axis].by_handwheel.as_mut().filter(|now| now.is_active) else { return target };
        let (start, moved) = now.way.unwrap_or((here, 0.0));
        let whole = (target - start).increments() as f64;
        let moved = (moved + now.turned).clamp(whole.min(0.0), whole.max(0.0));
        now.way = Some((start, moved));
        #[expect(clippy::cast_possible_truncation, reason = "the result is between two positions")]
        let way = Position::new(moved.round() as i64);
        start + way
    }

    /// Another positioning of an axis begins: its way by handwheel begins where the axis is then.
    pub(in crate::sinumerik) fn begin_way_by_handwheel(&mut self, axis: AxisNumber) {
        if let Some(now) = &mut self.axes[axis].by_handwheel {
            now.way = None;
        }
    }

    /// The overrides of all other axes have ended.
    pub(in crate::sinumerik) fn keep_handwheel_overrides(&mut self, kept: AxisSet) {
        let has_ended = |axis: AxisNumber, of: Option<HandwheelOverride>| of.is_some() && !kept.contains(axis);
        let ended = self.axes.iter().filter(|(axis, one)| has_ended(*axis, one.by_handwheel));
        let ended: AxisSet = ended.map(|(axis, _)| axis).collect();
        for axis in ended.iter() {
            let event = self.log.note_plain(Place::Axis(axis), Rule::HandwheelOverrideEnds, self.end_of_override(axis));
            self.axes[axis].by_handwheel = None;
            self.single.axes[axis].handwheel_cause = event;
            self.log.news.set(axis, true);
        }
    }

    /// The event that ended the override of an axis: that of its order in this cycle, else the latest one of its movement and its program.
    fn end_of_override(&self, axis: AxisNumber) -> EventId {
        let of_order = self.single.axes[axis].cause;
        let is_axial = self.axes[axis].by_handwheel.is_some_and(|one| one.is_axial);
        if is_axial && self.log.is_of_this_cycle(of_order) {
            return of_order;
        }
        let program = &self.programs[self.owners.of(axis).channel];
        self.axes[axis].causes.motion.max(program.block_cause()).max(program.cause)
    }

    /// How far the pulses of this cycle move the axis, in increments, and the bit of its handwheel; 0 without one.
    fn turned_way(&self, axis: AxisNumber, parameters: &Parameters, to_nck: &ToNck) -> (f64, u8) {
        let signals = &to_nck.axes[axis];
        let mut active = signals.activated_handwheels();
        for (bit, handwheel) in self.handwheels.iter().enumerate() {
            active |= u8::from(handwheel.selected == Some(axis)) << bit;
        }
        // The first one counts.
        active &= active.wrapping_neg();
        if active == 0 {
            return (0.0, 0);
        }
        let own = &parameters.axes[axis];
        let increment = Function::requested(signals.requested_machine_functions()).way(own);
        let increment = limited(increment, own.handwheel_maximum).increments() as f64;
        let bit = active.trailing_zeros() as usize;
        let detents = self.handwheels.get(bit).map_or(0.0, |handwheel| {
            let per_detent = parameters.handwheel_pulses[bit];
            if per_detent.abs() > 0.0 { handwheel.moved as f64 / per_detent } else { 0.0 }
        });
        let sign = if signals.invert_handwheel_direction_of_rotation() { -1.0 } else { 1.0 };
        ((detents * increment * sign).clamp(-1e12, 1e12), active)
    }
}
