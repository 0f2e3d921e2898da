//! A variable of the NCK: its address by area, module and column, and how its value is written down.

use std::borrow::Cow;

use super::View;
use crate::s7::wire::date_and_time::DateAndTime;

/// Modules by their number on the wire.
pub(super) mod module {
    /// System data.
    pub(in crate::s7::nck) const Y: u8 = 0x10;
    /// R parameters.
    pub(in crate::s7::nck) const RP: u8 = 0x15;
    /// Machine data; of drives on the powerline.
    pub(in crate::s7::nck) const M: u8 = 0x1A;
    /// Diagnosis.
    pub(in crate::s7::nck) const DIAGN: u8 = 0x3B;
    /// Alarms by their time, as they come.
    pub(in crate::s7::nck) const SALAC: u8 = 0x54;
    /// Geometry axes, more of them.
    pub(in crate::s7::nck) const SEGA: u8 = 0x70;
    /// Machine axes, more of them.
    pub(in crate::s7::nck) const SEMA: u8 = 0x71;
    /// Spindles.
    pub(in crate::s7::nck) const SSP: u8 = 0x72;
    /// Geometry axes.
    pub(in crate::s7::nck) const SGA: u8 = 0x73;
    /// Machine axes.
    pub(in crate::s7::nck) const SMA: u8 = 0x74;
    /// Alarms, the last one first.
    pub(in crate::s7::nck) const SALAL: u8 = 0x75;
    /// Alarms, that of the highest priority first.
    pub(in crate::s7::nck) const SALAP: u8 = 0x76;
    /// Alarms by their time.
    pub(in crate::s7::nck) const SALA: u8 = 0x77;
    /// The program pointer.
    pub(in crate::s7::nck) const SPARPP: u8 = 0x7A;
    /// The program.
    pub(in crate::s7::nck) const SPARP: u8 = 0x7D;
    /// How the program is influenced.
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
    pub(super) get: for<'a> fn(&View<'a>, u8, u16) -> Option<Shown<'a>>,
}
