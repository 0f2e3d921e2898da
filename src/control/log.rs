//! The events of a cycle: every stage that decides something notes here why.

use serde::{Deserialize, Serialize};

use super::transitions::Taken;
use crate::units::AxisSet;
use crate::variables::{EventId, Events, Input, Place, RuleNumber};

/// The latest events and the cycle that runs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Log {
    /// Number of the cycle that runs.
    pub cycle: u64,
    /// The latest events.
    pub events: Events,
    /// Which rows of the tables of transitions were taken.
    #[serde(skip)]
    pub taken: Taken,
    /// Axes of which something was noted in this cycle, or is known that no decision brought.
    #[serde(skip)]
    pub news: AxisSet,
}

impl Log {
    /// Notes that a rule allowed something.
    pub fn note(&mut self, place: Place, rule: impl Into<RuleNumber>, inputs: [Input; 3], parent: EventId) -> EventId {
        if let Place::Axis(axis) = place {
            self.news.set(axis, true);
        }
        self.events.push(self.cycle, place, rule.into(), inputs, parent)
    }

    /// Whether this event was noted in the cycle that runs.
    #[must_use]
    pub fn is_of_this_cycle(&self, id: EventId) -> bool {
        self.events.find(id).is_some_and(|event| event.cycle == self.cycle)
    }

    /// The event behind something that happens now: `cause` itself if it was noted in this cycle; else a new one with what was tested
    /// now, which `cause` has led to.
    pub fn now(&mut self, place: Place, cause: EventId, rule: impl Into<RuleNumber>, inputs: [Input; 3]) -> EventId {
        if self.is_of_this_cycle(cause) { cause } else { self.note(place, rule, inputs, cause) }
    }

    /// Notes it with one input.
    pub fn note_one(&mut self, place: Place, rule: impl Into<RuleNumber>, input: Input, parent: EventId) -> EventId {
        self.note(place, rule, [input, Input::None, Input::None], parent)
    }

    /// Notes it without inputs.
    pub fn note_plain(&mut self, place: Place, rule: impl Into<RuleNumber>, parent: EventId) -> EventId {
        self.note(place, rule, [Input::None; 3], parent)
    }
}
