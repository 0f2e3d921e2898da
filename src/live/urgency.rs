//! The stepping thread goes before others where the system allows it: a round-robin thread of the lowest real-time priority. Linux
//! allows that to the administrator and to whom `ulimit -r` says so; everybody else steps as all programs run, where a thread that
//! computes without a pause can hold up a cycle for a time slice of some 3 ms.
//!
//! It needs some microseconds of each cycle. Where it needs all the time it must not go before anybody: not at more than real time,
//! and not when cycles take longer than they last.

use super::speed::Speed;

/// After so many cycles without a pause others are as urgent again.
const BREATHLESS: u32 = 50;

/// Whether this thread goes before others.
#[derive(Debug)]
pub(super) struct Urgency {
    is_urgent: bool,
    /// Cycles without a pause.
    breathless: u32,
}

impl Urgency {
    /// Makes this thread urgent, if that may be.
    pub(super) fn new(speed: Speed) -> Self {
        Self { is_urgent: speed <= Speed::default() && system::hurry(), breathless: 0 }
    }

    /// A cycle is over, and there was a pause before the next or not.
    pub(super) fn note(&mut self, has_paused: bool) {
        self.breathless = if has_paused { 0 } else { self.breathless + u32::from(self.is_urgent) };
        if self.breathless > BREATHLESS {
            *self = Self { is_urgent: false, breathless: 0 };
            system::calm_down();
            tracing::warn!(
                "{BREATHLESS} cycles one after another took longer than they last: other programs keep this computer busy, or a PLC process \
                 in lock-step is slow. The machine goes before other programs no more; close some, or take a smaller --speed"
            );
        }
    }
}

#[cfg(unix)]
mod system {
    use thread_priority::unix::{
        NormalThreadSchedulePolicy, RealtimeThreadSchedulePolicy, ThreadSchedulePolicy, set_thread_priority_and_policy,
        thread_native_id,
    };
    use thread_priority::{ThreadPriority, ThreadPriorityValue};

    fn set(policy: ThreadSchedulePolicy, priority: u8) -> bool {
        let Ok(priority) = ThreadPriorityValue::try_from(priority) else {
            return false;
        };
        set_thread_priority_and_policy(thread_native_id(), ThreadPriority::Crossplatform(priority), policy).is_ok()
    }

    pub(super) fn hurry() -> bool {
        set(ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::RoundRobin), 1)
    }

    pub(super) fn calm_down() {
        // 48 of 99 is a nice value of 0.
        set(ThreadSchedulePolicy::Normal(NormalThreadSchedulePolicy::Other), 48);
    }
}

#[cfg(not(unix))]
mod system {
    pub(super) fn hurry() -> bool {
        false
    }

    pub(super) fn calm_down() {}
}
