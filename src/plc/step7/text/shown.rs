//! Operands and constants as messages show them.

use std::fmt;

use crate::plc::step7::instruction::{BlockKind, Register, Space, Width};

use super::constants::Constant;
use super::syntax::{Operand, Step};

impl fmt::Display for Constant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Integer(value) => write!(f, "{value}"),
            Self::Long(value) => write!(f, "L#{value}"),
            Self::Bits(value, 0) => write!(f, "2#{value:b}"),
            Self::Bits(value, 8) => write!(f, "B#16#{value:X}"),
            Self::Bits(value, 16) => write!(f, "W#16#{value:X}"),
            Self::Bits(value, _) => write!(f, "DW#16#{value:X}"),
            Self::Real(value) => write!(f, "{value:e}"),
            Self::Text(text) => {
                let text: String = text.iter().map(|letter| char::from(*letter)).collect();
                write!(f, "'{text}'")
            }
            Self::Boolean(value) => f.write_str(if *value { "TRUE" } else { "FALSE" }),
            Self::S5Time(value) => write!(f, "an S5TIME (16#{value:04X})"),
            Self::Time(millis) => write!(f, "T#{millis}MS"),
            Self::Date(days) => write!(f, "a DATE (day {days})"),
            Self::TimeOfDay(millis) => write!(f, "a TIME_OF_DAY ({millis} ms)"),
            Self::DateTime(_) => f.write_str("a DATE_AND_TIME"),
            Self::Count(value) => write!(f, "C#{value:X}"),
            Self::Bit(bit) => write!(f, "P#{}.{}", bit / 8, bit % 8),
            Self::Pointer { block: 0, pointer, .. } => {
                let bit = pointer & 0x00FF_FFFF;
                write!(f, "a pointer to area 16#{:02X}, byte {}.{}", pointer >> 24, bit / 8, bit % 8)
            }
            Self::Pointer { block, pointer, .. } => {
                let bit = pointer & 0x00FF_FFFF;
                write!(f, "P#DB{block}.DBX {}.{}", bit / 8, bit % 8)
            }
        }
    }
}

/// The letters of an area with a width.
fn letters(space: Option<Space>, width: Width) -> String {
    let of_width = |of_bit: &str| match width {
        Width::Bit => of_bit.to_owned(),
        Width::Byte => "B".to_owned(),
        Width::Word => "W".to_owned(),
        Width::Double => "D".to_owned(),
    };
    let area = match space {
        None => return of_width(""),
        Some(Space::Peripheral) => "P",
        Some(Space::Inputs) => "I",
        Some(Space::Outputs) => "Q",
        Some(Space::Flags) => "M",
        Some(Space::Data) => return format!("DB{}", of_width("X")),
        Some(Space::Instance) => return format!("DI{}", of_width("X")),
        Some(Space::Local) => "L",
        Some(Space::Caller) => "V",
    };
    format!("{area}{}", of_width(""))
}

fn address(width: Width, bit: u32) -> String {
    if width == Width::Bit { format!("{}.{}", bit / 8, bit % 8) } else { (bit / 8).to_string() }
}

/// A path into a variable: `.member[1]`.
pub(in crate::plc::step7) fn path(steps: &[Step]) -> String {
    let step = |step: &Step| match step {
        Step::Member(name) => format!(".{name}"),
        Step::Index(indices) => {
            format!("[{}]", indices.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "))
        }
    };
    steps.iter().map(step).collect()
}

impl fmt::Display for Operand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("no operand"),
            Self::Constant(constant) => write!(f, "{constant}"),
            Self::Local(name, steps) => write!(f, "#{name}{}", path(steps)),
            Self::Bare(name, steps) => write!(f, "{name}{}", path(steps)),
            Self::Symbol(name, steps) => write!(f, "\"{name}\"{}", path(steps)),
            &Self::SymbolData(ref name, width, bit) => {
                write!(f, "\"{name}\".{} {}", letters(Some(Space::Data), width), address(width, bit))
            }
            &Self::Memory(space, width, bit) => write!(f, "{} {}", letters(Some(space), width), address(width, bit)),
            &Self::BlockData(number, width, bit) => {
                write!(f, "DB{number}.{} {}", letters(Some(Space::Data), width), address(width, bit))
            }
            Self::BlockMember(number, steps) => write!(f, "DB{number}{}", path(steps)),
            Self::Indirect(space, width, pointer) => write!(f, "{} [{pointer}]", letters(Some(*space), *width)),
            &Self::Register(space, width, register, bit) => {
                let register = if register == Register::Ar1 { "AR1" } else { "AR2" };
                let letters = letters(space, width);
                let blank = if letters.is_empty() { "" } else { " " };
                write!(f, "{letters}{blank}[{register},P#{}.{}]", bit / 8, bit % 8)
            }
            Self::Timer(number) => write!(f, "T {number}"),
            Self::Counter(number) => write!(f, "C {number}"),
            Self::TimerAt(pointer) => write!(f, "T [{pointer}]"),
            Self::CounterAt(pointer) => write!(f, "C [{pointer}]"),
            Self::Block(name) => write!(f, "{name}"),
            Self::BlockAt(BlockKind::Db, true, pointer) => write!(f, "DI [{pointer}]"),
            Self::BlockAt(kind, _, pointer) => write!(f, "{} [{pointer}]", format!("{kind:?}").to_uppercase()),
            Self::InstanceBlock(number) => write!(f, "DI {number}"),
            Self::Status(_) => f.write_str("a status bit"),
            Self::Special(word) => f.write_str(word),
            Self::AddressOf(name, steps) => write!(f, "P##{name}{}", path(steps)),
        }
    }
}
