//! Conditions of measuring systems, exact stop and standstill.

use crate::control::{Condition, Fact, fact, yes};
use crate::image::{axis_from_nck, axis_to_nck};
use crate::motion::Brake;
use crate::sinumerik::alarms::Reaction;
use crate::sinumerik::parameters::dynamics::StopLimit;
use crate::sinumerik::program::state::ProgramState;
use crate::sinumerik::publish::conditions::look::{Look, Row, length};
use crate::units::AxisNumber;
use crate::variables::{Place, six_decimals};

/// The signals.
pub(super) const ROWS: &[Row<AxisNumber>] = &[
    Row::new(axis_from_nck::encoder_limit_frequency_exceeded_1, |look, axis| look.frequency(axis, 0)),
    Row::new(axis_from_nck::encoder_limit_frequency_exceeded_2, |look, axis| look.frequency(axis, 1)),
    Row::new(axis_from_nck::position_reached_exact_stop_coarse, |look, axis| look.exact_stop(axis, StopLimit::Coarse)),
    Row::new(axis_from_nck::position_reached_exact_stop_fine, |look, axis| look.exact_stop(axis, StopLimit::Fine)),
    Row::new(axis_from_nck::axis_specific_alarm, |look, axis| look.shown_alarm(axis).opposite()),
    Row::new(axis_from_nck::axis_ready, |look, owner| look.axis_ready(owner)),
    Row::with(
        axis_from_nck::axis_stationary,
        |look, owner| look.stationary(owner),
        |look, owner| look.stationary_no_more(owner),
    ),
    Row::new(axis_from_nck::ramp_function_generator_disable_active, |look, owner| look.fast_stop(owner)),
    Row::new(axis_from_nck::drive_test_travel_request, |look, axis| look.test_travel(axis)),
    Row::with(
        axis_from_nck::position_measuring_system_1_activated,
        |look, axis| look.measuring_system(axis, 0),
        |look, axis| look.measuring_system_off(axis, 0),
    ),
    Row::with(
        axis_from_nck::position_measuring_system_2_activated,
        |look, axis| look.measuring_system(axis, 1),
        |look, axis| look.measuring_system_off(axis, 1),
    ),
];

impl Look<'_> {
    fn test_travel(self, axis: AxisNumber) -> Condition {
        let requested = self.state.axes[axis].test_travel.requested;
        let found = if requested { "started" } else { "not started" };
        let what = format!("function generator of {}", self.axis_name(axis));
        Fact::new(what, found, "started by NC start in JOG", requested).into()
    }

    fn frequency(self, axis: AxisNumber, encoder: usize) -> Condition {
        let exceeded = self.state.axes[axis].monitor.encoders[encoder].frequency_exceeded;
        let found = if exceeded { "above" } else { "not above" };
        let what = format!("frequency of encoder {} of {}", encoder + 1, self.axis_name(axis));
        Fact::new(what, found, "above MD36300", exceeded).into()
    }

    fn exact_stop(self, number: AxisNumber, limit: StopLimit) -> Condition {
        let pending = self.state.axes[number].travel.is_pending();
        let at_rest =
            Fact::new(format!("a movement of {} is pending", self.axis_name(number)), yes(pending), "no", !pending);
        Condition::All(vec![
            self.axis(number, axis_from_nck::position_controller_active, true),
            at_rest.into(),
            self.setpoint_rests(number),
            self.not_moved_beside(number),
            self.deviation(number, limit),
        ])
    }

    /// Neither a DRF offset nor the function generator moves an axis: they are beside the setpoint of its own movement.
    fn not_moved_beside(self, axis: AxisNumber) -> Condition {
        let state = &self.state.axes[axis];
        let found = match (state.overlay.command != 0, state.test_travel.moves) {
            (true, _) => "DRF",
            (false, true) => "the function generator",
            (false, false) => "none",
        };
        let what = format!("movement of {} beside its setpoint", self.axis_name(axis));
        Fact::new(what, found, "none", found == "none").into()
    }

    pub(super) fn setpoint_rests(self, axis: AxisNumber) -> Condition {
        fact(format!("the setpoint of {} rests", self.axis_name(axis)), self.state.axes[axis].setpoint.is_at_rest())
            .into()
    }

    pub(super) fn deviation(self, axis: AxisNumber, limit: StopLimit) -> Condition {
        let deviation = self.state.axes[axis].deviation().abs();
        let (window, data) = self.state.axes[axis].active_set(&self.parameters.axes[axis]).window(limit);
        let what = format!("deviation of {} from its setpoint", self.axis_name(axis));
        let wanted = format!("at most {} ({data})", length(window));
        Fact::new(what, length(deviation), wanted, deviation <= window).into()
    }

    /// O-29: no new setpoints, and the velocity below MD36060.
    pub(super) fn stationary(self, number: AxisNumber) -> Condition {
        Condition::All(vec![self.outputs_setpoints(number, false).into(), self.slow(number)])
    }

    pub(super) fn stationary_no_more(self, number: AxisNumber) -> Condition {
        let outputs = self.outputs_setpoints(number, true).after(|| self.setpoints_begin(number));
        Condition::Any(vec![outputs, self.slow(number).opposite()])
    }

    fn outputs_setpoints(self, number: AxisNumber, wanted: bool) -> Fact {
        let outputs = self.state.axes[number].outputs_setpoints();
        let what = format!("new setpoints are output to the drive of {}", self.axis_name(number));
        Fact::new(what, yes(outputs), yes(wanted), outputs == wanted)
    }

    /// What a movement that waits needs; without one, a traverse command.
    fn setpoints_begin(self, number: AxisNumber) -> Condition {
        let unit = self.unit(number);
        if !self.state.axes[number].travel.is_pending() {
            let commands = [axis_from_nck::traverse_command_minus, axis_from_nck::traverse_command_plus];
            let commanded = Condition::Any(commands.map(|command| self.axis(number, command, true)).into());
            let program = &self.state.programs[unit.channel];
            let runs = matches!(program.state, ProgramState::Running | ProgramState::Waiting);
            if self.state.axes[number].compensation.command == 0 && runs {
                let next = self.reaches(unit.channel, "one that moves the axis");
                return Condition::All(vec![commanded, next]);
            }
            if self.state.axes[number].compensation.command == 0 {
                return commanded;
            }
            // The command of a compensation is not one of a movement (SIG-10).
            let what = format!("movement of {} in addition to its compensation", self.axis_name(number));
            return Condition::All(vec![commanded, Fact::new(what, "none", "one", false).into()]);
        }
        if self.state.single.axes[unit.leader()].order.is_some() {
            return Condition::All(self.not_held_alone(&unit));
        }
        let mut all = vec![self.may_move(&unit), self.not_held(&unit)];
        if self.spindle(number).is_none() {
            all.extend(self.no_spindle_awaited(unit.channel));
        }
        all.extend(unit.members().flat_map(|axis| {
            let enable = self.axis(axis, axis_to_nck::controller_enable, true);
            [enable, self.selects_one(axis), self.pulses_enabled(axis), self.no_follow_up_alarm(axis)]
        }));
        // Position control of an axis begins when its brake is open.
        let has_brake = |axis: &AxisNumber| self.state.axes[*axis].brake != Brake::None;
        all.extend(
            unit.members().filter(has_brake).map(|axis| self.axis(axis, axis_from_nck::holding_brake_open, true)),
        );
        Condition::All(all)
    }

    fn slow(self, number: AxisNumber) -> Condition {
        let (axis, parameters) = (&self.state.axes[number], &self.parameters.axes[number]);
        let what = format!("velocity of {}", self.axis_name(number));
        let wanted = format!("below {} (MD36060)", six_decimals(parameters.per_minute(parameters.standstill_velocity)));
        let holds = axis.velocity.abs() < parameters.standstill_velocity;
        Fact::new(what, six_decimals(parameters.per_minute(axis.velocity.abs())), wanted, holds).into()
    }

    fn shown_alarm(self, axis: AxisNumber) -> Condition {
        self.no_alarm(format!("alarm of {} with interface signals", self.axis_name(axis)), |place, alarm| {
            place == Place::Axis(axis) && alarm.reaction.has(Reaction::INTERFACE_SIGNALS)
        })
    }

    fn axis_ready(self, axis: AxisNumber) -> Condition {
        Condition::All(vec![
            self.axis(axis, axis_from_nck::drive_ready, true),
            self.not_parked(axis),
            self.shown_alarm(axis),
        ])
    }

    /// One of the measuring systems is active.
    pub(super) fn not_parked(self, axis: AxisNumber) -> Condition {
        Condition::Any(vec![
            self.axis(axis, axis_from_nck::position_measuring_system_1_activated, true),
            self.axis(axis, axis_from_nck::position_measuring_system_2_activated, true),
        ])
    }

    fn fast_stop(self, axis: AxisNumber) -> Condition {
        let unit = self.unit(axis);
        let stopping = unit.members().map(|axis| self.axis(axis, axis_to_nck::ramp_function_generator_fast_stop, true));
        Condition::Any(stopping.collect())
    }

    /// The setpoint rests and the axis is slower than MD36060.
    pub(super) fn stands(self, axis: AxisNumber) -> Condition {
        Condition::All(vec![self.setpoint_rests(axis), self.slow(axis)])
    }

    fn selected_fact(self, number: AxisNumber, encoder: u8, wanted: bool) -> Fact {
        let active = self.state.axes[number].measuring_system;
        let found = active.map_or_else(|| "none: the axis is parked".to_owned(), |active| (active + 1).to_string());
        let other = if wanted { String::new() } else { "not ".to_owned() };
        let wanted_text = format!("{other}{}", encoder + 1);
        Fact::new(
            format!("active measuring system of {}", self.axis_name(number)),
            found,
            wanted_text,
            (active == Some(encoder)) == wanted,
        )
    }

    fn measuring_system(self, number: AxisNumber, encoder: u8) -> Condition {
        self.selected_fact(number, encoder, true).after(|| {
            let count = self.parameters.axes[number].encoders;
            let exist = Fact::new(
                format!("measuring systems of {} (MD30200)", self.axis_name(number)),
                count.to_string(),
                format!("at least {}", encoder + 1),
                count > encoder,
            );
            let mut all = vec![exist.into()];
            if encoder == 0 {
                all.push(self.axis(number, axis_to_nck::position_measuring_system_1, true));
            } else {
                all.push(self.axis(number, axis_to_nck::position_measuring_system_1, false));
                all.push(self.axis(number, axis_to_nck::position_measuring_system_2, true));
            }
            // Parking applies to all axes of a unit.
            let unit = self.unit(number);
            all.extend(unit.members().filter(|&axis| axis != number).map(|axis| self.selects_one(axis)));
            let switches = self.state.axes[number].measuring_system.is_some();
            if switches && count > 1 {
                all.push(self.no_alarm(
                    format!("alarm of {} that prevents switching over", self.axis_name(number)),
                    |place, alarm| {
                        place == Place::Axis(number) && alarm.number == crate::sinumerik::alarms::SWITCH_OVER_IMPOSSIBLE
                    },
                ));
            }
            Condition::All(all)
        })
    }

    /// The PLC selects a measuring system of the axis.
    fn selects_one(self, axis: AxisNumber) -> Condition {
        let first = self.axis(axis, axis_to_nck::position_measuring_system_1, true);
        match self.parameters.axes[axis].encoders {
            0 => fact(format!("{} has a measuring system (MD30200)", self.axis_name(axis)), false).into(),
            1 if self.state.axes[axis].measuring_system.is_none() => first,
            _ => Condition::Any(vec![first, self.axis(axis, axis_to_nck::position_measuring_system_2, true)]),
        }
    }

    fn measuring_system_off(self, number: AxisNumber, encoder: u8) -> Condition {
        self.selected_fact(number, encoder, false).after(|| {
            let unit = self.unit(number);
            let mut any: Vec<_> = unit.members().map(|axis| self.selects_one(axis).opposite()).collect();
            if self.parameters.axes[number].encoders > 1 {
                let other = if encoder == 0 {
                    vec![
                        self.axis(number, axis_to_nck::position_measuring_system_1, false),
                        self.axis(number, axis_to_nck::position_measuring_system_2, true),
                    ]
                } else {
                    vec![self.axis(number, axis_to_nck::position_measuring_system_1, true)]
                };
                any.push(Condition::All(other));
            }
            Condition::Any(any)
        })
    }
}
