//! Captures the network traffic in a file for Wireshark (pcap): TCP as on the wire, with handshake, sequence numbers and end of each
//! connection.
//!
//! The server's port is written as 102, whatever it is, because Wireshark recognises S7 communication there. A packet contains what was
//! read or written at once, up to 32 KiB, with the time of the computer's clock. Every packet is written to the file immediately. The file
//! ends at 1 GiB or when the disk is full; this is logged, and the server keeps running.

#![expect(clippy::disallowed_methods, reason = "the packets have the computer's time")]

use std::fs::File;
use std::io::{self, Write};
use std::net::{IpAddr, SocketAddr};
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use etherparse::err::packet::BuildWriteError;
use etherparse::{PacketBuilder, TcpOptionElement};

/// The port of S7 communication (RFC 1006).
const PORT: u16 = 102;
/// Maximum bytes of one packet.
const SEGMENT: usize = 32_768;
/// Maximum size of the file.
const LARGEST: u64 = 1 << 30;
/// Link type: packets begin with IP, version 4 or 6.
const RAW: u32 = 101;
/// Window sizes are in units of 128 bytes.
const WINDOW_SCALE: u8 = 7;

/// A capture of all connections of a server.
#[derive(Debug)]
pub struct Capture(Mutex<Output>);

#[derive(Debug)]
struct Output {
    /// `None` after the end.
    file: Option<File>,
    length: u64,
    last: Duration,
    record: Vec<u8>,
}

impl Capture {
    /// Creates a new file.
    ///
    /// # Errors
    /// It exists already, or cannot be written.
    pub fn create(path: &Path) -> io::Result<Self> {
        Self::into_file(File::create_new(path)?)
    }

    fn into_file(mut file: File) -> io::Result<Self> {
        let mut head = Vec::with_capacity(24);
        // Magic number for microseconds; version 2.4; time zone and accuracy (unused); longest packet; link type.
        for word in [0xA1B2_C3D4_u32, 0x0004_0002, 0, 0, 0x0004_0000, RAW] {
            head.extend(word.to_le_bytes());
        }
        file.write_all(&head)?;
        let output = Output { file: Some(file), length: head.len() as u64, last: Duration::ZERO, record: Vec::new() };
        Ok(Self(Mutex::new(output)))
    }

    /// Begins the connection with this number: three packets.
    pub(super) fn begin(&self, client: SocketAddr, server: SocketAddr, number: u64) -> Recording<'_> {
        let at = |address: SocketAddr, port| SocketAddr::new(address.ip().to_canonical(), port);
        // Ports are reused: different sequence numbers distinguish the connections.
        let start = u32::try_from(number.wrapping_mul(0x0100_0000) & 0xFFFF_FFFF).unwrap_or(0);
        let mut recording = Recording {
            capture: self,
            ends: [at(client, client.port()), at(server, PORT)],
            next: [start, start],
            server_closes: true,
        };
        recording.put(CLIENT, Kind::Begin, &[]);
        recording.put(SERVER, Kind::Accepted, &[]);
        recording.put(CLIENT, Kind::Acknowledge, &[]);
        recording
    }

    fn output(&self) -> MutexGuard<'_, Output> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Output {
    fn put(&mut self, packet: impl FnOnce(&mut Vec<u8>) -> Result<(), BuildWriteError>) {
        let Some(file) = &mut self.file else { return };
        // Time stamps never go back, even if the clock is set back.
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().max(self.last);
        self.last = now;
        let record = &mut self.record;
        record.clear();
        record.resize(16, 0);
        if packet(record).is_err() {
            return; // both addresses have the same family, and a segment is short enough
        }
        let word = |number: u64| u32::try_from(number).unwrap_or(u32::MAX).to_le_bytes();
        let length = word(record.len() as u64 - 16);
        let head = [word(now.as_secs()), word(now.subsec_micros().into()), length, length];
        record[..16].copy_from_slice(head.as_flattened());
        let larger = self.length + record.len() as u64;
        let ended = if larger > LARGEST {
            Some("the maximum file size is reached".to_owned())
        } else {
            file.write_all(record).err().map(|error| format!("the file cannot be written: {error}"))
        };
        match ended {
            None => self.length = larger,
            Some(why) => {
                // Removes an incomplete packet at the end.
                let _ = file.set_len(self.length);
                self.file = None;
                tracing::warn!("the capture ends: {why}; the server keeps running");
            }
        }
    }
}

const CLIENT: usize = 0;
const SERVER: usize = 1;

/// What a TCP packet does besides carrying bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Begin,
    Accepted,
    Acknowledge,
    Data,
    End,
}

/// One connection; its end is written when it is dropped.
#[derive(Debug)]
pub(super) struct Recording<'a> {
    capture: &'a Capture,
    /// Client and server.
    ends: [SocketAddr; 2],
    /// The next sequence number of each.
    next: [u32; 2],
    server_closes: bool,
}

impl Recording<'_> {
    /// The client has sent bytes.
    pub(super) fn received(&mut self, bytes: &[u8]) {
        bytes.chunks(SEGMENT).for_each(|bytes| self.put(CLIENT, Kind::Data, bytes));
    }

    /// The server has sent bytes.
    pub(super) fn sent(&mut self, bytes: &[u8]) {
        bytes.chunks(SEGMENT).for_each(|bytes| self.put(SERVER, Kind::Data, bytes));
    }

    /// The client has closed its side.
    pub(super) fn left(&mut self) {
        self.server_closes = false;
    }

    fn put(&mut self, from: usize, kind: Kind, bytes: &[u8]) {
        let to = 1 - from;
        let (source, target) = (self.ends[from], self.ends[to]);
        let (sequence, acknowledged) = (self.next[from], self.next[to]);
        let taken = match kind {
            Kind::Begin | Kind::Accepted | Kind::End => 1,
            Kind::Acknowledge => 0,
            Kind::Data => u32::try_from(bytes.len()).unwrap_or(0), // at most one segment
        };
        self.next[from] = sequence.wrapping_add(taken);
        self.capture.output().put(|record| {
            let ip = match (source.ip(), target.ip()) {
                (IpAddr::V4(source), IpAddr::V4(target)) => PacketBuilder::ipv4(source.octets(), target.octets(), 64),
                (IpAddr::V6(source), IpAddr::V6(target)) => PacketBuilder::ipv6(source.octets(), target.octets(), 64),
                (IpAddr::V4(_), IpAddr::V6(_)) | (IpAddr::V6(_), IpAddr::V4(_)) => return Ok(()),
            };
            let tcp = ip.tcp(source.port(), target.port(), sequence, u16::MAX);
            let scaled = [TcpOptionElement::WindowScale(WINDOW_SCALE)];
            let tcp = match kind {
                Kind::Begin => {
                    tcp.syn().options(&scaled).map_err(|_| BuildWriteError::Io(io::ErrorKind::Other.into()))?
                }
                Kind::Accepted => tcp
                    .syn()
                    .ack(acknowledged)
                    .options(&scaled)
                    .map_err(|_| BuildWriteError::Io(io::ErrorKind::Other.into()))?,
                Kind::Acknowledge => tcp.ack(acknowledged),
                Kind::Data => tcp.ack(acknowledged).psh(),
                Kind::End => tcp.ack(acknowledged).fin(),
            };
            tcp.write(record, bytes)
        });
    }
}

impl Drop for Recording<'_> {
    fn drop(&mut self) {
        let first = if self.server_closes { SERVER } else { CLIENT };
        self.put(first, Kind::End, &[]);
        self.put(1 - first, Kind::End, &[]);
        self.put(first, Kind::Acknowledge, &[]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `/dev/full` behaves like a full disk: the capture ends, and nothing else is affected.
    #[test]
    #[cfg(target_os = "linux")]
    fn a_full_disk_ends_the_capture_and_nothing_else() {
        let full = || std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        assert!(Capture::into_file(full()).is_err());
        let output = Output { file: Some(full()), length: 24, last: Duration::ZERO, record: Vec::new() };
        let capture = Capture(Mutex::new(output));
        let (client, server) = ("127.0.0.1:50000".parse().unwrap(), "127.0.0.1:10102".parse().unwrap());
        let mut recording = capture.begin(client, server, 1);
        recording.received(&[3, 0, 0, 7, 2, 0xF0, 0x80]);
        drop(recording);
        assert!(capture.output().file.is_none());
    }
}
