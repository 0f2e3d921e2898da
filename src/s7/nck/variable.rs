//! A variable of the NCK: its address by area, module and column, and the format of its value.

use std::borrow::Cow;

use super::View;
use crate::s7::wire::date_and_time::DateAndTime;

/// Modules by their number on the wire.
pub(super) mod module {
    /// System data.
    pub(in crate::s7::nck) const Y: u8 = 0x10;
    /// R parameters.
    pub(in crate::s7::nck) const RP: u8 = 0x15;
    /// Machine data; for drives: those of the powerline.
    pub(in crate::s7::nck) const M: u8 = 0x1A;
    /// Diagnosis.
    pub(in crate::s7::nck) const DIAGN: u8 = 0x3B;
    /// Alarms by time, oldest first.
    pub(in crate::s7::nck) const SALAC: u8 = 0x54;
    /// Geometry axes, further variables.
    pub(in crate::s7::nck) const SEGA: u8 = 0x70;
    /// Machine axes, further variables.
    pub(in crate::s7::nck) const SEMA: u8 = 0x71;
    /// Spindles.
    pub(in crate::s7::nck) const SSP: u8 = 0x72;
    /// Geometry axes.
    pub(in crate::s7::nck) const SGA: u8 = 0x73;
    /// Machine axes.
    pub(in crate::s7::nck) const SMA: u8 = 0x74;
    /// Alarms, newest first.
    pub(in crate::s7::nck) const SALAL: u8 = 0x75;
    /// Alarms, highest priority first.
    pub(in crate::s7::nck) const SALAP: u8 = 0x76;
    /// Alarms by time.
    pub(in crate::s7::nck) const SALA: u8 = 0x77;
    /// The program pointer.
    pub(in crate::s7::nck) const SPARPP: u8 = 0x7A;
    /// The program.
    pub(in crate::s7::nck) const SPARP: u8 = 0x7D;
    /// Program modification.
    pub(in crate::s7::nck) const SINF: u8 = 0x7E;
    /// States.
    pub(in crate::s7::nck) const S: u8 = 0x7F;
    /// Parameters of SINAMICS drives.
    pub(in crate::s7::nck) const DRIVE: u8 = 0x82;
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

/// The format of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A two-byte word.
    Word,
    /// A signed four-byte integer.
    Long,
    /// An unsigned four-byte integer.
    UnsignedLong,
    /// An eight-byte floating-point number.
    Double,
    /// A length of eight bytes in millimetres or degrees, converted to the unit of the item.
    Length,
    /// A four-byte floating-point number, big-endian.
    DriveReal,
    /// A `DATE_AND_TIME` of eight bytes.
    Date,
    /// A text of this many bytes.
    Text(usize),
}

/// A value before encoding.
#[derive(Clone, Debug, PartialEq)]
pub enum Shown<'a> {
    /// A number.
    Number(f64),
    /// A text.
    Text(Cow<'a, str>),
    /// A point in time; `None` is encoded as zeros.
    Date(Option<DateAndTime>),
}

/// A row of the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct Variable {
    /// Area and name as in the list of NC variables.
    pub name: &'static str,
    /// The area.
    pub area: NckArea,
    /// The block type.
    pub module: u8,
    /// Its column.
    pub column: u16,
    /// Its format.
    pub kind: Kind,
    /// The sources of its address, by the letters in the module documentation of the catalogue.
    pub source: &'static str,
    /// Its value for a unit and a line, both from one; `None` if there is no such row.
    pub(super) get: for<'a> fn(&View<'a>, u8, u16) -> Option<Shown<'a>>,
}
