//! The boundary at which a server plugs into a live machine. `live/mod.rs` says what holds there.

use std::sync::Arc;
use std::time::Duration;

use super::inbox::Order;
use super::seen::Seen;
use super::shared::{Pace, Shared};
use super::speed::Speed;

/// What a server holds of a live machine. A clone is of the same machine. Nothing here waits for a step that lasts, but for what is
/// `async`.
#[derive(Clone, Debug)]
pub struct Handle(Arc<Shared>);

impl Handle {
    pub(super) fn new(shared: Arc<Shared>) -> Self {
        Self(shared)
    }

    /// Looks at the machine as its last step left it: everything that is read in one call is of the step [`Seen::step`]. Other callers
    /// wait meanwhile, so a look takes microseconds and does not block.
    pub fn look<T>(&self, look: impl FnOnce(&Seen) -> T) -> T {
        self.0.look(look)
    }

    /// Orders something for the edge of the next step, at which all of it acts. Gives the number of that step, which is a later one
    /// where the next has enough to do.
    #[must_use = "the order is acknowledged when this step is over"]
    pub fn order(&self, order: Order) -> u64 {
        self.0.inbox.add(order)
    }

    /// Waits until an order may be acknowledged: until its step is over, so that a client that writes and then reads finds what it wrote.
    /// Orders from a machine that is held are acknowledged at once, unless very many wait. False where the machine ended
    /// before: the order was not done.
    pub async fn taken_up(&self, step: u64) -> bool {
        self.0.is_held() && !self.is_crowded() || self.over(step).await
    }

    /// Waits until a step is over. A server that follows the machine waits for the step behind the one that it has seen; it may find a
    /// later one then. False where the machine ended before.
    pub async fn over(&self, step: u64) -> bool {
        self.0.over(step).await
    }

    /// Whether so many orders wait that a client has to wait for its own, however long that takes.
    #[must_use]
    pub fn is_crowded(&self) -> bool {
        self.0.inbox.is_full()
    }

    /// Whether the PLC is in RUN after what was ordered so far: a client that stops the PLC finds it in STOP at once and may start it.
    #[must_use]
    pub fn plc_runs(&self, seen: &Seen) -> bool {
        self.0.inbox.plc_runs(seen.step).unwrap_or_else(|| !seen.machine.is_plc_stopped())
    }

    /// Whether the machine takes no step yet: it waits for a PLC process.
    #[must_use]
    pub fn is_held(&self) -> bool {
        self.0.is_held()
    }

    /// Whether the machine takes no step any more. Then the server ends, too.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        self.0.has_ended()
    }

    /// How many times real time is wanted.
    #[must_use]
    pub fn speed(&self) -> Speed {
        self.0.speed()
    }

    /// How well the schedule was kept so far.
    #[must_use]
    pub fn pace(&self) -> Pace {
        self.0.pace()
    }

    /// How long a cycle takes at this speed, by the clock of the computer.
    #[must_use]
    pub fn cycle(&self) -> Duration {
        let nanos = self.look(|seen| seen.machine.cycle_time().nanos());
        self.speed().real(u128::try_from(nanos).unwrap_or(1))
    }
}
