//! The setpoint of one axis, limited in velocity and acceleration. Target, velocity and direction may change during
//! motion.
//!
//! Called once per interpolation cycle, by the stage "setpoints". A profile that runs to a target uses the discrete
//! braking distance. It ends on the target exactly, and its last step is at most one cycle's acceleration.

use serde::{Deserialize, Serialize};

use crate::units::Position;

/// The limits of a movement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest velocity, in increments per second.
    pub velocity: f64,
    /// Largest acceleration, in increments per second squared.
    pub acceleration: f64,
}

/// The movement of a setpoint in one cycle, for another setpoint that follows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Movement {
    way: Position,
    velocity: f64,
    held_back: bool,
}

impl Movement {
    /// The same movement in the opposite direction.
    #[must_use]
    pub(super) fn reversed(self) -> Self {
        Self { way: -self.way, velocity: -self.velocity, ..self }
    }
}

/// The setpoint of an axis and its velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Setpoint {
    /// Position.
    pub position: Position,
    carry: f64,
    velocity: f64,
    /// A filter still delays part of the movement.
    held_back: bool,
}

impl Setpoint {
    /// A setpoint at rest at this position.
    #[must_use]
    pub const fn at(position: Position) -> Self {
        Self { position, carry: 0.0, velocity: 0.0, held_back: false }
    }

    /// Velocity in increments per second.
    #[must_use]
    pub const fn velocity(&self) -> f64 {
        self.velocity
    }

    /// Whether it is at rest.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.velocity.abs() < 1e-9 && !self.held_back
    }

    /// Whether it does not move at all, so that braking has no effect.
    #[must_use]
    pub const fn is_still(&self) -> bool {
        self.velocity.to_bits() == 0 && !self.held_back
    }

    /// Moves for one cycle towards a velocity (signed, increments per second). Used for jogging, searching and, with 0,
    /// braking.
    pub fn run(&mut self, velocity: f64, acceleration: f64, cycle: f64) {
        self.held_back = false;
        let step = acceleration * cycle;
        self.velocity += (velocity - self.velocity).clamp(-step, step);
        self.position = super::advance(self.position, &mut self.carry, self.velocity * cycle);
    }

    /// Moves for one cycle towards a target. Returns true when the setpoint rests there.
    pub fn go_to(&mut self, target: Position, limits: Limits, cycle: f64) -> bool {
        self.held_back = false;
        let distance = (target - self.position).increments() as f64 - self.carry;
        let step = limits.acceleration * cycle;
        if distance.abs() < 0.5 && self.velocity.abs() <= step * 1.001 {
            *self = Self::at(target);
            return true;
        }
        // The largest velocity from which N whole cycles of braking end on the target: the sum v·T + (v − aT)·T + …
        // over N cycles equals the distance, for the smallest possible N.
        let in_steps = distance.abs() / (step * cycle);
        let cycles = ((0.25 + 2.0 * in_steps).sqrt() - 0.5).ceil().max(1.0);
        let braking = step * (in_steps / cycles + 0.5 * (cycles - 1.0));
        let wanted = braking.min(limits.velocity).copysign(distance);
        self.velocity += (wanted - self.velocity).clamp(-step, step);
        let movement = self.velocity * cycle;
        let reaches = movement.abs() + 0.5 >= distance.abs() && movement * distance >= 0.0;
        if reaches && self.velocity.abs() <= step * 1.001 {
            // The last cycle of motion ends on the target; the next one is at rest.
            self.velocity = distance / cycle;
            self.position = target;
            self.carry = 0.0;
        } else {
            self.position = super::advance(self.position, &mut self.carry, movement);
        }
        false
    }

    /// The movement since `before`, the position before this cycle, and the present velocity.
    #[must_use]
    pub fn moved_from(&self, before: Position) -> Movement {
        Movement { way: self.position - before, velocity: self.velocity, held_back: self.held_back }
    }

    /// Follows another setpoint: takes over its movement in the same cycle and its present velocity.
    pub fn follow(&mut self, movement: Movement) {
        self.position += movement.way;
        (self.velocity, self.held_back) = (movement.velocity, movement.held_back);
    }

    /// Is moved to a position by the path of a program, with the velocity of this cycle.
    pub fn lead(&mut self, position: Position, velocity: f64) {
        *self = Self { position, carry: 0.0, velocity, held_back: false };
    }

    /// Sets the output of a filter for this setpoint.
    pub(super) fn show(&mut self, position: Position, velocity: f64, held_back: bool) {
        *self = Self { position, carry: 0.0, velocity, held_back };
    }

    /// Shifts the coordinate without a movement: setting a reference moves nothing.
    pub fn shift(&mut self, by: Position) {
        self.position += by;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CYCLE: f64 = 0.002;
    /// 10 m/min and 1 m/s² in nanometres.
    const LIMITS: Limits = Limits { velocity: 10e9 / 60.0, acceleration: 1e9 };

    fn cycles_to(setpoint: &mut Setpoint, target: Position, limits: Limits) -> u32 {
        for count in 1..1_000_000 {
            let before = *setpoint;
            let arrived = setpoint.go_to(target, limits, CYCLE);
            let change = (setpoint.velocity() - before.velocity()).abs();
            // The last cycle ends on a whole increment: rounding adds up to one increment per cycle.
            assert!(change <= limits.acceleration * CYCLE + 1.01 / CYCLE, "acceleration {change}");
            assert!(setpoint.velocity().abs() <= limits.velocity + 1e-6);
            if arrived {
                return count;
            }
        }
        panic!("never arrived");
    }

    #[test]
    fn a_movement_takes_the_time_of_the_trapezoid_and_ends_on_the_target() {
        let mut setpoint = Setpoint::default();
        let cycles = cycles_to(&mut setpoint, Position::from_user(100.0), LIMITS);
        // v = 166.67 mm/s, a = 1000 mm/s²: v/a + s/v = 0.1667 s + 0.6 s = 0.7667 s = 383.3 cycles of 2 ms.
        assert!((381..=388).contains(&cycles), "{cycles}");
        assert_eq!(setpoint, Setpoint::at(Position::from_user(100.0)));
    }

    #[test]
    fn a_short_movement_never_reaches_its_velocity_and_does_not_overshoot() {
        let mut setpoint = Setpoint::default();
        let target = Position::from_user(0.5);
        // Triangle: 2·sqrt(s/a) = 2·sqrt(0.5/1000) = 44.7 ms = 22.4 cycles.
        let cycles = cycles_to(&mut setpoint, target, LIMITS);
        assert!((22..=26).contains(&cycles), "{cycles}");
        assert_eq!(setpoint.position, target);
    }

    #[test]
    fn a_target_behind_is_reached_by_braking_and_turning_round() {
        let mut setpoint = Setpoint::default();
        for _ in 0..200 {
            setpoint.run(LIMITS.velocity, LIMITS.acceleration, CYCLE);
        }
        let target = setpoint.position - Position::from_user(1.0);
        cycles_to(&mut setpoint, target, LIMITS);
        assert_eq!(setpoint, Setpoint::at(target));
    }

    #[test]
    fn the_fraction_of_an_increment_is_carried() {
        let mut setpoint = Setpoint::default();
        // 100 nm/s for 10 s is 1000 nm although one cycle is 0.2 nm.
        for _ in 0..5_000 {
            setpoint.run(100.0, 1e9, CYCLE);
        }
        assert_eq!(setpoint.position, Position::new(1_000));
    }

    #[test]
    fn every_target_is_reached_from_every_velocity() {
        for millionth in [1_i64, 7, 499, 1_000, 4_001, 77_777, 1_000_000, 12_345_678] {
            for start in [-150, -3, 0, 1, 90, 166] {
                let mut setpoint = Setpoint { velocity: f64::from(start) * 1e6, ..Setpoint::default() };
                cycles_to(&mut setpoint, Position::new(millionth), LIMITS);
                assert_eq!(setpoint.position, Position::new(millionth));
            }
        }
    }
}
