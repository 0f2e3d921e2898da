//! Distributes items over requests: in order, as many as fit into a request and its answer. A value that is longer than a PDU is split
//! between elements and fills the remaining space. A value that fits into one PDU is never split, so that it is of one cycle.
//!
//! | | request | answer |
//! |---|---|---|
//! | read | header 10, parameter 2 + items | header 12, parameter 2, data items of 4 + value |
//! | write | as for read, and data items of 4 + value | header 12, parameter 2, one code per item |
//! | subscribe | header 10, parameter 8, data 4 + 4, items | header 10, parameter 12, data 4 + 2, data items |
//!
//! A value of odd length is followed by a fill byte if another item follows.

use crate::image::{Area, Width};
use crate::s7::wire::items::{AnyItem, NckItem};

use super::nc::NcVariable;
use super::variable::{Memory, Variable};

/// The kind of request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    Read,
    Write,
    Subscribe,
}

/// The limits of one request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Capacity {
    /// Bytes of a PDU.
    pub(super) pdu: usize,
    /// Number of items.
    pub(super) items: usize,
}

/// Maximum bytes of one value: its length field counts bits in two bytes.
const LONGEST_VALUE: usize = 8190;

/// Assumed maximum length of an NC variable of unknown type.
const UNKNOWN: usize = 200;

/// Some bytes of a variable, in one item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Part {
    /// The index of the variable in the request of the caller.
    pub(super) of: usize,
    /// Offset of its first byte.
    pub(super) offset: usize,
    /// Number of bytes.
    pub(super) length: usize,
    what: What,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum What {
    Memory(Memory),
    Nc(NcVariable),
}

impl Part {
    /// The parts of a variable before they are split further.
    pub(super) fn all(of: usize, variable: &Variable, purpose: Purpose) -> Vec<Self> {
        match *variable {
            Variable::Memory(memory) => match (purpose, memory.width) {
                // Bits are written one by one: writing the byte would overwrite its other bits.
                (Purpose::Write, Width::Bits { first, last }) => (first..=last)
                    .zip(0..)
                    .map(|(bit, offset)| {
                        let memory = Memory { width: Width::Bit(bit), ..memory };
                        Self { of, offset, length: 1, what: What::Memory(memory) }
                    })
                    .collect(),
                _ => vec![Self { of, offset: 0, length: memory.length(), what: What::Memory(memory) }],
            },
            Variable::Nc(variable) => {
                let length = variable.kind.map_or(UNKNOWN, |kind| kind.bytes() * usize::from(variable.item.count));
                vec![Self { of, offset: 0, length, what: What::Nc(variable) }]
            }
        }
    }

    /// Appends its item in wire format.
    pub(super) fn put_item(&self, out: &mut Vec<u8>) {
        match self.what {
            What::Memory(memory) => {
                // The bits of a group are in the same byte.
                let offset = if matches!(memory.width, Width::Bit(_)) { 0 } else { self.offset };
                out.extend_from_slice(&memory.item(offset, self.length).bytes());
            }
            What::Nc(variable) => {
                let NcVariable { mut item, kind } = variable;
                if let Some(bytes) = kind.map(|kind| kind.bytes().max(1)) {
                    item.line = item.line.saturating_add(u16::try_from(self.offset / bytes).unwrap_or(u16::MAX));
                    item.count = u8::try_from(self.length / bytes).unwrap_or(u8::MAX);
                }
                out.extend_from_slice(&item.bytes());
            }
        }
    }

    /// Whether its value is a bit; its length counts as one.
    pub(super) fn is_bit(&self) -> bool {
        matches!(self.what, What::Memory(Memory { width: Width::Bit(_), .. }))
    }

    /// Whether its value is an octet string: timers, counters, NC variables.
    pub(super) fn is_octets(&self) -> bool {
        match self.what {
            What::Memory(memory) => matches!(memory.area, Area::Timers | Area::Counters),
            What::Nc(_) => true,
        }
    }

    /// Whether an answer may have a value of this length.
    pub(super) fn takes(&self, length: usize) -> bool {
        matches!(self.what, What::Nc(NcVariable { kind: None, .. })) || length == self.length
    }

    const fn wire(&self) -> usize {
        match self.what {
            What::Memory(_) => AnyItem::WIRE,
            What::Nc(_) => NckItem::WIRE,
        }
    }

    /// The size of its elements, between which it may be split; `None` if it cannot be split.
    fn grain(&self) -> Option<usize> {
        match self.what {
            What::Memory(memory) => Some(memory.element()),
            What::Nc(variable) => variable.kind.map(|kind| kind.bytes().max(1)),
        }
    }

    fn split(self, at: usize) -> (Self, Self) {
        let (offset, length) = (self.offset + at, self.length - at);
        (Self { length: at, ..self }, Self { offset, length, ..self })
    }
}

/// A request that is being filled.
#[derive(Debug)]
struct Open {
    purpose: Purpose,
    capacity: Capacity,
    parts: Vec<Part>,
    request: usize,
    answer: usize,
}

impl Open {
    fn new(purpose: Purpose, capacity: Capacity) -> Self {
        let (request, answer) = match purpose {
            Purpose::Read | Purpose::Write => (12, 14),
            Purpose::Subscribe => (26, 28),
        };
        Self { purpose, capacity, parts: Vec::new(), request, answer }
    }

    /// The bytes available for a value after an item of this length; `None` if the item does not fit.
    fn left(&self, wire: usize) -> Option<usize> {
        if self.parts.len() >= self.capacity.items {
            return None;
        }
        let request = self.capacity.pdu.checked_sub(self.request + wire)?;
        let left = match self.purpose {
            Purpose::Read | Purpose::Subscribe => self.capacity.pdu.checked_sub(self.answer + 4)?,
            Purpose::Write => {
                self.capacity.pdu.checked_sub(self.answer + 1)?;
                request.checked_sub(4)?
            }
        };
        Some(left.min(LONGEST_VALUE))
    }

    fn push(&mut self, part: Part) {
        self.request += part.wire();
        let value = 4 + part.length.next_multiple_of(2);
        match self.purpose {
            Purpose::Read | Purpose::Subscribe => self.answer += value,
            Purpose::Write => {
                self.request += value;
                self.answer += 1;
            }
        }
        self.parts.push(part);
    }
}

/// The planned requests, and the parts that do not fit into any request.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Plan {
    pub(super) requests: Vec<Vec<Part>>,
    /// Parts that are too long for a PDU and cannot be split.
    pub(super) too_long: Vec<Part>,
}

/// Fills requests with these parts, in order.
pub(super) fn plan(parts: impl IntoIterator<Item = Part>, purpose: Purpose, capacity: Capacity) -> Plan {
    let mut plan = Plan::default();
    let mut open = Open::new(purpose, capacity);
    for part in parts {
        let mut rest = Some(part);
        while let Some(part) = rest.take() {
            let left = open.left(part.wire());
            let fresh = Open::new(purpose, capacity).left(part.wire()).unwrap_or(0);
            if left.is_some_and(|left| part.length <= left) {
                open.push(part);
                continue;
            }
            // A value that fits into a PDU is not split; a subscribed value never is.
            let may_split = part.length > fresh && purpose != Purpose::Subscribe;
            let most = match part.what {
                What::Memory(_) => usize::MAX,
                What::Nc(_) => usize::from(u8::MAX) * part.grain().unwrap_or(1),
            };
            let piece = |capacity: usize| part.grain().map_or(0, |grain| capacity.min(most) / grain * grain);
            let here = left.map_or(0, piece);
            if may_split && here > 0 {
                let (first, second) = part.split(here);
                open.push(first);
                rest = Some(second);
            } else if part.length > fresh && (!may_split || piece(fresh) == 0) {
                plan.too_long.push(part);
            } else {
                // It does not fit here, but fits into an empty request.
                rest = Some(part);
            }
            if rest.is_some() && !open.parts.is_empty() {
                plan.requests.push(std::mem::replace(&mut open, Open::new(purpose, capacity)).parts);
            }
        }
    }
    if !open.parts.is_empty() {
        plan.requests.push(open.parts);
    }
    plan
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL: Capacity = Capacity { pdu: 240, items: 255 };

    fn lengths(texts: &[&str], purpose: Purpose, capacity: Capacity) -> Vec<Vec<usize>> {
        let parts = texts.iter().enumerate().flat_map(|(of, text)| Part::all(of, &text.parse().unwrap(), purpose));
        let plan = plan(parts, purpose, capacity);
        assert_eq!(plan.too_long, []);
        plan.requests.iter().map(|parts| parts.iter().map(|part| part.length).collect()).collect()
    }

    #[test]
    fn a_pdu_of_240_bytes_reads_222_and_writes_212() {
        // 240 - 12 - 2 - 4 = 222; 240 - 10 - 2 - 12 - 4 = 212.
        assert_eq!(lengths(&["DB1.DBB0..999"], Purpose::Read, SMALL), [[222], [222], [222], [222], [112]]);
        assert_eq!(lengths(&["DB1.DBB0..429"], Purpose::Write, SMALL), [[212], [212], [6]]);
    }

    #[test]
    fn elements_are_never_split() {
        // 55 double words are 220 bytes.
        assert_eq!(lengths(&["DB1.DBD0..236"], Purpose::Read, SMALL), [[220], [20]]);
    }

    #[test]
    fn a_value_that_fits_into_one_pdu_is_not_split() {
        assert_eq!(lengths(&["MB0..149", "MB200..349"], Purpose::Read, SMALL), [[150], [150]]);
    }

    #[test]
    fn a_longer_value_fills_the_remaining_space() {
        // After 100 bytes: 240 - 14 - 104 - 4 = 118.
        assert_eq!(lengths(&["MB0..99", "DB1.DBB0..299"], Purpose::Read, SMALL), [vec![100, 118], vec![182]]);
    }

    #[test]
    fn a_read_request_of_240_bytes_has_19_items() {
        // (240 - 12) / 12 = 19, and their answers of 6 bytes each take 14 + 19 * 6 = 128 of 240.
        let many: Vec<String> = (0..40).map(|byte| format!("MB{byte}")).collect();
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        let counts: Vec<usize> = lengths(&many, Purpose::Read, SMALL).iter().map(Vec::len).collect();
        assert_eq!(counts, [19, 19, 2]);
        // (240 - 12 - 18 + 1) / 18: twelve complete items of 12 + 4 + 2 bytes, the last one without its fill byte.
        let counts: Vec<usize> = lengths(&many, Purpose::Write, SMALL).iter().map(Vec::len).collect();
        assert_eq!(counts, [12, 12, 12, 4]);
        let counts: Vec<usize> =
            lengths(&many, Purpose::Write, Capacity { pdu: 960, items: 20 }).iter().map(Vec::len).collect();
        assert_eq!(counts, [20, 20]);
    }

    #[test]
    fn rows_of_the_nck_are_split_between_rows() {
        // 27 numbers of 8 bytes are 216 of 222 bytes.
        assert_eq!(lengths(&["nck:C/SMA/actToolBasePos[1..31]"], Purpose::Read, SMALL), [[216], [32]]);
        let part = plan(
            Part::all(0, &"nck:C/SMA/actToolBasePos[1..31]".parse().unwrap(), Purpose::Read),
            Purpose::Read,
            SMALL,
        )
        .requests[1][0];
        let mut wire = Vec::new();
        part.put_item(&mut wire);
        assert_eq!(wire, [0x12, 8, 0x82, 0x41, 0, 2, 0, 28, 0x74, 4]);
    }

    #[test]
    fn a_value_that_is_too_long_and_cannot_be_split_is_reported() {
        let variable = "DB1.DBB0..299".parse().unwrap();
        let plan = plan(Part::all(0, &variable, Purpose::Subscribe), Purpose::Subscribe, SMALL);
        assert_eq!((plan.requests.len(), plan.too_long.len()), (0, 1));
    }

    #[test]
    fn bits_of_a_group_are_written_one_by_one() {
        let parts = Part::all(0, &"DB10.DBX100.1..3".parse().unwrap(), Purpose::Write);
        let mut wire = Vec::new();
        parts.iter().for_each(|part| part.put_item(&mut wire));
        // 100 * 8 + 1 = 801 = 0321
        let item = |bit| [0x12, 10, 0x10, 1, 0, 1, 0, 10, 0x84, 0, 3, bit];
        assert_eq!(wire, [item(0x21), item(0x22), item(0x23)].concat());
    }
}
