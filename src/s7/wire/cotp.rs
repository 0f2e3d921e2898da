//! COTP class 0 (ISO 8073): connection request and confirm, data, disconnect.
//!
//! | TPDU | code | use |
//! |---|---|---|
//! | connection request, CR | `E0` | size of a TPDU and the two TSAPs |
//! | connection confirm, CC | `D0` | repeats the parameters of the CR in the order `C0 C1 C2`, so most clients get 22 bytes |
//! | data, DT | `F0` | a piece of an S7 PDU; the last piece has the end-of-TSDU mark (EOT) |
//! | disconnect request, DR, and confirm, DC | `80`, `C0` | ends the connection |
//!
//! The TPDU number is always 0 in class 0. A request for another class is answered with class 0.

/// The bytes after the length indicator of a DT: its code, and number 0 with the end mark.
pub const DATA_LAST: [u8; 3] = [2, 0xF0, 0x80];
/// The same without the end mark.
pub const DATA_MORE: [u8; 3] = [2, 0xF0, 0x00];
/// The answer to a disconnect request.
const DISCONNECT_CONFIRM: u8 = 0xC0;
const DISCONNECT_REQUEST: u8 = 0x80;
const CONNECTION_CONFIRM: u8 = 0xD0;
const CONNECTION_REQUEST: u8 = 0xE0;

/// Sizes of a TPDU as powers of two: 128 to 8192 bytes.
const SIZES: std::ops::RangeInclusive<u8> = 7..=13;

const SIZE: u8 = 0xC0;
const CALLING_TSAP: u8 = 0xC1;
const CALLED_TSAP: u8 = 0xC2;

/// A transport protocol data unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tpdu<'a> {
    /// Connection request.
    ConnectionRequest(ConnectionRequest<'a>),
    /// Data, and whether it is the last piece.
    Data {
        /// A piece of an S7 PDU.
        piece: &'a [u8],
        /// EOT.
        last: bool,
    },
    /// Disconnect request, with the reference of the sender.
    DisconnectRequest {
        /// Source reference.
        source: [u8; 2],
    },
    /// Another TPDU, which class 0 does not use.
    Other(u8),
    /// Its length does not fit.
    Malformed,
}

/// The request of a client that connects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConnectionRequest<'a> {
    /// The client's reference.
    pub source: [u8; 2],
    /// Binary logarithm of the largest TPDU in bytes; `None` is no limit.
    pub size: Option<u8>,
    /// The calling TSAP: `01 00` for most clients.
    pub calling: Option<&'a [u8]>,
    /// The called TSAP: connection type, and rack and slot, for example `01 02`.
    pub called: Option<&'a [u8]>,
}

impl<'a> Tpdu<'a> {
    /// Parses the content of a TPKT.
    #[must_use]
    pub fn parse(content: &'a [u8]) -> Self {
        let Some((&indicator, rest)) = content.split_first() else {
            return Self::Malformed;
        };
        let Some((header, piece)) = rest.split_at_checked(usize::from(indicator)) else {
            return Self::Malformed;
        };
        match header {
            [0xF0, number, ..] => Self::Data { piece, last: number & 0x80 != 0 },
            [code, _, _, source @ .., _class] if code & 0xF0 == 0xE0 && source.len() >= 2 => {
                let (source, parameters) = (&header[3..5], header.get(6..).unwrap_or(&[]));
                connection_request([source[0], source[1]], parameters).map_or(Self::Malformed, Self::ConnectionRequest)
            }
            [0x80, _, _, a, b, ..] => Self::DisconnectRequest { source: [*a, *b] },
            [code, ..] if !matches!(code & 0xF0, 0xE0 | 0xF0) && *code != 0x80 => Self::Other(*code),
            _ => Self::Malformed,
        }
    }
}

fn connection_request(source: [u8; 2], mut parameters: &[u8]) -> Option<ConnectionRequest<'_>> {
    let mut request = ConnectionRequest { source, size: None, calling: None, called: None };
    while let [code, length, rest @ ..] = parameters {
        let (value, rest) = rest.split_at_checked(usize::from(*length))?;
        match (*code, value) {
            (SIZE, [size]) => request.size = Some(*size),
            (CALLING_TSAP, tsap) => request.calling = Some(tsap),
            (CALLED_TSAP, tsap) => request.called = Some(tsap),
            _ => {} // checksums, priorities and similar parameters have no meaning in class 0
        }
        parameters = rest;
    }
    Some(request)
}

impl ConnectionRequest<'_> {
    /// The size in the answer: the requested size within the limits of class 0.
    #[must_use]
    pub fn agreed_size(&self) -> Option<u8> {
        self.size.map(|size| size.clamp(*SIZES.start(), *SIZES.end()))
    }

    /// The number of bytes of an S7 PDU that fit into one DT.
    #[must_use]
    pub fn piece(&self) -> usize {
        // RFC 1006: without the parameter a TPDU may fill the packet. PDUs of this server are much shorter than 8192 bytes.
        (1 << self.agreed_size().unwrap_or(*SIZES.end())) - DATA_LAST.len()
    }

    /// Appends the packet of the connection confirm; `reference` is the server's, not 0.
    pub fn confirm(&self, reference: u16, out: &mut Vec<u8>) {
        let [high, low] = reference.to_be_bytes();
        let [a, b] = self.source;
        let mut header = arrayvec::ArrayVec::<u8, 255>::new();
        // The length indicator is at most that of the request, because the parameters are the same.
        header.extend([0, CONNECTION_CONFIRM, a, b, high, low, 0]);
        self.put_parameters(self.agreed_size(), &mut header);
        super::tpkt::put(out, [&header, &[]]);
    }

    /// Appends the parameters and sets the length indicator.
    fn put_parameters(&self, size: Option<u8>, header: &mut arrayvec::ArrayVec<u8, 255>) {
        let size = size.map(|size| [size]);
        let size = size.as_ref().map(<[u8; 1]>::as_slice);
        for (code, value) in [(SIZE, size), (CALLING_TSAP, self.calling), (CALLED_TSAP, self.called)] {
            let Some(value) = value else { continue };
            if value.len() + 2 <= header.remaining_capacity() {
                header.push(code);
                header.push(u8::try_from(value.len()).unwrap_or(0));
                header.extend(value.iter().copied());
            }
        }
        header[0] = u8::try_from(header.len() - 1).unwrap_or(0);
    }
}

/// The answer of a server to a connection request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConnectionConfirm {
    /// The client's reference, repeated.
    pub destination: [u8; 2],
    /// The server's reference.
    pub source: [u8; 2],
    /// Binary logarithm of the largest TPDU in bytes; `None` is no limit.
    pub size: Option<u8>,
}

impl ConnectionConfirm {
    /// Parses the content of a TPKT; `None` if it is another TPDU.
    #[must_use]
    pub fn parse(content: &[u8]) -> Option<Self> {
        let (&indicator, rest) = content.split_first()?;
        match rest.get(..usize::from(indicator))? {
            [code, a, b, c, d, _class, parameters @ ..] if code & 0xF0 == CONNECTION_CONFIRM => {
                let size = connection_request([*c, *d], parameters)?.size;
                Some(Self { destination: [*a, *b], source: [*c, *d], size })
            }
            _ => None,
        }
    }

    /// The number of bytes of an S7 PDU that fit into one DT to the server. The server may agree to a smaller size than requested, but not
    /// to a larger one.
    #[must_use]
    pub fn piece(&self, asked: u8) -> usize {
        let size = self.size.unwrap_or(asked).min(asked);
        (1 << size.clamp(*SIZES.start(), *SIZES.end())) - DATA_LAST.len()
    }
}

impl ConnectionRequest<'_> {
    /// Appends the packet of the request: class 0, parameters in the order `C0 C1 C2`.
    pub fn put(&self, out: &mut Vec<u8>) {
        let [a, b] = self.source;
        let mut header = arrayvec::ArrayVec::<u8, 255>::new();
        header.extend([0, CONNECTION_REQUEST, 0, 0, a, b, 0]);
        self.put_parameters(self.size, &mut header);
        super::tpkt::put(out, [&header, &[]]);
    }
}

/// Reason of a disconnect request: the called TSAP does not exist.
pub const UNKNOWN_ADDRESS: u8 = 3;

/// Appends the refusal of a connection request: a disconnect request with a reason.
pub fn disconnect_request(source: [u8; 2], reason: u8, out: &mut Vec<u8>) {
    super::tpkt::put(out, [&[6, DISCONNECT_REQUEST, source[0], source[1], 0, 0, reason], &[]]);
}

/// Appends the answer to a disconnect request.
pub fn disconnect_confirm(source: [u8; 2], reference: u16, out: &mut Vec<u8>) {
    let [high, low] = reference.to_be_bytes();
    super::tpkt::put(out, [&[5, DISCONNECT_CONFIRM, source[0], source[1], high, low], &[]]);
}
