//! Variables that a client reads and writes: memory of any PLC by address, and variables of the NCK by name.
//!
//! | text | meaning |
//! |---|---|
//! | `DB31.DBX101.4` `M10.3` `IB0` `QW4` `DB31.DBD78:REAL` `T5` `C3` | one element, in the notation of this project |
//! | `DB10.DBX100.0..4` | adjacent bits of one byte |
//! | `DB31.DBB0..10` `DB21.DBW4..8:INT` `T0..7` | elements; the range ends with the byte (or number) of the last element |
//! | `nck:C/MachineAxis/actToolBasePos[2]` | an NC variable; see [`NcVariable`] |
//!
//! All block and byte numbers are allowed, because the host may be any PLC. Without a suffix a number is unsigned.

use std::fmt;
use std::str::FromStr;

use super::Error;
use super::nc::{NcKind, NcVariable};
use crate::image::{Address, Area, Format, Width};
use crate::s7::wire::data::Type;
use crate::s7::wire::items::AnyItem;

/// A variable to read or write.
#[derive(Clone, Debug, PartialEq)]
pub enum Variable {
    /// Memory of the PLC.
    Memory(Memory),
    /// A variable of the NCK.
    Nc(NcVariable),
}

/// Consecutive elements in the memory of a PLC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// The area.
    pub area: Area,
    /// The first byte; the number of a timer or counter.
    pub byte: u32,
    /// The size of each element; timers and counters are words.
    pub width: Width,
    /// The number format.
    pub format: Format,
    /// The number of elements.
    pub count: u32,
}

impl Memory {
    /// One element. Without a suffix in the address its number is unsigned.
    #[must_use]
    pub fn of(address: &Address) -> Self {
        let &Address { area, byte, width, format } = address;
        Self { area, byte: byte.into(), width, format: format.unwrap_or(Format::Unsigned), count: 1 }
    }

    /// Bytes of an area.
    #[must_use]
    pub const fn bytes(area: Area, byte: u32, count: u32) -> Self {
        Self { area, byte, width: Width::Byte, format: Format::Unsigned, count }
    }

    /// Bytes of one element.
    #[must_use]
    pub const fn element(&self) -> usize {
        match self.width {
            Width::Bit(_) | Width::Bits { .. } | Width::Byte => 1,
            Width::Word => 2,
            Width::Double => 4,
        }
    }

    /// Bytes of all elements.
    #[must_use]
    pub const fn length(&self) -> usize {
        self.element() * self.count as usize
    }

    /// The wire item for some of its bytes. All types except bits, timers and counters are requested as bytes, which every server supports;
    /// some servers count the elements of words and double words wrongly.
    pub(super) fn item(&self, offset: usize, length: usize) -> AnyItem {
        let small = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
        let count = |number: usize| u16::try_from(number).unwrap_or(u16::MAX);
        let at = match self.area {
            Area::Timers | Area::Counters => self.byte.saturating_mul(2),
            Area::DataBlock(_) | Area::Inputs | Area::Outputs | Area::Flags => self.byte,
        };
        let byte = at.saturating_add(small(offset));
        let (kind, count, bit) = match (self.area, self.width) {
            (Area::Timers, _) => (Type::Timer, count(length / 2), 0),
            (Area::Counters, _) => (Type::Counter, count(length / 2), 0),
            (_, Width::Bit(bit)) => (Type::Bit, 1, bit),
            (_, Width::Bits { .. } | Width::Byte | Width::Word | Width::Double) => (Type::Byte, count(length), 0),
        };
        AnyItem { kind, count, area: self.area, byte, bit }
    }

    /// The first address after the last element, as counted on the wire.
    fn end(&self) -> u64 {
        let step = if matches!(self.area, Area::Timers | Area::Counters) { 1 } else { self.element() as u64 };
        u64::from(self.byte) + u64::from(self.count) * step
    }
}

/// The address space of the protocol: three bytes, including three bits for the bit number.
const ADDRESSES: u64 = 1 << 21;

impl Variable {
    /// Refuses an invalid variable before anything is sent.
    pub(super) fn check(&self) -> Result<(), Error> {
        let wrong =
            |what: &str, cure: &str| Err(Error::Input { what: format!("{what}, found {self}"), cure: cure.into() });
        match self {
            Self::Memory(memory) if memory.count == 0 => wrong("expected at least one element", "request one element"),
            Self::Memory(memory) if memory.end() > ADDRESSES => {
                wrong("expected an address within the range of the protocol", "the last byte is 2097151")
            }
            Self::Memory(Memory { width: Width::Bit(_) | Width::Bits { .. }, count, .. }) if *count > 1 => {
                wrong("expected one element for an address of bits", "read bytes (DBB)")
            }
            Self::Memory(_) => Ok(()),
            Self::Nc(variable) if variable.item.count == 0 || variable.item.line == 0 => {
                wrong("expected rows from 1 on", "the first row is 1")
            }
            Self::Nc(_) => Ok(()),
        }
    }

    /// The error of a value with `found` bytes where `expected` were asked for. The type of an NC variable is the user's word where it is
    /// written behind the column; then it is wrong, and not the server.
    pub(super) fn another_length(&self, expected: usize, found: usize) -> Error {
        let what = self.to_string();
        let rows = match self {
            Self::Nc(NcVariable { kind: Some(kind), item }) => {
                Some(usize::from(item.count)).filter(|rows| kind.bytes() * rows == expected)
            }
            Self::Nc(_) | Self::Memory(_) => None,
        };
        match rows {
            Some(rows) if what.trim_start_matches("nck:").contains(':') && found.is_multiple_of(rows) => {
                let (expected, found) = (expected / rows, found / rows);
                let fitting = NcKind::of_length(found);
                Error::Input {
                    what: format!("{what}: the type has {expected} bytes, the value has {found}"),
                    cure: format!("write a type of {found} bytes ({fitting}), or omit the type to see the bytes"),
                }
            }
            Some(_) | None => Error::Unexpected { what, found: format!("{found} bytes instead of {expected}") },
        }
    }
}

impl FromStr for Variable {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        if text.starts_with("nck:") || text.contains('/') {
            return text.strip_prefix("nck:").unwrap_or(text).parse().map(Self::Nc);
        }
        let (address, last) = match range(text) {
            Some((first, last)) => (first, Some(last)),
            None => (text.to_owned(), None),
        };
        let address: Address = address.parse().map_err(|problem: <Address as FromStr>::Err| Error::Input {
            what: if problem.what.contains(text) { problem.what } else { format!("{} in `{text}`", problem.what) },
            cure: problem.cure + "\n  a range: DB31.DBB0..10; an NC variable: nck:C/MachineAxis/actToolBasePos[1]",
        })?;
        let mut memory = Memory::of(&address);
        if let Some(last) = last {
            let step = if matches!(memory.area, Area::Timers | Area::Counters) { 1 } else { memory.element() };
            let step = u32::try_from(step).unwrap_or(1);
            match last.checked_sub(memory.byte) {
                Some(distance) if distance % step == 0 => {
                    memory.count = (distance / step).saturating_add(1);
                }
                _ => {
                    return Err(Error::Input {
                        what: format!("expected the byte of the last element after `..`, found `{text}`"),
                        cure: format!(
                            "use the first byte, {}, or a multiple of the element size after it",
                            memory.byte
                        ),
                    });
                }
            }
        }
        let variable = Self::Memory(memory);
        variable.check()?;
        Ok(variable)
    }
}

/// The first address with its suffix, and the number after `..`. Bits of one byte (`DBX100.0..4`) are not a range.
fn range(text: &str) -> Option<(String, u32)> {
    let (plain, suffix) = text.find(':').map_or((text, ""), |at| text.split_at(at));
    let (first, last) = plain.split_once("..")?;
    let is_bit = first.rsplit('.').next()?.bytes().all(|digit| digit.is_ascii_digit());
    let last = last.parse().ok()?;
    (!is_bit).then(|| (format!("{first}{suffix}"), last))
}

impl From<Memory> for Variable {
    fn from(memory: Memory) -> Self {
        Self::Memory(memory)
    }
}

impl From<NcVariable> for Variable {
    fn from(variable: NcVariable) -> Self {
        Self::Nc(variable)
    }
}

impl fmt::Display for Variable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Memory(memory) => memory.fmt(f),
            Self::Nc(variable) => write!(f, "nck:{variable}"),
        }
    }
}

impl fmt::Display for Memory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { area, byte, width, format, count } = *self;
        let is_counted = matches!(area, Area::Timers | Area::Counters);
        let dot = if matches!(area, Area::DataBlock(_)) { ".DB" } else { "" };
        let letter = match width {
            _ if is_counted => "",
            Width::Bit(_) | Width::Bits { .. } if dot.is_empty() => "",
            Width::Bit(_) | Width::Bits { .. } => "X",
            Width::Byte => "B",
            Width::Word => "W",
            Width::Double => "D",
        };
        write!(f, "{area}{dot}{letter}{byte}")?;
        match width {
            Width::Bit(bit) => write!(f, ".{bit}")?,
            Width::Bits { first, last } => write!(f, ".{first}..{last}")?,
            Width::Byte | Width::Word | Width::Double if count > 1 => {
                let step = if is_counted { 1 } else { self.element() as u64 };
                write!(f, "..{}", u64::from(byte) + (u64::from(count) - 1) * step)?;
            }
            Width::Byte | Width::Word | Width::Double => {}
        }
        f.write_str(match (format, width) {
            (Format::Real, _) => ":REAL",
            (Format::Signed, Width::Double) => ":DINT",
            (Format::Signed, _) => ":INT",
            (Format::Unsigned, _) => "",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_read_and_written_alike() {
        for text in [
            "DB31.DBX101.4",
            "DB10.DBX100.0..4",
            "DB31.DBB0..10",
            "DB21.DBW4..8:INT",
            "DB31.DBD78:REAL",
            "DB65535.DBD65535:DINT",
            "M10.3",
            "MB0..99",
            "IB0",
            "QW4",
            "T0..7",
            "C3",
            "nck:C/MachineAxis/actToolBasePos[2]",
            "nck:N/State/numAlarms",
            "nck:C2/State/chanStatus",
            "nck:A2/M/32000:DOUBLE",
            "nck:V/16#80/30:REAL[2]",
            "nck:V/DRIVE/30:REAL",
            "nck:C/RP/1[5..9]",
            "nck:V/M/1717:REAL",
        ] {
            let variable: Variable = text.parse().unwrap();
            assert_eq!(variable.to_string(), text);
        }
    }

    #[test]
    fn ranges_have_whole_elements() {
        let length = |text: &str| match text.parse().unwrap() {
            Variable::Memory(memory) => (memory.count, memory.length()),
            Variable::Nc(_) => (0, 0),
        };
        assert_eq!(length("DB31.DBB0..10"), (11, 11));
        assert_eq!(length("DB21.DBW4..8"), (3, 6));
        assert_eq!(length("T0..7"), (8, 16));
        for wrong in ["DB21.DBW4..7", "DB21.DBB4..3", "DB21.DBB4..", "DB21.DBB..4", "X.y", "DB", "", "MB0..4294967290"]
        {
            let error = wrong.parse::<Variable>().unwrap_err();
            assert!(matches!(&error, Error::Input { what, .. } if what.contains(wrong)), "{wrong}: {error:?}");
        }
    }

    #[test]
    fn a_misspelt_variable_gets_the_nearest_name() {
        let error = "nck:C/MachineAxis/actToolBasPos".parse::<Variable>().unwrap_err();
        assert_eq!(error.cure(), "did you mean `C/MachineAxis/actToolBasePos`?");
        for wrong in [
            "nck:C",
            "nck:X/State/opMode",
            "nck:C/SMA/2:FLOAT",
            "C99/State/chanStatus",
            "C/SMA/2[0]",
            "C/SMA/2[1..300]",
        ] {
            assert!(wrong.parse::<Variable>().is_err(), "{wrong}");
        }
    }

    /// C1 = 41, N = 01, B1 = 21, A1 = 61 of the address lists.
    #[test]
    fn nc_variables_have_the_bytes_of_the_address_lists() {
        let bytes = |text: &str| match text.parse().unwrap() {
            Variable::Nc(variable) => variable.item.bytes(),
            Variable::Memory(_) => [0; 10],
        };
        assert_eq!(bytes("C/SMA/actToolBasePos[2]"), [0x12, 8, 0x82, 0x41, 0, 2, 0, 2, 0x74, 1]);
        assert_eq!(bytes("N/SALAC/1:LONG"), [0x12, 8, 0x82, 1, 0, 1, 0, 1, 0x54, 1]);
        assert_eq!(bytes("B/State/opMode"), [0x12, 8, 0x82, 0x21, 0, 3, 0, 1, 0x7F, 1]);
        assert_eq!(bytes("A1/M/32000"), [0x12, 8, 0x82, 0x61, 0x7D, 0, 0, 1, 0x1A, 1]);
    }
}
