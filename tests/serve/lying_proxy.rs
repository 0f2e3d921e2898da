//! `opennck s7` through a proxy that lies: it delays, cuts and closes where it hurts most. The command ends in time, and what was sent is not
//! called unsent.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![expect(clippy::disallowed_methods, reason = "the proxy waits in real time")]

use std::io::{Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::process::Output;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use crate::s7_command::{Served, program};

/// The time limit of a command that must exceed it, the pause of a proxy that stays just below it, and how long the command may take: a
/// proxy that could reset the time limit would hold it for longer.
const SHORT: &str = "2s";
const JUST_BELOW: Duration = Duration::from_millis(1700);
const SOON: Duration = Duration::from_secs(15);
/// The time limit of a command that ends otherwise.
const LONG: &str = "60s";

/// What the proxy does to the answer of a read or a write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Lie {
    /// Every packet comes just before the time limit, also those of the handshake.
    Late,
    /// Each byte comes just before the time limit.
    Drip,
    /// Answers to somebody else come, and never the right one.
    Chatter,
    /// No answer comes at all.
    Mute,
    /// Half of the answer, then the connection is closed.
    Half,
    /// The same, on the first connection alone.
    HalfOnce,
    /// The last byte is missing.
    Short,
    /// A byte in the middle is missing.
    Gap,
    /// The request is taken and the connection is closed; the server never gets it.
    Swallowed,
}

/// A proxy in front of a server, and the functions of the jobs that it received.
struct Proxy {
    host: String,
    jobs: Arc<Mutex<Vec<u8>>>,
}

impl Proxy {
    fn start(server: &str, lie: Lie) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let (host, jobs) = (listener.local_addr().unwrap().to_string(), Arc::default());
        let (server, seen) = (server.to_owned(), Arc::clone(&jobs));
        // It ends with the test.
        std::thread::spawn(move || {
            for (number, client) in listener.incoming().enumerate() {
                let (client, server, seen) = (client.unwrap(), TcpStream::connect(&server).unwrap(), Arc::clone(&seen));
                std::thread::spawn(move || converse(client, server, (number, lie), &seen));
            }
        });
        Self { host, jobs }
    }

    /// `opennck s7 COMMAND` through the proxy, and how long it took.
    fn ask(&self, command: &str, argument: &str, timeout: &str) -> (Output, Duration) {
        let begin = Instant::now();
        let output = program(&["s7", command, &self.host, argument, "--timeout", timeout]).output().unwrap();
        (output, begin.elapsed())
    }

    fn count(&self, function: u8) -> usize {
        self.jobs.lock().unwrap().iter().filter(|job| **job == function).count()
    }
}

/// A packet; `None` at the end of the connection.
fn packet(stream: &mut TcpStream) -> Option<Vec<u8>> {
    let mut packet = vec![0; 4];
    stream.read_exact(&mut packet).ok()?;
    packet.resize(usize::from(u16::from_be_bytes([packet[2], packet[3]])), 0);
    stream.read_exact(&mut packet[4..]).ok()?;
    Some(packet)
}

const READ: u8 = 4;
const WRITE: u8 = 5;

/// The function of a job for S7 communication.
fn function(packet: &[u8]) -> Option<u8> {
    (packet[5] == 0xF0 && packet[8] == 1).then(|| packet[17])
}

/// Requests and answers in turn. A connection that the client has left ends in an error of a read or a write.
fn converse(mut client: TcpStream, mut server: TcpStream, (number, lie): (usize, Lie), jobs: &Mutex<Vec<u8>>) {
    while let Some(request) = packet(&mut client) {
        let function = function(&request);
        jobs.lock().unwrap().extend(function);
        let is_meant = function.is_some_and(|function| [READ, WRITE].contains(&function));
        if is_meant && lie == Lie::Swallowed {
            break;
        }
        server.write_all(&request).unwrap();
        let Some(mut answer) = packet(&mut server) else { break };
        if lie == Lie::Late {
            std::thread::sleep(JUST_BELOW);
        }
        let is_told = match lie {
            _ if !is_meant => client.write_all(&answer),
            Lie::Late | Lie::Swallowed => client.write_all(&answer),
            Lie::HalfOnce if number > 0 => client.write_all(&answer),
            Lie::Drip => answer.iter().try_for_each(|byte| {
                std::thread::sleep(JUST_BELOW);
                client.write_all(&[*byte])
            }),
            Lie::Chatter => {
                answer[12] ^= 0x55; // the reference
                (0..30).try_for_each(|_| {
                    std::thread::sleep(JUST_BELOW / 2);
                    client.write_all(&answer)
                })
            }
            Lie::Mute => Ok(()),
            Lie::Half | Lie::HalfOnce => {
                let _ = client.write_all(&answer[..answer.len() / 2]);
                break;
            }
            Lie::Short => client.write_all(&answer[..answer.len() - 1]),
            Lie::Gap => {
                answer.remove(answer.len() / 2);
                client.write_all(&[&answer[..], &answer].concat())
            }
        };
        if is_told.is_err() {
            break;
        }
    }
    let _ = client.shutdown(Shutdown::Both);
}

fn error(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn the_time_limit_of_a_connection_is_that_of_its_whole_handshake() {
    let served = Served::start();
    let proxy = Proxy::start(&served.host, Lie::Late);
    let (output, took) = proxy.ask("read", "MB0", SHORT);
    assert_eq!(output.status.code(), Some(2), "{}", error(&output));
    assert!(error(&output).contains("no answer within 2 s") && took < SOON, "{took:?}: {}", error(&output));
    assert_eq!(proxy.count(READ), 0);
}

#[test]
fn the_time_limit_of_a_request_is_not_prolonged_by_what_arrives_meanwhile() {
    let served = Served::start();
    let ask = &|lie| {
        let proxy = Proxy::start(&served.host, lie);
        for (command, argument, said) in [("read", "MB0", "MB0"), ("write", "MB3=7", "MB3")] {
            let (output, took) = proxy.ask(command, argument, SHORT);
            let error = error(&output);
            assert_eq!(output.status.code(), Some(2), "{lie:?}: {error}");
            assert!(took < SOON, "{lie:?}: {took:?}: {error}");
            assert!(error.contains(said) && error.contains("no answer within 2 s"), "{lie:?}: {error}");
            assert!(!error.contains("was not sent"), "{lie:?}: {error}");
        }
        assert_eq!(proxy.count(WRITE), 1, "{lie:?}");
    };
    std::thread::scope(|scope| {
        for lie in [Lie::Drip, Lie::Chatter, Lie::Short] {
            scope.spawn(move || ask(lie));
        }
    });
}

/// The names of axes, which the NCK does not have to tell, are asked for first: that time counts, too.
#[test]
fn a_module_that_never_answers_ends_a_read_after_the_time_limit_and_nothing_was_executed() {
    let served = Served::start();
    let proxy = Proxy::start(&served.host, Lie::Mute);
    let (output, took) = proxy.ask("read", "AX1.controller_enable", "5s");
    let error = error(&output);
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!((5.0..7.5).contains(&took.as_secs_f64()), "{took:?}: {error}");
    assert!(error.contains("DB31.DBX2.1: no answer within 5 s\n"), "{error}");
    assert!(error.contains("increase the timeout") && !error.contains("executed"), "{error}");
}

#[test]
fn a_write_whose_answer_was_cut_off_was_sent_and_is_not_repeated() {
    let served = Served::start();
    for (value, lie) in [("11", Lie::Half), ("12", Lie::Gap), ("13", Lie::Swallowed)] {
        let proxy = Proxy::start(&served.host, lie);
        let (output, took) = proxy.ask("write", &format!("MB3={value}"), LONG);
        let error = error(&output);
        assert_eq!(output.status.code(), Some(2), "{lie:?}: {error}");
        assert!(took < SOON, "{lie:?}: {took:?}: {error}");
        assert!(error.contains("connection lost (") && error.contains("; the request was sent\n"), "{lie:?}: {error}");
        assert!(error.contains("may have been executed: read the value before you repeat it"), "{lie:?}: {error}");
        assert_eq!(proxy.count(WRITE), 1, "{lie:?}: a write is never repeated");
        let is_written = served.text("read", &["MB3"]).split_whitespace().any(|word| word == value);
        assert_eq!(is_written, lie != Lie::Swallowed, "{lie:?}");
    }
}

/// A read changes nothing, so it is repeated on the next connection.
#[test]
fn a_read_whose_answer_was_cut_off_is_repeated_for_no_longer_than_its_time_limit() {
    let served = Served::start();
    served.text("write", &["MB3=7"]);
    let proxy = Proxy::start(&served.host, Lie::HalfOnce);
    let (output, _) = proxy.ask("read", "MB3", LONG);
    assert_eq!((output.status.code(), proxy.count(READ)), (Some(0), 2), "{}", error(&output));
    let proxy = Proxy::start(&served.host, Lie::Half);
    let (output, took) = proxy.ask("read", "MB3", SHORT);
    assert_eq!(output.status.code(), Some(2), "{}", error(&output));
    assert!(took < SOON && proxy.count(READ) > 1, "{took:?}: {}", error(&output));
    assert!(!error(&output).contains("was not sent"), "{}", error(&output));
}
