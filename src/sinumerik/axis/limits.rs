//! Hardware and software limit switches.
//!
//! Hardware (12.0 minus, 12.1 plus): alarm 21614 on the axis. All axes of its unit brake (MON-14) according to MD36600, with
//! their ramp or with setpoint 0. Afterwards only the opposite direction moves. An approach or a synchronising motion ends there.
//!
//! Software (MD36100 and MD36110, or the second pair selected by 12.2 and 12.3): for the leading axis only (MON-13), when it is
//! referenced, and not for modulo axes. JOG brakes so that the axis stops exactly on the limit; 10621 is pending until it is
//! moved away.

use crate::image::{AxisToNck, Signal, ToNck, axis_to_nck};
use crate::motion::Motion;
use crate::sinumerik::alarms;
use crate::sinumerik::axis::state::LimitSwitches;
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::{AxisNumber, ChannelNumber, Position};
use crate::variables::{AlarmNumber, EventId, Input, Parameter, Place, Quantity, RaisedAlarm};

/// Setpoint 0 at once, without a ramp.
const WITHOUT_RAMP: f64 = 1e18;

/// The software limit ahead of a movement in JOG.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sinumerik) enum Ahead {
    /// No software limit is active.
    Free,
    /// A limit is ahead.
    At(Position),
    /// The axis is on the limit or beyond it.
    Reached,
}

impl State {
    /// Monitors the hardware limit switches of a unit and raises their alarms.
    pub(in crate::sinumerik) fn watch_limit_switches(&mut self, unit: &Unit, to_nck: &ToNck) {
        for number in unit.members() {
            let signals = &to_nck.axes[number];
            let (minus, plus) = (signals.hardware_limit_switch_minus(), signals.hardware_limit_switch_plus());
            let before = self.axes[number].limits;
            if !minus && !plus && !before.minus && !before.plus {
                continue;
            }
            if (minus, plus) != (before.minus, before.plus) {
                let inputs = [
                    axis_signal(number, axis_to_nck::hardware_limit_switch_minus, minus),
                    axis_signal(number, axis_to_nck::hardware_limit_switch_plus, plus),
                    Input::None,
                ];
                let cause = self.log.note(Place::Axis(number), Rule::HardwareLimitSwitch, inputs, EventId::NONE);
                self.axes[number].limits = LimitSwitches { minus, plus, cause };
            }
            for (pressed, direction) in [(minus, -1), (plus, 1)] {
                if pressed {
                    let limits = self.axes[number].limits;
                    let inputs = [limits.input(number, direction), Input::None, Input::None];
                    let alarm = limit_alarm(alarms::HARDWARE_LIMIT_SWITCH, unit.channel, number, direction);
                    self.raise_tested(alarm, limits.cause, Rule::HardwareLimitSwitch, inputs);
                }
            }
        }
    }

    /// The axis of the unit that a movement in this direction would move further onto its hardware limit switch.
    pub(in crate::sinumerik) fn limited_by(&self, unit: &Unit, direction: i8) -> Option<AxisNumber> {
        unit.members().find(|&axis| self.axes[axis].limits.blocks(direction))
    }

    /// Any pressed hardware limit switch of the unit: its signal and its event.
    pub(in crate::sinumerik) fn on_limit_switch(&self, unit: &Unit) -> Option<(Input, EventId)> {
        [1, -1].into_iter().find_map(|direction| {
            let axis = self.limited_by(unit, direction)?;
            let limits = self.axes[axis].limits;
            Some((limits.input(axis, direction), limits.cause))
        })
    }

    /// What holds the movement of a program in this direction: a pressed switch, or 21614, which only RESET ends. The switch alone does not let the axis
    /// go on.
    pub(in crate::sinumerik) fn limits_program(&self, unit: &Unit, direction: i8) -> Option<Input> {
        if let Some(pressed) = self.limited_by(unit, direction) {
            return Some(self.axes[pressed].limits.input(pressed, direction));
        }
        let is_of_unit = |alarm: &RaisedAlarm| {
            unit.members()
                .any(|axis| *alarm == limit_alarm(alarms::HARDWARE_LIMIT_SWITCH, unit.channel, axis, direction))
        };
        let mut pending = self.alarms.iter();
        pending.any(|(alarm, _)| is_of_unit(alarm)).then_some(Input::Alarm(alarms::HARDWARE_LIMIT_SWITCH.0))
    }

    /// Brakes the unit because of a hardware limit switch, according to MD36600 of the axis on the switch. Returns whether it has set the motion: not
    /// with MD36600 = 0, the ramp of the axis.
    pub(in crate::sinumerik) fn brake_at_limit(&mut self, unit: &Unit, parameters: &Parameters) -> bool {
        let pressed = |axis: &AxisNumber| self.axes[*axis].limits.minus || self.axes[*axis].limits.plus;
        let at_once = unit.members().filter(pressed).any(|axis| parameters.axes[axis].limit_without_ramp);
        if at_once {
            for axis in unit.members() {
                self.axes[axis].motion = Motion::Brake { deceleration: WITHOUT_RAMP };
            }
        }
        at_once
    }

    /// The software limit of an axis in a direction, if it is active.
    pub(in crate::sinumerik) fn software_limit(
        &self,
        number: AxisNumber,
        direction: i8,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) -> Option<Position> {
        let limit = || selected_limit(&to_nck.axes[number], &parameters.axes[number], direction);
        self.axes[number].knows_position().then(limit).flatten()
    }

    /// The software limit ahead of a movement in JOG in this direction.
    pub(in crate::sinumerik) fn software_limit_ahead(
        &self,
        number: AxisNumber,
        direction: i8,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) -> Ahead {
        match self.software_limit(number, direction, parameters, to_nck) {
            None => Ahead::Free,
            Some(limit) => {
                let axis = &self.axes[number];
                let way = (limit - axis.machine_setpoint()).increments();
                if way.signum() * i64::from(direction) <= 0 {
                    Ahead::Reached
                } else {
                    Ahead::At(limit - axis.overlay.position())
                }
            }
        }
    }

    /// 10621 while the leading axis of a unit is on its software limit or beyond it.
    pub(in crate::sinumerik) fn watch_software_limits(&mut self, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) {
        let number = unit.leader();
        for direction in [-1, 1] {
            let limit = self.software_limit(number, direction, parameters, to_nck);
            let axis = &self.axes[number];
            let beyond = limit.is_some_and(|limit| {
                (limit - axis.machine_setpoint()).increments().signum() * i64::from(direction) <= 0
            });
            let holds = beyond && axis.setpoint.is_at_rest();
            let alarm = limit_alarm(alarms::ON_SOFTWARE_LIMIT, unit.channel, number, direction);
            if !holds && !self.alarms.is_pending(alarm.number, alarm.place) {
                continue;
            }
            let tested = |limit: Position| {
                let (second, signal) = selects_second(&to_nck.axes[number], direction);
                let datum = [[36100, 36120], [36110, 36130]][usize::from(direction > 0)][usize::from(second)];
                [
                    Input::Length(Quantity::Setpoint, number, axis.machine_setpoint()),
                    Input::Datum(datum, Some(number), limit.user()),
                    axis_signal(number, signal, second),
                ]
            };
            let motion = axis.causes.motion;
            if holds {
                let inputs = limit.map_or([Input::None; 3], tested);
                self.raise_tested(alarm, motion, Rule::OnSoftwareLimit, inputs);
                continue;
            }
            let (inputs, parent) = match limit {
                None => self.reference_inputs(number, parameters),
                // The setpoint moves: the movement is the cause.
                Some(_) if beyond => ([Input::None; 3], motion),
                Some(limit) => (tested(limit), motion),
            };
            self.end_tested(&alarm, Rule::OffSoftwareLimit, inputs, parent);
        }
    }
}

/// The software limit that acts in a direction while the axis is referenced; `None` for a modulo axis.
pub(in crate::sinumerik) fn selected_limit(
    signals: &AxisToNck,
    parameters: &AxisParameters,
    direction: i8,
) -> Option<Position> {
    let (second, _) = selects_second(signals, direction);
    let limits = parameters.software_limits[usize::from(direction > 0)];
    (!parameters.modulo).then_some(limits[usize::from(second)])
}

/// The alarm of a limit: `%1` channel, `%2` axis, `%3` direction.
const fn limit_alarm(number: AlarmNumber, channel: ChannelNumber, axis: AxisNumber, direction: i8) -> RaisedAlarm {
    let shown = [Parameter::Channel(channel), Parameter::Axis(axis), Parameter::Direction(direction), Parameter::None];
    RaisedAlarm { number, place: Place::Axis(axis), parameters: shown }
}

/// Whether the second software limit of a direction is selected, and the signal that selects it.
fn selects_second(signals: &AxisToNck, direction: i8) -> (bool, Signal) {
    if direction > 0 {
        (signals.second_software_limit_switch_plus(), axis_to_nck::second_software_limit_switch_plus)
    } else {
        (signals.second_software_limit_switch_minus(), axis_to_nck::second_software_limit_switch_minus)
    }
}
