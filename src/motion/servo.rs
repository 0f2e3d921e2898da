//! Position control and the drive. Both run once per position-control cycle; an interpolation cycle contains a whole
//! number of these.
//!
//! The speed loop responds as PT1, discretised as `a = T / (τ + T)`, which is stable for every τ ≥ 0.

use serde::{Deserialize, Serialize};

use crate::units::Position;

/// The velocity command of position control, in increments per second.
///
/// `deviation` is setpoint minus actual value in increments. A deviation of at most half an encoder count cannot be
/// detected and gives no command. `feed_forward` is the part of the setpoint velocity that is added (0 without
/// feedforward).
#[must_use]
pub fn velocity_command(deviation: f64, gain: f64, half_count: Position, feed_forward: f64) -> f64 {
    let seen = if deviation.abs() <= half_count.increments() as f64 { 0.0 } else { deviation };
    seen * gain + feed_forward
}

/// A drive: the velocity of its motor, referred to the slide.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Drive {
    velocity: f64,
    carry: f64,
}

impl Drive {
    /// The response of the speed loop to a command, one position-control cycle later.
    pub fn answer(&mut self, command: f64, time_constant: f64, cycle: f64) {
        if command == 0.0 && self.velocity == 0.0 {
            return;
        }
        let share = cycle / (time_constant + cycle);
        self.velocity += share * (command - self.velocity);
        // Far below one increment per hour: the drive is at rest. This avoids denormal numbers.
        if self.velocity.abs() < 1e-4 {
            self.velocity = 0.0;
        }
    }

    /// Velocity in increments per second.
    #[must_use]
    pub const fn velocity(&self) -> f64 {
        self.velocity
    }

    /// Sets the velocity of a motor that is blocked or moved by an external force.
    pub fn force(&mut self, velocity: f64) {
        self.velocity = velocity;
    }

    /// Moves a slide for one cycle.
    #[must_use]
    pub fn moved(&mut self, slide: Position, cycle: f64) -> Position {
        super::advance(slide, &mut self.carry, self.velocity * cycle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CYCLE: f64 = 0.002;

    #[test]
    fn the_drive_responds_as_pt1() {
        let mut drive = Drive::default();
        for _ in 0..3 {
            drive.answer(1000.0, 0.004, CYCLE);
        }
        // a = 2/(4+2) = 1/3; after three cycles 1 − (2/3)³ = 19/27 of the command.
        assert!((drive.velocity() - 1000.0 * 19.0 / 27.0).abs() < 1e-9);
    }

    /// Without feed-forward, the following error at constant velocity is v/Kv.
    #[test]
    fn the_following_error_is_velocity_over_gain() {
        let gain = 1000.0 / 60.0;
        let (mut setpoint, mut slide, mut drive) = (Position::ZERO, Position::ZERO, Drive::default());
        for _ in 0..2_000 {
            setpoint += Position::new(200_000);
            let deviation = (setpoint - slide).increments() as f64;
            let command = velocity_command(deviation, gain, Position::new(50), 0.0);
            drive.answer(command, 0.003, CYCLE);
            slide = drive.moved(slide, CYCLE);
        }
        // 100 mm/s ÷ 16.667 1/s = 6 mm, plus one cycle (0.2 mm) by which the setpoint leads in this order.
        let error = (setpoint - slide).user();
        assert!((error - 6.0).abs() < 0.201, "{error}");
    }

    #[test]
    fn less_than_half_a_count_gives_no_command() {
        assert_eq!(velocity_command(50.0, 16.0, Position::new(50), 0.0).to_bits(), 0.0_f64.to_bits());
        assert!(velocity_command(51.0, 16.0, Position::new(50), 0.0) > 0.0);
    }
}
