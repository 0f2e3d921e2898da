//! Generated conversations: every value of a field, every length of a request, in turn.

use super::{Conversation, length};

/// A read of MB0.
const READ: [u8; 14] = [4, 1, 0x12, 10, 0x10, 2, 0, 1, 0, 0, 0x83, 0, 0, 0];

/// Slots of a solution line.
const PLC: u8 = 2;
const NCK: u8 = 4;

pub(super) fn conversations() -> Vec<Conversation> {
    let mut all = Vec::new();
    all.extend(every_function());
    all.extend(user_data());
    all.extend(items());
    all.extend(writes());
    all.extend(lengths());
    all.extend(transport());
    all.extend(services());
    all.extend(variables());
    all
}

/// Conversations in which a field takes every value, 16 values per conversation.
fn every(name: &str, ask: impl Fn(&mut Conversation, u8)) -> Vec<Conversation> {
    every_at(PLC, name, ask)
}

fn every_at(slot: u8, name: &str, ask: impl Fn(&mut Conversation, u8)) -> Vec<Conversation> {
    let tens = (0..16_u8).map(|high| {
        let mut conversation = Conversation::ready_at(slot, format!("{name} {high:X}0 to {high:X}F"));
        (0..16).for_each(|low| ask(&mut conversation, high << 4 | low));
        conversation
    });
    tens.collect()
}

fn every_function() -> Vec<Conversation> {
    let one = |function: u8| {
        let mut conversation = Conversation::ready(format!("function {function:02X}, followed by 0 to 16 bytes"));
        for count in [0, 1, 7, 16] {
            conversation.job(&[&[function][..], &vec![0; count]].concat(), &[]);
            conversation.job(&[&[function][..], &vec![0xFF; count]].concat(), &[0xFF, 4, 0, 8, 0]);
        }
        conversation
    };
    let mut all: Vec<_> = (0..=255).map(one).collect();
    all.extend(every("kind of PDU", |conversation, kind| conversation.pdu(kind, &READ, &[])));
    all
}

fn user_data() -> Vec<Conversation> {
    let mut all = Vec::new();
    for group in 0..16 {
        for payload in [&[][..], &[0, 0], &[0xFF; 20]] {
            let mut conversation = Conversation::ready(format!("group {group:X}, {} bytes", payload.len()));
            (0..=255).for_each(|function| conversation.ask(group, function, payload));
            all.push(conversation);
        }
    }
    all.extend(every("type and group", |conversation, kind| {
        conversation.pdu(7, &[0, 1, 0x12, 4, 0x11, kind, 1, 0], &[0xFF, 9, 0, 4, 0, 0x11, 0, 0]);
    }));
    all.extend(every("length of the head of user data", |conversation, count| {
        conversation.pdu(7, &[0, 1, 0x12, count, 0x11, 0x44, 1, 0], &[0xFF, 9, 0, 4, 0, 0x11, 0, 0]);
    }));
    all.extend(every("method", |conversation, method| {
        conversation.pdu(7, &[0, 1, 0x12, 4, method, 0x44, 1, 0], &[0xFF, 9, 0, 4, 0, 0x11, 0, 0]);
    }));
    all.extend(every("transport size of a payload", |conversation, size| {
        conversation.pdu(7, &[0, 1, 0x12, 4, 0x11, 0x44, 1, 0], &[0xFF, size, 0, 4, 0, 0x11, 0, 0]);
    }));
    all.extend(every("length of a payload", |conversation, count| {
        conversation.pdu(7, &[0, 1, 0x12, 4, 0x11, 0x44, 1, 0], &[0xFF, 9, count, count, 0, 0x11, 0, 0]);
    }));
    all.extend(every("sequence of a next part", |conversation, sequence| {
        conversation.ask(4, 1, &[0, 0, 0, 0]);
        conversation.pdu(7, &[0, 1, 0x12, 8, 0x12, 0x44, 1, sequence, 0, 0, 0, 0], &[0x0A, 0, 0, 0]);
    }));
    all
}

fn read(conversation: &mut Conversation, item: &[u8]) {
    conversation.job(&[&[4, 1], item].concat(), &[]);
    // Between two valid items, which must not be affected.
    let good = &READ[2..];
    let fill = if item.len() % 2 == 1 { &[0][..] } else { &[] };
    conversation.job(&[&[4, 3], good, item, fill, good].concat(), &[]);
}

fn items() -> Vec<Conversation> {
    let mut all = Vec::new();
    all.extend(every("specification", |conversation, specification| {
        read(conversation, &[specification, 10, 0x10, 2, 0, 1, 0, 0, 0x83, 0, 0, 0]);
    }));
    all.extend(every("length of an item", |conversation, count| {
        read(conversation, &[0x12, count, 0x10, 2, 0, 1, 0, 0, 0x83, 0, 0, 0]);
    }));
    all.extend(every("length of an item that is there", |conversation, count| {
        read(conversation, &[&[0x12, count][..], &vec![0x10; count.into()]].concat());
    }));
    for (slot, name) in [(PLC, "syntax"), (NCK, "syntax, to the NCK")] {
        all.extend(every_at(slot, name, |conversation, syntax| {
            read(conversation, &[0x12, 10, syntax, 2, 0, 1, 0, 0, 0x83, 0, 0, 0]);
            read(conversation, &[0x12, 8, syntax, 0x41, 0, 2, 0, 1, 0x74, 1]);
            conversation.job(&[5, 1, 0x12, 8, syntax, 0x41, 0, 2, 0, 1, 0x74, 1], &[0, 9, 0, 1, 0]);
        }));
    }
    all.extend(every("type", |conversation, kind| {
        for count in [0, 1, 0xFF] {
            read(conversation, &[0x12, 10, 0x10, kind, count, count, 3, 0xE8, 0x84, 0, 0, 0]);
        }
    }));
    all.extend(every("area", |conversation, area| {
        for address in [0, 1, 0xFF] {
            read(conversation, &[0x12, 10, 0x10, 2, 0, 1, 3, 0xE8, area, address, address, address]);
            read(conversation, &[0x12, 10, 0x10, area, 0, 1, 0, 1, area, 0, 0, address]);
        }
    }));
    all.extend(every("count of items", |conversation, count| {
        conversation.job(&[&[4, count], &READ[2..]].concat(), &[]);
        conversation.job(&[&[4, count][..], &READ[2..].repeat(39)].concat(), &[]);
    }));
    all.extend(every("bit", |conversation, bit| {
        read(conversation, &[0x12, 10, 0x10, 1, 0, 1, 3, 0xE8, 0x84, 0, 0, bit]);
        read(conversation, &[0x12, 10, 0x10, 4, 0, 1, 3, 0xE8, 0x84, 0, 0, bit]);
        read(conversation, &[0x12, 10, 0x10, 1, 0, bit, 3, 0xE8, 0x84, 0, 0, 0]);
    }));
    all.extend(every("high byte of a block", |conversation, high| {
        for low in [0, 10, 0xFF] {
            read(conversation, &[0x12, 10, 0x10, 2, 0, 1, high, low, 0x84, 0, 0, 0]);
        }
    }));
    for size in [1_u16, 2, 20, 221, 222, 223, 230, 460, 462, 463, 900] {
        let mut conversation = Conversation::ready(format!("{size} bytes around the end of DB 1000"));
        let [c1, c0] = size.to_be_bytes();
        for byte in [0_u32, 2047, 2048, 2049, 2048 - u32::from(size), 0xFFFF, 0x1F_FFFF] {
            let [_, a2, a1, a0] = (byte * 8).to_be_bytes();
            read(&mut conversation, &[0x12, 10, 0x10, 2, c1, c0, 3, 0xE8, 0x84, a2, a1, a0]);
        }
        all.push(conversation);
    }
    for count in [2, 19, 20, 21, 38, 39] {
        let mut conversation = Conversation::ready(format!("{count} items of 1 byte, of 9 bytes, and of 21 bytes"));
        for size in [1, 9, 21] {
            let item = [0x12, 10, 0x10, 2, 0, size, 3, 0xE8, 0x84, 0, 0, 0].repeat(count.into());
            conversation.job(&[&[4, count][..], &item].concat(), &[]);
        }
        all.push(conversation);
    }
    all
}

/// A write of this many bytes from MB100 on, with this value.
fn write(conversation: &mut Conversation, count: u8, value: &[u8]) {
    conversation.job(&[5, 1, 0x12, 10, 0x10, 2, 0, count, 0, 0, 0x83, 0, 3, 0x20], value);
}

fn writes() -> Vec<Conversation> {
    let mut all = Vec::new();
    all.extend(every("transport size of a value", |conversation, size| {
        write(conversation, 1, &[0, size, 0, 8, 0x55]);
        write(conversation, 1, &[0, size, 0, 1, 0x55]);
        write(conversation, 8, &[0, size, 0, 8, 1, 2, 3, 4, 5, 6, 7, 8]);
    }));
    all.extend(every("length of a value", |conversation, count| {
        write(conversation, 2, &[0, 4, 0, count, 0x55, 0x66]);
        write(conversation, 2, &[0, 9, 0, count, 0x55, 0x66]);
        write(conversation, 2, &[0, 9, count, 0, 0x55, 0x66]);
    }));
    all.extend(every("return code of a value", |conversation, code| write(conversation, 1, &[code, 4, 0, 8, 0x55])));
    all.extend(every("type to write", |conversation, kind| {
        conversation.job(&[5, 1, 0x12, 10, 0x10, kind, 0, 1, 0, 0, 0x83, 0, 3, 0x20], &[0, 4, 0, 8, 0x55]);
        conversation
            .job(&[5, 1, 0x12, 10, 0x10, kind, 0, 1, 0, 0, 0x83, 0, 3, 0x20], &[0, 4, 0, 64, 1, 2, 3, 4, 5, 6, 7, 8]);
    }));
    all.extend(every("area to write", |conversation, area| {
        conversation.job(&[5, 1, 0x12, 10, 0x10, 2, 0, 1, 3, 0xE8, area, 0, 0x7F, 0xF8], &[0, 4, 0, 8, 0x55]);
    }));
    all.extend(every("count of items to write", |conversation, count| {
        conversation.job(&[&[5, count], &READ[2..]].concat(), &[0, 4, 0, 8, 0x55]);
        conversation.job(&[&[5, count][..], &READ[2..].repeat(20)].concat(), &[0, 4, 0, 8, 0x55, 0].repeat(20));
    }));
    all
}

/// Requests of every kind, as parameter and data part.
fn templates() -> Vec<(&'static str, u8, Vec<u8>, Vec<u8>)> {
    let upload = [&[0x1D, 0, 0, 0, 0, 0, 0, 0, 9], b"_0A01000A".as_slice()].concat();
    let start = [&[0x28, 0, 0, 0, 0, 0, 0, 0xFD, 0, 0, 9], b"P_PROGRAM".as_slice()].concat();
    let stop = [&[0x29, 0, 0, 0, 0, 0, 9], b"P_PROGRAM".as_slice()].concat();
    let asked = |group: u8, function| vec![0, 1, 0x12, 4, 0x11, 0x40 | group, function, 0];
    let octets = |payload: &[u8]| [&[0xFF, 9][..], &length(payload.len()), payload].concat();
    let clock = [0, 0x19, 0x26, 0x11, 0x22, 3, 4, 5, 0x67, 0x81];
    let cyclic = [&[0, 1, 0, 1], &READ[2..]].concat();
    vec![
        ("setup", 1, vec![0xF0, 0, 0, 1, 0, 1, 1, 0xE0], vec![]),
        ("read", 1, [&[4, 2], &READ[2..], &READ[2..]].concat(), vec![]),
        ("read of an NC variable", 1, vec![4, 1, 0x12, 8, 0x82, 0x41, 0, 2, 0, 1, 0x74, 3], vec![]),
        ("write", 1, [&[5, 2], &READ[2..], &READ[2..]].concat(), vec![0, 4, 0, 8, 1, 0, 0, 4, 0, 8, 2]),
        ("start of an upload", 1, upload, vec![]),
        ("start", 1, start, vec![]),
        ("stop", 1, stop, vec![]),
        ("system state list", 7, asked(4, 1), octets(&[0, 0x11, 0, 0])),
        ("list of blocks", 7, asked(3, 2), octets(b"0A")),
        ("information of a block", 7, asked(3, 3), octets(b"0A01000A")),
        ("clock to set", 7, asked(7, 2), octets(&clock)),
        ("password", 7, asked(5, 1), octets(b"12345678")),
        ("subscription", 7, asked(2, 1), octets(&cyclic)),
    ]
}

/// Every request, truncated and with wrong lengths.
fn lengths() -> Vec<Conversation> {
    let mut all = Vec::new();
    for (name, kind, parameter, data) in templates() {
        let head = |parameter: [u8; 2], data: [u8; 2]| [&[0x32, kind, 0, 0, 0, 5], &parameter[..], &data].concat();
        let right = head(length(parameter.len()), length(data.len()));
        let whole = [right.as_slice(), &parameter, &data].concat();
        let mut cut = Conversation::ready(format!("{name}, cut at every byte after its header"));
        (10..whole.len()).for_each(|end| cut.data(&whole[..end]));
        all.push(cut);
        let mut short = Conversation::ready(format!("{name}, with a shorter parameter part at every length"));
        (0..parameter.len()).for_each(|end| short.pdu(kind, &parameter[..end], &data));
        all.push(short);
        let mut less = Conversation::ready(format!("{name}, with a shorter data part at every length"));
        (0..data.len()).for_each(|end| less.pdu(kind, &parameter, &data[..end]));
        all.push(less);
        let mut wrong = Conversation::ready(format!("{name}, with lengths that lie"));
        for lie in [0, 1, parameter.len() - 1, parameter.len() + 1, 0x7FFF, 0xFFFF] {
            wrong.data(&[head(length(lie), length(data.len())).as_slice(), &parameter, &data].concat());
            wrong.data(&[head(length(parameter.len()), length(lie)).as_slice(), &parameter, &data].concat());
            wrong.data(&[head(length(lie), length(0xFFFF - lie)).as_slice(), &parameter, &data].concat());
        }
        all.push(wrong);
        let mut changed = Conversation::ready(format!("{name}, with each byte of its parameter part 00, 7F, FF"));
        for at in 0..parameter.len() {
            for byte in [0, 0x7F, 0xFF] {
                let mut parameter = parameter.clone();
                parameter[at] = byte;
                changed.pdu(kind, &parameter, &data);
            }
        }
        all.push(changed);
        for piece in [1, 2, 3, 7, 13] {
            let mut pieces = Conversation::ready(format!("{name}, in fragments of {piece} bytes"));
            let mut rest = whole.chunks(piece).peekable();
            while let Some(bytes) = rest.next() {
                pieces.piece(bytes, rest.peek().is_none());
            }
            all.push(pieces);
        }
        for end in (0..10).chain([whole.len() - 1]) {
            let mut ended = Conversation::ready(format!("{name}, of which the packet has only {end} bytes"));
            ended.data(&whole[..end]);
            all.push(ended);
        }
    }
    all
}

fn transport() -> Vec<Conversation> {
    let mut all = Vec::new();
    let request = [3, 0, 0, 22, 17, 0xE0, 0, 0, 0, 1, 0, 0xC0, 1, 10, 0xC1, 2, 1, 0, 0xC2, 2, 1, 2];
    for end in 1..request.len() {
        let mut half = Conversation::new(format!("a connection request of which only {end} bytes come"));
        half.send(&request[..end]);
        all.push(half);
        let mut short = Conversation::new(format!("a connection request in a packet of {end} bytes"));
        let mut bytes = request[..end].to_vec();
        if let Some(length) = bytes.get_mut(3) {
            *length = u8::try_from(end).unwrap_or(0);
        }
        short.send(bytes);
        all.push(short);
    }
    for at in (0..request.len()).filter(|at| *at != 2 && *at != 3) {
        for byte in [0, 1, 0x7F, 0xFF] {
            let mut changed = Conversation::new(format!("a connection request whose byte {at} is {byte:02X}"));
            let mut bytes = request;
            bytes[at] = byte;
            changed.send(bytes);
            all.push(changed);
        }
    }
    for length in (0..8).chain([9, 200]) {
        let mut conversation = Conversation::ready(format!("a packet with a length field of {length}"));
        conversation.send([3, 0, 0, length, 2, 0xF0, 0x80, 0x32]);
        all.push(conversation);
    }
    for code in (0..16).map(|high| high << 4) {
        let mut conversation = Conversation::ready(format!("TPDU {code:02X}"));
        conversation.send([3, 0, 0, 11, 6, code, 0, 0, 0, 1, 0]);
        all.push(conversation);
        let mut conversation = Conversation::new(format!("TPDU {code:02X} before a connection"));
        conversation.send([3, 0, 0, 11, 6, code, 0, 0, 0, 1, 0]);
        all.push(conversation);
    }
    for size in 0..=16 {
        let mut conversation = Conversation::new(format!("a TPDU of 2 to the power of {size}, and a long answer"));
        let mut bytes = request;
        bytes[13] = size;
        conversation.send(bytes);
        conversation.set_up(960);
        conversation.job(&[4, 1, 0x12, 10, 0x10, 2, 3, 0x84, 3, 0xE8, 0x84, 0, 0, 0], &[]);
        all.push(conversation);
    }
    for pdu in [0, 1, 10, 119, 120, 239, 240, 241, 242, 480, 959, 960, 961, 2048, 4096, 65535] {
        let mut conversation = Conversation::new(format!("a PDU of {pdu} bytes, answers and requests around it"));
        conversation.connect();
        conversation.set_up(pdu);
        for count in [200_u16, 221, 222, 223, 224, 461, 462, 463, 941, 942, 943, 944, 2047] {
            let [c1, c0] = count.to_be_bytes();
            conversation.job(&[4, 1, 0x12, 10, 0x10, 2, c1, c0, 3, 0xE8, 0x84, 0, 0, 0], &[]);
            let value = [&[0, 4][..], &(count * 8).to_be_bytes(), &vec![0xA5; count.into()]].concat();
            conversation.job(&[5, 1, 0x12, 10, 0x10, 2, c1, c0, 3, 0xE8, 0x84, 0, 0, 0], &value);
        }
        all.push(conversation);
    }
    all.extend(every("number of a TPDU", |conversation, number| {
        let pdu = [&[0x32, 1, 0, 0, 0, 9, 0, 14, 0, 0], &READ[..]].concat();
        conversation.send([&[3, 0, 0, 31, 2, 0xF0, number], pdu.as_slice()].concat());
        conversation.data(&[]);
    }));
    all
}

fn services() -> Vec<Conversation> {
    let mut all = Vec::new();
    for high in [0x00, 0x01, 0x02, 0x03, 0x04, 0x07, 0x0E, 0x0F, 0x80, 0xFF] {
        let mut conversation = Conversation::ready(format!("system state lists {high:02X}00 to {high:02X}FF"));
        for low in 0..=255 {
            conversation.ask(4, 1, &[high, low, 0, 0]);
            conversation.ask(4, 1, &[high, low, 0xFF, 0xFF]);
        }
        all.push(conversation);
    }
    for function in [1, 2, 3] {
        let mut conversation = Conversation::ready(format!("blocks of every type, function {function}"));
        for kind in 0..=255 {
            conversation.ask(3, function, &[0x30, kind]);
            conversation.ask(3, function, &[&[0x30, kind], b"01000A".as_slice()].concat());
        }
        all.push(conversation);
    }
    let mut names = Conversation::ready("information about blocks with an invalid number");
    for number in ["00000", "99999", "65535", "65536", "0100A", "-1000", "+1000", " 1000", "1e3  ", "\0\0\0\0\0"] {
        names.ask(3, 3, format!("0A{number}A").as_bytes());
        let name = format!("_0A{number}A");
        names.job(&[&[0x1D, 0, 0, 0, 0, 0, 0, 0, 9], name.as_bytes()].concat(), &[]);
    }
    all.push(names);
    all.extend(every("number of an upload", |conversation, number| {
        conversation.job(&[0x1E, 0, 0, 0, 0, 0, 0, number], &[]);
        conversation.job(&[0x1F, 0, 0, 0, 0, 0, 0, number], &[]);
        conversation.job(&[0x1E, 0, 0, 0, number, 0, 0, 1], &[]);
    }));
    all.extend(every("passwords and clocks of such bytes", |conversation, byte| {
        for count in [1, 7, 8, 9, 10, 11] {
            conversation.ask(5, 1, &vec![byte; count]);
            conversation.ask(7, 2, &vec![byte; count]);
        }
    }));
    all.extend(every("time base, factor and job of a subscription", |conversation, byte| {
        conversation.ask(2, 1, &[&[0, 1, byte, 1], &READ[2..]].concat());
        conversation.ask(2, 5, &[&[0, 1, 0, byte], &READ[2..]].concat());
        conversation.ask(2, 1, &[&[byte, 1, 0, 1], &READ[2..]].concat());
        conversation.ask(2, 4, &[byte, byte]);
        conversation.ask(2, 4, &[0, 0]);
    }));
    all
}

fn variables() -> Vec<Conversation> {
    let mut all = Vec::new();
    let mut field = |name: &str, item: fn(u8) -> [u8; 10]| {
        all.extend(every_at(NCK, name, move |conversation, byte| {
            for syntax in [0x82, 0x83, 0x84] {
                let mut item = item(byte);
                item[2] = syntax;
                read(conversation, &item);
            }
            conversation.job(&[&[5, 1][..], &item(byte)].concat(), &[0, 9, 0, 8, 0, 0, 0, 0, 0, 0, 0xF0, 0x3F]);
        }));
    };
    field("area and unit of an NC variable", |byte| [0x12, 8, 0x82, byte, 0, 2, 0, 1, 0x74, 1]);
    field("high byte of a column", |byte| [0x12, 8, 0x82, 0x41, byte, 2, 0, 1, 0x1A, 1]);
    field("column", |byte| [0x12, 8, 0x82, 0x41, 0, byte, 0, 1, 0x7F, 1]);
    field("line", |byte| [0x12, 8, 0x82, 0x41, 0, 2, byte, byte, 0x74, 1]);
    field("module", |byte| [0x12, 8, 0x82, 0x41, 0, 2, 0, 1, byte, 1]);
    field("count of lines", |byte| [0x12, 8, 0x82, 0x41, 0, 2, 0, 1, 0x74, byte]);
    field("R parameter", |byte| [0x12, 8, 0x82, 0x41, 0, 1, byte, byte, 0x15, 1]);
    field("count of machine data", |byte| [0x12, 8, 0x82, 0x01, 0x27, 0x10, 0, 1, 0x1A, byte]);
    all.extend(every_at(9, "type, rows, object, parameter and index of a drive", |conversation, byte| {
        for at in 3..12 {
            let mut item = [0x12, 10, 0xA2, 8, 0, 1, 0, 3, 0, 0x1A, 0, 0];
            item[at] = byte;
            read(conversation, &item);
        }
    }));
    all
}
