//! The state of traversing keys, increments and handwheels.

use serde::{Deserialize, Serialize};

use crate::image::{AxisToNck, Signal, axis_to_nck, mode_group_to_nck};
use crate::sinumerik::parameters::KeyModes;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::units::{AxisNumber, Position};
use crate::variables::EventId;

/// Number of handwheels.
pub(in crate::sinumerik) const HANDWHEELS: usize = 3;

/// A machine function of JOG.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum Function {
    /// Continuous, bit 6.
    #[default]
    Continuous,
    /// INC1, 10, 100, 1000, 10000 or var, bits 0 to 5.
    Increment(u8),
}

impl Function {
    /// The requested function: of several the smallest increment, without a request continuous.
    pub(in crate::sinumerik) fn requested(bits: u8) -> Self {
        match u8::try_from((bits & 0x3F).trailing_zeros()) {
            Ok(bit @ 0..=5) => Self::Increment(bit),
            Ok(_) | Err(_) => Self::Continuous,
        }
    }

    /// The bits that display it.
    #[must_use]
    pub(in crate::sinumerik) const fn bits(self) -> u8 {
        1 << self.bit()
    }

    pub(in crate::sinumerik) const fn bit(self) -> u8 {
        match self {
            Self::Continuous => 6,
            Self::Increment(bit) => bit,
        }
    }

    /// The signal of an axis that requests this function.
    pub(in crate::sinumerik) const fn of_axis(self) -> Signal {
        const REQUESTS: [Signal; 7] = [
            axis_to_nck::machine_function_increment_1,
            axis_to_nck::machine_function_increment_10,
            axis_to_nck::machine_function_increment_100,
            axis_to_nck::machine_function_increment_1000,
            axis_to_nck::machine_function_increment_10000,
            axis_to_nck::machine_function_increment_variable,
            axis_to_nck::machine_function_continuous,
        ];
        REQUESTS[self.bit() as usize]
    }

    /// The signal of a mode group that requests this function.
    pub(in crate::sinumerik) const fn of_mode_group(self) -> Signal {
        const REQUESTS: [Signal; 7] = [
            mode_group_to_nck::machine_function_increment_1,
            mode_group_to_nck::machine_function_increment_10,
            mode_group_to_nck::machine_function_increment_100,
            mode_group_to_nck::machine_function_increment_1000,
            mode_group_to_nck::machine_function_increment_10000,
            mode_group_to_nck::machine_function_increment_variable,
            mode_group_to_nck::machine_function_continuous,
        ];
        REQUESTS[self.bit() as usize]
    }

    /// The distance of one increment, with its sign; zero for continuous.
    #[must_use]
    pub(in crate::sinumerik) fn way(self, parameters: &AxisParameters) -> Position {
        match self {
            Self::Continuous => Position::ZERO,
            Self::Increment(bit) => parameters.increments[usize::from(bit.min(5))],
        }
    }
}

/// The source of a movement by a distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum By {
    /// A traversing key: +1 or −1.
    Key(i8),
    /// Handwheels.
    Handwheel,
}

/// The movement of an axis in JOG.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum Movement {
    /// Nothing.
    #[default]
    None,
    /// It moves while a key is active: +1 or −1.
    Continuous(i8),
    /// A movement by a distance is pending.
    Pending(Position, By),
    /// It moves to a target.
    Path(Position, By),
}

impl Movement {
    /// The direction of the movement: +1, −1 or 0.
    #[must_use]
    pub(in crate::sinumerik) fn direction(self, setpoint: Position) -> i8 {
        let way = match self {
            Self::None => return 0,
            Self::Continuous(direction) => return direction,
            Self::Pending(way, _) => way,
            Self::Path(target, _) => target - setpoint,
        };
        i8::try_from(way.increments().signum()).unwrap_or(0)
    }

    /// Whether handwheels move the axis.
    #[must_use]
    pub(in crate::sinumerik) const fn is_by_handwheel(self) -> bool {
        matches!(self, Self::Pending(_, By::Handwheel) | Self::Path(_, By::Handwheel))
    }

    /// Whether a traversing key moves the axis.
    #[must_use]
    pub(in crate::sinumerik) const fn is_by_key(self) -> bool {
        matches!(self, Self::Continuous(_) | Self::Pending(_, By::Key(_)) | Self::Path(_, By::Key(_)))
    }

    /// The remaining distance of a movement with an end.
    #[must_use]
    pub(in crate::sinumerik) fn distance_to_go(self, setpoint: Position) -> Position {
        match self {
            Self::None | Self::Continuous(_) => Position::ZERO,
            Self::Pending(way, _) => way,
            Self::Path(target, _) => target - setpoint,
        }
    }
}

/// The effect of keys and handwheels on one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Jogging {
    /// The active machine function.
    pub function: Function,
    /// The displayed machine function: none outside of JOG.
    pub shown: u8,
    /// The event behind it.
    pub function_cause: EventId,
    /// Plus and minus key in the last cycle.
    pub keys: [bool; 2],
    /// Rising edges of the plus and minus key that no stage has taken yet.
    pub pressed: [bool; 2],
    /// The axis was in position control in the last cycle in which it was jogged.
    pub was_on: bool,
    /// The movement of the axis.
    pub movement: Movement,
    /// Handwheels that move this axis, as bits.
    pub handwheels: u8,
    /// The event behind the assignment.
    pub handwheel_cause: EventId,
    /// The last turn of a handwheel that moves it.
    pub turn_cause: EventId,
    /// The direction of the handwheels is inverted, 67.0.
    pub inverted: bool,
    /// The remaining fraction of an increment.
    pub carry: f64,
    /// Number of cycles without a pulse.
    pub still: u64,
    /// Handwheels were turned while a key moved the axis.
    pub refused: bool,
}

impl Jogging {
    /// Detects the keys pressed since the last cycle, in every mode, so that a held key does not count as pressed.
    #[inline]
    pub(in crate::sinumerik) fn watch_keys(&mut self, signals: &AxisToNck) {
        let keys = [signals.traversing_key_plus(), signals.traversing_key_minus()];
        let rises = |key: usize| keys[key] && (self.pressed[key] || !self.keys[key]);
        self.pressed = [rises(0), rises(1)];
        self.keys = keys;
    }

    /// Ends jogging: another mode, REF, or not the leading axis of the unit.
    #[inline]
    pub(in crate::sinumerik) fn end(&mut self) {
        self.movement = Movement::None;
        self.pressed = [false; 2];
        self.handwheels = 0;
        self.inverted = false;
        self.refused = false;
        self.carry = 0.0;
    }

    /// A key is pressed but moves nothing because handwheels move the axis.
    #[must_use]
    pub(in crate::sinumerik) const fn key_meets_handwheel(&self, direction: i8) -> bool {
        direction != 0 && self.movement.is_by_handwheel()
    }

    /// Starts and ends movements by the traversing keys. `direction` is +1, −1, or 0 if no key, both keys or keys disabled by 4.4
    /// are pressed. Only the rising edge of a key starts a movement (O-26).
    pub(in crate::sinumerik) fn take_keys(&mut self, direction: i8, disabled: bool, way: Position, modes: KeyModes) {
        let rises = std::mem::take(&mut self.pressed);
        let pressed = !disabled && (rises[0] || rises[1]);
        let begins = if direction != 0 && rises[usize::from(direction < 0)] { direction } else { 0 };
        let begun = match self.function {
            _ if begins == 0 => Movement::None,
            Function::Continuous => Movement::Continuous(begins),
            Function::Increment(_) if way == Position::ZERO => Movement::None,
            Function::Increment(_) => Movement::Pending(if begins > 0 { way } else { -way }, By::Key(begins)),
        };
        self.movement = match self.movement {
            Movement::None => begun,
            Movement::Continuous(runs) if modes.continuous_held && direction != runs => begun,
            Movement::Pending(_, By::Key(key)) | Movement::Path(_, By::Key(key))
                if modes.increment_held && direction != key =>
            {
                Movement::None
            }
            Movement::Continuous(_) if !modes.continuous_held && (disabled || pressed) => Movement::None,
            Movement::Pending(_, By::Key(_)) | Movement::Path(_, By::Key(_))
                if !modes.increment_held && (disabled || pressed) =>
            {
                Movement::None
            }
            goes_on @ (Movement::Continuous(_) | Movement::Pending(..) | Movement::Path(..)) => goes_on,
        };
    }
}

/// The machine function that a mode group selects for all its axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct GroupFunction {
    /// The selected function, while one is selected.
    pub function: Option<Function>,
    /// The event behind it.
    pub cause: EventId,
}

/// One handwheel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Handwheel {
    /// Number of pulses of a turn.
    pub pulses: i64,
    /// Number of cycles over which they are spread.
    pub cycles: i64,
    /// Number of cycles that have passed.
    pub passed: i64,
    /// Pulses in this cycle.
    pub moved: i64,
    /// All pulses so far, as the interface counts them.
    pub counter: u8,
    /// The machine axis for which the HMI selects the handwheel.
    pub selected: Option<AxisNumber>,
    /// The event of its last turn.
    pub cause: EventId,
}

impl Handwheel {
    pub(in crate::sinumerik) fn turn(&mut self, pulses: i64, cycles: i64) {
        let left = self.pulses - self.share(self.passed);
        *self = Self { pulses: left + pulses, cycles: cycles.max(1), passed: 0, ..*self };
    }

    /// Number of pulses after this many cycles of the turn.
    pub(in crate::sinumerik) const fn share(&self, passed: i64) -> i64 {
        if self.cycles == 0 { 0 } else { self.pulses.saturating_mul(passed) / self.cycles }
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the counter runs over")]
    pub(in crate::sinumerik) fn advance(&mut self) {
        self.moved = 0;
        if self.passed < self.cycles {
            self.moved = self.share(self.passed + 1) - self.share(self.passed);
            self.passed += 1;
            self.counter = self.counter.wrapping_add(self.moved as u8);
            if self.passed == self.cycles {
                *self = Self { pulses: 0, cycles: 0, passed: 0, ..*self };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 7 pulses over 3 cycles: 7/3, 14/3 and 7 give the whole pulses after each cycle, so 2, 2 and 3 pulses in them, then none.
    #[test]
    fn pulses_spread_evenly_and_none_is_lost() {
        for sign in [1, -1] {
            let mut handwheel = Handwheel::default();
            handwheel.turn(sign * 7, 3);
            let moved: Vec<_> = (0..5)
                .map(|_| {
                    handwheel.advance();
                    handwheel.moved
                })
                .collect();
            assert_eq!(moved, [2, 2, 3, 0, 0].map(|pulses| sign * pulses));
        }
    }

    #[test]
    fn a_second_turn_takes_the_rest_of_the_first_along() {
        let mut handwheel = Handwheel::default();
        handwheel.turn(10, 10);
        for _ in 0..4 {
            handwheel.advance();
        }
        assert_eq!(handwheel.counter, 4);
        handwheel.turn(-1, 1);
        handwheel.advance();
        assert_eq!((handwheel.moved, handwheel.counter), (5, 9));
        // 250 more: the counter is one byte.
        handwheel.turn(250, 1);
        handwheel.advance();
        assert_eq!(handwheel.counter, 3);
    }
}
