//! Observes a conversation: counters, log and capture.
//!
//! A client with many errors does not fill the log: only the first [`REFUSALS`] of a connection are logged, and at most [`LINES`] lines per
//! second for all clients together, with the number of omitted lines. All events are counted.

use std::net::SocketAddr;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use tokio::time::Instant;

use super::capture::Recording;
use super::counters::Counters;
use super::end::End;
use super::refusals::{asked, refusals, written};
use crate::s7::wire::cotp::Tpdu;
use crate::s7::wire::pdu::Answers;
use crate::s7::wire::tpkt::{self, Packet};

/// Maximum number of logged refusals per connection.
const REFUSALS: u32 = 20;
/// Maximum number of log lines about clients per second.
const LINES: u32 = 100;

/// Observes one client.
#[derive(Debug)]
pub(super) struct Witness<'a> {
    counters: &'a Counters,
    flood: &'a Flood,
    peer: SocketAddr,
    recording: Option<Recording<'a>>,
    refusals: u32,
    farewell: Option<String>,
}

impl<'a> Witness<'a> {
    pub(super) fn new(
        counters: &'a Counters,
        flood: &'a Flood,
        peer: SocketAddr,
        recording: Option<Recording<'a>>,
    ) -> Self {
        flood.log(|| tracing::info!("{peer} connected"));
        Self { counters, flood, peer, recording, refusals: 0, farewell: None }
    }

    /// The address of the client.
    pub(super) const fn peer(&self) -> SocketAddr {
        self.peer
    }

    /// Bytes were received.
    pub(super) fn received(&mut self, bytes: &[u8]) {
        self.counters.received.add(bytes.len());
        if let Some(recording) = &mut self.recording {
            recording.received(bytes);
        }
    }

    /// A packet was answered. The answers after the first `known` belong to it; `wrote` is whether it changed the machine.
    pub(super) fn answered(&mut self, packet: &[u8], answers: &Answers, known: usize, wrote: bool) {
        if wrote {
            self.counters.writes.add(1);
            if tracing::enabled!(tracing::Level::DEBUG)
                && let Some(written) = written(packet)
            {
                self.flood.log(|| tracing::debug!("{} wrote {written}", self.peer));
            }
        }
        for answer in answers.since(known) {
            self.farewell = farewell(packet, answer).or_else(|| self.farewell.take());
            refusals(answer, |item, refused| {
                self.counters.refused(refused);
                if self.refusals < REFUSALS && tracing::enabled!(tracing::Level::INFO) {
                    self.refusals += 1;
                    let (asked, meaning) = (asked(packet, item), refused.meaning());
                    self.flood.log(|| tracing::info!("{} refused: {asked}: {refused}, {meaning}", self.peer));
                    if self.refusals == REFUSALS {
                        self.flood.log(|| tracing::info!("{}: further refusals are not logged", self.peer));
                    }
                }
            });
        }
    }

    /// Updates are to be sent.
    pub(super) fn pushed(&self, count: usize) {
        self.counters.pushes.add(count);
    }

    /// Answers are to be sent.
    pub(super) fn answering(&self, answers: &Answers) {
        self.counters.answers.add(answers.count());
    }

    /// Bytes were sent.
    pub(super) fn sent(&mut self, bytes: &[u8]) {
        self.counters.sent.add(bytes.len());
        if let Some(recording) = &mut self.recording {
            recording.sent(bytes);
        }
    }

    /// A fault was injected.
    pub(super) fn fault(&self) {
        self.counters.faults.add(1);
    }

    /// The conversation has ended.
    pub(super) fn ended(&mut self, end: End) {
        let index = End::ALL.iter().position(|each| *each == end);
        if let Some(count) = index.and_then(|index| self.counters.ends.get(index)) {
            count.add(1);
        }
        if let (End::Left, Some(recording)) = (end, &mut self.recording) {
            recording.left();
        }
        let farewell = self.farewell.take().filter(|_| end == End::Closed);
        self.flood.log(|| match farewell {
            Some(farewell) => tracing::info!("{} {farewell}", self.peer),
            None => tracing::info!("{} {end}", self.peer),
        });
    }
}

/// The log text for a connection that ends with this answer; `None` for any other answer.
fn farewell(packet: &[u8], answer: &[u8]) -> Option<String> {
    let tpdu = |packet| match tpkt::split(packet) {
        Packet::Whole { content, .. } => Tpdu::parse(content),
        Packet::Incomplete | Packet::Wrong => Tpdu::Malformed,
    };
    match (tpdu(packet), tpdu(answer)) {
        (Tpdu::ConnectionRequest(request), Tpdu::DisconnectRequest { .. }) => Some(match request.called {
            Some(&[kind, place]) => {
                let (rack, slot) = (place >> 5, place & 0x1F);
                format!("rejected: no module at TSAP {kind:02X}{place:02X} (rack {rack}, slot {slot})")
            }
            _ => "rejected: no TSAP of a module in the connection request".to_owned(),
        }),
        (Tpdu::DisconnectRequest { .. }, _) => Some("disconnected with a disconnect request".to_owned()),
        _ => None,
    }
}

/// Limits the log lines of all clients together.
#[derive(Debug)]
pub(super) struct Flood(Mutex<Shown>);

#[derive(Debug)]
struct Shown {
    since: Instant,
    shown: u32,
    left_out: u64,
}

impl Default for Flood {
    fn default() -> Self {
        Self(Mutex::new(Shown { since: Instant::now(), shown: 0, left_out: 0 }))
    }
}

impl Flood {
    /// Logs a line, unless there were too many in this second.
    pub(super) fn log(&self, line: impl FnOnce()) {
        let mut shown = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if shown.since.elapsed() >= Duration::from_secs(1) {
            if shown.left_out > 0 {
                tracing::warn!("{} more log lines about clients were omitted", shown.left_out);
            }
            *shown = Shown { since: Instant::now(), shown: 0, left_out: 0 };
        }
        if shown.shown < LINES {
            shown.shown += 1;
            line();
        } else {
            shown.left_out += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flood_leaves_a_short_log() {
        let (flood, mut lines) = (Flood::default(), 0);
        (0..1000).for_each(|_| flood.log(|| lines += 1));
        assert!((LINES..1000).contains(&lines), "{lines}"); // a slow computer may need a second second
    }
}
