//! Upload of data blocks, from the module to the client: start, as many pieces as needed, end. The upload contains the block as it was at
//! the start: header, bytes, trailer.
//!
//! ```text
//! 1D  00 00 00  00 00 00 00  09 _0A00031A     start     ->  1D  00 01 00  00 00 00 01  07 0000220
//! 1E  00 00 00  00 00 00 01                   piece     ->  1E  01 more, 00 last; data: length, 00 FB, bytes
//! 1F  00 00 00  00 00 00 01                   end       ->  1F
//! ```

use super::Session;
use super::blocks::{FOOT, HEAD, head, named, signature};
use super::exchange::Exchange;
use super::pending::Upload;
use crate::s7::wire::header::{ErrorCode, function};
use crate::s7::wire::pdu::Pdu;

/// Maximum number of parallel uploads per client.
const AT_ONCE: usize = 4;

impl Session {
    pub(super) fn start_upload(&mut self, rest: &[u8], exchange: &mut Exchange<'_>) {
        let Some((name, [])) = rest.get(7..).and_then(|rest| {
            let (length, rest) = rest.split_first()?;
            rest.split_at_checked(usize::from(*length))
        }) else {
            return exchange.refuse(ErrorCode::WRONG_FRAME);
        };
        if let Err(error) = self.permit(3, exchange) {
            return exchange.refuse(error);
        }
        let block = name.strip_prefix(b"_").ok_or(ErrorCode::BLOCK_NAME);
        let block = match block.and_then(|name| named(name, exchange.station)) {
            Ok(block) => block,
            Err(error) => return exchange.refuse(error),
        };
        if self.uploads.open.len() >= AT_ONCE {
            return exchange.refuse(ErrorCode::NO_FURTHER_UPLOAD);
        }
        let length = usize::from(block.length);
        let mut content = vec![0; HEAD + length + FOOT];
        content[..HEAD].copy_from_slice(&head(block));
        exchange.station.read_block(block.number, &mut content[HEAD..HEAD + length]);
        content[HEAD + length..][..24].copy_from_slice(&signature());
        let uploads = &mut self.uploads;
        uploads.last = uploads.last.checked_add(1).unwrap_or(1);
        let number = uploads.last;
        let mut pdu = Pdu::ack_data(exchange.answers, exchange.reference, exchange.budget);
        pdu.put(&[function::START_UPLOAD, 0, 1, 0, 0, 0, 0, number, 7]);
        pdu.put(format!("{:07}", content.len()).as_bytes());
        pdu.finish();
        uploads.open.push(Upload { number, content, sent: 0 });
    }

    pub(super) fn upload(&mut self, rest: &[u8], exchange: &mut Exchange<'_>) {
        let Some(upload) = number(rest).and_then(|number| self.uploads.find(number)) else {
            return exchange.refuse(ErrorCode::WRONG_SEQUENCE);
        };
        let left = &upload.content[upload.sent..];
        if left.is_empty() {
            return exchange.refuse(ErrorCode::WRONG_SEQUENCE); // the last piece was marked as the last
        }
        let mut pdu = Pdu::ack_data(exchange.answers, exchange.reference, exchange.budget);
        let piece = &left[..left.len().min(pdu.room().saturating_sub(6))];
        pdu.put(&[function::UPLOAD, u8::from(piece.len() < left.len())]);
        pdu.data();
        let [high, low] = u16::try_from(piece.len()).unwrap_or(0).to_be_bytes();
        pdu.put(&[high, low, 0, 0xFB]);
        pdu.put(piece);
        pdu.finish();
        upload.sent += piece.len();
    }

    pub(super) fn end_upload(&mut self, rest: &[u8], exchange: &mut Exchange<'_>) {
        let Some(number) = number(rest).filter(|number| self.uploads.find(*number).is_some()) else {
            return exchange.refuse(ErrorCode::WRONG_SEQUENCE);
        };
        self.uploads.open.retain(|upload| upload.number != number);
        let mut pdu = Pdu::ack_data(exchange.answers, exchange.reference, exchange.budget);
        pdu.put(&[function::END_UPLOAD]);
        pdu.finish();
    }
}

fn number(rest: &[u8]) -> Option<u8> {
    match rest {
        [_, _, _, 0, 0, 0, number] => Some(*number),
        _ => None,
    }
}
