//! The requests of a client: their parameter and data parts. The server's direction of the same formats is in `items`, `data` and
//! `user_data`; this module is the reverse, byte for byte as most clients send it.
//!
//! | request | parameter part | data part |
//! |---|---|---|
//! | setup | `F0 00`, jobs in each direction, PDU size | |
//! | read | `04`, count, items | |
//! | write | `05`, count, items | values |
//! | start and named services | `28 00 00 00 00 00 00 FD`, arguments, name | |
//! | stop | `29 00 00 00 00 00`, name | |
//! | upload: start, piece, end | `1D` `1E` `1F` | |
//! | user data | `00 01 12`, group, function, sequence | payload |

use super::data::{SUCCESS, TransportSize, Type};
use super::header::function;
use super::items::{AnyItem, MeasuringSystem, NckItem};
use crate::image::Area;

/// The service that starts and stops the PLC.
pub const PROGRAM: &[u8] = b"P_PROGRAM";
/// The argument of a cold restart.
pub const COLD: &[u8] = b"C ";

impl AnyItem {
    /// Bytes of an item on the wire.
    pub const WIRE: usize = 12;

    /// Its bytes on the wire.
    #[must_use]
    pub fn bytes(&self) -> [u8; Self::WIRE] {
        let (code, block) = match self.area {
            Area::DataBlock(number) => (0x84, number),
            Area::Inputs => (0x81, 0),
            Area::Outputs => (0x82, 0),
            Area::Flags => (0x83, 0),
            Area::Counters => (0x1C, 0),
            Area::Timers => (0x1D, 0),
        };
        let address = match self.area {
            Area::Counters | Area::Timers => self.byte / 2,
            Area::DataBlock(_) | Area::Inputs | Area::Outputs | Area::Flags => self.byte * 8 + u32::from(self.bit),
        };
        let ([c1, c0], [d1, d0], [_, a2, a1, a0]) =
            (self.count.to_be_bytes(), block.to_be_bytes(), address.to_be_bytes());
        [0x12, 10, 0x10, self.kind.code(), c1, c0, d1, d0, code, a2, a1, a0]
    }
}

impl NckItem {
    /// Bytes of an item on the wire.
    pub const WIRE: usize = 10;

    /// Its bytes on the wire.
    #[must_use]
    pub fn bytes(&self) -> [u8; Self::WIRE] {
        let syntax = match self.system {
            MeasuringSystem::Current => 0x82,
            MeasuringSystem::Metric => 0x83,
            MeasuringSystem::Inch => 0x84,
        };
        let ([c1, c0], [l1, l0]) = (self.column.to_be_bytes(), self.line.to_be_bytes());
        [0x12, 8, syntax, self.area << 5 | self.unit & 0x1F, c1, c0, l1, l0, self.module, self.count]
    }
}

impl Type {
    /// Its code.
    #[must_use]
    pub const fn code(self) -> u8 {
        match self {
            Self::Bit => 0x01,
            Self::Byte => 0x02,
            Self::Char => 0x03,
            Self::Word => 0x04,
            Self::Int => 0x05,
            Self::DoubleWord => 0x06,
            Self::DoubleInt => 0x07,
            Self::Real => 0x08,
            Self::Date => 0x09,
            Self::TimeOfDay => 0x0A,
            Self::Time => 0x0B,
            Self::S5Time => 0x0C,
            Self::DateAndTime => 0x0F,
            Self::Counter => 0x1C,
            Self::Timer => 0x1D,
        }
    }
}

/// Setup communication.
#[must_use]
pub fn setup(jobs: u16, pdu: u16) -> [u8; 8] {
    let ([j1, j0], [p1, p0]) = (jobs.to_be_bytes(), pdu.to_be_bytes());
    [function::SETUP, 0, j1, j0, j1, j0, p1, p0]
}

/// Appends one value of a write request. The caller adds fill bytes between values.
pub fn put_value(size: TransportSize, bytes: &[u8], out: &mut Vec<u8>) {
    let [high, low] = size.field(bytes.len()).to_be_bytes();
    out.extend_from_slice(&[0, size.0, high, low]);
    out.extend_from_slice(bytes);
}

/// PLC stop.
#[must_use]
pub fn stop() -> Vec<u8> {
    [&[function::STOP, 0, 0, 0, 0, 0, 9][..], PROGRAM].concat()
}

/// Restart of the PLC.
#[must_use]
pub fn start(arguments: &[u8]) -> Vec<u8> {
    let [high, low] = u16::try_from(arguments.len()).unwrap_or(0).to_be_bytes();
    [&[function::START, 0, 0, 0, 0, 0, 0, 0xFD, high, low], arguments, &[9], PROGRAM].concat()
}

/// The start of an upload of a block, from the module to the client: `0A00031A` for DB31 in the active file system (passive: `P`).
#[must_use]
pub fn start_upload(name: [u8; 8]) -> Vec<u8> {
    [&[function::START_UPLOAD, 0, 0, 0, 0, 0, 0, 0, 9, b'_'], &name[..]].concat()
}

/// The next piece of an upload, or its end.
#[must_use]
pub fn upload(function: u8, number: [u8; 4]) -> [u8; 8] {
    let [a, b, c, d] = number;
    [function, 0, 0, 0, a, b, c, d]
}

/// The name of a block: type `A` for data blocks, and its number.
#[must_use]
pub fn block_name(kind: u8, number: u16) -> [u8; 8] {
    let mut name = [b'0', kind, 0, 0, 0, 0, 0, b'A'];
    let mut rest = number;
    for digit in name[2..7].iter_mut().rev() {
        *digit = b'0' + u8::try_from(rest % 10).unwrap_or(0);
        rest /= 10;
    }
    name
}

/// The parameter part of a user data request.
#[must_use]
pub fn user_data(group: u8, function: u8) -> [u8; 8] {
    [0, 1, 0x12, 4, 0x11, 0x40 | group, function, 0]
}

/// The parameter part of the request for the next part of a long answer.
#[must_use]
pub fn next_part(group: u8, function: u8, sequence: u8, unit: u8) -> [u8; 12] {
    [0, 1, 0x12, 8, 0x12, 0x40 | group, function, sequence, unit, 0, 0, 0]
}

/// The data part of user data.
#[must_use]
pub fn payload(bytes: &[u8]) -> Vec<u8> {
    if bytes.is_empty() {
        return vec![0x0A, 0, 0, 0];
    }
    let [high, low] = TransportSize::OCTETS.field(bytes.len()).to_be_bytes();
    [&[SUCCESS, TransportSize::OCTETS.0, high, low], bytes].concat()
}

/// Encodes a password of eight characters: the first two are XORed with `55`, each further one with `55` and the encoded character two
/// positions before.
#[must_use]
pub fn folded(password: [u8; 8]) -> [u8; 8] {
    let mut folded = password;
    for at in 0..folded.len() {
        let before = if at < 2 { 0 } else { folded[at - 2] };
        folded[at] ^= 0x55 ^ before;
    }
    folded
}
