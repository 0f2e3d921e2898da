//! Who has a place and has said nothing yet. Where all places are taken, whoever has been silent for the longest time gives way to who
//! comes: connections without a connection request keep nobody out. The server meets them, conversations wait for their turn to go.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tokio::sync::Notify;

/// The silent ones by the order in which they came.
#[derive(Debug, Default)]
pub(super) struct Strangers(Mutex<BTreeMap<u64, Arc<Notify>>>);

impl Strangers {
    /// Somebody with this number, which only grows, has come.
    pub(super) fn meet(&self, number: u64) -> Stranger<'_> {
        let turn = Arc::new(Notify::new());
        self.waiting().insert(number, Arc::clone(&turn));
        Stranger { strangers: self, number, turn }
    }

    /// Asks the oldest one to give way; whether there is one.
    pub(super) fn send_oldest_away(&self) -> bool {
        let oldest = self.waiting().pop_first();
        oldest.map(|(_, turn)| turn.notify_one()).is_some()
    }

    fn waiting(&self) -> MutexGuard<'_, BTreeMap<u64, Arc<Notify>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// One of them, until it is dropped.
#[derive(Debug)]
pub(super) struct Stranger<'a> {
    strangers: &'a Strangers,
    number: u64,
    turn: Arc<Notify>,
}

impl Stranger<'_> {
    /// Waits until its place is needed.
    pub(super) async fn gives_way(&self) {
        self.turn.notified().await;
    }
}

impl Drop for Stranger<'_> {
    fn drop(&mut self) {
        self.strangers.waiting().remove(&self.number);
    }
}
