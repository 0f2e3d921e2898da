//! Values of variables in an answer: each item succeeds or is refused by itself.

use crate::s7::station::Station;
use crate::s7::wire::data::{Refusal, SUCCESS, TransportSize, Type};
use crate::s7::wire::items::{AnyItem, Item};
use crate::s7::wire::pdu::{Budget, Pdu};

/// An answer with values of drives is never longer, whatever was agreed.
const DRIVE_PDU: usize = 240;

/// How long an answer to these items may be.
pub(super) fn budget_of(mut items: impl Iterator<Item = Item>, budget: Budget) -> Budget {
    let is_of_drive = items.any(|item| matches!(item, Item::Nck(item) if item.is_of_drive()));
    if is_of_drive { Budget { pdu: budget.pdu.min(DRIVE_PDU), ..budget } } else { budget }
}

/// Appends the value of each item, or why there is none. Items that do not fit leave the PDU full.
pub(super) fn put_values(
    pdu: &mut Pdu<'_>,
    items: impl Iterator<Item = Item>,
    scratch: &mut Vec<u8>,
    station: &dyn Station,
) {
    // Values begin at even places: what stands before them in a data part, if anything, has an even length.
    for item in items {
        if pdu.is_full() {
            return;
        }
        if pdu.data_length() % 2 == 1 {
            pdu.put(&[0]);
        }
        let start = pdu.data_length();
        let put = match item {
            Item::Any(item) => put_area(pdu, &item, station),
            Item::Nck(item) => {
                scratch.clear();
                station.read_variable(&item, scratch).map(|()| put_octets(pdu, scratch))
            }
            Item::Drive(item) => {
                scratch.clear();
                station.read_drive(&item, scratch).map(|()| put_octets(pdu, scratch))
            }
            Item::Refused(refusal) => Err(refusal),
        };
        if let Err(refusal) = put {
            pdu.truncate_data(start);
            pdu.put(&[refusal.code(), TransportSize::NULL.0, 0, 0]);
        }
    }
}

fn put_head(pdu: &mut Pdu<'_>, size: TransportSize, bytes: usize) {
    let [high, low] = size.field(bytes).to_be_bytes();
    pdu.put(&[SUCCESS, size.0, high, low]);
}

fn put_octets(pdu: &mut Pdu<'_>, bytes: &[u8]) {
    put_head(pdu, TransportSize::OCTETS, bytes.len());
    pdu.put(bytes);
}

fn put_area(pdu: &mut Pdu<'_>, item: &AnyItem, station: &dyn Station) -> Result<(), Refusal> {
    if item.count == 0 {
        return Err(Refusal::OutOfRange);
    }
    let length = item.length();
    if length + 4 > pdu.room() {
        // Whether it is there at all comes first, and only then that it does not fit.
        station.may_read(item.area, item.byte, item.span())?;
    }
    put_head(pdu, item.kind.answered_as(), length);
    let Some(space) = pdu.space(length) else {
        return Ok(()); // the answer is full
    };
    station.read(item.area, item.byte, space)?;
    if let (Type::Bit, [byte]) = (item.kind, space) {
        *byte = *byte >> item.bit & 1;
    }
    Ok(())
}
