//! How a live machine is driven: its speed, and whether it pauses. Servers change it through the handle; the stepping thread reads it before
//! each step.

use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};

use super::speed::Speed;

/// The speed of a machine, and whether it pauses.
#[derive(Debug)]
pub(super) struct Driving {
    /// In thousandths of real time.
    speed: AtomicU32,
    is_paused: AtomicBool,
    /// A step is running or about to begin. The stepping thread sets it before it asks whether the machine pauses. So a caller that pauses
    /// the machine and then finds it clear knows that no step follows.
    is_stepping: AtomicBool,
    /// The steps that a paused machine may still take.
    steps: AtomicU64,
    /// The number of changes: after each one the schedule begins anew.
    changes: AtomicU64,
}

impl Driving {
    pub(super) fn new(speed: Speed) -> Self {
        let speed = AtomicU32::new(speed.thousandths());
        let (is_paused, is_stepping) = (AtomicBool::new(false), AtomicBool::new(false));
        Self { speed, is_paused, is_stepping, steps: AtomicU64::new(0), changes: AtomicU64::new(0) }
    }

    pub(super) fn speed(&self) -> Speed {
        Speed::of_thousandths(self.speed.load(Ordering::Relaxed))
    }

    pub(super) fn set_speed(&self, speed: Speed) {
        self.speed.store(speed.thousandths(), Ordering::Relaxed);
        self.changes.fetch_add(1, Ordering::Release);
    }

    pub(super) fn is_paused(&self) -> bool {
        self.is_paused.load(Ordering::SeqCst)
    }

    /// Whether it pauses and no step is under way.
    pub(super) fn is_at_rest(&self) -> bool {
        self.is_paused() && !self.is_stepping.load(Ordering::SeqCst)
    }

    /// Pauses after the current step, or goes on.
    pub(super) fn pause(&self, is_paused: bool) {
        self.steps.store(0, Ordering::Release);
        self.is_paused.store(is_paused, Ordering::SeqCst);
        self.changes.fetch_add(1, Ordering::Release);
    }

    /// Pauses, and takes this number of steps more.
    pub(super) fn step(&self, count: u64) {
        self.is_paused.store(true, Ordering::SeqCst);
        self.steps.fetch_add(count, Ordering::AcqRel);
        self.changes.fetch_add(1, Ordering::Release);
    }

    /// Whether the next step may be taken; called once for each step, which [`Driving::stepped`] ends.
    pub(super) fn may_step(&self) -> bool {
        let less = |steps: u64| steps.checked_sub(1);
        self.is_stepping.store(true, Ordering::SeqCst);
        let may = !self.is_paused() || self.steps.fetch_update(Ordering::AcqRel, Ordering::Acquire, less).is_ok();
        if !may {
            self.stepped();
        }
        may
    }

    /// The step is over.
    pub(super) fn stepped(&self) {
        self.is_stepping.store(false, Ordering::SeqCst);
    }

    pub(super) fn changes(&self) -> u64 {
        self.changes.load(Ordering::Acquire)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_paused_machine_takes_the_steps_that_it_may() {
        let driving = Driving::new(Speed::default());
        assert!(driving.may_step() && driving.may_step());
        driving.step(2);
        assert!(driving.is_paused());
        assert_eq!((0..5).filter(|_| driving.may_step()).count(), 2);
        driving.step(1);
        driving.pause(false);
        assert!(driving.may_step() && !driving.is_paused());
        driving.pause(true);
        assert!(!driving.may_step());
    }
}
