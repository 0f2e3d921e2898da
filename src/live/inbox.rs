//! What clients asked for, until the edge of the next step: whoever asks does not wait for a step that lasts, and all of a request
//! acts at the same edge. Where they ask for more than a step has time for, some of them wait for the edges behind it, in order.

use std::collections::VecDeque;
use std::net::SocketAddr;
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::stepping::Clocked;
use crate::machine::Command;
use crate::s7::live::panel::machine_datum;
use crate::s7::{self, CpuState};
use crate::source::Problem;

/// From so many orders on, clients wait a while with each.
const MANY: usize = 1000;
/// How many bytes an edge writes: what takes half a millisecond, and far less than what the record of a step has room for. One request
/// has fewer.
const EDGE: usize = 4096;

/// What a request asked for, in order.
#[derive(Debug)]
pub(crate) struct Order {
    /// Who, where that is known.
    pub(crate) client: Option<SocketAddr>,
    pub(crate) commands: Vec<s7::Command>,
}

/// Orders that wait for the edge of a step.
#[derive(Debug)]
pub(crate) struct Inbox(Mutex<Waiting>);

#[derive(Debug)]
struct Waiting {
    /// With the step at whose edge each is taken up.
    orders: VecDeque<(u64, Order)>,
    /// The step of the last of them, and how many bytes its edge writes already.
    step: u64,
    bytes: usize,
    /// How many steps have begun.
    begun: u64,
    /// What the PLC was asked for last, and the step at whose edge it does that.
    plc: Option<(u64, CpuState)>,
}

impl Order {
    /// How many bytes it writes.
    fn bytes(&self) -> usize {
        let bytes = |command: &s7::Command| match command {
            s7::Command::Write { location, .. } => location.bytes() as usize,
            s7::Command::MachineDatum { .. }
            | s7::Command::RParameter { .. }
            | s7::Command::PlcStop
            | s7::Command::PlcStart(_)
            | s7::Command::SetClock(_) => size_of::<f64>(),
        };
        self.commands.iter().map(bytes).sum()
    }
}

impl Inbox {
    /// An empty one, before the first step.
    pub(crate) fn new() -> Self {
        Self(Mutex::new(Waiting { orders: VecDeque::new(), step: 1, bytes: 0, begun: 0, plc: None }))
    }

    /// Adds an order; gives the step that takes it up.
    pub(crate) fn add(&self, order: Order) -> u64 {
        let mut waiting = self.lock();
        let bytes = order.bytes();
        waiting.bytes += bytes;
        if waiting.bytes > EDGE {
            waiting.step += 1;
            waiting.bytes = bytes;
        }
        let step = waiting.step;
        let plc = order.commands.iter().rev().find_map(|command| match command {
            s7::Command::PlcStop => Some(CpuState::Stop),
            s7::Command::PlcStart(_) => Some(CpuState::Run),
            s7::Command::Write { .. }
            | s7::Command::MachineDatum { .. }
            | s7::Command::RParameter { .. }
            | s7::Command::SetClock(_) => None,
        });
        waiting.plc = plc.map(|state| (step, state)).or(waiting.plc);
        waiting.orders.push_back((step, order));
        step
    }

    /// What the PLC was asked for and does not show yet, for who sees the machine after this step: whoever stops it may start it at once.
    pub(crate) fn asked_of_plc(&self, seen: u64) -> Option<CpuState> {
        self.lock().plc.filter(|(step, _)| *step > seen).map(|(_, state)| state)
    }

    /// Whether many orders wait.
    pub(crate) fn is_full(&self) -> bool {
        self.count() >= MANY
    }

    /// How many orders wait.
    pub(crate) fn count(&self) -> usize {
        self.lock().orders.len()
    }

    /// The orders for the edge of the step that begins; what comes from now on waits for the next.
    pub(crate) fn take(&self) -> Vec<Order> {
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

/// Queues what a client asked for.
pub(crate) fn queue(clocked: &mut Clocked, command: &s7::Command) -> Result<(), Problem> {
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
    use crate::image::{Format, Location, Part};
    use crate::trace::Recorder;

    /// So many doubles.
    fn order(doubles: usize) -> Order {
        let location = Location { part: Part::Flags, offset: 0, bit: 0, width: 32, format: Format::Unsigned };
        Order { client: None, commands: vec![s7::Command::Write { location, value: 0 }; doubles] }
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
