//! Subscriptions: values that the module sends cyclically or when they change.
//!
//! ```text
//! 2/1 and 2/5 request    count(2)  time base(1)  factor(1)  items          base 0 = 0.1 s, 1 = 1 s, 2 = 10 s
//!             answer     count(2)  values                                  its sequence is the number of the job
//!             push       count(2)  values                                  with the number of the job
//! 2/4 request            function(1)  number of the job(1), 0 = all
//! ```
//! Changes are checked once per interval. Without an interval (factor 0) they are checked as often as the server allows.

use super::Session;
use super::exchange::Exchange;
use super::subscriptions::{CHANGE, Job};
use super::values::budget_of;
use crate::s7::wire::header::ErrorCode;
use crate::s7::wire::items::Items;
use crate::s7::wire::user_data::Request;
use crate::units::Time;

/// Maximum number of subscriptions per client.
const JOBS: usize = 32;

const CYCLE: u8 = 1;
const UNSUBSCRIBE: u8 = 4;

impl Session {
    pub(super) fn cyclic(
        &mut self,
        function: u8,
        request: &Request<'_>,
        exchange: &mut Exchange<'_>,
    ) -> Result<(), ErrorCode> {
        match function {
            CYCLE | CHANGE => self.subscribe(function, request, exchange),
            UNSUBSCRIBE => self.unsubscribe(request, exchange),
            _ => Err(ErrorCode::NOT_SUPPORTED),
        }
    }

    fn subscribe(&mut self, function: u8, request: &Request<'_>, exchange: &mut Exchange<'_>) -> Result<(), ErrorCode> {
        let [high, low, base, factor, items @ ..] = request.payload else {
            return Err(ErrorCode::NOT_SUPPORTED);
        };
        let base = match base {
            0 => Time::from_millis(100),
            1 => Time::from_millis(1000),
            2 => Time::from_millis(10_000),
            _ => return Err(ErrorCode::NOT_SUPPORTED),
        };
        let count = u16::from_be_bytes([*high, *low]);
        let known = Items::new(items, count.into());
        if count == 0 || (*factor == 0 && function == CYCLE) || known.clone().any(|item| item.is_err()) {
            return Err(ErrorCode::NOT_SUPPORTED);
        }
        self.may_ask_for(known.flatten())?;
        if self.subscriptions.jobs.len() >= JOBS {
            return Err(ErrorCode::TOO_MANY);
        }
        let mut job = Job {
            number: self.free_number(),
            function,
            interval: base.times(u64::from(*factor)),
            due: None,
            count,
            items: items.to_vec(),
            last: Vec::new(),
        };
        let mut pdu = job.head(ErrorCode::NONE).begin(
            exchange.answers,
            exchange.reference,
            budget_of(known.flatten(), exchange.budget),
        );
        job.put(&mut pdu, &mut self.scratch, exchange.station);
        if pdu.is_full() {
            pdu.discard();
            return Err(ErrorCode::WRONG_FRAME);
        }
        job.last = pdu.data_mut().to_vec();
        pdu.finish();
        self.subscriptions.jobs.push(job);
        Ok(())
    }

    fn unsubscribe(&mut self, request: &Request<'_>, exchange: &mut Exchange<'_>) -> Result<(), ErrorCode> {
        let [_, number] = request.payload else {
            return Err(ErrorCode::NOT_SUPPORTED);
        };
        let jobs = &mut self.subscriptions.jobs;
        let before = jobs.len();
        jobs.retain(|job| *number != 0 && job.number != *number);
        if jobs.len() == before && *number != 0 {
            return Err(ErrorCode::NOT_SUPPORTED);
        }
        self.acknowledge(request, exchange);
        Ok(())
    }

    /// A number that no job uses.
    fn free_number(&mut self) -> u8 {
        loop {
            let number = self.next_sequence();
            if self.subscriptions.jobs.iter().all(|job| job.number != number) {
                return number; // there are more numbers than jobs
            }
        }
    }
}
