//! The subscriptions of a client.

use super::values::{budget_of, put_values};
use crate::s7::station::Station;
use crate::s7::wire::data::{SUCCESS, TransportSize};
use crate::s7::wire::header::ErrorCode;
use crate::s7::wire::items::Items;
use crate::s7::wire::pdu::{Answers, Budget, Pdu};
use crate::s7::wire::user_data::{Head, group};
use crate::units::Time;

/// Values are sent when they change.
pub(super) const CHANGE: u8 = 5;

/// The subscriptions of a client.
#[derive(Clone, Debug, Default)]
pub(super) struct Subscriptions {
    pub(super) jobs: Vec<Job>,
}

#[derive(Clone, Debug)]
pub(super) struct Job {
    pub(super) number: u8,
    /// Cyclic or on change.
    pub(super) function: u8,
    pub(super) interval: Time,
    /// When it is due; `None` before the first tick, which only starts the interval.
    pub(super) due: Option<Time>,
    pub(super) count: u16,
    pub(super) items: Vec<u8>,
    /// The values sent last.
    pub(super) last: Vec<u8>,
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
            // Counted from now, not from the due time: a delayed subscription must not send a burst.
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
    pub(super) fn head(&self, error: ErrorCode) -> Head {
        let (function, sequence) = (self.function, self.number);
        Head { group: group::CYCLIC, function, sequence, unit: 0, more: false, error }
    }

    /// Appends the data part: count and values.
    pub(super) fn put(&self, pdu: &mut Pdu<'_>, scratch: &mut Vec<u8>, station: &dyn Station) {
        let [high, low] = self.count.to_be_bytes();
        pdu.put(&[SUCCESS, TransportSize::OCTETS.0, 0, 0, high, low]);
        put_values(pdu, Items::new(&self.items, self.count.into()).flatten(), scratch, station);
        let length = pdu.data_length().saturating_sub(4);
        if let [_, _, high, low, ..] = pdu.data_mut() {
            [*high, *low] = TransportSize::OCTETS.field(length).to_be_bytes();
        }
    }
}
