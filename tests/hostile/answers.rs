//! Hostile conversations, as no regular client has them. Each is passed to a session (at once, packet by packet, in small pieces) and to
//! the server over TCP. Each request must be answered correctly, or the connection must end; a regular client must be served after each.
#![expect(clippy::disallowed_methods, reason = "a live machine runs in real time")]

use std::io::{Read, Write};
use std::net::{Shutdown, SocketAddr, TcpStream};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use opennck::image::Preset;
use opennck::live::Live;
use opennck::machine::{Machine, OpenOptions};
use opennck::s7::live::LiveServer;
use opennck::s7::server::Limits;
use rust7::{S7_AREA_DB, S7Client};

use crate::clients::client;
use crate::conversation;
use crate::conversations::{Act, Conversation, conversations};
use crate::oracle::{Expected, Listener, packet_length};

/// A job with an unknown function, and its reference.
const PROBE: [u8; 18] = [3, 0, 0, 18, 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0xBE, 0xEF, 0, 1, 0, 0, 0x77];

#[test]
fn there_are_more_than_900_conversations_with_different_names() {
    let mut names: Vec<_> = conversations().into_iter().map(|conversation| conversation.name).collect();
    let count = names.len();
    names.sort();
    names.dedup();
    assert!(names.len() == count && count > 900, "{} names of {count}", names.len());
}

#[test]
fn a_session_answers_every_conversation_or_ends_it() {
    for conversation in conversations() {
        let mut input = vec![0];
        for act in &conversation.acts {
            match act {
                Act::Send(bytes) => input.extend(bytes),
                Act::Pause(time) => {
                    input.extend(conversation::PAUSE);
                    input.push(u8::try_from(time.div_ceil(10)).unwrap_or(u8::MAX));
                }
            }
        }
        let judged = std::panic::catch_unwind(|| conversation::judge(&input));
        assert!(judged.is_ok(), "{}", conversation.name);
    }
}

#[test]
fn a_good_client_is_served_after_each() {
    let (_live, window) = open();
    let address = window.addresses()[0];
    let mut old = client(address);
    for conversation in conversations() {
        let begin = Instant::now();
        tell(&conversation, address);
        serve(&mut old, &conversation.name);
        serve(&mut client(address), &conversation.name);
        let time = begin.elapsed();
        assert!(time < Duration::from_secs(10), "{} held it up for {time:?}", conversation.name);
    }
    drop(old);
    let begin = Instant::now();
    while window.clients() > 0 {
        assert!(begin.elapsed() < Duration::from_secs(10), "{} clients are still there", window.clients());
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// All conversations from sixteen threads at once, and connections that send nothing.
#[test]
fn a_good_client_is_served_during_all_conversations() {
    let (live, window) = open();
    let address = window.addresses()[0];
    let all = conversations();
    let _silent: Vec<_> = (0..30).map(|_| TcpStream::connect(address).unwrap()).collect();
    let is_over = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let sides = (0..16).map(|side| {
            let all = &all;
            scope.spawn(move || all.iter().skip(side).step_by(16).for_each(|conversation| tell(conversation, address)))
        });
        let sides: Vec<_> = sides.collect();
        let good = scope.spawn(|| {
            let mut client = client(address);
            while !is_over.load(Ordering::Relaxed) {
                serve(&mut client, "some of them");
            }
        });
        let hostile: Vec<_> = sides.into_iter().map(|side| side.join()).collect();
        is_over.store(true, Ordering::Relaxed);
        assert!(good.join().is_ok() && hostile.iter().all(Result::is_ok));
    });
    assert!(live.is_running());
}

/// A live machine with the image `recipes` at five times real time, and its server.
fn open() -> (Live, LiveServer) {
    let preset = Preset::read(Path::new("plc_images/recipes.toml")).expect("it is there");
    let options = OpenOptions { preset: Some(preset), ..OpenOptions::default() };
    let machine = Machine::open_with("g1_example", options).expect("it is built in");
    let live = Live::start(machine, "5".parse().expect("a speed"));
    let window = LiveServer::open(&live, &["127.0.0.1:0"], false, Limits::default()).expect("some port is free");
    (live, window)
}

/// DB 1001 of the image `recipes`, which is never written: `8C 00 FF` repeated.
fn serve(client: &mut S7Client, after: &str) {
    let mut found = [0; 30];
    let read = client.read_db(1001, 3, &mut found);
    assert!(read.is_ok() && found == *[0x8C, 0, 0xFF].repeat(10), "after {after}: {found:02X?}");
    assert!(client.read_bit(S7_AREA_DB, 1001, 0, 7).expect("it is there"));
}

/// The packets sent by a client, and whether all of its bytes form packets. An empty packet marks the position where the stream becomes
/// invalid.
fn packets(conversation: &Conversation) -> (Vec<Vec<u8>>, bool) {
    let sent = conversation.acts.iter().filter_map(|act| if let Act::Send(bytes) = act { Some(bytes) } else { None });
    let stream: Vec<u8> = sent.flatten().copied().collect();
    let (mut rest, mut packets) = (stream.as_slice(), Vec::new());
    loop {
        match packet_length(rest) {
            Ok(Some(length)) if length <= rest.len() => {
                let (packet, others) = rest.split_at(length);
                packets.push(packet.to_vec());
                rest = others;
            }
            Ok(_) => return (packets, rest.is_empty()),
            Err(()) => {
                packets.push(Vec::new());
                return (packets, false);
            }
        }
    }
}

fn tell(conversation: &Conversation, address: SocketAddr) {
    let mut stream = TcpStream::connect(address).expect("the server is there");
    stream.set_nodelay(true).expect("it is a socket");
    let reader = stream.try_clone().expect("there is a handle left");
    std::thread::scope(|scope| {
        let listening = scope.spawn(|| listen(conversation, reader));
        for act in &conversation.acts {
            match act {
                // The server may have closed the connection; the listener checks whether that was correct.
                Act::Send(bytes) => drop(stream.write_all(bytes)),
                Act::Pause(time) => std::thread::sleep(Duration::from_millis(*time)),
            }
        }
        let _ = stream.write_all(&PROBE);
        assert!(listening.join().is_ok(), "{}", conversation.name);
    });
    let _ = stream.shutdown(Shutdown::Both);
}

/// Receives the answers and judges each.
fn listen(conversation: &Conversation, stream: TcpStream) {
    let (mut packets, is_whole) = packets(conversation);
    if is_whole {
        // The next answer must be the one to this probe: there must be no answer without a request.
        packets.push(PROBE.to_vec());
    }
    let mut incoming = Incoming { stream, bytes: Vec::new() };
    incoming.stream.set_read_timeout(Some(Duration::from_secs(5))).expect("it is a time");
    let mut listener = Listener::new(Vec::new());
    // If a later packet is invalid, the connection may be reset before all answers have arrived.
    let mut later = listener.clone();
    let ends = |packet: &Vec<u8>| packet.is_empty() || matches!(later.hear(packet), Expected::End | Expected::Goodbye);
    let must_end = packets.iter().any(ends);
    for packet in &packets {
        let expected = if packet.is_empty() { Expected::End } else { listener.hear(packet) };
        if expected == Expected::Silence {
            continue;
        }
        let answer = incoming.answer(&listener, &conversation.name);
        let has_ended = answer.is_none() || expected == Expected::Goodbye;
        assert!(!has_ended || must_end, "{}: it ended, an answer was due to {packet:02X?}", conversation.name);
        if let Some(answer) = answer {
            listener.judge(&expected, &[&answer], has_ended);
        }
        if has_ended {
            return;
        }
    }
}

/// Answers in the order of arrival.
struct Incoming {
    stream: TcpStream,
    bytes: Vec<u8>,
}

impl Incoming {
    /// The next answer, which may have several packets; `None` at the end. Pushes are judged and skipped.
    fn answer(&mut self, listener: &Listener, name: &str) -> Option<Vec<u8>> {
        let mut answer = Vec::new();
        loop {
            let packet = self.packet(name)?;
            let goes_on = packet.get(5..7) == Some(&[0xF0, 0]);
            answer.extend(packet);
            if goes_on {
                continue;
            }
            if answer.get(7..9) == Some(&[0x32, 7]) && answer.get(22).is_some_and(|kind| kind >> 4 == 0) {
                listener.judge_push(&answer);
                answer.clear();
            } else {
                return Some(answer);
            }
        }
    }

    fn packet(&mut self, name: &str) -> Option<Vec<u8>> {
        loop {
            if let Some(length) = packet_length(&self.bytes).expect("packets come").filter(|l| *l <= self.bytes.len()) {
                return Some(self.bytes.drain(..length).collect());
            }
            let mut read = [0; 4096];
            match self.stream.read(&mut read) {
                Ok(0) => return None,
                Ok(count) => self.bytes.extend(&read[..count]),
                Err(error) if matches!(error.kind(), std::io::ErrorKind::ConnectionReset) => return None,
                Err(error) => panic!("{name}: silence: {error}"),
            }
        }
    }
}
