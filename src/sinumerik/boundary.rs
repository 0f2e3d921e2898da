//! Implements the trait that the machine steps: converts bytes to the structures of this control, and commands to its calls.

use std::any::Any;

use zerocopy::IntoBytes;

use crate::control::{
    Activated, Changes, ChartPosition, Condition, Control, ControlCommand, ControlSide, CycleTimes, Data, Datum, Owner,
    PlcSide, Question, Taken, Texts,
};
use crate::image::{FromNck, Hmi, Names, NckHmi, OverrideCoding, ToNck, View};
use crate::motion::Feedback;
use crate::nc_program::Program;
use crate::sinumerik::activation::shown;
use crate::sinumerik::jog::state::HANDWHEELS;
use crate::sinumerik::machine_data::{Target, by_identifier};
use crate::sinumerik::nck::Nck;
use crate::sinumerik::texts::TEXTS;
use crate::sinumerik::user::state::UserReaction;
use crate::source::Problem;
use crate::units::{AxisNumber, AxisSet, ChannelNumber, ModeGroupNumber, PerAxis, Position};
use crate::variables::{AlarmNumber, DatumValue, EventId, Events, Place, RParameters, ShownProgram, Variables};

/// The parts have the lengths of this control's interface, because the memory was created for it.
const LENGTHS: &str = "the memory of a machine has the interface of its control";

fn to_nck(plc: PlcSide<'_>) -> &ToNck {
    ToNck::of_bytes(plc.to_nck).expect(LENGTHS)
}

fn nck_hmi(plc: PlcSide<'_>) -> &NckHmi {
    &Hmi::of_bytes(plc.hmi).expect(LENGTHS).nck
}

impl Control for Nck {
    fn check(&self, command: &ControlCommand) -> Result<(), Problem> {
        match command {
            ControlCommand::Store { target, value } => {
                let target = self.stored().parse_target(target)?;
                self.stored().check(&target, value)
            }
            ControlCommand::Handwheel { number, .. } if !(1..=HANDWHEELS).contains(&usize::from(*number)) => {
                Err(Problem::new(
                    format!("expected a handwheel from 1 to {HANDWHEELS}, found {number}"),
                    "use handwheel 1, 2 or 3",
                ))
            }
            &ControlCommand::RParameter { channel, number, value } => {
                let count = self.state.r_parameters.count(channel);
                if usize::from(number) < count && value.is_finite() {
                    return Ok(());
                }
                let known = if count == 0 { "no R parameter".to_owned() } else { format!("R0 to R{}", count - 1) };
                Err(Problem::new(
                    format!("expected a finite value for {known}, found {value} for R{number}"),
                    "MD28050 is the number of R parameters of a channel",
                ))
            }
            ControlCommand::SelectProgram { channel, path } => self.check_program(*channel, path),
            ControlCommand::EnterBlocks { channel, .. } | ControlCommand::Search { channel, .. } => {
                self.check_channel(*channel)
            }
            &ControlCommand::Preset { axis, value } => self.check_preset(axis, value),
            ControlCommand::FunctionGenerator(wanted) => self.check_generator(wanted),
            ControlCommand::Handwheel { .. }
            | ControlCommand::Activate
            | ControlCommand::Cancel
            | ControlCommand::PlcMissing
            | ControlCommand::PlcRestarted
            | ControlCommand::PlcMessages(_)
            | ControlCommand::Written(_)
            | ControlCommand::Fault { .. } => Ok(()),
        }
    }

    fn begin_cycle(&mut self, cycle: u64) {
        self.begin(cycle);
    }

    fn command(&mut self, command: &ControlCommand) -> EventId {
        match command {
            ControlCommand::Store { target, value } => {
                // The command was checked when it was queued. A later command of the same step may have renamed its axis.
                if let Ok(target) = self.stored().parse_target(target) {
                    let _ = self.store(&target, value);
                }
            }
            &ControlCommand::RParameter { channel, number, value } => {
                self.state.r_parameters.set(channel, number, value);
            }
            ControlCommand::SelectProgram { channel, path } => return self.select_program(*channel, path),
            ControlCommand::EnterBlocks { channel, text } => return self.enter_blocks(*channel, text),
            &ControlCommand::Preset { axis, value } => return self.preset(axis, value),
            &ControlCommand::FunctionGenerator(wanted) => return self.parameterise_generator(wanted),
            ControlCommand::Search { channel, block, kind } => return self.search(*channel, block, *kind),
            ControlCommand::Activate => return self.new_conf(),
            ControlCommand::Cancel => return self.press_cancel_key(),
            &ControlCommand::Handwheel { number, pulses, cycles } => {
                return self.turn_handwheel(number, pulses, cycles);
            }
            ControlCommand::PlcMissing => return self.plc_missing(),
            ControlCommand::PlcRestarted => self.plc_restarted(),
            ControlCommand::PlcMessages(messages) => self.state.show_messages(messages),
            ControlCommand::Written(location) => self.written_from_outside(*location),
            &ControlCommand::Fault { axis, name, begins, affected } => {
                return self.note_fault(axis, name, begins, affected);
            }
        }
        EventId::NONE
    }

    fn take_activated(&mut self) -> Vec<Activated> {
        Self::take_activated(self)
    }

    fn decide(&mut self, plc: PlcSide<'_>, changes: Changes) {
        self.select_handwheels(nck_hmi(plc));
        Self::decide(self, to_nck(plc), changes);
    }

    fn stops_plc(&self) -> Option<String> {
        let alarm = self.state.user.alarm(UserReaction::PlcStop)?;
        Some(format!("user alarm {alarm} stops the PLC (MD14516 bit 4)"))
    }

    /// The basic program no longer transfers them: they are 0. Measuring systems and pulse enables stay, so that the axes can brake, and so do
    /// user alarms (P-150).
    fn neutralise(&self, to_nck: &mut [u8]) -> bool {
        let Some(signals) = ToNck::of_bytes_mut(to_nck) else { return false };
        let before = signals.clone();
        signals.as_mut_bytes().fill(0);
        signals.user_alarms = before.user_alarms;
        for (axis, kept) in before.axes.iter() {
            let signals = signals.axis(axis);
            signals.set_position_measuring_system_1(kept.position_measuring_system_1());
            signals.set_position_measuring_system_2(kept.position_measuring_system_2());
            signals.set_pulse_enable(kept.pulse_enable());
        }
        true
    }

    fn velocity_command(&mut self, axis: AxisNumber, counts: [Position; 2], part: u32, of: u32) -> Option<f64> {
        Self::velocity_command(self, axis, counts, part, of)
    }

    fn still(&self) -> AxisSet {
        Self::still(self)
    }

    fn opens_brake(&self, axis: AxisNumber) -> bool {
        self.state.axes[axis].enabling.opens_brake
    }

    fn observe(&mut self, feedback: &PerAxis<Feedback>, changed: AxisSet) {
        Self::observe(self, feedback, changed);
    }

    fn publish(&mut self, out: ControlSide<'_>, variables: &mut Variables, restless: AxisSet) {
        let from_nck = FromNck::of_bytes_mut(out.from_nck).expect(LENGTHS);
        let hmi = Hmi::of_bytes_mut(out.hmi).expect(LENGTHS);
        Self::publish(self, from_nck, hmi, variables, restless);
    }

    fn awake(&self) -> AxisSet {
        Self::awake(self)
    }

    fn never_rest(&mut self) {
        Self::never_rest(self);
    }

    fn decide_always(&mut self) {
        Self::decide_always(self);
    }

    fn power_on(&mut self) -> EventId {
        Self::power_on(self)
    }

    fn cycle_times(&self) -> CycleTimes {
        let parameters = self.parameters();
        CycleTimes { interpolation: parameters.cycle, position_control: parameters.servo_cycles }
    }

    fn has_channel(&self, channel: ChannelNumber) -> bool {
        self.stored().mode_group(channel).is_some()
    }

    fn has_mode_group(&self, mode_group: ModeGroupNumber) -> bool {
        ChannelNumber::all().any(|channel| self.stored().mode_group(channel) == Some(mode_group))
    }

    fn measuring_system(&self, axis: AxisNumber) -> Option<u8> {
        Self::measuring_system(self, axis)
    }

    fn cause(&mut self, place: Place, byte: u16, bit: u8) -> EventId {
        Self::cause(self, place, byte, bit)
    }

    fn alarm_cause(&self, number: AlarmNumber, place: Place) -> EventId {
        Self::alarm_cause(self, number, place)
    }

    fn cleared_cause(&self, number: AlarmNumber, place: Place) -> EventId {
        Self::cleared_cause(self, number, place)
    }

    fn conditions(&self, question: &Question<'_>, plc: PlcSide<'_>) -> Option<Condition> {
        Self::conditions(self, question, to_nck(plc), nck_hmi(plc))
    }

    fn events(&self) -> &Events {
        &self.state.log.events
    }

    fn override_coding(&self) -> OverrideCoding {
        self.active().override_coding()
    }

    fn axis_override(&self, axis: AxisNumber, plc: PlcSide<'_>) -> f64 {
        Self::axis_override(self, &to_nck(plc).axes[axis])
    }

    fn spindle_override(&self, axis: AxisNumber, plc: PlcSide<'_>) -> f64 {
        Self::spindle_override(self, axis, &to_nck(plc).axes[axis])
    }

    fn channel_overrides(&self, channel: ChannelNumber, plc: PlcSide<'_>) -> [f64; 2] {
        Self::channel_overrides(self, &to_nck(plc).channels[channel])
    }

    fn motor_speed(&self, axis: AxisNumber, velocity: f64) -> f64 {
        Self::motor_speed(self, axis, velocity)
    }

    fn shown_program(&self, channel: ChannelNumber) -> ShownProgram<'_> {
        self.state.programs[channel].shown()
    }

    fn zero_offset(&self, channel: ChannelNumber, frame: u8, axis: AxisNumber) -> f64 {
        // G group 8 begins with G500.
        self.state.programs[channel].settable_offset(frame + 1, axis).user()
    }

    fn r_parameter(&self, channel: ChannelNumber, number: u16) -> Option<f64> {
        self.state.r_parameters.get(channel, number)
    }

    fn r_parameters(&self) -> RParameters {
        self.state.r_parameters.clone()
    }

    fn program_text(&self, path: &str, all: bool) -> Option<String> {
        self.programs.archive(path, all)
    }

    fn message_text(&self, index: u32) -> &str {
        self.state.reasons.get(index)
    }

    fn load_programs(&mut self, programs: Vec<Program>, search_path: Vec<String>) {
        Self::load_programs(self, programs, search_path);
    }

    fn data(&self) -> &dyn Data {
        self
    }

    fn texts(&self) -> &'static dyn Texts {
        &TEXTS
    }

    fn is_rotary(&self, axis: AxisNumber) -> bool {
        self.active().axes[axis].is_rot_ax
    }

    fn active_datum(&self, number: u32, index: Option<u8>, axis: Option<AxisNumber>) -> Option<f64> {
        let target = Target::new(number, axis.map_or(Owner::Nck, Owner::Axis), index.unwrap_or(0)).ok()?;
        if index.is_none() && target.datum().count > 1 {
            return None;
        }
        self.active().get(&target)?.number()
    }

    fn in_causes(&self, number: u32, axis: Option<AxisNumber>, value: f64) -> f64 {
        self.active().metric(number, axis, value)
    }

    fn configuration(&self, names: &Names) -> Vec<String> {
        let groupings: Vec<String> = (1..=8).filter_map(|grouping| self.grouping_in_words(grouping, names)).collect();
        if groupings.is_empty() { vec!["gantry groupings: none".to_owned()] } else { groupings }
    }

    fn taken(&self) -> Taken {
        self.taken_transitions()
    }

    fn chart_positions(&self) -> Vec<ChartPosition> {
        self.chart_positions()
    }

    fn save(&self) -> Vec<u8> {
        Self::save(self)
    }

    fn restore(&mut self, saved: &[u8]) -> Result<(), Problem> {
        Self::restore(self, saved)
    }

    fn clone_box(&self) -> Box<dyn Control> {
        Box::new(self.clone())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

impl Data for Nck {
    fn stored(&self, number: u32, owner: Owner, index: u8) -> Option<Datum> {
        let target = Target::new(number, owner, index).ok()?;
        let datum = target.datum();
        let value = Self::stored(self).get(&target)?;
        Some(Datum { kind: datum.kind, read_only: datum.read_only, count: datum.count, value })
    }

    fn named(&self, target: &str) -> Option<DatumValue> {
        let target = Self::stored(self).parse_target(target).ok()?;
        Some(shown(Self::stored(self), &target))
    }

    fn number(&self, identifier: &str) -> Option<u32> {
        by_identifier(identifier).filter(|datum| datum.full_identifier() == identifier).map(|datum| datum.number)
    }

    fn text(&self, number: u32, owner: Owner, index: u8) -> Option<&str> {
        let (data, index) = (Self::stored(self), usize::from(index));
        match (owner, number) {
            (Owner::Nck, 10000) => data.general.axconf_machax_name_tab.get(index).map(String::as_str),
            (Owner::Nck, 10002) => data.general.axconf_logic_machax_tab.get(index).map(String::as_str),
            (Owner::Channel(channel), 20000) => Some(&data.channels[channel].chan_name),
            (Owner::Channel(channel), 20060) => {
                data.channels[channel].axconf_geoax_name_tab.get(index).map(String::as_str)
            }
            (Owner::Channel(channel), 20080) => {
                data.channels[channel].axconf_chanax_name_tab.get(index).map(String::as_str)
            }
            (Owner::Nck | Owner::Channel(_) | Owner::Axis(_), _) => None,
        }
    }
}

impl Nck {
    /// The leading and synchronous axes of a gantry grouping according to the stored data; `None` if no axis belongs to it.
    fn grouping_in_words(&self, grouping: u8, names: &Names) -> Option<String> {
        let with = |code: u8| {
            let of_code = |(axis, _): &(AxisNumber, &str)| self.active().axes[*axis].gantry_axis_type == code;
            let named = names.axes.iter().filter_map(|(axis, name)| Some((axis, name.as_deref()?)));
            named.filter(of_code).map(|(_, name)| name).collect::<Vec<_>>().join(" and ")
        };
        let (leading, synchronous) = (with(grouping), with(10 + grouping));
        if leading.is_empty() && synchronous.is_empty() {
            return None;
        }
        let or_none = |names: String| if names.is_empty() { "no axis of this machine".to_owned() } else { names };
        Some(format!("gantry grouping {grouping}: {} leads {}", or_none(leading), or_none(synchronous)))
    }
}
