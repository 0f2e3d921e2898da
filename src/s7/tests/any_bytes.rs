//! Arbitrary input: no panic, no answer longer than the PDU, no change by a refused request.

use proptest::prelude::*;

use super::{CONNECT, Client, bytes, changed, packet};
use crate::s7::wire::cotp::Tpdu;
use crate::s7::wire::data::Values;
use crate::s7::wire::date_and_time::DateAndTime;
use crate::s7::wire::header::Message;
use crate::s7::wire::items::Items;
use crate::s7::wire::tpkt;
use crate::s7::wire::user_data;

/// Every PDU in these answers is complete and within the negotiated length.
fn check(client: &Client, answers: &[Vec<u8>]) {
    for answer in answers {
        let mut rest = answer.as_slice();
        let mut pdu = Vec::new();
        while !rest.is_empty() {
            let tpkt::Packet::Whole { content, length } = tpkt::split(rest) else { panic!("{answer:02X?}") };
            if let Tpdu::Data { piece, .. } = Tpdu::parse(content) {
                pdu.extend_from_slice(piece);
            }
            rest = &rest[length..];
        }
        assert!(pdu.len() <= client.session.pdu_length(), "{} bytes: {pdu:02X?}", pdu.len());
        if !pdu.is_empty() {
            let message = Message::parse(&pdu).expect("our own PDU can be read");
            let head = if message.kind == 7 { 10 } else { 12 };
            assert_eq!(head + message.parameter.len() + message.data.len(), pdu.len());
        }
    }
}

/// Almost correct requests: real functions and items with some bytes changed.
fn nearly_right() -> impl Strategy<Value = Vec<u8>> {
    let templates = [
        "32 01 00 00 00 01 00 08 00 00 F0 00 00 01 00 01 01 E0",
        "32 01 00 00 00 05 00 0E 00 00 04 01 12 0A 10 02 00 02 03 E8 84 00 00 00",
        "32 01 00 00 00 05 00 18 00 00 04 02 12 08 82 41 00 02 00 01 74 01 12 0A 10 02 00 02 03 E8 84 00 00 00",
        "32 01 00 00 00 05 00 0E 00 05 05 01 12 0A 10 02 00 01 03 E8 84 00 00 00 00 04 00 08 11",
        "32 07 00 00 00 09 00 08 00 08 00 01 12 04 11 44 01 00 FF 09 00 04 00 11 00 00",
        "32 07 00 00 00 09 00 0C 00 04 00 01 12 08 12 44 01 01 00 00 00 00 0A 00 00 00",
        "32 07 00 00 00 09 00 08 00 0C 00 01 12 04 11 43 03 00 FF 09 00 08 30 41 30 31 30 30 31 41",
        "32 07 00 00 00 09 00 08 00 06 00 01 12 04 11 43 02 00 FF 09 00 02 30 41",
        "32 07 00 00 00 09 00 08 00 0E 00 01 12 04 11 47 02 00 FF 09 00 0A 00 19 26 11 22 03 04 05 67 81",
        "32 07 00 00 00 09 00 08 00 14 00 01 12 04 11 42 01 00 FF 09 00 10 00 01 00 01 12 0A 10 02 00 01 03 E8 84 00 00 00",
        "32 07 00 00 00 09 00 08 00 06 00 01 12 04 11 42 04 00 FF 09 00 02 00 01",
        "32 01 00 00 00 05 00 12 00 00 1D 00 00 00 00 00 00 00 09 5F 30 41 30 31 30 30 30 41",
        "32 01 00 00 00 05 00 08 00 00 1E 00 00 00 00 00 00 01",
        "32 01 00 00 00 05 00 14 00 00 28 00 00 00 00 00 00 FD 00 00 09 50 5F 50 52 4F 47 52 41 4D",
    ];
    let template = (0..templates.len()).prop_map(move |at| bytes(templates[at]));
    changed(template)
}

proptest! {
    #[test]
    fn parsers_take_any_bytes(bytes in proptest::collection::vec(any::<u8>(), 0..600), count in 0..300_usize) {
        let _ = tpkt::split(&bytes);
        let _ = Tpdu::parse(&bytes);
        let _ = Message::parse(&bytes);
        let _ = Items::new(&bytes, count).count();
        if let Some(values) = Values::new(&bytes, count) {
            let length: usize = values.map(|(_, value)| value.len() + 4).sum();
            prop_assert!(length <= bytes.len());
        }
        if let Some(time) = DateAndTime::parse(&bytes) {
            prop_assert_eq!(DateAndTime::parse(&time.bytes()), Some(time));
        }
        let (parameter, data) = bytes.split_at(bytes.len() / 2);
        let _ = user_data::parse(parameter, data);
    }

    #[test]
    fn a_session_takes_any_bytes(pieces in proptest::collection::vec(proptest::collection::vec(any::<u8>(), 0..200), 0..6)) {
        let mut client = Client::new();
        client.send(&bytes(CONNECT));
        for piece in pieces {
            let answers = client.send(&piece);
            check(&client, &answers);
        }
        prop_assert!(client.commands.is_empty());
    }

    #[test]
    fn a_session_takes_any_pdu(pdus in proptest::collection::vec(proptest::collection::vec(any::<u8>(), 0..300), 1..6)) {
        let mut client = Client::ready(240);
        for pdu in pdus {
            let answers = client.send(&packet(&[&[0x32, 1], pdu.as_slice()].concat()));
            check(&client, &answers);
        }
    }

    #[test]
    fn requests_that_are_nearly_right_are_answered_within_the_pdu(
        pdus in proptest::collection::vec(nearly_right(), 1..12),
        small in any::<bool>(),
        at_the_nck in any::<bool>(),
    ) {
        let mut client = Client::new();
        let size = if small { "C0 01 07" } else { "C0 01 0A" };
        let called = if at_the_nck { "C2 02 0D 04" } else { "C2 02 01 02" };
        client.send(&bytes(&CONNECT.replace("C0 01 0A", size).replace("C2 02 01 02", called)));
        client.send(&packet(&bytes("32 01 00 00 00 01 00 08 00 00 F0 00 00 01 00 01 00 F0")));
        for (time, pdu) in (0..).zip(pdus) {
            let before = client.memory.clone();
            let answers = client.send(&packet(&pdu));
            check(&client, &answers);
            prop_assert_eq!(&client.memory, &before); // nothing is written before the step
            let is_refused = answers.iter().all(|answer| !answer.contains(&0xFF));
            if is_refused && pdu.get(10) == Some(&5) {
                prop_assert!(client.commands.is_empty());
            }
            client.step();
            let pushes = client.tick(time * 100);
            check(&client, &pushes);
        }
    }
}
