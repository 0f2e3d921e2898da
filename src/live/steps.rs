//! Every step, for servers that must not miss one: a copy of the machine after each step, in order. The stepping thread adds a copy to the
//! queue of each server that listens, and never waits. If a server does not take its steps for long, the oldest ones are dropped and
//! counted.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, SystemTime};

use super::seen::Seen;
use crate::units::Time;

/// The most steps that wait for a server.
const MOST: usize = 2000;
/// The largest distance of the shown instant of a step to the clock of the computer.
const BEHIND: Duration = Duration::from_millis(50);

/// The machine after a step.
#[derive(Debug)]
pub struct Step {
    /// The machine.
    pub seen: Box<Seen>,
    /// When the step ended, by the clock of the computer. In real time the instants of consecutive steps differ by exactly one cycle, as
    /// long as the machine keeps its schedule. They never go back, and are never in the future.
    pub instant: SystemTime,
}

/// The steps of a live machine, in order. There is one for each server that needs them.
#[derive(Debug)]
pub struct Steps {
    queue: Arc<Queue>,
    readers: Arc<Readers>,
}

#[derive(Debug, Default)]
struct Queue {
    is_listening: AtomicBool,
    steps: Mutex<VecDeque<Step>>,
    lost: AtomicU64,
}

impl Steps {
    /// Begins or ends to collect steps. A server that needs none costs the machine nothing.
    pub fn listen(&self, is_listening: bool) {
        if self.queue.is_listening.swap(is_listening, Ordering::AcqRel) == is_listening {
            return;
        }
        if is_listening {
            self.readers.listening.fetch_add(1, Ordering::AcqRel);
        } else {
            self.readers.listening.fetch_sub(1, Ordering::AcqRel);
            lock(&self.queue.steps).clear();
        }
    }

    /// The steps since the last call.
    #[must_use]
    pub fn take(&self) -> VecDeque<Step> {
        std::mem::take(&mut *lock(&self.queue.steps))
    }

    /// The number of steps that were dropped because they were not taken in time.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.queue.lost.load(Ordering::Relaxed)
    }
}

impl Drop for Steps {
    fn drop(&mut self) {
        self.listen(false);
    }
}

/// All servers that need every step.
#[derive(Debug, Default)]
pub(super) struct Readers {
    listening: AtomicUsize,
    shared: Mutex<Shared>,
}

#[derive(Debug, Default)]
struct Shared {
    queues: Vec<Weak<Queue>>,
    /// The instant and the machine time of the last step.
    last: Option<(SystemTime, Time)>,
}

impl Readers {
    pub(super) fn add(self: &Arc<Self>) -> Steps {
        let queue = Arc::default();
        lock(&self.shared).queues.push(Arc::downgrade(&queue));
        Steps { queue, readers: Arc::clone(self) }
    }

    /// The number of servers that listen: each gets a copy of its own.
    pub(super) fn listening(&self) -> usize {
        self.listening.load(Ordering::Acquire)
    }

    /// Adds a step to the queues of those that listen.
    pub(super) fn put(&self, mut copies: Vec<Box<Seen>>, is_real_time: bool, now: SystemTime) {
        let mut shared = lock(&self.shared);
        let Some(time) = copies.first().map(|seen| seen.machine.time()) else { return };
        let instant = instant(shared.last, time, is_real_time, now);
        shared.last = Some((instant, time));
        shared.queues.retain(|queue| {
            let Some(queue) = queue.upgrade() else { return false };
            if queue.is_listening.load(Ordering::Acquire)
                && let Some(seen) = copies.pop()
            {
                let mut steps = lock(&queue.steps);
                if steps.len() >= MOST {
                    steps.pop_front();
                    queue.lost.fetch_add(1, Ordering::Relaxed);
                }
                steps.push_back(Step { seen, instant });
            }
            true
        });
    }
}

/// The instant of a step: in real time one cycle after the last one, otherwise now. A machine that was delayed begins anew.
fn instant(last: Option<(SystemTime, Time)>, time: Time, is_real_time: bool, now: SystemTime) -> SystemTime {
    let due = last.filter(|_| is_real_time).and_then(|(instant, before)| {
        let since = u64::try_from((time - before).nanos()).ok()?;
        instant.checked_add(Duration::from_nanos(since))
    });
    let is_near = |due: &SystemTime| now.duration_since(*due).is_ok_and(|behind| behind <= BEHIND);
    let next = due.filter(is_near).unwrap_or(now);
    // The clock of the computer may have been set back.
    last.map_or(next, |(instant, _)| if instant > next && instant <= now { instant } else { next })
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn ms(milliseconds: u64) -> Duration {
        Duration::from_millis(milliseconds)
    }

    #[test]
    fn steps_in_real_time_are_one_cycle_apart_and_never_in_the_future() {
        let start = SystemTime::UNIX_EPOCH + ms(1000);
        let at = |cycle, now| instant(Some((start, Time::from_millis(2))), Time::from_millis(cycle), true, start + now);
        assert_eq!(at(4, ms(3)), start + ms(2));
        // Too early by the clock: the step is not dated in the future.
        assert_eq!(at(4, ms(1)), start + ms(1));
        // The machine paused for a second.
        assert_eq!(at(4, ms(1000)), start + ms(1000));
        // The machine went back in time.
        assert_eq!(at(1, ms(7)), start + ms(7));
        assert_eq!(instant(None, Time::ZERO, true, start), start);
    }

    #[test]
    fn steps_at_another_speed_have_the_instant_at_which_they_end() {
        let start = SystemTime::UNIX_EPOCH + ms(1000);
        let last = Some((start, Time::from_millis(2)));
        assert_eq!(instant(last, Time::from_millis(4), false, start + ms(20)), start + ms(20));
    }
}
