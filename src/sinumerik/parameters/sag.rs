//! The tables of sag compensation that are evaluated, and what is wrong with the others (20120 to 20123).

use crate::sinumerik::alarms;
use crate::sinumerik::machine_data::MachineData;
use crate::sinumerik::parameters::compensation::Table;
use crate::sinumerik::parameters::configuration::ChannelFault;
use crate::sinumerik::parameters::groupings::Fault;
use crate::sinumerik::rules::Rule;
use crate::units::AxisNumber;
use crate::variables::{AlarmNumber, Input, Parameter, Place};

/// The largest number of tables with the same output axis (20120).
const MOST_TABLES: usize = 5;

/// A table of sag compensation that is evaluated.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::sinumerik) struct SagRelation {
    /// The axis whose setpoint is the position in the table.
    pub input: AxisNumber,
    /// The axis that gets the value.
    pub output: AxisNumber,
    /// Only while the input axis moves in this direction; 0 both directions.
    pub direction: i8,
    /// SD41310.
    pub weight: f64,
    pub table: Table,
    /// The table with which it is multiplied, with its input axis and weight.
    pub factor: Option<(AxisNumber, f64, Table)>,
}

/// The evaluated tables of sag compensation, and what is wrong with the others.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::sinumerik) struct SagTables {
    pub relations: Vec<SagRelation>,
    pub faults: Vec<ChannelFault>,
}

/// The tables with SD41300 = 1 whose output axis has MD32710 = 1.
pub(super) fn sag_tables(data: &MachineData) -> SagTables {
    let mut found = SagTables::default();
    let enabled = data
        .tables
        .sag
        .iter()
        .filter(|(number, _)| data.setting.cec_table_enable.get(usize::from(**number)) == Some(true));
    for (&number, table) in enabled {
        match relation(data, number) {
            Ok(relation) => found.relations.extend(relation),
            Err((alarm, rule, tested)) => {
                let number = Parameter::Number(number.into());
                let parameters = match (alarm, table.output) {
                    (alarms::SAG_AXES_MISSING, _) | (_, None) => {
                        [number, Parameter::None, Parameter::None, Parameter::None]
                    }
                    (_, Some(axis)) => [Parameter::Axis(axis), number, Parameter::None, Parameter::None],
                };
                let place = table.output.map_or(Place::Nck, Place::Axis);
                let fault = Fault { alarm, place, parameters };
                found.faults.push(ChannelFault { fault, rule, tested });
            }
        }
    }
    for axis in MachineData::axis_numbers() {
        let count = found.relations.iter().filter(|relation| relation.output == axis).count();
        if count > MOST_TABLES {
            found.relations.retain(|relation| relation.output != axis);
            let parameters = [Parameter::Axis(axis), Parameter::None, Parameter::None, Parameter::None];
            let fault = Fault { alarm: alarms::SAG_TOO_MANY_TABLES, place: Place::Axis(axis), parameters };
            let tested = Input::Datum(32710, Some(axis), 1.0);
            found.faults.push(ChannelFault { fault, rule: Rule::SagTooManyTables, tested });
        }
    }
    found
}

/// The table of a number; `Ok(None)` while its output axis has MD32710 = 0.
fn relation(data: &MachineData, number: u8) -> Result<Option<SagRelation>, (AlarmNumber, Rule, Input)> {
    let sag = &data.tables.sag[&number];
    let enabled = sag
        .output
        .map_or(Input::None, |axis| Input::Datum(32710, Some(axis), f64::from(u8::from(data.axes[axis].cec_enable))));
    let (Some(input), Some(output)) = (sag.input, sag.output) else {
        return Err((alarms::SAG_AXES_MISSING, Rule::SagAxesMissing, enabled));
    };
    if !data.axes[output].cec_enable {
        return Ok(None);
    }
    let wrong = (alarms::SAG_TABLE_WRONG, Rule::SagTableWrong, enabled);
    let table = Table::new(&sag.points).ok_or(wrong)?;
    let weight = |table: u8| data.setting.cec_table_weight.get(usize::from(table)).unwrap_or(1.0);
    let factor = match sag.multiplied_by.checked_sub(1) {
        None => None,
        Some(other) => {
            let missing = (alarms::SAG_AXES_MISSING, Rule::SagAxesMissing, enabled);
            let factor = data.tables.sag.get(&other).ok_or(missing)?;
            if factor.output != Some(output) {
                return Err((alarms::SAG_PRODUCT, Rule::SagProduct, enabled));
            }
            let input = factor.input.ok_or(missing)?;
            Some((input, weight(other), Table::new(&factor.points).ok_or(wrong)?))
        }
    };
    Ok(Some(SagRelation { input, output, direction: sag.direction, weight: weight(number), table, factor }))
}
