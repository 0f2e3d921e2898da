//! Tests of many clients, and of clients with many requests: the memory of a client, the order of answers, and that one client does not
//! delay others. `benches/s7` measures the speed.
#![cfg(all(feature = "cli", feature = "s7"))]

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};

use opennck::live::{Live, Speed};
use opennck::machine::Machine;
use opennck::s7::live::LiveServer;
use opennck::s7::server::Limits;

use crate::clients::{CONNECT, bare, packet, setup};

/// The number of connected clients.
const MANY: usize = 1000;

/// Reads one byte: MB0.
fn read(reference: u16) -> Vec<u8> {
    let [high, low] = reference.to_be_bytes();
    let head = [3, 0, 0, 31, 2, 0xF0, 0x80, 0x32, 1, 0, 0, high, low, 0, 14, 0, 0];
    [&head[..], &[4, 1, 0x12, 10, 0x10, 2, 0, 1, 0, 0, 0x83, 0, 0, 0]].concat()
}

/// Writes one byte: MB0.
fn write(reference: u16, value: u8) -> Vec<u8> {
    let [high, low] = reference.to_be_bytes();
    let head = [3, 0, 0, 36, 2, 0xF0, 0x80, 0x32, 1, 0, 0, high, low, 0, 14, 0, 5];
    [&head[..], &[5, 1, 0x12, 10, 0x10, 2, 0, 1, 0, 0, 0x83, 0, 0, 0, 0, 4, 0, 8, value]].concat()
}

fn served(speed: &str) -> (Live, LiveServer, SocketAddr) {
    let speed: Speed = speed.parse().expect("it is one");
    let live = Live::start(Machine::open("g1_example").expect("it is built in"), speed);
    let window = LiveServer::open(&live, &["127.0.0.1:0"], false, Limits::default()).expect("some port is free");
    let address = window.addresses()[0];
    (live, window, address)
}

/// A connected client with a PDU of 240 bytes.
fn client(address: SocketAddr) -> TcpStream {
    let mut stream = bare(address);
    stream.set_nodelay(true).expect("it is a socket");
    for said in [&CONNECT[..], &setup(240)] {
        stream.write_all(said).expect("it is taken");
        packet(&mut stream);
    }
    stream
}

/// The number of bytes that this process has in memory, if the system reports it.
fn memory() -> Option<usize> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(1024 * line.split_whitespace().next()?.parse::<usize>().ok()?)
}

/// Each client has sent a request. On the side of this test, clients are only socket handles.
#[test]
fn a_thousand_clients_need_less_than_8_kib_each() {
    let handles = 2 * MANY as u64 + 100;
    let given = rlimit::increase_nofile_limit(handles).unwrap_or(0);
    if given < handles {
        println!("not tested: {handles} handles are needed, the system allows {given}");
        return;
    }
    let (_live, window, address) = served("1");
    let mut first = client(address);
    let before = memory();
    let mut clients: Vec<_> = (1..MANY).map(|_| client(address)).collect();
    for (reference, stream) in (0..).zip(&mut clients) {
        stream.write_all(&read(reference)).unwrap();
    }
    for (reference, stream) in (0_u16..).zip(&mut clients) {
        assert_eq!(packet(stream)[11..13], reference.to_be_bytes());
    }
    assert_eq!(window.clients(), MANY);
    if let (Some(before), Some(after)) = (before, memory()) {
        let each = after.saturating_sub(before) / clients.len();
        assert!(each < 8 * 1024, "{each} bytes for a client");
    }
    first.write_all(&read(7)).unwrap();
    assert_eq!(packet(&mut first)[21], 0xFF);
}

/// Repeated writes and reads of the same byte sent together: each read returns the value of the write before it.
#[test]
fn requests_sent_together_are_answered_in_order_and_reads_see_earlier_writes() {
    let (_live, _window, address) = served("10");
    let mut stream = client(address);
    let requests = (0..100_u8).flat_map(|value| {
        let reference = 2 * u16::from(value);
        [write(reference, value), read(reference + 1)].concat()
    });
    stream.write_all(&requests.collect::<Vec<_>>()).unwrap();
    for value in 0..100_u8 {
        let reference = 2 * u16::from(value);
        let (written, found) = (packet(&mut stream), packet(&mut stream));
        assert_eq!((&written[11..13], written[21]), (&reference.to_be_bytes()[..], 0xFF));
        assert_eq!((&found[11..13], found[25]), (&(reference + 1).to_be_bytes()[..], value));
    }
}

/// Here, a cycle lasts 200 ms, so that the effect is visible: eight writes need one cycle, not eight.
#[test]
fn writes_sent_together_are_executed_together() {
    let (live, _window, address) = served("0.01");
    let mut stream = client(address);
    let before = live.with(|machine| machine.cycle());
    let requests: Vec<_> = (0..8).flat_map(|value| write(value.into(), value)).collect();
    stream.write_all(&requests).unwrap();
    for reference in 0..8_u16 {
        assert_eq!(packet(&mut stream)[11..13], reference.to_be_bytes());
    }
    let (after, last) = live.with(|machine| (machine.cycle(), machine.memory().flags[0]));
    assert_eq!(last, 7);
    assert!(after - before < 8, "{} cycles", after - before);
}

/// One client sends a thousand requests at once and reads the answers, while other clients work.
#[test]
fn a_client_that_floods_does_not_delay_others() {
    let (_live, window, address) = served("1");
    let (mut flood, is_over) = (client(address), AtomicBool::new(false));
    let mut taken = flood.try_clone().unwrap();
    std::thread::scope(|scope| {
        scope.spawn(|| {
            let requests: Vec<_> = (0..1000).flat_map(read).collect();
            while !is_over.load(Ordering::Relaxed) {
                if flood.write_all(&requests).is_err() {
                    break;
                }
            }
            flood.shutdown(std::net::Shutdown::Write).unwrap();
        });
        scope.spawn(|| while taken.read(&mut [0; 65536]).is_ok_and(|count| count > 0) {});
        let mut others: Vec<_> = (0..8).map(|_| client(address)).collect();
        for round in 0..50 {
            for stream in &mut others {
                stream.write_all(&read(round)).unwrap();
            }
            for stream in &mut others {
                assert_eq!(packet(stream)[11..13], round.to_be_bytes());
            }
        }
        is_over.store(true, Ordering::Relaxed);
    });
    assert!(window.answers() > 8 * 50 + 1000);
}
