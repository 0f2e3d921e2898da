//! What keeps a served machine safe, and what makes panels testable: faults on purpose, captures as Wireshark's tshark reads them,
//! write protection, passwords. Bare sockets where no proper client does such a thing.
#![cfg(all(feature = "cli", feature = "s7"))]
#![expect(clippy::disallowed_methods, reason = "a live machine is watched in real time")]

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use opennck::cli::serve::{Capture, Instruments, Live, Speed, Window, WindowOptions};
use opennck::machine::Machine;
use rust7::{S7_AREA_MK, S7_WL_BYTE, S7Client};

/// The connection request of most clients.
const CONNECT: [u8; 22] = [3, 0, 0, 22, 17, 0xE0, 0, 0, 0, 1, 0, 0xC0, 1, 10, 0xC1, 2, 1, 0, 0xC2, 2, 1, 2];
/// Setup communication: one job, a PDU of 480 bytes.
const SETUP: [u8; 25] = [3, 0, 0, 25, 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, 1, 0, 8, 0, 0, 0xF0, 0, 0, 1, 0, 1, 1, 0xE0];

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

fn window(live: &Live, options: WindowOptions) -> (Window, SocketAddr) {
    let window = Window::open_with(live, &["127.0.0.1:0"], options).expect("some port is free");
    let address = window.addresses()[0];
    (window, address)
}

fn faults(text: &str) -> WindowOptions {
    let faults = Some(text.parse().expect("they are faults"));
    WindowOptions { instruments: Instruments { faults, ..Instruments::default() }, ..WindowOptions::default() }
}

fn client(address: SocketAddr) -> S7Client {
    let mut client = S7Client::new();
    client.set_connection_port(address.port()).expect("it is not connected yet");
    client.set_timeout(5000, 5000, 5000).expect("it is not connected yet");
    client.connect_rack_slot(&address.ip().to_string(), 0, 2).expect("the server is there");
    client
}

fn bare(address: SocketAddr) -> TcpStream {
    let stream = TcpStream::connect(address).expect("the server is there");
    stream.set_read_timeout(Some(Duration::from_secs(10))).expect("it is a time");
    stream
}

/// The next packet; nothing when the connection has ended.
fn next(stream: &mut TcpStream) -> Option<Vec<u8>> {
    let mut head = [0; 4];
    stream.read_exact(&mut head).ok()?;
    let mut packet = vec![0; usize::from(u16::from_be_bytes([head[2], head[3]]))];
    packet[..4].copy_from_slice(&head);
    stream.read_exact(&mut packet[4..]).ok()?;
    Some(packet)
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
    // Those that came together wait together; two reads of the server at most tear them apart.
    assert!(begin.elapsed() < Duration::from_secs(2), "{:?}", begin.elapsed());
}

/// The references of the answers that came to 200 reads.
fn answered(address: SocketAddr) -> Vec<u8> {
    let mut stream = bare(address);
    stream.write_all(&CONNECT).unwrap();
    next(&mut stream).unwrap();
    // Setup may be swallowed, too; it may be said again.
    stream.set_read_timeout(Some(Duration::from_millis(300))).unwrap();
    while next(&mut {
        stream.write_all(&SETUP).unwrap();
        stream.try_clone().unwrap()
    })
    .is_none()
    {}
    stream.write_all(&(0..200).flat_map(read).collect::<Vec<_>>()).unwrap();
    std::iter::from_fn(|| next(&mut stream)).map(|packet| packet[12]).collect()
}

#[test]
fn the_same_seed_swallows_the_same_answers() {
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
fn a_request_that_fails_on_purpose_is_not_done() {
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

#[test]
fn a_connection_breaks_on_purpose() {
    let live = live();
    let (window, address) = window(&live, faults("close=100%"));
    let mut stream = bare(address);
    stream.write_all(&[&CONNECT[..], &SETUP].concat()).unwrap();
    assert_eq!(next(&mut stream).unwrap()[5], 0xD0);
    assert_eq!(next(&mut stream), None);
    assert!(window.counters().ends().any(|end| end == ("fault", 1)));
}

/// What tshark says of a capture, one packet a line; nothing, and a word on standard error, where it is not there.
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
fn wireshark_reads_a_capture_without_being_told() {
    let (live, file) = (live(), new_file("session.pcap"));
    let capture = Some(Capture::create(&file).unwrap());
    let instruments = Instruments { capture, ..Instruments::default() };
    let (window, address) = window(&live, WindowOptions { instruments, ..WindowOptions::default() });
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
    drop(window); // the server ends first
    let Some(jobs) = tshark(&file, &["-Y", "s7comm.header.rosctr == 1", "-T", "fields", "-e", "s7comm.param.func"])
    else {
        return;
    };
    assert_eq!(jobs, ["0xf0", "0x05", "0x04", "0x04"], "setup, write, two reads");
    let codes = ["-Y", "s7comm.header.rosctr == 3", "-T", "fields", "-e", "s7comm.data.returncode"];
    assert_eq!(tshark(&file, &codes).unwrap(), ["", "0xff", "0xff", "0x0a"]);
    // Both connections: begin, end, and nothing strange in between; checksums are right.
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
fn a_capture_takes_no_file_that_is_there() {
    let file = new_file("taken.pcap");
    std::fs::write(&file, "mine").unwrap();
    assert!(Capture::create(&file).is_err());
    assert_eq!(std::fs::read(&file).unwrap(), b"mine");
}
