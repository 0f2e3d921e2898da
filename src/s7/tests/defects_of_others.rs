//! Defects that crash other servers or make them silently wrong; each is tested on this server.

use super::{CONNECT, Client, bytes, hex, packet};
use crate::s7::Connection;

/// Crashes snap7's server: an answer buffer of 4096 bytes on the stack. DB1000 has 2048 bytes. Items beyond that are out of range; existing
/// bytes that do not fit in the PDU make the whole request a wrong frame.
#[test]
fn a_read_longer_than_any_pdu_is_refused() {
    let mut client = Client::ready(480);
    for item in [
        "02 13 88 03 E8 84 00 00 00", // 5000 bytes
        "02 75 30 03 E8 84 00 00 00", // 30000
        "02 FF FF 03 E8 84 00 00 00", // 65535, openplc-runtime issue 153
        "06 3F FF 03 E8 84 00 00 00", // 16383 double words
        "0F FF FF 03 E8 84 00 00 00", // half a megabyte
    ] {
        assert_eq!(client.read(&[item]), "00 02 00 04 00 00 04 01 05 00 00 00");
    }
    for item in ["02 08 00 03 E8 84 00 00 00", "06 02 00 03 E8 84 00 00 00"] {
        assert_eq!(client.read(&[item]), "00 00 00 00 85 00"); // 2048 bytes, 512 double words: the whole block
    }
    let each = "02 0F A0 03 E8 84 00 00 00"; // 20 x 4000
    assert_eq!(client.read(&[each; 20]), format!("00 02 00 50 00 00 04 14{}", " 05 00 00 00".repeat(20)));
    let each = "02 07 D0 03 E8 84 00 00 00"; // 20 x 2000
    assert_eq!(client.read(&[each; 20]), "00 00 00 00 85 00");
    let each = "02 00 DE 03 E8 84 00 00 00"; // 20 x 222
    assert_eq!(client.read(&[each; 20]), "00 00 00 00 85 00");
    assert_eq!(client.connection, Connection::Open);
}

/// An invalid item does not affect the values of the others, whatever its length is.
#[test]
fn an_item_out_of_range_is_refused_by_itself_however_long_it_is() {
    let mut client = Client::ready(240);
    let good = "02 00 01 03 E8 84 00 00 00";
    for (wild, code) in [
        ("02 FF FF 03 E8 84 00 00 00", "05"), // 65535 bytes of 2048
        ("0F FF FF 03 E8 84 00 00 00", "05"), // half a megabyte
        ("02 FF FF 00 63 84 00 00 00", "0A"), // DB99 does not exist
        ("02 FF FF 00 00 83 00 00 00", "05"), // flags
        ("02 FF FF 00 00 83 FF FF F8", "05"),
        ("1D FF FF 00 00 1D 00 00 00", "05"), // timers
    ] {
        let answer = client.read(&[good, wild, good]);
        let expected = format!("00 02 00 0F 00 00 04 03 FF 04 00 08 A5 00 {code} 00 00 00 FF 04 00 08 A5");
        assert_eq!(answer, expected, "{wild}");
    }
    let mut client = client.on_828d();
    let answer = client.read(&[good, "02 FF FF 0E D8 84 00 00 00"]); // DB3800 has gaps and ends earlier
    assert_eq!(answer, "00 02 00 0A 00 00 04 02 FF 04 00 08 A5 00 05 00 00 00");
}

/// snap7's server answers 241 and 274 bytes at 240.
#[test]
fn the_longest_answer_is_as_long_as_the_pdu_and_not_a_byte_longer() {
    for pdu in [240_u16, 480, 960] {
        let mut client = Client::ready(pdu);
        let fits = pdu - 12 - 2 - 4;
        let item = |length: u16| format!("02 {:02X} {:02X} 03 E8 84 00 00 00", length >> 8, length & 0xFF);
        let answer = client.read(&[&item(fits)]);
        assert_eq!(bytes(&answer).len() + 6, usize::from(pdu));
        assert_eq!(client.read(&[&item(fits + 1)]), "00 00 00 00 85 00");
    }
}

/// snap7's server cuts a read to 20 items; a write with more items overruns its stack. nodes7 sends more than 50.
#[test]
fn as_many_items_as_fit_are_served() {
    let mut client = Client::ready(960);
    let item = "02 00 01 03 E8 84 00 00 00";
    let answer = client.read(&[item; 70]);
    assert!(answer.starts_with("00 02 01 A3 00 00 04 46 FF 04 00 08 A5 00"), "{answer}"); // 70 x 5 + 69
    assert_eq!(answer.matches("FF 04 00 08 A5").count(), 70);
    let data = vec!["00 04 00 08 11"; 50].join(" 00 ");
    let answer = client.write(&[item; 50], &data);
    assert_eq!(answer, format!("00 02 00 32 00 00 05 32{}", " FF".repeat(50)));
    assert_eq!(client.commands.len(), 50);
}

/// Crashes snap7's server: from the third piece on, its offsets count twice.
#[test]
fn three_pieces_of_1300_bytes_and_five_of_800_are_put_together_and_refused() {
    for (count, length) in [(3, 1300), (5, 800)] {
        let mut client = Client::ready(480);
        let mut answers = Vec::new();
        for piece in 1..=count {
            let mut bytes = if piece == 1 { bytes("32 01 00 00 00 07 00 02 0F FF 04 01") } else { Vec::new() };
            bytes.resize(length, 0);
            let [high, low] = u16::try_from(length + 7).unwrap().to_be_bytes();
            let end = if piece == count { 0x80 } else { 0 };
            answers.extend(client.send(&[&[3, 0, high, low, 2, 0xF0, end], bytes.as_slice()].concat()));
        }
        assert_eq!(answers.len(), 1);
        assert_eq!(hex(&answers[0][7..]), "32 02 00 00 00 07 00 00 00 00 85 00");
    }
}

/// snap7's server writes its own memory into the block: it does not compare the length with the received bytes.
#[test]
fn a_write_of_more_than_what_came_writes_nothing() {
    let mut client = Client::ready(480);
    let item = "02 01 00 03 E8 84 00 00 00";
    assert_eq!(client.write(&[item], "00 04 08 00 11 22 33 44"), "00 00 00 00 85 00");
    assert_eq!(client.write(&[item], "00 04 00 20 11 22 33 44"), "00 02 00 01 00 00 05 01 07");
    assert!(client.commands.is_empty());
}

/// SCADACS/snap7 pull request 9: REAL items of a multi-item write go to the wrong address.
#[test]
fn a_real_in_the_middle_of_a_write_keeps_its_place() {
    let mut client = Client::ready(480);
    let answer = client.write(
        &["02 00 01 03 E8 84 00 00 00", "08 00 02 03 E8 84 00 00 20", "05 00 01 03 E8 84 00 00 60"],
        "00 04 00 08 11 00 00 07 00 08 3F 80 00 00 40 00 00 00 00 05 00 10 FF FE",
    );
    assert_eq!(answer, "00 02 00 03 00 00 05 03 FF FF FF");
    client.step();
    let block = client.memory.blocks.get(1000).unwrap();
    assert_eq!(hex(&block[..16]), "11 A5 A5 A5 3F 80 00 00 40 00 00 00 FF FE A5 A5");
}

/// @st-one-io/nodes7 sends no fill bytes in a write.
#[test]
fn a_write_without_fill_bytes_is_understood() {
    let mut client = Client::ready(480);
    let items = ["02 00 01 03 E8 84 00 00 00", "02 00 03 03 E8 84 00 00 10", "02 00 01 03 E8 84 00 00 50"];
    let with = "00 04 00 08 11 00 00 04 00 18 22 33 44 00 00 04 00 08 55";
    let without = "00 04 00 08 11 00 04 00 18 22 33 44 00 04 00 08 55";
    let mut written = Vec::new();
    for data in [with, without, &format!("{with} 00")] {
        assert_eq!(client.write(&items, data), "00 02 00 03 00 00 05 03 FF FF FF", "{data}");
        written.push(std::mem::take(&mut client.commands));
    }
    assert_eq!(written[0].len(), 5);
    assert_eq!(written[0], written[1]);
    assert_eq!(written[0], written[2]);
}

/// python-snap7's server writes only the first of several items.
#[test]
fn every_item_of_a_write_is_written() {
    let mut client = Client::ready(240);
    client.write(&["02 00 01 03 E8 84 00 00 00", "02 00 01 03 E8 84 00 00 08"], "00 04 00 08 11 00 00 04 00 08 22");
    client.step();
    assert_eq!(client.memory.blocks.get(1000).unwrap()[..3], [0x11, 0x22, 0xA5]);
}

/// snap7's and python-snap7's servers read every syntax as `10`.
#[test]
fn a_syntax_that_is_not_any_type_is_not_read_as_one() {
    let mut client = Client::ready(240);
    for syntax in ["B2", "B0", "A2", "13", "00"] {
        let answer = client.job(&format!("04 01 12 0A {syntax} 02 00 01 03 E8 84 00 00 00"), "");
        assert!(answer.ends_with(" 00 00 00"), "{answer}");
        assert!(!answer.contains("FF 04"), "{answer}");
    }
}

/// python-snap7's server answers bits as bytes.
#[test]
fn a_bit_is_answered_as_a_bit() {
    let mut client = Client::ready(240);
    assert!(client.read(&["01 00 01 03 E8 84 00 00 00"]).ends_with("FF 03 00 01 01"));
    assert!(client.read(&["01 00 01 03 E8 84 00 00 01"]).ends_with("FF 03 00 01 00"));
}

/// The Rust snap7-server answers with zeros for blocks that do not exist, and has no bounds checks.
#[test]
fn a_missing_block_is_not_full_of_zeros() {
    let mut client = Client::ready(240);
    assert!(client.read(&["02 00 01 00 63 84 00 00 00"]).ends_with("04 01 0A 00 00 00"));
    assert!(client.read(&["02 00 02 03 E8 84 00 3F F8"]).ends_with("04 01 05 00 00 00"));
}

/// The Rust snap7-server fails on a second setup.
#[test]
fn the_setup_may_be_said_twice() {
    let mut client = Client::ready(240);
    client.get_ready(480);
    assert!(client.read(&["02 00 01 03 E8 84 00 00 00"]).ends_with("FF 04 00 08 A5"));
}

/// The Rust snap7-server confirms without parameters, PLC4X refuses a confirm with one byte too many.
#[test]
fn the_confirm_is_as_long_as_it_says() {
    let confirm = &Client::new().send(&bytes(CONNECT))[0];
    assert_eq!(confirm.len(), 22);
    assert_eq!((usize::from(confirm[3]), usize::from(confirm[4])), (22, 17));
}

/// snap7's server does not answer unknown functions; python-snap7's client sends a one-byte read and ignores the answer.
#[test]
fn there_is_no_silence() {
    let mut client = Client::ready(240);
    for function in 0..=255_u8 {
        client.job(&format!("{function:02X}"), "");
        for group in 0..16 {
            client.user_data(group, function, "");
        }
    }
    assert_eq!(client.connection, Connection::Open);
}

/// apache/plc4x issue 1704: the number of a TPDU stays 0.
#[test]
fn the_number_of_a_tpdu_stays_0() {
    let mut client = Client::ready(240);
    for _ in 0..3 {
        let answers = client.send(&packet(&bytes("32 01 00 00 00 01 00 01 00 00 06")));
        assert_eq!(hex(&answers[0][4..7]), "02 F0 80");
    }
}

/// python-snap7 issue 70: after a time-out, the next answer is taken for the last request.
#[test]
fn answers_come_in_the_order_of_the_requests_with_their_references() {
    let mut client = Client::ready(240);
    let ask = |reference: u8| {
        packet(&bytes(&format!("32 01 00 00 00 {reference:02X} 00 0E 00 00 04 01 12 0A 10 02 00 01 03 E8 84 00 00 00")))
    };
    let answers = client.send(&[ask(7), ask(3), ask(9)].concat());
    let references: Vec<u8> = answers.iter().map(|answer| answer[7 + 5]).collect();
    assert_eq!(references, [7, 3, 9]);
}

/// snap7's server sends a weekday that is one too low, and answers the information request for a missing block from uninitialised memory.
#[test]
fn the_weekday_is_right_and_a_missing_block_has_no_information() {
    let mut client = Client::ready(240);
    assert!(client.user_data(7, 1, "").1.ends_with("81")); // a Sunday is 1
    assert_eq!(client.user_data(3, 3, "30 41 30 39 39 39 39 41").1, "0A 00 00 00");
}
