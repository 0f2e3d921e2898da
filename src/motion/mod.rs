//! AXIS MECHANICS AND CONTROL LOOPS, independent of the kind of control: setpoint profiles, position control, the drive's response,
//! encoders, the one [`coupling`] engine for all gantries, and the [`path`] of an NC program.
//!
//! Everything is computed in whole cycles; the cycle time is in seconds. Positions are whole increments; a fraction of an increment is
//! carried over and never lost. Arithmetic uses only `+ − × ÷ sqrt` and comparisons, so every build and machine computes the same bits.

mod command;
pub mod coupling;
mod delay;
mod encoder;
mod feedback;
mod jerk;
pub mod path;
mod profile;
mod servo;
mod waveform;

pub use command::Motion;
pub use delay::{DeadTime, Pt1};
pub use encoder::{Encoder, EncoderSignal};
pub use feedback::{Brake, Feedback};
pub use jerk::{JerkFilter, LONGEST_WINDOW};
pub use profile::{Limits, Movement, Setpoint};
pub use servo::{Drive, velocity_command};
pub use waveform::Waveform;

/// The farthest position of an axis, in increments. It is beyond every position that machine data can express, and small enough for sums,
/// differences and fine interpolation of positions.
const FARTHEST: i64 = 1 << 52;

/// Limits a position to the range that an axis can reach.
#[must_use]
pub fn within_reach(position: i64) -> crate::units::Position {
    crate::units::Position::new(position.clamp(-FARTHEST, FARTHEST))
}

/// Adds a movement in increments to a position and carries the fraction. The result is limited to [`FARTHEST`]. A movement of zero changes
/// neither.
pub(crate) fn advance(position: crate::units::Position, carry: &mut f64, movement: f64) -> crate::units::Position {
    if movement == 0.0 {
        return position;
    }
    let wanted = movement + *carry;
    // Rounds half away from zero, like `round`, which is a function call on some processors. The cast drops the fraction and saturates.
    // The rounding direction is practically random, so the code has no branch on it.
    #[expect(clippy::cast_possible_truncation, reason = "the cast saturates")]
    let truncated = wanted as i64;
    let fraction = wanted - truncated as f64;
    let whole = truncated.saturating_add(i64::from(fraction >= 0.5) - i64::from(fraction <= -0.5));
    *carry = wanted - whole as f64;
    within_reach(position.increments().saturating_add(whole))
}

#[cfg(test)]
mod tests {
    use super::advance;
    use crate::units::Position;

    #[test]
    fn a_fraction_of_an_increment_is_carried_and_halves_go_away_from_zero() {
        for movement in [0.0, 0.25, 0.5, -0.5, 1.5, -2.5, 0.499_999_999_999_999_94, 1e9 + 0.5, -4.75, 1e17] {
            let mut carry = 0.0;
            let moved = advance(Position::ZERO, &mut carry, movement);
            let rounded = f64::round(movement).clamp(-(super::FARTHEST as f64), super::FARTHEST as f64);
            assert!((moved.increments() as f64 - rounded).abs() <= 0.0, "{movement}");
            assert!((carry - (movement - movement.round())).abs() <= 0.0, "{movement}");
        }
    }
}
