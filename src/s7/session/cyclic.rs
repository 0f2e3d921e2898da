//! Data that the module sends by itself: in cycles, or when they change.
//!
//! ```text
//! 2/1 and 2/5 request    count(2)  time base(1)  factor(1)  items          base 0 = 0.1 s, 1 = 1 s, 2 = 10 s
//!             answer     count(2)  values                                  its sequence is the number of the job
//!             push       count(2)  values                                  with the number of the job
//! 2/4 request            function(1)  number of the job(1), 0 = all
//! ```
//! A change is looked for as often as the interval says. Without an interval (factor 0) it is looked for as often as the server
//! allows.

use super::variables::{budget_of, put_values};
use super::{Exchange, Session};
use crate::s7::station::Station;
use crate::s7::wire::data::{SUCCESS, TransportSize};
use crate::s7::wire::header::ErrorCode;
use crate::s7::wire::items::Items;
use crate::s7::wire::pdu::{Answers, Budget, Pdu};
use crate::s7::wire::user_data::{Head, Request, group};
use crate::units::Time;

/// How many jobs of this kind a client may have.
const JOBS: usize = 32;

const CYCLE: u8 = 1;
const UNSUBSCRIBE: u8 = 4;
const CHANGE: u8 = 5;

/// The jobs of a client.
#[derive(Clone, Debug, Default)]
pub(super) struct Subscriptions {
    jobs: Vec<Job>,
}

#[derive(Clone, Debug)]
struct Job {
    number: u8,
    /// In cycles or on change.
    function: u8,
    interval: Time,
    /// When it is due; not before the first tick, which only starts the interval.
    due: Option<Time>,
    count: u16,
    items: Vec<u8>,
    /// What was sent last.
    last: Vec<u8>,
}

impl Subscriptions {
    pub(super) fn is_empty(&self) -> bool {
        self.jobs.is_empty()
    }

    pub(super) fn tick(
        &mut self,
        now: Time,
        shortest: Time,
        scratch: &mut Vec<u8>,
        budget: Budget,
        station: &dyn Station,
        answers: &mut Answers,
    ) {
        for job in &mut self.jobs {
            let interval = job.interval.max(shortest);
            let due = *job.due.get_or_insert(now + interval);
            if now < due {
                continue;
            }
            // From now on, not from when it was due: who is late does not catch up in a burst.
            job.due = Some(now + interval);
            let items = Items::new(&job.items, job.count.into()).flatten();
            let mut pdu = job.head(ErrorCode::NONE).begin_push(answers, budget_of(items, budget));
            job.put(&mut pdu, scratch, station);
            let is_changed = pdu.data_mut() != job.last.as_slice();
            if pdu.is_full() || job.function == CHANGE && !is_changed {
                pdu.discard();
                continue;
            }
            if is_changed {
                job.last.clear();
                job.last.extend_from_slice(pdu.data_mut());
            }
            pdu.finish();
        }
    }
}

impl Job {
    fn head(&self, error: ErrorCode) -> Head {
        let (function, sequence) = (self.function, self.number);
        Head { group: group::CYCLIC, function, sequence, unit: 0, more: false, error }
    }

    /// Appends the data part: count and values.
    fn put(&self, pdu: &mut Pdu<'_>, scratch: &mut Vec<u8>, station: &dyn Station) {
        let [high, low] = self.count.to_be_bytes();
        pdu.put(&[SUCCESS, TransportSize::OCTETS.0, 0, 0, high, low]);
        put_values(pdu, Items::new(&self.items, self.count.into()).flatten(), scratch, station);
        let length = pdu.data_length().saturating_sub(4);
        if let [_, _, high, low, ..] = pdu.data_mut() {
            [*high, *low] = TransportSize::OCTETS.field(length).to_be_bytes();
        }
    }
}

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

    /// A number that no job has.
    fn free_number(&mut self) -> u8 {
        loop {
            let number = self.next_sequence();
            if self.subscriptions.jobs.iter().all(|job| job.number != number) {
                return number; // there are more numbers than jobs
            }
        }
    }
}
