//! The variables of the NCK as clients of a SINUMERIK read them: by area, unit, module, column and line.
//!
//! [`CATALOGUE`] has the variables by name, [`MachineData`] provides the machine data of module `1A`, and R parameters are module `15`.
//! Rows count from one. An item may request several consecutive rows; `R5` is row 6. Values are little-endian, unlike everything else on
//! the wire, except those of drives. Texts have a fixed length and are padded with zeros.
//!
//! A write is checked completely before it is acknowledged: machine data by type, range and write permission, R parameters by their length.
//! Displayed values of the control cannot be written.

mod alarms;
mod catalogue;
mod data;
mod drives;
mod values;
mod variable;
mod view;

pub use catalogue::CATALOGUE;
pub use data::{ControlValues, Datum, MachineData};
pub(super) use drives::read as read_drive;
pub use variable::{Kind, NckArea, Shown, Variable};
pub use view::View;

use super::command::Command;
use super::wire::data::Refusal;
use super::wire::items::{MeasuringSystem, NckItem};
use crate::image::{Layout, Sinumerik};
use crate::variables::Place;

use data::put_text;
use values::r_parameter;
use variable::module;

/// Appends the rows that an item requests.
///
/// # Errors
/// There is no such variable, or no such row.
pub fn read(view: &View<'_>, item: &NckItem, into: &mut Vec<u8>) -> Result<(), Refusal> {
    let lines = lines(item)?;
    let start = into.len();
    let variable = find(view, item);
    for line in lines {
        let put = match variable {
            Some(variable) => put_variable(view, variable, item, line, into),
            None => datum(view, item, line).map(|(_, datum)| datum.put(into)),
        };
        if let Err(refusal) = put {
            into.truncate(start);
            return Err(refusal);
        }
    }
    Ok(())
}

/// The requested rows; there is no row 0.
fn lines(item: &NckItem) -> Result<std::ops::Range<u16>, Refusal> {
    let end = item.line.checked_add(item.count.into()).ok_or(Refusal::OutOfRange)?;
    if item.line == 0 || item.count == 0 { Err(Refusal::OutOfRange) } else { Ok(item.line..end) }
}

/// Units count from 1. For the NCK, of which there is only one, some clients send 0 and others 1.
fn unit(item: &NckItem) -> u8 {
    if item.area == NckArea::Nck.code() { item.unit.max(1) } else { item.unit }
}

/// The row of the catalogue. The NC variables are those of a SINUMERIK; another control has none of them.
fn find(view: &View<'_>, item: &NckItem) -> Option<&'static Variable> {
    if !Sinumerik::is_of(view.names.interface()) {
        return None;
    }
    // The NCK has the axes of all channels; here these are the same axes.
    let area = match (item.area, item.module) {
        (0, module::SMA | module::SEMA) => NckArea::Channel.code(),
        (area, _) => area,
    };
    let is_it = |variable: &&Variable| {
        variable.area.code() == area && variable.module == item.module && variable.column == item.column
    };
    CATALOGUE.iter().find(is_it)
}

fn put_variable(
    view: &View<'_>,
    variable: &Variable,
    item: &NckItem,
    line: u16,
    into: &mut Vec<u8>,
) -> Result<(), Refusal> {
    let shown = (variable.get)(view, unit(item), line).ok_or(Refusal::OutOfRange)?;
    match (variable.kind, shown) {
        (Kind::Text(length), Shown::Text(text)) => put_text(&text, length, into),
        (Kind::Date, Shown::Date(date)) => into.extend_from_slice(&date.map_or([0; 8], |date| date.bytes())),
        (Kind::Double, Shown::Number(value)) => into.extend_from_slice(&value.to_le_bytes()),
        (Kind::Length, Shown::Number(value)) => {
            let shows_inch = view.memory.from_nck().nck.inch_measuring_system_active();
            let is_inch = match item.system {
                MeasuringSystem::Inch => true,
                MeasuringSystem::Metric => false,
                MeasuringSystem::Current => shows_inch,
            };
            let value = if is_inch && !values::is_rotary(view, line) { value / 25.4 } else { value };
            into.extend_from_slice(&value.to_le_bytes());
        }
        (Kind::DriveReal, Shown::Number(value)) => into.extend_from_slice(&drives::real(value)),
        (Kind::Word, Shown::Number(value)) => into.extend_from_slice(&whole(value).to_le_bytes()[..2]),
        (Kind::Long, Shown::Number(value)) => into.extend_from_slice(&whole(value).to_le_bytes()[..4]),
        (Kind::UnsignedLong, Shown::Number(value)) => into.extend_from_slice(&whole(value).to_le_bytes()[..4]),
        // No row of the catalogue has this combination.
        (Kind::Text(_) | Kind::Date, _) | (_, Shown::Text(_) | Shown::Date(_)) => {
            return Err(Refusal::TypeInconsistent);
        }
    }
    Ok(())
}

#[expect(clippy::cast_possible_truncation, reason = "the rows of the catalogue return integers that fit their kind")]
fn whole(value: f64) -> i64 {
    value as i64
}

/// The owner of a machine datum; a channel or an axis that does not exist has none.
fn owner(view: &View<'_>, item: &NckItem) -> Result<Place, Refusal> {
    let place = match item.area {
        0 => Some(Place::Nck),
        2 => values::channel_number(view, item.unit).map(Place::Channel),
        3 => values::axis_number(view, item.unit.into()).map(Place::Axis),
        _ => return Err(Refusal::DoesNotExist),
    };
    place.ok_or(Refusal::OutOfRange)
}

fn datum<'a>(view: &View<'a>, item: &NckItem, line: u16) -> Result<(Place, Datum<'a>), Refusal> {
    let (Some(machine_data), module::M) = (view.machine_data, item.module) else {
        return Err(Refusal::DoesNotExist);
    };
    let place = owner(view, item)?;
    let datum = machine_data.datum(place, item.column, line - 1);
    match datum {
        Some(datum) => Ok((place, datum)),
        None if machine_data.datum(place, item.column, 0).is_some() => Err(Refusal::OutOfRange),
        None => Err(Refusal::DoesNotExist),
    }
}

/// Appends the commands for writing a variable, one for each row.
///
/// # Errors
/// There is no such variable or row, it cannot be written, or a value does not fit; then nothing was appended.
pub fn write(view: &View<'_>, item: &NckItem, bytes: &[u8], into: &mut Vec<Command>) -> Result<(), Refusal> {
    let lines = lines(item)?;
    if find(view, item).is_some_and(|variable| variable.module != module::RP) {
        return Err(Refusal::NotAllowed); // a displayed value is read-only
    }
    let start = into.len();
    let size = bytes.len() / lines.len();
    let result = lines.enumerate().try_for_each(|(row, line)| {
        let bytes = bytes.get(row * size..(row + 1) * size).ok_or(Refusal::TypeInconsistent)?;
        into.push(write_row(view, item, line, bytes)?);
        Ok(())
    });
    let is_whole = bytes.len() == size * usize::from(item.count);
    let result = result.and(if is_whole { Ok(()) } else { Err(Refusal::TypeInconsistent) });
    if result.is_err() {
        into.truncate(start);
    }
    result
}

fn write_row(view: &View<'_>, item: &NckItem, line: u16, bytes: &[u8]) -> Result<Command, Refusal> {
    if find(view, item).is_some() {
        let (channel, number, _) = r_parameter(view, unit(item), line)?;
        let value = data::number(bytes).ok_or(Refusal::TypeInconsistent)?;
        return Ok(Command::RParameter { channel, number, value });
    }
    let (place, datum) = datum(view, item, line)?;
    if let Datum::Text(_) = datum {
        return Err(Refusal::NotAllowed);
    }
    let value = datum.parse(bytes).ok_or(Refusal::TypeInconsistent)?;
    let (number, index) = (item.column, line - 1);
    if let Some(machine_data) = view.machine_data {
        machine_data.may_store(place, number, index, value)?;
    }
    Ok(Command::MachineDatum { place, number, index, value })
}
