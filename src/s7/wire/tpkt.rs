//! TPKT (RFC 1006): how packets are told apart in a stream of TCP. `03`, a reserved byte, and the length of the whole packet.

/// Bytes before the packet's content.
pub const HEADER: usize = 4;

/// The shortest packet: its header, and a TPDU of COTP with its fixed part.
const SHORTEST: usize = HEADER + 2;

/// What stands at the beginning of the bytes received.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packet<'a> {
    /// A whole packet: its content, and how many bytes it took.
    Whole {
        /// The TPDU.
        content: &'a [u8],
        /// With the header.
        length: usize,
    },
    /// More bytes must come.
    Incomplete,
    /// This is no TPKT; the stream cannot be followed any more.
    Wrong,
}

/// Takes the first packet off.
#[must_use]
pub fn split(bytes: &[u8]) -> Packet<'_> {
    match bytes {
        [version, ..] if *version != 3 => Packet::Wrong,
        [_, _, high, low, ..] => {
            let length = usize::from(u16::from_be_bytes([*high, *low]));
            if length < SHORTEST {
                return Packet::Wrong;
            }
            match bytes.get(HEADER..length) {
                Some(content) => Packet::Whole { content, length },
                None => Packet::Incomplete,
            }
        }
        _ => Packet::Incomplete,
    }
}

/// Appends a packet.
pub fn put(out: &mut Vec<u8>, parts: [&[u8]; 2]) {
    let length = HEADER + parts[0].len() + parts[1].len();
    let length = u16::try_from(length).unwrap_or(u16::MAX); // a TPDU has at most 8192 bytes
    out.extend_from_slice(&[3, 0]);
    out.extend_from_slice(&length.to_be_bytes());
    out.extend_from_slice(parts[0]);
    out.extend_from_slice(parts[1]);
}
