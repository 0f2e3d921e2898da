//! One client of a server: its socket, its session, and the reasons to close its connection.
//!
//! An idle client costs only its session. The buffers for requests and answers are shared by all clients of a thread, and lent to the
//! client that is being answered ([`Space`]). A client has its own buffer only while one of its packets is incomplete.

use std::cell::Cell;
use std::future::{Future, poll_fn};
use std::io;
use std::net::SocketAddr;
use std::pin::{Pin, pin};
use std::task::{Context, Poll, ready};
use std::time::Duration;

use tokio::io::{AsyncRead, AsyncReadExt, AsyncWriteExt, Interest, ReadBuf, Ready};
use tokio::net::TcpStream;
use tokio::sync::watch;
use tokio::task::yield_now;
use tokio::time::{Instant, Interval, MissedTickBehavior, interval, sleep, timeout};

use super::end::End;
use super::faults::Faulty;
use super::sending::write;
use super::strangers::Stranger;
use super::witness::Witness;
use super::{Server, Stations};
use crate::s7::session::{Connection, Session};
use crate::s7::station::Station;
use crate::s7::wire::header::{PROTOCOL, function, kind};
use crate::s7::wire::pdu::Answers;
use crate::s7::wire::tpkt::{self, Packet};
use crate::units::Time;

/// Size of the input buffer: the longest packet of a TPDU of 8192 bytes, or many short ones.
const INPUT: usize = 8192 + tpkt::HEADER;
/// Bytes of answers after which they are sent and other clients get their turn.
const TURN: usize = 32 * 1024;
/// The idle time is divided into this many parts: the clock is read once per part, not for each request.
const PARTS: u32 = 8;
/// Polling interval of subscriptions.
const PUSHES: Duration = Duration::from_millis(10);
/// How long the server still reads from a client that is being disconnected.
const LAST_READS: Duration = Duration::from_millis(200);

/// Polling interval for the end of a connection whose requests are not read yet.
const CLOSING: Duration = Duration::from_millis(20);

thread_local! {
    /// The buffers of this thread, while no client uses them.
    static SPACE: Cell<Space> = const { Cell::new((Vec::new(), None)) };
}

/// Buffers for input and answers. If one client waits in the middle of its turn, a second client gets new buffers.
type Space = (Vec<u8>, Option<Answers>);

/// One client.
pub(super) struct Conversation<'a, S> {
    server: &'a Server<S>,
    /// Present until the first request; taken when the conversation starts.
    stranger: Option<Stranger<'a>>,
    witness: Witness<'a>,
    faulty: Option<Faulty>,
    stream: TcpStream,
    session: Session,
    answers: Answers,
    /// Bytes of an incomplete packet: an own buffer of exactly their size, or the buffer of the thread, partly filled.
    input: Vec<u8>,
    filled: usize,
}

impl<'a, S: Stations> Conversation<'a, S> {
    pub(super) fn new(server: &'a Server<S>, peer: SocketAddr, stream: TcpStream) -> Self {
        let number = server.counters.connections.next();
        let capture = server.instruments.capture.as_ref();
        let recording = capture.zip(stream.local_addr().ok()).map(|(capture, own)| capture.begin(peer, own, number));
        Self {
            server,
            stranger: Some(server.strangers.meet(number)),
            witness: Witness::new(&server.counters, &server.flood, peer, recording),
            faulty: server.instruments.faults.as_ref().map(|faults| Faulty::new(faults, number)),
            stream,
            session: Session::new(server.settings.clone()),
            answers: Answers::default(),
            input: Vec::new(),
            filled: 0,
        }
    }

    /// Closes the TCP connection. A client that is disconnected while it is still sending has a moment to read the last answers: unread
    /// bytes would reset the connection, and the answers in transit would be lost.
    pub(super) async fn close(mut self, end: End) {
        self.witness.ended(end);
        let _ = timeout(self.server.limits.writing, self.stream.shutdown()).await;
        if end == End::Closed {
            let mut unread = [0; 512];
            let rest = async { while matches!(self.stream.read(&mut unread).await, Ok(1..)) {} };
            let _ = timeout(LAST_READS, rest).await;
        }
    }

    pub(super) async fn hold(&mut self, ended: watch::Receiver<bool>) -> End {
        let limits = &self.server.limits;
        let (mut allowed, mut is_quiet) = (limits.greeting.min(limits.idle), true);
        let mut stranger = self.stranger.take();
        let mut last = Instant::now();
        let mut idle = pin!(sleep(allowed / PARTS));
        let mut pushes = None;
        let mut end = pin!(until(ended));
        loop {
            let mut is_full = false;
            tokio::select! {
                biased;
                read = poll_fn(|cx| self.poll_read(cx)) => match read {
                    Ok(0) | Err(_) => return End::Left,
                    Ok(count) => {
                        self.witness.received(&self.input[self.filled..self.filled + count]);
                        self.filled += count;
                        is_full = self.filled == self.input.len();
                        if let Some(end) = self.receive(end.as_mut()).await {
                            return end;
                        }
                    }
                },
                () = &mut end => return End::Server,
                () = turn(stranger.as_ref()), if stranger.is_some() => return End::GaveWay,
                () = due(&mut pushes), if self.session.has_subscriptions() => self.push(),
                () = &mut idle => {
                    let now = Instant::now();
                    if !is_quiet || self.session.has_subscriptions() {
                        (is_quiet, last) = (true, now);
                    } else if now - last >= allowed {
                        return End::Idle;
                    }
                    idle.as_mut().reset(now + allowed / PARTS);
                }
            }
            if is_full {
                // The client may continue without end: yield to other clients, and to the events that wait here.
                yield_now().await;
                if poll_fn(|cx| Poll::Ready(end.as_mut().poll(cx).is_ready())).await {
                    return self.send().await.unwrap_or(End::Server);
                }
                if self.session.has_subscriptions() {
                    self.push();
                }
            }
            if !self.answers.is_empty() {
                is_quiet = false;
                stranger = None;
                if allowed != limits.idle {
                    allowed = limits.idle;
                    idle.as_mut().reset(Instant::now() + allowed / PARTS);
                }
                if let Some(end) = self.send().await {
                    return end;
                }
            }
            self.give_space_back();
        }
    }

    /// Reads into the buffer of the thread.
    fn poll_read(&mut self, cx: &mut Context<'_>) -> Poll<io::Result<usize>> {
        ready!(self.stream.poll_read_ready(cx))?;
        self.take_space();
        let mut space = ReadBuf::new(&mut self.input[self.filled..]);
        let read = Pin::new(&mut self.stream).poll_read(cx, &mut space);
        let count = space.filled().len();
        if read.is_pending() {
            self.give_space_back();
        }
        read.map_ok(|()| count)
    }

    fn take_space(&mut self) {
        if self.input.len() == INPUT {
            return;
        }
        let (mut input, answers) = SPACE.take();
        input.resize(INPUT, 0);
        input[..self.filled].copy_from_slice(&self.input[..self.filled]);
        self.input = input;
        self.answers = answers.unwrap_or_default();
    }

    /// Ends a turn: all answers have been sent.
    fn give_space_back(&mut self) {
        if self.input.len() == INPUT {
            let rest = self.input[..self.filled].to_vec();
            SPACE.set((std::mem::replace(&mut self.input, rest), Some(std::mem::take(&mut self.answers))));
        }
    }

    /// Passes the input to the session. Reads that arrive together see the same step. Writes that arrive together are executed in the same
    /// step, and any other request after them sees their result.
    async fn receive(&mut self, mut end: Pin<&mut impl Future<Output = ()>>) -> Option<End> {
        let mut start = 0;
        let mut owed = None;
        while start < self.filled {
            let rest = &self.input[start..self.filled];
            let length = match tpkt::split(rest) {
                Packet::Whole { length, .. } => length,
                Packet::Incomplete if !is_too_long(rest) => break,
                Packet::Incomplete | Packet::Wrong => {
                    self.settle(&mut owed).await;
                    return self.end_session().await;
                }
            };
            if owed.is_some() && !is_write(&rest[..length]) {
                self.settle(&mut owed).await;
            }
            let (answered, connection, written) = self.answer(start, length);
            start += answered;
            owed = written.or(owed);
            if let Some(guess) = self.session.take_guess() {
                let address = self.witness.peer().ip().to_canonical();
                tokio::select! {
                    () = self.server.guesses.wait(address, guess) => {}
                    () = closes(&self.stream) => return Some(End::Left),
                    () = end.as_mut() => return Some(End::Server),
                }
            }
            if connection == Connection::Closed {
                self.settle(&mut owed).await;
                return self.end_session().await;
            }
            if self.answers.bytes().len() >= TURN {
                self.settle(&mut owed).await;
                if let Some(end) = self.send().await {
                    return Some(end);
                }
                yield_now().await;
            }
        }
        self.settle(&mut owed).await;
        self.input.copy_within(start..self.filled, 0);
        self.filled -= start;
        None
    }

    /// Answers the packet of this length, and all further reads if it is a read. Returns the number of bytes, whether the connection
    /// continues, and the step that executes the writes.
    fn answer(&mut self, start: usize, length: usize) -> (usize, Connection, Option<u64>) {
        let Self { server, witness, faulty, session, answers, input, filled, .. } = self;
        let mut rest = &input[start..*filled];
        let (mut length, mut answered, mut known) = (length, 0, 0);
        let mut connection = Connection::Open;
        let peer = witness.peer();
        let mut work = |station: &mut dyn Station| loop {
            let packet = &rest[..length];
            if let Some(failure) = faulty.as_mut().and_then(|faulty| faulty.failure(session.requests())) {
                session.fail_next(failure);
            }
            known = answers.count();
            connection = session.receive(packet, station, answers);
            rest = &rest[length..];
            answered += length;
            match tpkt::split(rest) {
                Packet::Whole { length: next, .. }
                    if connection == Connection::Open
                        && is_read(packet)
                        && is_read(&rest[..next])
                        && answers.bytes().len() < TURN =>
                {
                    witness.answered(packet, answers, known, false);
                    length = next;
                }
                _ => break,
            }
        };
        let written = server.stations.lend_to(peer, &mut work);
        let answered = answered.max(length); // skip the packet if no station was lent
        let last = &input[start + answered - length..start + answered];
        witness.answered(last, answers, known, written.is_some());
        (answered, connection, written)
    }

    /// Waits for the step that executes the writes.
    async fn settle(&self, owed: &mut Option<u64>) {
        if let Some(step) = owed.take() {
            let Server { stations, limits, .. } = self.server;
            while timeout(limits.step, stations.taken_up(step)).await.is_err() && stations.is_crowded() {}
        }
    }

    /// Ends the session; its last answers are still sent.
    async fn end_session(&mut self) -> Option<End> {
        self.send().await.or(Some(End::Closed))
    }

    /// Sends the updates that are due.
    fn push(&mut self) {
        let now = self.server.begin.elapsed().as_millis();
        let now = Time::from_millis(i64::try_from(now).unwrap_or(i64::MAX));
        self.take_space();
        let known = self.answers.count();
        let (session, answers) = (&mut self.session, &mut self.answers);
        self.server.stations.lend(&mut |station| session.tick(now, station, answers));
        self.witness.pushed(self.answers.count() - known);
    }

    async fn send(&mut self) -> Option<End> {
        let Self { stream, answers, witness, faulty, .. } = self;
        let limit = self.server.limits.writing;
        witness.answering(answers);
        let end = match faulty {
            None => write(stream, answers.bytes(), witness, limit).await,
            Some(faulty) => faulty.send(stream, answers, witness, limit).await,
        };
        answers.clear();
        end
    }
}

/// Waits for the end of the server.
async fn until(mut ended: watch::Receiver<bool>) {
    let _ = ended.wait_for(|ended| *ended).await;
}

/// Waits until the client closes its connection, without reading what it has sent.
async fn closes(stream: &TcpStream) {
    // It stays readable while it has unread bytes, so it is asked again only after a pause.
    while !stream.ready(Interest::READABLE).await.is_ok_and(Ready::is_read_closed) {
        sleep(CLOSING).await;
    }
}

/// Waits until a client without a request must disconnect.
async fn turn(stranger: Option<&Stranger<'_>>) {
    match stranger {
        Some(stranger) => stranger.gives_way().await,
        None => std::future::pending().await,
    }
}

/// Waits until subscriptions are due; without subscriptions no timer runs.
async fn due(pushes: &mut Option<Interval>) {
    let pushes = pushes.get_or_insert_with(|| {
        let mut pushes = interval(PUSHES);
        pushes.set_missed_tick_behavior(MissedTickBehavior::Delay);
        pushes
    });
    pushes.tick().await;
}

/// Whether a packet is a complete write job and nothing else: its answer does not depend on the memory.
fn is_write(packet: &[u8]) -> bool {
    job_of(packet) == Some(function::WRITE)
}

/// Whether a packet is a complete read job and nothing else: it changes nothing.
fn is_read(packet: &[u8]) -> bool {
    job_of(packet) == Some(function::READ)
}

/// The function of the job that begins in a packet.
fn job_of(packet: &[u8]) -> Option<u8> {
    match packet.get(tpkt::HEADER..)? {
        [2, 0xF0, 0x80, PROTOCOL, kind::JOB, _, _, _, _, _, _, _, _, function, ..] => Some(*function),
        _ => None,
    }
}

/// Whether a packet that has begun does not fit.
fn is_too_long(bytes: &[u8]) -> bool {
    matches!(bytes, [_, _, high, low, ..] if usize::from(u16::from_be_bytes([*high, *low])) > INPUT)
}
