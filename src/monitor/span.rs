//! Points of a run and the distances between them, in cycles and in time.

use crate::units::Time;

/// A point of a run: the number of cycles so far, and the time that they took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Point {
    /// Cycles since the start.
    pub cycle: u64,
    /// Time since the start.
    pub time: Time,
}

/// A limit of a rule. Each part that is not zero must be over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Span {
    /// A number of cycles.
    pub cycles: u64,
    /// A time; the cycle that completes it ends it.
    pub time: Time,
}

impl Span {
    /// No time at all: it is over in the cycle in which it begins.
    pub const NONE: Self = Self { cycles: 0, time: Time::ZERO };

    /// A number of cycles.
    #[must_use]
    pub const fn cycles(cycles: u64) -> Self {
        Self { cycles, time: Time::ZERO }
    }

    /// A time; at least one cycle must pass.
    #[must_use]
    pub const fn time(time: Time) -> Self {
        Self { cycles: 1, time }
    }

    /// Whether it is over at `now`, if it began at `began`.
    pub(super) fn is_over(self, began: Point, now: Point) -> bool {
        now.cycle - began.cycle >= self.cycles && now.time - began.time >= self.time
    }

    /// The number of further cycles of this length until it is over; 0 if it is over.
    pub(super) fn cycles_left(self, began: Point, now: Point, cycle: Time) -> u64 {
        let cycles = self.cycles.saturating_sub(now.cycle - began.cycle);
        let time = (self.time - (now.time - began.time)).nanos();
        cycles.max(whole(time, cycle, true))
    }

    /// The number of cycles of this length that passed since it was over.
    pub(super) fn cycles_beyond(self, began: Point, now: Point, cycle: Time) -> u64 {
        let cycles = (now.cycle - began.cycle).saturating_sub(self.cycles);
        let time = (now.time - began.time - self.time).nanos();
        cycles.min(whole(time, cycle, false))
    }
}

/// A time in cycles, rounded up or down; 0 for a negative time.
fn whole(nanos: i64, cycle: Time, up: bool) -> u64 {
    let (nanos, cycle) = (nanos.max(0).unsigned_abs(), cycle.nanos().max(1).unsigned_abs());
    if up { nanos.div_ceil(cycle) } else { nanos / cycle }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(cycle: u64, millis: i64) -> Point {
        Point { cycle, time: Time::from_millis(millis) }
    }

    #[test]
    fn a_time_is_over_by_the_time_of_the_machine_however_long_its_cycles_are() {
        let (began, span) = (after(5, 10), Span::time(Time::from_millis(8)));
        // Four cycles of 2 ms, or two of 4 ms.
        assert!(span.is_over(began, after(9, 18)) && !span.is_over(began, after(8, 16)));
        assert!(span.is_over(began, after(7, 18)) && !span.is_over(began, after(6, 14)));
        assert!(Span::cycles(3).is_over(began, after(8, 22)) && !Span::cycles(3).is_over(began, after(7, 999)));
        assert!(!Span::time(Time::ZERO).is_over(began, began), "at least one cycle");
        assert!(Span::NONE.is_over(began, began));
    }

    #[test]
    fn a_part_of_a_cycle_counts_as_the_cycle_that_completes_the_time() {
        let (began, cycle, span) = (after(0, 0), Time::from_millis(2), Span::time(Time::from_millis(7)));
        let left =
            |cycle_number: u64| span.cycles_left(began, after(cycle_number, 2 * cycle_number.cast_signed()), cycle);
        assert_eq!([left(0), left(1), left(3), left(4), left(9)], [4, 3, 1, 0, 0]);
        let beyond =
            |cycle_number: u64| span.cycles_beyond(began, after(cycle_number, 2 * cycle_number.cast_signed()), cycle);
        assert_eq!([beyond(3), beyond(4), beyond(5)], [0, 0, 1]);
    }
}
