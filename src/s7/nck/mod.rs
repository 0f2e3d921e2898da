//! The variables of the NCK as clients of a SINUMERIK read them: by area, unit, module, column and line.
//!
//! The table is [`variables::nc`](crate::variables::nc). An item may request several consecutive rows; `R5` is row 6. Values are
//! little-endian, unlike everything else on the wire, except those of drives. Texts have a fixed length and are padded with zeros.
//!
//! A write is checked completely before it is acknowledged: machine data by type, range and write permission, R parameters by their length.
//! Displayed values of the control cannot be written.

mod drives;
mod encoding;

pub(super) use drives::read as read_drive;

use super::command::Command;
use super::wire::data::Refusal;
use super::wire::date_and_time::DateAndTime;
use super::wire::items::{MeasuringSystem, NckItem};
use crate::variables::Place;
use crate::variables::nc::{
    self, ClockTime, Datum, Kind, NckArea, Refused, Shown, Variable, View, module, r_parameter,
};

use encoding::{parse_datum, put_datum, put_text};

impl From<Refused> for Refusal {
    fn from(refused: Refused) -> Self {
        match refused {
            Refused::NotAllowed => Self::NotAllowed,
            Refused::OutOfRange => Self::OutOfRange,
            Refused::TypeInconsistent => Self::TypeInconsistent,
            Refused::DoesNotExist => Self::DoesNotExist,
        }
    }
}

/// From 1970 to 1990, in milliseconds.
const EARLIER: u64 = 7305 * 86_400_000;

/// A point in time in the form of S7, which has none before 1990.
fn date_and_time(time: ClockTime) -> DateAndTime {
    DateAndTime::FIRST.later(time.earlier(EARLIER).0)
}

/// The point in time of a date of S7.
pub(super) fn clock_time(date: DateAndTime) -> ClockTime {
    ClockTime(date.milliseconds() + EARLIER)
}

/// Appends the rows that an item requests.
///
/// # Errors
/// There is no such variable, or no such row.
pub(super) fn read(view: &View<'_>, item: &NckItem, into: &mut Vec<u8>) -> Result<(), Refusal> {
    let lines = lines(item)?;
    let start = into.len();
    let variable = find(view, item);
    for line in lines {
        let put = match variable {
            Some(variable) => put_variable(view, variable, item, line, into),
            None => datum(view, item, line).map(|(_, datum)| put_datum(datum, into)),
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

fn find(view: &View<'_>, item: &NckItem) -> Option<&'static Variable> {
    nc::find(view, item.area, item.module, item.column)
}

fn put_variable(
    view: &View<'_>,
    variable: &Variable,
    item: &NckItem,
    line: u16,
    into: &mut Vec<u8>,
) -> Result<(), Refusal> {
    let is_inch = match item.system {
        MeasuringSystem::Inch => true,
        MeasuringSystem::Metric => false,
        MeasuringSystem::Current => view.shows_inch(),
    };
    let shown = variable.value(view, unit(item), line, is_inch).ok_or(Refusal::OutOfRange)?;
    match (variable.kind, shown) {
        (Kind::Text(length), Shown::Text(text)) => put_text(&text, length, into),
        (Kind::Date, Shown::Date(date)) => {
            into.extend_from_slice(&date.map_or([0; 8], |date| date_and_time(date).bytes()));
        }
        (Kind::Double | Kind::Length, Shown::Number(value)) => into.extend_from_slice(&value.to_le_bytes()),
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

fn datum<'a>(view: &View<'a>, item: &NckItem, line: u16) -> Result<(Place, Datum<'a>), Refusal> {
    if view.machine_data.is_none() || item.module != module::M {
        return Err(Refusal::DoesNotExist);
    }
    let place = nc::owner(view, item.area, item.unit)?;
    Ok((place, nc::datum(view, place, item.column, line)?))
}

/// Appends the commands for writing a variable, one for each row.
///
/// # Errors
/// There is no such variable or row, it cannot be written, or a value does not fit; then nothing was appended.
pub(super) fn write(view: &View<'_>, item: &NckItem, bytes: &[u8], into: &mut Vec<Command>) -> Result<(), Refusal> {
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
        let value = encoding::number(bytes).ok_or(Refusal::TypeInconsistent)?;
        return Ok(Command::RParameter { channel, number, value });
    }
    let (place, datum) = datum(view, item, line)?;
    if let Datum::Text(_) = datum {
        return Err(Refusal::NotAllowed);
    }
    let value = parse_datum(datum, bytes).ok_or(Refusal::TypeInconsistent)?;
    let (number, index) = (item.column, line - 1);
    if let Some(machine_data) = view.machine_data {
        machine_data.may_store(place, number, index, value)?;
    }
    Ok(Command::MachineDatum { place, number, index, value })
}
