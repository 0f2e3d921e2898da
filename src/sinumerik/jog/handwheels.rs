//! Handwheels 1 to 3: their pulses, the axes that they move, and the distances.
//!
//! Called once per cycle: [`State::turn_handwheels`] before the units, [`State::take_handwheels`] from `jog/mod.rs` while an axis
//! is jogged. Turning comes from outside. Reads DBX4.0 to 4.2 and 7.0 of the axis, and the selection of the HMI in DB10.DBB100 to
//! 102 (for a machine axis, 100.7 = 1), which acts like 4.0 to 4.2 because the basic program transfers it. Writes the counters in
//! DB10.DBB68 to 70, DBX64.0 to 64.2 and 67.0. A pulse is an increment of the active machine function (MD11330 or SD41010 times
//! MD31090, at most MD32080) divided by MD11320. A handwheel of a synchronous axis of a closed grouping moves nothing (MIS-01);
//! that of its leading axis moves the grouping (MIS-02).
//!
//! Stop conditions are in MD32084: bit 0 override 0 %, bit 2 feed stop and feed disable, bit 3 clamping (2.3), bits 4 and 5
//! missing controller and pulse enable; 1 drops the distance and ignores pulses, 0 keeps the distance and collects pulses. Bit 6
//! selects MD32000 as the largest velocity, otherwise the velocity of the keys; with bit 7 the override counts as 100 %, but 0 %
//! still holds.
//!
//! Choices where the manuals leave one: with continuous, a pulse has no distance and nothing moves. Of several handwheels
//! assigned to an axis, 1 has priority over 2 and 2 over 3. Pulses that lead beyond a software limit are ignored. Without path
//! mode (MD11346 = 0 or 2) the remaining distance is dropped 100 ms after the last pulse. The inversion acts at once on the
//! following pulses. A handwheel that is deselected drops its distance. 20051 stays until the key has ended its movement. A key
//! that is pressed while a handwheel moves the axis (20050) moves nothing until it is released and pressed again.

use crate::image::{AxisToNck, NckHmi, Signal, axis_from_nck, axis_to_nck, nck_hmi};
use crate::sinumerik::alarms;
use crate::sinumerik::axis::travel::Travel;
use crate::sinumerik::axis::traversing::keys;
use crate::sinumerik::inputs::{axis_signal, nck_signal};
use crate::sinumerik::jog::state::{By, Movement};
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, Position};
use crate::variables::{EventId, Input, Place};

/// The signals that assign each handwheel: that of the axis, and that of the HMI.
const ACTIVATED_AND_SELECTED: [(Signal, Signal); 3] = [
    (axis_to_nck::activate_handwheel_1, nck_hmi::handwheel_1_selected),
    (axis_to_nck::activate_handwheel_2, nck_hmi::handwheel_2_selected),
    (axis_to_nck::activate_handwheel_3, nck_hmi::handwheel_3_selected),
];

/// The effect of a stop condition on handwheels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Hold {
    /// No stop condition is active.
    None,
    /// The distance is kept, pulses are collected.
    Interrupt,
    /// The distance is dropped, pulses are ignored.
    Abort,
}

impl Nck {
    /// Turns a handwheel, 1 to 3, by pulses that are spread evenly over cycles. The rest of its last turn is included.
    pub fn turn_handwheel(&mut self, number: u8, pulses: i32, cycles: u64) -> EventId {
        let Some(handwheel) = self.state.handwheels.get_mut(usize::from(number.saturating_sub(1))) else {
            return EventId::NONE;
        };
        handwheel.turn(pulses.into(), i64::try_from(cycles).unwrap_or(i64::MAX));
        handwheel.cause = self.state.log.note_plain(Place::Nck, Rule::HandwheelTurned, EventId::NONE);
        handwheel.cause
    }

    /// Reads the machine axes selected by the HMI.
    #[inline]
    pub fn select_handwheels(&mut self, hmi: &NckHmi) {
        let selected = [
            (hmi.handwheel_1_selected(), hmi.handwheel_1_machine_axis(), hmi.handwheel_1_axis_number()),
            (hmi.handwheel_2_selected(), hmi.handwheel_2_machine_axis(), hmi.handwheel_2_axis_number()),
            (hmi.handwheel_3_selected(), hmi.handwheel_3_machine_axis(), hmi.handwheel_3_axis_number()),
        ];
        for (handwheel, (selected, machine_axis, axis)) in self.state.handwheels.iter_mut().zip(selected) {
            handwheel.selected = if selected && machine_axis { AxisNumber::new(axis) } else { None };
        }
    }
}

impl State {
    /// The pulses of this cycle.
    pub(in crate::sinumerik) fn turn_handwheels(&mut self) {
        for handwheel in &mut self.handwheels {
            handwheel.advance();
        }
    }

    /// Adds the pulses of handwheels to the distance of an axis, if this is permitted. `off` is an axis of its unit that is not in position
    /// control.
    pub(in crate::sinumerik) fn take_handwheels(
        &mut self,
        number: AxisNumber,
        off: Option<AxisNumber>,
        parameters: &Parameters,
        signals: &AxisToNck,
    ) {
        let mut active = signals.activated_handwheels();
        for (bit, handwheel) in self.handwheels.iter().enumerate() {
            active |= u8::from(handwheel.selected == Some(number)) << bit;
        }
        // Only one handwheel moves an axis, with priority 1, 2, 3.
        active &= active.wrapping_neg();
        if active == 0 && self.axes[number].jogging.handwheels == 0 {
            return;
        }
        let inverted = active != 0 && signals.invert_handwheel_direction_of_rotation();
        let shown = &self.axes[number].jogging;
        if active != shown.handwheels || inverted != shown.inverted {
            let changed = active ^ shown.handwheels;
            let inputs = self.selection_inputs(number, if changed == 0 { active } else { changed }, signals);
            let event = self.log.note(Place::Axis(number), Rule::HandwheelActivated, inputs, EventId::NONE);
            let jogging = &mut self.axes[number].jogging;
            (jogging.handwheels, jogging.inverted, jogging.handwheel_cause) = (active, inverted, event);
            jogging.still = 0;
            if active == 0 {
                self.drop_way_of_handwheels(number, Input::None, event);
            }
        }
        let axis_parameters = &parameters.axes[number];
        let (mut turned, mut detents) = (None, 0.0);
        for (bit, handwheel) in self.handwheels.iter().enumerate() {
            let per_detent = parameters.handwheel_pulses[bit];
            if active >> bit & 1 == 1 && handwheel.moved != 0 && per_detent.abs() > 0.0 {
                turned = Some(handwheel.cause);
                detents += (handwheel.moved as f64 / per_detent).clamp(-1e12, 1e12);
            }
        }
        let moved = turned.is_some();
        let (hold, held_by) = self.handwheel_hold(number, off, axis_parameters, signals);
        let jogging = &mut self.axes[number].jogging;
        jogging.turn_cause = turned.unwrap_or(jogging.turn_cause);
        let increment = limited(jogging.function.way(axis_parameters), axis_parameters.handwheel_maximum);
        // Counted only while needed, so that an axis with an assigned handwheel can rest.
        jogging.still = if moved || !jogging.movement.is_by_handwheel() { 0 } else { jogging.still + 1 };
        let drops = parameters.handwheel_drops_rest && jogging.still > parameters.handwheel_still_cycles;
        if hold == Hold::Abort || drops {
            let rest = Input::Datum(11346, None, f64::from(parameters.handwheel_true_distance));
            let parent = jogging.turn_cause;
            self.drop_way_of_handwheels(number, if hold == Hold::Abort { held_by } else { rest }, parent);
        }
        let jogging = &mut self.axes[number].jogging;
        if !moved || increment == Position::ZERO || hold == Hold::Abort {
            return;
        }
        let exact = detents * increment.increments() as f64 * if inverted { -1.0 } else { 1.0 } + jogging.carry;
        // Larger than any distance of a machine; sums of positions stay exact.
        let exact = exact.clamp(-1e15, 1e15);
        #[expect(clippy::cast_possible_truncation, reason = "bounded above")]
        let way = Position::new(exact.round() as i64);
        jogging.carry = exact - exact.round();
        jogging.movement = match jogging.movement {
            Movement::None => Movement::Pending(way, By::Handwheel),
            Movement::Pending(before, By::Handwheel) => Movement::Pending(before + way, By::Handwheel),
            Movement::Path(target, By::Handwheel) => Movement::Path(target + way, By::Handwheel),
            by_key @ (Movement::Continuous(_) | Movement::Pending(..) | Movement::Path(..)) => {
                jogging.refused = true;
                by_key
            }
        };
    }

    fn drop_way_of_handwheels(&mut self, number: AxisNumber, input: Input, parent: EventId) {
        let jogging = &mut self.axes[number].jogging;
        if jogging.movement.is_by_handwheel() {
            jogging.movement = Movement::None;
            jogging.carry = 0.0;
            let event = self.log.note_one(Place::Axis(number), Rule::HandwheelDropped, input, parent);
            self.travel(number, Travel::None, event);
        }
    }

    /// The signals that assign these handwheels, and the one that inverts their direction.
    pub(in crate::sinumerik) fn selection_inputs(
        &self,
        number: AxisNumber,
        handwheels: u8,
        signals: &AxisToNck,
    ) -> [Input; 3] {
        let handwheel = handwheels.trailing_zeros().min(2) as usize;
        let (activated, selects) = ACTIVATED_AND_SELECTED[handwheel];
        let by_plc = axis_signal(number, activated, signals.activated_handwheels() >> handwheel & 1 == 1);
        let selected = self.handwheels[handwheel].selected == Some(number);
        let by_hmi = if selected { nck_signal(selects, true) } else { Input::None };
        let inverted = signals.invert_handwheel_direction_of_rotation();
        [
            by_plc,
            by_hmi,
            if inverted {
                axis_signal(number, axis_to_nck::invert_handwheel_direction_of_rotation, true)
            } else {
                Input::None
            },
        ]
    }

    /// The stop conditions of MD32084, and the signal of the one that decides.
    fn handwheel_hold(
        &self,
        number: AxisNumber,
        off: Option<AxisNumber>,
        parameters: &AxisParameters,
        signals: &AxisToNck,
    ) -> (Hold, Input) {
        let axis = &self.axes[number];
        let decides = off.unwrap_or(number);
        let off = off.is_some();
        let pulses = self.axes[decides].enabling.pulses_enabled();
        let aborts = |bit: u8| parameters.handwheel_stop_conditions >> bit & 1 == 1;
        let controlled = self.axes[decides].enabling.controllers()[2];
        let control = axis_signal(decides, axis_from_nck::position_controller_active, controlled);
        let conditions = [
            (0, axis.feed_factor <= 0.0, axis.zero_override(number).1),
            (2, axis.feed_held, axis.feed_holder),
            (
                3,
                signals.clamping_in_progress() && aborts(3),
                axis_signal(number, axis_to_nck::clamping_in_progress, true),
            ),
            (4, off && pulses, control),
            (5, off && !pulses, control),
        ];
        let held = conditions.into_iter().filter(|&(_, holds, _)| holds);
        held.fold((Hold::None, Input::None), |(hold, by), (bit, _, input)| match hold {
            Hold::Abort => (hold, by),
            Hold::None | Hold::Interrupt if aborts(bit) => (Hold::Abort, input),
            Hold::None | Hold::Interrupt => (Hold::Interrupt, by),
        })
    }

    /// 20050 and 20051: a key is pressed while a handwheel moves the axis, or the opposite.
    pub(in crate::sinumerik) fn watch_keys_and_handwheels(&mut self, number: AxisNumber, key: i8, signals: &AxisToNck) {
        let axis = &mut self.axes[number];
        let jogging = &mut axis.jogging;
        let meets = jogging.key_meets_handwheel(key);
        jogging.refused &= jogging.movement != Movement::None && !jogging.movement.is_by_handwheel();
        let refused = jogging.refused;
        let keys = keys(number, signals);
        let assigned = active_handwheel(number, jogging.handwheels);
        let (turned, motion) = (jogging.turn_cause, axis.causes.motion);
        let [plus, minus, _] = keys;
        let alarm = self.axis_alarm(alarms::HANDWHEEL_NOT_POSSIBLE, number);
        if refused {
            self.raise_new(alarm, Rule::HandwheelMeetsKey, [plus, minus, assigned], turned);
        } else {
            self.end_tested(&alarm, Rule::KeyMovementEnded, keys, motion);
        }
        let alarm = self.axis_alarm(alarms::HANDWHEEL_ACTIVE, number);
        if meets {
            self.raise_new(alarm, Rule::KeyMeetsHandwheel, [plus, minus, assigned], turned);
        } else {
            self.end_tested(&alarm, Rule::KeyMeetsNoHandwheel, keys, motion);
        }
    }
}

/// DBX64.0 to 64.2: the first handwheel that moves an axis, as an input.
#[must_use]
pub(in crate::sinumerik) fn active_handwheel(number: AxisNumber, handwheels: u8) -> Input {
    let signals =
        [axis_from_nck::handwheel_1_active, axis_from_nck::handwheel_2_active, axis_from_nck::handwheel_3_active];
    signals.get(handwheels.trailing_zeros() as usize).map_or(Input::None, |signal| axis_signal(number, *signal, true))
}

/// The velocity of a handwheel movement, with the override.
#[must_use]
pub(in crate::sinumerik) fn velocity(parameters: &AxisParameters, key_velocity: f64, factor: f64) -> f64 {
    let bit = |bit: u8| parameters.handwheel_stop_conditions >> bit & 1 == 1;
    let velocity = if bit(6) { parameters.maximum_velocity } else { key_velocity };
    // The override counts as 100 % with bit 7, but 0 % always acts.
    let factor = if bit(7) && factor > 0.0 { 1.0 } else { factor };
    (velocity * factor).min(parameters.maximum_velocity)
}

/// An increment limited to `maximum`, unless that is 0.
/// An increment, at most MD32080; 0 does not limit it.
pub(in crate::sinumerik) fn limited(increment: Position, maximum: Position) -> Position {
    if maximum == Position::ZERO || increment.abs() <= maximum {
        increment
    } else if increment < Position::ZERO {
        -maximum
    } else {
        maximum
    }
}
