//! The leadscrew between a motor and its slide: pitch error and play.
//!
//! Drives and encoders are on the side of the motor. The slide, its true position, deviates from the position of the motor by the error of
//! the pitch there, and by the play after each change of direction.

use super::reading::position;
use crate::source::{Node, Problem, Table, Value};
use crate::units::Position;

/// A leadscrew.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Leadscrew {
    /// The slide stands still for this distance after a change of direction. A movement in plus direction pushes it, and a movement in minus
    /// direction leaves it behind by this distance.
    pub backlash: Position,
    /// Positions of the motor in ascending order, each with the distance by which the slide is farther in plus direction there.
    pub pitch_error: Vec<(Position, Position)>,
}

impl Leadscrew {
    /// By how much the slide is farther than the motor, without play: linear between the given positions, constant beyond them.
    #[must_use]
    pub fn error(&self, motor: Position) -> Position {
        let after = self.pitch_error.partition_point(|(at, _)| *at <= motor);
        let point = |index: usize| self.pitch_error.get(index).copied();
        match (after.checked_sub(1).and_then(point), point(after)) {
            (None, None) => Position::ZERO,
            (None, Some((_, error))) | (Some((_, error)), None) => error,
            (Some((from, first)), Some((to, second))) => {
                let part = (motor - from).increments() as f64 / (to - from).increments() as f64;
                #[expect(clippy::cast_possible_truncation, reason = "an error is bounded; the cast saturates")]
                let error = ((second - first).increments() as f64 * part).round() as i64;
                first + Position::new(error)
            }
        }
    }

    /// The side of the play after the motor has moved: 0 while plus movement pushes the slide, the whole backlash after minus movement.
    #[must_use]
    pub fn play(&self, before: Position, moved: Position) -> Position {
        (before - moved).clamp(Position::ZERO, self.backlash)
    }
}

pub(super) fn leadscrew(mut table: Table) -> Result<Leadscrew, Problem> {
    let mut leadscrew = Leadscrew::default();
    if let Some(node) = table.take("backlash") {
        let what = "a backlash of 0 mm or degrees or more";
        leadscrew.backlash = position(&node, what)?;
        if leadscrew.backlash < Position::ZERO {
            return Err(node.expected(what, "write the play of the slide as a positive number"));
        }
    }
    if let Some(node) = table.take("pitch_error") {
        leadscrew.pitch_error = pitch_error(&node)?;
    }
    table.finish()?;
    Ok(leadscrew)
}

fn pitch_error(node: &Node) -> Result<Vec<(Position, Position)>, Problem> {
    let what = "pairs of position and error in ascending order of positions";
    let cure = "write pitch_error = [[0.0, 0.0], [100.0, 0.012]]";
    let Value::Array(pairs) = &node.value else { return Err(node.expected(what, cure)) };
    let mut points = Vec::new();
    for pair in pairs {
        let Value::Array(values) = &pair.value else { return Err(pair.expected(what, cure)) };
        let [at, error] = values.as_slice() else { return Err(pair.expected(what, cure)) };
        let point = (position(at, "a position in mm or degrees")?, position(error, "an error in mm or degrees")?);
        if points.last().is_some_and(|(before, _)| *before >= point.0) {
            return Err(pair.expected(what, cure));
        }
        points.push(point);
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mm(value: f64) -> Position {
        Position::from_user(value)
    }

    #[test]
    fn the_pitch_error_is_linear_between_its_points_and_constant_beyond_them() {
        let pitch_error = vec![(mm(0.0), mm(0.0)), (mm(100.0), mm(0.02)), (mm(200.0), mm(-0.02))];
        let leadscrew = Leadscrew { pitch_error, ..Leadscrew::default() };
        for (motor, error) in [(-9.0, 0.0), (0.0, 0.0), (50.0, 0.01), (100.0, 0.02), (150.0, 0.0), (250.0, -0.02)] {
            assert_eq!(leadscrew.error(mm(motor)), mm(error), "{motor}");
        }
        assert_eq!(Leadscrew::default().error(mm(5.0)), Position::ZERO);
    }

    #[test]
    fn the_slide_stands_still_for_the_backlash_after_each_change_of_direction() {
        let leadscrew = Leadscrew { backlash: mm(0.03), ..Leadscrew::default() };
        let mut play = Position::ZERO;
        for (moved, expected) in [(5.0, 0.0), (-0.01, 0.01), (-0.01, 0.02), (-5.0, 0.03), (0.02, 0.01), (0.02, 0.0)] {
            play = leadscrew.play(play, mm(moved));
            assert_eq!(play, mm(expected), "{moved}");
        }
    }
}
