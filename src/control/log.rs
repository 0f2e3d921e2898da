//! The events of a cycle: every stage records here the reason for each of its decisions.

use serde::{Deserialize, Serialize};

use super::transitions::Taken;
use crate::units::{AxisNumber, AxisSet};
use crate::variables::{EventId, Events, Input, Place, RuleNumber};

/// The latest events and the present cycle.
///
/// Its owner calls [`Log::begin`] in [`Control::begin_cycle`](super::Control::begin_cycle): each event is recorded with the number of the
/// cycle, and [`Log::is_of_this_cycle`] compares with it. It keeps the events at power on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Log {
    /// Number of the present cycle, as given to [`Control::begin_cycle`](super::Control::begin_cycle).
    pub cycle: u64,
    /// The latest events.
    pub events: Events,
    /// The rows of the transition tables that were used.
    #[serde(skip)]
    pub taken: Taken,
    /// Axes of which something was noted in this cycle, or is known that no decision brought.
    #[serde(skip)]
    pub news: AxisSet,
    /// The machine data that became active in this cycle, of an axis if they are axial, and the event that activated them.
    #[serde(skip)]
    activated: (Vec<(u32, Option<AxisNumber>)>, EventId),
}

impl Log {
    /// A cycle begins.
    pub fn begin(&mut self, cycle: u64) {
        self.cycle = cycle;
        self.activated.0.clear();
    }

    /// A machine datum became active in this cycle. Events of this cycle that test it follow from its activation.
    pub fn activated(&mut self, number: u32, axis: Option<AxisNumber>, event: EventId) {
        let (data, cause) = &mut self.activated;
        data.push((number, axis));
        *cause = event;
    }

    /// The activation behind an event that tests these inputs now.
    fn activation(&self, inputs: &[Input; 3]) -> EventId {
        let (data, event) = &self.activated;
        if !data.is_empty() && inputs.iter().any(|input| self.is_new(input)) { *event } else { EventId::NONE }
    }

    /// Whether this is a machine datum that became active in the present cycle.
    #[must_use]
    pub fn is_new(&self, input: &Input) -> bool {
        match *input {
            Input::Datum(number, axis, _) => self.activated.0.contains(&(number, axis)),
            Input::Element(number, _, axis, _) => self.activated.0.contains(&(number, Some(axis))),
            Input::None
            | Input::Bit(..)
            | Input::Number(..)
            | Input::Length(..)
            | Input::Alarm(_)
            | Input::Fault(_)
            | Input::Block(_) => false,
        }
    }

    /// Records that a rule allowed an action.
    pub fn note(&mut self, place: Place, rule: impl Into<RuleNumber>, inputs: [Input; 3], parent: EventId) -> EventId {
        if let Place::Axis(axis) = place {
            self.news.set(axis, true);
        }
        // The later of the two is closer to the event.
        let parent = parent.max(self.activation(&inputs));
        self.events.push(self.cycle, place, rule.into(), inputs, parent)
    }

    /// Whether this event was recorded in the present cycle.
    #[must_use]
    pub fn is_of_this_cycle(&self, id: EventId) -> bool {
        self.events.find(id).is_some_and(|event| event.cycle == self.cycle)
    }

    /// The event behind a present change: `cause` itself if it was recorded in this cycle; otherwise a new event with the inputs tested
    /// now, with `cause` as its own cause.
    pub fn now(&mut self, place: Place, cause: EventId, rule: impl Into<RuleNumber>, inputs: [Input; 3]) -> EventId {
        if self.is_of_this_cycle(cause) { cause } else { self.note(place, rule, inputs, cause) }
    }

    /// Records it with one input.
    pub fn note_one(&mut self, place: Place, rule: impl Into<RuleNumber>, input: Input, parent: EventId) -> EventId {
        self.note(place, rule, [input, Input::None, Input::None], parent)
    }

    /// Records it without inputs.
    pub fn note_plain(&mut self, place: Place, rule: impl Into<RuleNumber>, parent: EventId) -> EventId {
        self.note(place, rule, [Input::None; 3], parent)
    }
}
