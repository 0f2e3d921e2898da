//! The state of the enabling sequence of an axis: its pulses, its controllers and its holding brake.

use serde::{Deserialize, Serialize};

/// Duration of each step of the enabling sequence in cycles, so that brake and timer logic sees a realistic order.
pub(in crate::sinumerik) const STEP: u8 = 2;

/// The state of position control.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum ControllerState {
    /// No position control.
    #[default]
    Off,
    /// The controllers switch on one after another; number of cycles so far.
    SwitchingOn(u8),
    /// In position control.
    On,
    /// Braking after the enable was removed; number of cycles until the axis is switched off in any case (MD36620).
    Braking(u64),
    /// At rest before it is switched off: the drive holds the axis until its brake holds; number of cycles until it is switched off in any
    /// case.
    Holding(u64),
}

/// The state of the enabling sequence.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Enabling {
    /// Position control.
    pub control: ControllerState,
    /// Cycles with drive ready and pulse enable, up to [`STEP`].
    pub pulses: u8,
    /// Not in position control, and the setpoint follows the actual value.
    pub follow_up: bool,
    /// The holding brake is to be open.
    pub opens_brake: bool,
}

impl Enabling {
    /// 93.7.
    #[must_use]
    pub(in crate::sinumerik) const fn pulses_enabled(&self) -> bool {
        self.pulses >= STEP
    }

    /// 61.7, 61.6 and 61.5: current, speed and position controller.
    #[must_use]
    pub(in crate::sinumerik) const fn controllers(&self) -> [bool; 3] {
        match self.control {
            ControllerState::Off => [false; 3],
            ControllerState::SwitchingOn(cycles) => [cycles >= STEP, cycles >= 2 * STEP, false],
            ControllerState::On | ControllerState::Braking(_) => [true; 3],
            ControllerState::Holding(_) => [true, true, false],
        }
    }

    /// The drive acts on velocity commands.
    #[must_use]
    pub(in crate::sinumerik) const fn is_powered(&self) -> bool {
        self.pulses_enabled() && self.moves()
    }

    /// In position control, also while braking before switching off.
    #[must_use]
    pub(in crate::sinumerik) const fn moves(&self) -> bool {
        matches!(self.control, ControllerState::On | ControllerState::Braking(_))
    }

    /// Ready to be moved.
    #[must_use]
    pub(in crate::sinumerik) const fn is_on(&self) -> bool {
        matches!(self.control, ControllerState::On)
    }
}
