//! The control behind the interface: [`Control`] over the state of this module.

use std::any::Any;
use std::collections::BTreeMap;
use std::sync::Arc;

use super::hli::{HLI, ToCnc, axis_to_cnc};
use super::inputs::axis_signal;
use super::lists::{Code, Lists, Message};
use super::pending::{Detail, of_axis};
use super::rules::Why;
use super::state::{Axis, AxisCauses, AxisError, State, Units};
use super::texts::TEXTS;
use super::{gantry, messages};
use crate::control::{
    Activated, Changes, ChartPosition, Condition, Control, ControlCommand, ControlSide, CycleTimes, Data, PlcSide,
    Question, Taken, Texts, Value,
};
use crate::image::{Names, OverrideCoding, Signal, View};
use crate::motion::{Feedback, Setpoint};
use crate::nc_program::Program;
use crate::source::{Place as FilePlace, Problem};
use crate::units::{AxisNumber, AxisSet, ChannelNumber, PerAxis, Position};
use crate::variables::{
    AlarmNumber, DatumValue, EventId, Events, FaultName, Input, Parameter, ParameterValue, Place, RaisedAlarm,
    Variables,
};

/// A control of the ISG kernel.
#[derive(Clone, Debug)]
pub struct Cnc(pub(super) Box<State>);

impl State {
    /// The controller starts: lists take effect, nothing is active (SG-09).
    pub(super) fn restart(&mut self) {
        let event = self.log.note_plain(Place::Nck, Why::PowerOn, EventId::NONE);
        self.power_on = event;
        self.as_after_start = self.log.note_plain(Place::Nck, Why::AsAfterStart, event);
        self.plc_missing = EventId::NONE;
        self.pending.restart(self.as_after_start);
        let started = self.lists.start();
        for (_, axis) in self.axes.iter_mut() {
            let causes = AxisCauses { fault: axis.causes.fault, ..AxisCauses::default() };
            *axis = Axis { feedback: axis.feedback, causes, ..Axis::default() };
        }
        self.adopt(&started, true, event);
        for (_, axis) in self.axes.iter_mut().filter(|(_, axis)| axis.exists) {
            axis.units = Units { drive_enable: true, feed_enable: true, gantry_on: false };
        }
        self.combinations = gantry::combinations(&self.axes, event);
        for one in &self.combinations {
            let leader = one.coupling.leader();
            for member in one.coupling.members() {
                // The slaves name their master; the first of them couples it.
                let slave = if member == leader { one.coupling.followers().next() } else { Some(member) };
                let master = f64::from(self.axes[leader].parameters.number);
                let input = slave.map_or(Input::None, |slave| Input::Datum(70, Some(slave), master));
                self.axes[member].causes.coupled =
                    self.log.note_one(Place::Axis(member), Why::CoupledByList, input, event);
            }
        }
        self.starts = true;
        for message in &started.messages {
            self.raise_check(message, Why::StartUpCheck, event);
        }
    }

    /// The encoders have reported for the first time since the start.
    fn take_first_positions(&mut self) {
        let event = self.power_on;
        for number in self.existing() {
            let axis = &mut self.axes[number];
            axis.homed = axis.feedback.absolute[0] && !axis.parameters.homing.ignores_absolute;
            axis.setpoint = Setpoint::at(axis.actual());
            if axis.homed {
                axis.causes.homed = self.log.note_plain(Place::Axis(number), Why::AbsoluteEncoder, event);
            }
        }
        self.start_couplings();
    }

    /// A message of the checks of the lists.
    pub(super) fn raise_check(&mut self, message: &Message, why: Why, cause: EventId) {
        let number = match message.code {
            Code::Number(number) => AlarmNumber(number),
            Code::Parameter(number) => messages::of_parameter(number),
        };
        let axis = message.axis.and_then(|axis| self.axis_of(axis));
        let other = message.other_axis.and_then(|axis| self.axis_of(axis));
        let channel = message.channel.and_then(|channel| ChannelNumber::new(u8::try_from(channel).ok()?));
        let place = axis.map(Place::Axis).or_else(|| channel.map(Place::Channel)).unwrap_or(Place::Nck);
        let event = self.log.note_plain(place, why, cause);
        // About a channel: channel, no block, axis, text, as at run time. About an axis: axis, other axis, text.
        let text = self.pending.parameter(Detail::Text(message.text.clone()));
        let [axis, second] = [axis, other].map(|axis| axis.map_or(Parameter::None, Parameter::Axis));
        let parameters = match channel {
            Some(channel) => [Parameter::Channel(channel), Parameter::None, axis, text],
            None => [axis, second, text, Parameter::None],
        };
        self.pending.raise_as(RaisedAlarm { number, place, parameters }, other, message.is_warning(), event);
    }

    /// Reads the control units of an axis. True if `gantry_on` rises.
    fn read_axis(&mut self, number: AxisNumber, to_cnc: &super::hli::AxisToCnc) -> bool {
        let axis = &self.axes[number];
        let before = axis.units;
        let unit = |enable: bool, command: bool, request: bool| if enable { command } else { request };
        let now = Units {
            drive_enable: unit(to_cnc.drive_enable_enable(), to_cnc.drive_enable_command(), true),
            feed_enable: unit(to_cnc.feed_enable_enable(), to_cnc.feed_enable_command(), true),
            gantry_on: unit(to_cnc.gantry_on_enable(), to_cnc.gantry_on_command(), false),
        };
        self.axes[number].units = now;
        let mut note = |unit: [Signal; 2], enable: bool, command: bool| -> EventId {
            let [enabled, commanded] = [(unit[0], enable), (unit[1], command)].map(|(s, v)| axis_signal(number, s, v));
            // The command is read only while the PLC gives it.
            let (why, second) = if enable { (Why::Commanded, commanded) } else { (Why::Request, Input::None) };
            self.log.note(Place::Axis(number), why, [enabled, second, Input::None], EventId::NONE)
        };
        let causes = &mut self.axes[number].causes;
        if before.drive_enable != now.drive_enable {
            let unit = [axis_to_cnc::drive_enable_enable, axis_to_cnc::drive_enable_command];
            causes.drive_enable = note(unit, to_cnc.drive_enable_enable(), to_cnc.drive_enable_command());
        }
        if before.feed_enable != now.feed_enable {
            let unit = [axis_to_cnc::feed_enable_enable, axis_to_cnc::feed_enable_command];
            causes.feed_enable = note(unit, to_cnc.feed_enable_enable(), to_cnc.feed_enable_command());
        }
        if before.gantry_on != now.gantry_on {
            let unit = [axis_to_cnc::gantry_on_enable, axis_to_cnc::gantry_on_command];
            causes.gantry_on = note(unit, to_cnc.gantry_on_enable(), to_cnc.gantry_on_command());
        }
        now.gantry_on && !before.gantry_on
    }

    /// Faults and readiness of the drives (HG-13, HG-22, HG-23).
    fn watch_drives(&mut self) {
        for number in self.existing() {
            let axis = &mut self.axes[number];
            if axis.feedback.drive_ready && !axis.was_ready {
                axis.was_ready = true;
                axis.causes.ready = self.log.note_plain(Place::Axis(number), Why::DriveStarted, self.power_on);
            }
            let is_new = axis.feedback.drive_fault && !axis.fault_raised;
            axis.fault_raised = axis.feedback.drive_fault;
            if is_new {
                // An intelligent drive leaves its reaction to the CNC if the list says so; it brakes by itself otherwise.
                axis.fault_stop = axis.parameters.stops_controlled && self.intelligent.contains(number);
                let input = Input::Fault(FaultName::DriveFault);
                let event = self.log.note_one(Place::Axis(number), Why::DriveFault, input, axis.causes.fault);
                axis.causes.ready = event;
                self.pending.raise(of_axis(messages::DRIVE_FAULT, number), None, event);
                let stop = self.log.note_plain(Place::Axis(number), Why::CombinationStops, event);
                self.axis_error(number, AxisError::Resettable, stop);
            }
            let axis = &mut self.axes[number];
            if axis.fault_stop && axis.setpoint.is_at_rest() && axis.still > 0 {
                axis.fault_stop = false;
            }
        }
    }

    /// The setpoints of the cycle.
    fn decide(&mut self, to_cnc: &ToCnc) {
        let mut rising = AxisSet::NONE;
        for number in self.existing() {
            let bits = to_cnc.axes[number];
            rising.set(number, self.read_axis(number, &bits));
        }
        self.clear_by_unit(rising);
        self.watch_drives();
        for index in 0..self.channels.len() {
            let bits = to_cnc.channels[self.channels[index].number];
            self.read_channel(index, &bits, &to_cnc.skips[self.channels[index].number]);
            self.step_channel(index);
        }
        self.realign();
        self.move_setpoints();
        self.trip_again();
        self.finish_groups();
    }

    /// An update of a list at run time: what waits for a restart is kept (HG-02).
    fn update(&mut self, target: &str, value: &Value) -> EventId {
        let event = self.log.note_plain(Place::Nck, Why::ListUpdated, EventId::NONE);
        let before = self.lists.update().messages;
        if self.lists.set(target, value, &FilePlace::file("scenario")).is_ok() {
            let started = self.lists.update();
            self.adopt(&started, false, event);
            self.adopt_offsets();
            for message in started.messages.iter().filter(|message| !before.contains(message)) {
                self.raise_check(message, Why::UpdateCheck, event);
            }
        }
        event
    }
}

impl Control for Cnc {
    fn check(&self, command: &ControlCommand) -> Result<(), Problem> {
        match command {
            ControlCommand::Store { target, value } => {
                let set = self.0.lists.clone().set(target, value, &FilePlace::file("scenario"));
                // The caller knows the line.
                set.map(|_| ()).map_err(|problem| Problem { place: None, ..problem })
            }
            ControlCommand::SelectProgram { channel, .. } if !self.has_channel(*channel) => {
                let channels: Vec<String> =
                    self.0.channels.iter().map(|channel| format!("channel_{}", channel.number)).collect();
                Err(Problem::new(
                    format!("expected a channel of the machine, found channel {channel}"),
                    match channels.is_empty() {
                        true => "add a channel list to the machine".to_owned(),
                        false => format!("the machine has {}", channels.join(", ")),
                    },
                ))
            }
            ControlCommand::SelectProgram { path, .. } if !self.0.programs.contains_key(path) => Err(Problem::new(
                format!("expected a program, found `{path}`"),
                "name a program with `program` or `nc`",
            )),
            ControlCommand::Activate
            | ControlCommand::SelectProgram { .. }
            | ControlCommand::Cancel
            | ControlCommand::PlcMissing
            | ControlCommand::PlcRestarted
            | ControlCommand::PlcMessages(_)
            | ControlCommand::Written(_)
            | ControlCommand::Fault { .. } => Ok(()),
            ControlCommand::RParameter { .. } => Err(foreign("R parameters", "P parameters belong to their program")),
            ControlCommand::EnterBlocks { .. } => Err(foreign("manual data input", "write `nc = \"…\"` and start it")),
            ControlCommand::Preset { .. } => Err(foreign("PRESET", "home the axis with G74")),
            ControlCommand::Search { .. } => Err(foreign("a block search", "start the program from its beginning")),
            ControlCommand::FunctionGenerator(_) => Err(foreign("a function generator", "remove the step")),
            ControlCommand::Handwheel { .. } => Err(foreign("handwheels", "write a program")),
        }
    }

    fn begin_cycle(&mut self, cycle: u64) {
        self.0.log.begin(cycle);
        self.0.pending.begin_cycle();
    }

    fn command(&mut self, command: &ControlCommand) -> EventId {
        let state = &mut *self.0;
        match command {
            ControlCommand::Store { target, value } => state.update(target, value),
            ControlCommand::SelectProgram { channel, path } => {
                // A program that runs is not changed by it: the next start takes the new one.
                let Some(one) = state.channels.iter_mut().find(|one| one.number == *channel) else {
                    return EventId::NONE;
                };
                one.selected = Some(path.clone());
                one.causes.selected =
                    state.log.note_plain(Place::Channel(*channel), Why::ProgramSelected, EventId::NONE);
                one.causes.selected
            }
            ControlCommand::PlcMissing => {
                if !state.plc_missing.is_some() {
                    state.plc_missing = state.log.note_plain(Place::Nck, Why::PlcMissing, EventId::NONE);
                }
                state.plc_missing
            }
            ControlCommand::PlcRestarted => {
                state.plc_missing = EventId::NONE;
                EventId::NONE
            }
            ControlCommand::Fault { axis, name, begins, affected } => {
                let why = if *begins { Why::FaultBegins } else { Why::FaultEnds };
                let event = state.log.note_one(Place::Axis(*axis), why, Input::Fault(*name), EventId::NONE);
                for number in affected.iter() {
                    state.axes[number].causes.fault = event;
                }
                if *begins && *name == FaultName::MovedByHand {
                    state.axes[*axis].tracks_once = true;
                }
                event
            }
            _ => EventId::NONE,
        }
    }

    fn take_activated(&mut self) -> Vec<Activated> {
        let activated = |(of, event): (ParameterValue, EventId)| {
            let index = match of.index {
                [0, 0] => None,
                [first, 0] => u8::try_from(first).ok(),
                [_, second] => u8::try_from(second).ok(),
            };
            let value = of.word.is_none().then_some(of.value);
            Activated { datum: DatumValue { number: of.number, place: of.place, index, value, word: of.word }, event }
        };
        self.0.activated.drain(..).map(activated).collect()
    }

    fn decide(&mut self, plc: PlcSide<'_>, _: Changes) {
        if let Some(to_cnc) = ToCnc::of_bytes(plc.to_nck) {
            let to_cnc = to_cnc.clone();
            self.0.decide(&to_cnc);
        }
    }

    fn velocity_command(&mut self, axis: AxisNumber, counts: [Position; 2], _: u32, _: u32) -> Option<f64> {
        self.0.velocity_command(axis, counts[0])
    }

    fn observe(&mut self, feedback: &PerAxis<Feedback>, _: AxisSet) {
        for number in self.0.existing() {
            let axis = &mut self.0.axes[number];
            let moved = axis.feedback.encoders[0].value != feedback[number].encoders[0].value;
            axis.still = if moved { 0 } else { axis.still.saturating_add(1) };
            axis.feedback = feedback[number];
        }
        if std::mem::take(&mut self.0.starts) {
            self.0.take_first_positions();
        }
        self.0.monitor();
        self.0.note_phases();
    }

    fn publish(&mut self, out: ControlSide<'_>, variables: &mut Variables, _: AxisSet) {
        self.0.publish(out.from_nck, variables);
    }

    fn power_on(&mut self) -> EventId {
        self.0.restart();
        self.0.power_on
    }

    fn cycle_times(&self) -> CycleTimes {
        CycleTimes { interpolation: self.0.cycle.0, position_control: 1 }
    }

    fn has_channel(&self, channel: ChannelNumber) -> bool {
        self.0.channels.iter().any(|one| one.number == channel)
    }

    fn motor_speed(&self, axis: AxisNumber, velocity: f64) -> f64 {
        // Of a rotary axis the velocity is in degrees/min.
        if self.0.axes[axis].parameters.is_rotary { velocity / 360.0 } else { velocity }
    }

    fn measuring_system(&self, axis: AxisNumber) -> Option<u8> {
        self.0.axes[axis].exists.then_some(0)
    }

    fn cause(&mut self, place: Place, byte: u16, bit: u8) -> EventId {
        self.0.signal_cause(place, byte, bit)
    }

    fn conditions(&self, question: &Question<'_>, _: PlcSide<'_>) -> Option<Condition> {
        self.0.conditions(question)
    }

    fn alarm_cause(&self, number: AlarmNumber, place: Place) -> EventId {
        self.0.pending.cause(number, place)
    }

    fn raised_again(&self) -> &[RaisedAlarm] {
        self.0.pending.raised_again()
    }

    fn cleared_cause(&self, _: AlarmNumber, _: Place) -> EventId {
        self.0.pending.cleared
    }

    fn events(&self) -> &Events {
        &self.0.log.events
    }

    fn override_coding(&self) -> OverrideCoding {
        OverrideCoding::of(&HLI)
    }

    fn load_programs(&mut self, programs: Vec<Program>, _: Vec<String>) {
        let programs = programs.into_iter().map(|program| (program.path(), Arc::new(program)));
        let programs: BTreeMap<String, Arc<Program>> = programs.collect();
        self.0.programs.extend(programs);
    }

    fn program_text(&self, path: &str, _: bool) -> Option<String> {
        self.0.programs.get(path).map(|program| program.text().to_owned())
    }

    fn data(&self) -> &dyn Data {
        self
    }

    fn message_text(&self, index: u32) -> &str {
        self.0.pending.text(index)
    }

    fn texts(&self) -> &'static dyn Texts {
        &TEXTS
    }

    fn is_rotary(&self, axis: AxisNumber) -> bool {
        self.0.axes[axis].parameters.is_rotary
    }

    fn active_datum(&self, number: u32, _: Option<u8>, axis: Option<AxisNumber>) -> Option<f64> {
        self.0.parameter_in_effect(number, axis)
    }

    fn configuration(&self, names: &Names) -> Vec<String> {
        self.0.configuration(names)
    }

    fn taken(&self) -> Taken {
        self.0.log.taken
    }

    fn chart_positions(&self) -> Vec<ChartPosition> {
        self.0.chart_positions()
    }

    fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(&self.0).unwrap_or_default()
    }

    fn restore(&mut self, saved: &[u8]) -> Result<(), Problem> {
        self.0 = postcard::from_bytes(saved).map_err(|error| {
            Problem::new(
                format!("expected a saved control of the ISG kernel, found other bytes: {error}"),
                "restore what this version saved",
            )
        })?;
        Ok(())
    }

    fn clone_box(&self) -> Box<dyn Control> {
        Box::new(self.clone())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

fn foreign(what: &str, cure: &str) -> Problem {
    Problem::new(format!("this control has no {what}"), cure)
}

impl Cnc {
    /// A control that starts with these lists.
    pub(super) fn new(lists: Lists, cycle: crate::units::Time, lenient: bool, intelligent: AxisSet) -> Self {
        let mut state = Box::new(State::new(lists, cycle, lenient, intelligent));
        // What holds after the start shows in the first cycle of a machine.
        state.log.begin(1);
        state.restart();
        Self(state)
    }
}
