//! Enabling: from drive ready to position control and back (decisions O-20 and O-25).
//!
//! | step | condition |
//! |---|---|
//! | 93.5 | the drive has started up |
//! | 93.7 | 93.5, 21.7 and 2.1 of the axis: the pulses need both enables |
//! | 61.7, 61.6, 61.5 | pulses and 2.1 on every axis of the unit |
//!
//! When 21.7 or the drive goes, the pulses of the axis go at once. When 2.1 goes, they go with position control: once the unit stands, at the
//! latest when MD36620 has passed. Choice where the manuals leave one: the pulses belong to the axis, as 93.7 does, so an axis that only
//! another axis of its grouping holds keeps them, and so does an axis in follow-up by an alarm.
//!
//! Called once per cycle in the stage "enabling", after modes and RESET and before any motion. Reads 1.4 to 1.6, 2.1 and 21.7 of
//! each axis. The axes of a closed grouping form one unit; they are enabled, braked and held together (SIG-01, SIG-02). Writes
//! the state that determines 61.3, 61.5 to 61.7, 93.5, 93.7 and 102.5/.6.

use crate::image::{AxisToNck, Signal, ToNck, axis_from_nck, axis_to_nck, nck_from_nck};
use crate::motion::Brake;
use crate::motion::Motion;
use crate::sinumerik::alarms::{self, Alarm, Reaction};
use crate::sinumerik::axis::controllers::{ControllerState, STEP};
use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::inputs::{axis_signal, nck_signal};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::resting::Resting;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::AxisNumber;
use crate::variables::{EventId, Input, Parameter, Place};

/// Conditions that apply to all axes of a unit.
struct Conditions {
    enable: bool,
    follow_up: bool,
    /// Pulses and measuring system are active on every axis.
    healthy: bool,
    /// The pulses that are missing are being enabled.
    starting: bool,
    /// Emergency stop, or an alarm with the reaction follow-up.
    tracks: Option<(Rule, Input, EventId)>,
    /// Every setpoint and every axis is at rest.
    standing: bool,
    moving: bool,
    /// The signal that removed the enable, with its rule.
    missing: (Rule, Input),
    /// The axis and cause of alarm 21612.
    culprit: (AxisNumber, i64),
}

/// The drive holds an axis at rest for at most this number of cycles until its brake holds.
const HOLDING_CYCLES: u64 = 1_000;

impl State {
    /// Selects measuring systems by 1.5 and 1.6. Parking applies to all axes of a unit.
    pub(in crate::sinumerik) fn select_measuring_systems(
        &mut self,
        parameters: &Parameters,
        to_nck: &ToNck,
        resting: &Resting,
    ) {
        let mut next = 0;
        while let Some(index) = self.next_deciding(next, resting) {
            next = index + 1;
            let unit = self.units[index];
            let parked = unit.members().any(|axis| self.selected(axis, parameters, to_nck).is_none());
            for axis in unit.members() {
                let signals = &to_nck.axes[axis];
                let wanted = self.selected(axis, parameters, to_nck).filter(|_| !parked);
                let second = signals.position_measuring_system_2() && !signals.position_measuring_system_1();
                if second && parameters.axes[axis].encoders == 1 {
                    self.report_missing_encoder(axis, &parameters.axes[axis]);
                }
                self.switch_measuring_system(axis, wanted, &parameters.axes[axis], to_nck);
            }
        }
    }

    /// The selected measuring system. Selecting a second one that does not exist has no effect.
    pub(in crate::sinumerik) fn selected(
        &self,
        number: AxisNumber,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) -> Option<u8> {
        let (signals, count) = (&to_nck.axes[number], parameters.axes[number].encoders);
        if signals.position_measuring_system_1() && count >= 1 {
            Some(0)
        } else if signals.position_measuring_system_2() && count >= 2 {
            Some(1)
        } else if signals.position_measuring_system_2() && count == 1 {
            self.axes[number].measuring_system
        } else {
            None
        }
    }

    fn switch_measuring_system(
        &mut self,
        number: AxisNumber,
        wanted: Option<u8>,
        parameters: &AxisParameters,
        to_nck: &ToNck,
    ) {
        if self.axes[number].measuring_system == wanted || self.switch_over_fails(number, wanted, parameters) {
            return;
        }
        if self.axes[number].measuring_system.is_some() && wanted.is_some() {
            self.report_switch_over(number);
        }
        let signals = &to_nck.axes[number];
        let inputs = [
            axis_signal(number, axis_to_nck::position_measuring_system_1, signals.position_measuring_system_1()),
            axis_signal(number, axis_to_nck::position_measuring_system_2, signals.position_measuring_system_2()),
            Input::None,
        ];
        let rule = if wanted.is_some() { Rule::MeasuringSystem } else { Rule::Parking };
        let event = self.log.note(Place::Axis(number), rule, inputs, EventId::NONE);
        let aborts = self.axes[number].approach.is_running();
        let was_parked = self.axes[number].measuring_system.is_none();
        let axis = &mut self.axes[number];
        let before = axis.actual;
        axis.measuring_system = wanted;
        axis.causes.measuring_system = event;
        if wanted.is_none() {
            axis.referenced = [false; 2];
            axis.causes.reference = [event; 2];
            axis.restored = [false; 2];
            axis.causes.restored = [event; 2];
        }
        axis.sense(&self.feedback[number]);
        axis.setpoint = crate::motion::Setpoint::at(axis.actual);
        axis.monitor.restart(axis.actual);
        axis.signals.hold_at(axis.actual);
        let shift = axis.actual - before;
        self.value_shifted(number, shift);
        if was_parked {
            self.read_absolute(number, event, parameters);
        }
        if aborts {
            self.abort_approach(number, event);
        }
    }

    /// One step of the enabling sequence for every axis.
    pub(in crate::sinumerik) fn enable(&mut self, parameters: &Parameters, to_nck: &ToNck, resting: &Resting) {
        for number in resting.deciding().iter() {
            self.axes[number].monitor.clamped = to_nck.axes[number].clamping_in_progress();
            self.enable_pulses(number, &to_nck.axes[number]);
        }
        let mut next = 0;
        while let Some(index) = self.next_deciding(next, resting) {
            next = index + 1;
            let unit = self.units[index];
            let conditions = self.conditions(&unit, parameters, to_nck);
            let lost = !conditions.enable || !conditions.healthy;
            let moving = conditions.moving || lost && self.belongs_to_moving_path(&unit, parameters);
            if lost && moving && self.unit_is_on(&unit) {
                let (axis, cause) = conditions.culprit;
                let event =
                    self.log.note_one(Place::Axis(axis), Rule::EnableLostInMotion, conditions.missing.1, EventId::NONE);
                let channel = Parameter::Channel(unit.channel);
                let cause = [channel, Parameter::Axis(axis), Parameter::Number(cause), Parameter::None];
                self.alarms.raise(alarms::ENABLE_RESET, Place::Axis(axis), cause, event);
            }
            // The first axis that is switched off switches off all of them: they stop together (SIG-01).
            let disable_cycles =
                unit.members().map(|axis| parameters.axes[axis].servo_disable_cycles).min().unwrap_or_default();
            for axis in unit.members() {
                let (was_on, moved) = (
                    self.axes[axis].enabling.controllers()[2],
                    !self.axes[axis].setpoint.is_at_rest() && !self.axes[axis].speed_controlled,
                );
                self.step_control(axis, &unit, &conditions, disable_cycles);
                if was_on && moved && !self.axes[axis].enabling.pulses_enabled() {
                    self.report_follow_up_in_motion(axis);
                }
                // The controller enable takes the pulses along.
                self.disable_pulses(axis, &to_nck.axes[axis]);
                self.command_brake(axis, &to_nck.axes[axis]);
            }
        }
    }

    /// 21615: the drive of an axis in motion lost its power. The axis cannot be braked, and 21612 switches it to follow-up.
    fn report_follow_up_in_motion(&mut self, number: AxisNumber) {
        let cause = self.axes[number].causes.drive;
        let event = self.log.note_plain(Place::Axis(number), Rule::FollowUpInMotion, cause);
        self.raise_axis_alarm(alarms::FOLLOW_UP_IN_MOTION, number, event);
    }

    fn unit_is_on(&self, unit: &Unit) -> bool {
        unit.members().any(|axis| self.axes[axis].enabling.is_on())
    }

    fn enable_pulses(&mut self, number: AxisNumber, signals: &AxisToNck) {
        let (axis, run_up) = (&self.axes[number], self.run_up.is_nc_ready());
        let controller = signals.controller_enable() || axis.enabling.control != ControllerState::Off;
        let enable = axis.drive_ready && run_up && signals.pulse_enable() && controller;
        let pulses = if enable { (axis.enabling.pulses + 1).min(STEP) } else { 0 };
        self.set_pulses(number, pulses, signals);
    }

    fn disable_pulses(&mut self, number: AxisNumber, signals: &AxisToNck) {
        if self.axes[number].enabling.control == ControllerState::Off && !signals.controller_enable() {
            self.set_pulses(number, 0, signals);
        }
    }

    fn set_pulses(&mut self, number: AxisNumber, pulses: u8, signals: &AxisToNck) {
        let axis = &mut self.axes[number];
        let was = axis.enabling.pulses_enabled();
        axis.enabling.pulses = pulses;
        let is = axis.enabling.pulses_enabled();
        if was == is {
            return;
        }
        let run_up = self.run_up.is_nc_ready();
        let rule = if is { Rule::PulsesEnabled } else { Rule::PulsesDisabled };
        let all = [
            (signals.pulse_enable(), axis_signal(number, axis_to_nck::pulse_enable, signals.pulse_enable())),
            (axis.drive_ready, axis_signal(number, axis_from_nck::drive_ready, axis.drive_ready)),
            (
                signals.controller_enable(),
                axis_signal(number, axis_to_nck::controller_enable, signals.controller_enable()),
            ),
            (run_up, nck_signal(nck_from_nck::nc_ready, run_up)),
        ];
        // The enables that are there, or those that are missing.
        let mut inputs = [Input::None; 3];
        for (input, (_, tested)) in inputs.iter_mut().zip(all.into_iter().filter(|(on, _)| *on == is)) {
            *input = tested;
        }
        axis.causes.drive = self.log.note(Place::Axis(number), rule, inputs, axis.causes.drive);
    }

    /// The drive opens the brake when its speed controller holds the axis, and closes it when the axis is switched off.
    fn command_brake(&mut self, number: AxisNumber, signals: &AxisToNck) {
        let axis = &mut self.axes[number];
        if axis.brake == Brake::None {
            return;
        }
        let holds = match axis.enabling.control {
            ControllerState::Off | ControllerState::Holding(_) => false,
            ControllerState::SwitchingOn(cycles) => cycles >= 2 * STEP,
            ControllerState::On | ControllerState::Braking(_) => true,
        };
        let powered = axis.enabling.pulses_enabled();
        let by_plc = signals.open_holding_brake();
        let opens = powered && holds || by_plc;
        if opens != axis.enabling.opens_brake {
            axis.enabling.opens_brake = opens;
            let inputs = [
                axis_signal(number, axis_to_nck::open_holding_brake, by_plc),
                axis_signal(number, axis_from_nck::pulses_enabled, powered),
                axis_signal(number, axis_from_nck::position_controller_active, axis.enabling.controllers()[2]),
            ];
            let rule = if opens { Rule::BrakeOpens } else { Rule::BrakeCloses };
            let parent = axis.causes.enabling;
            let event = self.log.note(Place::Axis(number), rule, inputs, parent);
            self.axes[number].causes.brake = event;
        }
    }

    fn conditions(&self, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) -> Conditions {
        let mut conditions = Conditions {
            enable: true,
            follow_up: false,
            healthy: true,
            starting: true,
            tracks: self.emergency_stop.active_cause().map(|cause| {
                (Rule::FollowUpByEmergencyStop, nck_signal(nck_from_nck::emergency_stop_active, true), cause)
            }),
            standing: true,
            moving: false,
            missing: (Rule::ControllerOff, Input::None),
            culprit: (unit.leader(), 0),
        };
        for number in unit.members() {
            let (axis, signals) = (&self.axes[number], &to_nck.axes[number]);
            conditions.standing &= axis.stands(&parameters.axes[number]);
            // A spindle in speed control brakes and turns again (S-05).
            conditions.moving |= axis.is_moving() && !axis.speed_controlled;
            conditions.follow_up |= signals.follow_up_mode();
            let place = Place::Axis(number);
            let tracks = self.alarms.first_alarm(|at, alarm| at == place && alarm.reaction.has(Reaction::FOLLOW_UP));
            if let Some((alarm, event)) = tracks {
                conditions.tracks = Some((Rule::FollowUpByAlarm, Input::Alarm(alarm.0), event));
            }
            let Some((missing, cause)) = axis.missing_enable(signals) else { continue };
            if signals.controller_enable() {
                conditions.healthy = false;
                conditions.starting &= signals.pulse_enable() && axis.drive_ready && axis.measuring_system.is_some();
            } else {
                conditions.enable = false;
            }
            if conditions.missing.1 == Input::None {
                let rule = match missing {
                    _ if !signals.controller_enable() => Rule::ControllerOff,
                    _ if axis.measuring_system.is_none() => Rule::UnitParked,
                    _ => Rule::PulsesMissing,
                };
                conditions.missing = (rule, axis_signal(number, missing, false));
                conditions.culprit = (number, cause);
            }
        }
        conditions
    }

    /// The last event of this cycle that made a condition of position control true: pulses, measuring system, the end of follow-up.
    fn allowed_by(&self, unit: &Unit) -> EventId {
        let of_axes = unit.members().flat_map(|axis| {
            let causes = &self.axes[axis].causes;
            [causes.drive, causes.measuring_system]
        });
        of_axes.filter(|event| self.log.is_of_this_cycle(*event)).fold(self.tracks_ended(unit), EventId::max)
    }

    /// What ended an emergency stop, or an alarm of a unit with the reaction follow-up, in this cycle.
    fn tracks_ended(&self, unit: &Unit) -> EventId {
        let by_alarm = self.alarms.last_end(|raised| {
            let tracks = Alarm::find(raised.number).is_some_and(|alarm| alarm.reaction.has(Reaction::FOLLOW_UP));
            tracks && unit.members().any(|axis| raised.place == Place::Axis(axis))
        });
        let stop = &self.emergency_stop;
        let acknowledged = !stop.active && self.log.is_of_this_cycle(stop.cause);
        if acknowledged { by_alarm.max(stop.cause) } else { by_alarm }
    }

    /// The enable that an axis of a unit does not have.
    pub(in crate::sinumerik) fn missing_enable(&self, unit: &Unit, to_nck: &ToNck) -> Input {
        let missing = |axis| Some((axis, self.axes[axis].missing_enable(&to_nck.axes[axis])?.0));
        let found = unit.members().find_map(missing);
        found.map_or(Input::None, |(axis, signal)| axis_signal(axis, signal, false))
    }

    fn step_control(&mut self, number: AxisNumber, unit: &Unit, conditions: &Conditions, disable_cycles: u64) {
        let before = self.axes[number].enabling;
        let wanted = conditions.enable && conditions.healthy && conditions.tracks.is_none();
        let powered = self.axes[number].enabling.pulses_enabled();
        let brake = self.axes[number].brake;
        let brake_holds = matches!(brake, Brake::Closed | Brake::Moving);
        let off = || {
            if powered { ControllerState::Braking(disable_cycles) } else { ControllerState::Off }
        };
        let control = match before.control {
            ControllerState::Off if wanted => {
                self.axes[number].causes.allowed = self.allowed_by(unit);
                ControllerState::SwitchingOn(0)
            }
            ControllerState::Off => ControllerState::Off,
            // The brake may be open already.
            ControllerState::SwitchingOn(_) if !wanted && powered && brake == Brake::Open => {
                ControllerState::Holding(HOLDING_CYCLES)
            }
            ControllerState::SwitchingOn(_) if !wanted => ControllerState::Off,
            ControllerState::SwitchingOn(cycles) if cycles + 1 >= 3 * STEP && !brake_holds => ControllerState::On,
            // Position control begins when the brake is open.
            ControllerState::SwitchingOn(cycles) if cycles + 1 >= 3 * STEP => ControllerState::SwitchingOn(cycles),
            ControllerState::SwitchingOn(cycles) => ControllerState::SwitchingOn(cycles + 1),
            ControllerState::On if wanted => ControllerState::On,
            ControllerState::On => off(),
            ControllerState::Braking(left) if left == 0 || conditions.standing || !powered => {
                if powered && brake == Brake::Open {
                    ControllerState::Holding(HOLDING_CYCLES)
                } else {
                    ControllerState::Off
                }
            }
            ControllerState::Holding(left) if left == 0 || !powered || brake == Brake::Closed => ControllerState::Off,
            ControllerState::Holding(left) => ControllerState::Holding(left - 1),
            ControllerState::Braking(left) => ControllerState::Braking(left - 1),
        };
        let parked = self.axes[number].measuring_system.is_none();
        let off =
            matches!(control, ControllerState::Off | ControllerState::SwitchingOn(_) | ControllerState::Holding(_));
        let follow_up = off && (conditions.follow_up && !conditions.enable || conditions.tracks.is_some() || parked);
        // Follow-up lasts until position control is active, so that control starts at the actual value.
        let waits_for_pulses = off && conditions.enable && conditions.starting && conditions.tracks.is_none();
        let follow_up = follow_up || before.follow_up && waits_for_pulses;
        self.axes[number].enabling.control = control;
        self.axes[number].enabling.follow_up = follow_up;
        let after = self.axes[number].enabling;
        if before.controllers() != after.controllers() || before.follow_up != after.follow_up {
            // Switching off continues even if its reason is gone.
            let goes_off = matches!(before.control, ControllerState::Braking(_) | ControllerState::Holding(_));
            let (missing, causes) = (conditions.missing.1, &self.axes[number].causes);
            let (rule, input, parent) = if wanted && goes_off {
                (Rule::SwitchingOffGoesOn, Input::None, causes.enabling)
            } else if wanted {
                // Position control waits for the brake, the other controllers do not.
                let brake = if after.controllers()[2] { causes.brake } else { EventId::NONE };
                let enable = axis_signal(number, axis_to_nck::controller_enable, true);
                (Rule::ControllerOn, enable, causes.allowed.max(brake))
            } else if let Some(tracks) = conditions.tracks {
                tracks
            } else if follow_up && !before.follow_up && parked {
                (Rule::FollowUpByParking, missing, causes.measuring_system)
            } else if follow_up && !before.follow_up {
                (Rule::FollowUp, missing, EventId::NONE)
            } else {
                (conditions.missing.0, missing, EventId::NONE)
            };
            let event = self.log.note_one(Place::Axis(number), rule, input, parent);
            self.axes[number].causes.enabling = event;
            if before.follow_up && !after.follow_up && !wanted {
                self.axes[number].causes.follow_up = self.follow_up_ended(number, unit, conditions);
            } else if before.follow_up != after.follow_up {
                self.axes[number].causes.follow_up = event;
            }
        }
    }

    /// What ended follow-up before position control is active: its reason is gone, or the enables changed.
    fn follow_up_ended(&mut self, number: AxisNumber, unit: &Unit, conditions: &Conditions) -> EventId {
        let tracks_ended = self.tracks_ended(unit);
        if tracks_ended.is_some() {
            return tracks_ended;
        }
        let (rule, missing) = conditions.missing;
        let second = if conditions.enable {
            axis_signal(number, axis_to_nck::controller_enable, true)
        } else {
            axis_signal(number, axis_to_nck::follow_up_mode, false)
        };
        self.log.note(Place::Axis(number), rule, [missing, second, Input::None], EventId::NONE)
    }
}

impl Axis {
    /// The enable that is missing, and the cause that 21612 gives for it.
    fn missing_enable(&self, signals: &AxisToNck) -> Option<(Signal, i64)> {
        if !signals.controller_enable() {
            Some((axis_to_nck::controller_enable, 1))
        } else if self.measuring_system.is_none() {
            Some((axis_from_nck::position_measuring_system_1_activated, 0))
        } else if self.enabling.pulses_enabled() {
            None
        } else if !signals.pulse_enable() {
            Some((axis_to_nck::pulse_enable, 2))
        } else if !self.drive_ready {
            Some((axis_from_nck::drive_ready, 4))
        } else {
            // The drive is ready, and its pulses are being enabled.
            Some((axis_from_nck::pulses_enabled, 4))
        }
    }

    /// Without position control the axis makes only the motion of this state; `emergency_deceleration` brakes it before it is
    /// switched off.
    pub(in crate::sinumerik) fn brake_without_control(&mut self, emergency_deceleration: f64) {
        if let Some(motion) = self.motion_without_control(emergency_deceleration) {
            self.motion = motion;
        }
    }

    /// The motion of an axis that is not in position control, or that brakes before it is switched off.
    fn motion_without_control(&self, emergency_deceleration: f64) -> Option<Motion> {
        match self.enabling.control {
            ControllerState::On => None,
            ControllerState::Braking(_) => Some(Motion::Brake { deceleration: emergency_deceleration }),
            ControllerState::Off | ControllerState::SwitchingOn(_) | ControllerState::Holding(_)
                if self.enabling.follow_up =>
            {
                Some(Motion::Track)
            }
            ControllerState::Off | ControllerState::SwitchingOn(_) | ControllerState::Holding(_) => Some(Motion::Hold),
        }
    }
}
