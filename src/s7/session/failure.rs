//! Injected refusals of read and write requests, for tests of operator panels. A refused request is not executed.

use super::exchange::Exchange;
use crate::s7::wire::data::TransportSize;
use crate::s7::wire::header::{ErrorCode, function};
use crate::s7::wire::pdu::Pdu;

/// The form of the refusal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// Each item has this return code.
    Items(u8),
    /// The whole request has this error.
    Request(ErrorCode),
}

impl Failure {
    /// Answers a read or write request; `rest` are its parameters after the function.
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
