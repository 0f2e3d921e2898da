//! Safety and test functions of a served machine: injected faults, captures as read by Wireshark's tshark, write protection, passwords.
//! Bare sockets are used for what no regular client does.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![expect(clippy::disallowed_methods, reason = "a live machine is watched in real time")]

use std::io::{Read, Write};
use std::net::{Shutdown, SocketAddr};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use opennck::image::{Area, Profile};
use opennck::live::{Live, Speed};
use opennck::machine::{Machine, OpenOptions};
use opennck::s7::live::{LiveServer, LiveServerOptions, Terms};
use opennck::s7::{Protected, Protection, Settings};
use prometheus_parse::{Scrape, Value};
use rust7::{S7_AREA_DB, S7_AREA_MK, S7_WL_BYTE};

use crate::clients::{CONNECT, bare, client, next, setup};

const SETUP: [u8; 25] = setup(480);

/// Read MB0, with a reference.
fn read(reference: u8) -> Vec<u8> {
    let mut packet = vec![3, 0, 0, 31, 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, reference, 0, 14, 0, 0, 4, 1];
    packet.extend([0x12, 10, 0x10, 2, 0, 1, 0, 0, 0x83, 0, 0, 0]);
    packet
}

/// Write one byte to MB0, with a reference.
fn write(reference: u8, value: u8) -> Vec<u8> {
    let mut packet = vec![3, 0, 0, 36, 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, reference, 0, 14, 0, 5, 5, 1];
    packet.extend([0x12, 10, 0x10, 2, 0, 1, 0, 0, 0x83, 0, 0, 0, 0, 4, 0, 8, value]);
    packet
}

fn live() -> Live {
    Live::start(Machine::open("g1_example").expect("it is built in"), Speed::default())
}

fn window(live: &Live, options: LiveServerOptions) -> (LiveServer, SocketAddr) {
    let window = LiveServer::open_with(live, &["127.0.0.1:0"], options).expect("some port is free");
    let address = window.addresses()[0];
    (window, address)
}

fn faults(text: &str) -> LiveServerOptions {
    LiveServerOptions { faults: Some(text.parse().expect("they are faults")), ..LiveServerOptions::default() }
}

fn terms(terms: Terms) -> LiveServerOptions {
    LiveServerOptions { terms, ..LiveServerOptions::default() }
}

/// A new file in the target directory.
fn new_file(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_file(&path);
    path
}

#[test]
fn answers_come_late_and_in_order() {
    let live = live();
    let (_window, address) = window(&live, faults("delay=100ms..300ms"));
    let mut stream = bare(address);
    stream.write_all(&CONNECT).unwrap();
    assert_eq!(next(&mut stream).unwrap()[5], 0xD0);
    let begin = Instant::now();
    let requests: Vec<u8> = (0..10).flat_map(read).collect();
    stream.write_all(&[&SETUP[..], &requests].concat()).unwrap();
    next(&mut stream).unwrap();
    assert!(begin.elapsed() >= Duration::from_millis(100));
    let references: Vec<u8> = (0..10).map(|_| next(&mut stream).unwrap()[12]).collect();
    assert_eq!(references, (0..10).collect::<Vec<_>>());
    // Requests that arrive together are delayed together; the server needs at most two reads for them.
    assert!(begin.elapsed() < Duration::from_secs(2), "{:?}", begin.elapsed());
}

/// The references of the answers to 200 reads; the client ends with a shutdown of its side.
fn answered(address: SocketAddr) -> Vec<u8> {
    let mut stream = bare(address);
    let reads: Vec<u8> = (0..200).flat_map(read).collect();
    stream.write_all(&[&CONNECT[..], &SETUP, &reads].concat()).unwrap();
    stream.shutdown(Shutdown::Write).unwrap();
    let is_read = |packet: &Vec<u8>| packet.get(19) == Some(&4);
    std::iter::from_fn(|| next(&mut stream)).filter(is_read).map(|packet| packet[12]).collect()
}

#[test]
fn the_same_seed_drops_the_same_answers() {
    let live = live();
    let found = ["drop=20%,seed=5", "drop=20%,seed=5", "drop=20%,seed=6"].map(|said| {
        let (window, address) = window(&live, faults(said));
        let found = answered(address);
        assert!(window.counters().faults.get() >= 200 - found.len() as u64);
        found
    });
    assert_eq!(found[0], found[1]);
    assert_ne!(found[0], found[2]);
    assert!(found[0].is_sorted());
    // 160 are expected, with a standard deviation of 5.7.
    assert!((130..=190).contains(&found[0].len()), "{}", found[0].len());
}

#[test]
fn a_request_with_an_injected_error_is_not_executed() {
    let live = live();
    for (said, answers) in [
        ("error=100%", [vec![0x0A, 0, 0, 0], vec![0x0A]]),
        ("error=100%,code=05", [vec![5, 0, 0, 0], vec![5]]),
        ("error=100%,code=8104", [vec![0x81, 4], vec![0x81, 4]]),
    ] {
        let (window, address) = window(&live, faults(said));
        let mut stream = bare(address);
        stream.write_all(&[&CONNECT[..], &SETUP, &read(7), &write(8, 0xAA)].concat()).unwrap();
        let packets: Vec<_> = (0..4).map(|_| next(&mut stream).unwrap()).collect();
        assert!(packets[2].ends_with(&answers[0]) && packets[3].ends_with(&answers[1]), "{said}: {packets:02X?}");
        assert_eq!(live.with(|machine| machine.memory().flags[0]), 0);
        assert_eq!(window.counters().writes.get(), 0);
        assert_eq!(window.counters().refusals().iter().map(|(_, count)| count).sum::<u64>(), 2);
    }
}

/// A packet, and the same in three packets with pieces of its PDU and an empty piece at the end, as some clients send.
fn in_pieces(packet: &[u8]) -> Vec<u8> {
    let (pdu, mut all) = (&packet[7..], Vec::new());
    for (piece, end) in [(&pdu[..5], 0), (&pdu[5..20], 0), (&pdu[20..], 0x80), (&[], 0x80)] {
        all.extend([3, 0, 0, u8::try_from(piece.len() + 7).unwrap(), 2, 0xF0, end]);
        all.extend(piece);
    }
    all
}

#[test]
fn a_request_in_pieces_gets_the_same_fault_as_in_one_packet() {
    let live = live();
    let refused = |split: bool| {
        let (_window, address) = window(&live, faults("error=25%,seed=3"));
        let mut stream = bare(address);
        let reads = (0..100).flat_map(|reference| if split { in_pieces(&read(reference)) } else { read(reference) });
        stream.write_all(&[&CONNECT[..], &SETUP, &reads.collect::<Vec<_>>()].concat()).unwrap();
        let packets: Vec<_> = (0..102).map(|_| next(&mut stream).unwrap()).collect();
        packets[2..].iter().filter(|packet| packet[21] == 0x0A).map(|packet| packet[12]).collect::<Vec<_>>()
    };
    let found = refused(false);
    assert_eq!(found, refused(true));
    // 25 are expected, with a standard deviation of 4.3.
    assert!((8..=42).contains(&found.len()), "{}", found.len());
}

#[test]
fn a_connection_is_closed_by_an_injected_fault() {
    let live = live();
    let (window, address) = window(&live, faults("close=100%"));
    let mut stream = bare(address);
    stream.write_all(&[&CONNECT[..], &SETUP].concat()).unwrap();
    assert_eq!(next(&mut stream).unwrap()[5], 0xD0);
    assert_eq!(next(&mut stream), None);
    assert!(window.counters().ends().any(|end| end == ("fault", 1)));
}

/// The output of tshark for a capture, one packet per line; `None`, with a message on standard error, if it is not installed.
fn tshark(file: &Path, arguments: &[&str]) -> Option<Vec<String>> {
    let Ok(output) = Command::new("tshark").arg("-r").arg(file).args(arguments).output() else {
        std::io::stderr().write_all(b"\nNOT CHECKED: tshark is not there\n").expect("standard error");
        return None;
    };
    let text = String::from_utf8(output.stdout).expect("text");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(text.lines().map(str::to_owned).collect())
}

#[test]
fn wireshark_recognises_a_capture() {
    let (live, file) = (live(), new_file("session.pcap"));
    let (window, address) =
        window(&live, LiveServerOptions { capture: Some(file.clone()), ..LiveServerOptions::default() });
    let mut client = client(address);
    client.write_area(S7_AREA_MK, 0, 0, S7_WL_BYTE, &[1, 2, 3]).unwrap();
    client.read_area(S7_AREA_MK, 0, 0, S7_WL_BYTE, &mut [0; 100]).unwrap();
    assert!(client.read_db(99, 0, &mut [0; 4]).is_err());
    client.disconnect();
    let mut slow = bare(address);
    for byte in CONNECT {
        slow.write_all(&[byte]).unwrap();
    }
    next(&mut slow).unwrap();
    drop(window); // the server stops first
    let Some(jobs) = tshark(&file, &["-Y", "s7comm.header.rosctr == 1", "-T", "fields", "-e", "s7comm.param.func"])
    else {
        return;
    };
    assert_eq!(jobs, ["0xf0", "0x05", "0x04", "0x04"], "setup, write, two reads");
    let codes = ["-Y", "s7comm.header.rosctr == 3", "-T", "fields", "-e", "s7comm.data.returncode"];
    assert_eq!(tshark(&file, &codes).unwrap(), ["", "0xff", "0xff", "0x0a"]);
    // Both connections: begin, end, and no anomaly in between; checksums are correct.
    let count = |filter: &str| tshark(&file, &["-Y", filter]).unwrap().len();
    assert_eq!(count("tcp.flags.syn == 1"), 4);
    assert_eq!(count("tcp.flags.fin == 1"), 4);
    assert_eq!(count("_ws.malformed || tcp.analysis.flags || tcp.dstport != 102 && tcp.srcport != 102"), 0);
    let checked = ["-o", "tcp.check_checksum:TRUE", "-o", "ip.check_checksum:TRUE"];
    let wrong = "tcp.checksum.status == \"Bad\" || ip.checksum.status == \"Bad\"";
    assert_eq!(tshark(&file, &[&checked[..], &["-Y", wrong]].concat()).unwrap().len(), 0);
    let right = "tcp.checksum.status == \"Good\" && ip.checksum.status == \"Good\"";
    assert!(tshark(&file, &[&checked[..], &["-Y", right]].concat()).unwrap().len() > 14);
}

#[test]
fn a_capture_refuses_an_existing_file() {
    let (live, file) = (live(), new_file("taken.pcap"));
    std::fs::write(&file, "mine").unwrap();
    let options = LiveServerOptions { capture: Some(file.clone()), ..LiveServerOptions::default() };
    let problem = LiveServer::open_with(&live, &["127.0.0.1:0"], options).unwrap_err().to_string();
    assert!(problem.contains("taken.pcap") && problem.contains("does not exist yet"), "{problem}");
    assert_eq!(std::fs::read(&file).unwrap(), b"mine");
}

/// Three items in one request: the protected item is refused, the others are written.
#[test]
fn protected_items_are_refused_and_the_others_are_written() {
    let live = live();
    let bytes = Protected::Bytes { area: Area::Flags, bytes: 10..=19 };
    let protected = vec![bytes, Protected::Blocks(31..=32)];
    let (_window, address) = window(&live, terms(Terms { protected, ..Terms::default() }));
    let mut stream = bare(address);
    let mut request = vec![3, 0, 0, 70, 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, 9, 0, 38, 0, 15, 5, 3];
    for byte in [9, 10, 20] {
        request.extend([0x12, 10, 0x10, 2, 0, 1, 0, 0, 0x83, 0, 0, byte * 8]);
    }
    request.extend([0, 4, 0, 8, 1, 0, 0, 4, 0, 8, 2, 0, 0, 4, 0, 8, 3]);
    request[3] = u8::try_from(request.len()).unwrap();
    request[16] = 17;
    stream.write_all(&[&CONNECT[..], &SETUP, &request].concat()).unwrap();
    let answer = (0..3).map(|_| next(&mut stream).unwrap()).last().unwrap();
    assert!(answer.ends_with(&[5, 3, 0xFF, 3, 0xFF]), "{answer:02X?}");
    live.with(|machine| {
        assert_eq!((machine.memory().flags[9], machine.memory().flags[10], machine.memory().flags[20]), (1, 0, 3));
    });
    let mut client = client(address);
    assert!(client.write_bit(S7_AREA_DB, 31, 2, 1, true).is_err());
    assert!(client.write_bit(S7_AREA_DB, 33, 2, 1, true).is_ok());
    assert!(client.write_area(S7_AREA_MK, 0, 0, S7_WL_BYTE, &[7; 11]).is_err(), "its last byte is protected");
    assert!(client.read_area(S7_AREA_MK, 0, 0, S7_WL_BYTE, &mut [0; 30]).is_ok());
}

/// A PDU in one packet.
fn packet(pdu: &[u8]) -> Vec<u8> {
    let length = u8::try_from(pdu.len() + 7).unwrap();
    [&[3, 0, 0, length, 2, 0xF0, 0x80], pdu].concat()
}

/// User data: group, function, and the payload of its data item.
fn user_data(group: u8, function: u8, payload: &[u8]) -> Vec<u8> {
    let length = u8::try_from(payload.len()).unwrap();
    let head =
        [0x32, 7, 0, 0, 0, 1, 0, 8, 0, length + 4, 0, 1, 0x12, 4, 0x11, 0x40 | group, function, 0, 0xFF, 9, 0, length];
    packet(&[&head, payload].concat())
}

/// The bytes of a password as encoded by programming devices.
fn folded(password: &[u8; 8]) -> [u8; 8] {
    let mut folded = [0; 8];
    for at in 0..8 {
        folded[at] = password[at] ^ 0x55 ^ if at < 2 { 0 } else { folded[at - 2] };
    }
    folded
}

#[test]
fn the_plc_is_stopped_only_with_the_password() {
    let live = live();
    let protection = Protection { level: 2, password: Some(*b"secret  ") };
    let (_window, address) = window(&live, terms(Terms { protection, ..Terms::default() }));
    let mut stream = bare(address);
    let mut ask = |request: &[u8]| {
        stream.write_all(request).unwrap();
        next(&mut stream).unwrap()
    };
    ask(&CONNECT);
    ask(&SETUP);
    let stop = packet(&[&[0x32, 1, 0, 0, 0, 2, 0, 16, 0, 0, 0x29, 0, 0, 0, 0, 0, 9][..], b"P_PROGRAM"].concat());
    assert!(ask(&stop).ends_with(&[0xD2, 0x41]), "protected");
    let wrong = ask(&user_data(5, 1, &folded(b"Secret  ")));
    assert_eq!(wrong[27..29], [0xD6, 2], "{wrong:02X?}");
    assert!(ask(&stop).ends_with(&[0xD2, 0x41]));
    let right = ask(&user_data(5, 1, &folded(b"secret  ")));
    assert_eq!(right[27..29], [0, 0], "{right:02X?}");
    assert_eq!(ask(&stop).last(), Some(&0x29));
    assert!(live.with(|machine| machine.is_plc_stopped()));
}

#[test]
fn the_cpu_has_the_identity_of_the_file() {
    let (live, file) = (live(), new_file("identity.toml"));
    std::fs::write(&file, "plant = \"Hall 2\"\norder_number = \"6ES7 999-9ZZ99-9ZZ9\"").unwrap();
    let identity = opennck::s7::live::OwnIdentity::read(&file).unwrap();
    let (_window, address) = window(&live, terms(Terms { identity, ..Terms::default() }));
    let mut stream = bare(address);
    stream.write_all(&[&CONNECT[..], &SETUP].concat()).unwrap();
    next(&mut stream).unwrap();
    next(&mut stream).unwrap();
    let mut ask = |list: [u8; 2], index: u8| {
        stream.write_all(&user_data(4, 1, &[list[0], list[1], 0, index])).unwrap();
        String::from_utf8_lossy(&next(&mut stream).unwrap()).into_owned()
    };
    assert!(ask([1, 0x1C], 3).contains("Hall 2"));
    assert!(ask([1, 0x11], 1).contains("6ES7 999-9ZZ99-9ZZ9 "));
    assert!(ask([1, 0x1C], 2).contains("PLC 317-2 PN/DP"));
}

#[test]
fn strict_slots_and_a_short_pdu_are_kept() {
    let live = live();
    let settings = Settings { longest_pdu: 240, called: Some(vec![[1, 2], [2, 2]]), ..Settings::default() };
    let (_window, address) = window(&live, LiveServerOptions { settings, ..LiveServerOptions::default() });
    let mut stream = bare(address);
    stream.write_all(&[&CONNECT[..], &SETUP].concat()).unwrap();
    next(&mut stream).unwrap();
    assert!(next(&mut stream).unwrap().ends_with(&[0, 240]), "SETUP asks for 480");
    let mut elsewhere = CONNECT;
    elsewhere[21] = 3;
    let mut stream = bare(address);
    stream.write_all(&elsewhere).unwrap();
    assert_eq!(next(&mut stream).as_deref(), Some(&[3, 0, 0, 11, 6, 0x80, 0, 1, 0, 0, 3][..]), "address unknown");
    assert_eq!(next(&mut stream), None);
}

#[test]
fn an_828d_is_served_with_its_block_numbers() {
    let options = OpenOptions { profile: Profile::SINUMERIK_828D, ..OpenOptions::default() };
    let live = Live::start(Machine::open_with("g1_example", options).unwrap(), Speed::default());
    let (_window, address) = window(&live, LiveServerOptions::default());
    let mut client = client(address);
    assert!(client.read_db(3900, 0, &mut [0; 4]).is_ok());
    assert!(client.read_db(31, 60, &mut [0; 4]).is_err());
}

/// Header and body of an answer.
fn http(address: SocketAddr, request: &str) -> (String, String) {
    let mut stream = bare(address);
    stream.write_all(request.as_bytes()).unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    let (head, body) = answer.split_once("\r\n\r\n").unwrap();
    (head.to_owned(), body.to_owned())
}

#[test]
fn prometheus_reads_the_counters() {
    let live = live();
    let options = LiveServerOptions { metrics: Some("127.0.0.1:0".to_owned()), ..LiveServerOptions::default() };
    let (window, address) = window(&live, options);
    let mut client = client(address);
    client.write_area(S7_AREA_MK, 0, 0, S7_WL_BYTE, &[1]).unwrap();
    assert!(client.read_db(99, 0, &mut [0; 4]).is_err());
    let metrics = window.metrics_addresses()[0];
    let (head, body) = http(metrics, "GET /metrics HTTP/1.1\r\nHost: a\r\n\r\n");
    assert!(head.starts_with("HTTP/1.1 200 ") && head.contains("text/plain; version=0.0.4"), "{head}");
    let scrape = Scrape::parse(body.lines().map(|line| Ok(line.to_owned()))).unwrap();
    let value = |name: &str, label: Option<(&str, &str)>| {
        let is_it = |sample: &&prometheus_parse::Sample| {
            sample.metric == name && label.is_none_or(|(label, value)| sample.labels.get(label) == Some(value))
        };
        match scrape.samples.iter().find(is_it).unwrap_or_else(|| panic!("no {name} in {body}")).value {
            Value::Counter(value) | Value::Gauge(value) => value,
            ref other => panic!("{name} is {other:?}: it has no TYPE"),
        }
    };
    assert!(value("opennck_steps_total", None) > 0.0 && value("opennck_simulated_seconds_total", None) > 0.0);
    for (name, label, expected) in [
        ("opennck_speed", None, 1.0),
        ("opennck_plc_running", None, 1.0),
        ("opennck_s7_clients", None, 1.0),
        ("opennck_s7_connections_total", None, 1.0),
        ("opennck_s7_writes_total", None, 1.0),
        ("opennck_s7_answers_total", None, 4.0), // connect, setup, write, read
        ("opennck_s7_refusals_total", Some(("code", "0A")), 1.0),
        ("opennck_s7_sent_away_total", Some(("reason", "places")), 0.0),
        ("opennck_s7_ended_total", Some(("how", "left")), 0.0),
    ] {
        assert!((value(name, label) - expected).abs() < 0.1, "{name}: {}", value(name, label));
    }
    // 22 + 25 + 36 + 31 bytes were received from the client; every sample has its help text.
    assert!((value("opennck_s7_received_bytes_total", None) - 114.0).abs() < 0.1);
    assert!(scrape.samples.iter().all(|sample| scrape.docs.contains_key(&sample.metric)));
    assert!(http(metrics, "GET / HTTP/1.1\r\n\r\n").0.starts_with("HTTP/1.1 404 "));
    assert!(http(metrics, "POST /metrics HTTP/1.1\r\n\r\n").0.starts_with("HTTP/1.1 405 "));
}

/// 16 connections are allowed, and a scrape must get one of them at once.
#[test]
fn idle_metrics_connections_do_not_block_a_scrape() {
    let live = live();
    let options = LiveServerOptions { metrics: Some("127.0.0.1:0".to_owned()), ..LiveServerOptions::default() };
    let (window, _) = window(&live, options);
    let metrics = window.metrics_addresses()[0];
    let silent: Vec<_> = (0..40).map(|_| bare(metrics)).collect();
    let begin = Instant::now();
    for _ in 0..5 {
        assert!(http(metrics, "GET /metrics HTTP/1.1\r\n\r\n").0.starts_with("HTTP/1.1 200 "));
    }
    assert!(begin.elapsed() < Duration::from_millis(1500), "{:?}", begin.elapsed());
    drop(silent);
}
