//! Jerk limitation: a moving average, over the jerk time, of a setpoint that is limited in acceleration.
//!
//! Axes with a filter use it instead of the plain setpoint, once per interpolation cycle. The average is taken over whole positions, so it
//! reaches the target exactly when the window holds only the target. The velocity is the distance across the window divided by the window's
//! time. A step of acceleration becomes a ramp over the jerk time, and a movement takes the jerk time longer.
//!
//! Two windows are in series: the jerk limit of single-axis movements, and the filter that applies to every movement. A fast stop bypasses
//! both: it brakes from the present position and velocity, and the windows are active again after the next standstill. The same applies to
//! an axis that was moved by another source (follow-up, or its leading axis) and to an axis whose windows changed during motion. Only
//! [`JerkFilter::new`] allocates.

use serde::{Deserialize, Serialize};

use super::Setpoint;
use crate::units::Position;

/// The longest window, in cycles. The sum of this many positions fits into the number type.
pub const LONGEST_WINDOW: usize = 1_000;

/// The mean of the last positions.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Window {
    /// The last positions, a ring buffer, relative to `base`.
    ring: Vec<i64>,
    /// Number of positions in use.
    length: usize,
    next: usize,
    sum: i64,
    base: Position,
    /// The newest position, and how many of the newest positions are equal to it.
    last: i64,
    equal: usize,
}

impl Window {
    fn new(longest: usize) -> Self {
        let longest = longest.clamp(1, LONGEST_WINDOW);
        Self { ring: vec![0; longest], length: longest, equal: longest + 1, ..Self::default() }
    }

    /// Fills the window with one position.
    fn fill(&mut self, position: Position, length: usize) {
        self.length = length.clamp(1, self.ring.len());
        self.ring.fill(0);
        (self.next, self.sum, self.base, self.last, self.equal) = (0, 0, position, 0, self.length + 1);
    }

    /// Adds a position. Returns the mean, and the distance between the newest position and the one that is dropped.
    fn pass(&mut self, position: Position) -> (Position, i64) {
        let newest = (position - self.base).increments();
        let way = newest - std::mem::replace(&mut self.ring[self.next], newest);
        self.next = (self.next + 1) % self.length;
        self.sum += way;
        self.equal = if newest == self.last { (self.equal + 1).min(self.length + 1) } else { 1 };
        self.last = newest;
        let length = i64::try_from(self.length).unwrap_or(1);
        let mean = (self.sum + length / 2).div_euclid(length);
        (self.base + Position::new(mean), way)
    }

    /// The mean did not move in the last cycle and will not move.
    fn is_settled(&self) -> bool {
        self.equal > self.length
    }
}

/// The jerk filter of an axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JerkFilter {
    /// Limited in acceleration only.
    unfiltered: Setpoint,
    windows: [Window; 2],
    /// The setpoint after the last step. If the present one differs, another source moved it.
    left: Setpoint,
    active: bool,
}

impl JerkFilter {
    /// A filter with memory for windows of this many cycles; 1 means no window.
    #[must_use]
    pub fn new(longest: [usize; 2]) -> Self {
        Self { windows: longest.map(Window::new), ..Self::default() }
    }

    /// Whether the memory has exactly these sizes.
    #[must_use]
    pub fn has_windows_of(&self, longest: [usize; 2]) -> bool {
        longest.map(|cycles| cycles.clamp(1, LONGEST_WINDOW))
            == [self.windows[0].ring.len(), self.windows[1].ring.len()]
    }

    /// Shifts the coordinate of the present position without a movement.
    pub fn shift(&mut self, by: Position) {
        self.unfiltered.shift(by);
        self.left.shift(by);
        for window in &mut self.windows {
            window.base += by;
        }
    }

    /// One cycle. `command` moves the setpoint that is limited in acceleration and returns whether it has arrived.
    ///
    /// `first` is the length of the first window for a movement that begins now. `fast` marks a stop that bypasses the filter. Returns true
    /// when the setpoint itself has arrived.
    pub fn step(
        &mut self,
        setpoint: &mut Setpoint,
        first: Option<usize>,
        fast: bool,
        cycle: f64,
        command: impl FnOnce(&mut Setpoint) -> bool,
    ) -> bool {
        self.active &= !fast && *setpoint == self.left;
        let begins = first.is_some_and(|length| length.clamp(1, self.windows[0].ring.len()) != self.windows[0].length);
        if !fast && setpoint.is_at_rest() && (!self.active || begins && self.is_settled()) {
            self.begin(setpoint.position, first);
        }
        let arrived = if self.active {
            let before = self.unfiltered;
            let settled = self.is_settled();
            let arrived = command(&mut self.unfiltered);
            // At rest before and after: nothing changes.
            if !settled || self.unfiltered != before {
                self.filter(setpoint, cycle);
            }
            arrived && self.is_settled()
        } else {
            command(setpoint)
        };
        self.left = *setpoint;
        arrived
    }

    /// Whether the filter still delays part of the movement.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.active && !self.is_settled()
    }

    fn begin(&mut self, position: Position, first: Option<usize>) {
        self.active = true;
        self.unfiltered = Setpoint::at(position);
        let lengths = [first.unwrap_or(self.windows[0].length), self.windows[1].ring.len()];
        for (window, length) in self.windows.iter_mut().zip(lengths) {
            window.fill(position, length);
        }
    }

    fn is_settled(&self) -> bool {
        self.unfiltered.is_at_rest() && self.windows.iter().all(Window::is_settled)
    }

    fn filter(&mut self, setpoint: &mut Setpoint, cycle: f64) {
        let (mut position, mut velocity) = (self.unfiltered.position, self.unfiltered.velocity());
        for window in &mut self.windows {
            let (mean, way) = window.pass(position);
            if window.length > 1 {
                (position, velocity) = (mean, way as f64 / (window.length as f64 * cycle));
            }
        }
        let settled = self.is_settled();
        setpoint.show(position, if settled { 0.0 } else { velocity }, !settled);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Limits;

    const CYCLE: f64 = 0.002;
    /// 10 m/min and 1 m/s² in nanometres.
    const LIMITS: Limits = Limits { velocity: 10e9 / 60.0, acceleration: 1e9 };

    fn mm(value: f64) -> Position {
        Position::from_user(value)
    }

    /// Number of cycles to a target, and the largest changes of velocity and of acceleration on the way.
    fn go(filter: &mut JerkFilter, setpoint: &mut Setpoint, target: Position) -> (u32, f64, f64) {
        let (mut acceleration, mut most) = (0.0, (0.0_f64, 0.0_f64));
        for count in 1..100_000 {
            let before = *setpoint;
            let arrived = filter.step(setpoint, None, false, CYCLE, |raw| raw.go_to(target, LIMITS, CYCLE));
            let now = (setpoint.velocity() - before.velocity()) / CYCLE;
            most = (most.0.max(now.abs()), most.1.max((now - acceleration).abs() / CYCLE));
            acceleration = now;
            if arrived {
                return (count, most.0, most.1);
            }
        }
        panic!("never arrived");
    }

    /// s/v + v/a + jerk time: 100 mm at 166.67 mm/s and 1 m/s² take 0.6 s + 0.1667 s; a window of 50 cycles is 0.1 s.
    #[test]
    fn a_movement_takes_the_jerk_time_longer_and_its_jerk_is_acceleration_over_jerk_time() {
        let mut plain = Setpoint::default();
        let unfiltered = (1..1_000).find(|_| plain.go_to(mm(100.0), LIMITS, CYCLE)).unwrap();
        for length in [2_usize, 5, 50, 200] {
            let (mut filter, mut setpoint) = (JerkFilter::new([length, 1]), Setpoint::default());
            let (cycles, acceleration, jerk) = go(&mut filter, &mut setpoint, mm(100.0));
            // After the last movement the window empties that many cycles later, less one.
            assert_eq!(cycles, unfiltered + u32::try_from(length).unwrap() - 1);
            assert_eq!(setpoint, Setpoint::at(mm(100.0)));
            // Velocities are distances in whole increments: rounding adds up to one increment per cycle.
            let rounding = 1.01 / CYCLE / CYCLE;
            assert!(acceleration <= LIMITS.acceleration + rounding, "{length}: {acceleration}");
            let limit = LIMITS.acceleration / (length as f64 * CYCLE);
            assert!(jerk <= limit + 2.0 * rounding / CYCLE, "{length}: {jerk} instead of {limit}");
            assert!(jerk >= 0.99 * limit, "{length}: {jerk} instead of {limit}");
        }
    }

    #[test]
    fn two_windows_add_their_times_and_end_on_the_target() {
        let mut plain = Setpoint::default();
        let unfiltered = (1..1_000).find(|_| plain.go_to(mm(-7.000_001), LIMITS, CYCLE)).unwrap();
        let (mut filter, mut setpoint) = (JerkFilter::new([7, 20]), Setpoint::default());
        assert_eq!(go(&mut filter, &mut setpoint, mm(-7.000_001)).0, unfiltered + 6 + 19);
        assert_eq!(setpoint, Setpoint::at(mm(-7.000_001)));
    }

    /// After release at velocity v, the stopping distance is v²/2a of braking plus v · (length − 1)/2 cycles delayed by the window.
    #[test]
    fn the_stopping_distance_is_that_of_braking_and_of_half_the_window() {
        for (velocity, length) in [(33.333_333e6, 50_u32), (100e6, 20), (100e6, 1), (166.666e6, 100)] {
            let (mut filter, mut setpoint) = (JerkFilter::new([length as usize, 1]), Setpoint::default());
            for _ in 0..500 {
                filter.step(&mut setpoint, None, false, CYCLE, |raw| {
                    raw.run(velocity, 1e9, CYCLE);
                    false
                });
            }
            let released = setpoint.position;
            for _ in 0..500 {
                filter.step(&mut setpoint, None, false, CYCLE, |raw| {
                    raw.run(0.0, 1e9, CYCLE);
                    false
                });
            }
            assert!(setpoint.is_at_rest());
            let way = (setpoint.position - released).increments() as f64;
            let expected = velocity * velocity / 2e9 + velocity * f64::from(length - 1) * CYCLE / 2.0;
            // Braking begins within the cycle: the distance is up to one cycle shorter.
            assert!(way <= expected && way > expected - velocity * CYCLE, "{velocity} {length}: {way}, not {expected}");
        }
    }

    /// A fast stop from 100 mm/s at 4 m/s² takes 25 ms, 12.5 cycles, although the window is 200 ms long.
    #[test]
    fn a_fast_stop_passes_the_filter_by_and_the_next_movement_does_not() {
        let (mut filter, mut setpoint) = (JerkFilter::new([100, 1]), Setpoint::default());
        for _ in 0..300 {
            filter.step(&mut setpoint, None, false, CYCLE, |raw| {
                raw.run(100e6, 1e9, CYCLE);
                false
            });
        }
        let mut cycles = 0;
        while !setpoint.is_at_rest() {
            filter.step(&mut setpoint, None, true, CYCLE, |raw| {
                raw.run(0.0, 4e9, CYCLE);
                false
            });
            cycles += 1;
        }
        assert_eq!(cycles, 13);
        let here = setpoint.position;
        filter.step(&mut setpoint, None, false, CYCLE, |raw| {
            raw.run(100e6, 1e9, CYCLE);
            false
        });
        // The first step of 1 m/s² is 4 µm; the window outputs one hundredth of it.
        assert_eq!(setpoint.position - here, Position::new(40));
    }

    #[test]
    fn a_reference_in_the_middle_of_a_movement_changes_nothing_but_the_value() {
        let (mut filter, mut setpoint) = (JerkFilter::new([20, 5]), Setpoint::default());
        let (mut other, mut moved) = (filter.clone(), setpoint);
        for cycle in 0..200 {
            if cycle == 60 {
                other.shift(mm(1_000.0));
                moved.shift(mm(1_000.0));
            }
            let shifted = mm(if cycle < 60 { 0.0 } else { 1_000.0 });
            filter.step(&mut setpoint, None, false, CYCLE, |raw| raw.go_to(mm(10.0), LIMITS, CYCLE));
            other.step(&mut moved, None, false, CYCLE, |raw| raw.go_to(mm(10.0) + shifted, LIMITS, CYCLE));
            assert_eq!((moved.position - shifted, moved.velocity()), (setpoint.position, setpoint.velocity()));
        }
        assert_eq!(setpoint, Setpoint::at(mm(10.0)));
    }

    #[test]
    fn a_movement_and_its_return_within_the_window_is_not_standstill() {
        let (mut filter, mut setpoint) = (JerkFilter::new([50, 1]), Setpoint::default());
        for velocity in [1e6, -1e6, 0.0] {
            filter.step(&mut setpoint, None, false, CYCLE, |raw| {
                raw.run(velocity, 1e9, CYCLE);
                false
            });
        }
        assert!(!setpoint.is_at_rest(), "the window still delays part of the movement");
    }

    #[test]
    fn an_axis_moved_by_another_source_begins_with_an_empty_window() {
        let (mut filter, mut setpoint) = (JerkFilter::new([10, 1]), Setpoint::default());
        go(&mut filter, &mut setpoint, mm(1.0));
        setpoint = Setpoint::at(mm(50.0));
        filter.step(&mut setpoint, None, false, CYCLE, |raw| raw.go_to(mm(50.0), LIMITS, CYCLE));
        assert_eq!(setpoint, Setpoint::at(mm(50.0)));
    }

    #[test]
    fn a_window_takes_the_length_of_the_movement_that_begins() {
        let (mut filter, mut setpoint) = (JerkFilter::new([10, 1]), Setpoint::default());
        let mut cycles = |first: usize, to: f64| {
            (1..1_000)
                .find(|_| filter.step(&mut setpoint, Some(first), false, CYCLE, |raw| raw.go_to(mm(to), LIMITS, CYCLE)))
                .unwrap()
        };
        let long = cycles(10, 1.0);
        assert_eq!((cycles(4, 2.0), cycles(99, 3.0)), (long - 6, long));
    }
}
