//! The clients of `/events`. One task follows the machine, makes each event once, and gives it to all clients. A client that does not take
//! its events is left out until it does, and then gets a snapshot.

use std::collections::VecDeque;
use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll};
use std::time::Duration;

use axum::body::Bytes;
use futures_core::Stream;
use serde::Serialize;
use tokio::sync::mpsc;
use tokio::time::{Instant, sleep_until, timeout};

use super::catalogue::Catalogue;
use super::options::WebOptions;
use super::picture::{Edge, Now, Past, Written, edges, values};
use super::why_not;
use crate::image::Location;
use crate::live::{Batch, Follower, Handle, Order};
use crate::machine::Command;
use crate::source::Problem;
use crate::trace::Watch;
use crate::units::Time;

/// The time between two events.
const PERIOD: Duration = Duration::from_millis(33);
/// A machine that takes no step tells its state in this interval.
const HEARTBEAT: Duration = Duration::from_millis(500);
/// The number of clients at the same time.
const CLIENTS: usize = 64;
/// The events that wait for a client, which is left out when it has more.
const WAITING: usize = 16;
/// The most signals that a client holds.
const HELD: usize = 64;
/// The most changes in one event. There are more only far above real time; the others are counted.
const EDGES: usize = 4000;
/// The changes that a new client gets.
const RECENT: usize = 3000;

/// The machine as the clients see it, and the clients.
pub(super) struct Hub {
    live: Handle,
    catalogue: Catalogue,
    shared: Mutex<Shared>,
}

struct Shared {
    follower: Option<Follower>,
    past: Past,
    recent: VecDeque<Edge>,
    /// The time of the machine after the last event.
    time: Time,
    clients: Vec<Client>,
    /// The number of the last client.
    last: u64,
}

struct Client {
    number: u64,
    /// What its pressed keys hold at 1.
    held: Vec<Location>,
    sender: mpsc::Sender<Bytes>,
    /// It missed events.
    is_behind: bool,
}

#[derive(Serialize)]
struct Snapshot<'a> {
    now: Now,
    values: Vec<f64>,
    writers: Vec<(&'a usize, &'a Written)>,
    recent: &'a VecDeque<Edge>,
    /// The client missed events, or changes were lost.
    lagged: bool,
    /// The number of the client, in its first event.
    #[serde(skip_serializing_if = "Option::is_none")]
    client: Option<u64>,
}

#[derive(Serialize)]
struct Step<'a> {
    now: Now,
    edges: &'a [Edge],
    /// The number of changes that are not told.
    lost: usize,
}

impl Hub {
    pub(super) fn new(live: Handle, options: &WebOptions) -> Self {
        let catalogue = Catalogue::new(&live, options);
        let follower = Some(live.follow());
        let (past, recent, clients) = (Past::default(), VecDeque::new(), Vec::new());
        let shared = Shared { follower, past, recent, time: Time::ZERO, clients, last: 0 };
        Self { live, catalogue, shared: Mutex::new(shared) }
    }

    pub(super) fn live(&self) -> &Handle {
        &self.live
    }

    pub(super) fn catalogue(&self) -> &Catalogue {
        &self.catalogue
    }

    fn lock(&self) -> MutexGuard<'_, Shared> {
        self.shared.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Follows the machine until the server ends.
    pub(super) async fn follow(self: Arc<Self>) {
        let Some(mut follower) = self.lock().follower.take() else { return };
        loop {
            let next = Instant::now() + PERIOD;
            match timeout(HEARTBEAT, follower.next()).await {
                Ok(batch) => self.take(&batch),
                Err(_) => self.tell(&[], 0),
            }
            sleep_until(next).await;
        }
    }

    /// Takes what happened, and tells it to the clients.
    fn take(&self, batch: &Batch) {
        let machine = batch.seen.machine();
        let lines = batch.trace.lines(machine, &Watch::default());
        let mut shared = self.lock();
        let time = batch.begin.seconds();
        if batch.is_new && batch.begin < shared.time {
            // The machine went back. Who wrote a signal before that is known only if nobody wrote it later.
            shared.past.forget_after(time);
            shared.recent.retain(|edge| edge.t <= time);
        } else if batch.is_new {
            (shared.past, shared.recent) = (Past::default(), VecDeque::new());
        }
        shared.time = machine.time();
        let mut all = edges(lines, batch.begin, &self.catalogue, &mut shared.past);
        let lost = all.len().saturating_sub(EDGES);
        all.truncate(EDGES);
        shared.recent.extend(all.iter().cloned());
        let surplus = shared.recent.len().saturating_sub(RECENT);
        shared.recent.drain(..surplus);
        if batch.is_new || lost > 0 {
            shared.clients.iter_mut().for_each(|client| client.is_behind = true);
        }
        drop(shared);
        self.tell(&all, lost);
    }

    /// Sends an event to each client, a snapshot to those that missed something.
    fn tell(&self, edges: &[Edge], lost: usize) {
        let mut shared = self.lock();
        if shared.clients.is_empty() {
            return;
        }
        let now = self.live.look(|seen| Now::of(seen, &self.live));
        let step = event("step", &Step { now, edges, lost });
        let mut clients = std::mem::take(&mut shared.clients);
        let is_free = |client: &Client| client.sender.capacity() == client.sender.max_capacity();
        let snapshot = clients.iter().any(|client| client.is_behind && is_free(client));
        let snapshot = snapshot.then(|| event("snapshot", &self.snapshot(&shared, true, None)));
        for client in &mut clients {
            let bytes = match (client.is_behind, &snapshot) {
                (false, _) => &step,
                (true, Some(snapshot)) if is_free(client) => snapshot,
                (true, _) => continue,
            };
            client.is_behind = client.sender.try_send(bytes.clone()).is_err();
        }
        shared.clients = clients;
    }

    fn snapshot<'a>(&self, shared: &'a Shared, lagged: bool, client: Option<u64>) -> Snapshot<'a> {
        let (now, values) = self.live.look(|seen| (Now::of(seen, &self.live), values(seen.machine(), &self.catalogue)));
        Snapshot { now, values, writers: shared.past.writers.iter().collect(), recent: &shared.recent, lagged, client }
    }

    /// The machine after its last step as JSON.
    pub(super) fn state(&self) -> String {
        let shared = self.lock();
        json(&self.snapshot(&shared, false, None))
    }

    /// A new client; its first event is a snapshot. `None` if there are too many.
    pub(super) fn join(self: &Arc<Self>) -> Option<Events> {
        let mut shared = self.lock();
        if shared.clients.len() >= CLIENTS {
            return None;
        }
        let (sender, receiver) = mpsc::channel(WAITING);
        shared.last += 1;
        let number = shared.last;
        // The next event, within half a second, continues after this one: both are made under the lock.
        let is_behind = sender.try_send(event("snapshot", &self.snapshot(&shared, false, Some(number)))).is_err();
        shared.clients.push(Client { number, held: Vec::new(), sender, is_behind });
        Some(Events { receiver, number, hub: Arc::clone(self) })
    }

    /// A client presses and releases keys: what it holds at 1 becomes 0 when its stream ends, at once if it has ended.
    pub(super) fn hold(&self, number: u64, commands: &[Command]) {
        let writes = commands.iter().filter_map(|command| {
            let Command::Write { location, value } = command else { return None };
            Some((*location, *value))
        });
        let mut shared = self.lock();
        let Some(client) = shared.clients.iter_mut().find(|client| client.number == number) else {
            self.let_go(writes.filter(|(_, value)| *value != 0).map(|(location, _)| location));
            return;
        };
        for (location, value) in writes {
            client.held.retain(|held| *held != location);
            if value != 0 && client.held.len() < HELD {
                client.held.push(location);
            }
        }
    }

    /// Writes 0 to what was held.
    fn let_go(&self, held: impl IntoIterator<Item = Location>) {
        let commands: Vec<_> = held.into_iter().map(|location| Command::Write { location, value: 0 }).collect();
        if !commands.is_empty() {
            // Nobody waits for this step.
            let _ = self.live.order(Order { commands, ..Order::default() });
        }
    }

    /// The stream of a client has ended.
    fn leave(&self, number: u64) {
        let mut shared = self.lock();
        if let Some(at) = shared.clients.iter().position(|client| client.number == number) {
            let client = shared.clients.swap_remove(at);
            self.let_go(client.held);
        }
    }

    /// What must hold before a signal has a value, as JSON.
    pub(super) fn why_not(&self, signal: &str, wanted: Option<bool>) -> Result<String, Problem> {
        let shared = self.lock();
        let writers = |location| self.catalogue.index(location).and_then(|index| shared.past.writers.get(&index));
        self.live.look(|seen| why_not::tree(seen.machine(), signal, wanted, &writers)).map(|tree| json(&tree))
    }
}

/// The events of a client.
pub(super) struct Events {
    receiver: mpsc::Receiver<Bytes>,
    number: u64,
    hub: Arc<Hub>,
}

impl Drop for Events {
    fn drop(&mut self) {
        self.hub.leave(self.number);
    }
}

impl Stream for Events {
    type Item = Result<Bytes, std::convert::Infallible>;

    fn poll_next(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        self.get_mut().receiver.poll_recv(context).map(|bytes| bytes.map(Ok))
    }
}

fn json(what: &impl Serialize) -> String {
    serde_json::to_string(what).unwrap_or_default()
}

fn event(name: &str, what: &impl Serialize) -> Bytes {
    // JSON has no line ends outside of texts, and escapes them inside.
    Bytes::from(format!("event: {name}\ndata: {}\n\n", json(what)))
}
