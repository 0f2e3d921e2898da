//! Hardware and software limit switches.
//!
//! Hardware (12.0 minus, 12.1 plus): alarm 21614 on the axis. All axes of its unit brake (MON-14) according to MD36600, with
//! their ramp or with setpoint 0. Afterwards only the opposite direction moves. An approach or a synchronising motion ends there.
//!
//! Software (MD36100 and MD36110, or the second pair selected by 12.2 and 12.3): for the leading axis only (MON-13), when it is
//! referenced, and not for modulo axes. The working area (SD43400 to SD43430): each axis of the unit has its own (E-27), when it is referenced;
//! in JOG always, in programs with WALIMON. JOG brakes so that the axis stops exactly on the limit; 10621 or 10631 is pending until it is
//! moved away. Every other movement to a target stops there with 10620 or 10630, and so does the path of a program
//! (`program/limits_ahead.rs`): the preparation of a block cannot know 12.2 and 12.3, offsets by handwheels and machine data that come later.

use crate::image::{AxisToNck, Signal, ToNck, axis_to_nck};
use crate::motion::Motion;
use crate::sinumerik::alarms;
use crate::sinumerik::axis::state::LimitSwitches;
use crate::sinumerik::exchange::state::Holder;
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::operation::state::Mode;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::{AxisNumber, ChannelNumber, Position};
use crate::variables::{AlarmNumber, EventId, Input, Parameter, Place, Quantity, RaisedAlarm, short_text};

/// WALIMON in G group 28.
const WORKING_AREA_ON: u8 = 1;

/// Setpoint 0 at once, without a ramp.
const WITHOUT_RAMP: f64 = 1e18;

/// What a limit is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    SoftwareLimit,
    WorkingArea,
}

/// The limit that a unit would reach first in a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sinumerik) struct Barrier {
    kind: Kind,
    /// The axis of the unit that it belongs to.
    axis: AxisNumber,
    direction: i8,
    /// In machine coordinates.
    at: Position,
    /// The way to it; against the direction if the axis is beyond it.
    pub way: Position,
}

impl Barrier {
    /// Whether the axis is on it or beyond it.
    pub(in crate::sinumerik) fn is_reached(&self) -> bool {
        self.way.increments() * i64::from(self.direction) <= 0
    }

    /// The rule by which it holds a movement.
    pub(in crate::sinumerik) const fn rule(&self) -> Rule {
        match self.kind {
            Kind::SoftwareLimit => Rule::SoftwareLimit,
            Kind::WorkingArea => Rule::WorkingArea,
        }
    }
}

/// The limit ahead of a movement in JOG.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sinumerik) enum Ahead {
    /// No limit is active.
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

    /// The limit ahead of a movement in JOG in this direction.
    pub(in crate::sinumerik) fn software_limit_ahead(
        &self,
        number: AxisNumber,
        direction: i8,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) -> Ahead {
        match self.unit_of(number).and_then(|unit| self.barrier(&unit, direction, parameters, to_nck)) {
            None => Ahead::Free,
            Some(barrier) if barrier.is_reached() => Ahead::Reached,
            Some(barrier) => Ahead::At(self.axes[number].setpoint.position + barrier.way),
        }
    }

    /// The limit of its working area that counts for an axis now.
    fn working_area(&self, unit: &Unit, axis: AxisNumber, direction: i8, parameters: &Parameters) -> Option<Position> {
        let limit = parameters.axes[axis].working_area[usize::from(direction > 0)]?;
        let is_on =
            self.mode_group(unit).mode == Mode::Jog || self.programs[unit.channel].modal.index(28) == WORKING_AREA_ON;
        (is_on && self.axes[axis].is_referenced() && !parameters.axes[axis].modulo).then_some(limit)
    }

    /// The limit that a unit would reach first in a direction: the software limit switch of its leading axis (MON-13), or the working area of
    /// any of its axes (E-27).
    pub(in crate::sinumerik) fn barrier(
        &self,
        unit: &Unit,
        direction: i8,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) -> Option<Barrier> {
        let barrier = |kind, axis: AxisNumber, at: Position| {
            let way = at - self.axes[axis].machine_setpoint();
            Barrier { kind, axis, direction, at, way }
        };
        let leader = unit.leader();
        let software = self.software_limit(leader, direction, parameters, to_nck);
        let software = software.map(|at| barrier(Kind::SoftwareLimit, leader, at));
        let areas = unit.members().filter_map(|axis| {
            let at = self.working_area(unit, axis, direction, parameters)?;
            Some(barrier(Kind::WorkingArea, axis, at))
        });
        software.into_iter().chain(areas).min_by_key(|one| one.way.increments() * i64::from(direction))
    }

    /// The target of a movement that is no farther than the limits of its unit; `None` on a limit or beyond it, where the unit brakes. At rest
    /// there, it raises 10620 or 10630 if the movement is not held anyway.
    pub(in crate::sinumerik) fn before_limit(
        &mut self,
        unit: &Unit,
        (target, moves): (Position, bool),
        parameters: &Parameters,
        to_nck: &ToNck,
    ) -> Option<Position> {
        let here = self.axes[unit.leader()].setpoint.position;
        let direction = i8::try_from((target - here).increments().signum()).unwrap_or(0);
        let barrier = if direction == 0 { None } else { self.barrier(unit, direction, parameters, to_nck) };
        let Some(barrier) = barrier else { return Some(target) };
        let farthest = here + barrier.way;
        if (target - farthest).increments() * i64::from(direction) <= 0 {
            return Some(target);
        }
        if !barrier.is_reached() {
            return Some(farthest);
        }
        if moves && self.axes[unit.leader()].setpoint.is_at_rest() {
            let block = self.programs[unit.channel].run.as_ref().and_then(|run| run.queue.front());
            let block = block.map(|block| block.origin.name.clone()).unwrap_or_default();
            self.report_limit(unit, &barrier, &block, parameters, to_nck);
        }
        None
    }

    /// 10620 or 10630: a movement has to stop before a limit.
    pub(in crate::sinumerik) fn report_limit(
        &mut self,
        unit: &Unit,
        barrier: &Barrier,
        block: &str,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) {
        let Barrier { axis, direction, .. } = *barrier;
        let block = if block.is_empty() { Parameter::None } else { Parameter::Text(short_text(block)) };
        let (channel, named, side) =
            (Parameter::Channel(unit.channel), Parameter::Axis(axis), Parameter::Direction(direction));
        let (number, shown) = match barrier.kind {
            Kind::SoftwareLimit => (alarms::REACHES_SOFTWARE_LIMIT, [channel, named, block, side]),
            Kind::WorkingArea => (alarms::REACHES_WORKING_AREA, [channel, block, named, side]),
        };
        let alarm = RaisedAlarm { number, place: Place::Axis(axis), parameters: shown };
        let inputs = self.limit_inputs(barrier, parameters, to_nck);
        self.raise_tested(alarm, self.axes[axis].causes.motion, barrier.rule(), inputs);
    }

    /// What is tested of a limit.
    pub(in crate::sinumerik) fn limit_inputs(
        &self,
        barrier: &Barrier,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) -> [Input; 3] {
        let Barrier { axis, direction, at, .. } = *barrier;
        let side = usize::from(direction > 0);
        let setpoint = Input::Length(Quantity::Setpoint, axis, self.axes[axis].machine_setpoint());
        match barrier.kind {
            Kind::SoftwareLimit => {
                let (second, signal) = selects_second(&to_nck.axes[axis], direction);
                let datum = [[36100, 36120], [36110, 36130]][side][usize::from(second)];
                [setpoint, Input::Datum(datum, Some(axis), at.user()), axis_signal(axis, signal, second)]
            }
            Kind::WorkingArea => {
                debug_assert!(parameters.axes[axis].working_area[side].is_some(), "it has a limit");
                [setpoint, Input::Datum([43430, 43420][side], Some(axis), at.user()), Input::None]
            }
        }
    }

    /// 10620 or 10630 of an axis that the programs of a channel move, and the event behind it.
    pub(in crate::sinumerik) fn alarm_of_limit(&self, channel: ChannelNumber) -> Option<(AlarmNumber, EventId)> {
        self.alarms.first_alarm(|place, alarm| {
            let is_meant = [alarms::REACHES_SOFTWARE_LIMIT, alarms::REACHES_WORKING_AREA].contains(&alarm.number);
            let Place::Axis(axis) = place else { return false };
            let of = self.owners.of(axis);
            is_meant && of.channel == channel && of.holder != Holder::Plc
        })
    }

    /// 10631 while an axis of a unit is at rest on the limit of its working area or beyond it.
    fn watch_working_areas(&mut self, unit: &Unit, parameters: &Parameters) {
        for number in unit.members() {
            if parameters.axes[number].working_area == [None; 2]
                && !self.alarms.is_pending(alarms::ON_WORKING_AREA, Place::Axis(number))
            {
                continue;
            }
            for direction in [-1, 1] {
                let limit = self.working_area(unit, number, direction, parameters);
                let axis = &self.axes[number];
                let way = limit.map(|limit| (limit - axis.machine_setpoint()).increments() * i64::from(direction));
                let beyond = way.is_some_and(|way| way <= 0);
                let alarm = limit_alarm(alarms::ON_WORKING_AREA, unit.channel, number, direction);
                let motion = axis.causes.motion;
                let tested = |limit: Position| {
                    let datum = [43430, 43420][usize::from(direction > 0)];
                    let setpoint = Input::Length(Quantity::Setpoint, number, axis.machine_setpoint());
                    [setpoint, Input::Datum(datum, Some(number), limit.user()), Input::None]
                };
                if beyond && axis.setpoint.is_at_rest() {
                    let inputs = limit.map_or([Input::None; 3], tested);
                    self.raise_noted(alarm, motion, Rule::OnWorkingArea, inputs);
                } else if self.alarms.iter().any(|(known, _)| *known == alarm) {
                    // While its setpoint moves, the movement is the cause.
                    let inputs = limit.filter(|_| !beyond).map_or([Input::None; 3], tested);
                    self.end_tested(&alarm, Rule::OffWorkingArea, inputs, motion);
                }
            }
        }
    }

    /// 10621 while the leading axis of a unit is on its software limit or beyond it; 10631 for the working areas of its axes.
    pub(in crate::sinumerik) fn watch_software_limits(&mut self, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) {
        self.watch_working_areas(unit, parameters);
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
                self.raise_noted(alarm, motion, Rule::OnSoftwareLimit, inputs);
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
