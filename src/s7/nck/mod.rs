//! The variables of the NCK as clients of a SINUMERIK read them: by area, unit, module, column and line.
//!
//! [`CATALOGUE`] has the variables by name, [`MachineData`] stands for the machine data behind module `1A`. Values are
//! little-endian, unlike everything else on this wire; texts have a fixed length and are filled with zeros. Rows are counted from
//! one, and an item may ask for several, which follow one another.

mod catalogue;

pub use catalogue::CATALOGUE;

use super::bridge::Command;
use super::wire::data::Refusal;
use super::wire::items::{MeasuringSystem, NckItem};
use crate::image::{Memory, Names};
use crate::units::{AxisNumber, ChannelNumber};
use crate::variables::{Place, Variables};

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
}

impl std::fmt::Debug for View<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("View").finish_non_exhaustive()
    }
}

/// Machine data, as the control keeps them.
pub trait MachineData {
    /// A machine datum by number, and by index from 0 where it is an array.
    fn datum(&self, place: Place, number: u16, index: u16) -> Option<Datum<'_>>;
}

/// The value of a machine datum; each kind has its length on the wire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Datum<'a> {
    /// BOOLEAN: one byte.
    Boolean(bool),
    /// BYTE: one byte.
    Byte(u8),
    /// DWORD: four bytes.
    Whole(i32),
    /// DOUBLE: eight bytes.
    Number(f64),
    /// STRING: 32 bytes.
    Text(&'a str),
}

impl Datum<'_> {
    fn put(self, into: &mut Vec<u8>) {
        match self {
            Self::Boolean(value) => into.push(value.into()),
            Self::Byte(value) => into.push(value),
            Self::Whole(value) => into.extend_from_slice(&value.to_le_bytes()),
            Self::Number(value) => into.extend_from_slice(&value.to_le_bytes()),
            Self::Text(text) => put_text(text, TEXT, into),
        }
    }

    /// The value that bytes of the same kind stand for; texts cannot be written.
    fn parse(self, bytes: &[u8]) -> Option<f64> {
        match (self, bytes) {
            (Self::Boolean(_), [value @ (0 | 1)]) | (Self::Byte(_), [value]) => Some((*value).into()),
            (Self::Whole(_), _) => Some(i32::from_le_bytes(bytes.try_into().ok()?).into()),
            (Self::Number(_), _) => {
                let value = f64::from_le_bytes(bytes.try_into().ok()?);
                value.is_finite().then_some(value)
            }
            (Self::Boolean(_) | Self::Byte(_) | Self::Text(_), _) => None,
        }
    }
}

/// Length of a text of the machine data.
const TEXT: usize = 32;

fn put_text(text: &str, length: usize, into: &mut Vec<u8>) {
    let end = into.len() + length;
    // The last byte stays 0, so that whoever looks for an end finds one.
    into.extend(text.bytes().take(length.saturating_sub(1)));
    into.resize(end, 0);
}

/// Modules by their number on the wire.
pub(crate) mod module {
    /// System data.
    pub(crate) const Y: u8 = 0x10;
    /// Machine data.
    pub(crate) const M: u8 = 0x1A;
    /// Alarms by their time.
    pub(crate) const SALAC: u8 = 0x54;
    /// Geometry axes, more of them.
    pub(crate) const SEGA: u8 = 0x70;
    /// Machine axes, more of them.
    pub(crate) const SEMA: u8 = 0x71;
    /// Geometry axes.
    pub(crate) const SGA: u8 = 0x73;
    /// Machine axes.
    pub(crate) const SMA: u8 = 0x74;
    /// The last alarm.
    pub(crate) const SALAL: u8 = 0x75;
    /// The alarm of the highest priority.
    pub(crate) const SALAP: u8 = 0x76;
    /// List of alarms.
    pub(crate) const SALA: u8 = 0x77;
    /// The program pointer.
    pub(crate) const SPARPP: u8 = 0x7A;
    /// The program.
    pub(crate) const SPARP: u8 = 0x7D;
    /// How the program is influenced.
    pub(crate) const SINF: u8 = 0x7E;
    /// States.
    pub(crate) const S: u8 = 0x7F;
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
}

impl NckArea {
    const fn code(self) -> u8 {
        match self {
            Self::Nck => 0,
            Self::ModeGroup => 1,
            Self::Channel => 2,
            Self::Axis => 3,
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
    /// A floating point number of eight bytes.
    Double,
    /// A length in millimetres or degrees of eight bytes, which the unit of the item changes.
    Length,
    /// A text of so many bytes.
    Text(usize),
}

/// A value before it is written down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shown<'a> {
    /// A number.
    Number(f64),
    /// A text.
    Text(&'a str),
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
            None => put_datum(view, item, line, into),
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

fn find(item: &NckItem) -> Option<&'static Variable> {
    let is_it = |variable: &&Variable| {
        variable.area.code() == item.area && variable.module == item.module && variable.column == item.column
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
    let unit = item.unit.max(1); // the NCK itself is 0 with some clients and 1 with others
    let shown = (variable.get)(view, unit, line).ok_or(Refusal::OutOfRange)?;
    match (variable.kind, shown) {
        (Kind::Text(length), Shown::Text(text)) => put_text(text, length, into),
        (Kind::Double, Shown::Number(value)) => into.extend_from_slice(&value.to_le_bytes()),
        (Kind::Length, Shown::Number(value)) => {
            let shows_inch = view.memory.from_nck.nck.inch_measuring_system_active();
            let is_inch = match item.system {
                MeasuringSystem::Inch => true,
                MeasuringSystem::Metric => false,
                MeasuringSystem::Current => shows_inch,
            };
            let value = if is_inch && !is_rotary(view, line) { value / 25.4 } else { value };
            into.extend_from_slice(&value.to_le_bytes());
        }
        (Kind::Word, Shown::Number(value)) => into.extend_from_slice(&whole(value).to_le_bytes()[..2]),
        (Kind::Long, Shown::Number(value)) => into.extend_from_slice(&whole(value).to_le_bytes()),
        (Kind::Text(_), Shown::Number(_)) | (_, Shown::Text(_)) => return Err(Refusal::TypeInconsistent),
    }
    Ok(())
}

#[expect(clippy::cast_possible_truncation, reason = "the catalogue gives whole numbers that fit; others are clamped")]
fn whole(value: f64) -> i32 {
    value as i32
}

/// Whether the axis of a row turns (MD30300): degrees have no inches.
fn is_rotary(view: &View<'_>, line: u16) -> bool {
    let axis = u8::try_from(line).ok().and_then(AxisNumber::new);
    let datum = axis.zip(view.machine_data).and_then(|(axis, data)| data.datum(Place::Axis(axis), 30300, 0));
    datum == Some(Datum::Boolean(true))
}

/// Whose machine datum an item means.
fn owner(item: &NckItem) -> Option<Place> {
    match item.area {
        0 => Some(Place::Nck),
        2 => ChannelNumber::new(item.unit).map(Place::Channel),
        3 => AxisNumber::new(item.unit).map(Place::Axis),
        _ => None,
    }
}

fn datum<'a>(view: &View<'a>, item: &NckItem, line: u16) -> Result<(Place, Datum<'a>), Refusal> {
    let (Some(place), Some(machine_data), module::M) = (owner(item), view.machine_data, item.module) else {
        return Err(Refusal::DoesNotExist);
    };
    let datum = machine_data.datum(place, item.column, line - 1);
    match datum {
        Some(datum) => Ok((place, datum)),
        None if machine_data.datum(place, item.column, 0).is_some() => Err(Refusal::OutOfRange),
        None => Err(Refusal::DoesNotExist),
    }
}

fn put_datum(view: &View<'_>, item: &NckItem, line: u16, into: &mut Vec<u8>) -> Result<(), Refusal> {
    datum(view, item, line).map(|(_, datum)| datum.put(into))
}

/// What writing a variable asks of the machine.
///
/// # Errors
/// There is no such variable or row, it cannot be written, or the length does not fit.
pub fn may_write(view: &View<'_>, item: &NckItem, bytes: &[u8]) -> Result<Command, Refusal> {
    let mut lines = lines(item)?;
    if find(item).is_some() {
        return Err(Refusal::NotAllowed); // the control shows it; nobody sets it
    }
    let (Some(line), None) = (lines.next(), lines.next()) else {
        return Err(Refusal::TypeInconsistent); // one row at a time
    };
    let (place, datum) = datum(view, item, line)?;
    if let Datum::Text(_) = datum {
        return Err(Refusal::NotAllowed);
    }
    let value = datum.parse(bytes).ok_or(Refusal::TypeInconsistent)?;
    Ok(Command::MachineDatum { place, number: item.column, index: line - 1, value })
}

/// The command of a write that was checked.
pub(super) fn write(view: &View<'_>, item: &NckItem, bytes: &[u8]) -> Option<Command> {
    may_write(view, item, bytes).ok()
}
