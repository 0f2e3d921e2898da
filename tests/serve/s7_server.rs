//! A live machine and clients of S7 communication over TCP: rust7, by the author of snap7, which shares no code with this project; and bare
//! sockets for what no regular client does.
#![expect(clippy::disallowed_methods, reason = "a live machine is watched in real time")]

use std::io::{Read, Write};
use std::net::{Shutdown, SocketAddr, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use opennck::live::{Live, LiveOptions, Speed};
use opennck::machine::Machine;
use opennck::plc::{self, PlcIo, Programs};
use opennck::s7::live::LiveServer;
use opennck::s7::server::Limits;
use opennck::sinumerik::Nck;
use rust7::{S7_AREA_DB, S7_AREA_MK, S7_WL_BYTE};

use crate::clients::{CONNECT, bare, client, packet, setup};

const SETUP: [u8; 25] = setup(480);

/// Read one byte: MB0.
const READ: [u8; 31] =
    [3, 0, 0, 31, 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, 2, 0, 14, 0, 0, 4, 1, 0x12, 10, 0x10, 2, 0, 1, 0, 0, 0x83, 0, 0, 0];

fn live() -> Live {
    let live = Live::start(Machine::open("g1_example").expect("it is built in"), Speed::default());
    wait("the run-up", || {
        live.with(|machine| {
            machine.axis("X").is_some_and(|x| machine.memory().from_nck().axes[x].gantry_leading_axis())
        })
    });
    live
}

fn window(live: &Live, limits: Limits) -> (LiveServer, SocketAddr) {
    let window = LiveServer::open(live, &["127.0.0.1:0"], false, limits).expect("some port is free");
    let address = window.addresses()[0];
    (window, address)
}

/// Waits until a condition is true, at most ten seconds.
#[track_caller]
fn wait(what: &str, mut is_true: impl FnMut() -> bool) {
    let begin = Instant::now();
    while !is_true() {
        assert!(begin.elapsed() < Duration::from_secs(10), "{what} did not come");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn is_any_set(bytes: &[u8]) -> bool {
    bytes.iter().any(|byte| *byte != 0)
}

#[test]
fn a_foreign_client_reads_interface_blocks_and_flags() {
    let live = live();
    let (_window, address) = window(&live, Limits::default());
    let mut client = client(address);
    // X is the leading axis of the gantry, XF is not: DB31.DBX101.6, DB33.DBX101.6; the axes stand still: DBX61.4.
    wait("the axes at rest", || client.read_bit(S7_AREA_DB, 31, 61, 4).unwrap());
    assert!(client.read_bit(S7_AREA_DB, 31, 101, 6).unwrap());
    assert!(!client.read_bit(S7_AREA_DB, 33, 101, 6).unwrap());
    let (mut axis, mut channel, mut mode_group, mut flags) = ([0; 60], [0; 40], [0; 7], [0xFF; 16]);
    client.read_db(31, 60, &mut axis).unwrap();
    client.read_db(21, 0, &mut channel).unwrap();
    client.read_db(11, 0, &mut mode_group).unwrap();
    client.read_area(S7_AREA_MK, 0, 0, S7_WL_BYTE, &mut flags).unwrap();
    assert!(is_any_set(&axis) && !is_any_set(&flags));
    assert!(mode_group[6] & 0b100 != 0, "JOG is active after power on: {mode_group:?}"); // DB11.DBX6.2
    // An address that does not exist is refused, and the conversation continues.
    assert!(client.read_db(99, 0, &mut axis).is_err());
    assert!(client.read_db(31, 60, &mut axis).is_ok());
}

#[test]
fn a_client_that_writes_and_then_reads_gets_what_it_wrote() {
    let live = live();
    let (_window, address) = window(&live, Limits::default());
    let mut client = client(address);
    for round in 0..20_u8 {
        client.write_area(S7_AREA_MK, 0, 100, S7_WL_BYTE, &[round, !round]).unwrap();
        let mut found = [0; 2];
        client.read_area(S7_AREA_MK, 0, 100, S7_WL_BYTE, &mut found).unwrap();
        assert_eq!(found, [round, !round]);
    }
    assert_eq!(live.with(|machine| machine.memory().flags[100]), 19);
}

/// A scan of a program in another process may take long: a panel continues to read, and its writes take effect afterwards.
#[test]
fn a_long_scan_does_not_hold_up_reads() {
    static IS_HELD: AtomicBool = AtomicBool::new(false);
    let mut machine = Machine::open("g1_example").expect("it is built in");
    machine.load_program(Box::new(plc::program("holds", (), |(), io: &mut PlcIo<'_>| {
        if io.flags[100] == 1 {
            IS_HELD.store(true, Ordering::SeqCst);
            while IS_HELD.load(Ordering::SeqCst) {
                std::thread::sleep(Duration::from_millis(1));
            }
        }
    })));
    let live = Live::start(machine, Speed::default());
    let (_window, address) = window(&live, Limits { step: Duration::from_millis(20), ..Limits::default() });
    let (mut panel, mut found) = (client(address), [0; 2]);
    panel.write_area(S7_AREA_MK, 0, 100, S7_WL_BYTE, &[1]).unwrap();
    wait("the scan that lasts", || IS_HELD.load(Ordering::SeqCst));
    panel.read_area(S7_AREA_MK, 0, 100, S7_WL_BYTE, &mut found).unwrap();
    assert_eq!(found, [0, 0], "the step before it");
    panel.write_area(S7_AREA_MK, 0, 100, S7_WL_BYTE, &[0, 7]).unwrap();
    client(address).read_area(S7_AREA_MK, 0, 100, S7_WL_BYTE, &mut found).unwrap();
    assert!(IS_HELD.swap(false, Ordering::SeqCst), "all of that was in one scan");
    assert_eq!(found, [0, 0], "nobody sees what the machine has not taken up");
    wait("what was written", || live.with(|machine| machine.memory().flags[100..102] == [0, 7]));
}

/// A cycle takes two microseconds here, so the reads would see several cycles.
#[test]
fn reads_that_came_together_see_one_step() {
    let mut machine = Machine::open("g1_example").expect("it is built in");
    machine.load_program(Box::new(plc::program("counts", 0_u8, |count: &mut u8, io: &mut PlcIo<'_>| {
        *count = count.wrapping_add(1);
        io.flags[0] = *count;
    })));
    let live = Live::start(machine, "1000".parse().unwrap());
    let (_window, address) = window(&live, Limits::default());
    let mut stream = bare(address);
    stream.write_all(&[&CONNECT[..], &SETUP].concat()).unwrap();
    let _answers = (packet(&mut stream), packet(&mut stream));
    for _ in 0..10 {
        stream.write_all(&READ.repeat(30)).unwrap(); // 930 bytes: one segment
        let answers: Vec<_> = (0..30).map(|_| packet(&mut stream).pop()).collect();
        assert!(answers.iter().all(|value| *value == answers[0]), "{answers:?}");
    }
}

/// Everything through S7: enables, mode, traversing key.
#[test]
fn an_axis_is_moved_through_s7_only() {
    let live = live();
    let (_window, address) = window(&live, Limits::default());
    let mut client = client(address);
    let y = live.with(|machine| machine.axis("Y")).unwrap();
    let position = || live.with(|machine| machine.variables().axes[y].position.user());
    let begin = position();
    client.write_bit(S7_AREA_DB, 32, 1, 5, true).unwrap(); // position measuring system 1
    client.write_bit(S7_AREA_DB, 32, 2, 1, true).unwrap(); // controller enable
    client.write_bit(S7_AREA_DB, 32, 21, 7, true).unwrap(); // pulse enable
    wait("the position controller", || client.read_bit(S7_AREA_DB, 32, 61, 5).unwrap());
    assert!((position() - begin).abs() < 0.001);
    client.write_bit(S7_AREA_DB, 32, 4, 7, true).unwrap(); // traversing key plus
    wait("the traverse command", || client.read_bit(S7_AREA_DB, 32, 64, 7).unwrap());
    wait("a millimetre", || position() > begin + 1.0);
    client.write_bit(S7_AREA_DB, 32, 4, 7, false).unwrap();
    wait("the standstill", || client.read_bit(S7_AREA_DB, 32, 61, 4).unwrap());
    wait("rest", || {
        let before = position();
        std::thread::sleep(Duration::from_millis(50));
        (position() - before).abs() < 0.001
    });
}

/// Each client writes its own four flags, and no read ever finds four different values.
#[test]
fn eight_clients_at_once_see_whole_requests() {
    let live = live();
    let (window, address) = window(&live, Limits::default());
    std::thread::scope(|scope| {
        for number in 0..8_u16 {
            scope.spawn(move || {
                let mut client = client(address);
                let mut all = [0; 32];
                for round in 0..50_u8 {
                    client.write_area(S7_AREA_MK, 0, 4 * number, S7_WL_BYTE, &[round; 4]).unwrap();
                    client.read_area(S7_AREA_MK, 0, 0, S7_WL_BYTE, &mut all).unwrap();
                    for part in all.chunks(4) {
                        assert!(part.iter().all(|byte| *byte == part[0]), "half a request: {part:?}");
                    }
                    assert_eq!(all[usize::from(4 * number)], round);
                }
                client.disconnect();
            });
        }
    });
    assert!(window.answers() >= 8 * 102);
    wait("the last client's leave", || window.clients() == 0);
}

#[test]
fn a_client_without_a_request_is_closed_at_the_idle_timeout() {
    let live = live();
    let limits = Limits { idle: Duration::from_millis(300), ..Limits::default() };
    assert!(limits.greeting > Duration::from_secs(5));
    let (window, address) = window(&live, limits);
    let begin = Instant::now();
    let mut silent = bare(address);
    wait("a client", || window.counters().connections.get() == 1);
    assert_eq!(silent.read(&mut [0; 100]).unwrap_or(0), 0);
    assert!(begin.elapsed() < Duration::from_secs(5));
    wait("its leave", || window.clients() == 0);
}

#[test]
fn a_new_client_replaces_one_without_a_request_but_no_other() {
    let live = live();
    let (window, address) = window(&live, Limits { clients: 3, ..Limits::default() });
    let mut first = client(address);
    let mut silent = [bare(address), bare(address)];
    wait("three clients", || window.clients() == 3);
    // The oldest silent connection is closed, then the next one: an incomplete packet is not a request.
    silent[1].write_all(&CONNECT[..11]).unwrap();
    let mut others = Vec::new();
    for stream in &mut silent {
        others.push(client(address));
        assert_eq!(stream.read(&mut [0; 100]).unwrap_or(0), 0);
    }
    // Clients with requests stay.
    assert_eq!(bare(address).read(&mut [0; 100]).unwrap_or(0), 0);
    assert!(first.read_bit(S7_AREA_DB, 31, 101, 6).unwrap());
    for other in &mut others {
        assert!(other.read_bit(S7_AREA_DB, 31, 101, 6).unwrap());
    }
    let ends: Vec<_> = window.counters().ends().filter(|(_, count)| *count > 0).collect();
    assert_eq!((ends, window.counters().crowded.get()), (vec![("gave_way", 2)], 1));
}

#[test]
fn garbage_and_incomplete_packets_do_not_hold_up_other_clients() {
    let live = live();
    let limits = Limits { greeting: Duration::from_millis(300), ..Limits::default() };
    let (window, address) = window(&live, limits);
    let mut good = client(address);
    // Another protocol: disconnected at once.
    let mut stream = bare(address);
    stream.write_all(b"GET / HTTP/1.1\r\n\r\n").unwrap();
    assert_eq!(stream.read(&mut [0; 100]).unwrap_or(0), 0);
    // A packet with an invalid length: disconnected at once.
    let mut stream = bare(address);
    stream.write_all(&[3, 0, 0xFF, 0xFF]).unwrap();
    assert_eq!(stream.read(&mut [0; 100]).unwrap_or(0), 0);
    // Packets that stay incomplete: closed after the time limit of the first request.
    let mut halves: Vec<_> = (0..20).map(|_| bare(address)).collect();
    for stream in &mut halves {
        stream.write_all(&CONNECT[..11]).unwrap();
    }
    // An incomplete packet, then the client closes.
    for length in 1..CONNECT.len() {
        bare(address).write_all(&CONNECT[..length]).unwrap();
    }
    assert!(good.read_bit(S7_AREA_DB, 31, 101, 6).unwrap());
    for stream in &mut halves {
        assert_eq!(stream.read(&mut [0; 100]).unwrap_or(0), 0);
    }
    // One byte at a time is slow but valid.
    let mut stream = bare(address);
    stream.set_nodelay(true).unwrap();
    for byte in CONNECT {
        stream.write_all(&[byte]).unwrap();
    }
    let mut confirm = [0; 22];
    stream.read_exact(&mut confirm).unwrap();
    assert_eq!(confirm[5], 0xD0);
    drop(stream);
    assert!(good.read_bit(S7_AREA_DB, 31, 101, 6).unwrap());
    wait("the others' leave", || window.clients() == 1);
}

/// The client sends requests without end and never reads: the server stops reading from it, and other clients are always answered.
#[test]
fn a_client_that_does_not_read_its_answers_is_closed() {
    let live = live();
    let limits = Limits { writing: Duration::from_millis(300), ..Limits::default() };
    let (window, address) = window(&live, limits);
    let mut good = client(address);
    let mut stream = bare(address);
    stream.set_write_timeout(Some(Duration::from_millis(50))).unwrap();
    stream.write_all(&[&CONNECT[..], &SETUP].concat()).unwrap();
    let requests = READ.repeat(1000);
    while stream.write_all(&requests).is_ok() {}
    assert!(good.read_bit(S7_AREA_DB, 31, 101, 6).unwrap());
    wait("its end", || window.clients() == 1);
    assert!(good.read_bit(S7_AREA_DB, 31, 101, 6).unwrap());
}

#[test]
fn a_client_beyond_the_limit_is_rejected_and_a_free_place_is_reused() {
    let live = live();
    let (window, address) = window(&live, Limits { clients: 2, ..Limits::default() });
    let (mut first, mut second) = (bare(address), client(address));
    first.write_all(&CONNECT).unwrap();
    first.read_exact(&mut [0; 22]).unwrap();
    wait("two clients", || window.clients() == 2);
    let mut third = bare(address);
    assert_eq!(third.read(&mut [0; 10]).unwrap_or(0), 0);
    first.shutdown(Shutdown::Both).unwrap();
    wait("a free place", || window.clients() == 1);
    let mut fourth = client(address);
    assert!(fourth.read_bit(S7_AREA_DB, 31, 101, 6).unwrap() && second.read_bit(S7_AREA_DB, 31, 101, 6).unwrap());
}

#[test]
fn only_clients_of_allowed_networks_are_accepted() {
    let live = live();
    let networks = |networks: &[&str]| Limits {
        networks: networks.iter().map(|network| network.parse().unwrap()).collect(),
        ..Limits::default()
    };
    let (_window, address) = window(&live, networks(&["10.0.0.0/8", "::1"]));
    assert_eq!(bare(address).read(&mut [0; 10]).unwrap_or(0), 0);
    let (_window, address) = window(&live, networks(&["10.0.0.0/8", "127.0.0.0/8"]));
    assert!(client(address).read_bit(S7_AREA_DB, 31, 101, 6).unwrap());
}

#[test]
fn a_read_only_server_refuses_writes() {
    let live = live();
    let window = LiveServer::open(&live, &["127.0.0.1:0"], true, Limits::default()).unwrap();
    let mut client = client(window.addresses()[0]);
    assert!(client.write_bit(S7_AREA_MK, 0, 0, 0, true).is_err());
    assert!(!client.read_bit(S7_AREA_MK, 0, 0, 0).unwrap());
}

/// Stop, state and start with the bytes of snap7's client.
#[test]
fn the_plc_is_stopped_and_started_by_a_client() {
    let mut machine = Machine::open("g1_example").unwrap();
    let program = Programs::ready().program("enable_all", machine.names()).unwrap();
    machine.load_program(program);
    let live = Live::start(machine, Speed::default());
    let (_window, address) = window(&live, Limits::default());
    let mut stream = bare(address);
    let mut ask = |request: &[u8]| {
        stream.write_all(request).unwrap();
        let mut answer = [0; 256];
        let length = stream.read(&mut answer).unwrap();
        answer[..length].to_vec()
    };
    ask(&CONNECT);
    ask(&SETUP);
    let name = b"P_PROGRAM";
    let stop =
        [&[3, 0, 0, 33, 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, 3, 0, 16, 0, 0, 0x29, 0, 0, 0, 0, 0, 9], &name[..]].concat();
    assert_eq!(ask(&stop)[17..19], [0, 0]);
    assert!(live.with(|machine| machine.is_plc_stopped()));
    wait("alarm 2000", || live.with(|machine| machine.variables().alarms.count() > 0));
    let head = [3, 0, 0, 37, 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, 4, 0, 20, 0, 0, 0x28, 0, 0, 0, 0, 0, 0, 0xFD, 0, 0, 9];
    assert_eq!(ask(&[&head[..], name].concat())[17..19], [0, 0]);
    assert!(!live.with(|machine| machine.is_plc_stopped()));
}

/// No step has executed the stop yet, but the start takes it into account and is not answered with "already in RUN".
#[test]
fn the_plc_of_a_held_machine_runs_after_a_stop_and_a_start() {
    let machine = Machine::open("g1_example").unwrap();
    let options = LiveOptions { is_held: true, ..LiveOptions::default() };
    let live = Live::start_with(machine, Speed::default(), options);
    let (_window, address) = window(&live, Limits::default());
    let mut stream = bare(address);
    stream.write_all(&[&CONNECT[..], &SETUP].concat()).unwrap();
    let _answers = (packet(&mut stream), packet(&mut stream));
    let stop = [&[0x29, 0, 0, 0, 0, 0, 9], &b"P_PROGRAM"[..]].concat();
    let start = [&[0x28, 0, 0, 0, 0, 0, 0, 0xFD, 0, 0, 9], &b"P_PROGRAM"[..]].concat();
    // After the error: the function and the additional byte.
    assert_eq!(ask(&mut stream, &start, &[])[2..], [0x28, 3], "it runs already");
    assert_eq!(ask(&mut stream, &stop, &[])[2..], [0x29]);
    assert_eq!(ask(&mut stream, &stop, &[])[2..], [0x29, 7], "it stands already");
    assert_eq!(ask(&mut stream, &start, &[])[2..], [0x28]);
    live.begin();
    wait("some cycles", || live.with(|machine| machine.cycle() > 5));
    assert!(!live.with(|machine| machine.is_plc_stopped()));
}

/// MB0 every 100 ms: subscribed with the bytes of a panel (user data, group 2, function 1); the writes of another client arrive.
#[test]
fn values_are_sent_cyclically() {
    let live = live();
    let (_window, address) = window(&live, Limits { idle: Duration::from_millis(300), ..Limits::default() });
    let mut panel = bare(address);
    let mut ask = |request: &[u8]| {
        panel.write_all(request).unwrap();
        packet(&mut panel)
    };
    ask(&CONNECT);
    ask(&SETUP);
    let mut subscribe =
        vec![3, 0, 0, 45, 2, 0xF0, 0x80, 0x32, 7, 0, 0, 0, 9, 0, 8, 0, 20, 0, 1, 0x12, 4, 0x11, 0x42, 1, 0];
    subscribe.extend([0xFF, 9, 0, 16, 0, 1, 0, 1, 0x12, 10, 0x10, 2, 0, 1, 0, 0, 0x83, 0, 0, 0]);
    let answer = ask(&subscribe);
    assert_eq!(answer[answer.len() - 5..answer.len() - 1], [0xFF, 4, 0, 8], "{answer:02X?}");
    for value in [1, 2] {
        client(address).write_area(S7_AREA_MK, 0, 0, S7_WL_BYTE, &[value]).unwrap();
        let begin = Instant::now();
        while packet(&mut panel).last() != Some(&value) {
            assert!(begin.elapsed() < Duration::from_secs(10));
        }
    }
}

/// A client without requests is closed, even if it sends bytes that are not requests.
#[test]
fn idle_clients_are_closed() {
    let live = live();
    let (window, address) = window(&live, Limits { idle: Duration::from_millis(200), ..Limits::default() });
    let mut stream = bare(address);
    stream.write_all(&CONNECT).unwrap();
    packet(&mut stream);
    let empty = [3, 0, 0, 7, 2, 0xF0, 0]; // an empty DT, which collectors send
    wait("the end", || stream.write_all(&empty).is_err() || window.clients() == 0);
}

/// A request in progress is answered; then the connection ends in order, and the port is free.
#[test]
fn the_end_is_graceful() {
    let live = live();
    let (window, address) = window(&live, Limits::default());
    let mut idle = bare(address);
    idle.write_all(&CONNECT).unwrap();
    idle.read_exact(&mut [0; 22]).unwrap();
    let begin = Instant::now();
    drop(window);
    assert!(begin.elapsed() < Duration::from_secs(1), "{:?}", begin.elapsed());
    assert_eq!(idle.read(&mut [0; 10]).unwrap(), 0, "the end of the stream, no reset");
    assert!(TcpStream::connect(address).is_err());
    let again = LiveServer::open(&live, &[&address.to_string()], false, Limits::default()).unwrap();
    assert!(client(again.addresses()[0]).read_bit(S7_AREA_DB, 31, 101, 6).unwrap());
}

/// Closing a socket with unread bytes resets the connection, and answers in transit are lost with it.
#[test]
fn a_client_that_is_disconnected_still_gets_its_last_answers() {
    let live = live();
    let (_window, address) = window(&live, Limits::default());
    let mut stream = bare(address);
    let foreign = b"GET / HTTP/1.1\r\n\r\n".repeat(1000);
    stream.write_all(&[&CONNECT[..], &SETUP, &READ.repeat(400), &foreign].concat()).unwrap();
    std::thread::sleep(Duration::from_millis(50));
    let mut all = Vec::new();
    stream.read_to_end(&mut all).expect("an end, no reset");
    // The answer to the setup has 27 bytes, each value 4 + 3 + 12 + 2 + 5.
    assert_eq!(all.len(), 22 + 27 + 400 * 26);
}

#[test]
fn ipv6_is_served_too() {
    let live = live();
    let Ok(window) = LiveServer::open(&live, &["[::1]:0"], false, Limits::default()) else {
        return; // this computer has no IPv6
    };
    let mut stream = bare(window.addresses()[0]);
    stream.write_all(&CONNECT).unwrap();
    stream.read_exact(&mut [0; 22]).unwrap();
}

#[test]
fn the_schedule_does_not_drift() {
    let begin = Instant::now();
    let live = Live::start(Machine::open("g1_example").unwrap(), "10".parse().unwrap());
    std::thread::sleep(Duration::from_millis(1000));
    let simulated = live.with(|machine| machine.time().seconds());
    let real = begin.elapsed().as_secs_f64();
    let lost = live.pace().lost.as_secs_f64();
    assert!((simulated / 10.0 - (real - lost)).abs() < 0.2, "{simulated} s in {real} s, {lost} s lost");
}

#[test]
fn an_address_that_cannot_be_opened_is_reported() {
    let live = live();
    let (window, address) = window(&live, Limits::default());
    for (address, cause) in [
        (address.to_string().as_str(), "in use"),
        ("127.0.0.1", "127.0.0.1:10102"),
        ("198.51.100.1:10102", "to this computer"),
    ] {
        let problem = LiveServer::open(&live, &[address], false, Limits::default()).unwrap_err().to_string();
        assert!(problem.contains(cause) && problem.contains(address), "{problem}");
    }
    drop(window);
}

/// The answer to a job at the NCK of a solution line, from its error on.
fn ask(stream: &mut TcpStream, parameter: &[u8], data: &[u8]) -> Vec<u8> {
    let length = |bytes: usize| u16::try_from(bytes).expect("short").to_be_bytes();
    let [total, p, d] = [17 + parameter.len() + data.len(), parameter.len(), data.len()].map(length);
    let head = [3, 0, total[0], total[1], 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, 1, p[0], p[1], d[0], d[1]];
    stream.write_all(&[&head, parameter, data].concat()).expect("it goes out");
    packet(stream)[17..].to_vec()
}

fn collector(address: SocketAddr) -> TcpStream {
    let mut stream = bare(address);
    let mut connect = CONNECT;
    connect[20..].copy_from_slice(&[0x0D, 4]);
    stream.write_all(&connect).expect("it goes out");
    packet(&mut stream);
    ask(&mut stream, &[0xF0, 0, 0, 1, 0, 1, 3, 0xC0], &[]);
    stream
}

/// MD32000 of X, and R5. A negative velocity is out of range and is refused before anything is written. MD37100 accepts any byte: the
/// control checks it at power on and raises 10650.
#[test]
fn a_collector_writes_machine_data_and_r_parameters_within_their_limits() {
    let live = live();
    let (_window, address) = window(&live, Limits::default());
    let mut stream = collector(address);
    let velocity = [0x12, 8, 0x82, 0x61, 0x7D, 0, 0, 1, 0x1A, 1];
    let r5 = [0x12, 8, 0x82, 0x41, 0, 1, 0, 6, 0x15, 1];
    let serial_number = [0x12, 8, 0x82, 1, 0x46, 0x6E, 0, 1, 0x1A, 1];
    let value = |value: f64| [&[0, 9, 0, 8][..], &value.to_le_bytes()].concat();
    let write = [&[5, 3][..], &velocity, &r5, &serial_number].concat();
    let answer = ask(&mut stream, &write, &[value(-1.0), value(2.5), value(0.0)].concat());
    assert_eq!(answer, [0, 0, 5, 3, 5, 0xFF, 3]);
    let answer = ask(&mut stream, &[&[5, 1][..], &velocity].concat(), &value(9000.0));
    assert_eq!(answer, [0, 0, 5, 1, 0xFF]);
    let gantry_axis_type = [0x12, 8, 0x82, 0x62, 0x90, 0xEC, 0, 1, 0x1A, 1];
    let answer = ask(&mut stream, &[&[5, 1][..], &gantry_axis_type].concat(), &[0, 9, 0, 1, 0xFF]);
    assert_eq!(answer, [0, 0, 5, 1, 0xFF]);
    let read = ask(&mut stream, &[&[4, 2][..], &velocity, &r5].concat(), &[]);
    let expected = [value(9000.0), value(2.5)].concat();
    assert_eq!((read[4], read[16]), (0xFF, 0xFF));
    assert_eq!((&read[5..16], &read[17..]), (&expected[1..12], &expected[13..]));
    let (axis, first) = (live.with(|machine| machine.axis("X")).unwrap(), opennck::units::ChannelNumber::FIRST);
    live.with(|machine| {
        assert!((machine.control().downcast::<Nck>().unwrap().stored().axes[axis].max_ax_velo - 9000.0).abs() < 1e-9);
        assert_eq!(machine.r_parameter(first, 5), Some(2.5));
    });
}

/// SZL 00A0, newest entry first: RUN, START-UP, manual cold restart, STOP by a programming device, then the entries of power on.
#[test]
fn stop_and_cold_restart_are_in_the_diagnostic_buffer_and_flags_are_cleared() {
    let live = live();
    let (_window, address) = window(&live, Limits::default());
    let mut stream = collector(address);
    client(address).write_area(S7_AREA_MK, 0, 100, S7_WL_BYTE, &[7]).unwrap();
    let program = b"\x09P_PROGRAM";
    let stop = [&[0x29, 0, 0, 0, 0, 0][..], program].concat();
    assert_eq!(ask(&mut stream, &stop, &[]), [0, 0, 0x29]);
    wait("STOP", || live.with(|machine| machine.is_plc_stopped()));
    let start = [&[0x28, 0, 0, 0, 0, 0, 0, 0xFD, 0, 2, b'C', b' '][..], program].concat();
    assert_eq!(ask(&mut stream, &start, &[]), [0, 0, 0x28]);
    wait("RUN", || live.with(|machine| !machine.is_plc_stopped()));
    assert_eq!(live.with(|machine| machine.memory().flags[100]), 0);
    let list = [0xFF, 9, 0, 4, 0, 0xA0, 0, 0];
    let head = [3, 0, 0, 33, 2, 0xF0, 0x80, 0x32, 7, 0, 0, 0, 1, 0, 8, 0, 8, 0, 1, 0x12, 4, 0x11, 0x44, 1, 0];
    stream.write_all(&[&head[..], &list].concat()).expect("it goes out");
    let answer = packet(&mut stream);
    let events: Vec<u16> =
        answer[41..].chunks_exact(20).map(|entry| u16::from_be_bytes([entry[0], entry[1]])).collect();
    assert_eq!(events, [0x4302, 0x4301, 0x1385, 0x4304, 0x4302, 0x4301, 0x4300]);
}
