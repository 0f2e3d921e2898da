//! Blocks: their number by type, a list, and the description of a block. Only data blocks exist.
//!
//! Choice: a type without blocks has an empty list, as in python-snap7's server, and not the error `D20E`, as in snap7's server. A real CPU
//! has blocks of all types. Clients that list one type after another (Node-RED) therefore treat one refusal as a failure of all.

use super::Session;
use super::exchange::Exchange;
use crate::s7::station::{BlockInfo, Station};
use crate::s7::wire::header::ErrorCode;
use crate::s7::wire::user_data::{Head, Request};

/// Block types in the order of the answer: OB, DB, SDB, FC, SFC, FB, SFB.
const TYPES: [u8; 7] = *b"8ABCDEF";
pub(super) const DATA_BLOCK: u8 = b'A';

/// Language of a data block.
const LANGUAGE: u8 = 5;
/// Block type inside the header of a block.
const INNER_TYPE: u8 = 0x0A;
/// Length of the header of a block in load memory.
pub(super) const HEAD: usize = 36;
/// Length of the trailer after its bytes.
pub(super) const FOOT: usize = 36;

impl Session {
    pub(super) fn count_blocks(&mut self, request: &Request<'_>, exchange: &mut Exchange<'_>) -> Result<(), ErrorCode> {
        let count = u16::try_from(exchange.station.data_blocks().len()).unwrap_or(u16::MAX);
        let mut payload = [0; 4 * TYPES.len()];
        for (entry, kind) in payload.chunks_mut(4).zip(TYPES) {
            let count = if kind == DATA_BLOCK { count } else { 0 };
            entry[..2].copy_from_slice(&[b'0', kind]);
            entry[2..].copy_from_slice(&count.to_be_bytes());
        }
        let head = Head::answer(request, self.next_sequence());
        head.send(exchange.answers, exchange.reference, exchange.budget, &payload);
        Ok(())
    }

    pub(super) fn list_blocks(&mut self, request: &Request<'_>, exchange: &mut Exchange<'_>) -> Result<(), ErrorCode> {
        let &[b'0', kind] = request.payload else {
            return Err(ErrorCode::FUNCTION_PARAMETERS);
        };
        let blocks = exchange.station.data_blocks();
        if !TYPES.contains(&kind) {
            return Err(ErrorCode::NO_BLOCK);
        }
        // A type without blocks has an empty list: clients that list one type after another stop at the first refusal.
        let blocks = if kind == DATA_BLOCK { blocks } else { &[] };
        let entry = |block: &BlockInfo| {
            let [high, low] = block.number.to_be_bytes();
            [high, low, 0x22, LANGUAGE]
        };
        let payload = blocks.iter().flat_map(entry).collect();
        self.send_in_parts(request, exchange, payload);
        Ok(())
    }

    pub(super) fn describe_block(
        &mut self,
        request: &Request<'_>,
        exchange: &mut Exchange<'_>,
    ) -> Result<(), ErrorCode> {
        let block = named(request.payload, exchange.station)?;
        let mut payload = vec![b'0', DATA_BLOCK, 0, 0x4A, 0, 0];
        payload.extend_from_slice(&head(block));
        payload.extend_from_slice(&signature());
        // Version 0.1, no checksum.
        payload.extend_from_slice(&[1, 0, 0, 0]);
        payload.resize(78, 0);
        let head = Head::answer(request, self.next_sequence());
        head.send(exchange.answers, exchange.reference, exchange.budget, &payload);
        Ok(())
    }
}

/// The block with a name such as `0A00031A`: type, number in five digits, file system.
pub(super) fn named(name: &[u8], station: &dyn Station) -> Result<BlockInfo, ErrorCode> {
    let [b'0', kind, digits @ .., b'A' | b'B' | b'P'] = name else {
        return Err(ErrorCode::BLOCK_NAME);
    };
    if digits.len() != 5 || !digits.iter().all(u8::is_ascii_digit) || !TYPES.contains(kind) {
        return Err(ErrorCode::BLOCK_NAME);
    }
    let number = digits.iter().fold(0_u32, |number, digit| number * 10 + u32::from(digit - b'0'));
    let blocks = station.data_blocks();
    let at = blocks.binary_search_by_key(&number, |block| block.number.into());
    match at {
        Ok(at) if *kind == DATA_BLOCK => Ok(blocks[at]),
        _ => Err(ErrorCode::BLOCK_NOT_FOUND),
    }
}

/// The header of a block in load memory: `pp`, flags, language, type, number, lengths, and times (not modelled).
pub(super) fn head(block: BlockInfo) -> [u8; HEAD] {
    let mut head = [0; HEAD];
    let in_load_memory = u32::try_from(HEAD + FOOT).unwrap_or(0) + u32::from(block.length);
    head[..6].copy_from_slice(&[b'p', b'p', 1, 1, LANGUAGE, INNER_TYPE]);
    head[6..8].copy_from_slice(&block.number.to_be_bytes());
    head[8..12].copy_from_slice(&in_load_memory.to_be_bytes());
    head[34..36].copy_from_slice(&block.length.to_be_bytes());
    head
}

/// Author, family and name, eight characters each.
pub(super) fn signature() -> [u8; 24] {
    *b"OpenNCK \0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0"
}
