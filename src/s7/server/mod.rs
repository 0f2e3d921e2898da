//! S7 sessions on TCP: admission, time limits and shutdown. [`Stations`] provides the data for the clients, one request at a time.
//!
//! | behaviour | reason |
//! |---|---|
//! | one request gets one station; reads that arrive together share one | values read together are of one step, and a write is executed as a whole |
//! | a write is answered after its execution | a client that writes and then reads gets what it wrote |
//! | writes that arrive together wait for one step | they are executed together, and the next request sees all of them |
//! | a turn ends after 32 KiB of answers | a client that floods the server does not hold up others |
//! | the buffers for requests and answers belong to the thread, not to the client | a thousand panels need about 3 MiB |
//! | answers leave in one write, in order, without TCP delay | clients that read once get the complete answer |
//! | the server stops reading from a client that does not read its answers, and closes its connection after a while | it does not hold up others |
//! | at the client limit, the oldest connection without a request is closed | idle connections do not block new clients |
//! | each wrong password from an address doubles the time until the next answer to one | a password of eight characters cannot be guessed |
//! | a client is idle if it has received no answer for a long time, not if it has sent nothing | incomplete packets do not keep a place |
//! | a client with subscriptions is never idle; TCP keep-alive detects lost clients | panels stay connected overnight |
//!
//! Nothing here depends on a machine. Within `s7`, only this folder uses a clock.

mod accepting;
mod capture;
mod conversation;
mod counters;
mod end;
mod faults;
mod guesses;
mod limits;
mod refusals;
mod sending;
mod strangers;
mod witness;

use std::future::Future;
use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use tokio::sync::Semaphore;
use tokio::time::Instant;

use super::session::Settings;
use super::station::Station;
pub use accepting::listen;
pub use capture::Capture;
pub use counters::{Counter, Counters};
pub use faults::Faults;
use guesses::Guesses;
pub use limits::{Limits, Network};
pub use refusals::Refused;
use strangers::Strangers;
use witness::Flood;

/// A source of stations.
pub trait Stations: Send + Sync + 'static {
    /// Lends a station exactly once. Nothing else changes it meanwhile. Returns the number of the step that executes the writes, or `None`
    /// if nothing was written.
    fn lend(&self, work: &mut dyn FnMut(&mut dyn Station)) -> Option<u64>;

    /// Lends a station to a known client, for implementations that keep a record of clients.
    fn lend_to(&self, _client: SocketAddr, work: &mut dyn FnMut(&mut dyn Station)) -> Option<u64> {
        self.lend(work)
    }

    /// Waits until that step has ended.
    fn taken_up(&self, step: u64) -> impl Future<Output = ()> + Send;

    /// Whether so many writes are queued that clients have to wait for their execution, for as long as it takes.
    fn is_crowded(&self) -> bool {
        false
    }
}

/// Optional instruments of a server.
#[derive(Debug, Default)]
pub struct Instruments {
    /// Injected faults.
    pub faults: Option<Faults>,
    /// The capture of the network traffic.
    pub capture: Option<Capture>,
}

/// A server of S7 communication.
#[derive(Debug)]
pub struct Server<S> {
    stations: S,
    settings: Settings,
    limits: Limits,
    places: Arc<Semaphore>,
    clients: AtomicUsize,
    counters: Counters,
    flood: Flood,
    strangers: Strangers,
    guesses: Guesses,
    instruments: Instruments,
    begin: Instant,
}

impl<S: Stations> Server<S> {
    /// A server without listeners.
    #[must_use]
    pub fn new(stations: S, settings: Settings, limits: Limits) -> Self {
        let places = Arc::new(Semaphore::new(limits.clients.min(Semaphore::MAX_PERMITS)));
        let begin = Instant::now();
        Self {
            stations,
            settings,
            limits,
            places,
            clients: AtomicUsize::new(0),
            counters: Counters::default(),
            flood: Flood::default(),
            strangers: Strangers::default(),
            guesses: Guesses::default(),
            instruments: Instruments::default(),
            begin,
        }
    }

    /// Adds instruments.
    #[must_use]
    pub fn with(self, instruments: Instruments) -> Self {
        Self { instruments, ..self }
    }

    /// The number of connected clients.
    #[must_use]
    pub fn clients(&self) -> usize {
        self.clients.load(Ordering::Relaxed)
    }

    /// The counters so far.
    #[must_use]
    pub fn counters(&self) -> &Counters {
        &self.counters
    }
}
