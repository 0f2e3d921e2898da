//! Items: the addresses in a request. Each begins with `12`, the length of the rest and a syntax identifier. An item of odd length is
//! followed by a fill byte.
//!
//! | syntax | support |
//! |---|---|
//! | `10` any-type: area, byte and bit, type, count | served |
//! | `82` `83` `84` NCK variable, in the current unit, metric, in inches | served |
//! | `A2` parameter of a drive object | served |
//! | `B0` areas of data blocks, `B2` symbolic | recognised, each refused separately |

use zerocopy::byteorder::big_endian::U16;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::data::{Refusal, Type};
use crate::image::Area;

const VARIABLE: u8 = 0x12;
const ANY: u8 = 0x10;

/// The item of syntax `10` on the wire.
#[derive(Clone, Copy, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
struct AnyBytes {
    kind: u8,
    count: U16,
    data_block: U16,
    area: u8,
    address: [u8; 3],
}

/// An item of syntax `10` with known codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AnyItem {
    /// The type of each element.
    pub kind: Type,
    /// The number of elements.
    pub count: u16,
    /// The area.
    pub area: Area,
    /// The first byte; timers and counters have two bytes each.
    pub byte: u32,
    /// The bit in the byte; 0 unless the type is a bit.
    pub bit: u8,
}

impl AnyItem {
    /// The number of bytes of its value.
    #[must_use]
    pub fn length(&self) -> usize {
        usize::from(self.count) * self.kind.bytes()
    }

    /// The number of bytes of memory that it covers.
    #[must_use]
    pub fn span(&self) -> u32 {
        u32::try_from(self.length()).unwrap_or(u32::MAX)
    }
}

/// The requested unit of an NCK variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasuringSystem {
    /// As displayed by the control.
    Current,
    /// Millimetres.
    Metric,
    /// Inches.
    Inch,
}

/// An item of syntax `82`, `83`, `84`: NCK variables by area, module, column and line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NckItem {
    /// The requested unit.
    pub system: MeasuringSystem,
    /// 0 NCK, 1 mode group, 2 channel, 3 axis, 4 tool, 5 feed drive, 6 main drive, 7 MMC.
    pub area: u8,
    /// The number of the channel, axis or other unit, from 1.
    pub unit: u8,
    /// The column in its module; the number of a machine datum.
    pub column: u16,
    /// The first row, from 1: axis, alarm, index of an array.
    pub line: u16,
    /// The block type, for example `74` machine axes.
    pub module: u8,
    /// The number of rows.
    pub count: u8,
}

/// Feed drives and main drives.
const DRIVE_AREAS: [u8; 2] = [5, 6];

impl NckItem {
    /// Whether it is a drive value.
    #[must_use]
    pub fn is_of_drive(&self) -> bool {
        DRIVE_AREAS.contains(&self.area)
    }
}

/// An item of syntax `A2`: a parameter of a drive object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DriveItem {
    /// The type of each element, as in syntax `10`.
    pub kind: u8,
    /// The number of elements.
    pub count: u16,
    /// The drive object.
    pub object: u16,
    /// Number of the parameter.
    pub parameter: u16,
    /// Its index.
    pub index: u16,
}

/// One item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Item {
    /// Syntax `10`.
    Any(AnyItem),
    /// Syntax `82` to `84`.
    Nck(NckItem),
    /// Syntax `A2`.
    Drive(DriveItem),
    /// An item that cannot be served, and the reason.
    Refused(Refusal),
}

/// The items of a parameter part.
#[derive(Clone, Copy, Debug)]
pub struct Items<'a> {
    rest: &'a [u8],
    left: usize,
}

impl<'a> Items<'a> {
    /// The first `count` items.
    #[must_use]
    pub fn new(bytes: &'a [u8], count: usize) -> Self {
        Self { rest: bytes, left: count }
    }
}

/// The bytes end before the last item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Truncated;

impl Iterator for Items<'_> {
    type Item = Result<Item, Truncated>;

    fn next(&mut self) -> Option<Self::Item> {
        self.left = self.left.checked_sub(1)?;
        let taken = match self.rest {
            [specification, length, rest @ ..] => {
                rest.split_at_checked(usize::from(*length)).map(|(body, rest)| (*specification, body, rest))
            }
            _ => None,
        };
        let Some((specification, body, mut rest)) = taken else {
            self.left = 0;
            return Some(Err(Truncated));
        };
        if body.len() % 2 == 1 && self.left > 0 {
            rest = rest.get(1..).unwrap_or(&[]);
        }
        self.rest = rest;
        Some(Ok(item(specification, body)))
    }
}

fn item(specification: u8, body: &[u8]) -> Item {
    if specification != VARIABLE {
        return Item::Refused(Refusal::TypeNotSupported);
    }
    match body {
        [ANY, rest @ ..] => any(rest),
        [syntax @ 0x82..=0x84, area_unit, c1, c0, l1, l0, module, count] => Item::Nck(NckItem {
            system: match syntax {
                0x82 => MeasuringSystem::Current,
                0x83 => MeasuringSystem::Metric,
                _ => MeasuringSystem::Inch,
            },
            area: area_unit >> 5,
            unit: area_unit & 0x1F,
            column: u16::from_be_bytes([*c1, *c0]),
            line: u16::from_be_bytes([*l1, *l0]),
            module: *module,
            count: *count,
        }),
        [0xA2, kind, r1, r0, o1, o0, p1, p0, i1, i0] => Item::Drive(DriveItem {
            kind: *kind,
            count: u16::from_be_bytes([*r1, *r0]),
            object: u16::from_be_bytes([*o1, *o0]),
            parameter: u16::from_be_bytes([*p1, *p0]),
            index: u16::from_be_bytes([*i1, *i0]),
        }),
        // Symbols are objects that this module does not have; other syntaxes are unsupported types.
        [0xA2 | 0xB2, ..] => Item::Refused(Refusal::DoesNotExist),
        _ => Item::Refused(Refusal::TypeNotSupported),
    }
}

fn any(rest: &[u8]) -> Item {
    let Ok(any) = AnyBytes::ref_from_bytes(rest) else {
        return Item::Refused(Refusal::TypeNotSupported);
    };
    let Some(kind) = Type::of(any.kind) else {
        return Item::Refused(Refusal::TypeNotSupported);
    };
    let [high, middle, low] = any.address;
    let address = u32::from_be_bytes([0, high, middle, low]);
    let (area, is_numbered) = match any.area {
        0x81 => (Area::Inputs, false),
        0x82 => (Area::Outputs, false),
        0x83 => (Area::Flags, false),
        0x84 => (Area::DataBlock(any.data_block.get()), false),
        0x1C => (Area::Counters, true),
        0x1D => (Area::Timers, true),
        _ => return Item::Refused(Refusal::DoesNotExist),
    };
    let is_timer = matches!(kind, Type::Timer | Type::Counter);
    if is_numbered {
        // The address is a number of two-byte elements. Clients send WORD as well as the type of the area. Another two-byte type counts in
        // other units: it is refused, because it would silently read another timer.
        let own = if area == Area::Timers { [Type::Timer, Type::S5Time] } else { [Type::Counter; 2] };
        if !matches!(kind, Type::Word | Type::Int) && !own.contains(&kind) {
            return Item::Refused(Refusal::TypeInconsistent);
        }
        return Item::Any(AnyItem { kind, count: any.count.get(), area, byte: address * 2, bit: 0 });
    }
    let bit = u8::try_from(address % 8).unwrap_or(0);
    match (kind, bit) {
        _ if is_timer => Item::Refused(Refusal::TypeInconsistent),
        (Type::Bit, _) if any.count.get() > 1 => Item::Refused(Refusal::TypeNotSupported),
        (Type::Bit, _) | (_, 0) => Item::Any(AnyItem { kind, count: any.count.get(), area, byte: address / 8, bit }),
        _ => Item::Refused(Refusal::OutOfRange),
    }
}
