//! The state of start-up, emergency stop, mode groups and channels.

use serde::{Deserialize, Serialize};

use crate::sinumerik::axis::controllers::STEP;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::referencing::state::ChannelReferencing;
use crate::units::{AxisNumber, ModeGroupNumber};
use crate::variables::EventId;

/// The state of a channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Channel {
    /// RESET is pressed.
    pub reset: bool,
    /// The latest RESET.
    pub reset_cause: EventId,
    /// NC start in the last cycle.
    pub start_was: bool,
    /// Channel-specific referencing.
    pub referencing: ChannelReferencing,
}

impl Channel {
    /// 33.0.
    #[must_use]
    pub(in crate::sinumerik) const fn is_referencing(&self) -> bool {
        self.referencing.is_active()
    }

    /// Whether channel-specific referencing started this axis.
    #[must_use]
    pub(in crate::sinumerik) const fn started(&self, axis: AxisNumber) -> bool {
        self.referencing.started(axis)
    }
}

/// The state of the emergency stop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct EmergencyStop {
    pub active: bool,
    /// The event that started or ended it.
    pub cause: EventId,
}

impl EmergencyStop {
    /// 106.1.
    #[must_use]
    pub(in crate::sinumerik) const fn is_active(self) -> bool {
        self.active
    }

    /// The event behind the emergency stop while it is active.
    #[must_use]
    pub(in crate::sinumerik) fn active_cause(self) -> Option<EventId> {
        self.active.then_some(self.cause)
    }
}

/// An operating mode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum Mode {
    /// Automatic.
    Automatic,
    /// Manual data input, automatic.
    Mda,
    /// Manual traversing.
    #[default]
    Jog,
}

impl Mode {
    /// The mode after power on according to MD10720.
    pub(in crate::sinumerik) const fn after_power_on(datum: i32) -> Self {
        match datum {
            0 | 1 => Self::Automatic,
            2..=5 => Self::Mda,
            _ => Self::Jog,
        }
    }
}

/// The function of the keys within a mode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum MachineFunction {
    /// The mode itself.
    #[default]
    None,
    /// TEACH IN in MDA.
    TeachIn,
    /// REPOS in JOG.
    Repos,
    /// REF in JOG.
    Reference,
}

/// The state of a mode group.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct ModeGroup {
    /// The active mode.
    pub mode: Mode,
    /// The active machine function.
    pub function: MachineFunction,
    /// The event behind the mode.
    pub mode_cause: EventId,
    /// The event behind the machine function.
    pub function_cause: EventId,
    /// The mode whose selection is refused: 16913 comes once.
    pub refused: Option<Mode>,
    /// REF is refused: 16914 comes once.
    pub refused_reference: bool,
    /// DB11.DBB5 was written from outside: the control no longer mirrors REF there (E-01).
    pub hmi_owns_strobe: bool,
}

impl ModeGroup {
    /// The state after power on.
    pub(in crate::sinumerik) fn new(parameters: &Parameters, group: ModeGroupNumber) -> Self {
        Self { mode: Mode::after_power_on(parameters.mode_after_power_on[group]), ..Self::default() }
    }

    /// The latest change of mode or machine function.
    pub(in crate::sinumerik) fn cause(&self) -> EventId {
        self.mode_cause.max(self.function_cause)
    }

    /// Machine function REF.
    #[must_use]
    pub(in crate::sinumerik) fn is_referencing(&self) -> bool {
        self.function == MachineFunction::Reference
    }

    /// JOG without a machine function.
    #[must_use]
    pub(in crate::sinumerik) fn is_jogging(&self) -> bool {
        self.mode == Mode::Jog && self.function == MachineFunction::None
    }
}

/// Progress of the start-up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct RunUp {
    pub cycles: u8,
    pub drives_ready: bool,
    /// The event behind the latest step.
    pub cause: EventId,
    /// The event behind 108.6.
    pub drives_cause: EventId,
}

impl RunUp {
    /// 104.7.
    #[must_use]
    pub(in crate::sinumerik) const fn is_cpu_ready(&self) -> bool {
        self.cycles >= STEP
    }

    /// 108.5.
    #[must_use]
    pub(in crate::sinumerik) const fn are_drives_cyclic(&self) -> bool {
        self.cycles >= 2 * STEP
    }

    /// 108.6.
    #[must_use]
    pub(in crate::sinumerik) const fn are_drives_ready(&self) -> bool {
        self.are_drives_cyclic() && self.drives_ready
    }

    /// The start-up has ended. 108.7 is this without alarms that reset NC ready.
    #[must_use]
    pub(in crate::sinumerik) const fn is_nc_ready(&self) -> bool {
        self.cycles >= 3 * STEP
    }
}
