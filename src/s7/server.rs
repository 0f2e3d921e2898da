//! Sessions on TCP: who may come, how long anybody may take, and how it ends. What the clients see is lent by [`Stations`], one
//! request at a time.
//!
//! | what | and why |
//! |---|---|
//! | one request, one loan | what it reads is of one step, and what it writes is taken up whole |
//! | an answer to a write waits until the write was taken up | who writes and then reads finds what was written |
//! | answers leave in one write, in order; no delay of TCP | clients that read once find all of it |
//! | a client that does not take its answers is not read any more, and is left after a while | it holds up nobody else |
//! | idle is who got no answer for long, not who has sent nothing | half packets keep no place |
//! | who waits for values that change is never idle; keep-alive of TCP finds out who has gone | panels stay connected over night |
//!
//! Nothing here knows a machine; it is the only file of the room that knows a clock.

use std::future::Future;
use std::io;
use std::net::{IpAddr, SocketAddr};
use std::pin::pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::Duration;

use socket2::{SockRef, TcpKeepalive};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore, watch};
use tokio::task::JoinSet;
use tokio::time::{Instant, MissedTickBehavior, interval, sleep, timeout};

use super::session::{Connection, Session, Settings};
use super::station::Station;
use super::wire::pdu::Answers;
use super::wire::tpkt::{self, Packet};
use crate::units::Time;

/// Space for what a client has sent: the longest packet of a TPDU of 8192 bytes, or many short ones.
const INPUT: usize = 8192 + tpkt::HEADER;
/// How many refused requests of one client are logged.
const REFUSALS: u32 = 20;

/// Whoever has stations to lend.
pub trait Stations: Send + Sync + 'static {
    /// Lends a station, which nobody else changes meanwhile. Gives the number of the step that takes up what was written;
    /// nothing where nothing was written.
    fn lend(&self, work: &mut dyn FnMut(&mut dyn Station)) -> Option<u64>;

    /// Waits until that step is over.
    fn taken_up(&self, step: u64) -> impl Future<Output = ()> + Send;
}

/// What a server allows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Clients at once; one more is sent away.
    pub clients: usize,
    /// From which networks they may come; from all where there is none.
    pub networks: Vec<Network>,
    /// How long a client may stay silent.
    pub idle: Duration,
    /// How long the first request may take.
    pub greeting: Duration,
    /// How long a client may take to take an answer.
    pub writing: Duration,
    /// How long an answer waits for the step that takes up a write.
    pub step: Duration,
    /// How long requests on their way have when the server ends.
    pub end: Duration,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            clients: 64,
            networks: Vec::new(),
            idle: Duration::from_mins(10),
            greeting: Duration::from_secs(10),
            writing: Duration::from_secs(5),
            step: Duration::from_secs(1),
            end: Duration::from_secs(2),
        }
    }
}

/// Addresses that begin alike: `192.168.0.0/24`, `fd00::/8`, or one address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Network {
    address: IpAddr,
    bits: u32,
}

impl Network {
    /// Whether an address is in it. IPv4 in IPv6 (`::ffff:192.168.0.1`) counts as IPv4.
    #[must_use]
    pub fn contains(&self, address: IpAddr) -> bool {
        match (self.address, address.to_canonical()) {
            (IpAddr::V4(own), IpAddr::V4(other)) => {
                u64::from(own.to_bits() ^ other.to_bits()) >> 32_u32.saturating_sub(self.bits) == 0
            }
            (IpAddr::V6(own), IpAddr::V6(other)) => {
                (own.to_bits() ^ other.to_bits()).checked_shr(128_u32.saturating_sub(self.bits)).unwrap_or(0) == 0
            }
            (IpAddr::V4(_), IpAddr::V6(_)) | (IpAddr::V6(_), IpAddr::V4(_)) => false,
        }
    }
}

impl std::str::FromStr for Network {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("expected an address or a network such as 192.168.0.0/24 or fd00::/8, found {text}");
        let (address, bits) = text.split_once('/').map_or((text, None), |(address, bits)| (address, Some(bits)));
        let address: IpAddr = address.parse().map_err(|_| wrong())?;
        let most = if address.is_ipv4() { 32 } else { 128 };
        let bits = bits.map_or(Ok(most), str::parse).map_err(|_| wrong())?;
        if bits > most { Err(wrong()) } else { Ok(Self { address, bits }) }
    }
}

/// A server of S7 communication.
#[derive(Debug)]
pub struct Server<S> {
    stations: S,
    settings: Settings,
    limits: Limits,
    places: Arc<Semaphore>,
    clients: AtomicUsize,
    answers: AtomicU64,
    begin: Instant,
}

/// How a conversation ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    /// The client has gone.
    Left,
    /// The session ended: a disconnect request, or bytes of something else.
    Closed,
    /// It asked nothing for too long.
    Idle,
    /// It did not take its answers.
    Slow,
    /// The server ends.
    Server,
}

impl<S: Stations> Server<S> {
    /// A server that nobody can reach yet.
    #[must_use]
    pub fn new(stations: S, settings: Settings, limits: Limits) -> Self {
        let places = Arc::new(Semaphore::new(limits.clients.min(Semaphore::MAX_PERMITS)));
        let begin = Instant::now();
        Self { stations, settings, limits, places, clients: AtomicUsize::new(0), answers: AtomicU64::new(0), begin }
    }

    /// How many clients there are now.
    #[must_use]
    pub fn clients(&self) -> usize {
        self.clients.load(Ordering::Relaxed)
    }

    /// How many answers were given so far.
    #[must_use]
    pub fn answers(&self) -> u64 {
        self.answers.load(Ordering::Relaxed)
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

    /// A place for a client, if it may come.
    fn admit(&self, stream: &TcpStream, peer: SocketAddr) -> Option<OwnedSemaphorePermit> {
        let networks = &self.limits.networks;
        if !networks.is_empty() && !networks.iter().any(|network| network.contains(peer.ip())) {
            tracing::warn!("{peer} was sent away: it is in none of the networks that are allowed");
            return None;
        }
        let Ok(place) = Arc::clone(&self.places).try_acquire_owned() else {
            tracing::warn!("{peer} was sent away: {} clients are there already", self.limits.clients);
            return None;
        };
        // Without these it works, too, only later.
        let _ = stream.set_nodelay(true);
        let keep_alive = TcpKeepalive::new().with_time(Duration::from_secs(30));
        let _ = SockRef::from(stream).set_tcp_keepalive(&keep_alive);
        Some(place)
    }

    async fn attend(
        self: Arc<Self>,
        stream: TcpStream,
        peer: SocketAddr,
        ended: watch::Receiver<bool>,
        place: OwnedSemaphorePermit,
    ) {
        let _counted = Counted::new(&self.clients);
        tracing::info!("{peer} has come");
        let mut conversation = Conversation {
            server: &self,
            peer,
            stream,
            session: Session::new(self.settings.clone()),
            answers: Answers::default(),
            input: vec![0; INPUT],
            filled: 0,
            refusals: 0,
        };
        let end = conversation.hold(ended).await;
        let _ = timeout(self.limits.writing, conversation.stream.shutdown()).await;
        tracing::info!("{peer} {end}");
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

/// One client.
struct Conversation<'a, S> {
    server: &'a Server<S>,
    peer: SocketAddr,
    stream: TcpStream,
    session: Session,
    answers: Answers,
    /// What has come and is not a whole packet yet.
    input: Vec<u8>,
    filled: usize,
    refusals: u32,
}

impl<S: Stations> Conversation<'_, S> {
    async fn hold(&mut self, mut ended: watch::Receiver<bool>) -> End {
        let limits = &self.server.limits;
        let mut allowed = limits.greeting;
        let mut last = Instant::now();
        let mut idle = pin!(sleep(allowed));
        let mut pushes = interval(Duration::from_millis(10));
        pushes.set_missed_tick_behavior(MissedTickBehavior::Delay);
        loop {
            tokio::select! {
                biased;
                () = until(&mut ended) => return End::Server,
                _ = pushes.tick(), if self.session.has_subscriptions() => self.push(),
                read = self.stream.read(&mut self.input[self.filled..]) => match read {
                    Ok(0) | Err(_) => return End::Left,
                    Ok(count) => {
                        self.filled += count;
                        if let Some(end) = self.receive().await {
                            return end;
                        }
                    }
                },
                () = &mut idle => {
                    let waits = self.session.has_subscriptions();
                    if last.elapsed() >= allowed && !waits {
                        return End::Idle;
                    }
                    idle.as_mut().reset(if waits { Instant::now() } else { last } + allowed);
                }
            }
            if !self.answers.is_empty() {
                last = Instant::now();
                if allowed != limits.idle {
                    allowed = limits.idle;
                    idle.as_mut().reset(last + allowed);
                }
                if let Some(end) = self.send().await {
                    return end;
                }
            }
        }
    }

    /// Gives the session what has come, packet by packet: each sees its own step.
    async fn receive(&mut self) -> Option<End> {
        let mut start = 0;
        while start < self.filled {
            let rest = &self.input[start..self.filled];
            let packet = match tpkt::split(rest) {
                Packet::Whole { length, .. } => &rest[..length],
                Packet::Incomplete if is_too_long(rest) => return Some(End::Closed),
                Packet::Incomplete => break,
                Packet::Wrong => return self.close().await,
            };
            start += packet.len();
            let (session, answers) = (&mut self.session, &mut self.answers);
            let mut connection = Connection::Open;
            let written =
                self.server.stations.lend(&mut |station| connection = session.receive(packet, station, answers));
            if let Some(step) = written {
                let _ = timeout(self.server.limits.step, self.server.stations.taken_up(step)).await;
            }
            if connection == Connection::Closed {
                return self.close().await;
            }
        }
        self.input.copy_within(start..self.filled, 0);
        self.filled -= start;
        None
    }

    /// The end of the session; what it answered is still sent.
    async fn close(&mut self) -> Option<End> {
        self.send().await.or(Some(End::Closed))
    }

    /// What is due by itself.
    fn push(&mut self) {
        let now = self.server.begin.elapsed().as_millis();
        let now = Time::from_millis(i64::try_from(now).unwrap_or(i64::MAX));
        let (session, answers) = (&mut self.session, &mut self.answers);
        self.server.stations.lend(&mut |station| session.tick(now, station, answers));
    }

    async fn send(&mut self) -> Option<End> {
        self.log_refusals();
        self.server.answers.fetch_add(self.answers.count() as u64, Ordering::Relaxed);
        let writing = self.stream.write_all(self.answers.bytes());
        let end = match timeout(self.server.limits.writing, writing).await {
            Ok(Ok(())) => None,
            Ok(Err(_)) => Some(End::Left),
            Err(_) => Some(End::Slow),
        };
        self.answers.clear();
        end
    }

    fn log_refusals(&mut self) {
        if self.refusals >= REFUSALS || !tracing::enabled!(tracing::Level::INFO) {
            return;
        }
        for refusal in self.answers.iter().filter_map(refusal) {
            self.refusals += 1;
            tracing::info!("{}: a request was refused: {refusal}", self.peer);
            if self.refusals == REFUSALS {
                tracing::info!("{}: further refusals are not shown", self.peer);
                return;
            }
        }
    }
}

/// Waits for the end of the server.
async fn until(ended: &mut watch::Receiver<bool>) {
    let _ = ended.wait_for(|ended| *ended).await;
}

/// Whether a packet that has begun would not fit.
fn is_too_long(bytes: &[u8]) -> bool {
    matches!(bytes, [_, _, high, low, ..] if usize::from(u16::from_be_bytes([*high, *low])) > INPUT)
}

/// What an answer refuses: the error in its header, or the first item that was not written.
fn refusal(answer: &[u8]) -> Option<String> {
    let pdu = answer.get(tpkt::HEADER + 3..)?;
    match pdu {
        [0x32, 2 | 3, _, _, _, _, _, _, _, _, class, code, ..] if (*class, *code) != (0, 0) => {
            Some(format!("error {class:02X}{code:02X}"))
        }
        [0x32, 3, _, _, _, _, _, _, _, _, 0, 0, 5, _, items @ ..] => {
            let item = items.iter().position(|code| *code != 0xFF)?;
            Some(format!("item {} was not written, return code {:02X}", item + 1, items[item]))
        }
        _ => None,
    }
}

impl std::fmt::Display for End {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Left => "has left",
            Self::Closed => "was disconnected: it asked for that, or sent what is no S7 communication",
            Self::Idle => "was disconnected: it asked nothing for too long",
            Self::Slow => "was disconnected: it did not take its answers",
            Self::Server => "was disconnected: the server ends",
        })
    }
}

/// Opens every address that a text such as `127.0.0.1:10102`, `[::1]:10102` or `localhost:10102` stands for.
///
/// # Errors
/// There is no such address here, or its port is in use.
pub async fn listen(address: &str) -> io::Result<Vec<TcpListener>> {
    let mut listeners = Vec::new();
    for address in tokio::net::lookup_host(address).await? {
        listeners.push(TcpListener::bind(address).await?);
    }
    Ok(listeners)
}
