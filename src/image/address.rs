//! STEP 7 absolute addresses: `DB31.DBX101.5`, `DB31.DBB101`, `DB21.DBW4`, `DB31.DBD78`, `M10.3`, `IB0`, `QW4`, `T5`, `C3`, with `:INT`,
//! `:DINT` or `:REAL` after words and double words. The four-digit bytes of the 828D (`DBX0001.2`) are the same addresses. STEP 7 has no
//! notation for a group of bits; this project writes `DB10.DBX100.0..4`.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::{Format, Part};
use crate::source::Problem;

/// The area in which an address begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Area {
    /// A data block, `DB31`.
    DataBlock(u16),
    /// Inputs, `I`.
    Inputs,
    /// Outputs, `Q`.
    Outputs,
    /// Flags, `M`.
    Flags,
    /// Timers, `T`.
    Timers,
    /// Counters, `C`.
    Counters,
}

impl Area {
    /// The area with this letter: `I`, `Q`, `M`, `T` or `C`.
    pub(super) fn of_letter(letter: &str) -> Option<Self> {
        let areas = [Self::Inputs, Self::Outputs, Self::Flags, Self::Timers, Self::Counters];
        areas.into_iter().zip(["I", "Q", "M", "T", "C"]).find(|(_, known)| *known == letter).map(|(area, _)| area)
    }

    /// The part that contains its bytes; for a data block, the part of the data blocks of the program.
    #[must_use]
    pub fn plain_part(self) -> Part {
        match self {
            Self::DataBlock(number) => Part::Block(number),
            Self::Inputs => Part::Inputs,
            Self::Outputs => Part::Outputs,
            Self::Flags => Part::Flags,
            Self::Timers => Part::Timers,
            Self::Counters => Part::Counters,
        }
    }
}

/// The size of an address.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Width {
    /// One bit, 0 to 7.
    Bit(u8),
    /// Adjacent bits of one byte.
    Bits {
        /// The lowest bit.
        first: u8,
        /// The highest bit.
        last: u8,
    },
    /// One byte.
    Byte,
    /// Two bytes, most significant first.
    Word,
    /// Four bytes, most significant first.
    Double,
}

/// A STEP 7 absolute address.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Address {
    /// The area.
    pub area: Area,
    /// The byte; the number of a timer or counter.
    pub byte: u16,
    /// The size; timers and counters are words.
    pub width: Width,
    /// The number format after the colon; `None` if the catalogue decides.
    pub format: Option<Format>,
}

impl fmt::Display for Area {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::DataBlock(number) => write!(f, "DB{number}"),
            Self::Inputs => f.write_str("I"),
            Self::Outputs => f.write_str("Q"),
            Self::Flags => f.write_str("M"),
            Self::Timers => f.write_str("T"),
            Self::Counters => f.write_str("C"),
        }
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { area, byte, .. } = self;
        if matches!(area, Area::Timers | Area::Counters) {
            return write!(f, "{area}{byte}");
        }
        let (before, bit) = match area {
            Area::DataBlock(_) => (format!("{area}.DB"), "X"),
            _ => (area.to_string(), ""),
        };
        match self.width {
            Width::Bit(at) => write!(f, "{before}{bit}{byte}.{at}")?,
            Width::Bits { first, last } => write!(f, "{before}{bit}{byte}.{first}..{last}")?,
            Width::Byte => write!(f, "{before}B{byte}")?,
            Width::Word => write!(f, "{before}W{byte}")?,
            Width::Double => write!(f, "{before}D{byte}")?,
        }
        match (self.format, self.width) {
            (Some(Format::Real), _) => f.write_str(":REAL"),
            (Some(Format::Signed), Width::Double) => f.write_str(":DINT"),
            (Some(Format::Signed), _) => f.write_str(":INT"),
            (Some(Format::Unsigned), Width::Double) => f.write_str(":DWORD"),
            (Some(Format::Unsigned) | None, _) => Ok(()),
        }
    }
}

const CURE: &str = "write it as DB31.DBX101.5, DB31.DBB101, DB21.DBW4, DB31.DBD78, M10.3, IB0, QW4, T5 or C3";

impl FromStr for Address {
    type Err = Problem;

    fn from_str(text: &str) -> Result<Self, Problem> {
        let (plain, suffix) = match text.split_once(':') {
            Some((plain, suffix)) => (plain, Some(suffix)),
            None => (text, None),
        };
        let (area, element) = area(plain).ok_or_else(|| strange(text))?;
        let (byte, width) = match area {
            Area::Timers | Area::Counters => (number(element, text)?, Width::Word),
            Area::DataBlock(_) => {
                let element = element.strip_prefix(".DB").ok_or_else(|| strange(text))?;
                let (kind, rest) = element.split_at_checked(1).ok_or_else(|| strange(text))?;
                of_kind(kind, rest, text)?
            }
            Area::Inputs | Area::Outputs | Area::Flags => match element.split_at_checked(1) {
                Some((kind @ ("B" | "W" | "D"), rest)) => of_kind(kind, rest, text)?,
                _ => of_kind("X", element, text)?,
            },
        };
        let format = suffix.map(|suffix| format(suffix, width, text)).transpose()?;
        Ok(Self { area, byte, width, format })
    }
}

/// The area of an address and the text after it.
fn area(text: &str) -> Option<(Area, &str)> {
    if let Some(rest) = text.strip_prefix("DB") {
        let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
        return Some((Area::DataBlock(rest[..end].parse().ok()?), &rest[end..]));
    }
    let (area, rest) = text.split_at_checked(1)?;
    Some((Area::of_letter(area)?, rest))
}

/// Byte and size of an element, from the text after its letter: X, B, W or D.
fn of_kind(kind: &str, rest: &str, text: &str) -> Result<(u16, Width), Problem> {
    let width = match kind {
        "X" => {
            let (byte, bit) = rest
                .split_once('.')
                .ok_or_else(|| Problem::new(format!("expected a bit after the byte, found none in `{text}`"), CURE))?;
            let width = match bit.split_once("..") {
                None => Width::Bit(bit_number(bit, text)?),
                Some((first, last)) => {
                    let (first, last) = (bit_number(first, text)?, bit_number(last, text)?);
                    if first >= last || last - first == 7 {
                        return Err(Problem::new(
                            format!("expected two to seven bits, lowest first, found `{text}`"),
                            "write DB10.DBX100.0..4 for a group of bits, or DBB for the whole byte",
                        ));
                    }
                    Width::Bits { first, last }
                }
            };
            return Ok((number(byte, text)?, width));
        }
        "B" => Width::Byte,
        "W" => Width::Word,
        "D" => Width::Double,
        _ => return Err(strange(text)),
    };
    Ok((number(rest, text)?, width))
}

fn bit_number(digit: &str, text: &str) -> Result<u8, Problem> {
    match digit.as_bytes() {
        [digit @ b'0'..=b'7'] => Ok(digit - b'0'),
        _ => Err(Problem::new(
            format!("expected a bit from 0 to 7, found `{digit}` in `{text}`"),
            "the bits of a byte are 0 to 7",
        )),
    }
}

fn number(digits: &str, text: &str) -> Result<u16, Problem> {
    if digits.is_empty() || !digits.bytes().all(|digit| digit.is_ascii_digit()) {
        return Err(strange(text));
    }
    digits.parse().map_err(|_| {
        Problem::new(format!("expected a byte up to 65535, found `{digits}` in `{text}`"), "write a smaller number")
    })
}

fn format(suffix: &str, width: Width, text: &str) -> Result<Format, Problem> {
    match (suffix, width) {
        ("INT", Width::Word) | ("DINT", Width::Double) => Ok(Format::Signed),
        ("REAL", Width::Double) => Ok(Format::Real),
        ("WORD", Width::Word) | ("DWORD", Width::Double) => Ok(Format::Unsigned),
        _ => Err(Problem::new(
            format!("expected `:INT` after a word, or `:DINT` or `:REAL` after a double word, found `{text}`"),
            "omit the suffix for an unsigned number",
        )),
    }
}

fn strange(text: &str) -> Problem {
    Problem::new(format!("expected an absolute address, found `{text}`"), CURE)
}
