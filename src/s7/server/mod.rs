//! Sessions on TCP: who may come, how long anybody may take, and how it ends. What the clients see is lent by [`Stations`], one
//! request at a time.
//!
//! | what | and why |
//! |---|---|
//! | one request, one loan; reads that came together have one as well | what they read is of one step, and what is written is taken up whole |
//! | an answer to a write waits until the write was taken up | who writes and then reads finds what was written |
//! | writes that came together wait for one step | it takes them up whole, and the next request finds all of them |
//! | a turn ends after 32 KiB of answers | who floods holds up nobody |
//! | the room for requests and answers belongs to the thread, not to the client | a thousand panels need some 3 MiB |
//! | answers leave in one write, in order; no delay of TCP | clients that read once find all of it |
//! | a client that does not take its answers is not read any more, and is left after a while | it holds up nobody else |
//! | where all places are taken, the oldest connection without any request gives way | silence keeps nobody out |
//! | idle is who got no answer for long, not who has sent nothing | half packets keep no place |
//! | who waits for values that change is never idle; keep-alive of TCP finds out who has gone | panels stay connected over night |
//!
//! Nothing here knows a machine; this folder is all of the room that knows a clock.

mod accepting;
mod capture;
mod conversation;
mod counters;
mod end;
mod faults;
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
pub use limits::{Limits, Network};
pub use refusals::Refused;
use strangers::Strangers;
use witness::Flood;

/// Whoever has stations to lend.
pub trait Stations: Send + Sync + 'static {
    /// Lends a station, which nobody else changes meanwhile, exactly once. Gives the number of the step that takes up what was written;
    /// nothing where nothing was written.
    fn lend(&self, work: &mut dyn FnMut(&mut dyn Station)) -> Option<u64>;

    /// The same to somebody who is known, for who keeps a record of it.
    fn lend_to(&self, _client: SocketAddr, work: &mut dyn FnMut(&mut dyn Station)) -> Option<u64> {
        self.lend(work)
    }

    /// Waits until that step is over.
    fn taken_up(&self, step: u64) -> impl Future<Output = ()> + Send;

    /// Whether so much waits to be taken up that clients have to wait for that, however long it takes.
    fn is_crowded(&self) -> bool {
        false
    }
}

/// What a server does besides serving.
#[derive(Debug, Default)]
pub struct Instruments {
    /// Faults on purpose.
    pub faults: Option<Faults>,
    /// Where everything that goes over the wire is written.
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
    instruments: Instruments,
    begin: Instant,
}

impl<S: Stations> Server<S> {
    /// A server that nobody can reach yet.
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
            instruments: Instruments::default(),
            begin,
        }
    }

    /// The same with instruments.
    #[must_use]
    pub fn with(self, instruments: Instruments) -> Self {
        Self { instruments, ..self }
    }

    /// How many clients there are now.
    #[must_use]
    pub fn clients(&self) -> usize {
        self.clients.load(Ordering::Relaxed)
    }

    /// What was counted so far.
    #[must_use]
    pub fn counters(&self) -> &Counters {
        &self.counters
    }
}
