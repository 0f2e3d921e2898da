//! Extended monitoring of the synchronism difference: MD37150 bit 0 of the synchronous axis (G1 2.2, E-14).
//!
//! Without it, an offset that arose in follow-up or in the opened grouping is the base of the limits. With it, the offset counts: the
//! difference itself is tested. It acts once all axes of the grouping have been referenced after power on, with an absolute
//! encoder once they have been synchronised (MON-10).
//!
//! A trip in extended monitoring writes the difference into MD37135, in the next cycle, or before a power off that comes earlier. 10653 then stays, also without the difference,
//! until a RESET at which MD37150 bit 0 = 0 and MD37135 = 0 are in effect (MON-11; both become active by this RESET). After power off and
//! on, 10657 is raised instead if MD37150 bit 0 = 1 and MD37135 is not 0; either of bit 0 = 0 and MD37135 = 0 lets a RESET cancel it (C-77). This
//! RESET also ends extended monitoring: with bit 0 = 1 again it acts only after the next referencing or synchronisation of the grouping
//! (MON-11).
//!
//! Choices where the manuals leave one: MD37135 keeps the largest of the differences that tripped since it was 0. While an axis is not
//! referenced, its difference counts from the return to position control in both settings (O-12). MD37135 is a length in the basic system
//! (MD10240), as every other datum.

use std::sync::Arc;

use crate::control::Log;
use crate::sinumerik::alarms;
use crate::sinumerik::gantry::state::Grouping;
use crate::sinumerik::gantry::view::{View, Want, Wants};
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::units::{AxisNumber, Position};
use crate::variables::{EventId, Input, Parameter, Place};

impl Grouping {
    /// After power on: the axes that were switched off while the limit was exceeded.
    pub(in crate::sinumerik) fn remember_trips(&mut self, parameters: &Parameters) {
        for axis in self.coupling.followers() {
            let gantry = &parameters.axes[axis].gantry;
            let tripped = gantry.extended_monitoring && gantry.tripped_difference != Position::ZERO;
            if tripped {
                self.extended.switched_off.push((axis, EventId::NONE));
            }
        }
    }

    /// 10653 and 10657 of extended monitoring, raised in each cycle in which they apply.
    pub(in crate::sinumerik) fn hold_trips(
        &mut self,
        view: &View<'_>,
        defined: EventId,
        log: &mut Log,
        wants: &mut Wants,
    ) {
        let parameters = |axis: AxisNumber| &view.parameters.axes[axis];
        let before = self.extended.switched_off.len();
        self.extended.switched_off.retain(|(axis, event)| {
            let gantry = &parameters(*axis).gantry;
            let (stored, extended) = (gantry.tripped_difference, gantry.extended_monitoring);
            if extended && stored != Position::ZERO && *event == EventId::NONE {
                let stored = Input::Datum(37135, Some(*axis), stored.user());
                let extended = Input::Datum(37150, Some(*axis), f64::from(gantry.function_mask));
                *event =
                    log.note(Place::Axis(*axis), Rule::SwitchedOffTripped, [stored, extended, Input::None], defined);
            }
            extended && stored != Position::ZERO
        });
        if self.extended.switched_off.len() < before {
            self.extended.readiness.release();
        }
        for found in self.monitored() {
            let shown = [
                Parameter::Channel(parameters(found.axis).channel),
                Parameter::Axis(found.axis),
                Parameter::None,
                Parameter::None,
            ];
            let place = Place::Axis(found.axis);
            if self.extended.tripped.contains(found.axis) && !found.trip {
                let (alarm, cause) = (alarms::GANTRY_TRIP_LIMIT, found.causes.trip);
                wants.push(Want::Raise { alarm, place, shown, cause });
            }
            if let Some((_, cause)) = self.extended.switched_off.iter().find(|(axis, _)| *axis == found.axis) {
                wants.push(Want::Raise { alarm: alarms::GANTRY_SWITCHED_OFF, place, shown, cause: *cause });
            }
        }
    }
}

impl Nck {
    /// Writes the differences that tripped in the last cycle into MD37135, stored and active.
    pub(in crate::sinumerik) fn store_differences(&mut self) {
        if self.state.groupings.iter().all(|grouping| grouping.extended.differences.is_empty()) {
            return;
        }
        let before = Arc::clone(&self.active);
        let mut cause = EventId::NONE;
        for grouping in &mut self.state.groupings {
            for (axis, difference) in std::mem::take(&mut grouping.extended.differences) {
                let number = before.number_of(axis, difference);
                let larger = |old: f64| if old.abs() < number.abs() { number } else { old };
                for data in [&mut self.stored, &mut self.active] {
                    let data = &mut Arc::make_mut(data).axes[axis];
                    data.gantry_act_pos_tol_error = larger(data.gantry_act_pos_tol_error);
                }
                let found = grouping.monitored().find(|monitored| monitored.axis == axis);
                cause = cause.max(found.map_or(EventId::NONE, |found| found.causes.trip));
            }
        }
        self.parameters = Arc::new(self.parameters_now());
        self.resting.wake_all();
        self.note_activated(&before, Rule::DifferenceStored, cause);
    }

    /// A RESET at which MD37150 bit 0 = 0 and MD37135 = 0 take effect releases 10653 of extended monitoring (MON-11).
    pub(in crate::sinumerik) fn release_trips(&mut self) {
        for grouping in &mut self.state.groupings {
            for axis in grouping.extended.tripped.iter() {
                let data = &self.stored.axes[axis];
                if data.gantry_function_mask & 1 == 0 && data.gantry_act_pos_tol_error == 0.0 {
                    grouping.extended.tripped.set(axis, false);
                    grouping.extended.readiness.release();
                }
            }
        }
    }
}
