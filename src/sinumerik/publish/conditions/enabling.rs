//! Conditions of enabling: drive, pulses, controllers, holding brake, follow-up.

use crate::control::{Condition, Fact, fact};
use crate::image::{axis_from_nck, axis_to_nck, nck_from_nck};
use crate::motion::Brake;
use crate::sinumerik::alarms::Reaction;
use crate::sinumerik::axis::controllers::{ControllerState, STEP};
use crate::sinumerik::publish::conditions::look::{Look, Row};
use crate::sinumerik::state::Unit;
use crate::units::AxisNumber;
use crate::variables::Place;

/// The signals.
pub(super) const ROWS: &[Row<AxisNumber>] = &[
    Row::with(
        axis_from_nck::follow_up_active,
        |look, axis| look.follow_up(axis, true),
        |look, axis| look.follow_up(axis, false),
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
];

impl Look<'_> {
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
        let of_loop = Fact::new(what, found, word, open != wanted).after(|| {
            let block = if wanted { "one with SPOS, SPOSA, M19 or M70" } else { "one with M3, M4 or M5" };
            Condition::Any(vec![self.by_program(axis, block), self.start_by_plc(axis)])
        });
        if wanted { Condition::All(vec![controller, of_loop]) } else { Condition::Any(vec![controller, of_loop]) }
    }

    pub(super) fn pulses_enabled(self, axis: AxisNumber) -> Condition {
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

    pub(super) fn no_follow_up_alarm(self, axis: AxisNumber) -> Condition {
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
}
