//! The state of a spindle.

use serde::{Deserialize, Serialize};

use crate::nc_program::Dimension;
use crate::units::Position;
use crate::variables::{EventId, Input};

/// The mode of a spindle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum Mode {
    /// 84.7: speed control.
    #[default]
    Control,
    /// 84.5: SPOS, SPOSA, M19.
    Positioning(SpindlePositioning),
    /// M70: it is an axis, once it stands.
    Axis,
}

/// A positioning of a spindle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct SpindlePositioning {
    /// The angle, or the distance with IC.
    pub angle: Position,
    pub dimension: Dimension,
    /// In increments per second; `None`: MD35300.
    pub speed: Option<f64>,
    pub phase: Phase,
}

/// The phase of a positioning.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum Phase {
    /// Where the search began, once the spindle turns no faster than MD35300.
    Searching { from: Option<Position> },
    /// To this target.
    Going { target: Position },
    /// It is there.
    InPosition { target: Position },
}

/// A change of the gear stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct GearChange {
    /// It oscillates: the direction, and the cycles left in it.
    pub oscillation: Option<(i8, u64)>,
    /// The cycles that RESET has waited.
    pub waited: u64,
}

/// What a spindle does, and what it shows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Spindle {
    pub mode: Mode,
    /// The event behind the mode.
    pub mode_cause: EventId,
    /// The event behind 85.5.
    pub position_cause: EventId,
    /// The actual gear stage; 0 without gear stages.
    pub gear_stage: u8,
    /// 82.0 to 82.2: the stage that a program wanted last.
    pub wanted_stage: u8,
    /// M40: S selects the stage.
    pub is_automatic: bool,
    /// 82.3: the stage is being changed.
    pub change: Option<GearChange>,
    /// The event behind 82.x.
    pub gear_cause: EventId,
    /// The PLC lets it oscillate: the direction, and the cycles left in it.
    pub plc_oscillation: Option<(i8, u64)>,
    /// Something has ended the oscillation by the PLC.
    pub is_ended: bool,
    /// The event behind 84.6.
    pub oscillation_cause: EventId,
    /// M3 is +1, M4 is −1, M5 is 0.
    pub direction: i8,
    /// S in rev/min.
    pub speed: f64,
    /// The event behind both.
    pub cause: EventId,
    /// A function has changed them, and the speed of this cycle is not yet commanded.
    pub is_new: bool,
    /// The direction in which a traversing key turns it, or 0.
    pub jog: i8,
    /// The key in the last cycle.
    pub key_was: i8,
    /// NC stop axes plus spindles holds it until NC start.
    pub stopped: bool,
    /// What holds it; in the cycle of its release, that signal with its new value.
    pub holder: Input,
    /// The commanded speed with its sign, in increments per second.
    pub commanded: f64,
    /// 83.1.
    pub limited: bool,
    /// 83.2.
    pub raised: bool,
    /// The event behind them.
    pub limit_cause: EventId,
    /// DBW86.
    pub m_function: u16,
    /// DBD88.
    pub s_function: f32,
    /// The event behind the last output.
    pub function_cause: EventId,
    /// 2.2 in the last cycle.
    pub reset_was: bool,
    /// 16.7 in the last cycle.
    pub delete_was: bool,
}

impl Default for Spindle {
    fn default() -> Self {
        Self {
            mode: Mode::Control,
            mode_cause: EventId::NONE,
            position_cause: EventId::NONE,
            gear_stage: 0,
            wanted_stage: 0,
            is_automatic: false,
            change: None,
            gear_cause: EventId::NONE,
            plc_oscillation: None,
            is_ended: false,
            oscillation_cause: EventId::NONE,
            direction: 0,
            speed: 0.0,
            cause: EventId::NONE,
            is_new: false,
            jog: 0,
            key_was: 0,
            stopped: false,
            holder: Input::None,
            commanded: 0.0,
            limited: false,
            raised: false,
            limit_cause: EventId::NONE,
            m_function: 0,
            s_function: 0.0,
            function_cause: EventId::NONE,
            reset_was: false,
            delete_was: false,
        }
    }
}

impl Spindle {
    /// The M function of its direction: 3, 4 or 5.
    pub(in crate::sinumerik) const fn direction_in_words(&self) -> i32 {
        match self.direction {
            0 => 5,
            direction if direction > 0 => 3,
            _ => 4,
        }
    }

    /// 85.5.
    pub(in crate::sinumerik) const fn is_in_position(&self) -> bool {
        matches!(self.mode, Mode::Positioning(SpindlePositioning { phase: Phase::InPosition { .. }, .. }))
    }

    /// The target of positioning, once it is known.
    pub(in crate::sinumerik) const fn target(&self) -> Option<Position> {
        match self.mode {
            Mode::Positioning(SpindlePositioning {
                phase: Phase::Going { target } | Phase::InPosition { target },
                ..
            }) => Some(target),
            Mode::Positioning(_) | Mode::Control | Mode::Axis => None,
        }
    }

    /// Speed control, after this event.
    pub(in crate::sinumerik) fn leave_positioning(&mut self, cause: EventId) {
        if self.mode != Mode::Control {
            (self.mode, self.mode_cause, self.position_cause) = (Mode::Control, cause, cause);
        }
    }

    /// Whether a program has given it a direction and a speed.
    pub(in crate::sinumerik) fn is_programmed(&self) -> bool {
        self.direction != 0 && self.speed > 0.0
    }
}
