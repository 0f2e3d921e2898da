//! The inbox: the orders of clients, queued for the start of the next step. A client does not wait for a step that takes long. All of an
//! order takes effect at the start of the same step. If there are more orders than one step has time for, the rest wait for the following
//! steps, in order.

use std::collections::VecDeque;
use std::net::SocketAddr;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

use crate::machine::{Command, PlcOrder};

/// From this number of queued orders on, each client waits for its own.
const MANY: usize = 1000;
/// Bytes that are written at the start of one step: they take half a millisecond, and far less than the capacity of a step's record. One
/// order has fewer bytes.
const EDGE: usize = 4096;

/// The changes requested by one client request; all of them take effect at the start of the same step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Order {
    /// The address of the client, if it has one. A recording uses it to number the clients.
    pub client: Option<SocketAddr>,
    /// The commands, in order. A command that the machine rejects (see [`Machine::check`](crate::machine::Machine::check)) is logged and
    /// skipped; the others are executed.
    pub commands: Vec<Command>,
    /// The time to which the clock of the PLC's CPU is set, in UTC.
    pub clock: Option<SystemTime>,
}

/// Orders queued for the start of a step.
#[derive(Debug)]
pub(super) struct Inbox(Mutex<Waiting>);

#[derive(Debug)]
struct Waiting {
    /// Each order with the step at whose start it is executed.
    orders: VecDeque<(u64, Order)>,
    /// The step of the last order, and the bytes already queued for that step.
    step: u64,
    bytes: usize,
    /// The number of steps that have begun.
    begun: u64,
    /// The last order to start or stop the PLC: the step at whose start it takes effect, and the requested state, RUN as true.
    plc: Option<(u64, bool)>,
}

impl Order {
    /// Whether it contains nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.commands.is_empty() && self.clock.is_none()
    }

    /// The number of bytes that it writes.
    fn bytes(&self) -> usize {
        let clock = if self.clock.is_some() { size_of::<f64>() } else { 0 };
        self.commands.iter().map(bytes).sum::<usize>() + clock
    }

    /// The state requested by its last command to start or stop the PLC, RUN as true; `None` without one.
    fn plc_runs(&self) -> Option<bool> {
        self.commands.iter().rev().find_map(Command::plc_order).map(|order| order != PlcOrder::Stop)
    }
}

fn bytes(command: &Command) -> usize {
    command.location().map_or(size_of::<f64>(), |location| location.bytes() as usize)
}

impl Inbox {
    /// An empty inbox, before the first step.
    pub(super) fn new() -> Self {
        Self(Mutex::new(Waiting { orders: VecDeque::new(), step: 1, bytes: 0, begun: 0, plc: None }))
    }

    /// Adds an order; returns the step that executes it.
    pub(super) fn add(&self, order: Order) -> u64 {
        let mut waiting = self.lock();
        let bytes = order.bytes();
        waiting.bytes += bytes;
        if waiting.bytes > EDGE {
            waiting.step += 1;
            waiting.bytes = bytes;
        }
        let step = waiting.step;
        let plc = order.plc_runs();
        waiting.plc = plc.map(|runs| (step, runs)).or(waiting.plc);
        waiting.orders.push_back((step, order));
        step
    }

    /// The state ordered for the PLC, if the state after this step does not show it yet. A client that stops the PLC may therefore start it
    /// again at once.
    pub(super) fn plc_runs(&self, after: u64) -> Option<bool> {
        self.lock().plc.filter(|(step, _)| *step > after).map(|(_, runs)| runs)
    }

    /// Whether many orders are queued.
    pub(super) fn is_full(&self) -> bool {
        self.count() >= MANY
    }

    /// The number of queued orders.
    pub(super) fn count(&self) -> usize {
        self.lock().orders.len()
    }

    /// Takes the orders for the step that begins; later orders wait for the next step.
    pub(super) fn take(&self) -> Vec<Order> {
        let mut waiting = self.lock();
        waiting.begun += 1;
        let begun = waiting.begun;
        if waiting.step <= begun {
            (waiting.step, waiting.bytes) = (begun + 1, 0);
        }
        let due = waiting.orders.partition_point(|(step, _)| *step <= begun);
        waiting.orders.drain(..due).map(|(_, order)| order).collect()
    }

    fn lock(&self) -> MutexGuard<'_, Waiting> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::{Format, Location, Part};
    use crate::trace::Recorder;

    /// An order that writes this many doubles.
    fn order(doubles: usize) -> Order {
        let location = Location { part: Part::Flags, offset: 0, bit: 0, width: 32, format: Format::Unsigned };
        Order { commands: vec![Command::Write { location, value: 0 }; doubles], ..Order::default() }
    }

    fn sizes(orders: &[Order]) -> Vec<usize> {
        orders.iter().map(|order| order.commands.len()).collect()
    }

    /// 1,000 and 24 doubles are the 4,096 bytes of the first step. The next order is for the second step, and the last one for the third.
    #[test]
    fn a_step_takes_whole_orders_up_to_its_limit() {
        let inbox = Inbox::new();
        let steps: Vec<_> = [1000, 24, 1, 1023, 1].into_iter().map(|count| inbox.add(order(count))).collect();
        assert_eq!(steps, [1, 1, 2, 2, 3]);
        assert_eq!(sizes(&inbox.take()), [1000, 24]);
        assert_eq!(inbox.add(order(5)), 3);
        assert_eq!((sizes(&inbox.take()), sizes(&inbox.take())), (vec![1, 1023], vec![1, 5]));
        assert!(inbox.take().is_empty());
        assert_eq!(inbox.add(order(7)), 5, "step 4 has begun");
    }

    /// Each byte that changes takes a row, and each write that the program overwrites takes another one.
    #[test]
    fn the_record_of_a_step_holds_the_writes_of_one_step() {
        const { assert!(Recorder::ROWS >= 2 * 2 * EDGE) };
    }
}
