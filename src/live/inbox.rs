//! The inbox: what clients asked for, until the edge of the next step. A client does not wait for a step that lasts, and all of an
//! order acts at the same edge. Where clients ask for more than a step has time for, some orders wait for the edges behind it, in order.

use std::collections::VecDeque;
use std::net::SocketAddr;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

use crate::machine::Command;

/// From so many orders on, clients wait a while with each.
const MANY: usize = 1000;
/// How many bytes an edge writes: what takes half a millisecond, and far less than what the record of a step has room for. One order
/// has fewer.
const EDGE: usize = 4096;

/// What one request of a client asks for; all of it acts at the edge of the same step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Order {
    /// The address of the client, if it has one: a recording numbers clients by it.
    pub client: Option<SocketAddr>,
    /// What the machine does, in this order. A command that it does not take (see [`Machine::check`](crate::machine::Machine::check)) is
    /// logged and left out; the others are done.
    pub commands: Vec<Command>,
    /// The time to which the clock of the PLC's CPU is set, in UTC.
    pub clock: Option<SystemTime>,
}

/// Orders that wait for the edge of a step.
#[derive(Debug)]
pub(super) struct Inbox(Mutex<Waiting>);

#[derive(Debug)]
struct Waiting {
    /// With the step at whose edge each is taken up.
    orders: VecDeque<(u64, Order)>,
    /// The step of the last of them, and how many bytes its edge writes already.
    step: u64,
    bytes: usize,
    /// How many steps have begun.
    begun: u64,
    /// The last order to start or stop the PLC: the step at whose edge it acts, and whether the PLC runs then.
    plc: Option<(u64, bool)>,
}

impl Order {
    /// Whether it asks for nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.commands.is_empty() && self.clock.is_none()
    }

    /// How many bytes it writes.
    fn bytes(&self) -> usize {
        let clock = if self.clock.is_some() { size_of::<f64>() } else { 0 };
        self.commands.iter().map(bytes).sum::<usize>() + clock
    }

    /// Whether it starts or stops the PLC: the state that its last such command asks for, RUN as true.
    fn plc_runs(&self) -> Option<bool> {
        self.commands.iter().rev().find_map(plc_runs)
    }
}

fn bytes(command: &Command) -> usize {
    match command {
        Command::Write { location, .. } | Command::Force { location, .. } | Command::Release { location } => {
            location.bytes() as usize
        }
        Command::MachineDatum { .. }
        | Command::RParameter { .. }
        | Command::NewConf
        | Command::PowerOn
        | Command::PlcStop
        | Command::PlcRun
        | Command::PlcColdRestart
        | Command::Cancel
        | Command::Handwheel { .. }
        | Command::Fault(_)
        | Command::ClearFault(_) => size_of::<f64>(),
    }
}

fn plc_runs(command: &Command) -> Option<bool> {
    match command {
        Command::PlcStop => Some(false),
        Command::PlcRun | Command::PlcColdRestart => Some(true),
        Command::Write { .. }
        | Command::Force { .. }
        | Command::Release { .. }
        | Command::MachineDatum { .. }
        | Command::RParameter { .. }
        | Command::NewConf
        | Command::PowerOn
        | Command::Cancel
        | Command::Handwheel { .. }
        | Command::Fault(_)
        | Command::ClearFault(_) => None,
    }
}

impl Inbox {
    /// An empty one, before the first step.
    pub(super) fn new() -> Self {
        Self(Mutex::new(Waiting { orders: VecDeque::new(), step: 1, bytes: 0, begun: 0, plc: None }))
    }

    /// Adds an order; gives the step that takes it up.
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

    /// Whether the PLC was ordered to run or to stop and does not show it yet after this step. So a client that stops it may start it at
    /// once.
    pub(super) fn plc_runs(&self, after: u64) -> Option<bool> {
        self.lock().plc.filter(|(step, _)| *step > after).map(|(_, runs)| runs)
    }

    /// Whether many orders wait.
    pub(super) fn is_full(&self) -> bool {
        self.count() >= MANY
    }

    /// How many orders wait.
    pub(super) fn count(&self) -> usize {
        self.lock().orders.len()
    }

    /// The orders for the edge of the step that begins; what comes from now on waits for the next.
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

    /// So many doubles.
    fn order(doubles: usize) -> Order {
        let location = Location { part: Part::Flags, offset: 0, bit: 0, width: 32, format: Format::Unsigned };
        Order { commands: vec![Command::Write { location, value: 0 }; doubles], ..Order::default() }
    }

    fn sizes(orders: &[Order]) -> Vec<usize> {
        orders.iter().map(|order| order.commands.len()).collect()
    }

    /// 1,000 and 24 doubles are the 4,096 bytes of the first edge, the next order is for the second, and what comes in the end for
    /// the third.
    #[test]
    fn an_edge_takes_whole_orders_as_far_as_it_has_time() {
        let inbox = Inbox::new();
        let steps: Vec<_> = [1000, 24, 1, 1023, 1].into_iter().map(|count| inbox.add(order(count))).collect();
        assert_eq!(steps, [1, 1, 2, 2, 3]);
        assert_eq!(sizes(&inbox.take()), [1000, 24]);
        assert_eq!(inbox.add(order(5)), 3);
        assert_eq!((sizes(&inbox.take()), sizes(&inbox.take())), (vec![1, 1023], vec![1, 5]));
        assert!(inbox.take().is_empty());
        assert_eq!(inbox.add(order(7)), 5, "the edge of step 4 is over");
    }

    /// A byte that changes is a row, and each write that the program overwrites is another one.
    #[test]
    fn the_record_of_a_step_has_room_for_an_edge() {
        const { assert!(Recorder::ROWS >= 2 * 2 * EDGE) };
    }
}
