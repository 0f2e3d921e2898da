//! Variables of the main run: `$AC_TIMER[n]` and `$AC_MARKER[n]`.

use serde::{Deserialize, Serialize};

/// The number of timers, and of markers.
pub(in crate::sinumerik) const MAIN_RUN_VARIABLES: u8 = 64;

/// A timer: its value at a time, and whether it runs since.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Timer {
    index: u8,
    value: f64,
    since: Option<f64>,
}

/// The variables of a channel; those that were never written are 0.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct MainRun {
    timers: Vec<Timer>,
    markers: Vec<(u8, i32)>,
}

impl MainRun {
    /// A timer in seconds; `now` is the time since power on.
    pub(super) fn timer(&self, index: u8, now: f64) -> f64 {
        let found = self.timers.iter().find(|timer| timer.index == index);
        found.map_or(0.0, |timer| timer.value + timer.since.map_or(0.0, |since| now - since))
    }

    /// A value of 0 or more starts a timer with it, a negative one stops it.
    pub(super) fn set_timer(&mut self, index: u8, value: f64, now: f64) {
        let timer = if value < 0.0 {
            Timer { index, value: self.timer(index, now), since: None }
        } else {
            Timer { index, value, since: Some(now) }
        };
        self.timers.retain(|other| other.index != index);
        self.timers.push(timer);
    }

    /// A marker.
    pub(super) fn marker(&self, index: u8) -> i32 {
        self.markers.iter().find(|(other, _)| *other == index).map_or(0, |(_, value)| *value)
    }

    pub(super) fn set_marker(&mut self, index: u8, value: i32) {
        self.markers.retain(|(other, _)| *other != index);
        self.markers.push((index, value));
    }

    /// RESET.
    pub(super) fn clear_markers(&mut self) {
        self.markers.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[expect(clippy::float_cmp, reason = "differences of whole seconds are exact")]
    fn a_timer_counts_from_its_value_until_it_is_stopped() {
        let mut run = MainRun::default();
        assert_eq!(run.timer(3, 10.0), 0.0);
        run.set_timer(3, 2.0, 10.0);
        assert_eq!(run.timer(3, 15.0), 7.0);
        run.set_timer(3, -1.0, 15.0);
        assert_eq!(run.timer(3, 20.0), 7.0);
        run.set_timer(3, 0.0, 30.0);
        assert_eq!(run.timer(3, 31.0), 1.0);
    }
}
