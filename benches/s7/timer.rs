//! A bare timer beside the load: a thread that only wakes every 2 ms, with the same priority as the stepping thread where the system allows
//! it. Delays measured here come from the system and the computer.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

const CYCLE: Duration = Duration::from_millis(2);

/// A timer that runs until its result is requested.
pub(crate) struct Timer {
    is_over: Arc<AtomicBool>,
    thread: JoinHandle<Lateness>,
}

/// The measured delays.
#[derive(Default)]
pub(crate) struct Lateness {
    pub(crate) cycles: u32,
    /// Wake-ups after the next one was already due.
    pub(crate) late: u32,
    pub(crate) worst: Duration,
}

impl Timer {
    pub(crate) fn start() -> Self {
        let is_over = Arc::new(AtomicBool::new(false));
        let asked = Arc::clone(&is_over);
        let thread = std::thread::spawn(move || {
            hurry();
            let (begin, mut lateness) = (Instant::now(), Lateness::default());
            while !asked.load(Ordering::Relaxed) {
                lateness.cycles += 1;
                let due = begin + CYCLE * lateness.cycles;
                std::thread::sleep(due.saturating_duration_since(Instant::now()));
                let late = due.elapsed();
                lateness.late += u32::from(late > CYCLE);
                lateness.worst = lateness.worst.max(late);
            }
            lateness
        });
        Self { is_over, thread }
    }

    pub(crate) fn end(self) -> Lateness {
        self.is_over.store(true, Ordering::Relaxed);
        self.thread.join().unwrap_or_default()
    }
}

/// As the stepping thread does (`src/live/urgency.rs`); without permission it runs with normal priority.
#[cfg(unix)]
fn hurry() {
    use thread_priority::unix::{
        RealtimeThreadSchedulePolicy, ThreadSchedulePolicy, set_thread_priority_and_policy, thread_native_id,
    };
    use thread_priority::{ThreadPriority, ThreadPriorityValue};
    if let Ok(lowest) = ThreadPriorityValue::try_from(1) {
        let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::RoundRobin);
        let _ = set_thread_priority_and_policy(thread_native_id(), ThreadPriority::Crossplatform(lowest), policy);
    }
}

#[cfg(not(unix))]
fn hurry() {}
