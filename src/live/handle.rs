//! The boundary between a server and a live machine. `live/mod.rs` has its rules.

use std::sync::Arc;
use std::time::Duration;

use super::inbox::Order;
use super::seen::Seen;
use super::shared::{Pace, Shared};
use super::speed::Speed;

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
    /// wrote. A machine that is held acknowledges orders at once, unless very many are queued. Returns false if the machine ended first:
    /// the order was not executed.
    pub async fn taken_up(&self, step: u64) -> bool {
        self.0.is_held() && !self.is_crowded() || self.over(step).await
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
