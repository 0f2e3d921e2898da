//! The access of S7 clients to a live machine.
//!
//! A request reads the machine as its last step left it. Everything that it writes is one order, and therefore takes effect at the start of
//! the same step.

use std::net::SocketAddr;
use std::sync::{Arc, Mutex, PoisonError};

use super::clock::{from_date_and_time, to_date_and_time};
use super::identity::identity;
use super::terms::Terms;
use crate::live::{Entry, Event, Handle, Order, Seen};
use crate::machine::{self, Panel};
use crate::s7::server::Stations;
use crate::s7::{Bridge, Command, CpuState, Diagnosis, Directory, Machinery, Restart, Station};

/// Serves one request after another from a live machine.
#[derive(Debug)]
pub(super) struct Lender {
    live: Handle,
    directory: Directory,
    is_read_only: bool,
    connections: u16,
    terms: Terms,
    diagnosis: Mutex<Shown>,
}

/// The diagnostic buffer of the machine, and its form in S7.
#[derive(Debug)]
struct Shown {
    of: Arc<[Entry]>,
    entries: Vec<Diagnosis>,
}

impl Lender {
    pub(super) fn new(live: Handle, is_read_only: bool, connections: u16, terms: Terms) -> Self {
        let (directory, of) = live.look(|seen| {
            let machine = seen.machine();
            (Directory::of(machine.memory(), machine.names().profile), Arc::clone(seen.diagnosis()))
        });
        Self { live, directory, is_read_only, connections, terms, diagnosis: Mutex::new(Shown::new(&of)) }
    }

    fn lend_out(&self, client: Option<SocketAddr>, work: &mut dyn FnMut(&mut dyn Station)) -> Option<u64> {
        let order = self.live.look(|seen| {
            let commands = self.show(seen, work);
            order(client, commands, seen.machine())
        });
        (!order.is_empty()).then(|| self.live.order(order))
    }

    /// Serves a request from a copy of the machine; returns the requested commands.
    fn show(&self, seen: &Seen, work: &mut dyn FnMut(&mut dyn Station)) -> Vec<Command> {
        let machine = seen.machine();
        let data = Panel(machine);
        let mut diagnosis = self.diagnosis.lock().unwrap_or_else(PoisonError::into_inner);
        if !Arc::ptr_eq(&diagnosis.of, seen.diagnosis()) {
            *diagnosis = Shown::new(seen.diagnosis());
        }
        let machinery = Machinery {
            state: if self.live.plc_runs(seen) { CpuState::Run } else { CpuState::Stop },
            clock: to_date_and_time(seen.clock()),
            is_read_only: self.is_read_only,
            machine_data: Some(&data),
            control: Some(&data),
            diagnosis: &diagnosis.entries,
            connections: self.connections,
            identity: identity(machine),
            ..Machinery::default()
        };
        let bridge = Bridge::new(machine.memory(), machine.variables(), machine.names(), &self.directory);
        let mut bridge = bridge.with(self.terms.over(machinery));
        work(&mut bridge);
        bridge.into_commands()
    }
}

impl Stations for Lender {
    fn lend(&self, work: &mut dyn FnMut(&mut dyn Station)) -> Option<u64> {
        self.lend_out(None, work)
    }

    fn lend_to(&self, client: SocketAddr, work: &mut dyn FnMut(&mut dyn Station)) -> Option<u64> {
        self.lend_out(Some(client), work)
    }

    async fn taken_up(&self, step: u64) {
        if !self.live.taken_up(step).await {
            // The machine has ended. The write is not acknowledged within the time limit of the server.
            std::future::pending::<()>().await;
        }
    }

    fn is_crowded(&self) -> bool {
        self.live.is_crowded()
    }
}

impl Shown {
    fn new(of: &Arc<[Entry]>) -> Self {
        Self { of: Arc::clone(of), entries: of.iter().map(diagnosis).collect() }
    }
}

fn diagnosis(entry: &Entry) -> Diagnosis {
    let event = match entry.event {
        Event::PowerOn => Diagnosis::POWER_ON,
        Event::StartUp => Diagnosis::START_UP,
        Event::Run => Diagnosis::RUN,
        Event::Stop => Diagnosis::STOP,
        Event::Fault => Diagnosis::FAULT,
        Event::Numbered(event, information) => {
            return Diagnosis { event, information, time: to_date_and_time(entry.time) };
        }
        Event::WarmRestart => Diagnosis::WARM_RESTART,
        Event::ColdRestart => Diagnosis::COLD_RESTART,
    };
    Diagnosis::of_state(event, to_date_and_time(entry.time))
}

/// Converts the commands of a request to commands of the machine.
fn order(client: Option<SocketAddr>, commands: Vec<Command>, machine: &machine::Machine) -> Order {
    let mut order = Order { client, commands: Vec::with_capacity(commands.len()), clock: None };
    for command in commands {
        order.commands.push(match command {
            Command::Write { location, value } => machine::Command::Write { location, value },
            Command::MachineDatum { place, number, index, value } => {
                match Panel(machine).store(place, number, index, value) {
                    Ok(command) => command,
                    Err(problem) => {
                        tracing::info!("rejected a command of a client: {problem}");
                        continue;
                    }
                }
            }
            Command::RParameter { channel, number, value } => machine::Command::RParameter { channel, number, value },
            Command::PlcStop => machine::Command::PlcStop,
            Command::PlcStart(Restart::Warm) => machine::Command::PlcRun,
            Command::PlcStart(Restart::Cold) => machine::Command::PlcColdRestart,
            Command::SetClock(time) => {
                order.clock = Some(from_date_and_time(time));
                continue;
            }
        });
    }
    order
}
