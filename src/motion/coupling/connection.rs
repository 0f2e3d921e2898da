//! State of the coupling: closed, realigning, or open. A closed coupling passes on the movement of the leading member.
//!
//! A coupling that was opened, or whose realignment was aborted, closes only when all its members are at rest. The control reports this
//! with [`Coupling::settle`].

use super::difference::{Events, What};
use super::policy::Release;
use super::state::{Axes, Connection, Coupling};

impl<const FOLLOWERS: usize> Coupling<FOLLOWERS> {
    /// Whether movements are passed on.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.connection == Connection::Closed
    }

    /// Whether the coupling was released: its members are independent, and nothing is monitored.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.connection == Connection::Open
    }

    /// Releases the followers, also during a realignment. The leader leads.
    pub fn release(&mut self, axes: &impl Axes) -> Events {
        self.connection = Connection::Open;
        self.leads_now = self.leader;
        self.for_each(What::Released, axes)
    }

    /// Closes the coupling after a release. Captures the offsets of activation. The policy defines the base of the differences.
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

    /// Reports whether all members are at rest in this cycle. A coupling that waits for this closes.
    pub fn settle(&mut self, rest: bool) {
        if self.connection == Connection::Settling && rest {
            self.connection = Connection::Closed;
        }
    }
}
