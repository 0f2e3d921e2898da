//! Read and write variables. Each item succeeds or is refused separately. All items of a write request are checked first and then executed
//! together. If the answer would be longer than the negotiated PDU, the request is refused as a wrong frame, as by a module. An item that
//! reaches beyond its area does not count for that length: it is refused separately with `05`.
//!
//! A choice: a read request without items, even without their number, is answered with no items. python-snap7 3 takes any answer to it for
//! the state RUN and for a sign of life, and a refusal for a lost connection.

use arrayvec::ArrayVec;

use super::Session;
use super::exchange::Exchange;
use super::values::{budget_of, put_values};
use crate::s7::station::{Station, Write, WrittenValue};
use crate::s7::wire::data::{Refusal, SUCCESS, TransportSize, Type, Values};
use crate::s7::wire::header::{ErrorCode, function};
use crate::s7::wire::items::{AnyItem, Item, Items};
use crate::s7::wire::pdu::Pdu;

/// The slots of the NCK: 3 on the powerline, 4 on the solution line.
const NCK_SLOTS: [u8; 2] = [3, 4];

impl Session {
    pub(super) fn read_variables(&mut self, rest: &[u8], exchange: &mut Exchange<'_>) {
        let (count, bytes) = rest.split_first().map_or((0, rest), |(&count, bytes)| (count, bytes));
        let mut items = ArrayVec::<Item, 255>::new();
        for item in Items::new(bytes, count.into()) {
            let Ok(item) = item else {
                return exchange.refuse(ErrorCode::WRONG_FRAME);
            };
            items.push(item);
        }
        let items = items.iter().copied();
        if let Err(error) = self.may_ask_for(items.clone()) {
            return exchange.refuse(error);
        }
        let budget = budget_of(items.clone(), exchange.budget);
        let mut pdu = Pdu::ack_data(exchange.answers, exchange.reference, budget);
        pdu.put(&[function::READ, count]);
        pdu.data();
        put_values(&mut pdu, items, &mut self.scratch, exchange.station);
        pdu.finish();
    }

    /// Whether the called module has the items: variables of the NCK must be requested from the NCK.
    pub(super) fn may_ask_for(&self, mut items: impl Iterator<Item = Item>) -> Result<(), ErrorCode> {
        let is_of_nck = items.any(|item| matches!(item, Item::Nck(_)));
        if is_of_nck && !NCK_SLOTS.contains(&self.slot) { Err(ErrorCode::NOT_IMPLEMENTED) } else { Ok(()) }
    }

    pub(super) fn write_variables(&self, rest: &[u8], data: &[u8], exchange: &mut Exchange<'_>) {
        let Some((&count, bytes)) = rest.split_first().filter(|(count, _)| **count > 0) else {
            return exchange.refuse(ErrorCode::WRONG_FRAME);
        };
        let items = Items::new(bytes, count.into());
        if let Err(error) = self.may_ask_for(items.flatten()) {
            return exchange.refuse(error);
        }
        let Some(values) = Values::new(data, count.into()) else {
            return exchange.refuse(ErrorCode::WRONG_FRAME);
        };
        let mut codes = ArrayVec::<u8, 255>::new();
        let mut writes = ArrayVec::<Write<'_>, 255>::new();
        for (item, (size, value)) in items.zip(values) {
            let Ok(item) = item else {
                return exchange.refuse(ErrorCode::WRONG_FRAME);
            };
            codes.push(match accepted(&item, size, value, exchange.station) {
                Ok(write) => {
                    writes.push(write);
                    SUCCESS
                }
                Err(refusal) => refusal.code(),
            });
        }
        if !writes.is_empty() {
            exchange.station.write(&writes);
        }
        let mut pdu = Pdu::ack_data(exchange.answers, exchange.reference, exchange.budget);
        pdu.put(&[function::WRITE, count]);
        pdu.data();
        pdu.put(&codes);
        pdu.finish();
    }
}

/// The write of an item, if it is allowed.
fn accepted<'a>(
    item: &Item,
    size: TransportSize,
    value: &'a [u8],
    station: &dyn Station,
) -> Result<Write<'a>, Refusal> {
    let is_bit = matches!(item, Item::Any(AnyItem { kind: Type::Bit, .. }));
    // Clients use 04 or 09 for values of many types, but 03 only for bits.
    if !matches!(size.0, 3..=7 | 9) || size == TransportSize::BIT && !is_bit {
        return Err(match item {
            Item::Refused(refusal) => *refusal,
            Item::Any(_) | Item::Nck(_) | Item::Drive(_) => Refusal::TypeInconsistent,
        });
    }
    match item {
        Item::Any(item) => {
            if item.count == 0 {
                return Err(Refusal::OutOfRange);
            }
            if value.len() != item.length() {
                return Err(Refusal::TypeInconsistent);
            }
            station.may_write(item.area, item.byte, item.span())?;
            let value = match (item.kind, value) {
                (Type::Bit, [value]) => WrittenValue::Bit { bit: item.bit, value: value & 1 == 1 },
                _ => WrittenValue::Bytes { bytes: value, element: item.kind.bytes() },
            };
            Ok(Write::Area { area: item.area, byte: item.byte, value })
        }
        Item::Nck(item) => {
            station.may_write_variable(item, value)?;
            Ok(Write::Variable { item: *item, bytes: value })
        }
        Item::Drive(_) => Err(Refusal::NotAllowed), // the known drive values are measured values
        Item::Refused(refusal) => Err(*refusal),
    }
}
