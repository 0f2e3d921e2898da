//! Texts for the numbers of this machine's control, and the meaning of names in expressions.

use super::Machine;
use crate::control::AlarmRow;
use crate::expression::Scope;
use crate::image::{Location, Names};
use crate::motion::Encoder;
use crate::source::Problem;
use crate::units::{AxisNumber, ChannelNumber, Position};
use crate::variables::{AlarmNumber, Describe, Parameter, Place, RaisedAlarm, Rule, RuleNumber};

impl Machine {
    /// The ending in the names of NC programs on this control: `.NC`, or none.
    pub(crate) fn program_ending(&self) -> &'static str {
        self.control.texts().program_ending()
    }
}

impl Describe for Machine {
    fn names(&self) -> &Names {
        &self.definition.names
    }

    fn message_text(&self, index: u32) -> &str {
        self.control.message_text(index)
    }

    fn alarm_text(&self, alarm: &RaisedAlarm) -> String {
        let Some(row) = self.control.texts().alarm(alarm.number) else {
            return String::new();
        };
        let mut text = row.text.to_owned();
        for (index, parameter) in alarm.parameters.iter().enumerate() {
            if *parameter == Parameter::None {
                // An alarm of programs that is raised without one has no block.
                text = text.replace(&format!(" block %{}", index + 1), "");
                // A message of the PLC program has no variable, unlike a user alarm with the same number.
                text = text.replace(&format!(", variable %{}", index + 1), "");
            }
            text = text.replace(&format!("%{}", index + 1), &shown(self, *parameter));
        }
        // A text of an alarm that has no place for it says why.
        if let last @ Parameter::OfControl(_) = alarm.parameters[3]
            && !row.text.contains("%4")
        {
            text = format!("{text}: {}", shown(self, last));
        }
        text
    }

    fn alarm_name(&self, number: AlarmNumber) -> String {
        self.control.texts().alarm_name(number)
    }

    fn alarm_number(&self, name: &str) -> Option<AlarmNumber> {
        self.control.texts().alarm_named(name)
    }

    fn alarm_names(&self) -> Vec<String> {
        let own = |row: &AlarmRow| row.number.0 >= AlarmNumber::OWN;
        self.control.texts().alarms().into_iter().filter(own).map(|row| row.name).collect()
    }

    fn has_alarm(&self, number: AlarmNumber) -> bool {
        self.control.texts().alarm(number).is_some()
    }

    fn parameter(&self, name: &str, place: Place) -> Option<(u32, [u16; 2])> {
        self.control.texts().parameter(name, place)
    }

    fn rule(&self, rule: RuleNumber) -> Rule {
        self.control.texts().rule(rule)
    }

    fn rules(&self) -> &'static [Rule] {
        self.control.texts().rules()
    }

    fn datum_name(&self, number: u32) -> String {
        self.control.texts().datum_name(number)
    }

    fn is_rotary(&self, axis: AxisNumber) -> bool {
        self.control.is_rotary(axis)
    }

    fn half_count(&self, axis: AxisNumber) -> Position {
        let encoders = self.definition.layout.axes[axis].iter().flat_map(|mechanics| &mechanics.encoders);
        encoders.map(Encoder::half_count).max().unwrap_or(Position::ZERO)
    }

    fn active_datum(&self, number: u32, index: Option<u8>, axis: Option<AxisNumber>) -> Option<f64> {
        self.control.active_datum(number, index, axis)
    }

    fn r_parameter_count(&self, channel: ChannelNumber) -> usize {
        self.state.variables.r_parameters.count(channel)
    }

    fn in_causes(&self, number: u32, axis: Option<AxisNumber>, value: f64) -> f64 {
        self.control.in_causes(number, axis, value)
    }
}

impl Scope for Machine {
    fn describe(&self) -> &dyn Describe {
        self
    }

    fn signal(&self, name: &str) -> Result<Location, Problem> {
        self.names().resolve(self.memory(), name)
    }
}

fn shown(machine: &Machine, parameter: Parameter) -> String {
    let names = &machine.definition.names;
    match parameter {
        Parameter::None => String::new(),
        Parameter::Channel(number) => names.channels[number].clone().unwrap_or_else(|| format!("CHAN{number}")),
        Parameter::Axis(number) => names.axes[number].clone().unwrap_or_else(|| format!("AX{number}")),
        Parameter::Number(number) => number.to_string(),
        Parameter::Direction(direction) => if direction < 0 { "-" } else { "+" }.to_owned(),
        Parameter::Milliseconds(time) => time.milliseconds().to_string(),
        Parameter::Text(text) => text.to_string(),
        Parameter::OfControl(index) => machine.control.message_text(index).to_owned(),
    }
}
