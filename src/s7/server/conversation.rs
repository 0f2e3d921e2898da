//! One client of a server: its socket, its session, and when it is left.

use std::net::SocketAddr;
use std::pin::pin;
use std::sync::atomic::Ordering;
use std::time::Duration;

use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::sync::watch;
use tokio::time::{Instant, MissedTickBehavior, interval, sleep, timeout};

use super::{Server, Stations};
use crate::s7::session::{Connection, Session};
use crate::s7::wire::pdu::Answers;
use crate::s7::wire::tpkt::{self, Packet};
use crate::units::Time;

/// Space for what a client has sent: the longest packet of a TPDU of 8192 bytes, or many short ones.
const INPUT: usize = 8192 + tpkt::HEADER;
/// How many refused requests of one client are logged.
const REFUSALS: u32 = 20;

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
}

/// One client.
pub(super) struct Conversation<'a, S> {
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

impl<'a, S: Stations> Conversation<'a, S> {
    pub(super) fn new(server: &'a Server<S>, peer: SocketAddr, stream: TcpStream) -> Self {
        Self {
            server,
            peer,
            stream,
            session: Session::new(server.settings.clone()),
            answers: Answers::default(),
            input: vec![0; INPUT],
            filled: 0,
            refusals: 0,
        }
    }

    /// Says good-bye on TCP.
    pub(super) async fn close(mut self) {
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
            let mut connection = Connection::Open;
            let written =
                self.server.stations.lend(&mut |station| connection = session.receive(packet, station, answers));
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
