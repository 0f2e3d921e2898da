//! Delays of a setpoint, PT1 and dead time. A delay is stored as the lag of the delayed setpoint.
//!
//! Called once per position-control cycle with the movement of that cycle. Because only the lag is stored, setting a
//! reference does not affect it. At a steady velocity `v` the lag of either delay is exactly `v` times its time: PT1 as
//! `a = T / (τ + T)`, a dead time between two cycles by interpolation.

use serde::{Deserialize, Serialize};

/// A PT1 delay.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pt1 {
    behind: f64,
}

impl Pt1 {
    /// Lag of the delayed setpoint, in increments.
    #[must_use]
    pub const fn behind(&self) -> f64 {
        self.behind
    }

    /// Delays the movement of one cycle. Returns the movement of the delayed setpoint.
    pub fn delay(&mut self, movement: f64, time_constant: f64, cycle: f64) -> f64 {
        let all = self.behind + movement;
        self.behind = all * (time_constant / (time_constant + cycle));
        // Far below one increment: avoids denormal numbers.
        if self.behind.abs() < 1e-4 {
            self.behind = 0.0;
        }
        all - self.behind
    }

    /// Removes the lag: the delayed setpoint equals the setpoint.
    pub fn reset(&mut self) {
        self.behind = 0.0;
    }
}

/// A dead time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DeadTime {
    /// The movements of the last cycles, a ring buffer.
    movements: Vec<f64>,
    next: usize,
    behind: f64,
}

impl DeadTime {
    /// The longest dead time, in cycles.
    const LONGEST: usize = 1_000;

    /// A dead time with memory for this many cycles.
    #[must_use]
    pub fn new(cycles: f64) -> Self {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the cast saturates at 0")]
        let cycles = cycles.ceil() as usize;
        Self { movements: vec![0.0; cycles.min(Self::LONGEST)], next: 0, behind: 0.0 }
    }

    /// Number of cycles that fit into the memory.
    #[must_use]
    pub fn cycles(&self) -> usize {
        self.movements.len()
    }

    /// Lag of the delayed setpoint, in increments.
    #[must_use]
    pub const fn behind(&self) -> f64 {
        self.behind
    }

    /// Delays the movement of one cycle by this many cycles, limited to the size of the memory.
    pub fn delay(&mut self, movement: f64, cycles: f64) {
        let length = self.movements.len();
        // Without a delay and without a movement nothing changes.
        if length == 0 || movement == 0.0 && self.behind == 0.0 {
            return;
        }
        self.movements[self.next] = movement;
        self.next = (self.next + 1) % length;
        let mut left = cycles.min(length as f64);
        self.behind = 0.0;
        for age in 1..=length {
            let movement = self.movements[(self.next + length - age) % length];
            self.behind += movement * left.clamp(0.0, 1.0);
            left -= 1.0;
        }
        if movement == 0.0 && self.behind == 0.0 {
            // A longer time later must not replay older movements.
            self.movements.fill(0.0);
        }
    }

    /// Removes the lag: the delayed setpoint equals the setpoint.
    pub fn reset(&mut self) {
        if self.behind != 0.0 {
            self.movements.fill(0.0);
            self.behind = 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At 100 increments per cycle of 2 ms, the lag of a time τ is 100 · τ / 2 ms increments.
    #[test]
    fn at_a_steady_velocity_the_lag_is_velocity_times_time() {
        for milliseconds in [0.0, 0.5, 2.0, 3.0, 5.0, 8.25] {
            let expected = 100.0 * milliseconds / 2.0;
            let (mut pt1, mut dead_time) = (Pt1::default(), DeadTime::new(milliseconds / 2.0));
            for _ in 0..200 {
                pt1.delay(100.0, milliseconds / 1_000.0, 0.002);
                dead_time.delay(100.0, milliseconds / 2.0);
            }
            assert!((pt1.behind() - expected).abs() < 1e-3, "PT1 {milliseconds} ms: {}", pt1.behind());
            assert!((dead_time.behind() - expected).abs() < 1e-9, "Tt {milliseconds} ms: {}", dead_time.behind());
        }
    }

    /// a = 2/(4+2) = 1/3: after three cycles from rest, the delayed velocity is 1 − (2/3)³ = 19/27.
    #[test]
    fn pt1_responds_like_the_speed_loop_with_the_same_time_constant() {
        let mut pt1 = Pt1::default();
        pt1.delay(27.0, 0.004, 0.002);
        pt1.delay(27.0, 0.004, 0.002);
        assert!((pt1.delay(27.0, 0.004, 0.002) - 19.0).abs() < 1e-9);
    }

    #[test]
    fn at_rest_the_lag_returns_to_zero() {
        let (mut pt1, mut dead_time) = (Pt1::default(), DeadTime::new(2.5));
        for movement in std::iter::repeat_n(100.0, 20).chain(std::iter::repeat_n(0.0, 100)) {
            pt1.delay(movement, 0.005, 0.002);
            dead_time.delay(movement, 2.5);
        }
        assert_eq!((pt1, dead_time.behind().to_bits()), (Pt1::default(), 0.0_f64.to_bits()));
    }

    /// 2.5 cycles: of three movements, the newest two count fully and the third half.
    #[test]
    fn a_dead_time_between_two_cycles_is_interpolated() {
        let mut dead_time = DeadTime::new(2.5);
        for movement in [1.0, 10.0, 100.0] {
            dead_time.delay(movement, 2.5);
        }
        assert!((dead_time.behind() - 110.5).abs() < 1e-9);
    }
}
