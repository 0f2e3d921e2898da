//! Conditions of enabling, measuring systems, exact stop and standstill.

use crate::control::{Condition, Fact, fact, yes};
use crate::image::{axis_from_nck, axis_to_nck, nck_from_nck};
use crate::motion::Brake;
use crate::sinumerik::alarms::Reaction;
use crate::sinumerik::axis::controllers::{ControllerState, STEP};
use crate::sinumerik::parameters::dynamics::StopLimit;
use crate::sinumerik::program::state::ProgramState;
use crate::sinumerik::publish::conditions::look::{Look, Row, length};
use crate::sinumerik::state::Unit;
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
        axis_from_nck::follow_up_active,
        |look, axis| look.follow_up(axis, true),
        |look, axis| look.follow_up(axis, false),
    ),
    Row::with(
        axis_from_nck::axis_stationary,
        |look, owner| look.stationary(owner),
        |look, owner| look.stationary_no_more(owner),
    ),
    Row::with(
        axis_from_nck::position_controller_active,
        |look, axis| look.position_control(axis, true),
        |look, axis| look.position_control(axis, false),
    ),
    Row::with(
        axis_from_nck::speed_controller_active,
        |look, axis| look.controllers(axis, 1),
        |look, axis| look.switched_off(axis, 1),
    ),
    Row::with(
        axis_from_nck::current_controller_active,
        |look, axis| look.controllers(axis, 0),
        |look, axis| look.switched_off(axis, 0),
    ),
    Row::new(axis_from_nck::ramp_function_generator_disable_active, |look, owner| look.fast_stop(owner)),
    Row::new(axis_from_nck::drive_test_travel_request, |look, axis| look.test_travel(axis)),
    Row::with(
        axis_from_nck::holding_brake_open,
        |look, axis| look.brake(axis, true),
        |look, axis| look.brake(axis, false),
    ),
    Row::new(axis_from_nck::drive_ready, |look, owner| look.drive_ready(owner)),
    Row::with(
        axis_from_nck::pulses_enabled,
        |look, owner| look.pulses_enabled(owner),
        |look, owner| look.pulses_disabled(owner),
    ),
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

    fn stationary_no_more(self, number: AxisNumber) -> Condition {
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

    fn drive_ready(self, axis: AxisNumber) -> Condition {
        let ready = self.state.axes[axis].drive_ready;
        let found = if ready { "ready" } else { "not ready" };
        Fact::new(format!("the drive of {} reports", self.axis_name(axis)), found, "ready", ready).into()
    }

    fn pulses_fact(self, axis: AxisNumber, wanted: bool) -> Fact {
        let on = self.state.axes[axis].enabling.pulses_enabled();
        let word = |on| if on { "enabled" } else { "disabled" };
        Fact::new(format!("pulses of {}", self.axis_name(axis)), word(on), word(wanted), on == wanted)
    }

    /// 93.5, 21.7 and 2.1; without 2.1 the pulses stay until position control is off (O-25).
    fn pulse_conditions(self, axis: AxisNumber) -> Condition {
        let mut enable = self.axis(axis, axis_to_nck::controller_enable, true);
        if self.state.axes[axis].enabling.control != ControllerState::Off {
            let control = Fact::new(format!("position control of {}", self.axis_name(axis)), "on", "on", true);
            enable = Condition::Any(vec![enable, control.into()]);
        }
        Condition::All(vec![
            enable,
            self.axis(axis, axis_to_nck::pulse_enable, true),
            self.axis(axis, axis_from_nck::drive_ready, true),
            fact("the start-up of the control has ended", self.state.run_up.is_nc_ready())
                .after(|| self.nck(nck_from_nck::drives_ready, true)),
        ])
    }

    /// The drive opens the brake when pulses and speed controller hold the axis, or by 20.5, and closes it when the axis is switched off.
    /// The brake takes its time.
    fn brake(self, axis: AxisNumber, wanted: bool) -> Condition {
        let (state, name) = (&self.state.axes[axis], self.axis_name(axis));
        let found = match state.brake {
            Brake::None => "none",
            Brake::Closed => "closed",
            Brake::Moving => "opens or closes",
            Brake::Open => "open",
        };
        let is_open = state.brake == Brake::Open;
        let word = if wanted { "open" } else { "not open" };
        let shown = Fact::new(format!("holding brake of {name} (plant.toml)"), found, word, is_open == wanted);
        if state.brake == Brake::None {
            return shown.into();
        }
        shown.after(|| {
            let holds = matches!(state.enabling.control, ControllerState::Holding(_));
            let off = fact(format!("{name} is at rest and about to be switched off"), holds);
            let by_plc = self.axis(axis, axis_to_nck::open_holding_brake, wanted);
            if wanted {
                let off = Condition::from(off).opposite();
                let by_drive = Condition::All(vec![self.pulses_enabled(axis), self.controllers(axis, 1), off]);
                let moves = fact(format!("the brake of {name} has had its time"), state.brake != Brake::Moving);
                Condition::All(vec![Condition::Any(vec![by_plc, by_drive]), moves.into()])
            } else {
                let off = [off.into(), self.pulses_disabled(axis), self.switched_off(axis, 1)];
                Condition::All(vec![by_plc, Condition::Any(off.into())])
            }
        })
    }

    /// 61.5: the position controller; of a spindle, also that its loop is not open for speed control.
    fn position_control(self, axis: AxisNumber, wanted: bool) -> Condition {
        let controller = if wanted { self.controllers(axis, 2) } else { self.switched_off(axis, 2) };
        if self.spindle(axis).is_none() {
            return controller;
        }
        let open = self.state.axes[axis].speed_controlled;
        let found = if open { "speed control" } else { "position control" };
        let word = if wanted { "position control" } else { "speed control" };
        let what = format!("loop of the spindle {}", self.axis_name(axis));
        let of_loop = Fact::new(what, found, word, open != wanted).into();
        if wanted { Condition::All(vec![controller, of_loop]) } else { Condition::Any(vec![controller, of_loop]) }
    }

    fn pulses_enabled(self, axis: AxisNumber) -> Condition {
        self.pulses_fact(axis, true).after(|| self.pulse_conditions(axis))
    }

    fn pulses_disabled(self, axis: AxisNumber) -> Condition {
        self.pulses_fact(axis, false).after(|| self.pulse_conditions(axis).opposite())
    }

    /// The axis is in position control and not about to leave it.
    pub(super) fn in_control(self, number: AxisNumber) -> Condition {
        let axis = &self.state.axes[number];
        if matches!(axis.enabling.control, ControllerState::Braking(_)) {
            let what = format!("position control of {}", self.axis_name(number));
            return Fact::new(what, "brakes before it is switched off", "on", false)
                .after(|| self.enables(&self.unit(number)));
        }
        self.axis(number, axis_from_nck::position_controller_active, true)
    }

    /// Controllers of an axis: current 0, speed 1, position 2.
    fn controllers(self, number: AxisNumber, which: usize) -> Condition {
        let axis = &self.state.axes[number];
        let name = ["current controller", "speed controller", "position control"][which];
        let on = axis.enabling.controllers()[which];
        let found = match axis.enabling.control {
            ControllerState::Off => "off".to_owned(),
            ControllerState::SwitchingOn(cycles) => {
                format!("switching on, cycle {} of {}", cycles + 1, 3 * STEP)
            }
            ControllerState::On => "on".to_owned(),
            ControllerState::Braking(_) => "brakes before it is switched off".to_owned(),
            ControllerState::Holding(_) => "waits for its brake before it is switched off".to_owned(),
        };
        Fact::new(format!("{name} of {}", self.axis_name(number)), found, "on", on).after(|| {
            let enables = self.enables(&self.unit(number));
            // Position control begins when the brake is open.
            let waits = which == 2 && !matches!(axis.brake, Brake::None | Brake::Open);
            if waits {
                Condition::All(vec![enables, self.axis(number, axis_from_nck::holding_brake_open, true)])
            } else {
                enables
            }
        })
    }

    /// What switches position control of a unit on: the enables of each of its axes, and nothing that forbids it (SIG-01).
    pub(super) fn enables(self, unit: &Unit) -> Condition {
        let mut all = self.enables_of_axes(unit);
        all.push(self.nck(nck_from_nck::emergency_stop_active, false));
        all.extend(unit.members().map(|axis| self.no_follow_up_alarm(axis)));
        Condition::All(all)
    }

    /// The enables of each axis of a unit.
    pub(super) fn enables_of_axes(self, unit: &Unit) -> Vec<Condition> {
        let of_axis = |axis| {
            let enable = self.axis(axis, axis_to_nck::controller_enable, true);
            [enable, self.not_parked(axis), self.axis(axis, axis_from_nck::pulses_enabled, true)]
        };
        unit.members().flat_map(of_axis).collect()
    }

    fn no_follow_up_alarm(self, axis: AxisNumber) -> Condition {
        self.no_alarm(format!("alarm of {} with the reaction follow-up", self.axis_name(axis)), |place, alarm| {
            place == Place::Axis(axis) && alarm.reaction.has(Reaction::FOLLOW_UP)
        })
    }

    /// Controllers go off when an enable is missing; a moving axis brakes first.
    fn switched_off(self, number: AxisNumber, which: usize) -> Condition {
        let axis = &self.state.axes[number];
        let braking = matches!(axis.enabling.control, ControllerState::Braking(_));
        let found = if braking { "brake before they are switched off" } else { "on" };
        let on = axis.enabling.controllers()[which];
        let name = self.axis_name(number);
        Fact::new(format!("controllers of {name}"), if on { found } else { "off" }, "off", !on).after(|| {
            if braking {
                let unit = self.unit(number);
                let standing = unit.members().map(|axis| self.stands(axis));
                return Condition::All(standing.collect());
            }
            if matches!(axis.enabling.control, ControllerState::Holding(_)) {
                return fact(format!("the brake of {name} is closed"), axis.brake == Brake::Closed).into();
            }
            self.enables(&self.unit(number)).opposite()
        })
    }

    /// The setpoint rests and the axis is slower than MD36060.
    pub(super) fn stands(self, axis: AxisNumber) -> Condition {
        Condition::All(vec![self.setpoint_rests(axis), self.slow(axis)])
    }

    fn follow_up(self, number: AxisNumber, wanted: bool) -> Condition {
        let axis = &self.state.axes[number];
        let on = axis.enabling.follow_up;
        let word = |on| if on { "on" } else { "off" };
        let state = Fact::new(format!("follow-up of {}", self.axis_name(number)), word(on), word(wanted), on == wanted);
        let unit = self.unit(number);
        let state = state.after(|| {
            let mode = unit.members().map(|axis| self.axis(axis, axis_to_nck::follow_up_mode, true));
            let enable = unit.members().map(|axis| self.axis(axis, axis_to_nck::controller_enable, true));
            let asked = Condition::All(vec![
                Condition::Any(mode.collect()),
                Condition::All(enable.collect::<Vec<_>>()).opposite(),
            ]);
            let alarms = unit.members().map(|axis| self.no_follow_up_alarm(axis).opposite());
            let emergency = self.nck(nck_from_nck::emergency_stop_active, true);
            let causes = [asked, emergency].into_iter().chain(alarms);
            if wanted {
                Condition::All(vec![
                    Condition::Any(causes.collect()),
                    self.axis(number, axis_from_nck::position_controller_active, false),
                ])
            } else {
                // It lasts until position control is active or holds without it.
                let gone = Condition::Any(causes.collect()).opposite();
                let switching = matches!(axis.enabling.control, ControllerState::SwitchingOn(_));
                let not_switching =
                    fact(format!("{} is in position control or holds", self.axis_name(number)), !switching);
                Condition::All(vec![gone, not_switching.into()])
            }
        });
        let active = self.not_parked(number);
        // Parking ends the display, but loses the reference: it comes last.
        if wanted { Condition::All(vec![active, state]) } else { Condition::Any(vec![state, active.opposite()]) }
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
