//! The small blocks that programs are made of, with the meaning of IEC 61131-3. Each is plain data that belongs to
//! the program's state; the time comes from [`PlcIo::time`](super::PlcIo).

use serde::{Deserialize, Serialize};

use crate::units::Time;

/// R_TRIG: true for one scan when its input rises. A first scan with the input on counts as rising.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RisingEdge {
    last: bool,
}

impl RisingEdge {
    /// Looks at the input once in this scan.
    pub fn scan(&mut self, input: bool) -> bool {
        let rose = input && !self.last;
        self.last = input;
        rose
    }
}

/// F_TRIG: true for one scan when its input falls. A first scan with the input off does not count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FallingEdge {
    last: bool,
}

impl FallingEdge {
    /// Looks at the input once in this scan.
    pub fn scan(&mut self, input: bool) -> bool {
        let fell = !input && self.last;
        self.last = input;
        fell
    }
}

/// TON: its output rises when the input has been on for the delay, and falls with the input.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct OnDelay {
    since: Option<Time>,
}

impl OnDelay {
    /// Looks at the input once in this scan, at this time.
    pub fn scan(&mut self, input: bool, delay: Time, now: Time) -> bool {
        if !input {
            self.since = None;
            return false;
        }
        now - *self.since.get_or_insert(now) >= delay
    }

    /// ET: how long the input has been on, at most the delay.
    #[must_use]
    pub fn elapsed(&self, delay: Time, now: Time) -> Time {
        self.since.map_or(Time::ZERO, |since| (now - since).min(delay))
    }
}

/// TOF: its output rises with the input, and falls when the input has been off for the delay.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct OffDelay {
    on: bool,
    since: Option<Time>,
}

impl OffDelay {
    /// Looks at the input once in this scan, at this time.
    pub fn scan(&mut self, input: bool, delay: Time, now: Time) -> bool {
        if input {
            self.since = None;
            self.on = true;
        } else if self.on {
            self.on = now - *self.since.get_or_insert(now) < delay;
        }
        self.on
    }

    /// ET: how long the input has been off while the output was still on, at most the delay.
    #[must_use]
    pub fn elapsed(&self, delay: Time, now: Time) -> Time {
        self.since.map_or(Time::ZERO, |since| (now - since).min(delay))
    }
}

/// SR: remembers; with both inputs on it is set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SetDominantLatch {
    on: bool,
}

impl SetDominantLatch {
    /// Looks at the inputs once in this scan.
    pub fn scan(&mut self, set: bool, reset: bool) -> bool {
        self.on = set || self.on && !reset;
        self.on
    }
}

/// RS: remembers; with both inputs on it is reset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ResetDominantLatch {
    on: bool,
}

impl ResetDominantLatch {
    /// Looks at the inputs once in this scan.
    pub fn scan(&mut self, set: bool, reset: bool) -> bool {
        self.on = !reset && (set || self.on);
        self.on
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DELAY: Time = Time::from_millis(30);

    fn at(millis: i64) -> Time {
        Time::from_millis(millis)
    }

    #[test]
    fn an_edge_is_seen_in_one_scan_only() {
        let (mut rising, mut falling) = (RisingEdge::default(), FallingEdge::default());
        let input = [false, true, true, false, false, true];
        assert_eq!(input.map(|on| rising.scan(on)), [false, true, false, false, false, true]);
        assert_eq!(input.map(|on| falling.scan(on)), [false, false, false, true, false, false]);
    }

    #[test]
    fn a_first_scan_counts_as_an_edge_only_upwards() {
        assert!(RisingEdge::default().scan(true));
        assert!(!FallingEdge::default().scan(false));
    }

    #[test]
    fn an_on_delay_waits_its_whole_time_and_forgets_at_once() {
        let mut delay = OnDelay::default();
        assert!(!delay.scan(true, DELAY, at(0)));
        assert!(!delay.scan(true, DELAY, at(29)));
        assert_eq!(delay.elapsed(DELAY, at(29)), at(29));
        assert!(delay.scan(true, DELAY, at(30)));
        assert_eq!(delay.elapsed(DELAY, at(99)), DELAY);
        assert!(!delay.scan(false, DELAY, at(31)));
        assert_eq!(delay.elapsed(DELAY, at(31)), Time::ZERO);
        assert!(!delay.scan(true, DELAY, at(32)));
        assert!(!delay.scan(true, DELAY, at(61)));
        assert!(delay.scan(true, DELAY, at(62)));
    }

    #[test]
    fn an_on_delay_of_no_time_follows_its_input() {
        let mut delay = OnDelay::default();
        assert!(delay.scan(true, Time::ZERO, at(5)));
        assert!(!delay.scan(false, Time::ZERO, at(6)));
    }

    #[test]
    fn an_off_delay_comes_at_once_and_leaves_after_its_whole_time() {
        let mut delay = OffDelay::default();
        assert!(!delay.scan(false, DELAY, at(0)));
        assert!(delay.scan(true, DELAY, at(10)));
        assert!(delay.scan(false, DELAY, at(20)));
        assert!(delay.scan(false, DELAY, at(49)));
        assert!(!delay.scan(false, DELAY, at(50)));
        assert_eq!(delay.elapsed(DELAY, at(60)), DELAY);
    }

    #[test]
    fn an_off_delay_starts_anew_when_its_input_returns() {
        let mut delay = OffDelay::default();
        delay.scan(true, DELAY, at(0));
        assert!(delay.scan(false, DELAY, at(10)));
        assert!(delay.scan(true, DELAY, at(39)));
        assert!(delay.scan(false, DELAY, at(41)));
        assert!(delay.scan(false, DELAY, at(70)));
        assert!(!delay.scan(false, DELAY, at(71)));
    }

    #[test]
    fn a_latch_remembers_and_its_dominant_input_wins() {
        let (mut set, mut reset) = (SetDominantLatch::default(), ResetDominantLatch::default());
        let steps = [(false, false), (true, false), (false, false), (true, true), (false, true), (true, true)];
        assert_eq!(steps.map(|(s, r)| set.scan(s, r)), [false, true, true, true, false, true]);
        assert_eq!(steps.map(|(s, r)| reset.scan(s, r)), [false, true, true, false, false, false]);
    }
}
