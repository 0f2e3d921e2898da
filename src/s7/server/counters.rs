//! What a server counts: who came, what went over the wire, what was refused. Whoever shows it reads it with
//! [`Server::counters`](super::Server::counters).

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use super::end::End;
use super::refusals::Refused;

/// Counts from the start of a server.
#[derive(Debug, Default)]
pub struct Counters {
    /// Connections that were accepted, those that were sent away not counted.
    pub connections: Counter,
    /// Sent away because of their network.
    pub foreign: Counter,
    /// Sent away because all places were taken.
    pub crowded: Counter,
    /// Bytes that came.
    pub received: Counter,
    /// Bytes that went.
    pub sent: Counter,
    /// Answers, pushes and confirms of transport.
    pub answers: Counter,
    /// Requests that changed something.
    pub writes: Counter,
    /// What was sent without being asked for each time: values in cycles, values that changed.
    pub pushes: Counter,
    /// Answers that were delayed, swallowed, falsified or cut off on purpose.
    pub faults: Counter,
    /// How connections ended.
    pub(super) ends: [Counter; End::ALL.len()],
    refusals: Mutex<BTreeMap<Refused, u64>>,
}

impl Counters {
    /// How often what was refused.
    #[must_use]
    pub fn refusals(&self) -> Vec<(Refused, u64)> {
        let refusals = self.refusals.lock().unwrap_or_else(PoisonError::into_inner);
        refusals.iter().map(|(refused, count)| (*refused, *count)).collect()
    }

    /// How many connections ended in which way.
    pub fn ends(&self) -> impl Iterator<Item = (&'static str, u64)> {
        End::ALL.iter().zip(&self.ends).map(|(end, count)| (end.name(), count.get()))
    }

    pub(super) fn refused(&self, refused: Refused) {
        *self.refusals.lock().unwrap_or_else(PoisonError::into_inner).entry(refused).or_default() += 1;
    }
}

/// A number that only grows.
#[derive(Debug, Default)]
pub struct Counter(AtomicU64);

impl Counter {
    /// The number.
    #[must_use]
    pub fn get(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }

    pub(super) fn add(&self, count: usize) {
        self.0.fetch_add(count as u64, Ordering::Relaxed);
    }

    /// One more, and the number of it.
    pub(super) fn next(&self) -> u64 {
        self.0.fetch_add(1, Ordering::Relaxed) + 1
    }
}
