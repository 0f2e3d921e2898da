//! The basic function blocks of IEC 61131-3 for PLC programs. Each is plain data in the state of a program. The time comes from
//! [`PlcIo::time`](super::PlcIo).

use serde::{Deserialize, Serialize};

use crate::units::Time;

/// R_TRIG: true for one scan when its input rises. An input that is on in the first scan counts as a rising edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RisingEdge {
    last: bool,
}

impl RisingEdge {
    /// Evaluates the input; call it once per scan.
    pub fn scan(&mut self, input: bool) -> bool {
        let rose = input && !self.last;
        self.last = input;
        rose
    }
}

/// F_TRIG: true for one scan when its input falls. An input that is off in the first scan does not count as a falling edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FallingEdge {
    last: bool,
}

impl FallingEdge {
    /// Evaluates the input; call it once per scan.
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
    /// Evaluates the input at the time of this scan; call it once per scan.
    pub fn scan(&mut self, input: bool, delay: Time, now: Time) -> bool {
        if !input {
            self.since = None;
            return false;
        }
        now - *self.since.get_or_insert(now) >= delay
    }

    /// ET: the time for which the input has been on, at most the delay.
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
    /// Evaluates the input at the time of this scan; call it once per scan.
    pub fn scan(&mut self, input: bool, delay: Time, now: Time) -> bool {
        if input {
            self.since = None;
            self.on = true;
        } else if self.on {
            self.on = now - *self.since.get_or_insert(now) < delay;
        }
        self.on
    }

    /// ET: the time for which the input has been off while the output was still on, at most the delay.
    #[must_use]
    pub fn elapsed(&self, delay: Time, now: Time) -> Time {
        self.since.map_or(Time::ZERO, |since| (now - since).min(delay))
    }
}

/// SR: a latch; if both inputs are on, it is set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SetDominantLatch {
    on: bool,
}

impl SetDominantLatch {
    /// Evaluates the inputs; call it once per scan.
    pub fn scan(&mut self, set: bool, reset: bool) -> bool {
        self.on = set || self.on && !reset;
        self.on
    }
}

/// RS: a latch; if both inputs are on, it is reset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ResetDominantLatch {
    on: bool,
}

impl ResetDominantLatch {
    /// Evaluates the inputs; call it once per scan.
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
    fn an_edge_lasts_one_scan() {
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
    fn an_on_delay_waits_its_full_time_and_resets_at_once() {
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
    fn an_off_delay_switches_on_at_once_and_off_after_its_full_time() {
        let mut delay = OffDelay::default();
        assert!(!delay.scan(false, DELAY, at(0)));
        assert!(delay.scan(true, DELAY, at(10)));
        assert!(delay.scan(false, DELAY, at(20)));
        assert!(delay.scan(false, DELAY, at(49)));
        assert!(!delay.scan(false, DELAY, at(50)));
        assert_eq!(delay.elapsed(DELAY, at(60)), DELAY);
    }

    #[test]
    fn an_off_delay_restarts_when_its_input_returns() {
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
