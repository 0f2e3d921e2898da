//! One client of a server: its socket, its session, and when it is left.

use std::net::SocketAddr;
use std::pin::pin;
use std::time::Duration;

use tokio::io::{AsyncReadExt, AsyncWrite, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::sync::watch;
use tokio::time::{Instant, MissedTickBehavior, interval, sleep, timeout};

use super::faults::Faulty;
use super::witness::Witness;
use super::{Server, Stations};
use crate::s7::session::{Connection, Session};
use crate::s7::wire::pdu::Answers;
use crate::s7::wire::tpkt::{self, Packet};
use crate::units::Time;

/// Space for what a client has sent: the longest packet of a TPDU of 8192 bytes, or many short ones.
const INPUT: usize = 8192 + tpkt::HEADER;
/// How a conversation ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
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
    /// A fault on purpose.
    Fault,
}

impl End {
    pub(super) const ALL: [Self; 6] = [Self::Left, Self::Closed, Self::Idle, Self::Slow, Self::Server, Self::Fault];

    /// In one word, for whoever counts.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Closed => "closed",
            Self::Idle => "idle",
            Self::Slow => "slow",
            Self::Server => "server",
            Self::Fault => "fault",
        }
    }
}

/// One client.
pub(super) struct Conversation<'a, S> {
    server: &'a Server<S>,
    witness: Witness<'a>,
    faulty: Option<Faulty>,
    stream: TcpStream,
    session: Session,
    answers: Answers,
    /// What has come and is not a whole packet yet.
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
            witness: Witness::new(&server.counters, &server.flood, peer, recording),
            faulty: server.instruments.faults.as_ref().map(|faults| Faulty::new(faults, number)),
            stream,
            session: Session::new(server.settings.clone()),
            answers: Answers::default(),
            input: vec![0; INPUT],
            filled: 0,
        }
    }

    /// Says good-bye on TCP.
    pub(super) async fn close(mut self, end: End) {
        self.witness.ended(end);
        let _ = timeout(self.server.limits.writing, self.stream.shutdown()).await;
    }

    pub(super) async fn hold(&mut self, mut ended: watch::Receiver<bool>) -> End {
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
                        self.witness.received(&self.input[self.filled..self.filled + count]);
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
                Packet::Wrong => return self.end_session().await,
            };
            start += packet.len();
            let (session, answers) = (&mut self.session, &mut self.answers);
            if let Some(faulty) = &mut self.faulty {
                session.fail_next(faulty.failure());
            }
            let known = answers.count();
            let mut connection = Connection::Open;
            let written =
                self.server.stations.lend(&mut |station| connection = session.receive(packet, station, answers));
            self.witness.answered(packet, &self.answers, known, written.is_some());
            if let Some(step) = written {
                let _ = timeout(self.server.limits.step, self.server.stations.taken_up(step)).await;
            }
            if connection == Connection::Closed {
                return self.end_session().await;
            }
        }
        self.input.copy_within(start..self.filled, 0);
        self.filled -= start;
        None
    }

    /// The end of the session; what it answered is still sent.
    async fn end_session(&mut self) -> Option<End> {
        self.send().await.or(Some(End::Closed))
    }

    /// What is due by itself.
    fn push(&mut self) {
        let now = self.server.begin.elapsed().as_millis();
        let now = Time::from_millis(i64::try_from(now).unwrap_or(i64::MAX));
        let (session, answers) = (&mut self.session, &mut self.answers);
        self.server.stations.lend(&mut |station| session.tick(now, station, answers));
        self.witness.pushed(&self.answers);
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

/// Sends bytes, within a limit of time.
pub(super) async fn write(
    stream: &mut (impl AsyncWrite + Unpin),
    bytes: &[u8],
    witness: &mut Witness<'_>,
    limit: Duration,
) -> Option<End> {
    match timeout(limit, stream.write_all(bytes)).await {
        Ok(Ok(())) => {
            witness.sent(bytes);
            None
        }
        Ok(Err(_)) => Some(End::Left),
        Err(_) => Some(End::Slow),
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

impl std::fmt::Display for End {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Left => "has left",
            Self::Closed => "was disconnected: it asked for that, or sent what is no S7 communication",
            Self::Idle => "was disconnected: it asked nothing for too long",
            Self::Slow => "was disconnected: it did not take its answers",
            Self::Server => "was disconnected: the server ends",
            Self::Fault => "was disconnected: a fault on purpose",
        })
    }
}
