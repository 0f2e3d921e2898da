//! The texts behind the numbers of this machine's control, and what names mean in expressions over it.

use super::Machine;
use crate::expression::Scope;
use crate::image::{Location, Names};
use crate::sinumerik::{ALARMS_NOT_RAISED, Alarm, Rule as ControlRule};
use crate::source::Problem;
use crate::units::AxisNumber;
use crate::variables::{AlarmNumber, Describe, Parameter, RaisedAlarm, Rule, RuleNumber};

impl Describe for Machine {
    fn names(&self) -> &Names {
        &self.definition.names
    }

    fn alarm_text(&self, alarm: &RaisedAlarm) -> String {
        let Some(row) = Alarm::find(alarm.number) else {
            return String::new();
        };
        let mut text = row.text.to_owned();
        for (index, parameter) in alarm.parameters.iter().enumerate() {
            text = text.replace(&format!("%{}", index + 1), &shown(self, *parameter));
        }
        text
    }

    fn alarm_name(&self, number: AlarmNumber) -> String {
        Alarm::name(number)
    }

    fn alarm_number(&self, name: &str) -> Option<AlarmNumber> {
        Alarm::named(name)
    }

    fn has_alarm(&self, number: AlarmNumber) -> bool {
        Alarm::find(number).is_some() || ALARMS_NOT_RAISED.iter().any(|alarm| alarm.number == number)
    }

    fn rule(&self, rule: RuleNumber) -> Rule {
        ControlRule::text(rule)
    }

    fn is_rotary(&self, axis: AxisNumber) -> bool {
        self.machine_data().axes[axis].is_rot_ax
    }
}

impl Scope for Machine {
    fn describe(&self) -> &dyn Describe {
        self
    }

    fn signal(&self, name: &str) -> Result<Location, Problem> {
        self.names().resolve(&self.memory, name)
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
    }
}
