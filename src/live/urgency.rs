//! The stepping thread has priority over other threads if the system allows it: a round-robin thread of the lowest real-time priority.
//! Linux allows this to the administrator and to users with a limit set in `ulimit -r`. Without it the thread is scheduled like any other,
//! and another thread that computes without a pause can delay a cycle by a time slice of about 3 ms.
//!
//! The stepping thread needs some microseconds of each cycle. If it needed all the time, it must not have priority: not above real time,
//! and not when cycles take longer than their duration.

use super::speed::Speed;

/// After this many cycles without a pause the thread gives up its priority.
const WITHOUT_PAUSE: u32 = 50;

/// Whether this thread has priority.
#[derive(Debug)]
pub(super) struct Urgency {
    is_urgent: bool,
    /// Cycles without a pause.
    without_pause: u32,
}

impl Urgency {
    /// Gives this thread priority if that is allowed.
    pub(super) fn new(speed: Speed) -> Self {
        Self { is_urgent: speed <= Speed::default() && system::raise_priority(), without_pause: 0 }
    }

    /// A cycle has ended, with or without a pause before the next one.
    pub(super) fn note(&mut self, has_paused: bool) {
        self.without_pause = if has_paused { 0 } else { self.without_pause + u32::from(self.is_urgent) };
        if self.without_pause > WITHOUT_PAUSE {
            *self = Self { is_urgent: false, without_pause: 0 };
            system::reset_priority();
            tracing::warn!(
                "{WITHOUT_PAUSE} consecutive cycles took longer than the cycle time: this computer is busy, or a PLC process in lock-step is \
                 slow. The machine now runs without priority; close other programs, or choose a smaller --speed"
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

    pub(super) fn raise_priority() -> bool {
        set(ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::RoundRobin), 1)
    }

    pub(super) fn reset_priority() {
        // 48 of 99 is a nice value of 0.
        set(ThreadSchedulePolicy::Normal(NormalThreadSchedulePolicy::Other), 48);
    }
}

#[cfg(not(unix))]
mod system {
    pub(super) fn raise_priority() -> bool {
        false
    }

    pub(super) fn reset_priority() {}
}
