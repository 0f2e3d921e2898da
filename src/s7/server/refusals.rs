//! The refusals in an answer, and the request as text: for the log and the counters.

use std::fmt::{self, Write};

use crate::image::Area;
use crate::s7::wire::codes;
use crate::s7::wire::cotp::Tpdu;
use crate::s7::wire::data::{SUCCESS, Type, Values};
use crate::s7::wire::header::{ErrorCode, Message, function, kind};
use crate::s7::wire::items::{Item, Items, NckItem};
use crate::s7::wire::tpkt::{self, Packet};
use crate::s7::wire::user_data::{self, Received, group};

/// A refusal in an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Refused {
    /// The return code of an item.
    Item(u8),
    /// The error of a whole request.
    Request(u16),
}

impl fmt::Display for Refused {
    /// In the notation of the manuals, `0A` or `8104`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Item(code) => write!(f, "{code:02X}"),
            Self::Request(error) => write!(f, "{error:04X}"),
        }
    }
}

impl Refused {
    /// The meaning of the code.
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::Item(code) => codes::of_item(code),
            Self::Request(error) => codes::of_request(ErrorCode(error)),
        }
    }
}

/// The refusals in an answer: the index of the item, from 0, and its return code; or the error of the whole request.
pub(super) fn refusals(answer: &[u8], mut each: impl FnMut(usize, Refused)) {
    match answer.get(tpkt::HEADER + 3..) {
        Some(&[0x32, kind::ACK | kind::ACK_DATA, _, _, _, _, _, _, _, _, class, code, ..])
            if (class, code) != (0, 0) =>
        {
            each(0, Refused::Request(u16::from_be_bytes([class, code])));
        }
        Some(&[0x32, kind::ACK_DATA, _, _, _, _, _, _, _, _, 0, 0, function::READ, count, ref data @ ..]) => {
            let mut rest = data;
            for index in 0..usize::from(count) {
                let [code, size, high, low, values @ ..] = rest else { return };
                let length = match (*code, size) {
                    (SUCCESS, 3..=5) => usize::from(u16::from_be_bytes([*high, *low])).div_ceil(8),
                    (SUCCESS, _) => usize::from(u16::from_be_bytes([*high, *low])),
                    _ => {
                        each(index, Refused::Item(*code));
                        0
                    }
                };
                let Some(next) = values.get(length + length % 2..) else { return };
                rest = next;
            }
        }
        Some([0x32, kind::ACK_DATA, _, _, _, _, _, _, _, _, 0, 0, function::WRITE, _, codes @ ..]) => {
            for (index, code) in codes.iter().enumerate().filter(|(_, code)| **code != SUCCESS) {
                each(index, Refused::Item(*code));
            }
        }
        // An answer of user data has its error at the end of its parameters.
        Some(&[0x32, kind::USER_DATA, _, _, _, _, 0, 12, _, _, _, _, _, _, _, _, _, _, _, _, class, code, ..])
            if (class, code) != (0, 0) =>
        {
            each(0, Refused::Request(u16::from_be_bytes([class, code])));
        }
        _ => {}
    }
}

/// The request in a packet as text: the function, and the item with this index.
pub(super) fn asked(packet: &[u8], item: usize) -> String {
    let Packet::Whole { content, .. } = tpkt::split(packet) else { return "a request".to_owned() };
    let Tpdu::Data { piece, last: true } = Tpdu::parse(content) else { return "a request in pieces".to_owned() };
    let Ok(message) = Message::parse(piece) else { return "a request".to_owned() };
    match (message.kind, message.parameter) {
        (kind::JOB, [code @ (function::READ | function::WRITE), count, items @ ..]) => {
            let what = if *code == function::READ { "read" } else { "write" };
            match Items::new(items, (*count).into()).nth(item) {
                Some(Ok(item)) => format!("{what} {}", named(&item)),
                _ => what.to_owned(),
            }
        }
        (kind::JOB, [code, ..]) => match *code {
            function::SETUP => "set up communication".to_owned(),
            function::REQUEST_DOWNLOAD | function::DOWNLOAD | function::END_DOWNLOAD => "load a block".to_owned(),
            function::START_UPLOAD | function::UPLOAD | function::END_UPLOAD => "upload a block".to_owned(),
            function::START => "start, or a service by name".to_owned(),
            function::STOP => "stop the PLC".to_owned(),
            code => format!("function {code:02X}"),
        },
        (kind::USER_DATA, parameter) => match user_data::parse(parameter, message.data) {
            Received::Request(request) => {
                let about = match request.group {
                    group::PROGRAMMER => "programming device",
                    group::CYCLIC => "cyclic data",
                    group::BLOCKS => "blocks",
                    group::CPU => "system state lists and messages",
                    group::SECURITY => "password",
                    group::TIME => "clock",
                    _ => "unknown group",
                };
                format!("{about}, function {}", request.function)
            }
            Received::Answer | Received::Malformed => "user data".to_owned(),
        },
        (kind, _) => format!("a message of kind {kind}"),
    }
}

/// The values written by a packet, item by item, in hexadecimal.
pub(super) fn written(packet: &[u8]) -> Option<String> {
    /// The number of bytes shown of a value.
    const SHOWN: usize = 16;
    let Packet::Whole { content, .. } = tpkt::split(packet) else { return None };
    let Tpdu::Data { piece, last: true } = Tpdu::parse(content) else { return None };
    let message = Message::parse(piece).ok()?;
    let (kind::JOB, [function::WRITE, count, items @ ..]) = (message.kind, message.parameter) else { return None };
    let items = Items::new(items, (*count).into());
    let mut text = String::new();
    for (item, (_, value)) in items.zip(Values::new(message.data, (*count).into())?) {
        let _ = write!(text, "{}{} =", if text.is_empty() { "" } else { ", " }, named(&item.ok()?));
        for byte in value.iter().take(SHOWN) {
            let _ = write!(text, " {byte:02X}");
        }
        if value.len() > SHOWN {
            text += " ...";
        }
    }
    Some(text)
}

fn named(item: &Item) -> String {
    match item {
        Item::Any(any) => {
            let (area, byte) = (any.area, any.byte);
            let before = match area {
                Area::DataBlock(_) => format!("{area}.DB"),
                Area::Timers | Area::Counters if any.count == 1 => return format!("{area}{}", byte / 2),
                Area::Timers | Area::Counters => return format!("{area}{}, {} of them", byte / 2, any.count),
                Area::Inputs | Area::Outputs | Area::Flags => area.to_string(),
            };
            match (any.kind, any.length()) {
                (Type::Bit, _) if matches!(area, Area::DataBlock(_)) => format!("{before}X{byte}.{}", any.bit),
                (Type::Bit, _) => format!("{before}{byte}.{}", any.bit),
                (_, 1) => format!("{before}B{byte}"),
                (_, length) => format!("{before}B{byte}, {length} bytes"),
            }
        }
        Item::Nck(NckItem { area, unit, column, line, module, .. }) => {
            format!("NC variable of area {area}, unit {unit}, module {module:02X}, column {column}, line {line}")
        }
        Item::Drive(drive) => format!("parameter {} of drive object {}", drive.parameter, drive.object),
        Item::Refused(_) => "an item of another kind".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A PDU in one packet.
    fn packet(pdu: &[u8]) -> Vec<u8> {
        let mut packet = Vec::new();
        tpkt::put(&mut packet, [&[2, 0xF0, 0x80], pdu]);
        packet
    }

    fn found(pdu: &[u8]) -> Vec<(usize, Refused)> {
        let mut found = Vec::new();
        refusals(&packet(pdu), |index, refused| found.push((index, refused)));
        found
    }

    #[test]
    fn every_refused_item_and_every_error_is_found() {
        let head = |parameter, data| [0x32, 3, 0, 0, 0, 1, 0, parameter, 0, data, 0, 0];
        // Three items: a byte with its fill byte, a refused item, a word.
        let read = [0xFF, 4, 0, 8, 7, 0, 0x0A, 0, 0, 0, 0xFF, 4, 0, 16, 1, 2];
        let answer = [&head(2, 16)[..], &[4, 3], &read].concat();
        assert_eq!(found(&answer), [(1, Refused::Item(0x0A))]);
        for end in 0..answer.len() {
            found(&answer[..end]); // an incomplete answer must not panic
        }
        let answer = [&head(2, 3)[..], &[5, 3, 3, 0xFF, 5]].concat();
        assert_eq!(found(&answer), [(0, Refused::Item(3)), (2, Refused::Item(5))]);
        assert_eq!(found(&[0x32, 2, 0, 0, 0, 1, 0, 0, 0, 0, 0x81, 4]), [(0, Refused::Request(0x8104))]);
        let list = [0x32, 7, 0, 0, 0, 1, 0, 12, 0, 4, 0, 1, 0x12, 8, 0x12, 0x84, 1, 1, 0, 0, 0xD4, 1, 0x0A, 0, 0, 0];
        assert_eq!(found(&list), [(0, Refused::Request(0xD401))]);
        assert_eq!(Refused::Request(0xD401).meaning(), "the list does not exist");
    }

    #[test]
    fn a_request_is_described_by_addresses() {
        let item = |kind, count, block, area, bits: u32| {
            let [_, high, middle, low] = bits.to_be_bytes();
            [0x12, 10, 0x10, kind, 0, count, 0, block, area, high, middle, low]
        };
        let request = |function, items: &[[u8; 12]], data: &[u8]| {
            let (count, length) = (u8::try_from(items.len()).unwrap(), u8::try_from(data.len()).unwrap());
            let head = [0x32, 1, 0, 0, 0, 1, 0, 2 + 12 * count, 0, length, function, count];
            packet(&[&head[..], &items.concat(), data].concat())
        };
        let items = [item(2, 10, 99, 0x84, 4 * 8), item(1, 1, 0, 0x83, 10 * 8 + 3), item(0x1D, 1, 0, 0x1D, 5)];
        let read = request(4, &items, &[]);
        assert_eq!(asked(&read, 0), "read DB99.DBB4, 10 bytes");
        assert_eq!(asked(&read, 1), "read M10.3");
        assert_eq!(asked(&read, 2), "read T5");
        let write = request(5, &[item(1, 1, 32, 0x84, 4 * 8 + 7)], &[0, 3, 0, 1, 1]);
        assert_eq!(written(&write).unwrap(), "DB32.DBX4.7 = 01");
        assert_eq!(asked(&packet(&[0x32, 1, 0, 0, 0, 1, 0, 1, 0, 0, 0x29]), 0), "stop the PLC");
    }
}
