//! The NC as the PLC program of a machine reaches it beside the interface: NC variables of control and machine, orders, messages.

use crate::control::{Control, ControlCommand, Owner, Value};
use crate::plc::{NcOrder, NcServices, NcVariable};
use crate::units::{AxisNumber, ChannelNumber};
use crate::variables::Variables;

/// The modules of the NC variables that a PLC program can read.
mod module {
    pub(super) const R_PARAMETERS: u8 = 0x15;
    pub(super) const MACHINE_DATA: u8 = 0x1A;
    pub(super) const MACHINE_AXES_EXTENDED: u8 = 0x71;
    pub(super) const MACHINE_AXES: u8 = 0x74;
}

/// What a program reads during one scan, and what it orders.
#[derive(Debug)]
pub(super) struct NcOfMachine<'a> {
    pub(super) control: &'a dyn Control,
    pub(super) variables: &'a Variables,
    /// What the program ordered, checked by the control.
    pub(super) orders: Vec<ControlCommand>,
    /// The messages that are shown.
    pub(super) messages: &'a mut Vec<u32>,
    /// They have changed.
    pub(super) has_new_messages: bool,
}

impl NcOfMachine<'_> {
    fn of_axis(&self, variable: NcVariable) -> Option<f64> {
        let values = &self.variables.axes[AxisNumber::new(u8::try_from(variable.line).ok()?)?];
        Some(match (variable.module, variable.column) {
            (module::MACHINE_AXES, 1) => values.setpoint.user(),
            (module::MACHINE_AXES, 2) => values.position.user(),
            (module::MACHINE_AXES, 3) => values.distance_to_go.user(),
            (module::MACHINE_AXES_EXTENDED, 3) => values.velocity,
            (module::MACHINE_AXES_EXTENDED, 5) => values.encoders[0].user(),
            (module::MACHINE_AXES_EXTENDED, 6) => values.encoders[1].user(),
            (module::MACHINE_AXES_EXTENDED, 9) => values.setpoint.user(),
            (module::MACHINE_AXES_EXTENDED, 10) => values.following_error.user(),
            _ => return None,
        })
    }
}

impl NcOfMachine<'_> {
    /// The command that writes an NC variable; `None` for one that only shows a value.
    fn command(&self, variable: NcVariable, value: f64) -> Option<ControlCommand> {
        let row = variable.line.checked_sub(1)?;
        match variable.module {
            module::R_PARAMETERS => {
                let channel = ChannelNumber::new(variable.unit)?;
                Some(ControlCommand::RParameter { channel, number: row, value })
            }
            module::MACHINE_DATA => {
                let owner = owner(variable)?;
                let datum = self.control.data().stored(variable.column.into(), owner, u8::try_from(row).ok()?)?;
                let place = match owner {
                    Owner::Nck => None,
                    Owner::Channel(channel) => Some(format!("CHAN{channel}")),
                    Owner::Axis(axis) => Some(format!("AX{axis}")),
                };
                let index = (datum.count > 1).then(|| row.to_string());
                let parts: Vec<_> = index.into_iter().chain(place).collect();
                let number = variable.column;
                let target =
                    if parts.is_empty() { number.to_string() } else { format!("{number}[{}]", parts.join(",")) };
                let value = if datum.read_only { return None } else { value_of(&datum.value, value) };
                Some(ControlCommand::Store { target, value })
            }
            _ => None,
        }
    }
}

/// A number in the kind of the present value.
fn value_of(present: &Value, value: f64) -> Value {
    match present {
        Value::Boolean(_) => Value::Boolean(value != 0.0),
        #[expect(clippy::cast_possible_truncation, reason = "the control checks the range of the datum")]
        Value::Integer(_) => Value::Integer(value.round() as i64),
        Value::Real(_) | Value::Text(_) => Value::Real(value),
    }
}

fn owner(variable: NcVariable) -> Option<Owner> {
    match variable.area {
        0 => Some(Owner::Nck),
        2 => ChannelNumber::new(variable.unit).map(Owner::Channel),
        3 => AxisNumber::new(variable.unit).map(Owner::Axis),
        _ => None,
    }
}

impl NcServices for NcOfMachine<'_> {
    fn read(&self, variable: NcVariable) -> Option<f64> {
        let row = variable.line.checked_sub(1)?;
        match variable.module {
            module::R_PARAMETERS => self.control.r_parameter(ChannelNumber::new(variable.unit)?, row),
            module::MACHINE_DATA => {
                let index = u8::try_from(row).ok()?;
                self.control.data().stored(u32::from(variable.column), owner(variable)?, index)?.value.number()
            }
            module::MACHINE_AXES | module::MACHINE_AXES_EXTENDED => self.of_axis(variable),
            _ => None,
        }
    }

    fn order(&mut self, order: NcOrder) -> bool {
        let command = match order {
            NcOrder::SelectProgram(channel, path) => ControlCommand::SelectProgram { channel, path },
            NcOrder::ActivateData => ControlCommand::Activate,
            NcOrder::Write(variable, value) => match self.command(variable, value) {
                Some(command) => command,
                None => return false,
            },
        };
        let is_taken = self.control.check(&command).is_ok();
        if is_taken {
            self.orders.push(command);
        }
        is_taken
    }

    fn show(&mut self, messages: &[u32]) {
        if self.messages != messages {
            messages.clone_into(self.messages);
            self.has_new_messages = true;
        }
    }
}
