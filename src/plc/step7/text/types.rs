//! Data types and the layout of their variables.

use std::sync::Arc;

use crate::plc::step7::instruction::{BlockName, Width};

use super::constants::{Constant, word};

/// The largest data block.
pub(in crate::plc::step7) const LARGEST: u32 = 65_536;

/// A data type.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::plc::step7) enum Type {
    Bool,
    Byte,
    Char,
    Word,
    Int,
    Date,
    S5Time,
    DWord,
    DInt,
    Real,
    Time,
    TimeOfDay,
    DateTime,
    /// With the maximum length.
    Text(u8),
    Array(Arc<Array>),
    Struct(Arc<Layout>),
    /// A multi-instance.
    Instance(BlockName, Arc<Layout>),
    Pointer,
    Any,
    Timer,
    Counter,
    BlockDb,
    BlockFb,
    BlockFc,
    Void,
}

/// An array: its ranges, and the type of its elements.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::plc::step7) struct Array {
    pub(in crate::plc::step7) ranges: Vec<(i32, i32)>,
    pub(in crate::plc::step7) element: Type,
}

/// How a variable is declared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Section {
    Input,
    Output,
    InOut,
    Static,
    Temp,
}

/// A variable and its place.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::plc::step7) struct Field {
    pub(in crate::plc::step7) name: String,
    pub(in crate::plc::step7) ty: Type,
    pub(in crate::plc::step7) section: Section,
    /// Its bit address.
    pub(in crate::plc::step7) bit: u32,
}

/// Variables one after the other, with their initial values.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::plc::step7) struct Layout {
    pub(in crate::plc::step7) fields: Vec<Field>,
    /// The initial values; the length is even.
    pub(in crate::plc::step7) image: Vec<u8>,
}

fn even(bits: u32) -> u32 {
    bits.next_multiple_of(16)
}

impl Type {
    /// The elementary type of a keyword.
    pub(in crate::plc::step7) fn elementary(word: &str) -> Option<Self> {
        Some(match word.to_ascii_uppercase().as_str() {
            "BOOL" => Self::Bool,
            "BYTE" => Self::Byte,
            "CHAR" => Self::Char,
            "WORD" => Self::Word,
            "INT" => Self::Int,
            "DATE" => Self::Date,
            "S5TIME" => Self::S5Time,
            "DWORD" => Self::DWord,
            "DINT" => Self::DInt,
            "REAL" => Self::Real,
            "TIME" => Self::Time,
            "TIME_OF_DAY" | "TOD" => Self::TimeOfDay,
            "DATE_AND_TIME" | "DT" => Self::DateTime,
            "POINTER" => Self::Pointer,
            "ANY" => Self::Any,
            "TIMER" => Self::Timer,
            "COUNTER" => Self::Counter,
            "BLOCK_DB" => Self::BlockDb,
            "BLOCK_FB" => Self::BlockFb,
            "BLOCK_FC" | "BLOCK_SDB" => Self::BlockFc,
            "VOID" => Self::Void,
            _ => return None,
        })
    }

    /// Its name, for messages.
    pub(in crate::plc::step7) fn name(&self) -> String {
        match self {
            Self::Text(length) => format!("STRING[{length}]"),
            Self::Array(array) => format!("ARRAY OF {}", array.element.name()),
            Self::Struct(_) => "STRUCT".to_owned(),
            Self::Instance(name, _) => name.to_string(),
            Self::DateTime => "DATE_AND_TIME".to_owned(),
            Self::TimeOfDay => "TIME_OF_DAY".to_owned(),
            Self::BlockDb => "BLOCK_DB".to_owned(),
            Self::BlockFb => "BLOCK_FB".to_owned(),
            Self::BlockFc => "BLOCK_FC".to_owned(),
            other => format!("{other:?}").to_uppercase(),
        }
    }

    /// The bits that a variable takes.
    pub(in crate::plc::step7) fn bits(&self) -> u32 {
        match self {
            Self::Bool => 1,
            Self::Byte | Self::Char => 8,
            Self::Word
            | Self::Int
            | Self::Date
            | Self::S5Time
            | Self::Timer
            | Self::Counter
            | Self::BlockDb
            | Self::BlockFb
            | Self::BlockFc => 16,
            Self::DWord | Self::DInt | Self::Real | Self::Time | Self::TimeOfDay => 32,
            Self::Pointer => 48,
            Self::DateTime => 64,
            Self::Any => 80,
            Self::Text(length) => (u32::from(*length) + 2) * 8,
            Self::Array(array) => even(array.bits_of(0)),
            Self::Struct(layout) | Self::Instance(_, layout) => layout.bits(),
            Self::Void => 0,
        }
    }

    /// The width of an access, for types that have one.
    pub(in crate::plc::step7) fn width(&self) -> Option<Width> {
        match self {
            Self::Bool => Some(Width::Bit),
            Self::Byte | Self::Char => Some(Width::Byte),
            Self::Word | Self::Int | Self::Date | Self::S5Time => Some(Width::Word),
            Self::DWord | Self::DInt | Self::Real | Self::Time | Self::TimeOfDay => Some(Width::Double),
            _ => None,
        }
    }

    /// Whether parameters of this type are numbers of timers, counters or blocks.
    pub(in crate::plc::step7) fn is_number(&self) -> bool {
        matches!(self, Self::Timer | Self::Counter | Self::BlockDb | Self::BlockFb | Self::BlockFc)
    }

    /// Whether a function gets it as a POINTER, and an FB gets it so as an in-out parameter.
    pub(in crate::plc::step7) fn is_complex(&self) -> bool {
        matches!(self, Self::DateTime | Self::Text(_) | Self::Array(_) | Self::Struct(_))
    }

    /// The code of its type in ANY, and the count.
    pub(in crate::plc::step7) fn any(&self) -> (u8, u16) {
        let length = |bits: u32| u16::try_from(bits / 8).unwrap_or(u16::MAX);
        match self {
            Self::Bool => (0x01, 1),
            Self::Byte => (0x02, 1),
            Self::Char => (0x03, 1),
            Self::Word => (0x04, 1),
            Self::Int => (0x05, 1),
            Self::DWord => (0x06, 1),
            Self::DInt => (0x07, 1),
            Self::Real => (0x08, 1),
            Self::Date => (0x09, 1),
            Self::TimeOfDay => (0x0A, 1),
            Self::Time => (0x0B, 1),
            Self::S5Time => (0x0C, 1),
            Self::DateTime => (0x0E, 1),
            Self::Text(_) => (0x13, 1),
            Self::BlockFb => (0x17, 1),
            Self::BlockFc => (0x18, 1),
            Self::BlockDb => (0x19, 1),
            Self::Counter => (0x1C, 1),
            Self::Timer => (0x1D, 1),
            Self::Array(_) | Self::Struct(_) | Self::Instance(..) | Self::Pointer | Self::Any => {
                (0x02, length(self.bits()))
            }
            Self::Void => (0, 0),
        }
    }

    /// The bit at which a variable begins that follows others.
    fn aligned(&self, bit: u32) -> u32 {
        match self {
            Self::Bool => bit,
            Self::Byte | Self::Char => bit.next_multiple_of(8),
            _ => even(bit),
        }
    }

    /// Its bytes without initial values of its own.
    fn image(&self, bytes: &mut [u8], bit: u32) {
        let at = (bit / 8) as usize;
        match self {
            Self::Text(length) => bytes[at] = *length,
            Self::Array(array) => {
                for index in 0..array.count() {
                    array.element.image(bytes, bit + array.offset_of(index));
                }
            }
            Self::Struct(layout) | Self::Instance(_, layout) => {
                bytes[at..at + layout.image.len()].copy_from_slice(&layout.image);
            }
            Self::DateTime => bytes[at..at + 8].copy_from_slice(&[0x90, 1, 1, 0, 0, 0, 0, 2]),
            _ => {}
        }
    }
}

impl Array {
    /// The number of elements of a dimension.
    fn length(&self, dimension: usize) -> u32 {
        let (from, to) = self.ranges[dimension];
        u32::try_from(i64::from(to) - i64::from(from) + 1).unwrap_or(0)
    }

    /// The bits of a row: of the elements with the same indices before a dimension.
    fn bits_of(&self, dimension: usize) -> u32 {
        let step = if dimension + 1 < self.ranges.len() { even(self.bits_of(dimension + 1)) } else { self.step() };
        step.saturating_mul(self.length(dimension))
    }

    fn step(&self) -> u32 {
        match self.element {
            Type::Bool => 1,
            Type::Byte | Type::Char => 8,
            ref element => even(element.bits()),
        }
    }

    /// The number of elements.
    pub(in crate::plc::step7) fn count(&self) -> u32 {
        (0..self.ranges.len()).map(|dimension| self.length(dimension)).product()
    }

    /// Whether it fits into a data block.
    pub(in crate::plc::step7) fn is_possible(&self) -> bool {
        let lengths = self.ranges.iter().map(|&(from, to)| i64::from(to) - i64::from(from) + 1);
        let mut lengths = lengths;
        let count = lengths.try_fold(1_i64, |count, length| count.checked_mul(length).filter(|_| length > 0));
        let element = i64::from(self.element.bits().max(1));
        count.is_some_and(|count| count <= i64::from(LARGEST) * 8 / element) && self.bits_of(0) <= LARGEST * 8
    }

    /// The distance of the element with a running number, last index fastest.
    pub(in crate::plc::step7) fn offset_of(&self, number: u32) -> u32 {
        let mut rest = number;
        let mut offset = 0;
        for dimension in (0..self.ranges.len()).rev() {
            let length = self.length(dimension).max(1);
            let step = if dimension + 1 < self.ranges.len() { even(self.bits_of(dimension + 1)) } else { self.step() };
            offset += rest % length * step;
            rest /= length;
        }
        offset
    }

    /// The running number of an element by its indices.
    pub(in crate::plc::step7) fn number_of(&self, indices: &[i64]) -> Option<u32> {
        if indices.len() != self.ranges.len() {
            return None;
        }
        let mut number = 0;
        for (dimension, (&index, &(from, to))) in indices.iter().zip(&self.ranges).enumerate() {
            if index < i64::from(from) || index > i64::from(to) {
                return None;
            }
            number = number * self.length(dimension) + u32::try_from(index - i64::from(from)).ok()?;
        }
        Some(number)
    }
}

impl Layout {
    pub(in crate::plc::step7) fn bits(&self) -> u32 {
        u32::try_from(self.image.len() * 8).unwrap_or(u32::MAX)
    }

    /// Adds a variable; `None` if it does not fit into a data block. An in-out parameter of a complex type is a pointer.
    pub(in crate::plc::step7) fn add(&mut self, name: &str, ty: Type, section: Section) -> Option<u32> {
        let end = self.fields.last().map_or(0, |last| last.end());
        let is_new = self.fields.last().is_some_and(|last| last.section != section);
        let stored = stored(&ty, section);
        let bit = stored.aligned(if is_new { even(end) } else { end });
        let after = bit.checked_add(stored.bits()).filter(|&after| after <= LARGEST * 8)?;
        self.image.resize((even(after) / 8) as usize, 0);
        stored.image(&mut self.image, bit);
        self.fields.push(Field { name: name.to_owned(), ty, section, bit });
        Some(bit)
    }

    /// A variable by its name, in any case of letters.
    pub(in crate::plc::step7) fn field(&self, name: &str) -> Option<&Field> {
        let same =
            |other: &str| other.chars().flat_map(char::to_lowercase).eq(name.chars().flat_map(char::to_lowercase));
        self.fields.iter().find(|field| same(&field.name))
    }
}

/// What is stored for a variable: a complex in-out parameter is a pointer.
fn stored(ty: &Type, section: Section) -> Type {
    if section == Section::InOut && ty.is_complex() { Type::Pointer } else { ty.clone() }
}

impl Field {
    fn end(&self) -> u32 {
        self.bit + stored(&self.ty, self.section).bits()
    }

    /// Whether only a pointer to it is stored.
    pub(in crate::plc::step7) fn is_pointer(&self) -> bool {
        self.section == Section::InOut && self.ty.is_complex()
    }
}

/// Writes a constant as a value of a type; the error is what was expected.
pub(in crate::plc::step7) fn store(bytes: &mut [u8], bit: u32, ty: &Type, value: &Constant) -> Result<(), String> {
    let at = (bit / 8) as usize;
    let expected = || format!("a value of the type {}, found {value}", ty.name());
    let bits = value_of(ty, value);
    let bits = match ty {
        Type::Text(length) => {
            let Constant::Text(text) = value else { return Err(expected()) };
            let text = text.get(..usize::from(*length)).unwrap_or(text);
            bytes[at] = *length;
            bytes[at + 1] = u8::try_from(text.len()).map_err(|_| expected())?;
            bytes[at + 2..at + 2 + text.len()].copy_from_slice(text);
            return Ok(());
        }
        Type::DateTime => {
            let Constant::DateTime(value) = value else { return Err(expected()) };
            bytes[at..at + 8].copy_from_slice(value);
            return Ok(());
        }
        Type::Pointer | Type::Any => {
            let Constant::Pointer { block, pointer, any } = *value else { return Err(expected()) };
            let mut at = at;
            if let (Type::Any, (code, count)) = (ty, any.unwrap_or((0x02, 1))) {
                bytes[at] = 0x10;
                bytes[at + 1] = code;
                bytes[at + 2..at + 4].copy_from_slice(&count.to_be_bytes());
                at += 4;
            }
            bytes[at..at + 2].copy_from_slice(&block.to_be_bytes());
            bytes[at + 2..at + 6].copy_from_slice(&pointer.to_be_bytes());
            return Ok(());
        }
        _ => bits.ok_or_else(expected)?,
    };
    let four = bits.to_be_bytes();
    match ty.bits() {
        1 => {
            let mask = 1 << (bit % 8);
            bytes[at] = if bits == 0 { bytes[at] & !mask } else { bytes[at] | mask };
        }
        8 => bytes[at] = four[3],
        16 => bytes[at..at + 2].copy_from_slice(&four[2..]),
        32 => bytes[at..at + 4].copy_from_slice(&four),
        _ => return Err(expected()),
    }
    Ok(())
}

/// The bits of a constant as a value of an elementary type; `None` if the type does not allow it.
pub(in crate::plc::step7) fn value_of(ty: &Type, value: &Constant) -> Option<u32> {
    let small = |limit: u32| value.bits().filter(|&bits| bits <= limit);
    match (ty, value) {
        (Type::Bool, Constant::Boolean(value)) => Some(u32::from(*value)),
        (Type::Bool, Constant::Integer(value @ (0 | 1))) => Some(u32::from(*value == 1)),
        (Type::Byte, Constant::Bits(..) | Constant::Integer(_) | Constant::Text(_)) => small(0xFF),
        (Type::Char, Constant::Text(text)) if text.len() == 1 => small(0xFF),
        (Type::Char, Constant::Bits(_, 8 | 0)) => small(0xFF),
        (Type::Word, Constant::Bits(..) | Constant::Integer(_) | Constant::Count(_) | Constant::S5Time(_)) => {
            small(0xFFFF)
        }
        (Type::Word, Constant::Text(text)) if text.len() <= 2 => small(0xFFFF),
        (Type::Int, Constant::Integer(_)) => small(0xFFFF),
        (Type::Int, Constant::Bits(_, 0 | 16)) => small(0xFFFF),
        (Type::Date, Constant::Date(_)) | (Type::S5Time, Constant::S5Time(_)) => value.bits(),
        (Type::S5Time | Type::Date, Constant::Bits(_, 16)) => value.bits(),
        (
            Type::DWord,
            Constant::Bits(..) | Constant::Long(_) | Constant::Text(_) | Constant::Bit(_) | Constant::Pointer { .. },
        ) => value.bits(),
        (Type::DWord | Type::DInt, Constant::Integer(value)) => {
            i32::try_from(*value).ok().map(i32::cast_unsigned).or_else(|| u32::try_from(*value).ok())
        }
        (Type::DInt, Constant::Long(_) | Constant::Bits(_, 0 | 32)) => value.bits(),
        (Type::Real, Constant::Real(_)) => value.bits(),
        #[expect(clippy::cast_precision_loss, reason = "a whole number as REAL is rounded")]
        (Type::Real, Constant::Integer(value)) => Some((*value as f32).to_bits()),
        (Type::Time, Constant::Time(_)) | (Type::TimeOfDay, Constant::TimeOfDay(_)) => value.bits(),
        (Type::Time | Type::TimeOfDay, Constant::Bits(_, 32)) => value.bits(),
        (ty, Constant::Integer(value)) if ty.is_number() => word(*value).map(u32::from),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(types: &[Type]) -> Vec<u32> {
        let mut layout = Layout::default();
        types.iter().map(|ty| layout.add("x", ty.clone(), Section::Static).unwrap()).collect()
    }

    fn array(ranges: &[(i32, i32)], element: Type) -> Type {
        Type::Array(Arc::new(Array { ranges: ranges.to_vec(), element }))
    }

    #[test]
    fn bits_are_packed_and_words_start_at_even_bytes() {
        let found = layout(&[Type::Bool, Type::Bool, Type::Byte, Type::Int, Type::Bool, Type::Char, Type::Real]);
        assert_eq!(found, [0, 1, 8, 16, 32, 40, 48]);
        // BOOL of 9 takes two bytes; each row of BOOL[2][3] starts at an even byte: 2 × 16 bits.
        let found =
            layout(&[array(&[(1, 9)], Type::Bool), array(&[(1, 2), (1, 3)], Type::Bool), Type::Byte, Type::Text(5)]);
        assert_eq!(found, [0, 16, 48, 64]);
    }

    #[test]
    fn elements_are_found_by_their_indices() {
        let array = Array { ranges: vec![(1, 2), (0, 4)], element: Type::Byte };
        // A row of 5 bytes takes 6.
        assert_eq!(array.number_of(&[2, 1]), Some(6));
        assert_eq!(array.offset_of(6), 7 * 8);
        assert_eq!((array.number_of(&[0, 1]), array.number_of(&[1])), (None, None));
        assert!(!Array { ranges: vec![(i32::MIN, i32::MAX); 3], element: Type::Byte }.is_possible());
        assert!(!Array { ranges: vec![(2, 1)], element: Type::Byte }.is_possible());
    }

    #[test]
    fn a_complex_in_out_parameter_is_a_pointer_of_six_bytes() {
        let mut layout = Layout::default();
        layout.add("a", Type::Text(100), Section::InOut).unwrap();
        assert_eq!(layout.add("b", Type::Bool, Section::Static), Some(48));
    }
}
