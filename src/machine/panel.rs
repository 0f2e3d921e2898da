//! A machine as an operator panel sees it, for the NC variables: machine data, and values of its control besides signals and variables.

use super::{Command, Machine};
use crate::control::{ClearInfo, Datum as StoredDatum, Kind, Owner, Value};
use crate::source::Problem;
use crate::units::{AxisNumber, ChannelNumber, Time};
use crate::variables::nc::{ControlValues, Datum, MachineData, Refused};
use crate::variables::{AlarmNumber, Place, ShownProgram};

fn owner(place: Place) -> Owner {
    match place {
        Place::Nck | Place::ModeGroup(_) => Owner::Nck,
        Place::Channel(channel) => Owner::Channel(channel),
        Place::Axis(axis) => Owner::Axis(axis),
    }
}

fn stored(machine: &Machine, place: Place, number: u16, index: u16) -> Option<StoredDatum> {
    machine.control().data().stored(number.into(), owner(place), u8::try_from(index).ok()?)
}

/// The control as an operator panel sees it: the stored machine data, and the values in effect.
#[derive(Debug)]
pub struct Panel<'a>(pub &'a Machine);

impl Panel<'_> {
    /// The command that stores a machine datum.
    ///
    /// # Errors
    /// The machine has no such datum.
    pub fn store(&self, place: Place, number: u16, index: u16, value: f64) -> Result<Command, Problem> {
        let datum = stored(self.0, place, number, index).ok_or_else(|| {
            Problem::new(
                format!("machine datum {number} with index {index} does not exist"),
                "use the machine data and indices of this control",
            )
        })?;
        let value = match datum.kind {
            Kind::Boolean => Value::Boolean(value > 0.5),
            // An integer has no decimal point in the text, and is read back as an integer.
            Kind::Byte | Kind::Dword | Kind::Udword => Value::parse(&value.to_string()).unwrap_or(Value::Real(value)),
            Kind::Double | Kind::String => Value::Real(value),
        };
        let target = match (place, datum.count) {
            (Place::Axis(axis), 1) => format!("{number}[AX{axis}]"),
            (Place::Axis(axis), _) => format!("{number}[{index},AX{axis}]"),
            (Place::Channel(channel), 1) => format!("{number}[CHAN{channel}]"),
            (Place::Channel(channel), _) => format!("{number}[{index},CHAN{channel}]"),
            (Place::Nck | Place::ModeGroup(_), 1) => number.to_string(),
            (Place::Nck | Place::ModeGroup(_), _) => format!("{number}[{index}]"),
        };
        Ok(Command::MachineDatum { target, value })
    }
}

impl MachineData for Panel<'_> {
    fn datum(&self, place: Place, number: u16, index: u16) -> Option<Datum<'_>> {
        let data = self.0.control().data();
        let index = u8::try_from(index).ok()?;
        if let Some(text) = data.text(number.into(), owner(place), index) {
            return Some(Datum::Text(text));
        }
        let StoredDatum { kind, value, .. } = data.stored(number.into(), owner(place), index)?;
        Some(match kind {
            Kind::Boolean => Datum::Boolean(value == Value::Boolean(true)),
            Kind::Byte => Datum::Byte(u8::try_from(value.whole()?).ok()?),
            Kind::Dword => Datum::Whole(i32::try_from(value.whole()?).ok()?),
            Kind::Udword => Datum::Unsigned(u32::try_from(value.whole()?).ok()?),
            Kind::Double => Datum::Number(value.number()?),
            Kind::String => return None,
        })
    }

    fn number(&self, identifier: &str) -> Option<u16> {
        self.0.control().data().number(identifier)?.try_into().ok()
    }

    fn may_store(&self, place: Place, number: u16, index: u16, value: f64) -> Result<(), Refused> {
        let datum = stored(self.0, place, number, index).ok_or(Refused::DoesNotExist)?;
        if datum.read_only {
            return Err(Refused::NotAllowed);
        }
        let command = self.store(place, number, index, value).map_err(|_| Refused::DoesNotExist)?;
        self.0.check(&command).map_err(|_| Refused::OutOfRange)
    }
}

impl ControlValues for Panel<'_> {
    fn time(&self) -> Time {
        self.0.time()
    }

    fn axis_override(&self, axis: AxisNumber) -> f64 {
        self.0.axis_override(axis)
    }

    fn spindle_override(&self, axis: AxisNumber) -> f64 {
        self.0.spindle_override(axis)
    }

    fn channel_overrides(&self, channel: ChannelNumber) -> [f64; 2] {
        self.0.channel_overrides(channel)
    }

    fn motor_speed(&self, axis: AxisNumber) -> f64 {
        self.0.motor_speed(axis)
    }

    fn is_rotary(&self, axis: AxisNumber) -> bool {
        self.0.control().is_rotary(axis)
    }

    fn shown_program(&self, channel: ChannelNumber) -> ShownProgram<'_> {
        self.0.control().shown_program(channel)
    }

    fn zero_offset(&self, channel: ChannelNumber, frame: u8, axis: AxisNumber) -> f64 {
        self.0.control().zero_offset(channel, frame, axis)
    }

    fn r_parameter(&self, channel: ChannelNumber, number: u16) -> Option<f64> {
        self.0.r_parameter(channel, number)
    }

    fn message_text(&self, index: u32) -> &str {
        self.0.control().message_text(index)
    }

    fn clear_info(&self, alarm: AlarmNumber) -> u8 {
        // An alarm that the control does not know is cancelled by power on.
        self.0.control().texts().alarm(alarm).map_or(ClearInfo::PowerOn, |alarm| alarm.clear_info).code()
    }
}
