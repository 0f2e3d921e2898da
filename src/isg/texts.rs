//! The texts of the control: messages, rules, parameters.

use super::hli::HLI;
use super::rules::RULES;
use super::{charts, lists, messages};
use crate::control::{AlarmRow, Chart, ClearInfo, DatumRow, Texts};
use crate::image::Interface;
use crate::variables::{AlarmNumber, Place, Rule};

/// The texts.
#[derive(Debug)]
pub struct IsgTexts;

/// The texts of the ISG kernel.
pub static TEXTS: IsgTexts = IsgTexts;

/// The row of a message.
fn alarm_row(row: &'static messages::Row) -> AlarmRow {
    let locked = row.number == messages::STAGE_2;
    AlarmRow {
        number: row.number,
        name: messages::name(row.number),
        text: row.text,
        raised: !matches!(
            row.number,
            messages::COMPENSATED_WHILE_COUPLED
                | messages::LINK_OF_MASTER_CONFLICTS
                | messages::MASTER_INDEPENDENT
                | messages::RETRACT_DISTANCE
                | messages::SLAVE_IS_MAIN_SPINDLE
        ),
        cancelled_by: if locked { "restart" } else { "NC reset" }.to_owned(),
        reaction: match row.class {
            1 => "none: a warning".to_owned(),
            3 => "at the start the entry is corrected; ends a program".to_owned(),
            4 => "stops all coupled axes at a_emergency".to_owned(),
            7 => "halts the axes".to_owned(),
            _ => "ends the program".to_owned(),
        },
        clear_info: if locked { ClearInfo::PowerOn } else { ClearInfo::Reset },
    }
}

/// The row of a message about a parameter.
fn parameter_row(parameter: &lists::Parameter) -> AlarmRow {
    AlarmRow {
        number: messages::of_parameter(parameter.number()),
        name: parameter.id(),
        text: match parameter.scope {
            lists::Scope::Axis => "Axis %1, check of the parameter lists: %3",
            lists::Scope::Channel => "Channel %1, check of the parameter lists: %4",
        },
        raised: true,
        cancelled_by: "NC reset".to_owned(),
        reaction: "none: the nearest allowed value, or that of the master, is used".to_owned(),
        clear_info: ClearInfo::Reset,
    }
}

impl Texts for IsgTexts {
    fn name(&self) -> &'static str {
        "isg"
    }

    fn interface(&self) -> &'static Interface {
        &HLI
    }

    fn first_names(&self) -> (&'static str, &'static str) {
        ("ax1", "channel_1")
    }

    fn alarms(&self) -> Vec<AlarmRow> {
        let mut rows: Vec<AlarmRow> = messages::ROWS.iter().map(alarm_row).collect();
        let taken: Vec<String> = rows.iter().map(|row| row.name.clone()).collect();
        let parameters = lists::PARAMETERS.iter().filter(|parameter| !taken.contains(&parameter.id()));
        rows.extend(parameters.map(parameter_row));
        rows.sort_by_key(|row| row.number);
        rows
    }

    fn alarm(&self, number: AlarmNumber) -> Option<AlarmRow> {
        match messages::row(number) {
            Some(row) => Some(alarm_row(row)),
            None => lists::PARAMETERS
                .iter()
                .find(|parameter| messages::of_parameter(parameter.number()) == number)
                .map(parameter_row),
        }
    }

    fn alarm_name(&self, number: AlarmNumber) -> String {
        messages::name(number)
    }

    fn alarm_named(&self, name: &str) -> Option<AlarmNumber> {
        messages::named(name)
    }

    fn rules(&self) -> &'static [Rule] {
        RULES
    }

    fn parameter(&self, name: &str, place: Place) -> Option<(u32, [u16; 2])> {
        let (parameter, index) = lists::parameter(name)?;
        let is_of_axis = matches!(place, Place::Axis(_));
        (is_of_axis == (parameter.scope == lists::Scope::Axis)).then(|| (parameter.number(), index))
    }

    fn datum_name(&self, number: u32) -> String {
        lists::id(number)
    }

    fn cycle_data(&self) -> &'static str {
        "[machine] cycle in plant.toml"
    }

    fn machine_data(&self) -> Vec<DatumRow> {
        let row = |parameter: &lists::Parameter| DatumRow {
            number: parameter.number(),
            name: parameter.name.map_or_else(|| parameter.id(), |name| format!("{} {name}", parameter.id())),
            unit: parameter.units[0],
            range: parameter.range.to_owned(),
            default: parameter.default.to_owned(),
            effect: parameter.effect.to_string(),
            modelled: parameter.is_modelled,
            text: parameter.meaning,
        };
        let mut rows: Vec<DatumRow> = lists::PARAMETERS.iter().map(row).collect();
        rows.sort_by_key(|row| row.number);
        rows
    }

    fn program_ending(&self) -> &'static str {
        ".NC"
    }

    fn charts(&self) -> Vec<Chart> {
        charts::charts()
    }
}
