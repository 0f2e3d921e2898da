//! THE AXIS, dialect-free: setpoint profiles, position control, the drive's answer, encoders, and the one
//! [`coupling`] engine that every gantry uses.
//!
//! Everything here is stepped by whole cycles with a cycle time in seconds; positions are whole increments, and a
//! fraction of an increment is carried, never lost. Arithmetic is `+ − × ÷ sqrt` and comparisons only, so that every
//! build and machine computes the same bits.

mod command;
pub mod coupling;
mod delay;
mod encoder;
mod feedback;
mod jerk;
mod profile;
mod servo;

pub use command::Motion;
pub use delay::{DeadTime, Pt1};
pub use encoder::{Encoder, EncoderSignal};
pub use feedback::Feedback;
pub use jerk::{JerkFilter, LONGEST_WINDOW};
pub use profile::{Limits, Movement, Setpoint};
pub use servo::{Drive, velocity_command};

/// How far an axis can run away, in increments: beyond every position that machine data can say, and near enough to zero
/// for sums, differences and fine interpolation of positions.
const FARTHEST: i64 = 1 << 52;

/// A position as far away as an axis can be at most.
#[must_use]
pub fn within_reach(position: i64) -> crate::units::Position {
    crate::units::Position::new(position.clamp(-FARTHEST, FARTHEST))
}

/// Adds a movement in increments to a position, carrying the fraction; it ends at [`FARTHEST`]. No movement changes neither.
pub(crate) fn advance(position: crate::units::Position, carry: &mut f64, movement: f64) -> crate::units::Position {
    if movement == 0.0 {
        return position;
    }
    let wanted = movement + *carry;
    // Half away from zero, as `round` does, which is a call on some processors; the cast drops the fraction and saturates. Which
    // way it is rounded is as good as random, so that nothing branches on it.
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
