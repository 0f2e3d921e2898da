//! The boundary between a server and a live machine. `live/mod.rs` has its rules.

use std::sync::Arc;
use std::time::Duration;

use super::follower::Follower;
use super::following::Collected;
use super::inbox::Order;
use super::seen::Seen;
use super::shared::{Pace, Return, Shared};
use super::speed::Speed;
use super::steps::Steps;
use crate::scenario::Stage;
use crate::source::Problem;

/// A server's access to a live machine. A clone refers to the same machine. Only `async` functions wait for a step that takes long.
#[derive(Clone, Debug)]
pub struct Handle(Arc<Shared>);

impl Handle {
    pub(super) fn new(shared: Arc<Shared>) -> Self {
        Self(shared)
    }

    /// Reads the state after the last step. Everything read in one call is of the step [`Seen::step`]. Other callers wait meanwhile, so
    /// `look` must take only microseconds and must not block.
    pub fn look<T>(&self, look: impl FnOnce(&Seen) -> T) -> T {
        self.0.look(look)
    }

    /// Queues an order for the start of the next step; all of it takes effect there. Returns the number of that step. It is a later step if
    /// the next one is full.
    #[must_use = "the order is acknowledged when this step is over"]
    pub fn order(&self, order: Order) -> u64 {
        self.0.inbox.add(order)
    }

    /// Waits until an order can be acknowledged: until its step has ended. A client that writes and then reads therefore gets what it
    /// wrote. A machine that is held or pauses acknowledges orders at once, unless very many are queued. Returns false if the machine ended first:
    /// the order was not executed.
    pub async fn taken_up(&self, step: u64) -> bool {
        (self.0.is_held() || self.is_paused()) && !self.is_crowded() || self.over(step).await
    }

    /// Waits until a step has ended. A server that follows the machine waits for the step after the one it has seen, and may then find an
    /// even later one. Returns false if the machine ended first.
    pub async fn over(&self, step: u64) -> bool {
        self.0.over(step).await
    }

    /// Whether so many orders are queued that a client has to wait for its own, for as long as it takes.
    #[must_use]
    pub fn is_crowded(&self) -> bool {
        self.0.inbox.is_full()
    }

    /// Whether the PLC is in RUN after all orders so far. A client that stops the PLC sees it in STOP at once and may start it again.
    #[must_use]
    pub fn plc_runs(&self, seen: &Seen) -> bool {
        self.0.inbox.plc_runs(seen.step).unwrap_or_else(|| !seen.machine.is_plc_stopped())
    }

    /// Whether the machine takes no steps yet because it waits for a PLC process.
    #[must_use]
    pub fn is_held(&self) -> bool {
        self.0.is_held()
    }

    /// Whether the machine takes no more steps. The server must then end as well.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        self.0.has_ended()
    }

    /// The requested speed relative to real time.
    #[must_use]
    pub fn speed(&self) -> Speed {
        self.0.speed()
    }

    /// Changes the speed, from the next step on.
    pub fn set_speed(&self, speed: Speed) {
        self.0.driving.set_speed(speed);
    }

    /// Pauses after the current step, or goes on.
    pub fn pause(&self, is_paused: bool) {
        self.0.driving.pause(is_paused);
    }

    /// Pauses, and takes this number of steps more as fast as possible.
    pub fn step(&self, count: u64) {
        self.0.driving.step(count);
    }

    /// Whether the machine pauses.
    #[must_use]
    pub fn is_paused(&self) -> bool {
        self.0.driving.is_paused()
    }

    /// Whether the machine pauses and its last step is over.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.0.driving.is_at_rest()
    }

    /// Follows the machine from now on. A machine has one follower; another one takes its place.
    #[must_use]
    pub fn follow(&self) -> Follower {
        let mut lent = self.0.lend();
        if lent.collected.is_none() {
            lent.collected = Some(Collected::new(&lent.machine));
        }
        drop(lent);
        Follower::new(Arc::clone(&self.0))
    }

    /// The machine after every step from now on, for a server that must not miss one. Any number of servers can have one.
    #[must_use]
    pub fn steps(&self) -> Steps {
        self.0.readers.add()
    }

    /// Goes back to the end of a cycle of the last minutes, and pauses there. What happened later is forgotten; a scenario that was running
    /// ends. It counts as a step; orders that were queued for it take effect in the next one.
    ///
    /// # Errors
    /// The cycle is older than the history or has not been yet, or the machine ends.
    pub async fn go_back(&self, cycle: u64) -> Result<(), Problem> {
        let (answer, answered) = tokio::sync::oneshot::channel();
        self.0.ask_to_return(Return { cycle, answer });
        let nothing = || Problem::new("the machine did not go back: it ended, or went to another moment", "ask again");
        answered.await.unwrap_or_else(|_| Err(nothing()))
    }

    /// Everything since power on as a scenario that repeats it; `None` if the machine keeps no history, or its step takes long.
    #[must_use]
    pub fn scenario(&self) -> Option<String> {
        let lent = self.0.lend_soon()?;
        lent.history.as_ref()?.scenario(lent.machine.cycle())
    }

    /// The steps of the scenario that runs on the machine.
    #[must_use]
    pub fn scenario_steps(&self) -> Vec<Stage> {
        self.0.lend().operator.as_ref().map_or_else(Vec::new, |operator| operator.stages())
    }

    /// How well the schedule has been kept so far.
    #[must_use]
    pub fn pace(&self) -> Pace {
        self.0.pace()
    }

    /// The duration of a cycle at this speed, by the clock of the computer.
    #[must_use]
    pub fn cycle(&self) -> Duration {
        let nanos = self.look(|seen| seen.machine.cycle_time().nanos());
        self.speed().real(u128::try_from(nanos).unwrap_or(1))
    }
}
