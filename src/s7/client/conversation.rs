//! The client's side of the transport, without a socket: bytes in, whole S7 PDUs out. Whatever comes is bounded: a packet by its
//! length field of two bytes, a PDU in pieces by the longest PDU that there is.

use crate::s7::wire::cotp::{ConnectionConfirm, Tpdu};
use crate::s7::wire::tpkt::{self, Packet};

/// The longest PDU that is put together. Servers were seen that answer more than was agreed; that is taken as far as here.
const LONGEST: usize = 65_536;

/// What came, one after another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Event<'a> {
    /// The server takes the connection.
    Confirmed(ConnectionConfirm),
    /// An S7 PDU.
    Pdu(&'a [u8]),
}

/// Why the stream cannot be followed any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Broken {
    /// Something else than S7 communication.
    Foreign,
    /// A PDU longer than any.
    TooLong,
    /// The server disconnects.
    Disconnected,
}

impl Broken {
    pub(super) const fn words(self) -> &'static str {
        match self {
            Self::Foreign => "what came is no S7 communication",
            Self::TooLong => "a PDU came that is longer than any",
            Self::Disconnected => "the server disconnected",
        }
    }
}

/// What has come and is not whole yet.
#[derive(Debug, Default)]
pub(super) struct Conversation {
    input: Vec<u8>,
    pieces: Vec<u8>,
}

impl Conversation {
    /// Takes bytes as they came, in whatever pieces, and tells everything that became whole by them.
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
                    (true, true) if piece.is_empty() => {} // says nothing
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
