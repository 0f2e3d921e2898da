//! Clients that have a place but have made no request yet. At the client limit, the oldest of them is closed in favour of a new client, so
//! idle connections do not block the server. The server registers them; their conversations wait for the request to close.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tokio::sync::Notify;

/// The clients without a request, in the order of their arrival.
#[derive(Debug, Default)]
pub(super) struct Strangers(Mutex<BTreeMap<u64, Arc<Notify>>>);

impl Strangers {
    /// Registers a client with this number. Numbers only increase.
    pub(super) fn meet(&self, number: u64) -> Stranger<'_> {
        let turn = Arc::new(Notify::new());
        self.waiting().insert(number, Arc::clone(&turn));
        Stranger { strangers: self, number, turn }
    }

    /// Asks the oldest one to disconnect; returns whether there is one.
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
