//! Requests to read or write that are refused on purpose, for tests of panels. Nothing of them is done.

use super::exchange::Exchange;
use crate::s7::wire::data::TransportSize;
use crate::s7::wire::header::{ErrorCode, function};
use crate::s7::wire::pdu::Pdu;

/// How a request is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// Each of its items has this return code.
    Items(u8),
    /// The whole has this error.
    Request(ErrorCode),
}

impl Failure {
    /// Answers a request to read or write whose parameters behind the function are these.
    pub(super) fn answer(self, code: u8, rest: &[u8], exchange: &mut Exchange<'_>) {
        match (self, rest) {
            (Self::Items(failure), [count, ..]) if *count > 0 => {
                let mut pdu = Pdu::ack_data(exchange.answers, exchange.reference, exchange.budget);
                pdu.put(&[code, *count]);
                pdu.data();
                let item = [failure, TransportSize::NULL.0, 0, 0];
                let item = if code == function::READ { &item[..] } else { &item[..1] };
                (0..*count).for_each(|_| pdu.put(item));
                pdu.finish();
            }
            (Self::Items(_), _) => exchange.refuse(ErrorCode::WRONG_FRAME),
            (Self::Request(error), _) => exchange.refuse(error),
        }
    }
}
