//! Where a spindle is positioned: the next position of the wanted angle in the right direction.

use crate::nc_program::Dimension;
use crate::units::Position;

/// One revolution in increments.
const REVOLUTION: i64 = 360_000_000;

/// How a spindle moves when its position is known: where it is, its velocity in increments per second, and the deceleration with which it can
/// stop, in increments per second squared.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    pub position: Position,
    pub velocity: f64,
    pub deceleration: f64,
}

/// The target of an angle, or of a distance (IC). A turning spindle goes on in its direction, unless ACP or ACN demand the other one; a standing
/// one takes the shorter way.
pub(super) fn target(angle: Position, dimension: Dimension, course: Course) -> Position {
    let from = course.position.increments();
    let braking = course.velocity * course.velocity.abs() / (2.0 * course.deceleration);
    #[expect(clippy::cast_possible_truncation, reason = "a braking distance fits; the cast saturates")]
    let stop = from.saturating_add(braking.ceil() as i64);
    let angle = angle.increments();
    let forwards = stop + (angle - stop).rem_euclid(REVOLUTION);
    let backwards = stop - (stop - angle).rem_euclid(REVOLUTION);
    let target = match dimension {
        Dimension::Incremental => from + angle,
        Dimension::FromPlus => forwards,
        Dimension::FromMinus => backwards,
        Dimension::Absolute | Dimension::Shortest if course.velocity > 0.0 => forwards,
        Dimension::Absolute | Dimension::Shortest if course.velocity < 0.0 => backwards,
        Dimension::Absolute | Dimension::Shortest if forwards - stop <= stop - backwards => forwards,
        Dimension::Absolute | Dimension::Shortest => backwards,
    };
    Position::new(target)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(from: f64, revolutions_per_second: f64, angle: f64, dimension: Dimension) -> f64 {
        let velocity = revolutions_per_second * 360.0 * Position::PER_USER_UNIT;
        // 10 rev/s².
        let course =
            Course { position: Position::from_user(from), velocity, deceleration: 3600.0 * Position::PER_USER_UNIT };
        target(Position::from_user(angle), dimension, course).user()
    }

    #[test]
    fn a_standing_spindle_takes_the_shorter_way_or_that_of_acp_and_acn() {
        let cases = [
            (350.0, 10.0, Dimension::Absolute, 370.0),
            (10.0, 350.0, Dimension::Shortest, -10.0),
            (720.0, 180.0, Dimension::Shortest, 900.0),
            (350.0, 340.0, Dimension::FromPlus, 700.0),
            (350.0, 10.0, Dimension::FromMinus, 10.0),
            (350.0, 350.0, Dimension::FromPlus, 350.0),
            (10.0, -90.0, Dimension::Incremental, -80.0),
            (10.0, 720.0, Dimension::Incremental, 730.0),
        ];
        for (from, angle, dimension, expected) in cases {
            let found = at(from, 0.0, angle, dimension);
            assert!((found - expected).abs() < 1e-6, "{from} {angle} {dimension:?}: {found}");
        }
    }

    /// 5 rev/s with 10 rev/s² stop after 25 / 20 = 1.25 revolutions, 450 degrees.
    #[test]
    fn a_turning_spindle_goes_on_in_its_direction_and_has_the_way_to_brake() {
        let cases = [
            (0.0, 5.0, 90.0, Dimension::Absolute, 450.0),
            (0.0, 5.0, 80.0, Dimension::Shortest, 800.0),
            (0.0, -5.0, 80.0, Dimension::Absolute, -640.0),
            (0.0, -5.0, 270.0, Dimension::FromMinus, -450.0),
            // It stops at 450 and turns round, to the next 80 in minus direction.
            (0.0, 5.0, 80.0, Dimension::FromMinus, 440.0),
            (0.0, -5.0, 80.0, Dimension::FromPlus, -280.0),
        ];
        for (from, speed, angle, dimension, expected) in cases {
            let found = at(from, speed, angle, dimension);
            assert!((found - expected).abs() < 1e-5, "{from} {speed} {angle} {dimension:?}: {found}");
        }
    }
}
