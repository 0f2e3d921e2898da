//! The events of a cycle: every stage that decides something notes here why.

use serde::{Deserialize, Serialize};

use crate::sinumerik::rules::Rule;
use crate::sinumerik::transitions::TakenTransitions;
use crate::units::AxisNumber;
use crate::variables::{EventId, Events, Input, Place, SignalBit};

/// The events and the cycle they belong to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Log {
    /// Number of the cycle that runs.
    pub cycle: u64,
    /// The latest events.
    pub events: Events,
    /// Which rows of the tables were taken.
    #[serde(skip)]
    pub taken: TakenTransitions,
}

impl Log {
    /// Notes that a rule allowed something.
    pub(super) fn note(&mut self, place: Place, rule: Rule, inputs: [Input; 3], parent: EventId) -> EventId {
        self.events.push(self.cycle, place, rule.number(), inputs, parent)
    }

    /// Notes it with one input.
    pub(super) fn note_one(&mut self, place: Place, rule: Rule, input: Input, parent: EventId) -> EventId {
        self.note(place, rule, [input, Input::None, Input::None], parent)
    }

    /// Notes it without inputs.
    pub(super) fn note_plain(&mut self, place: Place, rule: Rule, parent: EventId) -> EventId {
        self.note(place, rule, [Input::None; 3], parent)
    }
}

/// A signal of an axis as an input.
#[must_use]
pub(super) const fn axis_bit(axis: AxisNumber, byte: u16, bit: u8, value: bool) -> Input {
    Input::Bit(SignalBit { place: Place::Axis(axis), byte, bit }, value)
}
