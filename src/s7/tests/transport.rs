//! TPKT, COTP, setup communication and the S7 header.

use super::{CONNECT, Client, bytes, hex, packet};
use crate::s7::{Connection, Session, Settings};

/// The client rust7 reads exactly 22 bytes.
#[test]
fn a_connection_is_confirmed_with_the_parameters_in_one_order() {
    let confirm = "03 00 00 16 11 D0 00 01 00 01 00 C0 01 0A C1 02 01 00 C2 02 01 02";
    assert_eq!(Client::new().send(&bytes(CONNECT)), [bytes(confirm)]);
    // python-snap7 3 and nmap send the size last.
    let other = "03 00 00 16 11 E0 00 00 00 01 00 C1 02 01 00 C2 02 01 02 C0 01 0A";
    assert_eq!(Client::new().send(&bytes(other)), [bytes(confirm)]);
    // The collectors of 828D: slot 4, their own reference.
    let nck = "03 00 00 16 11 E0 00 00 00 07 00 C1 02 04 00 C2 02 0D 04 C0 01 0A";
    let confirm = "03 00 00 16 11 D0 00 07 00 01 00 C0 01 0A C1 02 04 00 C2 02 0D 04";
    assert_eq!(Client::new().send(&bytes(nck)), [bytes(confirm)]);
}

#[test]
fn a_connection_without_parameters_is_confirmed_without_them() {
    let answers = Client::new().send(&bytes("03 00 00 0B 06 E0 00 00 12 34 00"));
    assert_eq!(answers, [bytes("03 00 00 0B 06 D0 12 34 00 01 00")]);
}

#[test]
fn a_called_tsap_that_is_not_among_those_accepted_is_refused_with_its_reason() {
    let settings = Settings { called: Some(vec![[1, 3], [3, 3]]), ..Settings::default() };
    let mut client = Client::new();
    client.session = Session::new(settings.clone());
    // A disconnect request to the sender, reason 3: address unknown.
    assert_eq!(client.send(&bytes(CONNECT)), [bytes("03 00 00 0B 06 80 00 01 00 00 03")]);
    assert_eq!(client.connection, Connection::Closed);
    let mut client = Client::new();
    client.session = Session::new(settings);
    let nck = CONNECT.replace("C2 02 01 02", "C2 02 03 03");
    assert_eq!(client.send(&bytes(&nck)).len(), 1);
}

#[test]
fn bytes_may_come_one_by_one_and_requests_in_one_piece() {
    let setup = packet(&bytes("32 01 00 00 00 01 00 08 00 00 F0 00 00 01 00 01 01 E0"));
    let all = [bytes(CONNECT), setup.clone(), setup].concat();
    let at_once = Client::new().send(&all);
    let mut client = Client::new();
    let one_by_one: Vec<Vec<u8>> = all.iter().flat_map(|byte| client.send(&[*byte])).collect();
    assert_eq!(at_once.len(), 3);
    assert_eq!(at_once, one_by_one);
}

#[test]
fn a_request_in_several_pieces_is_one_request() {
    let mut client = Client::ready(480);
    let read = bytes("32 01 00 00 00 05 00 0E 00 00 04 01 12 0A 10 02 00 02 03 E8 84 00 00 00");
    let piece = |bytes: &[u8], last: u8| {
        let length = u8::try_from(bytes.len() + 7).unwrap();
        [&[3, 0, 0, length, 2, 0xF0, last], bytes].concat()
    };
    let whole = client.send(&packet(&read));
    assert_eq!(whole.len(), 1);
    let [a, b, c] = [&read[..3], &read[3..11], &read[11..]];
    assert!(client.send(&piece(a, 0)).is_empty());
    assert!(client.send(&piece(b, 0)).is_empty());
    assert!(client.send(&piece(&[], 0)).is_empty());
    assert_eq!(client.send(&piece(c, 0x80)), whole);
}

/// Some collectors send an empty DT after every request.
#[test]
fn an_empty_data_tpdu_is_swallowed() {
    let mut client = Client::ready(480);
    for empty in ["03 00 00 07 02 F0 00", "03 00 00 07 02 F0 80"] {
        assert!(client.send(&bytes(empty)).is_empty());
    }
    assert_eq!(client.connection, Connection::Open);
    assert_eq!(client.read(&["02 00 01 03 E8 84 00 00 00"]), "00 02 00 05 00 00 04 01 FF 04 00 08 A5");
}

/// S7.Net issue 145: a TPDU of 512 bytes holds 509 bytes of a PDU; an answer of 960 bytes is sent in two packets with
/// one write.
#[test]
fn an_answer_longer_than_the_agreed_tpdu_goes_in_pieces() {
    let mut client = Client::new();
    client.send(&bytes(&CONNECT.replace("C0 01 0A", "C0 01 09")));
    client.ask("32 01 00 00 00 01 00 08 00 00 F0 00 00 01 00 01 03 C0");
    let read = bytes("32 01 00 00 00 05 00 0E 00 00 04 01 12 0A 10 02 02 BC 03 E8 84 00 00 00");
    let answers = client.send(&packet(&read));
    let [answer] = answers.as_slice() else { panic!("one write") };
    assert_eq!(hex(&answer[..8]), "03 00 02 04 02 F0 00 32");
    assert_eq!(hex(&answer[516..523]), "03 00 00 D8 02 F0 80");
    // 700 bytes after header, parameter and item; 509 of these 718 bytes fit in a TPDU of 512 bytes, which the TPKT
    // extends to 516.
    assert_eq!(answer.len() - 2 * 7, 12 + 2 + 4 + 700);
}

#[test]
fn a_disconnect_request_is_confirmed_and_ends_the_connection() {
    let mut client = Client::ready(480);
    let answers = client.send(&bytes("03 00 00 0B 06 80 00 01 00 09 00"));
    assert_eq!(answers, [bytes("03 00 00 0A 05 C0 00 09 00 01")]);
    assert_eq!(client.connection, Connection::Closed);
    assert!(client.send(&bytes(CONNECT)).is_empty());
}

#[test]
fn what_is_no_packet_ends_the_connection() {
    let mut ends = Vec::new();
    for wrong in [
        "47 45 54 20",                            // HTTP
        "03 00 00 00",                            // shorter than its header
        "03 00 00 03",                            // the same
        "03 00 00 05 02",                         // too short for a TPDU
        "03 00 00 07 02 F0 80",                   // data before the connection
        "03 00 00 07 09 F0 80",                   // the header of the TPDU ends after the packet
        "03 00 00 07 06 E0 00",                   // a connection request that ends early
        "03 00 00 0D 08 E0 00 00 00 01 00 C0 09", // its parameter ends after it
        "03 00 FF FF",                            // more than a TPDU of 8192 bytes
        "03 00 00 06 01 F0",                      // data without a number
    ] {
        let mut client = Client::new();
        assert!(client.send(&bytes(wrong)).is_empty(), "{wrong}");
        ends.push(client.connection);
    }
    assert_eq!(ends, [Connection::Closed; 10]);
    let mut client = Client::ready(480);
    client.send(&packet(&bytes("72 01 00 00"))); // S7CommPlus
    assert_eq!(client.connection, Connection::Closed);
}

#[test]
fn pieces_without_an_end_are_taken_up_to_a_limit() {
    let mut client = Client::ready(480);
    let mut piece = bytes("03 00 04 07 02 F0 00");
    piece.resize(0x407, 0);
    for _ in 0..4 {
        assert!(client.send(&piece).is_empty());
        assert_eq!(client.connection, Connection::Open);
    }
    client.send(&piece);
    assert_eq!(client.connection, Connection::Closed);
}

#[test]
fn the_pdu_is_what_was_asked_for_within_240_and_960_and_it_may_be_asked_for_again() {
    let mut client = Client::new();
    client.send(&bytes(CONNECT));
    for (asked, agreed) in [("00 70", "00 F0"), ("00 F0", "00 F0"), ("01 E0", "01 E0"), ("FF FF", "03 C0")] {
        let answer = client.ask(&format!("32 01 00 00 00 01 00 08 00 00 F0 00 00 01 00 01 {asked}"));
        assert_eq!(answer, format!("32 03 00 00 00 01 00 08 00 00 00 00 F0 00 00 01 00 01 {agreed}"));
    }
    // Collectors request 100 jobs, pyS7 8.
    let answer = client.ask("32 01 00 00 00 01 00 08 00 00 F0 00 00 64 00 08 03 C0");
    assert_eq!(answer, "32 03 00 00 00 01 00 08 00 00 00 00 F0 00 00 08 00 08 03 C0");
    let answer = client.ask("32 01 00 00 00 01 00 08 00 00 F0 00 00 00 00 00 03 C0");
    assert!(answer.ends_with("F0 00 00 01 00 01 03 C0"));
}

#[test]
fn nothing_is_served_before_the_setup_but_everything_is_answered() {
    let mut client = Client::new();
    client.send(&bytes(CONNECT));
    assert_eq!(client.read(&["02 00 01 03 E8 84 00 00 00"]), "00 00 00 00 84 01");
    assert_eq!(client.user_data(4, 1, "00 11 00 00"), ("84 01".to_owned(), "0A 00 00 00".to_owned()));
}

#[test]
fn unknown_functions_and_wrong_lengths_are_refused_with_an_error_and_the_reference() {
    let mut client = Client::ready(240);
    assert_eq!(client.job("06 00", ""), "00 00 00 00 81 04");
    assert_eq!(client.job("", ""), "00 00 00 00 85 00");
    assert_eq!(client.job("F0 00 00 01", ""), "00 00 00 00 85 00");
    // An unknown kind of PDU, and one that ends before its data part.
    assert_eq!(client.ask("32 09 00 00 AB CD 00 00 00 00"), "32 02 00 00 AB CD 00 00 00 00 81 04");
    assert_eq!(client.ask("32 01 00 00 AB CD 00 02 00 09 04 01"), "32 02 00 00 AB CD 00 00 00 00 85 00");
    // User data with an invalid header, and an unknown group.
    assert_eq!(client.ask("32 07 00 00 AB CD 00 02 00 00 04 01"), "32 02 00 00 AB CD 00 00 00 00 85 00");
    assert_eq!(client.user_data(9, 1, ""), ("81 04".to_owned(), "0A 00 00 00".to_owned()));
    assert_eq!(client.user_data(1, 1, "00"), ("D4 05".to_owned(), "0A 00 00 00".to_owned()));
    assert_eq!(client.user_data(4, 0x13, "00"), ("D4 05".to_owned(), "0A 00 00 00".to_owned()));
    // A request longer than the negotiated PDU.
    let long = format!("32 01 00 00 00 07 00 02 00 F0 04 01{}", " 00".repeat(0xF0));
    assert_eq!(client.ask(&long), "32 02 00 00 00 07 00 00 00 00 85 00");
    assert_eq!(client.connection, Connection::Open);
}

#[test]
fn acknowledgements_of_a_client_ask_for_nothing() {
    let mut client = Client::ready(240);
    for pdu in [
        "32 02 00 00 00 01 00 00 00 00 00 00",
        "32 03 00 00 00 01 00 00 00 00 00 00",
        "32 07 00 00 00 01 00 0C 00 04 00 01 12 08 12 84 01 01 00 00 00 00 0A 00 00 00",
    ] {
        assert!(client.send(&packet(&bytes(pdu))).is_empty());
    }
}
