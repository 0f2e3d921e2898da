//! The oracle: it decodes the requests and answers with its own readers, according to RFC 1006, ISO 8073 and the dissector of Wireshark,
//! and rejects an answer that a module would not give. It shares no code with the server.
//!
//! | rule | meaning |
//! |---|---|
//! | framing | answers are complete packets: number 0, one end mark, no piece longer than the agreed TPDU |
//! | budget | no PDU is longer than negotiated |
//! | one for one | each request has one answer with its reference, its function, its count of items; there are no other answers |
//! | items | values begin at even offsets, end with the PDU, and have the requested length |
//! | memory | flags and user blocks are read as they are at this step, and written as requested, at the next |
//! | refusals | a refused request changes nothing |

use std::collections::VecDeque;

/// The longest request that a server reassembles.
const LONGEST_REQUEST: usize = 4096;

/// The memory that the oracle knows: flags and some data blocks, by number; flags are block 0.
pub type Shadow = Vec<(u16, Vec<u8>)>;

/// The expected reaction to a packet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Expected {
    /// No answer, and the connection continues.
    Silence,
    /// The end of the connection without an answer.
    End,
    /// A connection confirm with this destination reference, or the end.
    Confirm([u8; 2]),
    /// A disconnect confirm or nothing, and the end.
    Goodbye,
    /// One answer.
    Answer(Request),
}

/// A request that must be answered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Request {
    kind: u8,
    reference: u16,
    parameter: Vec<u8>,
    data: Vec<u8>,
    /// Whether it is valid for its kind.
    is_readable: bool,
}

/// The state of a conversation.
#[derive(Clone, Debug)]
pub struct Listener {
    is_connected: bool,
    is_set_up: bool,
    pieces: Vec<u8>,
    pdu: usize,
    piece: usize,
    /// The memory of this step.
    seen: Shadow,
    /// With the writes that are executed at the next step.
    written: Shadow,
}

fn word(bytes: &[u8], at: usize) -> u16 {
    u16::from_be_bytes([bytes[at], bytes[at + 1]])
}

/// The length of the first packet of a stream: `None` while unknown, an error if it is invalid.
pub fn packet_length(stream: &[u8]) -> Result<Option<usize>, ()> {
    match stream {
        [] => Ok(None),
        [version, ..] if *version != 3 => Err(()),
        [_, _, high, low, ..] => {
            let length = usize::from(u16::from_be_bytes([*high, *low]));
            // A TPDU of 8192 bytes is the longest of class 0; the shortest has a length and a code.
            if (6..=8192 + 4).contains(&length) { Ok(Some(length)) } else { Err(()) }
        }
        _ => Ok(None),
    }
}

impl Listener {
    /// The state before the first byte.
    #[must_use]
    pub fn new(seen: Shadow) -> Self {
        let written = seen.clone();
        Self { is_connected: false, is_set_up: false, pieces: Vec::new(), pdu: 240, piece: 8189, seen, written }
    }

    /// Begins a step: the writes take effect.
    pub fn step(&mut self) -> &Shadow {
        self.seen.clone_from(&self.written);
        &self.seen
    }

    /// Whether setup communication has succeeded.
    #[must_use]
    pub fn is_set_up(&self) -> bool {
        self.is_set_up
    }

    /// The expected reaction to a complete packet.
    pub fn hear(&mut self, packet: &[u8]) -> Expected {
        let indicator = usize::from(packet[4]);
        let Some((header, user_data)) = packet[5..].split_at_checked(indicator) else { return Expected::End };
        match header {
            [0xF0, number, ..] if self.is_connected => self.piece(user_data, number & 0x80 != 0),
            [0xE0..=0xEF, _, _, a, b, _class, parameters @ ..] => self.connection([*a, *b], parameters),
            [0x80, _, _, _, _, ..] => Expected::Goodbye,
            _ => Expected::End,
        }
    }

    fn connection(&mut self, reference: [u8; 2], mut parameters: &[u8]) -> Expected {
        let mut size = 13_u8;
        while let [code, length, rest @ ..] = parameters {
            let Some((value, rest)) = rest.split_at_checked((*length).into()) else { return Expected::End };
            if let (0xC0, [power]) = (*code, value) {
                size = (*power).clamp(7, 13);
            }
            parameters = rest;
        }
        (self.is_connected, self.is_set_up, self.pdu, self.piece) = (true, false, 240, (1 << size) - 3);
        self.pieces.clear();
        Expected::Confirm(reference)
    }

    fn piece(&mut self, piece: &[u8], is_last: bool) -> Expected {
        self.pieces.extend_from_slice(piece);
        if self.pieces.len() > LONGEST_REQUEST {
            return Expected::End;
        }
        // An empty DT is not a request.
        if !is_last || self.pieces.is_empty() {
            return Expected::Silence;
        }
        let pdu = std::mem::take(&mut self.pieces);
        self.pdu(&pdu)
    }

    fn pdu(&mut self, pdu: &[u8]) -> Expected {
        if pdu.len() < 10 || pdu[0] != 0x32 {
            return Expected::End;
        }
        let (kind, reference) = (pdu[1], word(pdu, 4));
        let (parameters, data) = (usize::from(word(pdu, 6)), usize::from(word(pdu, 8)));
        let is_whole = pdu.len() - 10 >= parameters + data;
        let is_readable = is_whole && pdu.len() <= self.pdu;
        let (parameter, data) = if is_readable {
            (pdu[10..10 + parameters].to_vec(), pdu[10 + parameters..][..data].to_vec())
        } else {
            (Vec::new(), Vec::new())
        };
        if matches!(kind, 2 | 3) {
            return Expected::Silence;
        }
        let mut request = Request { kind, reference, parameter, data, is_readable };
        if kind == 7 && is_readable {
            match request.user_data() {
                Some(of_client) if !of_client => return Expected::Silence,
                Some(_) => {}
                None => request.is_readable = false,
            }
        }
        Expected::Answer(request)
    }

    /// Judges the reaction to a packet: the answers, and whether the connection has ended.
    ///
    /// # Panics
    /// The reaction is not the expected one.
    pub fn judge(&mut self, expected: &Expected, answers: &[&[u8]], has_ended: bool) {
        match expected {
            Expected::Silence => assert!(answers.is_empty() && !has_ended, "silence was due: {answers:02X?}"),
            Expected::End => assert!(answers.is_empty() && has_ended, "the end was due: {answers:02X?}"),
            Expected::Goodbye => {
                assert!(has_ended && answers.len() <= 1, "a goodbye was due: {answers:02X?}");
                if let [answer] = answers {
                    assert_eq!(answer[..6], [3, 0, 0, 10, 5, 0xC0]);
                    assert_eq!(answer.len(), 10);
                }
            }
            Expected::Confirm(reference) => {
                let [answer] = answers else { panic!("a connection confirm was due: {answers:02X?}") };
                assert!(!has_ended);
                assert_eq!(packet_length(answer), Ok(Some(answer.len())));
                assert_eq!(usize::from(answer[4]) + 5, answer.len(), "a confirm has no user data");
                assert_eq!((answer[5], &answer[6..8]), (0xD0, &reference[..]));
                assert!(answer[8..10] != [0, 0] && answer[10] == 0, "our reference, class 0: {answer:02X?}");
            }
            Expected::Answer(request) => {
                let [answer] = answers else { panic!("one answer was due to {request:02X?}: {answers:02X?}") };
                assert!(!has_ended, "the connection goes on after {request:02X?}");
                let pdu = self.unpacked(answer);
                self.judge_answer(request, &pdu);
            }
        }
    }

    /// The S7 PDU in the packets of one answer.
    fn unpacked(&self, answer: &[u8]) -> Vec<u8> {
        let (mut rest, mut pdu) = (answer, Vec::new());
        while !rest.is_empty() {
            let length = packet_length(rest).ok().flatten().expect("an answer is made of packets");
            assert!(rest.len() >= length, "an answer ends with a packet: {answer:02X?}");
            let (packet, others) = rest.split_at(length);
            let mark = if others.is_empty() { 0x80 } else { 0 };
            assert_eq!(packet[4..7], [2, 0xF0, mark], "number 0 and one end mark: {answer:02X?}");
            assert!(length - 7 <= self.piece, "a piece of {} bytes, {} agreed", length - 7, self.piece);
            pdu.extend_from_slice(&packet[7..]);
            rest = others;
        }
        assert!(pdu.len() <= self.pdu, "a PDU of {} bytes, {} negotiated", pdu.len(), self.pdu);
        assert!(pdu.len() >= 10 && pdu[0] == 0x32 && pdu[2..4] == [0, 0], "{pdu:02X?}");
        let head = if pdu[1] == 7 { 10 } else { 12 };
        let lengths = usize::from(word(&pdu, 6)) + usize::from(word(&pdu, 8));
        assert_eq!(pdu.len(), head + lengths, "its lengths add up: {pdu:02X?}");
        pdu
    }

    fn judge_answer(&mut self, request: &Request, pdu: &[u8]) {
        assert_eq!(word(pdu, 4), request.reference, "the reference is the request's");
        match pdu[1] {
            2 => {
                assert!(pdu.len() == 12 && word(pdu, 10) != 0, "a refusal has an error and nothing else: {pdu:02X?}");
                assert!(request.kind != 7 || !request.is_readable, "user data are refused with user data: {pdu:02X?}");
            }
            3 => {
                assert_eq!((request.kind, word(pdu, 10)), (1, 0), "{pdu:02X?}");
                let (parameter, data) = pdu[12..].split_at(word(pdu, 6).into());
                assert_eq!(parameter.first(), request.parameter.first(), "the function is the request's");
                assert!(request.is_readable);
                self.judge_job(request, parameter, data);
            }
            7 => {
                assert!(request.kind == 7 && request.is_readable, "{pdu:02X?}");
                let error = judge_user_data(&pdu[10..], request.parameter[5] & 0xF | 0x80, request.parameter[6]);
                assert!(self.is_set_up || error != 0, "nothing is served before the setup");
            }
            kind => panic!("an answer of kind {kind}"),
        }
    }

    fn judge_job(&mut self, request: &Request, parameter: &[u8], data: &[u8]) {
        if parameter[0] == 0xF0 {
            assert!(parameter.len() == 8 && data.is_empty());
            let asked = word(&request.parameter, 6);
            let agreed = word(parameter, 6);
            assert!((240..=960).contains(&agreed) && agreed <= asked.max(240), "{asked} asked, {agreed} agreed");
            assert!(word(parameter, 2) > 0 && word(parameter, 4) > 0);
            (self.pdu, self.is_set_up) = (agreed.into(), true);
            return;
        }
        assert!(self.is_set_up, "nothing is served before the setup");
        match parameter {
            [4, count] => {
                // A read without items is answered without items, also if even their number is missing.
                let (asked, rest) =
                    request.parameter[1..].split_first().map_or((0, &[][..]), |(asked, rest)| (*asked, rest));
                assert_eq!(*count, asked, "one value for each item");
                self.judge_values(&items(rest, asked.into()), data);
            }
            [5, count] => {
                assert_eq!(*count, request.parameter[1], "one return code for each item");
                assert_eq!(data.len(), usize::from(*count));
                let items = items(&request.parameter[2..], (*count).into());
                let values = values(&request.data, items.len());
                for ((item, code), value) in items.iter().zip(data).zip(values) {
                    if *code == 0xFF {
                        item.write(&value, &mut self.written);
                    } else {
                        assert!(is_refusal(*code), "return code {code:02X}");
                    }
                }
            }
            [0x1D, rest @ ..] => assert!(rest.len() == 15 && data.is_empty()),
            [0x1E, more] => {
                assert!(*more <= 1 && data.len() >= 4 && data[2..4] == [0, 0xFB]);
                assert_eq!(usize::from(word(data, 0)), data.len() - 4);
            }
            // A start in RUN and a stop in STOP are acknowledged with 3 and 7.
            [0x1F | 0x28 | 0x29] | [0x28, 3] | [0x29, 7] => assert!(data.is_empty()),
            _ => panic!("an unknown answer: {parameter:02X?}"),
        }
    }

    /// Judges values at even offsets, one for each item, up to the last byte.
    fn judge_values(&self, items: &[Item], mut data: &[u8]) {
        let mut place = 0;
        for item in items {
            if place % 2 == 1 {
                assert_eq!(data[0], 0, "a fill byte");
                data = &data[1..];
                place += 1;
            }
            let (head, rest) = data.split_at(4);
            let field = usize::from(word(head, 2));
            let length = match (head[0], head[1]) {
                (0xFF, 3..=5) => field.div_ceil(8),
                (0xFF, 7 | 9) => field,
                (code, 0) if is_refusal(code) && field == 0 => 0,
                _ => panic!("the head of a value: {head:02X?}"),
            };
            let (value, rest) = rest.split_at(length);
            if head[0] == 0xFF {
                assert_eq!(head[1], item.size(), "the transport size of a value: {head:02X?}");
                item.judge(value, &self.seen);
            }
            place += 4 + length;
            data = rest;
        }
        assert!(data.is_empty(), "bytes after the last value: {data:02X?}");
    }

    /// Judges a push.
    ///
    /// # Panics
    /// It is not a valid push.
    pub fn judge_push(&self, answer: &[u8]) {
        let pdu = self.unpacked(answer);
        assert!(self.is_set_up && pdu[1] == 7, "{pdu:02X?}");
        assert!(matches!(pdu[16], 1 | 5) && pdu[17] != 0, "a job in cycles or on change: {pdu:02X?}");
        assert_eq!(judge_user_data(&pdu[10..], 2, pdu[16]), 0);
    }
}

impl Request {
    /// Whether user data are a request; `None` if they are invalid.
    fn user_data(&self) -> Option<bool> {
        let [0, 1, 0x12, length, _method, kind, _function, _sequence, rest @ ..] = self.parameter.as_slice() else {
            return None;
        };
        if usize::from(*length) != 4 + rest.len() {
            return None;
        }
        match kind >> 4 {
            0 | 4 => {}
            8.. => return Some(false),
            _ => return None,
        }
        let fits = match self.data.as_slice() {
            [] => true,
            [_, size, high, low, payload @ ..] => {
                let field = usize::from(u16::from_be_bytes([*high, *low]));
                let length = if matches!(size, 3..=5) { field.div_ceil(8) } else { field };
                payload.len() >= length
            }
            _ => false,
        };
        fits.then_some(true)
    }
}

/// Judges the two parts of user data, and returns its error.
fn judge_user_data(parts: &[u8], kind_group: u8, function: u8) -> u16 {
    let (parameter, data) = parts.split_at(12);
    assert_eq!(parameter[..5], [0, 1, 0x12, 8, 0x12], "{parts:02X?}");
    assert_eq!((parameter[5], parameter[6]), (kind_group, function), "group and function are the request's");
    assert!(parameter[9] <= 1, "last part or not");
    assert_eq!(usize::from(word(data, 2)), data.len() - 4, "the length of the item: {parts:02X?}");
    let error = word(parameter, 10);
    assert!(if error == 0 { matches!(data[0], 0xFF | 0x0A) } else { data == [0x0A, 0, 0, 0] }, "{parts:02X?}");
    error
}

fn is_refusal(code: u8) -> bool {
    matches!(code, 3 | 5 | 6 | 7 | 0x0A)
}

/// An item of a request, as its bytes after the length.
struct Item(Vec<u8>);

fn items(bytes: &[u8], count: usize) -> Vec<Item> {
    let (mut rest, mut items) = (bytes, Vec::new());
    for index in 0..count {
        let length = usize::from(rest[1]);
        items.push(Item(rest[2..2 + length].to_vec()));
        let fill = usize::from(length % 2 == 1 && index + 1 < count);
        rest = &rest[(2 + length + fill).min(rest.len())..];
    }
    items
}

/// The values of a write, with or without fill bytes.
fn values(data: &[u8], count: usize) -> Vec<Vec<u8>> {
    let read = |fills: bool| -> Option<Vec<Vec<u8>>> {
        let (mut rest, mut values) = (VecDeque::from(data.to_vec()), Vec::new());
        for index in 0..count {
            let head: Vec<u8> = (0..4).map_while(|_| rest.pop_front()).collect();
            let field = usize::from(word(head.get(..4)?, 2));
            let length = if matches!(head[1], 3..=5) { field.div_ceil(8) } else { field };
            if rest.len() < length {
                return None;
            }
            values.push(rest.drain(..length).collect::<Vec<u8>>());
            if fills && length % 2 == 1 && index + 1 < count {
                rest.pop_front()?;
            }
        }
        let may_fill = values.last().is_some_and(|value| value.len() % 2 == 1);
        (rest.is_empty() || rest.len() == 1 && may_fill).then_some(values)
    };
    read(true).or_else(|| read(false)).expect("what was accepted can be read")
}

impl Item {
    /// Block (flags are 0), address, type code and count, if the oracle knows the memory.
    fn known(&self) -> Option<(u16, usize, u8, usize)> {
        let [0x10, kind, c1, c0, d1, d0, area, a2, a1, a0] = *self.0.as_slice() else { return None };
        let block = match area {
            0x83 => 0,
            0x84 if [d1, d0] != [0, 0] => u16::from_be_bytes([d1, d0]),
            _ => return None,
        };
        let address = usize::from(a2) << 16 | usize::from(a1) << 8 | usize::from(a0);
        Some((block, address, kind, u16::from_be_bytes([c1, c0]).into()))
    }

    /// Length of the value of an item of syntax 10.
    fn length(&self) -> Option<usize> {
        let [0x10, kind, c1, c0, ..] = *self.0.as_slice() else { return None };
        let each = match kind {
            1..=3 => 1,
            4 | 5 | 9 | 0xC | 0x1C | 0x1D => 2,
            6..=8 | 0xA | 0xB => 4,
            0xF => 8,
            _ => panic!("a value of type {kind:02X}, which is unknown"),
        };
        Some(usize::from(u16::from_be_bytes([c1, c0])) * each)
    }

    /// The transport size of its value: bit, bytes, whole number, floating point, octets.
    fn size(&self) -> u8 {
        match *self.0.as_slice() {
            [0x10, 1, ..] => 3,
            [0x10, 5 | 7, ..] => 5,
            [0x10, 8, ..] => 7,
            [0x10, 0x1C | 0x1D, ..] => 9,
            [0x10, ..] => 4,
            _ => 9,
        }
    }

    fn judge(&self, value: &[u8], shadow: &Shadow) {
        if let Some(length) = self.length() {
            assert_eq!(value.len(), length, "the length of {:02X?}", self.0);
            assert!(length > 0);
        }
        let Some((block, address, kind, _)) = self.known() else { return };
        let Some((_, bytes)) = shadow.iter().find(|(number, _)| *number == block) else { return };
        let start = address / 8;
        if kind == 1 {
            assert_eq!(value, [bytes[start] >> (address % 8) & 1], "bit {address} of block {block}");
        } else {
            assert_eq!(value, &bytes[start..start + value.len()], "from byte {start} of block {block}");
        }
    }

    fn write(&self, value: &[u8], shadow: &mut Shadow) {
        if let Some(length) = self.length() {
            assert_eq!(value.len(), length, "a write of another length was accepted: {:02X?}", self.0);
        }
        let Some((block, address, kind, _)) = self.known() else { return };
        let Some((_, bytes)) = shadow.iter_mut().find(|(number, _)| *number == block) else { return };
        let start = address / 8;
        if kind == 1 {
            let mask = 1 << (address % 8);
            bytes[start] = if value[0] & 1 == 1 { bytes[start] | mask } else { bytes[start] & !mask };
        } else {
            bytes[start..start + value.len()].copy_from_slice(value);
        }
    }
}
