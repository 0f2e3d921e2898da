//! Long answers of user data, sent in parts: the first part with the answer, each further part when the client requests it. The last part
//! is marked. Only one answer is kept at a time; a new request discards it.

use super::Session;
use super::exchange::Exchange;
use super::pending::Parts;
use crate::s7::wire::header::ErrorCode;
use crate::s7::wire::user_data::{Head, Request, payload_room};

impl Session {
    /// Sends an answer, in as many parts as needed.
    pub(super) fn send_in_parts(&mut self, request: &Request<'_>, exchange: &mut Exchange<'_>, payload: Vec<u8>) {
        let sequence = self.next_sequence();
        self.parts = Parts { payload, sent: 0, of: Some([request.group, request.function, sequence]) };
        self.send_part(request, exchange, sequence);
    }

    /// Sends the next part of a long answer.
    pub(super) fn next_part(&mut self, request: &Request<'_>, exchange: &mut Exchange<'_>) {
        if self.parts.of == Some([request.group, request.function, request.sequence]) {
            self.send_part(request, exchange, request.sequence);
        } else {
            self.refuse_user_data(request, exchange, ErrorCode::WRONG_SEQUENCE);
        }
    }

    fn send_part(&mut self, request: &Request<'_>, exchange: &mut Exchange<'_>, sequence: u8) {
        let Parts { payload, sent, .. } = &mut self.parts;
        let left = &payload[*sent..];
        let part = &left[..left.len().min(payload_room(exchange.budget))];
        let more = part.len() < left.len();
        // An answer in one part has no data unit number.
        let unit = if more || *sent > 0 { sequence } else { 0 };
        let head = Head { unit, more, ..Head::answer(request, sequence) };
        head.send(exchange.answers, exchange.reference, exchange.budget, part);
        *sent += part.len();
        if !more {
            self.parts = Parts::default();
        }
    }
}
