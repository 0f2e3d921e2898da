//! The times of the cycles of a trace. All cycles have the same length until power on changes it (MD10050, MD10070).

use crate::units::Time;

/// The times of cycles; both count from the start of the trace.
#[derive(Clone, Debug)]
pub(super) struct Calendar {
    /// In order; the first one begins at zero.
    spans: Vec<Span>,
    /// The last cycle with its time.
    last: (u64, Time),
}

/// Cycles of one length.
#[derive(Clone, Copy, Debug)]
struct Span {
    /// The cycle at whose end it begins, and the time there.
    cycle: u64,
    time: Time,
    /// The length of each cycle after that.
    length: Time,
}

impl Calendar {
    /// All cycles have this length.
    pub(super) fn new(length: Time) -> Self {
        Self { spans: vec![Span { cycle: 0, time: Time::ZERO, length }], last: (0, Time::ZERO) }
    }

    /// Records the time at the end of a cycle. Call it for each cycle.
    pub(super) fn note(&mut self, cycle: u64, time: Time) {
        if self.time(cycle) != time {
            let (before, at) = self.last;
            self.spans.push(Span { cycle: before, time: at, length: time - at });
        }
        self.last = (cycle, time);
    }

    /// The time at the end of a cycle.
    pub(super) fn time(&self, cycle: u64) -> Time {
        let after = self.spans.partition_point(|span| span.cycle <= cycle);
        let Span { cycle: first, time, length } = self.spans[after.saturating_sub(1)];
        time + length.times(cycle - first)
    }

    /// The cycle that ends at a time.
    pub(super) fn cycle(&self, time: Time) -> u64 {
        let after = self.spans.partition_point(|span| span.time <= time);
        let Span { cycle, time: first, length } = self.spans[after.saturating_sub(1)];
        cycle + (time - first).nanos().unsigned_abs() / length.nanos().max(1).unsigned_abs()
    }

    /// The first cycle that ends at a time or after it.
    pub(super) fn cycle_from(&self, time: Time) -> u64 {
        let cycle = self.cycle(time);
        if self.time(cycle) < time { cycle + 1 } else { cycle }
    }

    /// The length of the first cycles.
    pub(super) fn first_length(&self) -> Time {
        self.spans[0].length
    }

    /// The longest time of which all cycles are multiples, in nanoseconds.
    pub(super) fn tick(&self) -> u64 {
        self.spans.iter().fold(0, |common, span| greatest_common_divisor(common, span.length.nanos().unsigned_abs()))
    }
}

fn greatest_common_divisor(one: u64, other: u64) -> u64 {
    if other == 0 { one } else { greatest_common_divisor(other, one % other) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cycles of 2 ms up to 6 ms, then of 60 ms.
    #[test]
    fn the_time_of_a_cycle_counts_the_cycles_before_it_with_their_own_lengths() {
        let mut calendar = Calendar::new(Time::from_millis(2));
        let noted = [(1, 2), (2, 4), (3, 6), (4, 66), (5, 126)];
        for (cycle, millis) in noted {
            calendar.note(cycle, Time::from_millis(millis));
        }
        for (cycle, millis) in noted.into_iter().chain([(0, 0), (6, 186)]) {
            assert_eq!(calendar.time(cycle), Time::from_millis(millis));
            assert_eq!(calendar.cycle(Time::from_millis(millis)), cycle);
            assert_eq!(calendar.cycle_from(Time::from_millis(millis)), cycle);
            assert_eq!(calendar.cycle_from(Time::from_millis(millis + 1)), cycle + 1);
        }
        assert_eq!(calendar.tick(), 2_000_000);
    }
}
