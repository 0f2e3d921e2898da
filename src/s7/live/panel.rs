//! What clients see of a live machine beside memory and variables: machine data, and what its control knows.

use crate::image::Profile;
use crate::machine::{Command, DatumValue, Machine};
use crate::s7::nck::{self, Datum};
use crate::s7::{Identity, Refusal};
use crate::sinumerik::Alarm;
use crate::sinumerik::machine_data::{Kind, Owner, Target};
use crate::source::Problem;
use crate::units::{AxisNumber, ChannelNumber, Time};
use crate::variables::{AlarmNumber, Place};

/// The command that stores a machine datum.
pub(super) fn machine_datum(place: Place, number: u16, index: u16, value: f64) -> Result<Command, Problem> {
    let target = target(place, number, index)?;
    let value = match target.datum().kind {
        Kind::Boolean => DatumValue::Boolean(value > 0.5),
        // A whole number is written without a point, and read as one.
        Kind::Byte | Kind::Dword | Kind::Udword => {
            DatumValue::parse(&value.to_string()).unwrap_or(DatumValue::Real(value))
        }
        Kind::Double | Kind::String => DatumValue::Real(value),
    };
    let index = target.index();
    let target = match (place, target.datum().count) {
        (Place::Axis(axis), 1) => format!("{number}[AX{axis}]"),
        (Place::Axis(axis), _) => format!("{number}[{index},AX{axis}]"),
        (Place::Channel(channel), 1) => format!("{number}[CHAN{channel}]"),
        (Place::Channel(channel), _) => format!("{number}[{index},CHAN{channel}]"),
        (Place::Nck | Place::ModeGroup(_), 1) => number.to_string(),
        (Place::Nck | Place::ModeGroup(_), _) => format!("{number}[{index}]"),
    };
    Ok(Command::MachineDatum { target, value })
}

fn target(place: Place, number: u16, index: u16) -> Result<Target, Problem> {
    let owner = match place {
        Place::Nck | Place::ModeGroup(_) => Owner::Nck,
        Place::Channel(channel) => Owner::Channel(channel),
        Place::Axis(axis) => Owner::Axis(axis),
    };
    Target::new(number.into(), owner, u8::try_from(index).unwrap_or(u8::MAX))
}

/// What an operator panel shows of the control: machine data as they are stored, and what acts.
pub(super) struct Panel<'a>(pub(super) &'a Machine);

impl nck::MachineData for Panel<'_> {
    fn datum(&self, place: Place, number: u16, index: u16) -> Option<Datum<'_>> {
        let target = target(place, number, index).ok()?;
        let data = self.0.stored_machine_data();
        if target.datum().kind == Kind::String {
            return text(self.0, place, number, index).map(Datum::Text);
        }
        let value = data.get(&target)?;
        Some(match target.datum().kind {
            Kind::Boolean => Datum::Boolean(value == DatumValue::Boolean(true)),
            Kind::Byte => Datum::Byte(u8::try_from(value.whole()?).ok()?),
            Kind::Dword => Datum::Whole(i32::try_from(value.whole()?).ok()?),
            Kind::Udword => Datum::Unsigned(u32::try_from(value.whole()?).ok()?),
            Kind::Double => Datum::Number(value.number()?),
            Kind::String => return None,
        })
    }

    fn may_store(&self, place: Place, number: u16, index: u16, value: f64) -> Result<(), Refusal> {
        let target = target(place, number, index).map_err(|_| Refusal::DoesNotExist)?;
        if target.datum().read_only {
            return Err(Refusal::NotAllowed);
        }
        let command = machine_datum(place, number, index, value).map_err(|_| Refusal::DoesNotExist)?;
        let Command::MachineDatum { value, .. } = command else { return Ok(()) };
        self.0.stored_machine_data().check(&target, &value).map_err(|_| Refusal::OutOfRange)
    }
}

impl nck::ControlValues for Panel<'_> {
    fn time(&self) -> Time {
        self.0.time()
    }

    fn axis_override(&self, axis: AxisNumber) -> f64 {
        self.0.axis_override(axis)
    }

    fn channel_overrides(&self, channel: ChannelNumber) -> [f64; 2] {
        self.0.channel_overrides(channel)
    }

    fn motor_speed(&self, axis: AxisNumber) -> f64 {
        self.0.motor_speed(axis)
    }

    fn r_parameter(&self, channel: ChannelNumber, number: u16) -> Option<f64> {
        self.0.r_parameters().get(channel, number)
    }

    fn clear_info(&self, alarm: AlarmNumber) -> u8 {
        Alarm::clear_info(alarm)
    }
}

/// What the PLC of a control is called.
pub(super) fn identity(machine: &Machine) -> Identity<'static> {
    if machine.names().profile == Profile::SINUMERIK_828D {
        Identity::SINUMERIK_828D
    } else {
        Identity::SINUMERIK_840D_SL
    }
}

/// Names of axes and channels.
fn text(machine: &Machine, place: Place, number: u16, index: u16) -> Option<&str> {
    let data = machine.stored_machine_data();
    let index = usize::from(index);
    match (place, number) {
        (Place::Nck, 10000) => data.general.axconf_machax_name_tab.get(index).map(String::as_str),
        (Place::Nck, 10002) => data.general.axconf_logic_machax_tab.get(index).map(String::as_str),
        (Place::Channel(channel), 20000) => Some(&data.channels[channel].chan_name),
        (Place::Channel(channel), 20060) => data.channels[channel].axconf_geoax_name_tab.get(index).map(String::as_str),
        (Place::Channel(channel), 20080) => {
            data.channels[channel].axconf_chanax_name_tab.get(index).map(String::as_str)
        }
        _ => None,
    }
}
