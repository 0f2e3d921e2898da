//! User data: all services except variables and jobs. The parameter part has group and function, the data part has one
//! item.
//!
//! ```text
//! 00 01 12  04  11  4G FF SS                     request: type 4, group G, function FF, sequence SS
//! 00 01 12  08  12  4G FF SS  UU LL 00 00        request for the next part of a long answer
//! 00 01 12  08  12  8G FF SS  UU LL EE EE        answer: data unit UU, LL 0 = last part, error EEEE
//! 00 01 12  08  12  0G FF SS  UU LL 00 00        push, which is not acknowledged
//! ```
//! Some clients send type 0 in a request; it is treated as 4.

use super::data::{SUCCESS, TransportSize};
use super::header::ErrorCode;
use super::pdu::{Answers, Budget, Pdu};

/// Groups of functions.
pub mod group {
    /// Tests of the programming device.
    pub const PROGRAMMER: u8 = 1;
    /// Values that the module sends cyclically or when they change.
    pub const CYCLIC: u8 = 2;
    /// Blocks.
    pub const BLOCKS: u8 = 3;
    /// System state lists and messages.
    pub const CPU: u8 = 4;
    /// Passwords.
    pub const SECURITY: u8 = 5;
    /// The clock.
    pub const TIME: u8 = 7;
}

/// Parameter and data item before the payload of an answer.
const PARAMETER: usize = 12;
const ITEM: usize = 4;

/// The number of payload bytes that fit into an answer.
#[must_use]
pub const fn payload_room(budget: Budget) -> usize {
    // An even number, so that no word of a list is split.
    budget.pdu.saturating_sub(10 + PARAMETER + ITEM) / 2 * 2
}

/// A request.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// [`group`].
    pub group: u8,
    /// The function in its group.
    pub function: u8,
    /// Its number in a sequence of requests.
    pub sequence: u8,
    /// Whether it requests the next part of a long answer.
    pub goes_on: bool,
    /// The payload of the data item.
    pub payload: &'a [u8],
}

/// The kind of a user data PDU.
#[derive(Clone, Copy, Debug)]
pub enum Received<'a> {
    /// A request.
    Request(Request<'a>),
    /// An answer or a push of the client; it needs no answer.
    Answer,
    /// Invalid.
    Malformed,
}

/// Parses parameter and data part.
#[must_use]
pub fn parse<'a>(parameter: &'a [u8], data: &'a [u8]) -> Received<'a> {
    let [0, 1, 0x12, length, method, kind_group, function, sequence, rest @ ..] = parameter else {
        return Received::Malformed;
    };
    if usize::from(*length) != 4 + rest.len() {
        return Received::Malformed;
    }
    match kind_group >> 4 {
        0 | 4 => {}
        8.. => return Received::Answer,
        _ => return Received::Malformed,
    }
    let payload = match data {
        [] => &[],
        [_, size, high, low, payload @ ..] => {
            let length = TransportSize(*size).bytes(u16::from_be_bytes([*high, *low]));
            match payload.get(..length) {
                Some(payload) => payload,
                None => return Received::Malformed,
            }
        }
        _ => return Received::Malformed,
    };
    let (group, function, sequence) = (kind_group & 0xF, *function, *sequence);
    Received::Request(Request { group, function, sequence, goes_on: *method == 0x12, payload })
}

/// The parameter part of an answer or a push.
#[derive(Clone, Copy, Debug)]
pub struct Head {
    /// [`group`].
    pub group: u8,
    /// The function in its group.
    pub function: u8,
    /// Its number in a sequence, or of a job.
    pub sequence: u8,
    /// The number of the data unit, if an answer has several parts.
    pub unit: u8,
    /// Whether more parts follow.
    pub more: bool,
    /// The error code.
    pub error: ErrorCode,
}

impl Head {
    /// The header of an answer to a request.
    #[must_use]
    pub fn answer(request: &Request<'_>, sequence: u8) -> Self {
        let (group, function) = (request.group, request.function);
        Self { group, function, sequence, unit: 0, more: false, error: ErrorCode::NONE }
    }

    /// Begins an answer; its data part is open.
    #[must_use]
    pub fn begin(self, answers: &mut Answers, reference: u16, budget: Budget) -> Pdu<'_> {
        self.begin_as(8, answers, reference, budget)
    }

    /// Begins a push; its data part is open.
    #[must_use]
    pub fn begin_push(self, answers: &mut Answers, budget: Budget) -> Pdu<'_> {
        self.begin_as(0, answers, 0, budget)
    }

    fn begin_as(self, kind: u8, answers: &mut Answers, reference: u16, budget: Budget) -> Pdu<'_> {
        let mut pdu = Pdu::user_data(answers, reference, budget);
        let [high, low] = self.error.0.to_be_bytes();
        pdu.put(&[0, 1, 0x12, 8, 0x12, kind << 4 | self.group, self.function, self.sequence]);
        pdu.put(&[self.unit, u8::from(self.more), high, low]);
        pdu.data();
        pdu
    }

    /// Sends an answer with a payload that fits.
    pub fn send(self, answers: &mut Answers, reference: u16, budget: Budget, payload: &[u8]) {
        let mut pdu = self.begin(answers, reference, budget);
        put_item(&mut pdu, payload);
        pdu.finish();
    }

    /// Sends an answer without payload: done, or an error.
    pub fn send_empty(self, answers: &mut Answers, reference: u16, budget: Budget) {
        let mut pdu = self.begin(answers, reference, budget);
        pdu.put(&[0x0A, 0, 0, 0]);
        pdu.finish();
    }
}

/// Appends a data item of octets.
pub fn put_item(pdu: &mut Pdu<'_>, payload: &[u8]) {
    let length = TransportSize::OCTETS.field(payload.len()).to_be_bytes();
    pdu.put(&[SUCCESS, TransportSize::OCTETS.0, length[0], length[1]]);
    pdu.put(payload);
}
