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

mod capture;
mod conversation;
mod counters;
mod faults;
mod limits;
mod refusals;
mod strangers;
mod witness;

use std::future::Future;
use std::io;
use std::net::SocketAddr;
use std::pin::pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use socket2::{SockRef, TcpKeepalive};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore, watch};
use tokio::task::JoinSet;
use tokio::time::{Instant, sleep, timeout};

use super::session::Settings;
use super::station::Station;
pub use capture::Capture;
use conversation::Conversation;
pub use counters::{Counter, Counters};
pub use faults::Faults;
pub use limits::{Limits, Network};
pub use refusals::Refused;
use strangers::Strangers;
use witness::Flood;

/// How long a place may take to become free whose client was asked to give way.
const GIVING_WAY: Duration = Duration::from_secs(1);

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

    /// Serves everybody who comes to a listener, until the end is there. Requests on their way are still answered. One server
    /// may run on several listeners; its limits are for all of them together.
    pub async fn run(self: Arc<Self>, listener: TcpListener, end: impl Future<Output = ()>) {
        let (ending, ended) = watch::channel(false);
        let mut conversations = JoinSet::new();
        let mut end = pin!(end);
        loop {
            tokio::select! {
                () = &mut end => break,
                Some(_) = conversations.join_next() => {}
                accepted = listener.accept() => match accepted {
                    Ok((stream, peer)) => {
                        if let Some(place) = self.admit(&stream, peer) {
                            conversations.spawn(Arc::clone(&self).attend(stream, peer, ended.clone(), place));
                        }
                    }
                    Err(error) => {
                        // No more handles, or a client that has gone already: others may still come.
                        tracing::warn!("a client could not be accepted: {error}");
                        sleep(Duration::from_millis(50)).await;
                    }
                },
            }
        }
        drop(listener);
        ending.send_replace(true);
        let _ = timeout(self.limits.end, async { while conversations.join_next().await.is_some() {} }).await;
        conversations.shutdown().await;
    }

    /// A place for a client, if it may come; one that will be free in a moment where somebody silent gives way.
    fn admit(&self, stream: &TcpStream, peer: SocketAddr) -> Option<Option<OwnedSemaphorePermit>> {
        let networks = &self.limits.networks;
        if !networks.is_empty() && !networks.iter().any(|network| network.contains(peer.ip())) {
            self.counters.foreign.add(1);
            self.flood.log(|| tracing::warn!("{peer} was sent away: it is in none of the networks that are allowed"));
            return None;
        }
        let place = Arc::clone(&self.places).try_acquire_owned().ok();
        if place.is_none() && !self.strangers.send_oldest_away() {
            self.send_away(peer);
            return None;
        }
        // Without these it works, too, only later.
        let _ = stream.set_nodelay(true);
        let keep_alive = TcpKeepalive::new().with_time(Duration::from_secs(30));
        let _ = SockRef::from(stream).set_tcp_keepalive(&keep_alive);
        Some(place)
    }

    fn send_away(&self, peer: SocketAddr) {
        self.counters.crowded.add(1);
        self.flood.log(|| tracing::warn!("{peer} was sent away: {} clients are there already", self.limits.clients));
    }

    async fn attend(
        self: Arc<Self>,
        stream: TcpStream,
        peer: SocketAddr,
        ended: watch::Receiver<bool>,
        place: Option<OwnedSemaphorePermit>,
    ) {
        let place = match place {
            Some(place) => place,
            None => match timeout(GIVING_WAY, Arc::clone(&self.places).acquire_owned()).await {
                Ok(Ok(place)) => place,
                Ok(Err(_)) | Err(_) => return self.send_away(peer),
            },
        };
        let _counted = Counted::new(&self.clients);
        let mut conversation = Conversation::new(&self, peer, stream);
        let end = conversation.hold(ended).await;
        conversation.close(end).await;
        drop(place);
    }
}

/// Counts a client as long as it lives.
struct Counted<'a>(&'a AtomicUsize);

impl<'a> Counted<'a> {
    fn new(count: &'a AtomicUsize) -> Self {
        count.fetch_add(1, Ordering::Relaxed);
        Self(count)
    }
}

impl Drop for Counted<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Opens every address that a text such as `127.0.0.1:10102`, `[::1]:10102` or `localhost:10102` stands for. Where a name stands for
/// several, those of a protocol that this computer does not have are left out.
///
/// # Errors
/// There is no such address here, or its port is in use.
pub async fn listen(address: &str) -> io::Result<Vec<TcpListener>> {
    let mut listeners = Vec::new();
    let mut nowhere = io::Error::from(io::ErrorKind::AddrNotAvailable);
    for address in tokio::net::lookup_host(address).await? {
        match TcpListener::bind(address).await {
            Ok(listener) => listeners.push(listener),
            Err(error) if matches!(error.kind(), io::ErrorKind::AddrNotAvailable | io::ErrorKind::Unsupported) => {
                nowhere = error;
            }
            Err(error) => return Err(error),
        }
    }
    if listeners.is_empty() { Err(nowhere) } else { Ok(listeners) }
}
