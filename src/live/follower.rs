//! The access of a server that follows a live machine.

use std::sync::Arc;

use super::following::Batch;
use super::shared::Shared;

/// Follows a live machine. There is one for each machine.
#[derive(Debug)]
pub struct Follower(Arc<Shared>);

impl Follower {
    pub(super) fn new(shared: Arc<Shared>) -> Self {
        Self(shared)
    }

    /// Waits for a step and returns the record of all steps since the last call. A call that is given up loses nothing.
    pub async fn next(&mut self) -> Batch {
        let counter = &self.0.counter;
        loop {
            if let Some(batch) = counter.take() {
                return batch;
            }
            counter.arrived().await;
        }
    }
}
