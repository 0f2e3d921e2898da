//! TPKT (RFC 1006): the framing of packets in a TCP stream: `03`, a reserved byte, and the length of the whole packet.

/// Bytes before the content of a packet.
pub const HEADER: usize = 4;

/// The shortest packet: its header, and a COTP TPDU with its fixed part.
const SHORTEST: usize = HEADER + 2;

/// The beginning of the received bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packet<'a> {
    /// A complete packet: its content, and its length.
    Whole {
        /// The TPDU.
        content: &'a [u8],
        /// Including the header.
        length: usize,
    },
    /// More bytes are needed.
    Incomplete,
    /// Not a TPKT; the stream cannot be decoded any further.
    Wrong,
}

/// Splits off the first packet.
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
