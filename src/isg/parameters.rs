//! Parameters as the model uses them: increments, seconds, and places of axes instead of logical numbers. [`lists`](super::lists) has them as
//! the control stores them.

use serde::{Deserialize, Serialize};

use super::language::Sign;
use crate::motion::coupling::TwoStage;
use crate::units::{AxisNumber, Position};

/// Increments of 0.1 µm or 0.0001°.
const LENGTH: i64 = 100;
/// Increments per second of 1 µm/s or 0.001°/s.
const VELOCITY: f64 = 1e3;
/// Increments per second squared of 1 mm/s² or 1°/s².
const ACCELERATION: f64 = 1e6;

/// A length of a list.
pub(super) const fn length(tenths: i64) -> Position {
    Position::new(tenths * LENGTH)
}

/// A length in the unit of the lists.
pub(super) fn tenths(at: Position) -> f64 {
    at.increments() as f64 / LENGTH as f64
}

/// A velocity of a list, in increments per second.
pub(super) fn velocity(number: u32) -> f64 {
    f64::from(number) * VELOCITY
}

/// An acceleration of a list, in increments per second squared.
pub(super) fn acceleration(number: u32) -> f64 {
    f64::from(number) * ACCELERATION
}

/// The range of a modulo axis (P-AXIS-00127 and P-AXIS-00126).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Modulo {
    pub lower: Position,
    pub upper: Position,
}

impl Modulo {
    /// A position as it is shown: within the range.
    pub(super) fn shown(self, position: Position) -> Position {
        let width = (self.upper - self.lower).increments();
        self.lower + Position::new((position - self.lower).increments().rem_euclid(width.max(1)))
    }

    /// Where an absolute movement ends: at most one turn, in the direction of the sign behind the name of the axis, else on the shortest
    /// way; half a turn goes in plus direction. `way` is the value of the word, with its sign.
    pub(super) fn target(self, start: f64, way: f64, sign: Option<Sign>) -> f64 {
        let width = (self.upper - self.lower).increments() as f64;
        let position = if sign == Some(Sign::Minus) { -way } else { way };
        let forward = (position - start).rem_euclid(width);
        let goes_back = match sign {
            Some(Sign::Plus) => false,
            Some(Sign::Minus) => forward > 0.0,
            None => forward > width / 2.0,
        };
        start + if goes_back { forward - width } else { forward }
    }
}

/// How a difference is cleared (P-AXIS-00704, with P-AXIS-00261).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Clearing {
    /// DEFAULT: at a reset, and while `gantry_on` is set.
    #[default]
    ResetOrUnit,
    /// ONLY_CONTROL_UNIT: while `gantry_on` is set, with drive enables and a ready drive.
    Unit,
    /// EDGE_TRIGGERED: at a rising edge of `gantry_on`.
    Edge,
    /// CONFIG: never; the combination can be opened in a program.
    Never,
}

/// How an axis is homed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Homing {
    /// The axis is not homed by a homing run (P-AXIS-00299 DISABLED).
    pub disabled: bool,
    /// The list says CNC_CONTROLLED: also a drive that could home by itself does not (HG-23).
    pub by_the_cnc: bool,
    /// The absolute position of the encoder is no reference (P-AXIS-00299 IGNORE_ABS_POS).
    pub ignores_absolute: bool,
    /// +1 or −1: where the search begins (P-AXIS-00158).
    pub direction: f64,
    /// To the cam (P-AXIS-00219).
    pub fast: f64,
    /// Off the cam and onto it again (P-AXIS-00218).
    pub slow: f64,
    /// P-AXIS-00285.
    pub acceleration: f64,
    /// The position at the reference (P-AXIS-00152).
    pub position: Position,
    /// P-AXIS-00156 = 0.
    pub with_cam: bool,
    /// P-AXIS-00157 = 0.
    pub reverses: bool,
    /// P-AXIS-00084 = 0.
    pub with_zero_pulse: bool,
    /// How far a slave may travel (P-AXIS-00284); `None` without a limit.
    pub farthest: Option<Position>,
}

/// The parameters of an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct AxisParameters {
    /// P-AXIS-00016.
    pub number: u16,
    /// P-AXIS-00018.
    pub kind: u16,
    /// P-AXIS-00015.
    pub mode: u32,
    pub is_rotary: bool,
    /// The range of a modulo axis.
    pub modulo: Option<Modulo>,
    pub is_master: bool,
    pub is_slave: bool,
    /// The master of a slave (P-AXIS-00070).
    pub master: Option<AxisNumber>,
    /// P-AXIS-00072 and P-AXIS-00071; `None` if the list gives none.
    pub limits: Option<TwoStage>,
    /// P-AXIS-00073.
    pub offset: Position,
    /// P-AXIS-00074.
    pub takes_masters_homing: bool,
    /// P-AXIS-00249.
    pub checks_without_homing: bool,
    /// P-AXIS-00253.
    pub homes_at_once: bool,
    /// P-AXIS-00254.
    pub stops_controlled: bool,
    pub clearing: Clearing,
    /// P-AXIS-00075.
    pub correction_velocity: f64,
    /// P-AXIS-00008.
    pub acceleration: f64,
    /// P-AXIS-00003, or P-AXIS-00008 where it is 0.
    pub emergency: f64,
    /// P-AXIS-00212.
    pub velocity: f64,
    pub homing: Homing,
}

/// The bits of P-AXIS-00015 that make an axis a gantry master or slave.
pub(super) const GANTRY_BITS: u32 = 0x0003_0000;
