//! Whether an axis is to travel, and whether it may.
//!
//! Shown as traverse request (64.4, 64.5) and traverse command (64.6, 64.7). Decision O-27: with MD17900 bit 0 = 0, the default, the
//! command is output with the request, also without controller enable and under feed stop, feed disable and an override of 0 %. A PLC
//! program unclamps and enables the axis because of it, so it must not wait for that. Only the movement waits. With bit 0 = 1 the command
//! is output only while the axis may really move. The request is the same in both cases.
//!
//! A synchronous axis that its leading axis takes along shows the command of the leading axis, and no request: it has none of its own (SIG-09,
//! C-48).
//!
//! A movement that something else blocks (a software limit switch, the fast stop 20.1) is requested and not commanded, in both cases.

use serde::{Deserialize, Serialize};

use crate::image::{Signal, axis_from_nck};
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::parameters::Parameters;
use crate::units::AxisNumber;
use crate::variables::Input;

/// The travel of an axis; the direction is +1 or −1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum Travel {
    /// None is requested.
    #[default]
    None,
    /// It moves.
    Moving(i8),
    /// It waits for an enable, or feed stop, feed disable or an override of 0 % holds it.
    Waiting(i8),
    /// It is requested, and cannot take place in this direction.
    Blocked(i8),
    /// A synchronous axis whose leading axis moves.
    LedMoving(i8),
    /// A synchronous axis whose leading axis waits.
    LedWaiting(i8),
}

impl Travel {
    /// A movement in this direction; none for 0.
    #[must_use]
    pub(in crate::sinumerik) const fn moving(direction: i8) -> Self {
        if direction == 0 { Self::None } else { Self::Moving(direction) }
    }

    /// A movement in this direction that waits; none for 0.
    #[must_use]
    pub(in crate::sinumerik) const fn waiting(direction: i8) -> Self {
        if direction == 0 { Self::None } else { Self::Waiting(direction) }
    }

    /// A movement in this direction that is blocked; none for 0.
    #[must_use]
    pub(in crate::sinumerik) const fn blocked(direction: i8) -> Self {
        if direction == 0 { Self::None } else { Self::Blocked(direction) }
    }

    /// The travel of a synchronous axis whose leading axis has this one.
    #[must_use]
    pub(in crate::sinumerik) const fn of_led_axis(self) -> Self {
        match self {
            Self::None | Self::Blocked(_) => Self::None,
            Self::Moving(direction) | Self::LedMoving(direction) => Self::LedMoving(direction),
            Self::Waiting(direction) | Self::LedWaiting(direction) => Self::LedWaiting(direction),
        }
    }

    /// 64.4 and 64.5: +1, −1 or 0.
    #[must_use]
    pub(in crate::sinumerik) const fn request(self) -> i8 {
        match self {
            Self::None | Self::LedMoving(_) | Self::LedWaiting(_) => 0,
            Self::Moving(direction) | Self::Waiting(direction) | Self::Blocked(direction) => direction,
        }
    }

    /// 64.6 and 64.7: +1, −1 or 0.
    #[must_use]
    pub(in crate::sinumerik) const fn command(self, parameters: &Parameters) -> i8 {
        match self {
            Self::None | Self::Blocked(_) => 0,
            Self::Moving(direction) | Self::LedMoving(direction) => direction,
            Self::Waiting(direction) | Self::LedWaiting(direction) => {
                if parameters.command_only_in_motion {
                    0
                } else {
                    direction
                }
            }
        }
    }

    /// Whether the axis moves or is to move.
    #[must_use]
    pub(in crate::sinumerik) const fn is_pending(self) -> bool {
        self.is_moving() || self.is_waiting()
    }

    /// Whether it moves.
    #[must_use]
    pub(in crate::sinumerik) const fn is_moving(self) -> bool {
        matches!(self, Self::Moving(_) | Self::LedMoving(_))
    }

    /// Whether it waits.
    #[must_use]
    pub(in crate::sinumerik) const fn is_waiting(self) -> bool {
        matches!(self, Self::Waiting(_) | Self::LedWaiting(_))
    }

    /// The signal that shows it while the axis moves or is to move: the command if it is output, otherwise the request.
    #[must_use]
    pub(in crate::sinumerik) const fn shown(self, axis: AxisNumber, parameters: &Parameters) -> Input {
        match (self.command(parameters), self.request()) {
            (0, 0) => Input::None,
            (0, request) => axis_signal(axis, request_signal(request), true),
            (command, _) => axis_signal(axis, command_signal(command), true),
        }
    }
}

/// The traverse command of a direction, −1 or +1.
#[must_use]
pub(in crate::sinumerik) const fn command_signal(direction: i8) -> Signal {
    if direction > 0 { axis_from_nck::traverse_command_plus } else { axis_from_nck::traverse_command_minus }
}

/// The traverse request of a direction, −1 or +1.
#[must_use]
pub(in crate::sinumerik) const fn request_signal(direction: i8) -> Signal {
    if direction > 0 { axis_from_nck::traverse_request_plus } else { axis_from_nck::traverse_request_minus }
}
