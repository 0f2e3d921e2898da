//! The speed of a spindle in a cycle.
//!
//! The programmed speed times the override, within the limits: at most MD35100, MD35130 of the gear stage, SD43220 (G26) and, while 3.6 = 1,
//! MD35160 (83.1); at least MD35140 and SD43210 (G25, 83.2). It changes with MD35200. 17.6 inverts M3 and M4. Spindle stop (4.3), NC stop axes plus
//! spindles, a missing enable and an override of 0 % hold the spindle; it turns again when they end.
//!
//! In JOG the keys turn a spindle without a function of a program, at SD41200 or MD32020, with 4.5 at MD32010, while they are pressed.

use crate::image::{AxisToNck, ToNck, axis_to_nck};
use crate::motion::Motion;
use crate::sinumerik::axis::travel::Travel;
use crate::sinumerik::axis::traversing::keys;
use crate::sinumerik::inputs::{axis_number, axis_signal};
use crate::sinumerik::jog::keys::key_direction;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::spindle::{REVOLUTION_PER_MINUTE, SpindleParameters};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::spindle::state::{Mode, Spindle};
use crate::sinumerik::state::{State, Unit};
use crate::units::AxisNumber;
use crate::variables::{EventId, Input, Place, Quantity};

/// A limit of the speed: its value in increments per second, and the datum that gives it.
type SpeedLimit = (f64, Input);

impl State {
    /// One cycle of a spindle.
    pub(in crate::sinumerik) fn run_spindle(&mut self, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) {
        let number = unit.leader();
        let Some(own) = parameters.axes[number].spindle.as_deref() else { return };
        let Some(before) = self.spindles[number].as_deref().copied() else { return };
        let signals = &to_nck.axes[number];
        self.synchronise_spindle(number, parameters);
        self.stop_spindle(unit, parameters, to_nck);
        self.jog_spindle(unit, parameters, signals);
        self.follow_gear(number, own, parameters, to_nck);
        self.follow_spindle_mode(number, parameters);
        let Some(spindle) = self.spindles[number].as_deref().copied() else { return };
        match spindle.mode {
            Mode::Control => {
                if let Some(change) = spindle.change {
                    return self.run_gear_change(unit, change, own, (parameters, to_nck));
                }
                if self.plc_oscillates(number) {
                    return self.run_plc_oscillation(unit, own, (parameters, to_nck));
                }
                self.end_plc_oscillation(number);
            }
            Mode::Positioning(order) => return self.run_positioning(unit, order, own, (parameters, to_nck)),
            Mode::Axis if self.axes[number].speed_controlled => {}
            Mode::Axis => return self.run_single(unit, parameters, to_nck),
        }
        let factor = spindle_factor(own, signals, self.axes[number].feed_factor);
        let turn = spindle.turn(own, signals, factor);
        let (speed, limited, raised, limit) = bounded(&turn, own, signals, (number, spindle.gear_stage));
        let holder = if turn.direction == 0 { None } else { self.spindle_holder(unit, &spindle, own, to_nck) };
        let commanded = if holder.is_some() { 0.0 } else { speed * f64::from(turn.direction) };
        self.axes[number].motion =
            Motion::Run { velocity: commanded, acceleration: own.stage(spindle.gear_stage).acceleration };
        let travel = match holder {
            None => Travel::moving(turn.direction),
            Some(_) => Travel::waiting(turn.direction),
        };
        self.show_spindle_travel(number, travel, holder, (&before, signals));
        let limit_cause = if (limited, raised) == (before.limited, before.raised) {
            spindle.limit_cause
        } else {
            let rule = match (limited, raised) {
                (true, _) => Rule::SpeedLimited,
                (false, true) => Rule::SpeedRaised,
                (false, false) => Rule::SpeedWithinLimits,
            };
            let acts = signals.override_active() || signals.feed_override_for_spindle();
            let code = if acts { override_code(number, signals) } else { Input::None };
            self.log.note(Place::Axis(number), rule, [limit, code, Input::None], spindle.cause)
        };
        if let Some(spindle) = self.spindles[number].as_deref_mut() {
            (spindle.limited, spindle.raised, spindle.limit_cause) = (limited, raised, limit_cause);
            spindle.is_new = false;
            (spindle.commanded, spindle.holder) = (commanded, holder.map_or(Input::None, |(_, input)| input));
        }
    }

    /// The zero mark gives a spindle its position, whatever it does (60.4, 60.5): the mark is at MD34100 + MD34080 + MD34090.
    fn synchronise_spindle(&mut self, number: AxisNumber, parameters: &Parameters) {
        let axis = &self.axes[number];
        let (Some(mark), Some(active), false) = (axis.zero_mark, axis.measuring_system, axis.is_referenced()) else {
            return;
        };
        let reference = &parameters.axes[number].reference;
        let position = reference.set_position[0] + reference.move_distance[usize::from(active)];
        let passed = Input::Length(Quantity::ZeroMark, number, mark);
        let event = self.log.note_one(Place::Axis(number), Rule::SpindleSynchronised, passed, axis.causes.motion);
        self.set_reference(number, position - mark, event);
    }

    /// Keys in JOG: a rising edge begins the turning, the release ends it.
    fn jog_spindle(&mut self, unit: &Unit, parameters: &Parameters, signals: &AxisToNck) {
        let number = unit.leader();
        let key = key_direction(signals);
        let stopped = self.stop(unit.channel, parameters).is_some();
        let jogging = self.is_jogging(unit) && !stopped;
        let Some(spindle) = self.spindles[number].as_deref().copied() else { return };
        let continues = key == spindle.jog || key != spindle.key_was;
        let turns = spindle.mode == Mode::Control;
        let jog = if jogging && turns && !spindle.is_programmed() && continues { key } else { 0 };
        let cause = if jog == spindle.jog {
            spindle.cause
        } else {
            let rule = if jog == 0 { Rule::KeyReleased } else { Rule::TraversingKey };
            self.log.note(Place::Axis(number), rule, keys(number, signals), EventId::NONE)
        };
        if let Some(spindle) = self.spindles[number].as_deref_mut() {
            (spindle.jog, spindle.key_was, spindle.cause) = (jog, key, cause);
        }
    }

    /// What holds the turning, with its rule.
    pub(super) fn spindle_holder(
        &self,
        unit: &Unit,
        spindle: &Spindle,
        own: &SpindleParameters,
        to_nck: &ToNck,
    ) -> Option<(Rule, Input)> {
        let number = unit.leader();
        let signals = &to_nck.axes[number];
        if signals.feed_stop() {
            return Some((Rule::SpindleStop, axis_signal(number, axis_to_nck::feed_stop, true)));
        }
        if spindle.stopped {
            return Some((Rule::SpindleStop, Self::stop_of_spindle(unit, to_nck)));
        }
        if !self.axes[number].enabling.is_on() {
            let missing = match self.missing_enable(unit, to_nck) {
                Input::None => axis_signal(number, crate::image::axis_from_nck::speed_controller_active, false),
                missing => missing,
            };
            return Some((Rule::SpindleWithoutEnable, missing));
        }
        if spindle_factor(own, signals, self.axes[number].feed_factor) <= 0.0 {
            return Some((Rule::HeldByOverride, override_code(number, signals)));
        }
        None
    }

    /// 64.4 to 64.7 of a spindle (S-01).
    pub(super) fn show_spindle_travel(
        &mut self,
        number: AxisNumber,
        travel: Travel,
        holder: Option<(Rule, Input)>,
        (before, signals): (&Spindle, &AxisToNck),
    ) {
        if self.axes[number].travel == travel {
            return;
        }
        let cause = self.spindles[number].as_deref().map_or(EventId::NONE, |spindle| spindle.cause);
        let turned_round = travel.request() == -self.axes[number].travel.request();
        let (rule, input) = match holder {
            Some(held) => held,
            None if turned_round && travel.request() != 0 => {
                let inverts = axis_signal(number, axis_to_nck::invert_m3_m4, signals.invert_m3_m4());
                (Rule::SpindleInverted, inverts)
            }
            None if travel == Travel::None => match before.target() {
                Some(target) => (Rule::SpindleTargetReached, Input::Length(Quantity::Target, number, target)),
                None => (Rule::SpindleReleased, Input::None),
            },
            None => (Rule::SpindleReleased, released(before.holder, number, signals)),
        };
        let cause = self.log.now(Place::Axis(number), cause, rule, [input, Input::None, Input::None]);
        self.travel(number, travel, cause);
    }

    /// Whether the actual speed is within MD35150 of the commanded one; without one, below MD36060 (83.5). What holds a spindle with a commanded
    /// speed keeps it from that speed (S-10).
    pub(in crate::sinumerik) fn is_in_speed_range(&self, number: AxisNumber, parameters: &Parameters) -> bool {
        let (axis, own) = (&self.axes[number], &parameters.axes[number]);
        let (Some(spindle), Some(data)) = (self.spindles[number].as_deref(), own.spindle.as_deref()) else {
            return false;
        };
        let speed = axis.turning_speed();
        if spindle.commanded == 0.0 {
            return spindle.holder == Input::None && speed.abs() < own.standstill_velocity;
        }
        (speed - spindle.commanded).abs() <= data.tolerance * spindle.commanded.abs()
    }
}

/// What a program or a key demands in this cycle.
struct Turn {
    /// With the inversion of 17.6; 0 if it is not to turn.
    direction: i8,
    /// In increments per second, with the override.
    speed: f64,
    by_key: bool,
}

impl Spindle {
    /// The direction in which a program or a key turns it, with the inversion of 17.6; 0 if it is not to turn.
    pub(in crate::sinumerik) fn direction_of_turning(&self, signals: &AxisToNck) -> i8 {
        let inverted = if signals.invert_m3_m4() { -1 } else { 1 };
        match self.jog {
            0 if self.is_programmed() => self.direction * inverted,
            key => key,
        }
    }

    fn turn(&self, own: &SpindleParameters, signals: &AxisToNck, factor: f64) -> Turn {
        if self.jog != 0 {
            let speed = own.jog_speeds[usize::from(signals.rapid_traverse_override())];
            return Turn { direction: self.jog, speed: speed * factor, by_key: true };
        }
        let direction = self.direction_of_turning(signals);
        Turn { direction, speed: self.speed * REVOLUTION_PER_MINUTE * factor, by_key: false }
    }
}

/// The code of the override that acts on a spindle.
fn override_code(number: AxisNumber, signals: &AxisToNck) -> Input {
    if signals.feed_override_for_spindle() {
        axis_number(number, axis_to_nck::feed_override, signals.feed_override())
    } else {
        axis_number(number, axis_to_nck::spindle_override, signals.spindle_override())
    }
}

/// The override of a spindle, while 1.7 = 1; with 17.0 = 1 the axial feed override.
pub(super) fn spindle_factor(own: &SpindleParameters, signals: &AxisToNck, feed: f64) -> f64 {
    if signals.feed_override_for_spindle() {
        feed
    } else if signals.override_active() {
        own.override_factor(signals.spindle_override())
    } else {
        1.0
    }
}

/// The speed within its limits, whether it is limited or raised, and the limit that acts.
fn bounded(
    turn: &Turn,
    own: &SpindleParameters,
    signals: &AxisToNck,
    (number, gear_stage): (AxisNumber, u8),
) -> (f64, bool, bool, Input) {
    let stage = own.stage(gear_stage);
    let revolutions = |speed: f64| speed / REVOLUTION_PER_MINUTE;
    let datum = |datum: u32, speed: f64| (speed, Input::Datum(datum, Some(number), revolutions(speed)));
    let element =
        |datum: u32, speed: f64| (speed, Input::Element(datum, gear_stage.max(1), number, revolutions(speed)));
    let [least, most] = own.programmed_limits;
    let mut highest: SpeedLimit = datum(35100, own.speed_limit);
    let external = signals.velocity_spindle_speed_limiting().then(|| datum(35160, own.external_limit));
    for limit in [Some(element(35130, stage.maximum_speed)), Some(datum(43220, most)), external].into_iter().flatten() {
        if limit.0 < highest.0 {
            highest = limit;
        }
    }
    let mut lowest: SpeedLimit = element(35140, stage.minimum_speed);
    if least > lowest.0 {
        lowest = datum(43210, least);
    }
    if turn.direction == 0 {
        (0.0, false, false, highest.1)
    } else if turn.speed > highest.0 {
        (highest.0, true, false, highest.1)
    } else if turn.speed < lowest.0 && !turn.by_key {
        (lowest.0.min(highest.0), false, true, lowest.1)
    } else {
        (turn.speed, false, false, highest.1)
    }
}

/// A signal that held the spindle, with the value with which it does so no longer.
fn released(holder: Input, number: AxisNumber, signals: &AxisToNck) -> Input {
    match holder {
        Input::Bit(signal, value) => Input::Bit(signal, !value),
        Input::Number(..) => override_code(number, signals),
        Input::None
        | Input::Datum(..)
        | Input::Element(..)
        | Input::Length(..)
        | Input::Alarm(_)
        | Input::Fault(_)
        | Input::Block(_) => Input::None,
    }
}
