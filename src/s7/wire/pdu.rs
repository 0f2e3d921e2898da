//! Builds answers: an S7 PDU with a budget, and its packets.
//!
//! A PDU never exceeds its budget, the negotiated length: bytes that do not fit are not appended, and [`Pdu::finish`] then sends a refusal.
//! An answer is one sequence of bytes for one write to the socket, even if the agreed TPDU is so small that it needs several packets.

use zerocopy::IntoBytes;

use super::header::{ErrorCode, Header, PROTOCOL, kind};
use super::{cotp, tpkt};

/// Answers in order; each is written to the socket in one write.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Answers {
    bytes: Vec<u8>,
    ends: Vec<usize>,
}

impl Answers {
    /// All bytes.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The answers in order.
    pub fn iter(&self) -> impl Iterator<Item = &[u8]> {
        self.since(0)
    }

    /// The answers after the first `known`.
    pub fn since(&self, known: usize) -> impl Iterator<Item = &[u8]> {
        let known = known.min(self.ends.len());
        let start = known.checked_sub(1).map_or(0, |last| self.ends[last]);
        let starts = std::iter::once(start).chain(self.ends[known..].iter().copied());
        starts.zip(&self.ends[known..]).map(|(start, end)| &self.bytes[start..*end])
    }

    /// The number of answers.
    #[must_use]
    pub fn count(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is nothing to send.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Removes the answers and keeps the buffer.
    pub fn clear(&mut self) {
        self.bytes.clear();
        self.ends.clear();
    }

    /// Appends a transport answer: connection confirm or disconnect confirm.
    pub fn transport(&mut self, put: impl FnOnce(&mut Vec<u8>)) {
        put(&mut self.bytes);
        self.ends.push(self.bytes.len());
    }
}

/// The maximum size of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// Bytes of an S7 PDU, as negotiated.
    pub pdu: usize,
    /// Bytes of an S7 PDU in one packet, according to the TPDU size.
    pub piece: usize,
}

/// The longest PDU that is built, whatever the budget is.
const LONGEST: usize = 4096;

/// Packet and TPDU headers before the PDU.
const TRANSPORT: usize = tpkt::HEADER + cotp::DATA_LAST.len();

/// An S7 PDU that is being built.
#[derive(Debug)]
pub struct Pdu<'a> {
    answers: &'a mut Answers,
    /// Offset of its packet.
    start: usize,
    budget: Budget,
    kind: u8,
    reference: u16,
    error: ErrorCode,
    /// Offset of the data part, once it has begun.
    data: Option<usize>,
    full: bool,
}

impl<'a> Pdu<'a> {
    /// Begins an acknowledgement with data.
    pub fn ack_data(answers: &'a mut Answers, reference: u16, budget: Budget) -> Self {
        Self::begin(answers, kind::ACK_DATA, reference, budget)
    }

    /// Begins a user data PDU.
    pub fn user_data(answers: &'a mut Answers, reference: u16, budget: Budget) -> Self {
        Self::begin(answers, kind::USER_DATA, reference, budget)
    }

    /// Begins a request of a client.
    pub fn job(answers: &'a mut Answers, reference: u16, budget: Budget) -> Self {
        Self::begin(answers, kind::JOB, reference, budget)
    }

    fn begin(answers: &'a mut Answers, kind: u8, reference: u16, budget: Budget) -> Self {
        let start = answers.bytes.len();
        let error = ErrorCode::NONE;
        answers.bytes.resize(start + TRANSPORT + header_length(kind), 0);
        Self { answers, start, budget, kind, reference, error, data: None, full: false }
    }

    /// The refusal of a job: an acknowledgement with an error and no data.
    pub fn refuse(answers: &'a mut Answers, reference: u16, budget: Budget, error: ErrorCode) {
        let mut pdu = Self::begin(answers, kind::ACK, reference, budget);
        pdu.error = error;
        pdu.finish();
    }

    /// Its length in bytes.
    #[must_use]
    pub fn length(&self) -> usize {
        self.answers.bytes.len() - self.start - TRANSPORT
    }

    /// The number of bytes that still fit.
    #[must_use]
    pub fn room(&self) -> usize {
        self.budget.pdu.min(LONGEST).saturating_sub(self.length())
    }

    /// Appends bytes to the current part; appends nothing if they do not fit.
    pub fn put(&mut self, bytes: &[u8]) {
        if let Some(space) = self.space(bytes.len()) {
            space.copy_from_slice(bytes);
        }
    }

    /// Appends zeros to the current part, to be filled in; `None` if they do not fit.
    pub fn space(&mut self, length: usize) -> Option<&mut [u8]> {
        if self.full || length > self.room() {
            self.full = true;
            return None;
        }
        let at = self.answers.bytes.len();
        self.answers.bytes.resize(at + length, 0);
        self.answers.bytes.get_mut(at..)
    }

    /// Ends the parameter part; the data part follows.
    pub fn data(&mut self) {
        self.data = Some(self.answers.bytes.len());
    }

    /// The length of the data part so far.
    #[must_use]
    pub fn data_length(&self) -> usize {
        self.data.map_or(0, |start| self.answers.bytes.len() - start)
    }

    /// The data part, for reading or patching.
    pub fn data_mut(&mut self) -> &mut [u8] {
        let end = self.answers.bytes.len();
        &mut self.answers.bytes[self.data.unwrap_or(end)..]
    }

    /// Removes everything after the first `length` bytes of the data part.
    pub fn truncate_data(&mut self, length: usize) {
        if let Some(start) = self.data {
            self.answers.bytes.truncate(start + length);
        }
    }

    /// Removes the whole PDU; nothing is sent.
    pub fn discard(self) {
        self.answers.bytes.truncate(self.start);
    }

    /// Whether some bytes did not fit.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.full
    }

    /// Closes the PDU. An answer that did not fit becomes the refusal "wrong frame".
    pub fn finish(self) {
        let Self { answers, start, budget, kind, reference, error, data, full } = self;
        if full {
            answers.bytes.truncate(start);
            return Self::refuse(answers, reference, budget, ErrorCode::WRONG_FRAME);
        }
        let end = answers.bytes.len();
        let parameter = start + TRANSPORT + header_length(kind);
        let data = data.unwrap_or(end);
        let length = |bytes: usize| u16::try_from(bytes).unwrap_or(u16::MAX).into(); // at most LONGEST
        let header = Header {
            protocol: PROTOCOL,
            kind,
            redundancy: 0.into(),
            reference: reference.into(),
            parameter_length: length(data - parameter),
            data_length: length(end - data),
        };
        let at = start + TRANSPORT;
        answers.bytes[at..at + size_of::<Header>()].copy_from_slice(header.as_bytes());
        if matches!(kind, kind::ACK | kind::ACK_DATA) {
            answers.bytes[parameter - 2..parameter].copy_from_slice(&error.0.to_be_bytes());
        }
        answers.close(start, budget.piece);
    }
}

impl Answers {
    /// Writes the transport headers of the PDU that begins at `start`, in several packets if it is longer than a piece.
    fn close(&mut self, start: usize, piece: usize) {
        let length = self.bytes.len() - start - TRANSPORT;
        if length <= piece {
            let packet = u16::try_from(TRANSPORT + length).unwrap_or(u16::MAX).to_be_bytes();
            let [a, b, c] = cotp::DATA_LAST;
            self.bytes[start..start + TRANSPORT].copy_from_slice(&[3, 0, packet[0], packet[1], a, b, c]);
        } else {
            let pdu = self.bytes.split_off(start + TRANSPORT);
            self.bytes.truncate(start);
            let mut pieces = pdu.chunks(piece.max(1)).peekable();
            while let Some(piece) = pieces.next() {
                let header = if pieces.peek().is_some() { cotp::DATA_MORE } else { cotp::DATA_LAST };
                tpkt::put(&mut self.bytes, [&header, piece]);
            }
        }
        self.ends.push(self.bytes.len());
    }
}

const fn header_length(kind: u8) -> usize {
    size_of::<Header>() + if matches!(kind, kind::ACK | kind::ACK_DATA) { 2 } else { 0 }
}
