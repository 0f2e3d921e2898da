//! The values of variables in an answer. Each item succeeds or is refused separately.

use crate::s7::station::Station;
use crate::s7::wire::data::{Refusal, SUCCESS, TransportSize, Type};
use crate::s7::wire::items::{AnyItem, Item};
use crate::s7::wire::pdu::{Budget, Pdu};

/// Maximum length of an answer with drive values, whatever PDU size was negotiated.
const DRIVE_PDU: usize = 240;

/// The maximum length of the answer to these items.
pub(super) fn budget_of(mut items: impl Iterator<Item = Item>, budget: Budget) -> Budget {
    let is_of_drive = items.any(|item| matches!(item, Item::Nck(item) if item.is_of_drive()));
    if is_of_drive { Budget { pdu: budget.pdu.min(DRIVE_PDU), ..budget } } else { budget }
}

/// Appends the value of each item, or the code of its refusal. Items that do not fit mark the PDU as full.
pub(super) fn put_values(
    pdu: &mut Pdu<'_>,
    items: impl Iterator<Item = Item>,
    scratch: &mut Vec<u8>,
    station: &dyn Station,
) {
    // Values begin at even offsets: the bytes before them in the data part, if any, have an even length.
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
        // First check whether the range exists, then whether it fits.
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
