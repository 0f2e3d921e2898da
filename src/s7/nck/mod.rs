//! The variables of the NCK as clients of a SINUMERIK read them: by area, unit, module, column and line.
//!
//! [`CATALOGUE`] has the variables by name, [`MachineData`] stands for the machine data behind module `1A`, and R parameters are
//! module `15`. Rows are counted from one, and an item may ask for several, which follow one another; `R5` is row 6. Values are
//! little-endian, unlike everything else on this wire, but for those of drives; texts have a fixed length and are filled with
//! zeros.
//!
//! What is written is judged whole before anything is acknowledged: machine data by type, range and whether anybody may write
//! them, R parameters by their length. What the control shows cannot be written.

mod alarms;
mod catalogue;
mod data;
mod drives;
mod values;

pub use catalogue::CATALOGUE;
pub use data::{Control, Datum, MachineData};
pub(super) use drives::read as read_drive;

use std::borrow::Cow;

use super::bridge::Command;
use super::wire::data::Refusal;
use super::wire::date_and_time::DateAndTime;
use super::wire::items::{MeasuringSystem, NckItem};
use crate::image::{Memory, Names};
use crate::units::ChannelNumber;
use crate::variables::{Place, Variables};

use data::put_text;

/// What the values are taken from.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// The memory after a step.
    pub memory: &'a Memory,
    /// The variables after a step.
    pub variables: &'a Variables,
    /// What axes and channels are called.
    pub names: &'a Names,
    /// Machine data.
    pub machine_data: Option<&'a dyn MachineData>,
    /// What else the control knows.
    pub control: Option<&'a dyn Control>,
    /// The clock.
    pub clock: DateAndTime,
    /// The serial number of the hardware.
    pub serial_number: &'a str,
}

impl std::fmt::Debug for View<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("View").finish_non_exhaustive()
    }
}

/// Modules by their number on the wire.
mod module {
    /// System data.
    pub(super) const Y: u8 = 0x10;
    /// R parameters.
    pub(super) const RP: u8 = 0x15;
    /// Machine data; of drives on the powerline.
    pub(super) const M: u8 = 0x1A;
    /// Diagnosis.
    pub(super) const DIAGN: u8 = 0x3B;
    /// Alarms by their time, as they come.
    pub(super) const SALAC: u8 = 0x54;
    /// Geometry axes, more of them.
    pub(super) const SEGA: u8 = 0x70;
    /// Machine axes, more of them.
    pub(super) const SEMA: u8 = 0x71;
    /// Spindles.
    pub(super) const SSP: u8 = 0x72;
    /// Geometry axes.
    pub(super) const SGA: u8 = 0x73;
    /// Machine axes.
    pub(super) const SMA: u8 = 0x74;
    /// Alarms, the last one first.
    pub(super) const SALAL: u8 = 0x75;
    /// Alarms, that of the highest priority first.
    pub(super) const SALAP: u8 = 0x76;
    /// Alarms by their time.
    pub(super) const SALA: u8 = 0x77;
    /// The program pointer.
    pub(super) const SPARPP: u8 = 0x7A;
    /// The program.
    pub(super) const SPARP: u8 = 0x7D;
    /// How the program is influenced.
    pub(super) const SINF: u8 = 0x7E;
    /// States.
    pub(super) const S: u8 = 0x7F;
    /// Parameters of SINAMICS drives.
    pub(super) const DRIVE: u8 = 0x82;
}

/// Areas by their number on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NckArea {
    /// N.
    Nck,
    /// B.
    ModeGroup,
    /// C.
    Channel,
    /// A.
    Axis,
    /// V.
    FeedDrive,
}

impl NckArea {
    /// Its number on the wire.
    pub(in crate::s7) const fn code(self) -> u8 {
        match self {
            Self::Nck => 0,
            Self::ModeGroup => 1,
            Self::Channel => 2,
            Self::Axis => 3,
            Self::FeedDrive => 5,
        }
    }
}

/// How a value is written down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A word of two bytes.
    Word,
    /// A whole number of four bytes.
    Long,
    /// A whole number of four bytes without a sign.
    UnsignedLong,
    /// A floating point number of eight bytes.
    Double,
    /// A length in millimetres or degrees of eight bytes, which the unit of the item changes.
    Length,
    /// A floating point number of four bytes, big-endian.
    DriveReal,
    /// A `DATE_AND_TIME` of eight bytes.
    Date,
    /// A text of so many bytes.
    Text(usize),
}

/// A value before it is written down.
#[derive(Clone, Debug, PartialEq)]
pub enum Shown<'a> {
    /// A number.
    Number(f64),
    /// A text.
    Text(Cow<'a, str>),
    /// A point in time; none is all zeros.
    Date(Option<DateAndTime>),
}

/// A row of the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct Variable {
    /// Area and name as the list of NC variables has them.
    pub name: &'static str,
    /// Whose it is.
    pub area: NckArea,
    /// The block type.
    pub module: u8,
    /// Its column.
    pub column: u16,
    /// How it is written down.
    pub kind: Kind,
    /// Who confirms its address, as the head of the catalogue names them.
    pub source: &'static str,
    /// Its value for a unit and a line, both from one; none where there is no such row.
    get: for<'a> fn(&View<'a>, u8, u16) -> Option<Shown<'a>>,
}

/// Appends the rows that an item asks for.
///
/// # Errors
/// There is no such variable, or no such row.
pub fn read(view: &View<'_>, item: &NckItem, into: &mut Vec<u8>) -> Result<(), Refusal> {
    let lines = lines(item)?;
    let start = into.len();
    let variable = find(item);
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

/// The rows from the first on; there is no row 0.
fn lines(item: &NckItem) -> Result<std::ops::Range<u16>, Refusal> {
    let end = item.line.checked_add(item.count.into()).ok_or(Refusal::OutOfRange)?;
    if item.line == 0 || item.count == 0 { Err(Refusal::OutOfRange) } else { Ok(item.line..end) }
}

/// Units count from 1; only the NCK itself, of which there is one, is 0 with some clients and 1 with others.
fn unit(item: &NckItem) -> u8 {
    if item.area == NckArea::Nck.code() { item.unit.max(1) } else { item.unit }
}

fn find(item: &NckItem) -> Option<&'static Variable> {
    // The NCK has the axes of all channels; here that is the same.
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
            let shows_inch = view.memory.from_nck.nck.inch_measuring_system_active();
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
        // No row of the catalogue is so.
        (Kind::Text(_) | Kind::Date, _) | (_, Shown::Text(_) | Shown::Date(_)) => {
            return Err(Refusal::TypeInconsistent);
        }
    }
    Ok(())
}

#[expect(clippy::cast_possible_truncation, reason = "the rows of the catalogue give whole numbers that fit their kind")]
fn whole(value: f64) -> i64 {
    value as i64
}

/// Whose machine datum an item means: a channel or an axis that is not there has none.
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

/// The R parameter of a row: its channel, its number and its value.
fn r_parameter(view: &View<'_>, unit: u8, line: u16) -> Result<(ChannelNumber, u16, f64), Refusal> {
    let control = view.control.ok_or(Refusal::DoesNotExist)?;
    let channel = values::channel_number(view, unit).ok_or(Refusal::OutOfRange)?;
    let value = control.r_parameter(channel, line - 1).ok_or(Refusal::OutOfRange)?;
    Ok((channel, line - 1, value))
}

/// Appends what writing a variable asks of the machine, a command for each row.
///
/// # Errors
/// There is no such variable or row, it cannot be written, or a value does not fit; nothing was appended then.
pub fn write(view: &View<'_>, item: &NckItem, bytes: &[u8], into: &mut Vec<Command>) -> Result<(), Refusal> {
    let lines = lines(item)?;
    if find(item).is_some_and(|variable| variable.module != module::RP) {
        return Err(Refusal::NotAllowed); // the control shows it; nobody sets it
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
    if find(item).is_some() {
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
