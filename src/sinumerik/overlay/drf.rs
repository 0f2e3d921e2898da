//! The stage of the DRF offset.
//!
//! In AUTOMATIC and MDA with DB21.DBX0.3 = 1, a pulse of the handwheel of an axis adds an increment of its machine function to the offset. The
//! axis moves there at MD32020 (SD41110 if it is not 0) times MD32090, at most. Of a closed grouping only the handwheel of the leading axis
//! counts; all axes of the grouping get the same offset (MIS-02). The offset is kept over blocks, modes and RESET. DRFOF, PRESET and a new
//! reference point approach end it without a movement: the offset becomes part of the coordinates (K-11). Power on clears it.

use crate::image::ToNck;
use crate::motion::Limits;
use crate::sinumerik::alarms;
use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::inputs::{axis_signal, channel_signal};
use crate::sinumerik::jog::handwheels::{active_handwheel, limited};
use crate::sinumerik::jog::state::Function;
use crate::sinumerik::nck::Nck;
use crate::sinumerik::operation::state::Mode;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::{AxisNumber, Position};
use crate::variables::{EventId, Input, Place};

impl Nck {
    /// The stage.
    pub(in crate::sinumerik) fn overlay(&mut self, to_nck: &ToNck) {
        let (parameters, state) = (&*self.parameters, &mut *self.state);
        for index in 0..state.units.len() {
            let unit = state.units[index];
            let selected = to_nck.channels[unit.channel].activate_drf();
            if !selected && state.axes[unit.leader()].overlay.rests() {
                continue;
            }
            let before = state.axes[unit.leader()].overlay;
            state.overlay_unit(&unit, selected, parameters, to_nck);
            if state.axes[unit.leader()].overlay != before {
                unit.members().for_each(|member| self.resting.hear(member));
            }
        }
    }
}

impl State {
    fn overlay_unit(&mut self, unit: &Unit, selected: bool, parameters: &Parameters, to_nck: &ToNck) {
        let number = unit.leader();
        let runs_programs = matches!(self.mode_group(unit).mode, Mode::Automatic | Mode::Mda);
        let signals = &to_nck.axes[number];
        let mut active = if selected && runs_programs { signals.activated_handwheels() } else { 0 };
        for (bit, handwheel) in self.handwheels.iter().enumerate() {
            let chosen = selected && runs_programs && handwheel.selected == Some(number);
            active |= u8::from(chosen) << bit;
        }
        active &= active.wrapping_neg();
        let mut next = self.axes[number].overlay;
        let inverted = active != 0 && signals.invert_handwheel_direction_of_rotation();
        if active != next.handwheels || inverted != next.inverted {
            let drf = channel_signal(unit.channel, crate::image::channel_to_nck::activate_drf, selected);
            let wheel = active_handwheel(number, active);
            let inversion = if inverted == next.inverted {
                Input::None
            } else {
                let signal = crate::image::axis_to_nck::invert_handwheel_direction_of_rotation;
                axis_signal(number, signal, signals.invert_handwheel_direction_of_rotation())
            };
            next.selected = self.log.note(
                Place::Axis(number),
                Rule::DrfSelected,
                [drf, wheel, inversion],
                self.mode_group(unit).mode_cause,
            );
            (next.handwheels, next.inverted) = (active, inverted);
        }
        let own = &parameters.axes[number];
        let requested = signals.requested_machine_functions();
        let increment = Function::requested(requested).way(own);
        let increment = limited(increment, own.handwheel_maximum);
        // A handwheel that overrides a velocity or a positioning adds nothing to the offset (K-31).
        let overrides = self.axes[number].by_handwheel.is_some();
        let (mut detents, mut turned) = (0.0, EventId::NONE);
        for (bit, handwheel) in self.handwheels.iter().enumerate() {
            let per_detent = parameters.handwheel_pulses[bit];
            if !overrides && active >> bit & 1 == 1 && handwheel.moved != 0 && per_detent.abs() > 0.0 {
                detents += (handwheel.moved as f64 / per_detent).clamp(-1e12, 1e12);
                turned = handwheel.cause;
            }
        }
        if turned.is_some() && increment != Position::ZERO {
            if unit.members().any(|member| self.axes[member].approach.is_running()) {
                let event = self.log.note_plain(Place::Axis(number), Rule::DrfWhileReferencing, turned);
                self.raise_axis_alarm(alarms::DRF_NOT_POSSIBLE, number, event);
            } else {
                let sign = if inverted { -1.0 } else { 1.0 };
                let exact = (detents * increment.increments() as f64 * sign + next.carry).clamp(-1e15, 1e15);
                #[expect(clippy::cast_possible_truncation, reason = "bounded above")]
                let way = Position::new(exact.round() as i64);
                next.carry = exact - exact.round();
                next.target = self.within_limits(number, next.target + way, parameters, to_nck);
            }
        }
        let free = self.stop(unit.channel, parameters).is_none() && self.motion_forbidden(unit).is_none();
        let held = self.axes[number].feed_held || self.axes[number].feed_factor <= 0.0;
        let on = unit.members().all(|member| self.axes[member].enabling.is_on());
        let cycle = parameters.cycle.seconds();
        let acceleration = unit.members().map(|member| parameters.axes[member].maximum_acceleration);
        let acceleration = acceleration.fold(f64::INFINITY, f64::min);
        let before = next.setpoint.position;
        if !on {
            next.setpoint = crate::motion::Setpoint::at(before);
        } else if free && !held {
            let velocity = own.jog_velocity * own.overlay_factor;
            next.setpoint.go_to(next.target, Limits { velocity, acceleration }, cycle);
        } else {
            next.setpoint.run(0.0, acceleration, cycle);
        }
        let moved = next.setpoint.position - before;
        let command = i8::try_from(moved.increments().signum()).unwrap_or(0);
        if command != next.command {
            let rule = if command == 0 { Rule::DrfRests } else { Rule::DrfMoves };
            let wheel = active_handwheel(number, next.handwheels);
            let parent = if turned.is_some() { turned } else { next.selected };
            for member in unit.members() {
                let event = self.log.note_one(Place::Axis(member), rule, wheel, parent);
                self.axes[member].overlay.cause = event;
                next.cause = if member == number { event } else { next.cause };
            }
            next.command = command;
        }
        for member in unit.members() {
            let axis = &mut self.axes[member];
            let cause = if member == number { next.cause } else { axis.overlay.cause };
            // Only the leading axis has a handwheel.
            let (handwheels, inverted, selected) = match member == number {
                true => (next.handwheels, next.inverted, next.selected),
                false => (0, false, axis.overlay.selected),
            };
            let by = next.setpoint.position - axis.overlay.setpoint.position;
            axis.overlay = super::state::Overlay { cause, handwheels, inverted, selected, ..next };
            if axis.measuring_system.is_some() {
                axis.actual -= by;
                axis.monitor.shift(Position::ZERO - by);
            }
        }
    }

    /// An offset with which the axis stays within its software limits; one that leads back is allowed.
    fn within_limits(&self, number: AxisNumber, target: Position, parameters: &Parameters, to_nck: &ToNck) -> Position {
        let axis = &self.axes[number];
        let bound = |direction| {
            let limit = self.software_limit(number, direction, parameters, to_nck)?;
            Some(limit - axis.setpoint.position)
        };
        let target = bound(1).map_or(target, |most| target.min(most.max(axis.overlay.target)));
        bound(-1).map_or(target, |least| target.max(least.min(axis.overlay.target)))
    }

    /// The DRF offset of an axis, and of its grouping, becomes part of the coordinates: nothing moves (K-11).
    pub(in crate::sinumerik) fn absorb_overlay(&mut self, number: AxisNumber) {
        let of = self.groupings.iter().find(|grouping| grouping.coupling.members().any(|axis| axis == number));
        let members =
            of.map_or_else(|| crate::units::AxisSet::of(number), |grouping| grouping.coupling.members().collect());
        for member in members.iter() {
            if self.axes[member].overlay != super::state::Overlay::default() {
                self.log.news.set(member, true);
            }
            self.axes[member].absorb_overlay();
        }
    }
}

impl Axis {
    fn absorb_overlay(&mut self) {
        let super::state::Overlay { handwheels, inverted, cause, selected, .. } = self.overlay;
        let by = self.overlay.position();
        self.overlay =
            super::state::Overlay { handwheels, inverted, cause, selected, ..super::state::Overlay::default() };
        if by != Position::ZERO && self.measuring_system.is_some() {
            self.actual += by;
            self.setpoint.shift(by);
            self.before += by;
            self.monitor.shift(by);
            self.signals.shift(by);
        }
    }

    /// The setpoint in machine coordinates, with the DRF offset.
    #[must_use]
    pub(in crate::sinumerik) fn machine_setpoint(&self) -> Position {
        self.setpoint.position + self.overlay.position()
    }
}
