//! Lists of blocks, information about a block, and upload.

use super::{Client, bytes, hex};

#[test]
fn blocks_are_counted_by_type() {
    let mut client = Client::ready(240);
    // DB10, DB11, DB21 to DB61, ten standard blocks and two user blocks: 55.
    let counts = "30 38 00 00 30 41 00 37 30 42 00 00 30 43 00 00 30 44 00 00 30 45 00 00 30 46 00 00";
    assert_eq!(client.user_data(3, 1, ""), ("00 00".to_owned(), format!("FF 09 00 1C {counts}")));
    // 828D: DB1600 to DB1900 (4), DB2500 to DB2700 (3), DB3000 to DB3300 and DB3500 (5), DB4500, four times eight, and the same other blocks: 57.
    let answer = Client::ready(240).on_828d().user_data(3, 1, "").1;
    assert!(answer.contains("30 41 00 39"), "{answer}");
}

#[test]
fn data_blocks_are_listed_in_order_and_other_types_have_none() {
    let mut client = Client::ready(960);
    let (error, answer) = client.user_data(3, 2, "30 41");
    let answer = bytes(&answer);
    assert_eq!(error, "00 00");
    assert_eq!(hex(&answer[..8]), "FF 09 00 DC 00 02 22 05");
    let numbers: Vec<u16> = answer[4..].chunks(4).map(|entry| u16::from_be_bytes([entry[0], entry[1]])).collect();
    assert_eq!(numbers[..8], [2, 4, 5, 7, 10, 11, 18, 19]);
    assert_eq!(numbers[53..], [1000, 1001]);
    // OB, SDB, FC, SFC, FB, SFB.
    for kind in ["38", "42", "43", "44", "45", "46"] {
        let (error, answer) = client.user_data(3, 2, &format!("30 {kind}"));
        assert_eq!((error.as_str(), answer.as_str()), ("00 00", "FF 09 00 00"), "{kind}");
    }
    assert_eq!(client.user_data(3, 2, "30 39").0, "D2 0E");
    assert_eq!(client.user_data(3, 2, "41").0, "D2 02");
}

/// The client requests the next part with the sequence number of the answer, method 12.
#[test]
fn a_list_longer_than_the_pdu_comes_in_parts() {
    let mut client = Client::ready(240);
    // 55 entries of 4 bytes; 240 - 10 - 12 - 4 = 214 bytes fit.
    let first = bytes(&client.ask("32 07 00 00 00 09 00 08 00 06 00 01 12 04 11 43 02 00 FF 09 00 02 30 41"));
    assert_eq!(first.len(), 240);
    assert_eq!(hex(&first[10..17]), "00 01 12 08 12 83 02");
    let sequence = first[17];
    assert_eq!(first[18..20], [sequence, 1]);
    assert_eq!(hex(&first[22..26]), "FF 09 00 D6");
    let next = format!("32 07 00 00 00 0A 00 0C 00 04 00 01 12 08 12 43 02 {sequence:02X} 00 00 00 00 0A 00 00 00");
    let last = bytes(&client.ask(&next));
    assert_eq!(last[17..20], [sequence, sequence, 0]);
    assert_eq!(hex(&last[22..26]), "FF 09 00 06");
    assert_eq!(hex(&last[28..]), "03 E9 22 05");
    // There is no third part.
    let after = client.ask(&next);
    assert!(after.ends_with("84 01 0A 00 00 00"), "{after}");
}

#[test]
fn a_block_is_described() {
    let mut client = Client::ready(240);
    let (error, answer) = client.user_data(3, 3, "30 41 30 31 30 30 31 41");
    assert_eq!(error, "00 00");
    // DB1001 with 7 bytes: 36 + 7 + 36 = 79 in load memory.
    let head = "FF 09 00 4E 30 41 00 4A 00 00 70 70 01 01 05 0A 03 E9 00 00 00 4F";
    assert!(answer.starts_with(head), "{answer}");
    let answer = bytes(&answer);
    assert_eq!(answer.len(), 4 + 78);
    assert_eq!(answer[4 + 40..4 + 42], [0, 7]);
    assert_eq!(&answer[4 + 42..4 + 50], b"OpenNCK ");
    for (name, error) in [
        ("30 41 30 31 30 30 32 41", "D2 09"), // DB1002
        ("30 38 30 30 30 30 31 41", "D2 09"), // OB1
        ("30 41 39 39 39 39 39 41", "D2 09"),
        ("30 41 30 31 30 30 41 41", "D2 01"),
        ("30 7A 30 31 30 30 31 41", "D2 01"),
        ("30 41 31 41", "D2 01"),
        ("", "D2 01"),
    ] {
        assert_eq!(client.user_data(3, 3, name), (error.to_owned(), "0A 00 00 00".to_owned()), "{name}");
    }
}

const START: &str = "1D 00 00 00 00 00 00 00 09 5F 30 41 30 31 30 30 30 41"; // _0A01000A

#[test]
fn a_data_block_is_uploaded_as_it_was_at_the_start() {
    let mut client = Client::ready(240);
    // 36 + 2048 + 36 = 2120 bytes.
    let started = client.job(START, "");
    assert_eq!(started, "00 10 00 00 00 00 1D 00 01 00 00 00 00 01 07 30 30 30 32 31 32 30");
    client.memory.blocks.get_mut(1000).unwrap().fill(0);
    let mut block = Vec::new();
    let mut pieces = 0;
    loop {
        let piece = bytes(&client.job("1E 00 00 00 00 00 00 01", ""));
        assert_eq!(hex(&piece[..2]), "00 02");
        assert_eq!(piece[6], 0x1E);
        let length = usize::from(u16::from_be_bytes([piece[8], piece[9]]));
        assert_eq!(piece[10..12], [0, 0xFB]);
        assert_eq!(piece.len(), 12 + length);
        block.extend_from_slice(&piece[12..]);
        pieces += 1;
        if piece[7] == 0 {
            break;
        }
        assert_eq!(length, 240 - 12 - 2 - 4);
    }
    assert_eq!((block.len(), pieces), (2120, 10));
    assert_eq!(hex(&block[..12]), "70 70 01 01 05 0A 03 E8 00 00 08 48");
    assert_eq!(hex(&block[34..36]), "08 00");
    assert!(block[36..36 + 2048].iter().all(|byte| *byte == 0xA5));
    // There is no piece after the last one. Requesting it does not end the upload.
    assert_eq!(client.job("1E 00 00 00 00 00 00 01", ""), "00 00 00 00 84 01");
    assert_eq!(client.job("1F 00 00 00 00 00 00 01", ""), "00 01 00 00 00 00 1F");
    assert_eq!(client.job("1F 00 00 00 00 00 00 01", ""), "00 00 00 00 84 01");
    assert_eq!(client.job("1E 00 00 00 00 00 00 01", ""), "00 00 00 00 84 01");
}

#[test]
fn an_upload_of_what_is_not_there_is_refused() {
    let mut client = Client::ready(240);
    for (name, error) in [
        ("09 5F 30 41 30 31 30 30 32 41", "D2 09"),
        ("09 5F 30 38 30 30 30 30 31 41", "D2 09"),
        ("08 30 41 30 31 30 30 30 41", "D2 01"),
        ("09 5F 30 41", "85 00"),
        ("", "85 00"),
    ] {
        assert_eq!(
            client.job(&format!("1D 00 00 00 00 00 00 00 {name}"), ""),
            format!("00 00 00 00 {error}"),
            "{name}"
        );
    }
    for _ in 0..4 {
        assert!(client.job(START, "").starts_with("00 10"));
    }
    assert_eq!(client.job(START, ""), "00 00 00 00 83 04");
}

/// The gaps of a block of the 828D are zeros.
#[test]
fn a_block_of_the_828d_is_uploaded_with_its_gaps() {
    let mut client = Client::ready(960).on_828d();
    // DB3000 ends with byte 2.
    let started = client.job("1D 00 00 00 00 00 00 00 09 5F 30 41 30 33 30 30 30 41", "");
    assert!(started.ends_with("07 30 30 30 30 30 37 35"), "{started}");
    // DB3200 ends with byte 1011; 1008 comes after a gap.
    let started = client.job("1D 00 00 00 00 00 00 00 09 5F 30 41 30 33 32 30 30 41", "");
    assert!(started.ends_with("07 30 30 30 31 30 38 34"), "{started}");
    let first = bytes(&client.job("1E 00 00 00 00 00 00 02", ""));
    assert_eq!(first[12 + 36..][..9], [0xA5, 0xA5, 0xA5, 0xA5, 0xA5, 0xA5, 0xA5, 0xA5, 0]);
}

#[test]
fn blocks_cannot_be_loaded() {
    let mut client = Client::ready(240);
    for function in ["1A", "1B", "1C"] {
        assert_eq!(client.job(&format!("{function} 00 01 00 00 00 00 00"), ""), "00 00 00 00 D2 41");
    }
}
