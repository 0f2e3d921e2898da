//! S5 timers and counters: plain data, and what the operations do with them.
//!
//! A timer is over when start + n × base is reached; the value that is read is the rest, rounded up to whole bases. Time stands still
//! during a scan, so every read in a scan agrees.

use serde::{Deserialize, Serialize};

use crate::plc::step7::instruction::TimerKind;

use super::arithmetic::digits;
use super::fault::Fault;

/// The operation that started a timer last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum Course {
    Pulse,
    ExtendedPulse,
    OnDelay,
    StoredOnDelay,
    OffDelay,
}

/// A timer.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::plc::step7) struct Timer {
    course: Option<Course>,
    /// The time at which it is over, in ns, while it runs.
    end: Option<i64>,
    /// The whole bases that were left when it was stopped.
    left: u16,
    /// The base of the last start: 0 (10 ms) to 3 (10 s).
    base: u8,
    /// Whether its end counts: it was started and not stopped since.
    armed: bool,
    /// The edge memory of the start; it is also the input of an off delay.
    input: bool,
    /// The edge memory of FR.
    freed: bool,
}

/// Three BCD digits.
pub(in crate::plc::step7) const fn bcd(value: u16) -> u16 {
    (value / 100 % 10) << 8 | (value / 10 % 10) << 4 | (value % 10)
}

const fn base_nanos(base: u8) -> i64 {
    match base {
        0 => 10_000_000,
        1 => 100_000_000,
        2 => 1_000_000_000,
        _ => 10_000_000_000,
    }
}

impl Timer {
    fn is_running(&self, now: i64) -> bool {
        self.end.is_some_and(|end| now < end)
    }

    /// Its status bit.
    pub(in crate::plc::step7) fn status(&self, now: i64) -> bool {
        match self.course {
            None => false,
            Some(Course::Pulse | Course::ExtendedPulse) => self.is_running(now),
            Some(Course::OnDelay | Course::StoredOnDelay) => self.armed && !self.is_running(now),
            Some(Course::OffDelay) => self.armed && (self.input || self.is_running(now)),
        }
    }

    /// The rest in whole bases, rounded up.
    pub(in crate::plc::step7) fn value(&self, now: i64) -> u16 {
        match self.end {
            Some(end) if now < end => {
                let base = base_nanos(self.base);
                u16::try_from((end - now + base - 1) / base).unwrap_or(999).min(999)
            }
            Some(_) => 0,
            None => self.left,
        }
    }

    /// The base for the BCD form.
    pub(in crate::plc::step7) fn base(&self) -> u8 {
        self.base
    }

    /// Whether readers see another course: it runs or not, ends at another time, or has another status.
    pub(in crate::plc::step7) fn differs_from(&self, other: &Self, now: i64) -> bool {
        self.end.filter(|end| now < *end) != other.end.filter(|end| now < *end) || self.status(now) != other.status(now)
    }

    fn stop(&mut self, now: i64) {
        self.left = self.value(now);
        self.end = None;
        self.armed = false;
    }

    fn begin(&mut self, accu1: u32, now: i64) -> Result<(), Fault> {
        let bases = digits(accu1 & 0xFFF)?;
        self.base = u8::try_from(accu1 >> 12 & 3).unwrap_or(0);
        self.end = Some(now.saturating_add(i64::from(bases) * base_nanos(self.base)));
        self.left = 0;
        self.armed = true;
        Ok(())
    }

    /// One of the five start operations, with the RLO and ACCU1.
    pub(in crate::plc::step7) fn start(
        &mut self,
        kind: TimerKind,
        rlo: bool,
        accu1: u32,
        now: i64,
    ) -> Result<(), Fault> {
        let rises = rlo && !self.input;
        let falls = !rlo && self.input;
        self.input = rlo;
        match kind {
            TimerKind::Pulse | TimerKind::OnDelay => {
                if rises {
                    self.course = Some(if kind == TimerKind::Pulse { Course::Pulse } else { Course::OnDelay });
                    self.begin(accu1, now)?;
                } else if !rlo {
                    self.stop(now);
                }
            }
            TimerKind::ExtendedPulse | TimerKind::StoredOnDelay => {
                if rises {
                    let is_pulse = kind == TimerKind::ExtendedPulse;
                    self.course = Some(if is_pulse { Course::ExtendedPulse } else { Course::StoredOnDelay });
                    self.begin(accu1, now)?;
                }
            }
            TimerKind::OffDelay => {
                if falls {
                    self.course = Some(Course::OffDelay);
                    self.begin(accu1, now)?;
                } else if rises {
                    self.course = Some(Course::OffDelay);
                    self.stop(now);
                    self.armed = true;
                }
            }
        }
        Ok(())
    }

    /// R: the edge memory of the start stays.
    pub(in crate::plc::step7) fn reset(&mut self) {
        self.end = None;
        self.left = 0;
        self.armed = false;
    }

    /// FR with the RLO.
    pub(in crate::plc::step7) fn free(&mut self, rlo: bool) {
        if rlo && !self.freed {
            self.input = false;
        }
        self.freed = rlo;
    }
}

/// A counter.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::plc::step7) struct Counter {
    pub(in crate::plc::step7) value: u16,
    up: bool,
    down: bool,
    set: bool,
    freed: bool,
}

impl Counter {
    pub(in crate::plc::step7) fn count_up(&mut self, rlo: bool) {
        if rlo && !self.up && self.value < 999 {
            self.value += 1;
        }
        self.up = rlo;
    }

    pub(in crate::plc::step7) fn count_down(&mut self, rlo: bool) {
        if rlo && !self.down && self.value > 0 {
            self.value -= 1;
        }
        self.down = rlo;
    }

    pub(in crate::plc::step7) fn set(&mut self, rlo: bool, accu1: u32) -> Result<(), Fault> {
        let rises = rlo && !self.set;
        self.set = rlo;
        if rises {
            self.value = u16::try_from(digits(accu1 & 0xFFF)?).unwrap_or(999);
        }
        Ok(())
    }

    pub(in crate::plc::step7) fn free(&mut self, rlo: bool) {
        if rlo && !self.freed {
            (self.up, self.down, self.set) = (false, false, false);
        }
        self.freed = rlo;
    }
}
