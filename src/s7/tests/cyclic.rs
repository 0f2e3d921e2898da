//! Subscriptions.

use super::{Client, bytes, hex};

/// DB1000.DBB0 and DB1000.DBW2, one item of odd length.
const ITEMS: &str = "12 0A 10 02 00 01 03 E8 84 00 00 00 12 0A 10 04 00 01 03 E8 84 00 00 10";

/// The number of the job, its data part after the header, and the kind in the parameter part.
fn push(answer: &[u8]) -> (u8, String, u8) {
    let pdu = &answer[7..];
    assert_eq!(hex(&pdu[..6]), "32 07 00 00 00 00");
    assert_eq!(hex(&pdu[10..15]), "00 01 12 08 12");
    assert_eq!(usize::from(u16::from_be_bytes([pdu[24], pdu[25]])), pdu.len() - 26);
    (pdu[17], hex(&pdu[26..]), pdu[15])
}

fn subscribe(client: &mut Client, function: u8, head: &str) -> u8 {
    let request = bytes(&format!("{head} {ITEMS}"));
    let ask = format!(
        "32 07 00 00 00 09 00 08 00 {:02X} 00 01 12 04 11 42 {function:02X} 00 FF 09 00 {:02X} {}",
        request.len() + 4,
        request.len(),
        hex(&request)
    );
    let answer = bytes(&client.ask(&ask));
    assert_eq!(hex(&answer[14..17]), format!("12 82 {function:02X}"));
    assert_eq!(hex(&answer[22..]), "FF 09 00 0E 00 02 FF 04 00 08 A5 00 FF 04 00 10 A5 A5");
    assert!(client.session.has_subscriptions());
    answer[17]
}

/// Time base 0 and factor 2: every 200 ms.
#[test]
fn values_come_in_cycles_until_nobody_wants_them() {
    let mut client = Client::ready(240);
    let job = subscribe(&mut client, 1, "00 02 00 02");
    assert!(client.tick(1000).is_empty());
    assert!(client.tick(1199).is_empty());
    client.memory.blocks.get_mut(1000).unwrap()[0] = 7;
    let pushed = client.tick(1200);
    let [answer] = pushed.as_slice() else { panic!("one push") };
    assert_eq!(push(answer), (job, "00 02 FF 04 00 08 07 00 FF 04 00 10 A5 A5".to_owned(), 0x02));
    assert!(client.tick(1399).is_empty());
    assert_eq!(client.tick(1400), pushed);
    // A delayed subscription does not send a burst.
    assert_eq!(client.tick(5000).len(), 1);
    assert!(client.tick(5199).is_empty());
    let ended = client.user_data(2, 4, &format!("05 {job:02X}"));
    assert_eq!(ended, ("00 00".to_owned(), "0A 00 00 00".to_owned()));
    assert!(client.tick(9000).is_empty());
    assert!(!client.session.has_subscriptions());
    assert_eq!(client.user_data(2, 4, &format!("05 {job:02X}")).0, "D4 05");
}

#[test]
fn values_that_are_wanted_on_change_come_only_then() {
    let mut client = Client::ready(240);
    let job = subscribe(&mut client, 5, "00 02 00 01");
    for time in [0, 100, 200] {
        assert!(client.tick(time).is_empty());
    }
    client.memory.blocks.get_mut(1000).unwrap()[2] = 1;
    assert_eq!(push(&client.tick(300)[0]), (job, "00 02 FF 04 00 08 A5 00 FF 04 00 10 01 A5".to_owned(), 0x02));
    assert!(client.tick(400).is_empty());
    // A byte outside the subscription.
    client.memory.blocks.get_mut(1000).unwrap()[1] = 1;
    assert!(client.tick(500).is_empty());
}

/// Units of 0.1 s, 1 s and 10 s.
#[test]
fn the_time_base_counts() {
    for (head, due) in [("00 02 00 01", 100), ("00 02 01 01", 1000), ("00 02 02 03", 30_000)] {
        let mut client = Client::ready(240);
        subscribe(&mut client, 1, head);
        assert!(client.tick(0).is_empty());
        assert!(client.tick(due - 1).is_empty());
        assert_eq!(client.tick(due).len(), 1);
    }
}

#[test]
fn what_cannot_be_sent_by_itself_is_refused() {
    let mut client = Client::ready(240);
    for (function, request, error) in [
        (1, "00 00 00 01".to_owned(), "D4 05"),       // no item
        (1, format!("00 02 00 00 {ITEMS}"), "D4 05"), // no interval
        (1, format!("00 02 03 01 {ITEMS}"), "D4 05"), // no such base
        (1, format!("00 03 00 01 {ITEMS}"), "D4 05"), // an item is missing
        (1, "00 01".to_owned(), "D4 05"),
        (5, "00 01 00 01 12 0A 10 02 00 F0 03 E8 84 00 00 00".to_owned(), "85 00"), // longer than the PDU
        (4, "05".to_owned(), "D4 05"),
        (7, "00".to_owned(), "D4 05"),
    ] {
        assert_eq!(client.user_data(2, function, &request), (error.to_owned(), "0A 00 00 00".to_owned()), "{request}");
    }
    assert!(!client.session.has_subscriptions());
}

#[test]
fn a_client_has_32_jobs_and_ends_them_all_with_number_0() {
    let mut client = Client::ready(240);
    let numbers: Vec<u8> = (0..32).map(|_| subscribe(&mut client, 1, "00 02 00 01")).collect();
    let mut different = numbers.clone();
    different.sort_unstable();
    different.dedup();
    assert_eq!(different.len(), 32);
    assert_eq!(client.user_data(2, 1, &format!("00 02 00 01 {ITEMS}")).0, "D4 04");
    assert_eq!(client.tick(0).len() + client.tick(100).len(), 32);
    assert_eq!(client.user_data(2, 4, "00 00").0, "00 00");
    assert!(client.tick(1000).is_empty());
}

/// A subscription for a long PDU may not fit a short one, and would never be sent.
#[test]
fn a_second_setup_ends_what_comes_by_itself() {
    let mut client = Client::ready(480);
    subscribe(&mut client, 1, "00 02 00 02");
    client.ask("32 01 00 00 00 0A 00 08 00 00 F0 00 00 01 00 01 00 F0");
    assert!(!client.session.has_subscriptions());
    assert!(client.tick(5000).is_empty());
}
