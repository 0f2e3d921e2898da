//! Causes as text: the rule that allowed a transition, and the inputs that it tested, with their values.

use super::Trace;
use super::history::ProgramRow;
use super::printable::{Shown, signal_name};
use crate::image::{Interface, Names};
use crate::units::{AxisNumber, Position};
use crate::variables::{AlarmNumber, AxisValue, Describe, Event, Input, Quantity, axis_name, six_decimals};

/// The rule, its text if the inputs do not express it, and the inputs: `REF-11: MD37110[XF] = 0`,
/// `REF-31: reference cam reached, X.deceleration_reference_point_approach = 1`.
#[must_use]
pub fn because(event: &Event, describe: &dyn Describe) -> String {
    let rule = describe.rule(event.rule);
    let text = Some(rule.text.to_owned()).filter(|text| !text.is_empty());
    let inputs = event.inputs.iter().filter_map(|input| shown(input, describe));
    format!("{}: {}", rule.id, text.into_iter().chain(inputs).collect::<Vec<_>>().join(", "))
}

/// The statement that changed a bit or a word, and the operands that made its result: `OB1, network 2, statement 3 (main.awl:8): I0.0 = 1`.
pub(super) fn by_program(trace: &Trace, row: &ProgramRow, names: &Names) -> String {
    let tested = row.tested.iter().map(|&(location, value)| {
        let address = names.address(location).to_string();
        let name = names.symbol(location).unwrap_or_else(|| trace.program_name(&address));
        format!("{name} = {}", Shown::of(location, value))
    });
    let operations = row.operations.iter().map(|(text, value)| format!("{text} = {}", u8::from(*value)));
    let tested: Vec<_> = tested.chain(operations).collect();
    if tested.is_empty() { row.statement.to_string() } else { format!("{}: {}", row.statement, tested.join(", ")) }
}

fn shown(input: &Input, describe: &dyn Describe) -> Option<String> {
    let names = describe.names();
    match *input {
        Input::None => None,
        Input::Bit(bit, value) => Some(format!("{} = {}", signal_name(bit, names), u8::from(value))),
        Input::Number(bit, value) => Some(format!("{} = {value}", signal_name(bit, names))),
        Input::Datum(number, None, value) => Some(format!("{} = {value}", describe.datum_name(number))),
        Input::Datum(number, Some(axis), value) => {
            Some(format!("{}[{}] = {value}", describe.datum_name(number), axis_name(axis, names)))
        }
        Input::Element(number, index, axis, value) => {
            Some(format!("{}[{index},{}] = {value}", describe.datum_name(number), axis_name(axis, names)))
        }
        Input::Length(quantity, axis, length) => {
            let (name, value) = input_name(quantity, length, per_turn(axis, describe), names.interface());
            let axis = axis_name(axis, names);
            Some(format!("{axis}.{name} = {}", six_decimals(value)))
        }
        Input::Alarm(number) => Some(format!("alarm {}", describe.alarm_name(AlarmNumber(number)))),
        Input::Fault(fault) => Some(fault.name().to_owned()),
        Input::Block(name) => Some(format!("block {name}")),
    }
}

/// The distance that a unit of the displayed velocity of an axis stands for: where a rotary axis shows rev/min, 360 degrees.
pub(super) fn per_turn(axis: AxisNumber, describe: &dyn Describe) -> f64 {
    if describe.is_rotary(axis) { describe.names().interface().values().rotary_velocity_degrees } else { 1.0 }
}

/// The name of a length, and its value in user units.
pub(super) fn input_name(
    quantity: Quantity,
    length: Position,
    per_turn: f64,
    interface: &Interface,
) -> (&'static str, f64) {
    let name = |value: AxisValue| value.name(interface);
    match quantity {
        Quantity::SynchronismDifference => (name(AxisValue::SynchronismDifference), length.user()),
        Quantity::Position => (name(AxisValue::Position), length.user()),
        Quantity::Setpoint => (name(AxisValue::Setpoint), length.user()),
        Quantity::Target => ("target", length.user()),
        Quantity::ZeroMark => ("zero_mark", length.user()),
        Quantity::Deviation => ("deviation", length.user()),
        Quantity::ModelDeviation => ("contour_deviation", length.user()),
        Quantity::ZeroMarkDeviation => ("zero_mark_deviation", length.user()),
        Quantity::Base => ("base", length.user()),
        Quantity::Sag => ("sag", length.user()),
        Quantity::SetpointCompensation => (name(AxisValue::SetpointCompensation), length.user()),
        Quantity::Distance => ("distance", length.user()),
        // Events contain mm or degrees per second; all texts show the unit of the values of the axis.
        Quantity::Velocity => (name(AxisValue::Velocity), length.user() * 60.0 / per_turn),
        Quantity::VelocityCommand => ("velocity_command", length.user() * 60.0 / per_turn),
    }
}
