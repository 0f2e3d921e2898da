//! PLC stop and start, and the named services: `P_PROGRAM`, `_GARB` (compress), `_MODU` (copy RAM to ROM).
//!
//! ```text
//! 28  00 00 00 00 00 00 FD  LL LL arguments  NN name     start and services
//! 29  00 00 00 00 00        NN name                      stop
//! ```
//! A request for the current state is acknowledged with a second byte: `03` already in RUN, `07` already in STOP.

use super::Session;
use super::exchange::Exchange;
use crate::s7::station::{CpuState, Restart};
use crate::s7::wire::header::{ErrorCode, function};
use crate::s7::wire::pdu::Pdu;

const PROGRAM: &[u8] = b"P_PROGRAM";
const COMPRESS: &[u8] = b"_GARB";
const COPY_RAM_TO_ROM: &[u8] = b"_MODU";
/// The argument of a cold restart.
const COLD: &[u8] = b"C ";

const RUNS_ALREADY: u8 = 3;
const STANDS_ALREADY: u8 = 7;

impl Session {
    pub(super) fn start(&mut self, rest: &[u8], exchange: &mut Exchange<'_>) {
        let Some((arguments, name)) = service(rest) else {
            return exchange.refuse(ErrorCode::WRONG_FRAME);
        };
        if let Err(error) = self.permit(2, exchange) {
            return exchange.refuse(error);
        }
        let restart = match (name, arguments) {
            (PROGRAM, []) => Restart::Warm,
            (PROGRAM, COLD) => Restart::Cold,
            // There is no load memory to compress or to copy to.
            (COMPRESS | COPY_RAM_TO_ROM, _) => return acknowledge(exchange, &[function::START]),
            _ => return exchange.refuse(ErrorCode::FUNCTION_PARAMETERS),
        };
        match exchange.station.state() {
            CpuState::Run => acknowledge(exchange, &[function::START, RUNS_ALREADY]),
            CpuState::Stop if exchange.station.start(restart) => acknowledge(exchange, &[function::START]),
            CpuState::Stop => exchange.refuse(ErrorCode::CANNOT_BE_PERFORMED),
        }
    }

    pub(super) fn stop(&mut self, rest: &[u8], exchange: &mut Exchange<'_>) {
        let name = rest.get(5..).and_then(counted);
        if name != Some((PROGRAM, &[])) {
            return exchange.refuse(ErrorCode::WRONG_FRAME);
        }
        if let Err(error) = self.permit(2, exchange) {
            return exchange.refuse(error);
        }
        match exchange.station.state() {
            CpuState::Stop => acknowledge(exchange, &[function::STOP, STANDS_ALREADY]),
            CpuState::Run if exchange.station.stop() => acknowledge(exchange, &[function::STOP]),
            CpuState::Run => exchange.refuse(ErrorCode::CANNOT_BE_PERFORMED),
        }
    }
}

/// Arguments and name of a service.
fn service(rest: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, rest) = rest.get(7..)?.split_first_chunk::<2>()?;
    let (arguments, rest) = rest.split_at_checked(u16::from_be_bytes(*length).into())?;
    let (name, rest) = counted(rest)?;
    rest.is_empty().then_some((arguments, name))
}

/// A text preceded by its length, and the bytes after it.
fn counted(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, rest) = bytes.split_first()?;
    rest.split_at_checked(usize::from(*length))
}

fn acknowledge(exchange: &mut Exchange<'_>, parameter: &[u8]) {
    let mut pdu = Pdu::ack_data(exchange.answers, exchange.reference, exchange.budget);
    pdu.put(parameter);
    pdu.finish();
}
