//! Events: each transition of a state machine in the control, with the rule that allowed it and the inputs that it tested.
//!
//! An event is plain numbers; it becomes text only when somebody prints it. Events form chains: `parent` is the
//! event (or the edge of a signal, among the inputs) that led to this one.

use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};

use super::Place;
use crate::units::{AxisNumber, Position};

/// Number of an event, ascending from one; zero is "no event".
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct EventId(pub u32);

impl EventId {
    /// No event.
    pub const NONE: Self = Self(0);

    /// Whether there is one.
    #[must_use]
    pub const fn is_some(self) -> bool {
        self.0 != 0
    }
}

/// Number of a rule in the control's table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RuleNumber(pub u16);

/// A rule: where it is written, and what it says happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rule {
    /// Requirement ID, decision or place in a manual: `REF-11`.
    pub id: &'static str,
    /// What happened, in a few words.
    pub text: &'static str,
}

/// One bit of the interface, by owner and place in its data block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SignalBit {
    /// Whose block.
    pub place: Place,
    /// Byte of the block.
    pub byte: u16,
    /// Bit of the byte.
    pub bit: u8,
}

/// What a measured or computed length is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Quantity {
    /// Synchronism difference.
    SynchronismDifference,
    /// Actual value.
    Position,
    /// Following error, or deviation from the setpoint.
    Deviation,
    /// Distance travelled.
    Distance,
    /// Velocity, in millionths of a user unit per second.
    Velocity,
}

/// An input of a decision with the value it had.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Input {
    /// Nothing.
    #[default]
    None,
    /// A signal.
    Bit(SignalBit, bool),
    /// A machine datum, of an axis if it is axial.
    Datum(u32, Option<AxisNumber>, f64),
    /// A length on an axis.
    Length(Quantity, AxisNumber, Position),
    /// An alarm.
    Alarm(u32),
}

/// A transition: when, whose, by which rule, from which inputs, and what led to it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Its number.
    pub id: EventId,
    /// The cycle in which it happened.
    pub cycle: u64,
    /// Who.
    pub place: Place,
    /// Which rule allowed it.
    pub rule: RuleNumber,
    /// What was tested.
    pub inputs: [Input; 3],
    /// What led to it.
    pub parent: EventId,
}

/// The latest events, in a ring.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Events {
    ring: ArrayVec<Event, { Self::CAPACITY }>,
    last: u32,
}

impl Events {
    /// How many events are kept.
    pub const CAPACITY: usize = 128;

    /// Notes an event.
    pub fn push(&mut self, cycle: u64, place: Place, rule: RuleNumber, inputs: [Input; 3], parent: EventId) -> EventId {
        self.last = self.last.wrapping_add(1).max(1);
        let id = EventId(self.last);
        let event = Event { id, cycle, place, rule, inputs, parent };
        if self.ring.try_push(event).is_err() {
            self.ring[(self.last as usize - 1) % Self::CAPACITY] = event;
        }
        id
    }

    /// The number of the latest event.
    #[must_use]
    pub fn last(&self) -> EventId {
        EventId(self.last)
    }

    /// The events after this one, as far as they are kept, in order.
    pub fn since(&self, id: EventId) -> impl Iterator<Item = &Event> {
        (id.0.saturating_add(1)..=self.last).filter_map(|number| self.find(EventId(number)))
    }

    /// An event that is still kept.
    #[must_use]
    pub fn find(&self, id: EventId) -> Option<&Event> {
        let place = (id.0 as usize).checked_sub(1)? % Self::CAPACITY;
        self.ring.get(place).filter(|event| event.id == id)
    }
}
