//! A grammar: arbitrary bytes select alternatives and produce the stream of a client whose requests are almost all valid. The stream ends
//! when the bytes are used up.

use super::conversation::PAUSE;

/// Choices, taken in order; 0 when none is left.
struct Choices<'a>(&'a [u8]);

impl Choices<'_> {
    fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        *first
    }

    fn word(&mut self) -> u16 {
        u16::from_be_bytes([self.byte(), self.byte()])
    }

    fn of<T: Copy>(&mut self, these: &[T]) -> T {
        these[usize::from(self.byte()) % these.len()]
    }

    fn bytes(&mut self, count: usize) -> Vec<u8> {
        (0..count).map(|_| self.byte()).collect()
    }
}

/// The input of a conversation: the machine, a connection, a setup, and requests with pauses.
#[must_use]
pub fn stream(choices: &[u8]) -> Vec<u8> {
    let mut choices = Choices(choices);
    let mut stream = vec![choices.byte()];
    let size = choices.of(&[10, 7, 8, 9, 11, 13]);
    // The PLC, the NCK, a drive.
    let slot = choices.of(&[2, 4, 3, 9]);
    stream.extend([3, 0, 0, 22, 17, 0xE0, 0, 0, 0, 1, 0, 0xC0, 1, size, 0xC1, 2, 1, 0, 0xC2, 2, 1, slot]);
    let [high, low] = choices.of(&[480_u16, 240, 960, 241, 0xFFFF, 0]).to_be_bytes();
    packet(&mut stream, &mut choices, 1, &[0xF0, 0, 0, 1, 0, 1, high, low], &[]);
    while !choices.0.is_empty() && stream.len() < 8192 {
        request(&mut stream, &mut choices);
    }
    stream
}

fn request(stream: &mut Vec<u8>, choices: &mut Choices<'_>) {
    match choices.byte() % 16 {
        0..=3 => {
            let (items, _) = items(choices, false);
            packet(stream, choices, 1, &[&[4], items.as_slice()].concat(), &[]);
        }
        4..=6 => {
            let (items, values) = items(choices, true);
            packet(stream, choices, 1, &[&[5], items.as_slice()].concat(), &values);
        }
        7 => {
            stream.extend(PAUSE);
            stream.push(choices.byte());
        }
        8 => {
            let (items, _) = items(choices, false);
            let mut payload = vec![0];
            payload.extend([items[0], choices.of(&[0, 1, 2, 3]), choices.of(&[1, 0, 2, 200])]);
            payload.extend(&items[1..]);
            let function = choices.of(&[1, 5]);
            user_data(stream, choices, 2, function, &payload);
        }
        9 => {
            let number = choices.byte();
            user_data(stream, choices, 2, 4, &[0, number]);
        }
        10 => {
            let list: u16 = choices.of(&[
                0x0000, 0x0F00, 0x0011, 0x0111, 0x001C, 0x011C, 0x0131, 0x0132, 0x0232, 0x0424, 0x0074, 0x0174, 0x00A0,
                0x01A0, 0x0222, 0x0013, 0x0019, 0x0025,
            ]);
            let index = choices.word();
            user_data(stream, choices, 4, 1, &[list.to_be_bytes(), index.to_be_bytes()].concat());
        }
        11 => {
            let kind = choices.of(b"A8BCE");
            match choices.byte() % 3 {
                0 => user_data(stream, choices, 3, 1, &[]),
                1 => user_data(stream, choices, 3, 2, &[b'0', kind]),
                _ => {
                    let name = name(choices);
                    user_data(stream, choices, 3, 3, &[&[b'0', kind], name.as_bytes(), b"A"].concat());
                }
            }
        }
        12 => {
            let function = choices.of(&[1, 2, 3, 4]);
            let time = [0, 0x19, 0x26, 0x11, 0x22, 3, 4, 5, 0x67, 0x81];
            let payload = if matches!(function, 2 | 4) { &time[..] } else { &[] };
            user_data(stream, choices, 7, function, payload);
        }
        13 => {
            let upload = choices.byte() % 5;
            match choices.byte() % 3 {
                0 => {
                    let name = name(choices);
                    let start = [&[0x1D, 0, 0, 0, 0, 0, 0, 0, 9], b"_0A".as_slice(), name.as_bytes(), b"A"].concat();
                    packet(stream, choices, 1, &start, &[]);
                }
                1 => packet(stream, choices, 1, &[0x1E, 0, 0, 0, 0, 0, 0, upload], &[]),
                _ => packet(stream, choices, 1, &[0x1F, 0, 0, 0, 0, 0, 0, upload], &[]),
            }
        }
        14 => match choices.byte() % 6 {
            0 => packet(stream, choices, 1, &[&[0x29, 0, 0, 0, 0, 0, 9], b"P_PROGRAM".as_slice()].concat(), &[]),
            1 | 2 => {
                let argument: &[u8] = choices.of(&[&[0, 0], &[0, 2, b'C', b' ']]);
                let start = [&[0x28, 0, 0, 0, 0, 0, 0, 0xFD], argument, &[9], b"P_PROGRAM".as_slice()].concat();
                packet(stream, choices, 1, &start, &[]);
            }
            3 => user_data(stream, choices, 5, 2, &[]),
            _ => {
                let mut folded = *b"OPENNCK!";
                for at in 0..8 {
                    folded[at] ^= 0x55 ^ if at < 2 { 0 } else { folded[at - 2] };
                }
                user_data(stream, choices, 5, 1, &folded);
            }
        },
        _ => {
            // Any function or group, with some bytes.
            let (parameter, data) = (choices.byte() % 32, choices.byte() % 32);
            let parameter = choices.bytes(parameter.into());
            let data = choices.bytes(data.into());
            let kind = choices.of(&[1, 7, 2, 3, 8]);
            packet(stream, choices, kind, &parameter, &data);
        }
    }
}

fn name(choices: &mut Choices<'_>) -> String {
    format!("{:05}", choices.of(&[1000_u16, 1001, 10, 11, 31, 2, 9, 0, 3800]))
}

/// Items preceded by their count, and matching values.
fn items(choices: &mut Choices<'_>, is_write: bool) -> (Vec<u8>, Vec<u8>) {
    let count = choices.byte() % 24 + 1;
    let (mut items, mut values) = (vec![count], Vec::new());
    for index in 0..count {
        let what = choices.byte();
        let (item, length) = match what % 16 {
            7 | 15 => variable(choices),
            11 => drive(choices),
            _ => area(choices, what),
        };
        items.extend(&item);
        if item.len() % 2 == 1 && index + 1 < count {
            items.push(0);
        }
        if is_write {
            let length = if what & 0x80 == 0 { length } else { usize::from(choices.byte()) };
            let (size, field) = choices.of(&[(4, length * 8), (9, length), (7, length), (3, length)]);
            values.extend([0, size]);
            values.extend(u16::try_from(field).unwrap_or(u16::MAX).to_be_bytes());
            values.extend(choices.bytes(length));
            if length % 2 == 1 && index + 1 < count && what & 0x40 == 0 {
                values.push(0);
            }
        }
    }
    (items, values)
}

fn area(choices: &mut Choices<'_>, what: u8) -> (Vec<u8>, usize) {
    let area = [0x83, 0x84, 0x84, 0x84, 0x81, 0x82, 0x1C][usize::from(what % 7)];
    let area = if area == 0x1C { choices.of(&[0x1C, 0x1D]) } else { area };
    let (kind, bytes) = if matches!(area, 0x1C | 0x1D) {
        (area, 2)
    } else {
        choices.of(&[
            (2, 1),
            (1, 1),
            (4, 2),
            (8, 4),
            (3, 1),
            (5, 2),
            (6, 4),
            (7, 4),
            (9, 2),
            (0xA, 4),
            (0xF, 8),
            (0xE, 1),
        ])
    };
    let count: u16 = if kind == 1 { 1 } else { choices.of(&[1, 2, 3, 7, 20, 222, 0, 0xFFFF]) };
    let block = choices.of(&[1000_u16, 1001, 10, 11, 21, 31, 2, 3800, 2600, 9]);
    let byte = u32::from(choices.word()) % 2100;
    let address = if matches!(area, 0x1C | 0x1D) {
        byte % 40
    } else if kind == 1 {
        byte * 8 + u32::from(choices.byte() % 8)
    } else {
        byte % if area == 0x84 { 2100 } else { 270 } * 8
    };
    let [_, a2, a1, a0] = address.to_be_bytes();
    let ([c1, c0], [d1, d0]) = (count.to_be_bytes(), block.to_be_bytes());
    (vec![0x12, 10, 0x10, kind, c1, c0, d1, d0, area, a2, a1, a0], usize::from(count) * bytes)
}

fn variable(choices: &mut Choices<'_>) -> (Vec<u8>, usize) {
    let (unit, column, module) = choices.of(&[
        (0x41, 2_u16, 0x74_u8),
        (0x41, 3, 0x74),
        (0x41, 2, 0x73),
        (0x41, 10, 0x71),
        (0x41, 20080, 0x1A),
        (0x21, 3, 0x7F),
        (0x41, 11, 0x7F),
        (0x01, 7, 0x7F),
        (0x01, 1, 0x77),
        (0x01, 10000, 0x1A),
        (0x61, 30130, 0x1A),
        (0x01, 11410, 0x1A),
        (0x41, 1, 0x15),
        (0xA1, 26, 0x82),
    ]);
    let [c1, c0] = column.to_be_bytes();
    let syntax = choices.of(&[0x82, 0x83, 0x84, 0xB2]);
    let (line, count) = (choices.of(&[1, 2, 3, 4, 0, 31]), choices.of(&[1, 3, 2, 0, 255]));
    (vec![0x12, 8, syntax, unit, c1, c0, 0, line, module, count], 8 * usize::from(count))
}

/// A parameter of a drive object: type, rows, object, parameter, index.
fn drive(choices: &mut Choices<'_>) -> (Vec<u8>, usize) {
    let parameter: u8 = choices.of(&[0x1A, 0x1E, 0x20, 0x25, 2]);
    let rows = choices.of(&[1, 2, 0, 255]);
    (
        vec![0x12, 10, 0xA2, choices.of(&[8, 4]), 0, rows, 0, choices.byte() % 8, 0, parameter, 0, 0],
        4 * usize::from(rows),
    )
}

fn user_data(stream: &mut Vec<u8>, choices: &mut Choices<'_>, group: u8, function: u8, payload: &[u8]) {
    let kind = choices.of(&[0x40, 0x00]) | group;
    let sequence = choices.byte();
    let parameter = if sequence % 4 == 3 {
        // The next part of the last long answer.
        vec![0, 1, 0x12, 8, 0x12, kind, function, sequence / 4, 0, 0, 0, 0]
    } else {
        vec![0, 1, 0x12, 4, 0x11, kind, function, 0]
    };
    let head = if payload.is_empty() { [0x0A, 0] } else { [0xFF, 9] };
    let length = u16::try_from(payload.len()).unwrap_or(u16::MAX).to_be_bytes();
    packet(stream, choices, 7, &parameter, &[&head[..], &length, payload].concat());
}

/// A PDU, in one packet or in several.
fn packet(stream: &mut Vec<u8>, choices: &mut Choices<'_>, kind: u8, parameter: &[u8], data: &[u8]) {
    let reference = choices.word().to_be_bytes();
    let length = |bytes: &[u8]| u16::try_from(bytes.len()).unwrap_or(u16::MAX).to_be_bytes();
    let head = [0x32, kind, 0, 0, reference[0], reference[1]];
    let pdu = [&head[..], &length(parameter), &length(data), parameter, data].concat();
    let piece = if reference[0] % 8 == 7 { usize::from(reference[1]).max(1) } else { 8000 };
    let mut pieces = pdu.chunks(piece).peekable();
    while let Some(piece) = pieces.next() {
        let mark = if pieces.peek().is_some() { 0 } else { 0x80 };
        let [high, low] = u16::try_from(piece.len() + 7).unwrap_or(u16::MAX).to_be_bytes();
        stream.extend([3, 0, high, low, 2, 0xF0, mark]);
        stream.extend(piece);
    }
}
