//! PRESETON of a program and PRESET of the operator: an axis gets another actual value at the place where it stands (SYN-10).
//!
//! Only the leading axis of a grouping can be preset. The values of all its axes are shifted by the same distance, so that the difference between
//! them stays; all of them lose their references, and the grouping its synchronism. Nothing moves. The operator presets in JOG, at standstill.

use crate::image::mode_group_from_nck;
use crate::sinumerik::alarms;
use crate::sinumerik::inputs::mode_group_signal;
use crate::sinumerik::nck::Nck;
use crate::sinumerik::operation::state::Mode;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::source::Problem;
use crate::units::{AxisNumber, Position};
use crate::variables::{EventId, Input, Parameter, Place, Quantity};

impl Nck {
    /// Whether the operator can preset this axis.
    pub(in crate::sinumerik) fn check_preset(&self, axis: AxisNumber, value: f64) -> Result<(), Problem> {
        if !self.parameters.axes[axis].exists || self.parameters.axes[axis].gantry_follower {
            let found = format!("expected a leading axis or a single axis for PRESET, found {}", self.axis_words(axis));
            return Err(Problem::new(found, "PRESET acts on the leading axis of a gantry grouping, for all its axes"));
        }
        if value.is_finite() && value.abs() <= 1e9 {
            return Ok(());
        }
        Err(Problem::new(format!("expected an actual value of at most 1000000000, found {value}"), "correct the value"))
    }

    fn axis_words(&self, axis: AxisNumber) -> String {
        self.stored().axis_name(axis).to_owned()
    }

    /// PRESET of the operator; 22321 in another mode than JOG, and while an axis of the unit moves.
    pub(in crate::sinumerik) fn preset(&mut self, axis: AxisNumber, value: f64) -> EventId {
        let state = &mut *self.state;
        let Some(unit) = state.unit_of(axis) else { return EventId::NONE };
        let jog = state.mode_group(&unit).mode == Mode::Jog;
        let input = mode_group_signal(unit.mode_group, mode_group_from_nck::active_mode_jog, jog);
        let event = state.log.note_one(Place::Axis(axis), Rule::PresetByOperator, input, EventId::NONE);
        if !jog || unit.members().any(|member| state.axes[member].is_in_motion()) {
            let shown = [Parameter::Channel(unit.channel), Parameter::Axis(axis), Parameter::None, Parameter::None];
            state.alarms.raise(alarms::programs::PRESET_IN_MOTION, Place::Axis(axis), shown, event);
        } else {
            state.set_actual_value(&unit, Position::from_user(value), event);
        }
        self.wake_all();
        event
    }
}

impl State {
    /// The axes of a unit get other actual values: the first of them this one.
    pub(in crate::sinumerik) fn set_actual_value(&mut self, unit: &Unit, value: Position, cause: EventId) {
        let leader = unit.leader();
        self.absorb_overlay(leader);
        let shift = value - self.axes[leader].setpoint.position;
        for number in unit.members() {
            let input = Input::Length(Quantity::Position, number, self.axes[number].actual + shift);
            let event = self.log.note_one(Place::Axis(number), Rule::Preset, input, cause);
            let axis = &mut self.axes[number];
            for encoder in 0..axis.referenced.len() {
                if std::mem::replace(&mut axis.referenced[encoder], false) {
                    axis.causes.reference[encoder] = event;
                }
            }
        }
        // The differences count from where they are: all axes are shifted alike.
        for number in unit.members() {
            self.shift_actual_value(number, shift);
        }
    }
}
