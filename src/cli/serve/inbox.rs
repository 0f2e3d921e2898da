//! What clients asked for, until the edge of the next step: whoever asks does not wait for a step that lasts, and all of a request
//! acts at the same edge.

use std::net::SocketAddr;
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::live::Clocked;
use super::panel::machine_datum;
use crate::machine::Command;
use crate::s7;
use crate::source::Problem;

/// From so many orders on, clients wait a while with each.
const MANY: usize = 1000;

/// What a request asked for, in order.
#[derive(Debug)]
pub(super) struct Order {
    /// Who, where that is known.
    pub(super) client: Option<SocketAddr>,
    pub(super) commands: Vec<s7::Command>,
}

/// Orders that wait for the edge of a step.
#[derive(Debug)]
pub(super) struct Inbox(Mutex<Waiting>);

#[derive(Debug)]
struct Waiting {
    orders: Vec<Order>,
    /// The cycle at whose edge they are taken up.
    cycle: u64,
}

impl Inbox {
    /// An empty one, before this cycle.
    pub(super) fn new(cycle: u64) -> Self {
        Self(Mutex::new(Waiting { orders: Vec::new(), cycle }))
    }

    /// Adds an order; gives the cycle that takes it up.
    pub(super) fn add(&self, order: Order) -> u64 {
        let mut waiting = self.lock();
        waiting.orders.push(order);
        waiting.cycle
    }

    /// Whether many orders wait.
    pub(super) fn is_full(&self) -> bool {
        self.lock().orders.len() >= MANY
    }

    /// All orders, for the edge of this cycle; what comes from now on waits for the next.
    pub(super) fn empty(&self, cycle: u64) -> Vec<Order> {
        let mut waiting = self.lock();
        waiting.cycle = cycle + 1;
        std::mem::take(&mut waiting.orders)
    }

    fn lock(&self) -> MutexGuard<'_, Waiting> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Queues what a client asked for.
pub(super) fn queue(clocked: &mut Clocked, command: &s7::Command) -> Result<(), Problem> {
    let command = match *command {
        s7::Command::Write { location, value } => Command::Write { location, value },
        s7::Command::MachineDatum { place, number, index, value } => machine_datum(place, number, index, value)?,
        s7::Command::PlcStop => Command::PlcStop,
        s7::Command::RParameter { channel, number, value } => Command::RParameter { channel, number, value },
        s7::Command::PlcStart(restart) => {
            clocked.diagnosis.restart_asked(restart);
            match restart {
                s7::Restart::Warm => Command::PlcRun,
                s7::Restart::Cold => Command::PlcColdRestart,
            }
        }
        s7::Command::SetClock(time) => {
            clocked.set_clock(time);
            return Ok(());
        }
    };
    clocked.machine.queue(command)
}
