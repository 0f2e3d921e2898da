//! What clients asked for, until the edge of the next step: whoever asks does not wait for a step that lasts, and all of a request
//! acts at the same edge. Where they ask for more than a step has time for, some of them wait for the edges behind it, in order.

use std::collections::VecDeque;
use std::net::SocketAddr;
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::live::Clocked;
use super::panel::machine_datum;
use crate::machine::Command;
use crate::s7;
use crate::source::Problem;

/// From so many orders on, clients wait a while with each.
const MANY: usize = 1000;
/// How many commands an edge takes, a byte or more each: half a millisecond. One request has fewer.
const EDGE: usize = 4096;

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
    /// With the cycle at whose edge each is taken up.
    orders: VecDeque<(u64, Order)>,
    /// The cycle of the last of them, and how many commands its edge has already.
    cycle: u64,
    commands: usize,
}

impl Inbox {
    /// An empty one, before this cycle.
    pub(super) fn new(cycle: u64) -> Self {
        Self(Mutex::new(Waiting { orders: VecDeque::new(), cycle, commands: 0 }))
    }

    /// Adds an order; gives the cycle that takes it up.
    pub(super) fn add(&self, order: Order) -> u64 {
        let mut waiting = self.lock();
        waiting.commands += order.commands.len();
        if waiting.commands > EDGE {
            waiting.cycle += 1;
            waiting.commands = order.commands.len();
        }
        let cycle = waiting.cycle;
        waiting.orders.push_back((cycle, order));
        cycle
    }

    /// Whether many orders wait.
    pub(super) fn is_full(&self) -> bool {
        self.lock().orders.len() >= MANY
    }

    /// The orders for the edge of this cycle; what comes from now on waits for the next.
    pub(super) fn take(&self, cycle: u64) -> Vec<Order> {
        let mut waiting = self.lock();
        if waiting.cycle <= cycle {
            (waiting.cycle, waiting.commands) = (cycle + 1, 0);
        }
        let due = waiting.orders.partition_point(|(when, _)| *when <= cycle);
        waiting.orders.drain(..due).map(|(_, order)| order).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    fn order(commands: usize) -> Order {
        Order { client: None, commands: vec![s7::Command::PlcStop; commands] }
    }

    fn sizes(orders: &[Order]) -> Vec<usize> {
        orders.iter().map(|order| order.commands.len()).collect()
    }

    /// 4,000 and 96 fill the edge of cycle 1, the next order is for cycle 2, and what comes in the end for cycle 3.
    #[test]
    fn an_edge_takes_whole_orders_as_far_as_it_has_time() {
        let inbox = Inbox::new(1);
        let cycles: Vec<_> = [4000, 96, 1, 4095, 1].into_iter().map(|count| inbox.add(order(count))).collect();
        assert_eq!(cycles, [1, 1, 2, 2, 3]);
        assert_eq!(sizes(&inbox.take(1)), [4000, 96]);
        assert_eq!(inbox.add(order(5)), 3);
        assert_eq!((sizes(&inbox.take(2)), sizes(&inbox.take(3))), (vec![1, 4095], vec![1, 5]));
        assert!(inbox.take(4).is_empty());
        assert_eq!(inbox.add(order(7)), 5, "the edge of cycle 4 is over");
    }
}
