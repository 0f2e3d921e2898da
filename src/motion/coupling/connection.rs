//! Whether the movement of the member that leads is handed on: closed, realigning, open, and closed again.
//!
//! A coupling that was opened, or whose realignment was broken off, closes only while all its members rest: the control says
//! so by [`Coupling::settle`].

use super::difference::{Events, What};
use super::policy::Release;
use super::state::{Axes, Connection, Coupling};

impl<const FOLLOWERS: usize> Coupling<FOLLOWERS> {
    /// Movements are handed on.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.connection == Connection::Closed
    }

    /// The coupling was released: the members are independent, and nothing is monitored.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.connection == Connection::Open
    }

    /// Releases the followers, also out of a realignment; the leader leads.
    pub fn release(&mut self, axes: &impl Axes) -> Events {
        self.connection = Connection::Open;
        self.leads_now = self.leader;
        self.for_each(What::Released, axes)
    }

    /// Closes the coupling after a release. Offsets of activation are captured; what differences count from is the policy's.
    pub fn close(&mut self, axes: &impl Axes) -> Events {
        self.connection = Connection::Settling;
        for coupled in &mut self.followers {
            coupled.activate(self.leader, axes);
            match self.policy.release {
                Release::CountAnew => coupled.count_anew(self.leader, axes),
                Release::Keep => {}
            }
        }
        self.for_each(What::Closed, axes)
    }

    /// Whether all members rest in this cycle: a coupling that waits for it closes.
    pub fn settle(&mut self, rest: bool) {
        if self.connection == Connection::Settling && rest {
            self.connection = Connection::Closed;
        }
    }
}
