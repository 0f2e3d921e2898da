//! Recordings: the actions of clients and of a scenario on a live machine, recorded as a scenario, give the same trace byte for byte. Each
//! request reads or writes as a whole, at any speed.
#![expect(clippy::disallowed_methods, reason = "a live machine is watched in real time")]

mod panel;
mod program;

use std::fs;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use opennck::image::AsBytes;
use opennck::live::{Live, LiveOptions, Recording};
use opennck::machine::Machine;
use opennck::plc::{PlcFault, PlcIo, PlcProgram, Programs};
use opennck::s7::live::LiveServer;
use opennck::s7::server::Limits;
use opennck::scenario::{Heading, Scenario};
use opennck::source::Problem;
use opennck::trace::Watch;
use rust7::{S7_AREA_DB, S7_AREA_MK, S7_WL_BYTE, S7Client};

use panel::{Bare, DB, FLAGS, Item};

/// A recorded live machine with its clients.
struct Recorded {
    live: Live,
    window: LiveServer,
    path: PathBuf,
}

impl Recorded {
    fn start(name: &str, speed: &str, plc: Option<&str>) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.toml"));
        let _ = fs::remove_file(&path);
        let mut machine = Machine::open("g1_example").expect("it is built in");
        if let Some(plc) = plc {
            machine.load_program(Programs::ready().program(plc, machine.names()).expect("it is ready"));
        }
        let heading = Heading { title: name, machine: "g1_example", plc, ..Heading::default() };
        let recording = Some(Recording::begin(&path, &heading, &machine).expect("the file is new"));
        let live = Live::start_with(
            machine,
            speed.parse().expect("a speed"),
            LiveOptions { recording, trace: Some(Watch::default()), ..LiveOptions::default() },
        );
        let window = LiveServer::open(&live, &["127.0.0.1:0"], false, Limits::default()).expect("some port is free");
        Self { live, window, path }
    }

    fn address(&self) -> SocketAddr {
        self.window.addresses()[0]
    }

    fn client(&self) -> S7Client {
        let mut client = S7Client::new();
        client.set_connection_port(self.address().port()).expect("it is not connected yet");
        client.connect_rack_slot("127.0.0.1", 0, 2).expect("the server is there");
        client
    }

    #[track_caller]
    fn wait(&self, what: &str, is_true: impl Fn(&Machine) -> bool) {
        let begin = Instant::now();
        while !self.live.with(|machine| is_true(machine)) {
            assert!(begin.elapsed() < Duration::from_secs(60), "{what} did not come");
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    /// Ends the machine and runs the recording; returns its text.
    #[track_caller]
    fn runs_again(self) -> String {
        let Self { live, window, path } = self;
        drop(window);
        let ended = live.end().expect("no server holds a handle any more");
        let trace = ended.json_lines().expect("it was kept");
        let text = fs::read_to_string(&path).expect("it was written");
        let scenario = Scenario::parse(&text, &path).unwrap_or_else(|problem| panic!("{problem}\n{text}"));
        let finished = scenario.prepare(scenario.profiles[0], &Programs::ready()).expect("it can be run").run();
        assert!(finished.failure.is_none(), "{:?}", finished.failure);
        assert_eq!(finished.session().machine().cycle(), ended.machine.cycle());
        let again = finished.json_lines();
        if let Some((line, (live, again))) =
            trace.lines().zip(again.lines()).enumerate().find(|(_, (live, again))| live != again)
        {
            panic!("line {} is another one:\n{live}\n{again}\n{text}", line + 1);
        }
        assert!(trace == again, "{} bytes, then {}", trace.len(), again.len());
        let written = path.with_extension("jsonl");
        let mut run = Command::new(env!("CARGO_BIN_EXE_opennck"));
        let output = run.arg("run").arg(&path).arg("--trace").arg(&written).output().expect("the program was built");
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(fs::read_to_string(written).expect("it was written") == trace);
        text
    }
}

#[test]
fn an_operator_at_a_panel_is_recorded_and_runs_again() {
    let recorded = Recorded::start("panel", "20", Some("enable_all"));
    let mut client = recorded.client();
    let [x, y] = ["X", "Y"].map(|name| recorded.live.with(|machine| machine.axis(name)).unwrap());
    recorded.wait("the run-up", |machine| machine.memory().from_nck().axes[x].position_controller_active());
    // JOG with machine function REF, then the traversing key plus of the gantry, as in the worked example.
    client.write_bit(S7_AREA_DB, 11, 0, 2, true).unwrap();
    client.write_bit(S7_AREA_DB, 11, 1, 2, true).unwrap();
    client.write_bit(S7_AREA_DB, 31, 4, 7, true).unwrap();
    recorded.wait("the travel", |machine| machine.memory().from_nck().axes[x].traverse_command_plus());
    client.write_bit(S7_AREA_DB, 31, 4, 7, false).unwrap();
    recorded.wait("the references", |machine| machine.memory().from_nck().axes[x].referenced_synchronized_1());
    // A second client writes flags, a REAL of its block and a machine datum, and moves Y.
    let mut other = Bare::connect(recorded.address());
    let panel = (DB, 19);
    let items = [
        Item::bytes((FLAGS, 0), 10, &[1, 2, 3]),
        Item::words((FLAGS, 0), 20, &[0x12, 0x34]),
        Item::real(panel, 4, -12.25),
        Item::offset_of_the_second_axis(0.125),
        Item::bit((DB, 32), 4, 7, true),
    ];
    assert_eq!(other.write(&items), [0xFF; 5]);
    recorded.wait("a millimetre", |machine| machine.variables().axes[y].position.user() > 1.0);
    client.write_bit(S7_AREA_DB, 32, 4, 7, false).unwrap();
    recorded.wait("rest", |machine| machine.memory().from_nck().axes[y].axis_stationary());
    let text = recorded.runs_again();
    for said in [
        "plc = \"enable_all\"",
        "set = { \"X.traversing_key_plus\" = 1 }",
        "client 1, from 127.0.0.1",
        "client 2, from 127.0.0.1",
        "set = { \"MB10\" = 1, \"MB11\" = 2, \"MB12\" = 3, \"MW20\" = 4660, \"DB19.DBD4\" = 3242459136 }", // -12.25 is C1440000
        "machine_data = { \"34090[0,AX2]\" = 0.125 }",
        "set = { \"Y.traversing_key_plus\" = 1 }",
    ] {
        assert!(text.contains(said), "no {said} in\n{text}");
    }
}

#[test]
fn writes_of_one_request_keep_their_order_and_the_nck_takes_its_bits_back() {
    let recorded = Recorded::start("order", "1", None);
    let mut client = Bare::connect(recorded.address());
    let items = [
        Item::bytes((FLAGS, 0), 5, &[0xF0]),
        Item::bit((FLAGS, 0), 5, 0, true),   // in the byte written before
        Item::bytes((FLAGS, 0), 5, &[0x0F]), // again
        Item::bit((FLAGS, 0), 5, 7, true),
        Item::bytes((DB, 31), 100, &[0xFF, 0xFF]), // DB31.DBX101.6 and others are written by the NCK
        Item::bytes((DB, 31), 58, &[1, 2, 3, 4]),  // up to 59 written by the PLC, then by the NCK
        Item::new(0x1D, 1, (0x1D, 0), 7, &[0x25, 0x00]), // T7
        Item::new(0x1C, 1, (0x1C, 0), 3, &[0x01, 0x23]), // C3
    ];
    assert_eq!(client.write(&items), [0xFF; 8]);
    assert_eq!(
        client.job(&[0x29, 0, 0, 0, 0, 0, 9, b'P', b'_', b'P', b'R', b'O', b'G', b'R', b'A', b'M'], &[]),
        [0x29]
    );
    recorded.wait("the stop", Machine::is_plc_stopped);
    client.job(&[0x28, 0, 0, 0, 0, 0, 0, 0xFD, 0, 0, 9, b'P', b'_', b'P', b'R', b'O', b'G', b'R', b'A', b'M'], &[]);
    recorded.wait("the start", |machine| !machine.is_plc_stopped());
    let memory = recorded.live.with(|machine| machine.memory().clone());
    assert_eq!(memory.flags[5], 0x8F);
    let text = recorded.runs_again();
    for said in [
        "set = { \"MB5\" = 240, \"M5.0\" = 1 }",
        "set = { \"MB5\" = 15, \"M5.7\" = 1 }",
        "write = { \"DB31.DBB100\" = 255, \"DB31.DBB101\" = 255 }",
        "\"T7\" = 9472, \"C3\" = 291",
        "plc = \"stop\"",
        "plc = \"run\"",
    ] {
        assert!(text.contains(said), "no {said} in\n{text}");
    }
}

/// Pseudo-random numbers, the same in each run.
struct Chance(u64);

impl Chance {
    fn below(&mut self, end: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        u32::try_from(self.0 >> 33).expect("31 bits") % end
    }

    fn bytes(&mut self, count: u32) -> Vec<u8> {
        (0..count).map(|_| u8::try_from(self.below(256)).expect("a byte")).collect()
    }

    fn item(&mut self) -> Item {
        const AREAS: [((u8, u16), u32); 12] = [
            ((DB, 10), 272),
            ((DB, 11), 64),
            ((DB, 21), 416),
            ((DB, 31), 148),
            ((DB, 32), 148),
            ((DB, 33), 148),
            ((DB, 34), 148),
            ((DB, 2), 256),
            ((DB, 73), 256),
            ((0x81, 0), 128),
            ((0x82, 0), 128),
            ((FLAGS, 0), 256),
        ];
        let (area, length) = AREAS[self.below(12) as usize];
        let byte = self.below(length - 24);
        match self.below(5) {
            0 => Item::bit(area, byte, self.below(8), self.below(2) == 1),
            1 => Item::words(area, byte, &self.bytes(4)),
            2 => Item::doubles(area, byte, &self.bytes(8)),
            3 => Item::offset_of_the_second_axis(f64::from(self.below(1000)) / 7.0),
            _ => {
                let count = 1 + self.below(20);
                Item::bytes(area, byte, &self.bytes(count))
            }
        }
    }
}

#[test]
fn any_writes_are_recorded_and_repeated() {
    for (number, speed, plc) in
        [(1, "1", None), (2, "100", Some("enable_all")), (3, "1000", None), (4, "100", Some("machine_control_panel"))]
    {
        let recorded = Recorded::start(&format!("chance_{number}"), speed, plc);
        let address = recorded.address();
        std::thread::scope(|scope| {
            for client in 1..=2 {
                scope.spawn(move || {
                    let mut chance = Chance(number << 32 | client);
                    let mut client = Bare::connect(address);
                    for _ in 0..40 {
                        let items: Vec<_> = (0..=chance.below(6)).map(|_| chance.item()).collect();
                        let codes = client.write(&items);
                        assert!(codes.iter().all(|code| *code == 0xFF), "{codes:x?}");
                        std::thread::sleep(Duration::from_micros(chance.below(5000).into()));
                    }
                });
            }
        });
        recorded.runs_again();
    }
}

#[test]
fn a_recording_overwrites_no_file_and_begins_before_the_first_step() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("exists.toml");
    fs::write(&path, "mine").unwrap();
    let heading = Heading { title: "No", machine: "g1_example", ..Heading::default() };
    let mut machine = Machine::open("g1_example").unwrap();
    let problem = Recording::begin(&path, &heading, &machine).unwrap_err();
    assert!(problem.what.contains("exists already") && problem.to_string().contains("exists.toml"), "{problem}");
    assert_eq!(fs::read(&path).unwrap(), b"mine");
    machine.step();
    let problem = Recording::begin(&path.with_file_name("late.toml"), &heading, &machine).unwrap_err();
    assert!(problem.what.contains("has not run yet"), "{problem}");
}

#[test]
fn the_file_is_a_scenario_at_any_moment() {
    let recorded = Recorded::start("any_moment", "1", None);
    let mut client = recorded.client();
    let begin = Instant::now();
    let mut longest = 0;
    while begin.elapsed() < Duration::from_millis(2500) {
        client.write_area(S7_AREA_MK, 0, 0, S7_WL_BYTE, &[1, 2]).unwrap();
        let read = || fs::read_to_string(&recorded.path).unwrap();
        let mut text = read();
        if Scenario::parse(&text, &recorded.path).is_err() {
            // A reader during the write may see an incomplete step, for a moment once per second.
            std::thread::sleep(Duration::from_millis(100));
            text = read();
        }
        let scenario = Scenario::parse(&text, &recorded.path).unwrap();
        scenario.prepare(scenario.profiles[0], &Programs::ready()).unwrap();
        longest = longest.max(text.len());
    }
    assert!(longest > 1000, "it was not written meanwhile: {longest} bytes");
    recorded.runs_again();
}

/// A PLC program that checks whether the writes of clients are complete.
struct Witness {
    torn: Arc<AtomicU64>,
    scans: Arc<AtomicU64>,
}

impl PlcProgram for Witness {
    fn name(&self) -> &'static str {
        "witness"
    }

    fn startup(&mut self, _: &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault> {
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        Vec::new()
    }

    fn restore(&mut self, _: &[u8]) -> Result<(), Problem> {
        Ok(())
    }

    fn fork(&self) -> Option<Box<dyn PlcProgram>> {
        None
    }

    fn reset(&mut self) {}

    fn scan(&mut self, io: &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault> {
        let block = io.blocks.get(2).map_or(&[][..], |bytes| bytes);
        let is_whole = block[..200].iter().chain(&io.flags[..100]).all(|byte| *byte == block[0]);
        self.torn.fetch_add(u64::from(!is_whole), Ordering::Relaxed);
        self.scans.fetch_add(1, Ordering::Relaxed);
        Ok(())
    }
}

#[test]
fn two_writers_at_speed_1000_and_no_request_is_torn() {
    let (torn, scans) = (Arc::new(AtomicU64::new(0)), Arc::new(AtomicU64::new(0)));
    let mut machine = Machine::open("g1_example").unwrap();
    machine.load_program(Box::new(Witness { torn: Arc::clone(&torn), scans: Arc::clone(&scans) }));
    let live = Live::start(machine, "1000".parse().unwrap());
    let window = LiveServer::open(&live, &["127.0.0.1:0"], false, Limits::default()).unwrap();
    let address = window.addresses()[0];
    let block = |value: u8| Item::bytes((DB, 2), 0, &[value; 200]);
    let flags = |value: u8| Item::words((FLAGS, 0), 0, &[value; 100]);
    std::thread::scope(|scope| {
        for writer in 0..2_u8 {
            scope.spawn(move || {
                let mut client = Bare::connect(address);
                for round in 0..250_u8 {
                    let value = round.wrapping_mul(2) + writer;
                    assert_eq!(client.write(&[block(value), flags(value)]), [0xFF; 2]);
                }
            });
        }
        scope.spawn(move || {
            let mut client = Bare::connect(address);
            let read = [&[4, 2], block(0).any.as_slice(), flags(0).any.as_slice()].concat();
            for _ in 0..500 {
                let answer = client.job(&read, &[]);
                // After function and count: 4 bytes, 200 of the block, 4 bytes, 100 flags.
                let (block, flags) = (&answer[6..206], &answer[210..310]);
                assert!(block.iter().chain(flags).all(|byte| *byte == block[0]), "half a request: {answer:x?}");
            }
        });
    });
    assert_eq!(torn.load(Ordering::Relaxed), 0);
    assert!(scans.load(Ordering::Relaxed) >= 250, "each write was a step of its own");
}

/// 40 writes of 200 bytes at once are 8,000 bytes, and a step takes 4,096: some take effect one cycle later, also when the recording is
/// run.
#[test]
fn writes_beyond_the_limit_of_one_step_take_effect_in_order_and_are_repeated() {
    const BYTES: u8 = 200;
    let recorded = Recorded::start("too_much_for_one_edge", "1", None);
    let mut stream = TcpStream::connect(recorded.address()).expect("the server is there");
    // DB19 from byte 0, each time with another value in all bytes: 17 + 14 bytes, and 4 before the values.
    let write = |value: u8| {
        let head = [3, 0, 0, 35 + BYTES, 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, value, 0, 14, 0, 4 + BYTES];
        let [high, low] = (8 * u16::from(BYTES)).to_be_bytes();
        let item = [5, 1, 0x12, 10, 0x10, 2, 0, BYTES, 0, 19, 0x84, 0, 0, 0, 0, 4, high, low];
        [&head[..], &item, &vec![value; BYTES.into()]].concat()
    };
    let connect = [3, 0, 0, 22, 17, 0xE0, 0, 0, 0, 1, 0, 0xC0, 1, 10, 0xC1, 2, 1, 0, 0xC2, 2, 1, 2];
    let setup = [3, 0, 0, 25, 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, 1, 0, 8, 0, 0, 0xF0, 0, 0, 1, 0, 1, 1, 0xE0];
    let writes: Vec<u8> = (1..=40).flat_map(write).collect();
    stream.write_all(&[&connect[..], &setup, &writes].concat()).expect("it takes them");
    let mut answers = vec![0; 22 + 27 + 40 * 22];
    stream.read_exact(&mut answers).expect("all are answered");
    assert!(answers[49..].chunks(22).zip(1..).all(|(answer, value)| answer[12] == value && answer[21] == 0xFF));
    assert!(
        recorded.live.with(|machine| machine.memory().blocks.get(19).unwrap()[..200].iter().all(|byte| *byte == 40))
    );
    recorded.runs_again();
}
