//! The client's side of the transport, without a socket: bytes in, complete S7 PDUs out. All input is bounded: a packet by its two-byte
//! length field, a PDU in pieces by the maximum length of a PDU.

use crate::s7::wire::cotp::{ConnectionConfirm, Tpdu};
use crate::s7::wire::tpkt::{self, Packet};

/// The longest PDU that is reassembled. Some servers send longer answers than agreed; they are accepted up to this length.
const LONGEST: usize = 65_536;

/// An event of the stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Event<'a> {
    /// The server accepts the connection.
    Confirmed(ConnectionConfirm),
    /// An S7 PDU.
    Pdu(&'a [u8]),
}

/// The reason why the stream cannot be decoded any further.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Broken {
    /// A protocol other than S7 communication.
    Foreign,
    /// A PDU that is too long.
    TooLong,
    /// The server disconnects.
    Disconnected,
}

impl Broken {
    pub(super) const fn words(self) -> &'static str {
        match self {
            Self::Foreign => "the answer is not S7 communication",
            Self::TooLong => "a PDU is longer than the maximum",
            Self::Disconnected => "the server disconnected",
        }
    }
}

/// Received bytes of an incomplete packet or PDU.
#[derive(Debug, Default)]
pub(super) struct Conversation {
    input: Vec<u8>,
    pieces: Vec<u8>,
}

impl Conversation {
    /// Takes received bytes in pieces of any size, and reports every complete event.
    pub(super) fn receive(&mut self, bytes: &[u8], mut tell: impl FnMut(Event<'_>)) -> Result<(), Broken> {
        let mut input = std::mem::take(&mut self.input);
        input.extend_from_slice(bytes);
        let mut start = 0;
        loop {
            match tpkt::split(&input[start..]) {
                Packet::Whole { content, length } => {
                    self.tpdu(content, &mut tell)?;
                    start += length;
                }
                Packet::Incomplete => break,
                Packet::Wrong => return Err(Broken::Foreign),
            }
        }
        input.drain(..start);
        self.input = input;
        Ok(())
    }

    fn tpdu(&mut self, content: &[u8], tell: &mut impl FnMut(Event<'_>)) -> Result<(), Broken> {
        if let Some(confirm) = ConnectionConfirm::parse(content) {
            tell(Event::Confirmed(confirm));
            return Ok(());
        }
        match Tpdu::parse(content) {
            Tpdu::Data { piece, last } => {
                if self.pieces.len() + piece.len() > LONGEST {
                    return Err(Broken::TooLong);
                }
                match (last, self.pieces.is_empty()) {
                    (true, true) if piece.is_empty() => {} // an empty PDU is ignored
                    (true, true) => tell(Event::Pdu(piece)),
                    (_, _) => {
                        self.pieces.extend_from_slice(piece);
                        if last {
                            let mut whole = std::mem::take(&mut self.pieces);
                            tell(Event::Pdu(&whole));
                            whole.clear();
                            self.pieces = whole;
                        }
                    }
                }
                Ok(())
            }
            Tpdu::DisconnectRequest { .. } => Err(Broken::Disconnected),
            Tpdu::ConnectionRequest(_) | Tpdu::Other(_) | Tpdu::Malformed => Err(Broken::Foreign),
        }
    }
}
