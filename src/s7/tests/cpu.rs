//! The CPU: system state lists, clock, stop and restart, passwords, messages.

use super::{Client, bytes, hex};
use crate::s7::station::{Diagnosis, Protection};
use crate::s7::{Command, CpuState, DateAndTime, Restart};

/// A list with a PDU that holds all of it: length and number of its records, and the records.
fn list(client: &mut Client, list: &str, index: &str) -> (u16, u16, Vec<u8>) {
    let (error, answer) = client.user_data(4, 1, &format!("{list} {index}"));
    assert_eq!(error, "00 00", "{list} {index}");
    let answer = bytes(&answer);
    assert_eq!(hex(&answer[..2]), "FF 09");
    assert_eq!(usize::from(u16::from_be_bytes([answer[2], answer[3]])), answer.len() - 4);
    assert_eq!(hex(&answer[4..6]), list);
    let (length, count) = (u16::from_be_bytes([answer[8], answer[9]]), u16::from_be_bytes([answer[10], answer[11]]));
    // The extract 0Fxx is a header without records.
    let sent = if list.starts_with("0F") { 0 } else { usize::from(count) };
    assert_eq!(answer.len() - 12, usize::from(length) * sent, "{list}");
    (length, count, answer[12..].to_vec())
}

#[test]
fn every_list_that_is_listed_can_be_read() {
    let mut client = Client::ready(960);
    let (length, count, lists) = list(&mut client, "00 00", "00 00");
    assert_eq!(length, 2);
    let lists: Vec<String> = lists.chunks(2).map(hex).collect();
    assert_eq!(lists.len(), usize::from(count));
    assert!(lists.is_sorted());
    for needed in [
        "00 00", "00 11", "00 12", "00 13", "00 19", "00 1C", "00 74", "00 A0", "01 11", "01 1C", "01 31", "01 32",
        "01 74", "02 22", "02 32", "04 24", "0F 00",
    ] {
        assert!(lists.contains(&needed.to_owned()), "{needed}");
    }
    for known in &lists {
        let index = match known.as_str() {
            "01 11" | "01 1C" | "01 13" | "01 19" | "01 74" => "00 01",
            "01 12" => "01 00",
            _ => "00 00",
        };
        list(&mut client, known, index);
    }
}

/// System Software for S7-300/400, 33.16: in record 8 of list 0132 the time follows 22 bytes behind its beginning, and the last byte is 1: the
/// status is valid. The other records tell of functions that this CPU does not have. No rack but 0, no module in it but the CPU.
#[test]
fn lists_that_engineering_tools_ask_for_can_be_read() {
    let mut client = Client::ready(960);
    for (of, indices) in [("01 31", &[2, 4, 5, 6, 9][..]), ("01 32", &[1, 2, 9, 10, 11])] {
        for index in indices {
            let (length, count, record) = list(&mut client, of, &format!("00 {index:02X}"));
            assert_eq!((length, count), (40, 1), "{of} {index}");
            assert_eq!(record[..2], [0, *index], "{of}");
            assert!(record[2..].iter().all(|byte| *byte == 0), "{of} {index}");
        }
    }
    let time = client.clock.bytes();
    let (_, _, record) = list(&mut client, "01 32", "00 08");
    assert_eq!((&record[..2], &record[22..30], record[39]), (&[0, 8][..], &time[..], 1));
    let (length, count, record) = list(&mut client, "0D 91", "00 00");
    assert_eq!((length, count), (16, 1));
    assert_eq!(hex(&record), "00 00 02 00 00 00 00 C0 00 C0 00 00 00 02 00 00");
    assert_eq!(client.user_data(4, 1, "0D 91 00 01").0, "D4 02", "there is no rack 1");
    let (_, _, record) = list(&mut client, "02 22", "00 50");
    assert_eq!(hex(&record[..4]), "00 00 1A 50");
    for (of, head) in [("00 1A", "0F 1A"), ("00 1B", "0F 1B"), ("00 3A", "0F 3A"), ("0A 00", "0F 0A")] {
        assert_eq!(list(&mut client, of, "00 00").1, 0, "{of}");
        assert_eq!(list(&mut client, head, "00 00").1, 0, "{head}");
    }
}

/// System Software for S7-300/400, 33.2: the fourth word of the header is the number of records, and `0Fxx` is only the header. snap7 has
/// `0F 14 00 00 00 08 00 09` and others, captured at a CPU 315.
#[test]
fn the_head_of_a_list_tells_how_many_records_the_list_has() {
    let mut client = Client::ready(960);
    client.diagnosis = vec![Diagnosis::of_state(Diagnosis::RUN, client.clock); 3];
    for (head, whole, index) in [
        ("0F 00", "00 00", "00 00"),
        ("0F 11", "00 11", "00 00"),
        ("0F 12", "00 12", "00 00"),
        ("0F 13", "00 13", "00 00"),
        ("0F 14", "00 14", "00 00"),
        ("0F 15", "00 15", "00 00"),
        ("0F 19", "00 19", "00 00"),
        ("0F 1C", "00 1C", "00 00"),
        ("0F 31", "01 31", "00 01"),
        ("0F 32", "01 32", "00 04"),
        ("0F 74", "00 74", "00 00"),
        ("0F A0", "00 A0", "00 00"),
    ] {
        let (length, count, _) = list(&mut client, whole, index);
        assert!(count > 0, "{whole}");
        // FF, an octet string of the eight bytes of a header, and nothing after it.
        let alone = format!("FF 09 00 08 {head} 00 00 {length:04X} {count:04X}");
        assert_eq!(client.user_data(4, 1, &format!("{head} 00 00")).1.replace(' ', ""), alone.replace(' ', ""));
    }
}

#[test]
fn a_list_or_an_index_that_does_not_exist_is_refused() {
    let mut client = Client::ready(480);
    for (asked, error) in [
        ("00 91 00 00", "D4 01"),
        ("FF FF FF FF", "D4 01"),
        ("01 11 00 02", "D4 02"),
        ("01 1C 00 06", "D4 02"),
        ("01 31 00 07", "D4 02"),
        ("01 32 00 03", "D4 02"),
        ("02 32 00 01", "D4 02"),
        ("01 74 00 02", "D4 02"),
        ("01 12 09 00", "D4 02"),
        ("00 11", "D4 05"),
        ("", "D4 05"),
    ] {
        assert_eq!(client.user_data(4, 1, asked), (error.to_owned(), "0A 00 00 00".to_owned()), "{asked}");
    }
}

/// conpot issue 586: nmap and plcscan need at least 125 bytes and records of 28; the last three bytes are the version.
#[test]
fn the_order_number_lies_where_nmap_looks_for_it() {
    let mut client = Client::ready(480);
    let ask = "32 07 00 00 00 00 00 08 00 08 00 01 12 04 11 44 01 00 FF 09 00 04 00 11 00 01";
    let packet = super::packet(&bytes(&client.ask(ask)));
    assert!(packet.len() >= 125);
    assert_eq!(&packet[43..63], b"6ES7 317-2EK14-0AB0 ");
    assert_eq!(&packet[71..91], b"6ES7 317-2EK14-0AB0 ");
    assert_eq!(packet[121..], [b'V', 3, 2, 6]);
    let (length, count, _) = list(&mut client, "00 11", "00 00");
    assert_eq!((length, count), (28, 3));
    let (_, count, one) = list(&mut client, "01 11", "00 06");
    assert_eq!((count, &one[..3]), (1, &[0, 6, b'6'][..]));
}

/// python-snap7 expects each name at its offset after length and number of the records.
#[test]
fn the_names_lie_where_clients_look_for_them() {
    let mut client = Client::ready(480);
    let (length, count, records) = list(&mut client, "00 1C", "00 00");
    assert_eq!((length, count), (34, 10));
    for (at, text) in [(2, "OpenNCK\0"), (36, "PLC 317-2 PN/DP\0"), (104, "OpenNCK simulator\0"), (138, "SIMULATED\0")]
    {
        assert_eq!(&records[at..at + text.len()], text.as_bytes());
    }
    assert_eq!(&records[172..188], b"CPU 317-2 PN/DP\0");
    let (_, _, one) = list(&mut client, "01 1C", "00 05");
    assert_eq!(&one[..5], &[0, 5, b'S', b'I', b'M']);
}

/// 08 RUN, 04 STOP in the fourth byte of the record, where snap7 and Sharp7 look.
#[test]
fn the_operating_state_is_live() {
    let mut client = Client::ready(480);
    let (length, count, run) = list(&mut client, "04 24", "00 00");
    assert_eq!((length, count, run[3]), (20, 1, 8));
    client.state = CpuState::Stop;
    assert_eq!(list(&mut client, "04 24", "00 00").2[3], 4);
    // Lamps: 4 is RUN, 5 STOP.
    assert_eq!(list(&mut client, "01 74", "00 04").2, [0, 4, 0, 0]);
    assert_eq!(list(&mut client, "01 19", "00 05").2, [0, 5, 1, 0]);
}

/// 0222 has the last start of an organization block, 0424 the last change of the operating state; both come from the diagnostic buffer.
#[test]
fn restarts_and_changes_of_the_state_have_their_time() {
    let mut client = Client::ready(480);
    let clock = client.clock;
    let at = |hour| DateAndTime { hour, ..clock };
    let entry = |(event, hour)| Diagnosis::of_state(event, at(hour));
    let cold = [(0x4302, 2), (0x4301, 2), (0x1385, 2), (0x4304, 1), (0x4302, 0), (0x4301, 0), (0x4300, 0)].map(entry);
    client.diagnosis = cold.to_vec();
    let (length, count, start) = list(&mut client, "02 22", "00 66"); // OB102
    assert_eq!((length, count), (28, 1));
    assert_eq!(hex(&start[..20]), "13 85 1B 66 00 00 00 00 00 00 00 00 26 11 22 02 04 05 67 81");
    assert_eq!(client.user_data(4, 1, "02 22 00 64").0, "D4 02"); // OB100 was not started
    assert_eq!(hex(&list(&mut client, "02 22", "00 01").2[..4]), "11 03 01 01");
    let state = list(&mut client, "04 24", "00 00").2;
    assert_eq!(hex(&state), "43 02 FF 08 00 00 00 00 00 00 00 00 26 11 22 02 04 05 67 81");
    client.state = CpuState::Stop;
    client.diagnosis = cold[3..].to_vec();
    let state = list(&mut client, "04 24", "00 00").2;
    assert_eq!(hex(&state), "43 04 FF 04 00 00 00 00 00 00 00 00 26 11 22 01 04 05 67 81");
    assert_eq!(hex(&list(&mut client, "02 22", "00 64").2[..4]), "13 81 1B 64");
    // SF indicates a failed program.
    assert_eq!(list(&mut client, "01 74", "00 01").2, [0, 1, 0, 0]);
    client.diagnosis.insert(0, entry((0x4562, 3)));
    assert_eq!(list(&mut client, "01 74", "00 01").2, [0, 1, 1, 0]);
}

/// The longest PDU is that of the module, 960 here, although 480 was negotiated; connections are limited to the 32 of a CPU 317-2.
#[test]
fn communication_and_protection_have_records_of_40_bytes() {
    let mut client = Client::ready(480);
    for (asked, index, start) in [
        ("01 31", "00 01", "00 01 03 C0 00 20"),
        ("01 31", "00 00", "00 01 03 C0 00 20"),
        ("01 32", "00 04", "00 04 00 01 00 00 00 01 00 02 00 00"),
        ("02 32", "00 00", "00 04 00 01 00 00 00 01 00 02 00 00"),
    ] {
        let (length, count, record) = list(&mut client, asked, index);
        assert_eq!((length, count), (40, 1));
        assert!(hex(&record).starts_with(start), "{asked}: {}", hex(&record));
    }
    // 33.19: bart_sch, the fifth word, is the position of the mode selector; stopping the CPU does not change it.
    client.job(STOP, "");
    client.step();
    assert_eq!(client.state, CpuState::Stop);
    assert_eq!(hex(&list(&mut client, "02 32", "00 04").2[..12]), "00 04 00 01 00 00 00 01 00 02 00 00");
    client.connections = 7;
    assert_eq!(hex(&list(&mut client, "01 31", "00 01").2[..6]), "00 01 03 C0 00 07");
    client.connections = 2048;
    assert_eq!(hex(&list(&mut client, "01 31", "00 01").2[..6]), "00 01 03 C0 00 20");
}

/// snap7 has the lamps 1, 4, 5, 6, 0B, 0C and 15 of a CPU 315-2 PN/DP; 33.10 calls them SF, RUN, STOP, FRCE, BUS1F, BUS2F and (edition
/// of 2010, 34.20) MAINT.
#[test]
fn the_lamps_are_those_of_a_cpu_with_two_interfaces() {
    let mut client = Client::ready(240);
    let lamps = "00 01 00 00 00 04 01 00 00 05 00 00 00 06 00 00 00 0B 00 00 00 0C 00 00 00 15 00 00";
    for all in ["00 19", "00 74"] {
        assert_eq!(list(&mut client, all, "00 00"), (4, 7, bytes(lamps)));
    }
    for lamp in ["00 0C", "00 15"] {
        assert_eq!(hex(&list(&mut client, "01 74", lamp).2), format!("{lamp} 00 00"));
    }
}

/// snap7 has these bytes of a CPU 315: manufacturer 002A, which PROFIBUS and PROFINET assigned to Siemens, profile F600, type 1.
#[test]
fn the_manufacturer_is_that_of_the_order_number() {
    let mut client = Client::ready(240);
    let record = list(&mut client, "01 1C", "00 09").2;
    assert_eq!(hex(&record[..8]), "00 09 00 2A F6 00 00 01");
    assert!(record[8..].iter().all(|byte| *byte == 0));
}

/// snap7 answers lists without a selection of records with index 0000, whatever index was requested.
#[test]
fn a_list_without_a_choice_of_records_has_index_0_in_its_head() {
    let mut client = Client::ready(960);
    for list in ["00 00", "00 11", "00 12", "00 14", "00 19", "00 1C", "00 74", "00 A0", "01 A0", "04 24", "0F 11"] {
        let answer = client.user_data(4, 1, &format!("{list} FF FF")).1;
        assert_eq!(answer[12..23], format!("{list} 00 00"), "{answer}");
    }
    let answer = client.user_data(4, 1, "01 11 00 06").1;
    assert_eq!(answer[12..23], *"01 11 00 06");
}

#[test]
fn the_diagnostic_buffer_shows_the_newest_entries_first() {
    let mut client = Client::ready(240);
    let time = client.clock;
    client.diagnosis = (1..=20).rev().map(|event| Diagnosis { event, information: [0; 10], time }).collect();
    let (length, count, records) = list(&mut client, "01 A0", "00 03");
    assert_eq!((length, count), (20, 3));
    assert_eq!(hex(&records[..2]), "00 14");
    assert_eq!(hex(&records[12..20]), "26 11 22 03 04 05 67 81");
    // All 20 are 408 bytes: 214, then 194.
    let first = bytes(&client.ask("32 07 00 00 00 09 00 08 00 08 00 01 12 04 11 44 01 00 FF 09 00 04 00 A0 00 00"));
    let sequence = first[17];
    assert_eq!((first[19], hex(&first[22..26])), (1, "FF 09 00 D6".to_owned()));
    assert_eq!(hex(&first[26..34]), "00 A0 00 00 00 14 00 14");
    let next = format!("32 07 00 00 00 0A 00 0C 00 04 00 01 12 08 12 44 01 {sequence:02X} 00 00 00 00 0A 00 00 00");
    let last = bytes(&client.ask(&next));
    assert_eq!((last[19], hex(&last[22..26])), (0, "FF 09 00 C2".to_owned()));
}

/// pyS7 sends type 0 in its requests.
#[test]
fn a_request_without_a_type_is_a_request() {
    let mut client = Client::ready(480);
    let with = client.ask("32 07 00 00 00 09 00 08 00 08 00 01 12 04 11 44 01 00 FF 09 00 04 04 24 00 00");
    let without = client.ask("32 07 00 00 00 09 00 08 00 08 00 01 12 04 11 04 01 00 FF 09 00 04 04 24 00 00");
    let but_sequence = |answer: &str| [bytes(answer)[..17].to_vec(), bytes(answer)[18..].to_vec()].concat();
    assert_eq!(but_sequence(&with), but_sequence(&without));
}

/// 22 November 2026 is a Sunday: 1.
#[test]
fn the_clock_is_read_with_its_day_of_the_week() {
    let mut client = Client::ready(240);
    let (error, answer) = client.user_data(7, 1, "");
    assert_eq!((error.as_str(), answer.as_str()), ("00 00", "FF 09 00 0A 00 20 26 11 22 03 04 05 67 81"));
}

#[test]
fn the_clock_is_set_with_the_next_step_if_the_time_exists() {
    let mut client = Client::ready(240);
    let set = client.user_data(7, 2, "00 20 28 02 29 23 59 59 99 93");
    assert_eq!(set, ("00 00".to_owned(), "0A 00 00 00".to_owned()));
    let time = DateAndTime { year: 2028, month: 2, day: 29, hour: 23, minute: 59, second: 59, millisecond: 999 };
    assert_eq!(client.commands, [Command::SetClock(time)]);
    client.commands.clear();
    for wrong in [
        "00 20 27 02 29 00 00 00 00 00", // not a leap year
        "00 20 27 13 01 00 00 00 00 00",
        "00 20 27 00 01 00 00 00 00 00",
        "00 20 27 01 01 24 00 00 00 00",
        "00 20 27 01 01 00 60 00 00 00",
        "00 20 2A 01 01 00 00 00 00 00", // not BCD
        "00 20 27 01",
        "",
    ] {
        assert_eq!(client.user_data(7, 2, wrong).0, "DC 01", "{wrong}");
    }
    assert!(client.commands.is_empty());
}

#[test]
fn an_earlier_time_is_as_much_earlier_and_1990_is_the_first_year() {
    let leap = DateAndTime { year: 2000, month: 3, day: 1, hour: 0, minute: 0, second: 0, millisecond: 1 };
    let day_before = DateAndTime { month: 2, day: 29, hour: 23, minute: 59, second: 59, millisecond: 999, ..leap };
    assert_eq!(leap.earlier(2), day_before);
    assert_eq!(leap.earlier(1_000_000_000).later(1_000_000_000), leap);
    assert_eq!(leap.earlier(u64::MAX), DateAndTime::FIRST);
}

#[test]
fn dates_go_on_over_the_ends_of_months_and_years() {
    let day = 86_400_000;
    let start = DateAndTime { year: 1999, month: 12, day: 31, hour: 23, minute: 59, second: 59, millisecond: 999 };
    let next = start.later(1);
    assert_eq!(hex(&next.bytes()), "00 01 01 00 00 00 00 07"); // a Saturday
    assert_eq!(DateAndTime::parse(&next.bytes()), Some(next));
    let leap = next.later(59 * day);
    assert_eq!((leap.month, leap.day), (2, 29));
    assert_eq!(next.later(366 * day).year, 2001);
    assert_eq!(hex(&DateAndTime::FIRST.bytes()), "90 01 01 00 00 00 00 02"); // a Monday
}

const STOP: &str = "29 00 00 00 00 00 09 50 5F 50 52 4F 47 52 41 4D";
const WARM: &str = "28 00 00 00 00 00 00 FD 00 00 09 50 5F 50 52 4F 47 52 41 4D";
const COLD: &str = "28 00 00 00 00 00 00 FD 00 02 43 20 09 50 5F 50 52 4F 47 52 41 4D";

#[test]
fn the_plc_is_stopped_and_started_by_request() {
    let mut client = Client::ready(240);
    assert_eq!(client.job(WARM, ""), "00 02 00 00 00 00 28 03"); // already in RUN
    assert_eq!(client.job(STOP, ""), "00 01 00 00 00 00 29");
    assert_eq!(client.commands, [Command::PlcStop]);
    client.step();
    assert_eq!(client.job(STOP, ""), "00 02 00 00 00 00 29 07"); // already in STOP
    assert_eq!(client.job(COLD, ""), "00 01 00 00 00 00 28");
    assert_eq!(client.commands, [Command::PlcStart(Restart::Cold)]);
    client.commands.clear();
    assert_eq!(client.job(WARM, ""), "00 01 00 00 00 00 28");
    assert_eq!(client.commands, [Command::PlcStart(Restart::Warm)]);
}

#[test]
fn services_by_name_are_acknowledged_and_unknown_ones_refused() {
    let mut client = Client::ready(240);
    let compress = "28 00 00 00 00 00 00 FD 00 00 05 5F 47 41 52 42";
    let copy = "28 00 00 00 00 00 00 FD 00 02 45 50 05 5F 4D 4F 44 55";
    for service in [compress, copy] {
        assert_eq!(client.job(service, ""), "00 01 00 00 00 00 28");
    }
    for (service, error) in [
        ("28 00 00 00 00 00 00 FD 00 00 05 5F 44 45 4C 45", "D2 02"), // _DELE
        ("28 00 00 00 00 00 00 FD 00 00 06 5F 47 41 52 42", "85 00"),
        ("28 00 00 00 00 00 00 FD 00 09 05", "85 00"),
        ("28", "85 00"),
        ("29 00 00 00 00 00 09 50", "85 00"),
        ("29", "85 00"),
    ] {
        assert_eq!(client.job(service, ""), format!("00 00 00 00 {error}"), "{service}");
    }
    assert!(client.commands.is_empty());
}

#[test]
fn a_protected_module_wants_its_password_first() {
    let mut client = Client::ready(240);
    client.protection = Protection { level: 3, password: Some(*b"geheim  ") };
    let upload = "1D 00 00 00 00 00 00 00 09 5F 30 41 30 31 30 30 30 41";
    for job in [STOP, WARM, upload] {
        assert_eq!(client.job(job, ""), "00 00 00 00 D2 41");
    }
    assert_eq!(client.user_data(7, 2, "00 20 28 02 29 23 59 59 99 93").0, "D2 41");
    // "geheim  " encoded: 67^55=32, 65^55=30, 68^55^32=0F, 65^55^30=00, 69^55^0F=33, 6D^55^00=38, 20^55^33=46, 20^55^38=4D.
    assert_eq!(client.user_data(5, 1, "32 30 0F 00 33 38 46 4C").0, "D6 02");
    assert_eq!(client.job(STOP, ""), "00 00 00 00 D2 41");
    assert_eq!(client.user_data(5, 1, "32 30 0F 00 33 38 46 4D").0, "00 00");
    assert_eq!(client.job(STOP, ""), "00 01 00 00 00 00 29");
    assert!(client.job(upload, "").starts_with("00 10"));
    assert_eq!(client.user_data(5, 2, "").0, "00 00");
    assert_eq!(client.job(STOP, ""), "00 00 00 00 D2 41");
    // The password does not protect variables.
    assert!(client.read(&["02 00 01 03 E8 84 00 00 00"]).ends_with("FF 04 00 08 A5"));
    client.protection.level = 2;
    assert_eq!(client.job(STOP, ""), "00 00 00 00 D2 41");
    assert!(client.job(upload, "").starts_with("00 10"));
}

#[test]
fn a_module_without_a_password_says_so() {
    let mut client = Client::ready(240);
    assert_eq!(client.user_data(5, 1, "32 30 0F 00 33 38 46 4D").0, "D6 05");
    assert_eq!(client.user_data(5, 2, "").0, "D6 05");
    assert_eq!(client.user_data(5, 1, "32 30").0, "D4 05");
}

/// The PLC of an 828D has another identification.
#[test]
fn each_control_has_its_own_plc() {
    use crate::s7::Identity;
    for identity in [Identity::SINUMERIK_840D_SL, Identity::SINUMERIK_828D] {
        assert!(identity.order_number.is_ascii() && identity.order_number.len() == 20);
        assert!(identity.module_name.len() <= 24 && identity.module_type.len() <= 32);
    }
    assert_ne!(Identity::SINUMERIK_840D_SL.order_number, Identity::SINUMERIK_828D.order_number);
}

/// 33.6: index 0000 is the group "MC7 processing unit", 0100 the time system; a group is not a feature. snap7 has one record at index 0000
/// and two at 0100, from a CPU 315 that compiles MC7 (0001), while this one interprets it (0002).
#[test]
fn the_features_of_a_group_are_those_of_that_group_alone() {
    let mut client = Client::ready(240);
    for (group, features) in
        [("00 00", "00 02"), ("01 00", "01 01 01 04"), ("02 00", "02 02"), ("03 00", "03 02 03 03 03 04 03 05")]
    {
        assert_eq!(hex(&list(&mut client, "01 12", group).2), features);
    }
    assert_eq!(list(&mut client, "00 12", "00 00").1, 8);
}

/// The answer is the same as snap7's (`FF 09 00 02 02 00`).
#[test]
fn whoever_logs_on_to_messages_is_told_that_it_is() {
    let mut client = Client::ready(240);
    let name = "48 4D 49 5F 52 54 4D 20";
    assert_eq!(client.user_data(4, 2, &format!("01 00 {name}")).1, "FF 09 00 02 02 00");
    assert_eq!(client.user_data(4, 2, &format!("80 00 {name} 04 00")).1, "FF 09 00 05 02 00 04 00 00");
    assert_eq!(client.user_data(4, 2, "").0, "D4 05");
}

/// System Software for S7-300/400, 33.8: at least nine records, index 3 in bits, 8 in bytes. 128 bytes of inputs and outputs, 256 of flags
/// (2048 bits), 32 timers and counters, nothing else.
#[test]
fn flags_are_counted_in_bits_and_in_bytes() {
    let mut client = Client::ready(480);
    let records = [
        "00 01 00 01 00 80 00 00",
        "00 02 00 01 00 80 00 00",
        "00 03 00 01 08 00 00 00",
        "00 04 00 01 00 20 00 00",
        "00 05 00 01 00 20 00 00",
        "00 06 00 01 00 80 00 00",
        "00 07 00 01 00 00 00 00",
        "00 08 00 01 01 00 00 00",
        "00 09 00 01 00 00 00 00",
    ];
    assert_eq!(list(&mut client, "00 14", "00 00"), (8, 9, bytes(&records.join(" "))));
}

/// As decoded by Wireshark's dissector: used and free bytes add up to the size, and the listed services are supported.
#[test]
fn memories_areas_and_services_are_those_of_this_module() {
    let mut client = Client::ready(480);
    let memory = list(&mut client, "01 13", "00 01").2;
    let double = |at: usize| u32::from_be_bytes(memory[at..at + 4].try_into().unwrap());
    // DB10 272, DB11 64, ten of 416, 31 of 148, ten of 256, and 2048 + 7.
    assert_eq!(double(16), 272 + 64 + 4160 + 31 * 148 + 2560 + 2055);
    assert_eq!((double(4), double(12)), (1 << 24, 1 << 24));
    assert_eq!(double(16) + double(20), 1 << 24);
    let services = list(&mut client, "01 31", "00 03").2;
    assert_eq!(hex(&services[..14]), "00 03 47 E0 81 01 01 E0 00 20 00 01 63 9C");
}
