//! Spindles by the PLC: the spindle functions of FC 18 (32.4 to 32.6, 33.4, 33.5).
//!
//! | function | begins with the rising edge of | InPos (104.6) | ends with |
//! |---|---|---|---|
//! | position | 32.6 | in position: 85.5 | the position; 32.6 = 0 before that: the spindle brakes |
//! | rotate | 32.5 | the speed is within MD35150: 83.5 | the rising edge of 33.5: the spindle brakes |
//! | oscillate | 32.4 | it oscillates: 84.6 | the rising edge of 33.4: the spindle brakes |
//!
//! | error | condition |
//! |---|---|
//! | 1 | several functions, or several ways of approach at once |
//! | 40 | the spindle is no PLC axis |
//! | 100 | a position outside of 0 to 359.999 (MD30455 bit 0 = 0); constant cutting speed, which is not modelled; no spindle (22297) |
//! | 101, 111 | the speed is above MD35100; it is not positive |
//! | 105 | no measuring system (22050) |
//! | 107 | the zero mark was not found (22051) |
//! | 115 | something else stopped the spindle: RESET, an alarm, 2.2, a function of a program |

use crate::image::{AxisToNck, axis_from_nck, axis_to_nck};
use crate::nc_program::Dimension;
use crate::sinumerik::alarms::{SPINDLE_MARK_MISSING, axis_exchange as alarms};
use crate::sinumerik::exchange::state::Holder;
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::parameters::spindle::{REVOLUTION_PER_MINUTE, SpindleParameters};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::single_axis::state::{Outcome, SpindleOrder};
use crate::sinumerik::spindle::state::Mode;
use crate::sinumerik::state::State;
use crate::units::AxisNumber;
use crate::variables::{EventId, Input, Parameter, Place};

/// The axis is not a spindle: code of 22297.
const NO_SPINDLE: i64 = 6;

/// The error number of a refusal, and what was tested.
type SpindleRefusal = (u8, Input);

impl State {
    /// The start and stop bits of the spindle functions.
    pub(super) fn watch_spindle_order(&mut self, axis: AxisNumber, signals: &AxisToNck, parameters: &Parameters) {
        let started = SpindleOrder::started(signals).next();
        let was = std::mem::replace(&mut self.single.axes[axis].spindle_was, started);
        let stop = signals.stop_spindle_rotation() || signals.stop_spindle_oscillation();
        let stop_was = std::mem::replace(&mut self.single.axes[axis].spindle_stop_was, stop);
        if let (Some(order), None) = (started, was) {
            let pressed = axis_signal(axis, order.start(), true);
            if parameters.axes[axis].spindle.is_none() || self.spindles[axis].is_none() {
                self.refuse_spindle(axis, pressed);
                return;
            }
            let begun = match SpindleOrder::started(signals).nth(1) {
                Some(second) => Err((1, axis_signal(axis, second.start(), true))),
                None => self.begin_spindle_order(axis, order, signals, (parameters, pressed)),
            };
            if let Err((error, input)) = begun {
                let event = self.log.note(
                    Place::Axis(axis),
                    Rule::SpindleOrderRefused,
                    [pressed, input, Input::None],
                    EventId::NONE,
                );
                let one = &mut self.single.axes[axis];
                (one.outcome, one.cause) = (Outcome::Refused(error), event);
            }
        } else if let (None, Some(order)) = (started, was) {
            self.withdraw_spindle_order(axis, axis_signal(axis, order.start(), false));
        }
        if stop && !stop_was && self.single.axes[axis].spindle.is_some_and(|order| order != SpindleOrder::Position) {
            let input = if signals.stop_spindle_rotation() {
                axis_signal(axis, axis_to_nck::stop_spindle_rotation, true)
            } else {
                axis_signal(axis, axis_to_nck::stop_spindle_oscillation, true)
            };
            let event = self.log.note_one(Place::Axis(axis), Rule::SpindleOrderStopped, input, EventId::NONE);
            self.brake_spindle(axis, event);
            self.end_spindle_order(axis, Outcome::None, event);
        }
        self.follow_spindle_order(axis, parameters);
    }

    /// Whether the PLC lets a spindle oscillate.
    pub(in crate::sinumerik) fn plc_oscillates(&self, axis: AxisNumber) -> bool {
        self.single.axes[axis].spindle == Some(SpindleOrder::Oscillate)
    }

    fn begin_spindle_order(
        &mut self,
        axis: AxisNumber,
        order: SpindleOrder,
        signals: &AxisToNck,
        (parameters, pressed): (&Parameters, Input),
    ) -> Result<(), SpindleRefusal> {
        let Some(own) = parameters.axes[axis].spindle.as_deref() else {
            return Err((100, Input::None));
        };
        if self.owners.of(axis).holder != Holder::Plc {
            return Err((40, axis_signal(axis, axis_from_nck::plc_axis, false)));
        }
        let limit = own.speed_limit / REVOLUTION_PER_MINUTE;
        let speed = f64::from(signals.positioning_feedrate());
        if !speed.is_finite() || speed > limit {
            return Err((101, Input::Datum(35100, Some(axis), limit)));
        }
        let place = Place::Axis(axis);
        match order {
            SpindleOrder::Position => {
                let (angle, dimension) = wanted_angle(axis, signals, &parameters.axes[axis])?;
                let event = self.log.note_one(place, Rule::SpindleOrder, pressed, EventId::NONE);
                self.position_spindle(axis, (angle, dimension), Rule::SpindleOrder, parameters, event);
                let speed = if speed > 0.0 { Some(speed * REVOLUTION_PER_MINUTE) } else { None };
                let Some(spindle) = self.spindles[axis].as_deref_mut() else { return Err((105, Input::None)) };
                let Mode::Positioning(positioning) = &mut spindle.mode else {
                    return Err((105, axis_signal(axis, axis_from_nck::position_measuring_system_1_activated, false)));
                };
                positioning.speed = speed;
                self.take_spindle_order(axis, order, event);
            }
            SpindleOrder::Rotate => {
                if signals.constant_cutting_rate() {
                    return Err((100, axis_signal(axis, axis_to_nck::constant_cutting_rate, true)));
                }
                if speed <= 0.0 {
                    return Err((111, Input::None));
                }
                let event = self.log.note_one(place, Rule::SpindleOrder, pressed, EventId::NONE);
                self.rotate_spindle(axis, speed, own, signals, event);
                self.take_spindle_order(axis, order, event);
            }
            SpindleOrder::Oscillate => {
                let event = self.log.note_one(place, Rule::SpindleOrder, pressed, EventId::NONE);
                self.brake_spindle(axis, event);
                self.take_spindle_order(axis, order, event);
            }
        }
        Ok(())
    }

    fn rotate_spindle(
        &mut self,
        axis: AxisNumber,
        speed: f64,
        own: &SpindleParameters,
        signals: &AxisToNck,
        event: EventId,
    ) {
        let mut wants_stage = false;
        if let Some(spindle) = self.spindles[axis].as_deref_mut() {
            spindle.leave_positioning(event);
            let direction = if signals.direction_of_rotation_as_m4() { -1 } else { 1 };
            (spindle.direction, spindle.speed, spindle.stopped) = (direction, speed, false);
            (spindle.cause, spindle.is_new) = (event, true);
            if signals.automatic_gear_selection() && own.has_stages {
                wants_stage = spindle.want_stage(Some(40), own);
            }
        }
        if wants_stage {
            self.begin_gear_change(axis, event);
        }
    }

    fn take_spindle_order(&mut self, axis: AxisNumber, order: SpindleOrder, event: EventId) {
        let one = &mut self.single.axes[axis];
        (one.spindle, one.outcome, one.cause) = (Some(order), Outcome::None, event);
    }

    fn end_spindle_order(&mut self, axis: AxisNumber, outcome: Outcome, event: EventId) {
        let one = &mut self.single.axes[axis];
        (one.spindle, one.outcome, one.cause) = (None, outcome, event);
    }

    /// Start is 0: a positioning stops; rotation and oscillation go on until their stop. What has ended is no longer shown.
    fn withdraw_spindle_order(&mut self, axis: AxisNumber, starts: Input) {
        let event = self.log.note_one(Place::Axis(axis), Rule::OrderWithdrawn, starts, EventId::NONE);
        match self.single.axes[axis].spindle {
            Some(SpindleOrder::Position) => {
                self.brake_spindle(axis, event);
                self.end_spindle_order(axis, Outcome::None, event);
            }
            Some(SpindleOrder::Rotate | SpindleOrder::Oscillate) => {}
            None => {
                let one = &mut self.single.axes[axis];
                (one.outcome, one.cause) = (Outcome::None, event);
            }
        }
    }

    /// The spindle brakes to rest, in speed control.
    fn brake_spindle(&mut self, axis: AxisNumber, event: EventId) {
        if let Some(spindle) = self.spindles[axis].as_deref_mut() {
            spindle.leave_positioning(event);
            (spindle.direction, spindle.cause, spindle.is_new, spindle.is_ended) = (0, event, true, false);
        }
    }

    /// What a running function has reached, or what has ended it.
    fn follow_spindle_order(&mut self, axis: AxisNumber, parameters: &Parameters) {
        let one = self.single.axes[axis];
        let (Some(order), Some(spindle)) = (one.spindle, self.spindles[axis].as_deref().copied()) else { return };
        let (is_there, goes_on) = match order {
            SpindleOrder::Position => (spindle.is_in_position(), matches!(spindle.mode, Mode::Positioning(_))),
            SpindleOrder::Rotate => {
                let turns = spindle.mode == Mode::Control && spindle.is_programmed();
                let is_fast = turns && !spindle.is_new && spindle.change.is_none();
                (is_fast && self.is_in_speed_range(axis, parameters), turns)
            }
            SpindleOrder::Oscillate => {
                (spindle.oscillates(), spindle.mode == Mode::Control && !spindle.is_programmed() && !spindle.is_ended)
            }
        };
        let place = Place::Axis(axis);
        if !goes_on {
            let missing = self.alarms.is_pending(SPINDLE_MARK_MISSING, place);
            let error = if missing { 107 } else { 115 };
            let event = self.log.now(place, spindle.cause, Rule::SpindleOrderEnds, [Input::None; 3]);
            self.end_spindle_order(axis, Outcome::Failed(error), event);
        } else if order == SpindleOrder::Position && is_there {
            let event = self.log.note_plain(place, Rule::SpindleOrderReached, spindle.position_cause);
            self.end_spindle_order(axis, Outcome::Reached, event);
        } else if is_there != (one.outcome == Outcome::Reached) {
            let event = self.log.note_plain(place, Rule::SpindleOrderReached, spindle.cause);
            let one = &mut self.single.axes[axis];
            (one.outcome, one.cause) = (if is_there { Outcome::Reached } else { Outcome::None }, event);
        }
    }

    /// A spindle function for an axis that is no spindle.
    fn refuse_spindle(&mut self, axis: AxisNumber, pressed: Input) {
        let event = self.log.note_one(Place::Axis(axis), Rule::NoSpindle, pressed, EventId::NONE);
        let channel = Parameter::Channel(self.owners.of(axis).channel);
        let shown = [channel, Parameter::Axis(axis), Parameter::Number(NO_SPINDLE), Parameter::None];
        self.alarms.raise(alarms::SPINDLE_START_REFUSED, Place::Axis(axis), shown, event);
        let one = &mut self.single.axes[axis];
        (one.outcome, one.cause) = (Outcome::Refused(100), event);
    }
}

/// The angle that the PLC wants, or the distance, and how it is meant.
fn wanted_angle(
    axis: AxisNumber,
    signals: &AxisToNck,
    data: &AxisParameters,
) -> Result<(f64, Dimension), SpindleRefusal> {
    let ways = [
        (signals.incremental_position(), Dimension::Incremental, axis_to_nck::incremental_position),
        (signals.shortest_distance(), Dimension::Shortest, axis_to_nck::shortest_distance),
        (signals.approach_in_plus_direction(), Dimension::FromPlus, axis_to_nck::approach_in_plus_direction),
        (signals.approach_in_minus_direction(), Dimension::FromMinus, axis_to_nck::approach_in_minus_direction),
    ];
    let mut chosen = ways.iter().filter(|(is_set, ..)| *is_set);
    let dimension = chosen.next().map_or(Dimension::Absolute, |(_, dimension, _)| *dimension);
    if let Some((.., second)) = chosen.next() {
        return Err((1, axis_signal(axis, *second, true)));
    }
    let angle = f64::from(signals.positioning_target());
    if angle.abs() <= 1e9 && data.is_within_modulo(angle, dimension) {
        Ok((angle, dimension))
    } else {
        Err((100, Input::None))
    }
}
