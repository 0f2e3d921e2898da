//! Machine data become active: when they are stored, at RESET, by "set machine data active", and at power on. What became active is an event, and is
//! remembered for the record of the machine.

use std::sync::Arc;

use crate::control::{Activated, Owner, Value};
use crate::sinumerik::machine_data::{Effect, MachineData, Target};
use crate::sinumerik::nck::Nck;
use crate::sinumerik::rules::Rule;
use crate::source::Problem;
use crate::units::AxisNumber;
use crate::variables::{DatumValue, EventId, Input, Place};

impl Nck {
    /// Stores a machine datum. It takes effect as its class defines.
    ///
    /// # Errors
    /// The value does not fit the datum, or only the control may write it. In this case nothing has changed.
    pub fn store(&mut self, target: &Target, value: &Value) -> Result<(), Problem> {
        Arc::make_mut(&mut self.stored).set(target, value)?;
        if let (30350, Owner::Axis(axis)) = (target.datum().number, target.owner()) {
            self.output_entered[0].set(axis, true);
        }
        if target.datum().effect == Effect::Immediate {
            self.activate(Effect::Immediate, EventId::NONE);
        }
        Ok(())
    }

    /// "Set machine data active".
    pub fn new_conf(&mut self) -> EventId {
        let event = self.state.log.note_plain(Place::Nck, Rule::SetActive, EventId::NONE);
        self.activate(Effect::NewConf, event);
        event
    }

    /// Activates the stored data of a class and of the lower classes, after this event.
    pub(super) fn activate(&mut self, level: Effect, cause: EventId) {
        if Arc::ptr_eq(&self.stored, &self.active) {
            return;
        }
        let before = Arc::clone(&self.active);
        Arc::make_mut(&mut self.active).activate(&self.stored, level);
        self.parameters = Arc::new(self.parameters_now());
        self.state.prepare_position_control(&self.parameters);
        self.resting.wake_all();
        self.note_activated(&before, Rule::DataActive, cause);
    }

    /// Records one event for all data that became active, and remembers them for the record of the machine.
    pub(super) fn note_activated(&mut self, before: &MachineData, rule: Rule, cause: EventId) {
        let changed = self.active.differences(before);
        let shown = |target: &Target| shown(&self.active, target);
        let mut inputs = [Input::None; 3];
        let numbers = changed.iter().filter_map(|target| Some((target, shown(target).value?)));
        for (input, (target, value)) in inputs.iter_mut().zip(numbers) {
            *input = Input::Datum(target.datum().number, axis_of(target), value);
        }
        if changed.is_empty() {
            return;
        }
        let event = self.state.log.note(Place::Nck, rule, inputs, cause);
        for target in &changed {
            self.state.log.activated(target.datum().number, axis_of(target), event);
            self.activated.push(Activated { datum: shown(target), event });
        }
    }

    /// The data that became active since the last call.
    pub(super) fn take_activated(&mut self) -> Vec<Activated> {
        std::mem::take(&mut self.activated)
    }
}

/// The axis of an axial datum.
pub(super) fn axis_of(target: &Target) -> Option<AxisNumber> {
    match target.owner() {
        Owner::Axis(axis) => Some(axis),
        Owner::Nck | Owner::Channel(_) => None,
    }
}

/// A datum with its value in these data, for the trace.
pub(super) fn shown(data: &MachineData, target: &Target) -> DatumValue {
    let place = match target.owner() {
        Owner::Nck => Place::Nck,
        Owner::Channel(channel) => Place::Channel(channel),
        Owner::Axis(axis) => Place::Axis(axis),
    };
    DatumValue {
        number: target.datum().number,
        place,
        index: (target.datum().count > 1).then_some(target.index()),
        value: data.get(target).and_then(|value| value.number()),
        word: None,
    }
}
