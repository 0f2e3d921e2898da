//! Mode group 1: modes and machine functions.
//!
//! Called first in the control's part of a cycle. Requests are levels (O-19): the highest of JOG, MDA, AUTO that is 1
//! is taken, all 0 keeps the mode, DBX0.4 inhibits a change. Machine functions act within their mode: REF in JOG.
//! Without MD10720, the control starts in JOG.

use serde::{Deserialize, Serialize};

use super::State;
use super::rules::Rule;
use crate::image::ToNck;
use crate::units::ModeGroupNumber;
use crate::variables::{EventId, Input, Place, SignalBit};

/// An operating mode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Mode {
    /// Automatic.
    Automatic,
    /// Manual data input, automatic.
    Mda,
    /// Manual traversing.
    #[default]
    Jog,
}

/// The state of the mode group.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct ModeGroup {
    /// The active mode.
    pub mode: Mode,
    /// Machine function REF is active within JOG.
    pub reference: bool,
    /// The event behind the mode.
    pub mode_cause: EventId,
    /// The event behind the machine function.
    pub function_cause: EventId,
    /// DB11.DBB5 was written from outside: the control does not mirror REF there any more (E-01).
    pub strobe_is_the_hmi_s: bool,
}

impl ModeGroup {
    /// The latest change of mode or machine function.
    pub(super) fn cause(&self) -> EventId {
        self.mode_cause.max(self.function_cause)
    }
}

const FIRST: ModeGroupNumber = ModeGroupNumber::FIRST;

fn bit(byte: u16, bit: u8, value: bool) -> Input {
    Input::Bit(SignalBit { place: Place::ModeGroup(FIRST), byte, bit }, value)
}

impl State {
    /// Modes and machine functions as requested.
    pub(super) fn select_mode(&mut self, to_nck: &ToNck) {
        let signals = &to_nck.mode_groups[FIRST];
        let place = Place::ModeGroup(FIRST);
        let requested = if signals.mode_change_inhibit() {
            None
        } else if signals.mode_jog() {
            Some((Mode::Jog, bit(0, 2, true)))
        } else if signals.mode_mdi() {
            Some((Mode::Mda, bit(0, 1, true)))
        } else if signals.mode_automatic() {
            Some((Mode::Automatic, bit(0, 0, true)))
        } else {
            None
        };
        if let Some((mode, input)) = requested
            && mode != self.mode_group.mode
        {
            self.mode_group.mode = mode;
            self.mode_group.mode_cause = self.log.note_one(place, Rule::ModeSelected, input, EventId::NONE);
        }
        let reference = self.mode_group.mode == Mode::Jog && signals.machine_function_ref();
        if reference != self.mode_group.reference {
            self.mode_group.reference = reference;
            let inputs =
                [bit(1, 2, signals.machine_function_ref()), bit(6, 2, self.mode_group.mode == Mode::Jog), Input::None];
            self.mode_group.function_cause = self.log.note(place, Rule::MachineFunction, inputs, EventId::NONE);
        }
    }

    /// Somebody else wrote DB11.DBB5: it is the HMI's from now on (E-01).
    pub(super) fn strobe_written(&mut self) {
        if !self.mode_group.strobe_is_the_hmi_s {
            self.mode_group.strobe_is_the_hmi_s = true;
            self.log.note_plain(Place::ModeGroup(FIRST), Rule::StrobeOwnedByHmi, EventId::NONE);
        }
    }
}
