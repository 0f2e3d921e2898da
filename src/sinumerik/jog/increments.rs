//! Machine functions of JOG, INC1 to INC10000, INCvar and continuous: the active one, and the movements that a press of a
//! traversing key starts and ends.
//!
//! Called once per cycle: [`State::select_group_functions`] and [`State::select_functions`] before the units,
//! [`Jogging::take_keys`] from `jog/mod.rs` while an axis is jogged. Reads DBX5.0 to 5.6 of the axis, or DB11.DBX2.0 to 2.6 (22.0
//! to 22.6) for all axes of a mode group if DB10.DBX57.0 = 1. Writes DBX65.0 to 65.6, and DB11.DBX8.0 to 8.6 (28.0 to 28.6) if
//! 57.0 = 1. An increment is MD11330 (INCvar: SD41010) times MD31090; a negative MD31090 inverts it.
//!
//! Choices where the manuals leave one: no request means continuous, and of several requests the smallest increment applies. A
//! selection ends the running movement of a key (O-26) and acts on the next press; a handwheel goes on. An increment counts
//! from the setpoint and begins at standstill, so a key that is pressed while the axis brakes waits for standstill. Only a
//! press starts an increment: a key that was held before JOG, that remains pressed of two keys, or that becomes active again
//! with 4.4 = 0 starts none. An event that ends an increment early (the key, MD11300; 4.4; 2.2; RESET; a stop; a limit) drops
//! the rest of it.

use crate::image::{ToNck, nck_to_nck};
use crate::sinumerik::inputs::{axis_signal, mode_group_signal, nck_signal};
use crate::sinumerik::jog::state::{Function, GroupFunction};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::resting::Resting;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::variables::{EventId, Input, Place};

impl State {
    /// The machine function that a mode group selects for its axes.
    pub(in crate::sinumerik) fn select_group_functions(&mut self, parameters: &Parameters, to_nck: &ToNck) {
        let central = to_nck.nck.increment_inputs_active_in_mode_group_area();
        for group in parameters.existing_mode_groups() {
            let requested = to_nck.mode_groups[group].requested_machine_functions();
            let jogging = self.mode_groups[group].is_jogging();
            let function = (central && jogging).then(|| Function::requested(requested));
            if function != self.group_functions[group].function {
                let shown = function.unwrap_or_default();
                let place = Place::ModeGroup(group);
                let request = mode_group_signal(group, shown.of_mode_group(), requested & shown.bits() != 0);
                let where_from = nck_signal(nck_to_nck::increment_inputs_active_in_mode_group_area, central);
                let inputs = [where_from, request, Input::None];
                let cause = self.log.note(place, Rule::IncrementSelected, inputs, EventId::NONE);
                self.group_functions[group] = GroupFunction { function, cause };
            }
        }
    }

    /// The machine function of the axes; only in JOG without another machine function.
    pub(in crate::sinumerik) fn select_functions(
        &mut self,
        parameters: &Parameters,
        to_nck: &ToNck,
        resting: &Resting,
    ) {
        for number in resting.deciding().iter() {
            let group = parameters.mode_group(self.owners.of(number).channel);
            if !self.mode_groups[group].is_jogging() {
                self.axes[number].jogging.shown = 0;
                continue;
            }
            let GroupFunction { function: of_group, cause } = self.group_functions[group];
            let requested = to_nck.axes[number].requested_machine_functions();
            let function = of_group.unwrap_or_else(|| Function::requested(requested));
            if function != self.axes[number].jogging.function {
                let (parent, input) = if of_group.is_some() {
                    (cause, Input::None)
                } else {
                    (EventId::NONE, axis_signal(number, function.of_axis(), requested & function.bits() != 0))
                };
                let event = self.log.note_one(Place::Axis(number), Rule::IncrementSelected, input, parent);
                self.axes[number].jogging.function = function;
                self.axes[number].jogging.function_cause = event;
            }
            self.axes[number].jogging.shown = function.bits();
        }
    }
}
