//! Read and write variables: types, areas, fill bytes, refusals of single items.

use super::Client;
use crate::image::{Location, Part};
use crate::s7::Command;
use crate::s7::wire::data::{Refusal, TransportSize, Type};

/// Answer to a read of one item of DB1000 from byte 0, which contains 01 02 03 ...
fn read_of(kind: &str, count: &str) -> String {
    let mut client = Client::ready(480);
    for (byte, value) in client.memory.blocks.get_mut(1000).unwrap().iter_mut().zip(1_u8..=255) {
        *byte = value;
    }
    let answer = client.read(&[&format!("{kind} {count} 03 E8 84 00 00 00")]);
    answer.strip_prefix("00 02 ").map(|rest| rest[18..].to_owned()).unwrap_or(answer)
}

/// The length counts bits for 03, 04 and 05, and bytes for 07 and 09.
#[test]
fn each_type_is_answered_with_its_transport_size_and_length() {
    for (kind, count, item) in [
        ("01", "00 01", "FF 03 00 01 01"),
        ("02", "00 03", "FF 04 00 18 01 02 03"),
        ("03", "00 02", "FF 04 00 10 01 02"),
        ("04", "00 02", "FF 04 00 20 01 02 03 04"),
        ("05", "00 02", "FF 05 00 20 01 02 03 04"),
        ("06", "00 01", "FF 04 00 20 01 02 03 04"),
        ("07", "00 01", "FF 05 00 20 01 02 03 04"),
        ("08", "00 01", "FF 07 00 04 01 02 03 04"),
        ("09", "00 01", "FF 04 00 10 01 02"),
        ("0A", "00 01", "FF 04 00 20 01 02 03 04"),
        ("0B", "00 01", "FF 04 00 20 01 02 03 04"),
        ("0C", "00 01", "FF 04 00 10 01 02"),
        ("0F", "00 01", "FF 04 00 40 01 02 03 04 05 06 07 08"),
        // Twelve bits, unknown types, no type, timers in a data block.
        ("01", "00 02", "06 00 00 00"),
        ("13", "00 01", "06 00 00 00"),
        ("02", "00 00", "05 00 00 00"),
        ("1D", "00 01", "07 00 00 00"),
    ] {
        assert_eq!(read_of(kind, count), item, "type {kind}");
    }
}

#[test]
fn each_bit_is_read_by_itself() {
    let mut client = Client::ready(240);
    client.memory.blocks.get_mut(1000).unwrap()[3] = 0b0100_0010;
    let mut bits = Vec::new();
    for bit in 0x18..=0x1F {
        let answer = client.read(&[&format!("01 00 01 03 E8 84 00 00 {bit:02X}")]);
        bits.push(answer.ends_with("FF 03 00 01 01"));
    }
    assert_eq!(bits, [false, true, false, false, false, false, true, false]);
    // 65535 is the last byte of a block; bit 7 of byte 8191 is the last 16-bit address.
    assert!(client.read(&["01 00 01 03 E8 84 07 FF FF"]).ends_with("05 00 00 00"));
}

#[test]
fn items_are_filled_to_even_lengths_but_not_the_last() {
    let mut client = Client::ready(240);
    let odd = "02 00 01 03 E8 84 00 00 00";
    assert_eq!(client.read(&[odd]), "00 02 00 05 00 00 04 01 FF 04 00 08 A5");
    assert_eq!(
        client.read(&[odd, odd, odd]),
        "00 02 00 11 00 00 04 03 FF 04 00 08 A5 00 FF 04 00 08 A5 00 FF 04 00 08 A5"
    );
    let refused = "02 00 01 00 01 84 00 00 00";
    assert_eq!(
        client.read(&[odd, refused, odd]),
        "00 02 00 0F 00 00 04 03 FF 04 00 08 A5 00 0A 00 00 00 FF 04 00 08 A5"
    );
}

#[test]
fn every_area_is_read() {
    let mut client = Client::ready(240);
    let memory = &mut client.memory;
    for (area, value) in
        [(&mut memory.inputs, 1), (&mut memory.outputs, 2), (&mut memory.timers, 4), (&mut memory.counters, 5)]
    {
        area.fill(value);
    }
    for (item, value) in [
        ("02 00 02 00 00 81 00 00 00", "FF 04 00 10 01 01"),
        ("02 00 02 00 00 82 00 00 00", "FF 04 00 10 02 02"),
        ("02 00 02 00 00 83 00 00 00", "FF 04 00 10 A5 A5"),
        ("02 00 02 00 0A 84 00 00 00", "FF 04 00 10 A5 A5"),
        ("1D 00 01 00 00 1D 00 00 1F", "FF 09 00 02 04 04"), // timer 31 is the last
        ("1C 00 01 00 00 1C 00 00 1F", "FF 09 00 02 05 05"),
        ("1D 00 01 00 00 1D 00 00 20", "05 00 00 00"),
        ("04 00 01 00 00 1D 00 00 1F", "FF 04 00 10 04 04"), // as WORD
        ("02 00 01 00 00 1D 00 00 00", "07 00 00 00"),
        ("09 00 02 00 00 1D 00 00 08", "07 00 00 00"), // a client of Node-RED requests T1 in bits
        ("1C 00 01 00 00 1D 00 00 00", "07 00 00 00"), // a timer is not a counter
        ("02 00 01 00 00 80 00 00 00", "0A 00 00 00"), // peripheral inputs
        ("02 00 01 00 00 86 00 00 00", "0A 00 00 00"), // local data
    ] {
        assert!(client.read(&[item]).ends_with(value), "{item}: {}", client.read(&[item]));
    }
}

/// O-24: lengths of the interface blocks; the 828D has only its own block numbers.
#[test]
fn blocks_that_do_not_exist_and_addresses_behind_their_end_are_told_apart() {
    let mut client = Client::ready(240);
    for (item, code) in [
        ("02 00 01 00 1F 84 00 04 98", "FF 04 00 08 A5"), // DB31.DBB147
        ("02 00 02 00 1F 84 00 04 98", "05 00 00 00"),
        ("02 00 01 00 1F 84 00 04 A0", "05 00 00 00"),
        ("02 00 01 00 1F 84 FF FF F8", "05 00 00 00"),
        ("02 FF FF 00 1F 84 00 00 00", "05 00 00 00"),
        ("02 00 01 00 3E 84 00 00 00", "0A 00 00 00"), // DB62
        ("02 00 01 0F 3C 84 00 00 00", "0A 00 00 00"), // DB3900
        ("02 00 08 03 E9 84 00 00 00", "05 00 00 00"), // DB1001 has seven bytes
        ("04 00 01 00 1F 84 00 00 01", "05 00 00 00"), // a word at a bit
    ] {
        assert!(client.read(&[item]).ends_with(code), "{item}: {}", client.read(&[item]));
    }
    let mut client = Client::ready(240).on_828d();
    for (item, code) in [
        ("02 00 01 0F 3C 84 00 00 00", "FF 04 00 08 A5"), // DB3900
        ("02 00 01 0F 3C 84 00 9C 58", "FF 04 00 08 A5"), // DB3900.DBB5003
        ("02 00 01 0F 3C 84 00 13 88", "05 00 00 00"),    // DB3900.DBB625
        ("02 00 01 06 40 84 00 00 00", "FF 04 00 08 A5"), // DB1600.DBB0
        ("02 00 01 09 C4 84 00 3E 80", "FF 04 00 08 A5"), // DB2500.DBB2000
        ("02 00 01 09 C4 84 00 3E A0", "05 00 00 00"),    // DB2500.DBB2004
        ("02 00 01 16 44 84 00 00 38", "FF 04 00 08 A5"), // DB5700.DBB7
        ("02 00 01 00 1F 84 00 00 00", "0A 00 00 00"),
    ] {
        assert!(client.read(&[item]).ends_with(code), "{item}: {}", client.read(&[item]));
    }
}

#[test]
fn items_of_other_syntaxes_are_refused_by_themselves() {
    let mut client = Client::ready(240);
    // A symbol of an S7-1200 (B2), areas of data blocks (B0), a drive object (A2), an invalid item; then a byte of
    // DB1000.
    let symbol = "12 0E B2 FF 00 00 00 52 00 00 03 E8 00 00 00 0A";
    let areas = "12 07 B0 01 01 03 E8 00 00 00";
    let drive = "12 0A A2 08 00 01 00 03 00 1E 00 00";
    let byte = "12 0A 10 02 00 01 03 E8 84 00 00 00";
    let answer = client.job(&format!("04 05 {symbol} {areas} {drive} 13 02 00 00 {byte}"), "");
    assert_eq!(answer, "00 02 00 15 00 00 04 05 0A 00 00 00 06 00 00 00 0A 00 00 00 06 00 00 00 FF 04 00 08 A5");
}

#[test]
fn items_that_end_early_refuse_the_whole_request() {
    let mut client = Client::ready(240);
    for parameter in
        ["04 01", "04 01 12", "04 01 12 0A 10 02 00 01 03 E8 84 00 00", "04 02 12 0A 10 02 00 01 03 E8 84 00 00 00"]
    {
        assert_eq!(client.job(parameter, ""), "00 00 00 00 85 00", "{parameter}");
    }
}

#[test]
fn a_write_becomes_visible_with_the_next_step_and_whole() {
    let mut client = Client::ready(240);
    let answer = client.write(
        &["02 00 01 03 E8 84 00 00 00", "04 00 01 03 E8 84 00 00 10", "01 00 01 00 00 83 00 00 0D"],
        "00 04 00 08 11 00 00 04 00 10 22 33 00 03 00 01 00",
    );
    assert_eq!(answer, "00 02 00 03 00 00 05 03 FF FF FF");
    assert_eq!(client.memory.blocks.get(1000).unwrap()[..4], [0xA5; 4]);
    client.step();
    assert_eq!(client.memory.blocks.get(1000).unwrap()[..5], [0x11, 0xA5, 0x22, 0x33, 0xA5]);
    assert_eq!(client.memory.flags[..3], [0xA5, 0x85, 0xA5]); // M1.5
}

/// A word is one command if it lies in one part of the memory, so that the record shows it as one.
#[test]
fn an_element_is_written_as_one_number_unless_two_writers_share_it() {
    let mut client = Client::ready(240);
    client.write(&["08 00 01 03 E8 84 00 00 20"], "00 07 00 04 3F 80 00 00");
    let [
        Command::Write { location: Location { part: Part::Block(1000), offset: 4, width: 32, .. }, value: 0x3F80_0000 },
    ] = client.commands[..]
    else {
        panic!("{:?}", client.commands)
    };
    // DB10: byte 96 is the NCK's, byte 97 the HMI's.
    client.commands.clear();
    client.write(&["04 00 01 00 0A 84 00 03 00"], "00 04 00 10 12 34");
    let parts = client.commands.iter().map(|command| match command {
        Command::Write { location, value } => (location.part, location.width, *value),
        other => panic!("{other:?}"),
    });
    assert_eq!(parts.collect::<Vec<_>>(), [(Part::FromNck, 8, 0x12), (Part::Hmi, 8, 0x34)]);
}

/// SIG-11: a bit of the NCK accepts a write, and is overwritten at the next publication.
#[test]
fn a_bit_of_the_nck_takes_what_is_written() {
    let mut client = Client::ready(240);
    // DB31.DBX101.5
    let answer = client.write(&["01 00 01 00 1F 84 00 03 2D"], "00 03 00 01 00");
    assert_eq!(answer, "00 02 00 01 00 00 05 01 FF");
    client.step();
    assert!(!client.memory.from_nck().axes[crate::units::AxisNumber::FIRST].gantry_grouping_is_synchronized());
}

#[test]
fn an_item_that_is_refused_leaves_the_others_alone() {
    let mut client = Client::ready(240);
    let answer = client.write(
        &[
            "02 00 01 03 E8 84 00 00 00", // valid
            "02 00 01 00 01 84 00 00 00", // no such block
            "02 00 02 03 E8 84 00 00 08", // two bytes, one given
            "02 00 01 03 E9 84 00 00 38", // after the end
            "02 00 01 03 E8 84 00 00 10", // valid
        ],
        "00 04 00 08 11 00 00 04 00 08 22 00 00 04 00 08 33 00 00 04 00 08 44 00 00 04 00 08 55",
    );
    assert_eq!(answer, "00 02 00 05 00 00 05 05 FF 0A 07 05 FF");
    assert_eq!(client.commands.len(), 2);
}

#[test]
fn a_request_to_write_whose_values_do_not_add_up_writes_nothing() {
    let mut client = Client::ready(240);
    let item = "02 00 01 03 E8 84 00 00 00";
    for data in ["", "00", "00 04 00 08", "00 04 00 10 11", "00 04 00 08 11 22 33", "00 04 00 08 11 00 00 04"] {
        assert_eq!(client.write(&[item], data), "00 00 00 00 85 00", "{data}");
    }
    assert_eq!(client.write(&[item, item], "00 04 00 08 11 00"), "00 00 00 00 85 00");
    assert_eq!(client.job("05 00", ""), "00 00 00 00 85 00");
    assert_eq!(client.job("05 01 12 0A", "00 04 00 08 11"), "00 00 00 00 85 00");
    assert!(client.commands.is_empty());
}

#[test]
fn a_read_only_server_refuses_writes() {
    let mut client = Client::ready(240);
    client.is_read_only = true;
    let item = "02 00 01 03 E8 84 00 00 00";
    assert_eq!(client.write(&[item], "00 04 00 08 11"), "00 02 00 01 00 00 05 01 03");
    assert!(client.commands.is_empty());
    assert_eq!(client.read(&[item]), "00 02 00 05 00 00 04 01 FF 04 00 08 A5");
    assert_eq!(client.job("29 00 00 00 00 00 09 50 5F 50 52 4F 47 52 41 4D", ""), "00 00 00 00 84 04");
    assert_eq!(client.user_data(7, 2, "00 19 26 11 22 03 04 05 67 81").0, "84 04");
    assert!(client.commands.is_empty());
}

#[test]
fn lengths_and_codes_are_those_of_the_protocol() {
    let sizes = [(3, 9, 2), (4, 16, 2), (4, 12, 2), (5, 32, 4), (6, 4, 4), (7, 4, 4), (9, 5, 5), (0, 3, 3)];
    for (size, field, bytes) in sizes {
        assert_eq!(TransportSize(size).bytes(field), bytes);
    }
    for code in 0..=255 {
        let Some(kind) = Type::of(code) else { continue };
        let size = kind.answered_as();
        // One bit is one byte, whose length is 1.
        assert_eq!(size.bytes(size.field(kind.bytes())), kind.bytes(), "{kind:?}");
    }
    let refusals = [
        Refusal::NotAllowed,
        Refusal::OutOfRange,
        Refusal::TypeNotSupported,
        Refusal::TypeInconsistent,
        Refusal::DoesNotExist,
    ];
    assert_eq!(refusals.map(Refusal::code), [3, 5, 6, 7, 10]);
}

/// The transport sizes of values are 03 to 07 and 09; 03 is one bit.
#[test]
fn a_value_of_no_known_kind_is_inconsistent_and_is_not_written() {
    let mut client = Client::ready(480);
    for size in ["00", "01", "02", "03", "08", "0A", "FF"] {
        let length = if size == "03" { "00 10" } else { "00 02" };
        let item = "12 0A 10 04 00 01 00 00 83 00 00 10";
        let answer = client.ask(&format!("32 01 00 00 00 09 00 0E 00 06 05 01 {item} 00 {size} {length} 12 34"));
        assert!(answer.ends_with("05 01 07"), "{size}: {answer}");
    }
    assert!(client.commands.is_empty());
}

/// python-snap7 3 sends them for the state of the CPU and as a sign of life. A write without items remains a wrong frame.
#[test]
fn a_read_without_items_is_answered_with_no_items() {
    let mut client = Client::ready(480);
    assert_eq!(client.job("04", ""), "00 02 00 00 00 00 04 00");
    assert_eq!(client.job("04 00", ""), "00 02 00 00 00 00 04 00");
    assert_eq!(client.job("05 00", ""), "00 00 00 00 85 00");
}
