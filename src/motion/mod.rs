//! THE AXIS, dialect-free: setpoint profiles, position control, the drive's answer, encoders, and the one
//! [`Coupling`] core that every gantry uses.
//!
//! Everything here is stepped by whole cycles with a cycle time in seconds; positions are whole increments, and a
//! fraction of an increment is carried, never lost. Arithmetic is `+ − × ÷ sqrt` and comparisons only, so that every
//! build and machine computes the same bits.

mod coupling;
mod delay;
mod encoder;
mod jerk;
mod profile;
mod servo;

pub use coupling::{Coupling, Difference, Stage};
pub use delay::{DeadTime, Pt1};
pub use encoder::{Encoder, EncoderSignal};
pub use jerk::{JerkFilter, LONGEST_WINDOW};
pub use profile::{Limits, Setpoint};
pub use servo::{Drive, velocity_command};

/// How far an axis can run away, in increments: beyond every position that machine data can say, and near enough to zero
/// for sums, differences and fine interpolation of positions.
const FARTHEST: i64 = 1 << 52;

/// Adds a movement in increments to a position, carrying the fraction; it ends at [`FARTHEST`]. No movement changes neither.
pub(crate) fn advance(position: crate::units::Position, carry: &mut f64, movement: f64) -> crate::units::Position {
    if movement == 0.0 {
        return position;
    }
    let wanted = movement + *carry;
    let whole = wanted.round();
    *carry = wanted - whole;
    #[expect(clippy::cast_possible_truncation, reason = "the cast saturates")]
    let whole = whole as i64;
    crate::units::Position::new(position.increments().saturating_add(whole).clamp(-FARTHEST, FARTHEST))
}
