//! The clock of the CPU: read and set. The payload is a reserved byte, the century in BCD (ignored), and a
//! DATE_AND_TIME.

use super::Session;
use super::exchange::Exchange;
use crate::s7::wire::date_and_time::DateAndTime;
use crate::s7::wire::header::ErrorCode;
use crate::s7::wire::user_data::{Head, Request};

impl Session {
    pub(super) fn read_clock(&mut self, request: &Request<'_>, exchange: &mut Exchange<'_>) -> Result<(), ErrorCode> {
        let time = exchange.station.clock();
        let century = if time.year < 2000 { 0x19 } else { 0x20 };
        let mut payload = [0; 10];
        payload[1] = century;
        payload[2..].copy_from_slice(&time.bytes());
        let head = Head::answer(request, self.next_sequence());
        head.send(exchange.answers, exchange.reference, exchange.budget, &payload);
        Ok(())
    }

    pub(super) fn set_clock(&mut self, request: &Request<'_>, exchange: &mut Exchange<'_>) -> Result<(), ErrorCode> {
        self.permit(2, exchange)?;
        let time = request.payload.get(2..).and_then(DateAndTime::parse).ok_or(ErrorCode::WRONG_TIME)?;
        if !exchange.station.set_clock(time) {
            return Err(ErrorCode::CANNOT_BE_PERFORMED);
        }
        self.acknowledge(request, exchange);
        Ok(())
    }

    /// Acknowledges a request.
    pub(super) fn acknowledge(&mut self, request: &Request<'_>, exchange: &mut Exchange<'_>) {
        let head = Head::answer(request, self.next_sequence());
        head.send_empty(exchange.answers, exchange.reference, exchange.budget);
    }
}
