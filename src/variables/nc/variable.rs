//! A variable of the NCK: its address by area, module and column, and the format of its value.

use std::borrow::Cow;

use super::{ClockTime, View};

/// Modules by their number on the wire.
pub mod module {
    /// System data.
    pub const Y: u8 = 0x10;
    /// Settable zero offsets.
    pub const FU: u8 = 0x12;
    /// R parameters.
    pub const RP: u8 = 0x15;
    /// Machine data; for drives: those of the powerline.
    pub const M: u8 = 0x1A;
    /// Diagnosis.
    pub const DIAGN: u8 = 0x3B;
    /// Alarms by time, oldest first.
    pub const SALAC: u8 = 0x54;
    /// Geometry axes, further variables.
    pub const SEGA: u8 = 0x70;
    /// Machine axes, further variables.
    pub const SEMA: u8 = 0x71;
    /// Spindles.
    pub const SSP: u8 = 0x72;
    /// Geometry axes.
    pub const SGA: u8 = 0x73;
    /// Machine axes.
    pub const SMA: u8 = 0x74;
    /// Alarms, newest first.
    pub const SALAL: u8 = 0x75;
    /// Alarms, highest priority first.
    pub const SALAP: u8 = 0x76;
    /// Alarms by time.
    pub const SALA: u8 = 0x77;
    /// The program pointer.
    pub const SPARPP: u8 = 0x7A;
    /// The program.
    pub const SPARP: u8 = 0x7D;
    /// Program modification.
    pub const SINF: u8 = 0x7E;
    /// States.
    pub const S: u8 = 0x7F;
    /// Parameters of SINAMICS drives.
    pub const DRIVE: u8 = 0x82;
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
    #[must_use]
    pub const fn code(self) -> u8 {
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
    /// A point in time; `None` in a free row.
    Date(Option<ClockTime>),
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
