//! A second server that connects to a live machine only through its handle. Its protocol is lines of text on TCP.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime};

use opennck::live::{Event, Handle, Live, LiveOptions, Order, Recording, Speed};
use opennck::machine::{Command, Machine};
use opennck::plc::Programs;
use opennck::s7::live::LiveServer;
use opennck::s7::server::Limits;
use opennck::scenario::{Heading, Scenario};
use opennck::trace::Watch;
use tokio::runtime::{Builder, Runtime};

/// A line server for one client; it runs until it is dropped or the machine ends.
struct Lines {
    address: SocketAddr,
    ends: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Lines {
    fn open(live: Handle) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap();
        let ends = Arc::new(AtomicBool::new(false));
        let ended = Arc::clone(&ends);
        let thread = Some(std::thread::spawn(move || serve(&live, &listener, &ended)));
        Self { address, ends, thread }
    }

    fn client(&self) -> Client {
        let stream = TcpStream::connect(self.address).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        Client(BufReader::new(stream))
    }
}

impl Drop for Lines {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Relaxed);
        self.thread.take().unwrap().join().unwrap();
    }
}

fn serve(live: &Handle, listener: &TcpListener, ends: &AtomicBool) {
    let runtime = Builder::new_current_thread().build().unwrap();
    let (mut stream, client) = listener.accept().unwrap();
    stream.set_read_timeout(Some(Duration::from_millis(10))).unwrap();
    let mut lines = BufReader::new(stream.try_clone().unwrap());
    let mut line = String::new();
    while !ends.load(Ordering::Relaxed) && !live.has_ended() {
        match lines.read_line(&mut line) {
            Ok(0) => return,
            Ok(_) => {
                let answer = answer(live, client, line.trim(), &runtime);
                writeln!(stream, "{answer}").unwrap();
                line.clear();
            }
            Err(_) => {} // no data: an incomplete line is kept
        }
    }
    if live.has_ended() {
        writeln!(stream, "ended").unwrap();
    }
}

/// `read ADDRESS` returns `STEP VALUE`; `write ADDRESS VALUE`, `clock SECONDS` and `stop` return `done STEP`; `follow COUNT` returns the
/// numbers of this many consecutive steps that it saw. `ended` if the machine ended first.
fn answer(live: &Handle, client: SocketAddr, line: &str, runtime: &Runtime) -> String {
    let words: Vec<_> = line.split(' ').collect();
    let locate = |address: &str| {
        live.look(|seen| {
            let machine = seen.machine();
            machine.memory().locate(&address.parse().unwrap(), machine.names().profile).unwrap()
        })
    };
    let done = |order: Order| {
        let step = live.order(order);
        if runtime.block_on(live.taken_up(step)) { format!("done {step}") } else { "ended".to_owned() }
    };
    let client = Some(client);
    match words[..] {
        ["read", address] => {
            let location = locate(address);
            live.look(|seen| format!("{} {}", seen.step(), seen.machine().memory().read(location)))
        }
        ["write", address, value] => {
            let commands = vec![Command::Write { location: locate(address), value: value.parse().unwrap() }];
            done(Order { client, commands, ..Order::default() })
        }
        ["stop"] => done(Order { client, commands: vec![Command::PlcStop], clock: None }),
        ["clock", seconds] => {
            let time = SystemTime::UNIX_EPOCH + Duration::from_secs(seconds.parse().unwrap());
            done(Order { client, clock: Some(time), ..Order::default() })
        }
        ["follow", count] => {
            let mut seen = live.look(|seen| seen.step());
            let mut steps = Vec::new();
            for _ in 0..count.parse().unwrap() {
                if !runtime.block_on(live.over(seen + 1)) {
                    return "ended".to_owned();
                }
                seen = live.look(|seen| seen.step());
                steps.push(seen.to_string());
            }
            steps.join(" ")
        }
        _ => panic!("{line}: read, write, clock, stop and follow are all that it knows"),
    }
}

struct Client(BufReader<TcpStream>);

impl Client {
    fn send(&mut self, line: &str) {
        writeln!(self.0.get_mut(), "{line}").unwrap();
    }

    fn receive(&mut self) -> String {
        let mut answer = String::new();
        self.0.read_line(&mut answer).unwrap();
        answer.trim().to_owned()
    }

    /// The answer to a line; its words as numbers where possible.
    fn ask(&mut self, line: &str) -> Vec<u64> {
        self.send(line);
        self.receive().split(' ').filter_map(|word| word.parse().ok()).collect()
    }
}

#[test]
fn a_second_server_reads_writes_and_counts_steps_beside_the_first() {
    let live = Live::start(Machine::open("g1_example").unwrap(), Speed::default());
    let window = LiveServer::open(&live, &["127.0.0.1:0"], false, Limits::default()).unwrap();
    let lines = Lines::open(live.handle());
    let mut client = lines.client();
    assert_eq!(client.ask("read M100.3")[1], 0);
    let done = client.ask("write M100.3 1")[0];
    let read = client.ask("read M100.3");
    assert!(read[0] >= done && read[1] == 1, "{read:?} after step {done}");
    // All 31 axes have this byte; in the example it marks the leading axis.
    assert_eq!(client.ask("read DB31.DBX101.6")[1], 1);
    let steps = client.ask("follow 5");
    assert!(steps.len() == 5 && steps.is_sorted_by(|one, next| one < next), "{steps:?}");
    drop((lines, window));
    assert!(live.end().is_some(), "no server holds a handle");
}

#[test]
fn what_a_second_server_orders_is_recorded_and_runs_again() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("live_lines.toml");
    let _ = fs::remove_file(&path);
    let machine = Machine::open("g1_example").unwrap();
    let heading = Heading { title: "lines", machine: "g1_example", ..Heading::default() };
    let recording = Some(Recording::begin(&path, &heading, &machine).unwrap());
    let options = LiveOptions { recording, trace: Some(Watch::default()), ..LiveOptions::default() };
    let live = Live::start_with(machine, Speed::default(), options);
    let lines = Lines::open(live.handle());
    let mut client = lines.client();
    client.ask("write DB31.DBX2.1 1");
    client.ask("write MB100 7");
    drop(lines);
    let trace = live.end().unwrap().json_lines().unwrap();
    let recorded = fs::read_to_string(&path).unwrap();
    assert_eq!(recorded.matches("client 1, from 127.0.0.1").count(), 2, "{recorded}");
    let again = Scenario::read(&path).unwrap();
    let finished = again.prepare(again.profiles[0], &Programs::ready()).unwrap().run();
    assert_eq!(finished.json_lines(), trace);
}

#[test]
fn a_second_server_stops_the_plc_and_sets_its_clock() {
    let live = Live::start(Machine::open("g1_example").unwrap(), Speed::default());
    let (handle, lines) = (live.handle(), Lines::open(live.handle()));
    let mut client = lines.client();
    // 30 November 2026.
    client.ask("clock 1796029200");
    client.ask("stop");
    let (clock, newest) = handle.look(|seen| (seen.clock(), seen.diagnosis()[0]));
    let since = |time: SystemTime| time.duration_since(SystemTime::UNIX_EPOCH).unwrap().as_secs();
    assert!((1_796_029_200..1_796_029_260).contains(&since(clock)), "{clock:?}");
    assert!(newest.event == Event::Stop && newest.time <= clock, "{newest:?}");
    assert!(handle.look(|seen| seen.machine().is_plc_stopped() && !handle.plc_runs(seen)));
}

#[test]
fn a_server_detects_that_the_machine_has_ended() {
    let live = Live::start(Machine::open("g1_example").unwrap(), Speed::default());
    let handle = live.handle();
    let lines = Lines::open(live.handle());
    let mut client = lines.client();
    assert!(!client.ask("read MB100").is_empty() && !handle.has_ended());
    client.send("follow 1000000");
    assert!(live.end().is_none(), "a server holds a handle");
    assert_eq!(client.receive(), "ended");
    assert!(handle.has_ended());
    let step = handle.look(|seen| seen.step());
    assert_eq!(handle.order(Order::default()), step + 1);
}

#[test]
fn orders_from_a_machine_that_is_held_are_acknowledged_at_once() {
    let options = LiveOptions { is_held: true, ..LiveOptions::default() };
    let live = Live::start_with(Machine::open("g1_example").unwrap(), Speed::default(), options);
    let lines = Lines::open(live.handle());
    let mut client = lines.client();
    assert_eq!(client.ask("write MB100 7"), [1]);
    assert_eq!(client.ask("read MB100"), [0, 0]);
    live.begin();
    assert!(client.ask("follow 1")[0] >= 1);
    assert_eq!(client.ask("read MB100")[1], 7);
}
