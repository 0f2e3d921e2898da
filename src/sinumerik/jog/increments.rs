//! Machine functions of JOG, INC1 to INC10000, INCvar and continuous: which one is active, and what a press of a traversing
//! key begins and ends.
//!
//! Called once per cycle: [`State::select_group_functions`] and [`State::select_functions`] before the units,
//! [`Jogging::take_keys`] from `jog/mod.rs` while an axis is jogged. Reads DBX5.0 to 5.6 of the axis, or DB11.DBX2.0 to 2.6 (22.0
//! to 22.6) for all axes of a mode group where DB10.DBX57.0 = 1; shows DBX65.0 to 65.6, and DB11.DBX8.0 to 8.6 (28.0 to 28.6)
//! where 57.0 = 1. An increment is MD11330 (INCvar: SD41010) times MD31090; a negative MD31090 turns it round.
//!
//! Choices where the manuals leave one: no request means continuous, and of several requests the smallest increment counts;
//! what is selected acts on the next press of a key, a movement that runs goes on as it began; an increment
//! counts from the setpoint, and begins at rest, so that a key pressed while the axis still brakes waits for that;
//! only a press begins an increment: a key that was held before JOG, that is left over of two, or that comes back with
//! 4.4 = 0 begins none; what ends an increment early (the key, MD11300; 4.4; 2.2; RESET; a stop; a limit) drops the rest of it.

use serde::{Deserialize, Serialize};

use crate::image::{AxisToNck, ToNck};
use crate::sinumerik::State;
use crate::sinumerik::log::axis_bit;
use crate::sinumerik::parameters::{AxisParameters, Parameters};
use crate::sinumerik::resting::Resting;
use crate::sinumerik::rules::Rule;
use crate::units::Position;
use crate::variables::{EventId, Input, Place, SignalBit};

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
    /// As requested; of several the smallest increment, without any continuous.
    fn requested(bits: u8) -> Self {
        match u8::try_from((bits & 0x3F).trailing_zeros()) {
            Ok(bit @ 0..=5) => Self::Increment(bit),
            Ok(_) | Err(_) => Self::Continuous,
        }
    }

    /// As it is shown.
    #[must_use]
    pub(in crate::sinumerik) const fn bits(self) -> u8 {
        1 << self.bit()
    }

    const fn bit(self) -> u8 {
        match self {
            Self::Continuous => 6,
            Self::Increment(bit) => bit,
        }
    }

    /// The way of one increment, with its sign; zero for continuous.
    #[must_use]
    pub(in crate::sinumerik) fn way(self, parameters: &AxisParameters) -> Position {
        match self {
            Self::Continuous => Position::ZERO,
            Self::Increment(bit) => parameters.increments[usize::from(bit.min(5))],
        }
    }
}

/// What moves an axis by a way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum By {
    /// A traversing key: +1 or −1.
    Key(i8),
    /// Handwheels.
    Handwheel,
}

/// What an axis does in JOG.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum Movement {
    /// Nothing.
    #[default]
    None,
    /// It moves while a key says so: +1 or −1.
    Continuous(i8),
    /// It is to move by a way, and has not begun.
    Pending(Position, By),
    /// It moves to a target.
    Path(Position, By),
}

impl Movement {
    /// The direction of it: +1, −1 or 0.
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

    /// Handwheels move.
    #[must_use]
    pub(in crate::sinumerik) const fn is_by_handwheel(self) -> bool {
        matches!(self, Self::Pending(_, By::Handwheel) | Self::Path(_, By::Handwheel))
    }

    /// The way that is left of a movement that has an end.
    #[must_use]
    pub(in crate::sinumerik) fn distance_to_go(self, setpoint: Position) -> Position {
        match self {
            Self::None | Self::Continuous(_) => Position::ZERO,
            Self::Pending(way, _) => way,
            Self::Path(target, _) => target - setpoint,
        }
    }
}

/// What keys and handwheels do to one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Jogging {
    /// The active machine function.
    pub function: Function,
    /// As it is shown: nothing outside of JOG.
    pub shown: u8,
    /// Why.
    pub function_cause: EventId,
    /// Plus and minus key in the last cycle.
    keys: [bool; 2],
    /// Plus and minus key pressed in this cycle.
    pressed: [bool; 2],
    /// The key that is held began something that has ended; it must be released first.
    pub spent: bool,
    /// What the axis does.
    pub movement: Movement,
    /// Handwheels that move this axis, as bits.
    pub handwheels: u8,
    /// Why.
    pub handwheel_cause: EventId,
    /// The direction of the handwheels is turned round, 67.0.
    pub inverted: bool,
    /// The fraction of an increment that pulses have left over.
    pub carry: f64,
    /// Cycles without a pulse.
    pub still: u64,
    /// Handwheels were turned while a key moved the axis.
    pub refused: bool,
}

/// How keys act.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeyModes {
    /// MD11300: an increment runs while its key is held, else to its end.
    pub increment_held: bool,
    /// SD41050: continuous movement runs while its key is held, else until the next press.
    pub continuous_held: bool,
}

impl Jogging {
    /// Sees which keys were pressed since the last cycle; in every mode, so that a key that is held is none that is pressed.
    #[inline]
    pub(in crate::sinumerik) fn watch_keys(&mut self, signals: &AxisToNck) {
        let keys = [signals.traversing_key_plus(), signals.traversing_key_minus()];
        self.pressed = [keys[0] && !self.keys[0], keys[1] && !self.keys[1]];
        self.keys = keys;
        self.spent &= keys[0] || keys[1];
    }

    /// Nothing is jogged: another mode, REF, or no leading axis of its unit.
    #[inline]
    pub(in crate::sinumerik) fn end(&mut self) {
        self.movement = Movement::None;
        self.handwheels = 0;
        self.inverted = false;
        self.refused = false;
        self.carry = 0.0;
    }

    /// A key is pressed that moves nothing because handwheels move the axis.
    #[must_use]
    pub(in crate::sinumerik) const fn key_meets_handwheel(&self, direction: i8) -> bool {
        direction != 0 && self.movement.is_by_handwheel()
    }

    /// What the traversing keys begin and end; `direction` is +1, −1, or 0 for none, both, or keys that 4.4 disables.
    pub(in crate::sinumerik) fn take_keys(&mut self, direction: i8, disabled: bool, way: Position, modes: KeyModes) {
        let pressed = !disabled && (self.pressed[0] || self.pressed[1]);
        let begins = if direction != 0 && self.pressed[usize::from(direction < 0)] { direction } else { 0 };
        self.movement = match self.movement {
            Movement::None => match self.function {
                Function::Continuous if modes.continuous_held && direction != 0 && !self.spent => {
                    Movement::Continuous(direction)
                }
                Function::Continuous if !modes.continuous_held && begins != 0 => Movement::Continuous(begins),
                Function::Increment(_) if begins != 0 && way != Position::ZERO => {
                    self.spent = true;
                    Movement::Pending(if begins > 0 { way } else { -way }, By::Key(begins))
                }
                Function::Increment(_) => {
                    // What is held when an increment is selected moves nothing afterwards either.
                    self.spent |= direction != 0;
                    Movement::None
                }
                Function::Continuous => Movement::None,
            },
            Movement::Continuous(runs) if modes.continuous_held => match (direction, self.function) {
                (0, _) => Movement::None,
                (other, Function::Increment(_)) if other != runs => Movement::None,
                (direction, Function::Continuous | Function::Increment(_)) => Movement::Continuous(direction),
            },
            Movement::Pending(_, By::Key(key)) | Movement::Path(_, By::Key(key))
                if modes.increment_held && direction != key =>
            {
                Movement::None
            }
            Movement::Continuous(_) if disabled || pressed => Movement::None,
            Movement::Pending(_, By::Key(_)) | Movement::Path(_, By::Key(_))
                if !modes.increment_held && (disabled || pressed) =>
            {
                Movement::None
            }
            by_handwheel @ (Movement::Pending(_, By::Handwheel) | Movement::Path(_, By::Handwheel)) => {
                self.spent |= direction != 0;
                by_handwheel
            }
            goes_on @ (Movement::Continuous(_) | Movement::Pending(..) | Movement::Path(..)) => goes_on,
        };
    }
}

/// The machine function that a mode group selects for all its axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct GroupFunction {
    /// Which one, while it does.
    pub function: Option<Function>,
    /// Why.
    pub cause: EventId,
}

impl State {
    /// The machine function that a mode group selects for its axes.
    pub(in crate::sinumerik) fn select_group_functions(&mut self, parameters: &Parameters, to_nck: &ToNck) {
        let central = to_nck.nck.increment_inputs_active_in_mode_group_area();
        for group in parameters.existing_mode_groups() {
            let requested = to_nck.mode_groups[group].requested_machine_functions();
            let jogging = self.mode_groups[group].is_jogging();
            let function = (central && jogging).then(|| Function::requested(requested));
            if function != self.group_functions[group].function {
                let shown = function.unwrap_or_default();
                let place = Place::ModeGroup(group);
                let request = Input::Bit(SignalBit { place, byte: 2, bit: shown.bit() }, requested & shown.bits() != 0);
                let where_from = Input::Bit(SignalBit { place: Place::Nck, byte: 57, bit: 0 }, central);
                let inputs = [where_from, request, Input::None];
                let cause = self.log.note(place, Rule::IncrementSelected, inputs, EventId::NONE);
                self.group_functions[group] = GroupFunction { function, cause };
            }
        }
    }

    /// The machine function of the axes; in JOG without another machine function only.
    pub(in crate::sinumerik) fn select_functions(
        &mut self,
        parameters: &Parameters,
        to_nck: &ToNck,
        resting: &Resting,
    ) {
        for number in resting.awake().iter() {
            let group = parameters.mode_group(parameters.axes[number].channel);
            if !self.mode_groups[group].is_jogging() {
                self.axes[number].jogging.shown = 0;
                continue;
            }
            let GroupFunction { function: of_group, cause } = self.group_functions[group];
            let requested = to_nck.axes[number].requested_machine_functions();
            let function = of_group.unwrap_or_else(|| Function::requested(requested));
            if function != self.axes[number].jogging.function {
                let (parent, input) = if of_group.is_some() {
                    (cause, Input::None)
                } else {
                    (EventId::NONE, axis_bit(number, 5, function.bit(), requested & function.bits() != 0))
                };
                let event = self.log.note_one(Place::Axis(number), Rule::IncrementSelected, input, parent);
                self.axes[number].jogging.function = function;
                self.axes[number].jogging.function_cause = event;
            }
            self.axes[number].jogging.shown = function.bits();
        }
    }
}
