//! The values of nodes after a step, with the types of a SINUMERIK: unsigned numbers of any size are UInt32, REAL and F64 are Double.
//!
//! A name that no control knows is `BadNodeIdUnknown`. A known name with an index that the machine does not have is
//! `BadAttributeIdInvalid`, as a SINUMERIK answers.

use opcua::types::{Array, DateTime, StatusCode, Variant, VariantScalarTypeId};

use super::node_id::{Datum, Id, Index, Nc, Own, Plc, Type};
use crate::image::{Address, Area, Location, Width};
use crate::live::Seen;
use crate::machine::{Machine, Panel};
use crate::units::Time;
use crate::variables::nc::{self, ClockTime, Kind, MachineData, Shown, View};

/// From 1601, where the times of OPC UA begin, to 1970, in milliseconds.
pub(super) const EARLIER: i64 = 11_644_473_600_000;

/// Nothing of this machine has this id.
pub(super) const NOT_HERE: StatusCode = StatusCode::BadAttributeIdInvalid;

/// What nodes are read from.
pub(super) struct Reader<'a> {
    machine: &'a Machine,
    view: View<'a>,
    is_inch: bool,
    speed: f64,
}

/// What values depend on besides the machine.
#[derive(Clone, Copy, Debug)]
pub(super) struct Terms<'a> {
    /// The speed relative to real time.
    pub(super) speed: f64,
    /// The serial number of the hardware.
    pub(super) serial_number: &'a str,
}

/// Calls with a reader of this copy of the machine.
pub(super) fn with_reader<T>(seen: &Seen, terms: Terms<'_>, work: impl FnOnce(&Reader<'_>) -> T) -> T {
    let machine = seen.machine();
    let panel = Panel(machine);
    let since = seen.clock().duration_since(std::time::UNIX_EPOCH).unwrap_or_default();
    let view = View {
        memory: machine.memory(),
        variables: machine.variables(),
        names: machine.names(),
        machine_data: Some(&panel),
        control: Some(&panel),
        clock: ClockTime(u64::try_from(since.as_millis()).unwrap_or(u64::MAX)),
        serial_number: terms.serial_number,
    };
    let is_inch = nc::is_sinumerik(&view) && view.shows_inch();
    work(&Reader { machine, view, is_inch, speed: terms.speed })
}

impl<'a> Reader<'a> {
    pub(super) fn machine(&self) -> &'a Machine {
        self.machine
    }

    pub(super) fn view(&self) -> &View<'a> {
        &self.view
    }

    /// The value of a node.
    pub(super) fn read(&self, id: &Id) -> Result<Variant, StatusCode> {
        match id {
            Id::Plc(plc) => self.plc(plc),
            Id::Pattern(..) | Id::Absent => Err(NOT_HERE),
            Id::Variable(nc) => self.variable(nc),
            Id::Datum(datum) => self.datum(datum),
            Id::Own(own) => Ok(self.own(*own)),
            Id::Cnc(member) => self.cnc(member),
        }
    }

    /// The bits of a number of the PLC that lies in one part of the memory.
    pub(super) fn location(&self, plc: &Plc) -> Option<Location> {
        let is_number = plc.count.is_none() && !matches!(plc.kind, Type::String | Type::Char);
        let address = Address { area: plc.area, byte: plc.byte, width: plc.width, format: None };
        is_number.then(|| self.machine.memory().locate(&address, self.view.names.profile).ok()).flatten()
    }

    fn bytes(&self, area: Area, start: u32, count: usize) -> Result<Vec<u8>, StatusCode> {
        let mut bytes = vec![0; count];
        let read = self.machine.memory().read_bytes(area, start, &mut bytes, self.view.names.profile);
        read.map(|()| bytes).map_err(|_| NOT_HERE)
    }

    fn plc(&self, plc: &Plc) -> Result<Variant, StatusCode> {
        let start = start(plc);
        let text = |units: &[u8]| match plc.width {
            Width::Word => {
                let units = units.chunks_exact(2).map(|unit| u16::from_be_bytes([unit[0], unit[1]]));
                char::decode_utf16(units).map(|letter| letter.unwrap_or('\u{FFFD}')).collect::<String>()
            }
            _ => String::from_utf8_lossy(units).into_owned(),
        };
        if plc.kind == Type::String {
            let unit = unit(plc.width);
            let head = self.bytes(plc.area, start, 2 * unit)?;
            let [longest, length] = lengths(&head, plc.width);
            let length = length.min(longest);
            return Ok(text(&self.bytes(plc.area, start + 2 * width_u32(unit), length * unit)?).into());
        }
        let size = size(plc);
        let bytes = self.bytes(plc.area, start, size * usize::from(plc.count.unwrap_or(1)))?;
        let element = |bytes: &[u8]| {
            if plc.kind == Type::Char {
                return Variant::from(text(bytes));
            }
            let raw = bytes.iter().fold(0, |raw: u32, byte| raw << 8 | u32::from(*byte));
            let raw = if let Width::Bit(bit) = plc.width { raw >> bit & 1 } else { raw };
            number(plc.kind, raw)
        };
        match plc.count {
            None => Ok(element(&bytes)),
            Some(_) => array(bytes.chunks_exact(size).map(element).collect()),
        }
    }

    fn variable(&self, nc: &Nc) -> Result<Variant, StatusCode> {
        if !nc::is_sinumerik(&self.view) {
            return Err(StatusCode::BadNodeIdUnknown);
        }
        let element = |line: u16| {
            let shown = nc.variable.value(&self.view, nc.index.unit, line, self.is_inch).ok_or(NOT_HERE)?;
            Ok(match (nc.variable.kind, shown) {
                (Kind::Double | Kind::Length | Kind::DriveReal, Shown::Number(value)) => value.into(),
                (Kind::Word | Kind::Long | Kind::UnsignedLong | Kind::Text(_) | Kind::Date, Shown::Number(value)) => {
                    whole(value).into()
                }
                (_, Shown::Text(text)) => text.into_owned().into(),
                (_, Shown::Date(None)) => Variant::from(DateTime::null()),
                (_, Shown::Date(Some(ClockTime(time)))) => Variant::from(date_time(time)),
            })
        };
        // R0 is row 1.
        let first = if nc.is_r { nc.index.first.checked_add(1).ok_or(NOT_HERE)? } else { nc.index.first };
        elements(first, nc.index, element)
    }

    fn datum(&self, datum: &Datum) -> Result<Variant, StatusCode> {
        let (place, number) = self.datum_place(datum)?;
        let element = |line| {
            let datum = nc::datum(&self.view, place, number, line).map_err(|_| NOT_HERE)?;
            Ok(match datum {
                nc::Datum::Boolean(value) => value.into(),
                nc::Datum::Byte(value) => u32::from(value).into(),
                nc::Datum::Whole(value) => value.into(),
                nc::Datum::Unsigned(value) => value.into(),
                nc::Datum::Number(value) => value.into(),
                nc::Datum::Text(text) => text.to_owned().into(),
            })
        };
        elements(datum.index.first, datum.index, element)
    }

    /// The owner and the number of a machine datum.
    pub(super) fn datum_place(&self, datum: &Datum) -> Result<(crate::variables::Place, u16), StatusCode> {
        let number = Panel(self.machine).number(&datum.identifier).ok_or(StatusCode::BadNodeIdUnknown)?;
        let place = nc::owner(&self.view, datum.scope.area(), datum.index.unit).map_err(|_| NOT_HERE)?;
        Ok((place, number))
    }

    fn own(&self, own: Own) -> Variant {
        match own {
            Own::Cycle => self.machine.cycle().into(),
            Own::Time => Time::seconds(self.machine.time()).into(),
            Own::Speed => self.speed.into(),
        }
    }
}

/// One element, or all elements of an array.
fn elements(
    first: u16,
    index: Index,
    element: impl Fn(u16) -> Result<Variant, StatusCode>,
) -> Result<Variant, StatusCode> {
    // There is no row 0.
    let first = if first == 0 { return Err(NOT_HERE) } else { first };
    match index.count {
        None => element(first),
        Some(count) => {
            let end = first.checked_add(count).ok_or(NOT_HERE)?;
            array((first..end).map(element).collect::<Result<_, _>>()?)
        }
    }
}

fn array(values: Vec<Variant>) -> Result<Variant, StatusCode> {
    let kind = values.first().and_then(Variant::scalar_type_id).unwrap_or(VariantScalarTypeId::UInt32);
    Array::new(kind, values).map(Variant::from).map_err(|_| StatusCode::BadInternalError)
}

/// The first byte of an address; timers and counters have two bytes each.
pub(super) fn start(plc: &Plc) -> u32 {
    match plc.area {
        Area::Timers | Area::Counters => u32::from(plc.byte) * 2,
        Area::DataBlock(_) | Area::Inputs | Area::Outputs | Area::Flags => plc.byte.into(),
    }
}

/// The bytes of one element of a number or a character.
pub(super) const fn size(plc: &Plc) -> usize {
    match plc.width {
        Width::Bit(_) | Width::Bits { .. } | Width::Byte => 1,
        Width::Word => 2,
        Width::Double => 4,
    }
}

/// The bytes of a character, and of each of the two lengths of a text.
pub(super) const fn unit(width: Width) -> usize {
    if matches!(width, Width::Word) { 2 } else { 1 }
}

fn width_u32(unit: usize) -> u32 {
    u32::try_from(unit).unwrap_or(1)
}

/// The longest and the present length of a text, in characters.
pub(super) fn lengths(head: &[u8], width: Width) -> [usize; 2] {
    match (width, head) {
        (Width::Word, [a, b, c, d]) => [[*a, *b], [*c, *d]].map(|length| u16::from_be_bytes(length).into()),
        (_, [longest, length, ..]) => [usize::from(*longest), usize::from(*length)],
        _ => [0, 0],
    }
}

/// A number of the PLC from its bits.
pub(super) fn number(kind: Type, raw: u32) -> Variant {
    match kind {
        Type::Bool => (raw & 1 == 1).into(),
        Type::Byte | Type::Word | Type::DoubleWord | Type::Timer | Type::Char | Type::String => raw.into(),
        #[expect(clippy::cast_possible_truncation, reason = "the bits of a word")]
        Type::Int => i32::from((raw as u16).cast_signed()).into(),
        Type::DoubleInt => raw.cast_signed().into(),
        Type::Real => f64::from(f32::from_bits(raw)).into(),
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a counter counts to 999 in BCD; the type of OPC UA is a byte"
        )]
        Type::Counter => (raw as u8).into(),
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "states and modes are small")]
fn whole(value: f64) -> u32 {
    value as u32
}

/// A time in milliseconds since 1970.
fn date_time(milliseconds: u64) -> DateTime {
    let since = i64::try_from(milliseconds).unwrap_or(i64::MAX / 20_000) + EARLIER;
    DateTime::from(since * 10_000)
}
