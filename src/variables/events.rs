//! Events: each transition of a state machine in the control, with the rule that allowed it and the inputs that it tested.
//!
//! An event consists of numbers; it becomes text only when it is printed. Events form chains: `parent` is the event that led to this one
//! (an edge of a signal can also lead to it and is then among the inputs).

use arrayvec::{ArrayString, ArrayVec};
use serde::{Deserialize, Serialize};

use super::{FaultName, Place};
use crate::units::{AxisNumber, Position};

/// Number of an event, ascending from one; zero means "no event".
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct EventId(pub u32);

impl EventId {
    /// No event.
    pub const NONE: Self = Self(0);

    /// Whether this is an event.
    #[must_use]
    pub const fn is_some(self) -> bool {
        self.0 != 0
    }
}

/// Number of a rule in the table of the control.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RuleNumber(pub u16);

/// A rule: its source and the text of what happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rule {
    /// Requirement ID, decision or place in a manual: `REF-11`.
    pub id: &'static str,
    /// What happened, in a few words.
    pub text: &'static str,
}

/// One bit of the interface, by owner and position in its data block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SignalBit {
    /// The owner of the block.
    pub place: Place,
    /// Byte of the block.
    pub byte: u16,
    /// Bit of the byte.
    pub bit: u8,
}

/// The meaning of a measured or computed length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Quantity {
    /// Synchronism difference.
    SynchronismDifference,
    /// Actual value.
    Position,
    /// Setpoint.
    Setpoint,
    /// Target of a movement.
    Target,
    /// Following error, or deviation from the setpoint.
    Deviation,
    /// The difference from which the limits of a grouping count.
    Base,
    /// Distance travelled.
    Distance,
    /// Actual velocity with its sign, in millionths of a user unit per second.
    Velocity,
    /// Velocity that position control commands, in the same unit.
    VelocityCommand,
    /// Deviation of the actual value from the model of the axis, as contour monitoring calculates it.
    ModelDeviation,
    /// Position of a zero mark that the encoder has passed.
    ZeroMark,
    /// Deviation of the distance of two zero marks from a multiple of their spacing.
    ZeroMarkDeviation,
    /// Sag compensation value before its limits.
    Sag,
    /// Compensation of the setpoint.
    SetpointCompensation,
}

/// An input of a decision, with its value at that time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Input {
    /// Unused.
    #[default]
    None,
    /// A signal of one bit.
    Bit(SignalBit, bool),
    /// A machine datum, of an axis if it is axial.
    Datum(u32, Option<AxisNumber>, f64),
    /// An element of a machine datum of an axis, by its index.
    Element(u32, u8, AxisNumber, f64),
    /// A length on an axis.
    Length(Quantity, AxisNumber, Position),
    /// An alarm.
    Alarm(u32),
    /// A signal of several bits of one byte, by its lowest bit.
    Number(SignalBit, u8),
    /// A fault of the place of the event.
    Fault(FaultName),
    /// A block of a program, by its number, label or line.
    Block(BlockName),
}

/// The name of a block in causes, at most 12 bytes.
pub type BlockName = ArrayString<12>;

impl Input {
    /// The signal, by its lowest bit, and its value, if the input is a signal.
    #[must_use]
    pub fn signal(&self) -> Option<(SignalBit, u8)> {
        match *self {
            Self::Bit(bit, value) => Some((bit, value.into())),
            Self::Number(bit, value) => Some((bit, value)),
            Self::None
            | Self::Datum(..)
            | Self::Element(..)
            | Self::Length(..)
            | Self::Alarm(_)
            | Self::Fault(_)
            | Self::Block(_) => None,
        }
    }
}

/// A transition: its cycle, place, rule, inputs and parent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// The number of the event.
    pub id: EventId,
    /// The cycle in which it happened.
    pub cycle: u64,
    /// The place where it happened.
    pub place: Place,
    /// The rule that allowed it.
    pub rule: RuleNumber,
    /// The inputs that were tested.
    pub inputs: [Input; 3],
    /// The event that led to it.
    pub parent: EventId,
}

/// The number of events that are kept.
const CAPACITY: usize = 128;

/// The latest events, in a ring buffer.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Events {
    ring: ArrayVec<Event, CAPACITY>,
    last: u32,
}

impl Events {
    /// The number of events that are kept.
    pub const CAPACITY: usize = CAPACITY;

    /// Records an event and returns its number.
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

    /// The events after the given one that are still kept, in order.
    pub fn since(&self, id: EventId) -> impl Iterator<Item = &Event> {
        (id.0.saturating_add(1)..=self.last).filter_map(|number| self.find(EventId(number)))
    }

    /// An event by its number, if it is still kept.
    #[must_use]
    pub fn find(&self, id: EventId) -> Option<&Event> {
        let place = (id.0 as usize).checked_sub(1)? % Self::CAPACITY;
        self.ring.get(place).filter(|event| event.id == id)
    }
}
