//! `opennck serve` with a STEP 7 program, and clients of S7 communication: timers, counters, the state of the CPU, its diagnostic buffer, and
//! the lines that `serve` prints when the program stops the PLC and when it starts again.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::PathBuf;
use std::process::Stdio;

use rust7::{S7_AREA_MK, S7_WL_BYTE};

use crate::clients::{CONNECT, bare, client, packet, setup};
use crate::processes::EndsWithTest;
use crate::s7_command::program;

/// A delay of 100 s, a counter, and a statement that stops the PLC. The fault is in line 5.
const SOURCE: &str = "ORGANIZATION_BLOCK OB 1\nBEGIN\nNETWORK\n\
    A M 0.7; JCN a;\nOPN DB 99;\na: NOP 0;\nNETWORK\n\
    A M 0.0; L S5T#100S; SD T 5;\nA M 0.1; CU C 3;\nEND_ORGANIZATION_BLOCK\n";

fn folder() -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("served_step7");
    fs::create_dir_all(&folder).expect("the target directory is writable");
    fs::write(folder.join("main.awl"), SOURCE).expect("it is writable");
    folder
}

/// Sends a request and returns the answer.
fn ask(stream: &mut TcpStream, request: &[u8]) -> Vec<u8> {
    stream.write_all(request).expect("it goes out");
    packet(stream)
}

/// Reads the word of a timer (1Dh) or a counter (1Ch).
fn word(stream: &mut TcpStream, kind: u8, number: u8) -> u16 {
    let head = [3, 0, 0, 31, 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, 2, 0, 14, 0, 0, 4, 1];
    let item = [0x12, 10, 0x10, kind, 0, 1, 0, 0, kind, 0, 0, number];
    let answer = ask(stream, &[&head[..], &item].concat());
    u16::from_be_bytes(*answer.last_chunk().expect("it has a word"))
}

/// Reads a system state list; returns its records.
fn list(stream: &mut TcpStream, id: u16) -> Vec<u8> {
    let [high, low] = id.to_be_bytes();
    let head = [3, 0, 0, 33, 2, 0xF0, 0x80, 0x32, 7, 0, 0, 0, 1, 0, 8, 0, 8, 0, 1, 0x12, 4, 0x11, 0x44, 1, 0];
    ask(stream, &[&head[..], &[0xFF, 9, 0, 4, high, low, 0, 0]].concat())[41..].to_vec()
}

/// The numbers of the newest entries of the diagnostic buffer.
fn events(stream: &mut TcpStream, count: usize) -> Vec<u16> {
    let entries = list(stream, 0x00A0);
    entries.chunks_exact(20).take(count).map(|entry| u16::from_be_bytes([entry[0], entry[1]])).collect()
}

/// The state in list 0424: 8 is RUN, 4 is STOP.
fn state(stream: &mut TcpStream) -> u8 {
    list(stream, 0x0424)[3] & 0xF
}

/// Waits for a value, at most some seconds.
#[track_caller]
fn becomes<T: PartialEq + std::fmt::Debug>(mut read: impl FnMut() -> T, wanted: &T) {
    for _ in 0..500 {
        if read() == *wanted {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    panic!("expected {wanted:?}, found {:?}", read());
}

#[test]
fn clients_see_timers_counters_and_why_the_program_stopped_the_plc() {
    let folder = folder();
    let arguments = ["serve", "g1_example", "--plc", folder.to_str().expect("it is UTF-8"), "--s7", "127.0.0.1:0"];
    let mut child = program(&arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it was built");
    let _ends = EndsWithTest::new(&child);
    let printed = BufReader::new(child.stdout.take().expect("it is piped")).lines();
    let mut addresses = printed
        .map_while(Result::ok)
        .filter_map(|line| line.split_once("127.0.0.1:")?.1.split(':').next()?.trim().parse::<u16>().ok());
    let address = SocketAddr::from(([127, 0, 0, 1], addresses.next().expect("the output has the port")));
    let mut log = BufReader::new(child.stderr.take().expect("it is piped")).lines().map_while(Result::ok);

    let mut stream = bare(address);
    ask(&mut stream, &CONNECT);
    ask(&mut stream, &setup(480));
    let mut rust7 = client(address);
    let mut set = |flags: u8| rust7.write_area(S7_AREA_MK, 0, 0, S7_WL_BYTE, &[flags]).expect("flags are writable");

    assert_eq!(state(&mut stream), 8);
    assert_eq!((word(&mut stream, 0x1D, 5), word(&mut stream, 0x1C, 3)), (0, 0));
    set(0b11);
    becomes(|| word(&mut stream, 0x1C, 3), &1);
    set(0b01);
    set(0b11);
    becomes(|| word(&mut stream, 0x1C, 3), &2);
    // 100 s are 100 of the base 1 s (2 in the bits 12 and 13), in BCD; some of them have passed at most.
    let timer = word(&mut stream, 0x1D, 5);
    assert!((0x2080..=0x2100).contains(&timer), "{timer:04X}");

    // DB99 is not loaded (253A), so the CPU is in STOP because of a programming error (4562).
    set(0b1000_0000);
    becomes(|| state(&mut stream), &4);
    assert_eq!(events(&mut stream, 2), [0x4562, 0x253A]);
    let line = log.find(|line| line.contains("the PLC stops")).expect("serve prints the stop");
    let fault = "the PLC stops: OB1, network 1, statement 3 (main.awl:5): DB99 is not loaded; ACCU1 ";
    assert!(line.contains(fault) && line.contains(" STW "), "{line}");

    // A warm restart by a client, after the cause is gone.
    set(0);
    let start = [0x28, 0, 0, 0, 0, 0, 0, 0xFD, 0, 0, 9];
    let head = [3, 0, 0, 37, 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, 4, 0, 20, 0, 0];
    ask(&mut stream, &[&head[..], &start, b"P_PROGRAM"].concat());
    becomes(|| state(&mut stream), &8);
    assert_eq!(events(&mut stream, 2), [0x4302, 0x4301]);
    assert!(log.any(|line| line.contains("the PLC starts again")), "serve prints the start");
    child.kill().expect("it runs");
    child.wait().expect("it ends");
}
