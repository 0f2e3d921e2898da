//! NC variables by their name in the server's catalogue, or by number if they are not in it.
//!
//! | text | meaning |
//! |---|---|
//! | `C/MachineAxis/actToolBasePos[2]` | a name of the catalogue, row 2; default row 1 |
//! | `C/SMA/actToolBasePos[1..3]` | the same variable by its module, three rows |
//! | `C2/State/chanStatus` | a variable of channel 2; default unit 1 |
//! | `A1/M/32000:DOUBLE` | column 32000 of module M of axis 1, and its type |
//! | `C/Parameter/rpa[6]` | R5: the first row is 1 |
//! | `C/RP/1[5]` | without a type, the raw bytes |
//! | `V/16#80/30:REAL` | a module by its number |
//!
//! Types: `BYTE`, `WORD`, `LONG`, `ULONG`, `REAL`, `DOUBLE`, `DATE`, `TEXT32` and other lengths. Values of drives (areas V and H) are
//! big-endian, all others are little-endian.

use std::fmt;
use std::str::FromStr;

use super::Error;
use crate::s7::wire::items::{MeasuringSystem, NckItem};
use crate::variables::nc::{CATALOGUE, Kind, Variable as Row};

/// Rows of a variable of the NCK.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NcVariable {
    /// The item on the wire.
    pub item: NckItem,
    /// The type of a row; `None` if it is unknown: then the row is read as bytes.
    pub kind: Option<NcKind>,
}

/// The type of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NcKind {
    /// One byte.
    Byte,
    /// A two-byte word.
    Word,
    /// A signed four-byte integer.
    Long,
    /// An unsigned four-byte integer.
    UnsignedLong,
    /// A four-byte floating-point number.
    Real,
    /// An eight-byte floating-point number.
    Double,
    /// A point in time of eight bytes (`DATE_AND_TIME`); all zeros if there is none.
    Date,
    /// A text of this many bytes, padded with zeros.
    Text(usize),
}

impl NcKind {
    /// Bytes of a row.
    #[must_use]
    pub const fn bytes(self) -> usize {
        match self {
            Self::Byte => 1,
            Self::Word => 2,
            Self::Long | Self::UnsignedLong | Self::Real => 4,
            Self::Double | Self::Date => 8,
            Self::Text(length) => length,
        }
    }

    /// The types of this length as users write them: `DOUBLE, DATE, TEXT8`.
    pub(super) fn of_length(bytes: usize) -> String {
        let types = [
            ("BYTE", Self::Byte),
            ("WORD", Self::Word),
            ("LONG", Self::Long),
            ("ULONG", Self::UnsignedLong),
            ("REAL", Self::Real),
            ("DOUBLE", Self::Double),
            ("DATE", Self::Date),
        ];
        let fitting = types.into_iter().filter(|(_, kind)| kind.bytes() == bytes).map(|(name, _)| name.to_owned());
        fitting.chain([format!("TEXT{bytes}")]).collect::<Vec<_>>().join(", ")
    }

    /// The type in the server's catalogue.
    #[must_use]
    pub const fn of(kind: Kind) -> Self {
        match kind {
            Kind::Word => Self::Word,
            Kind::Long => Self::Long,
            Kind::UnsignedLong => Self::UnsignedLong,
            Kind::Double | Kind::Length => Self::Double,
            // It is big-endian because its area is.
            Kind::DriveReal => Self::Real,
            Kind::Date => Self::Date,
            Kind::Text(length) => Self::Text(length),
        }
    }
}

/// The letters of the areas; the position is the area number. The simulator has the first three and A.
const AREAS: &[u8; 8] = b"NBCATVHM";

/// Modules by their names in Siemens' lists.
const MODULES: &[(&str, u8)] = &[
    ("Y", 0x10),
    ("FU", 0x12),
    ("FA", 0x13),
    ("TO", 0x14),
    ("RP", 0x15),
    ("SE", 0x16),
    ("M", 0x1A),
    ("FE", 0x20),
    ("TD", 0x21),
    ("TS", 0x22),
    ("TV", 0x26),
    ("DIAGN", 0x3B),
    ("FB", 0x41),
    ("SALAC", 0x54),
    ("AUXFU", 0x55),
    ("SPARPI", 0x6F),
    ("SEGA", 0x70),
    ("SEMA", 0x71),
    ("SSP", 0x72),
    ("SGA", 0x73),
    ("SMA", 0x74),
    ("SALAL", 0x75),
    ("SALAP", 0x76),
    ("SALA", 0x77),
    ("SSYNAC", 0x78),
    ("SPARPF", 0x79),
    ("SPARPP", 0x7A),
    ("SNCF", 0x7B),
    ("SPARP", 0x7D),
    ("SINF", 0x7E),
    ("S", 0x7F),
    ("DRIVE", 0x82),
];

impl NcVariable {
    /// A row of the catalogue, with unit 1 and line 1.
    #[must_use]
    pub fn of(row: &Row) -> Self {
        let item = NckItem {
            system: MeasuringSystem::Current,
            area: row.area.code(),
            unit: 1,
            column: row.column,
            line: 1,
            module: row.module,
            count: 1,
        };
        Self { item, kind: Some(NcKind::of(row.kind)) }
    }

    /// These rows of the variable.
    #[must_use]
    pub fn rows(self, first: u16, count: u8) -> Self {
        Self { item: NckItem { line: first, count, ..self.item }, ..self }
    }

    /// The variable of this channel, mode group or axis.
    #[must_use]
    pub fn unit(self, unit: u8) -> Self {
        Self { item: NckItem { unit, ..self.item }, ..self }
    }

    /// Whether its numbers are big-endian: those of drives.
    pub(super) fn is_big_endian(&self) -> bool {
        matches!(self.item.area, 5 | 6)
    }
}

fn wrong(text: &str, what: &str, cure: impl Into<String>) -> Error {
    Error::Input { what: format!("expected {what}, found `{text}`"), cure: cure.into() }
}

impl FromStr for NcVariable {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let (name, rows) = match text.strip_suffix(']').and_then(|text| text.split_once('[')) {
            Some((name, rows)) => (name, rows),
            None => (text, "1"),
        };
        let rows = match rows.split_once("..") {
            None => rows.parse().ok().map(|first: u16| (first, 1)),
            Some((first, last)) => first.parse().ok().zip(last.parse::<u16>().ok()).and_then(|(first, last)| {
                let count = last.checked_sub(first)?.checked_add(1)?;
                Some((first, u8::try_from(count).ok()?))
            }),
        };
        let Some((first, count)) = rows.filter(|(first, _)| *first > 0) else {
            return Err(wrong(text, "one row or up to 255, counted from 1", "write [2] or [1..3]"));
        };
        let shape = || wrong(text, "area, module and variable", "write C/MachineAxis/actToolBasePos[1]");
        let (owner, path) = name.split_once('/').ok_or_else(shape)?;
        let (letter, unit) = owner.split_at_checked(1).ok_or_else(shape)?;
        let area = AREAS.iter().position(|known| letter.as_bytes() == [*known]);
        let area = area.and_then(|area| u8::try_from(area).ok());
        let unit = if unit.is_empty() { Some(1) } else { unit.parse().ok().filter(|unit| (1..=31).contains(unit)) };
        let (Some(area), Some(unit)) = (area, unit) else {
            return Err(wrong(text, "an area N, B, C, A, T, V, H or M with a number from 1 to 31", "write C2/State/…"));
        };
        let by_number = path.split_once('/').filter(|(_, column)| column.starts_with(|c: char| c.is_ascii_digit()));
        let variable = match by_number {
            Some((module, column)) => numbered(area, module, column, text)?,
            None => named(area, path, text)?,
        };
        Ok(variable.unit(unit).rows(first, count))
    }
}

/// Parses `M/32000:DOUBLE`.
fn numbered(area: u8, module: &str, column: &str, text: &str) -> Result<NcVariable, Error> {
    let (column, kind) = column.split_once(':').map_or((column, None), |(column, kind)| (column, Some(kind)));
    let code = match module.strip_prefix("16#") {
        Some(number) => u8::from_str_radix(number, 16).ok(),
        None => MODULES.iter().find(|(name, _)| *name == module).map(|(_, code)| *code),
    };
    let module = code.ok_or_else(|| {
        let names: Vec<_> = MODULES.iter().map(|(name, _)| *name).collect();
        wrong(
            text,
            "a module with its column",
            format!("write C/RP/1, or 16#15 for RP; known modules: {}", names.join(" ")),
        )
    })?;
    let column = column.parse();
    let column = column.map_err(|_| wrong(text, "a column from 0 to 65535", "for machine data it is their number"))?;
    let kind = kind.map(|kind| {
        of_type(kind).ok_or_else(|| {
            let types = "BYTE, WORD, LONG, ULONG, REAL, DOUBLE, DATE, or TEXT32 for texts of 1 to 200 bytes";
            wrong(text, "a type after the column", types)
        })
    });
    let item = NckItem { system: MeasuringSystem::Current, area, unit: 1, column, line: 1, module, count: 1 };
    Ok(NcVariable { item, kind: kind.transpose()? })
}

/// Parses `DOUBLE`.
fn of_type(text: &str) -> Option<NcKind> {
    Some(match text {
        "BYTE" | "BOOL" => NcKind::Byte,
        "WORD" => NcKind::Word,
        "LONG" => NcKind::Long,
        "ULONG" => NcKind::UnsignedLong,
        "DATE" => NcKind::Date,
        "REAL" => NcKind::Real,
        "DOUBLE" => NcKind::Double,
        text => {
            let length = text.strip_prefix("TEXT")?.parse().ok();
            NcKind::Text(length.filter(|length| (1..=200).contains(length))?)
        }
    })
}

/// Parses `MachineAxis/actToolBasePos` or `SMA/actToolBasePos`.
fn named(area: u8, path: &str, text: &str) -> Result<NcVariable, Error> {
    let in_area = || CATALOGUE.iter().filter(|row| row.area.code() == area);
    let tail = |row: &Row| row.name.split_once('/').map_or("", |(_, tail)| tail);
    let by_module = path.split_once('/').and_then(|(module, name)| {
        let (_, module) = MODULES.iter().find(|(known, _)| *known == module)?;
        in_area().find(|row| row.module == *module && row.name.rsplit('/').next() == Some(name))
    });
    if let Some(row) = in_area().find(|row| tail(row) == path).or(by_module) {
        return Ok(NcVariable::of(row));
    }
    let last = |name: &str| name.rsplit('/').next().unwrap_or_default().to_ascii_lowercase();
    let distance = |row: &&Row| strsim::damerau_levenshtein(&last(row.name), &last(path));
    let near = CATALOGUE.iter().min_by_key(distance).filter(|row| distance(row) <= 3);
    let cure = near.map_or_else(
        || "`opennck s7 nck` lists them; address others by number: C/SMA/2:DOUBLE[1]".to_owned(),
        |row| format!("did you mean `{}`?", row.name),
    );
    Err(wrong(text, "an NC variable of the catalogue", cure))
}

impl fmt::Display for NcVariable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let NckItem { area, unit, column, line, module, count, .. } = self.item;
        let letter = AREAS.get(usize::from(area)).map_or('?', |letter| char::from(*letter));
        let unit = if unit == 1 { String::new() } else { unit.to_string() };
        let row = CATALOGUE.iter().find(|row| {
            (row.area.code(), row.module, row.column) == (area, module, column)
                && self.kind == Some(NcKind::of(row.kind))
        });
        match row.and_then(|row| row.name.split_once('/')) {
            Some((_, path)) => write!(f, "{letter}{unit}/{path}")?,
            None => {
                let known = MODULES.iter().find(|(_, code)| *code == module);
                let module = known.map_or_else(|| format!("16#{module:02X}"), |(name, _)| (*name).to_owned());
                write!(f, "{letter}{unit}/{module}/{column}")?;
                match self.kind {
                    None => {}
                    Some(NcKind::Byte) => f.write_str(":BYTE")?,
                    Some(NcKind::Word) => f.write_str(":WORD")?,
                    Some(NcKind::Long) => f.write_str(":LONG")?,
                    Some(NcKind::UnsignedLong) => f.write_str(":ULONG")?,
                    Some(NcKind::Date) => f.write_str(":DATE")?,
                    Some(NcKind::Real) => f.write_str(":REAL")?,
                    Some(NcKind::Double) => f.write_str(":DOUBLE")?,
                    Some(NcKind::Text(length)) => write!(f, ":TEXT{length}")?,
                }
            }
        }
        match (line, count) {
            (1, 1) => Ok(()),
            (line, 1) => write!(f, "[{line}]"),
            (line, count) => write!(f, "[{line}..{}]", line.saturating_add(u16::from(count).saturating_sub(1))),
        }
    }
}
