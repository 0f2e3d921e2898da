//! What clients do to a live machine, recorded, is a scenario with the same trace, byte for byte.
#![cfg(all(feature = "cli", feature = "s7"))]
#![expect(clippy::disallowed_methods, reason = "a live machine is watched in real time")]

use std::fs;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use opennck::cli::serve::{Keeping, Limits, Live, Recording, Window};
use opennck::machine::Machine;
use opennck::plc::Programs;
use opennck::scenario::{Heading, Scenario};
use opennck::trace::Watch;
use rust7::{S7_AREA_DB, S7_AREA_MK, S7_WL_BYTE, S7Client};

/// A live machine that is recorded, with its clients.
struct Recorded {
    live: Live,
    window: Window,
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
        let live = Live::start_with(machine, speed.parse().expect("a speed"), Keeping { recording, trace: true });
        let window = Window::open(&live, &["127.0.0.1:0"], false, Limits::default()).expect("some port is free");
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

    /// Ends it and runs the recording; gives its text.
    #[track_caller]
    fn runs_again(self) -> String {
        let Self { live, window, path } = self;
        drop(window);
        let ended = live.end().expect("nobody looks at it any more");
        let trace = ended.trace.expect("it was kept").json_lines(&ended.machine, &Watch::default());
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

/// A client that sends any bytes.
struct Bare(TcpStream);

impl Bare {
    fn connect(address: SocketAddr) -> Self {
        let mut bare = Self(TcpStream::connect(address).expect("the server is there"));
        bare.0.set_read_timeout(Some(Duration::from_secs(10))).expect("it is a time");
        bare.exchange(&[3, 0, 0, 22, 17, 0xE0, 0, 0, 0, 1, 0, 0xC0, 1, 10, 0xC1, 2, 1, 0, 0xC2, 2, 1, 2]);
        bare.job(&[0xF0, 0, 0, 1, 0, 1, 3, 0xC0], &[]); // a PDU of 960 bytes
        bare
    }

    fn exchange(&mut self, packet: &[u8]) -> Vec<u8> {
        self.0.write_all(packet).expect("it is connected");
        let mut head = [0; 4];
        self.0.read_exact(&mut head).expect("a packet comes");
        let mut answer = vec![0; usize::from(u16::from_be_bytes([head[2], head[3]])) - 4];
        self.0.read_exact(&mut answer).expect("its rest comes");
        answer
    }

    /// One job; gives parameter and data of its answer.
    fn job(&mut self, parameter: &[u8], data: &[u8]) -> Vec<u8> {
        let length = |length: usize| u16::try_from(length).expect("it is short").to_be_bytes();
        let mut packet = vec![3, 0];
        packet.extend(length(17 + parameter.len() + data.len()));
        packet.extend([2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, 7]);
        packet.extend(length(parameter.len()));
        packet.extend(length(data.len()));
        packet.extend(parameter);
        packet.extend(data);
        let answer = self.exchange(&packet);
        assert_eq!(answer[13..15], [0, 0], "the job was refused: {answer:x?}");
        answer[15..].to_vec()
    }

    /// One request to write; gives the code of each item.
    fn write(&mut self, items: &[Item]) -> Vec<u8> {
        let mut parameter = vec![5, u8::try_from(items.len()).expect("few")];
        let mut data = Vec::new();
        for item in items {
            if data.len() % 2 == 1 {
                data.push(0);
            }
            parameter.extend(&item.any);
            data.extend(&item.value);
        }
        self.job(&parameter, &data)[2..].to_vec()
    }
}

/// An item of a request to write, and its value.
struct Item {
    any: Vec<u8>,
    value: Vec<u8>,
}

const DB: u8 = 0x84;
const FLAGS: u8 = 0x83;

impl Item {
    /// Elements of a type from a bit of an area on.
    fn new(kind: u8, count: usize, (area, block): (u8, u16), bit: u32, bytes: &[u8]) -> Self {
        let mut any = vec![0x12, 10, 0x10, kind];
        any.extend(u16::try_from(count).expect("few").to_be_bytes());
        any.extend(block.to_be_bytes());
        any.push(area);
        any.extend(&bit.to_be_bytes()[1..]);
        let (size, length) = if kind == 1 { (3, 1) } else { (4, bytes.len() * 8) };
        let mut value = vec![0, size];
        value.extend(u16::try_from(length).expect("few").to_be_bytes());
        value.extend(bytes);
        Self { any, value }
    }

    fn bit(area: (u8, u16), byte: u32, bit: u32, value: bool) -> Self {
        Self::new(1, 1, area, byte * 8 + bit, &[u8::from(value)])
    }

    fn bytes(area: (u8, u16), byte: u32, bytes: &[u8]) -> Self {
        Self::new(2, bytes.len(), area, byte * 8, bytes)
    }

    fn words(area: (u8, u16), byte: u32, bytes: &[u8]) -> Self {
        Self::new(4, bytes.len() / 2, area, byte * 8, bytes)
    }

    fn doubles(area: (u8, u16), byte: u32, bytes: &[u8]) -> Self {
        Self::new(6, bytes.len() / 4, area, byte * 8, bytes)
    }

    /// A REAL.
    fn real(area: (u8, u16), byte: u32, value: f32) -> Self {
        Self::new(8, 1, area, byte * 8, &value.to_be_bytes())
    }

    /// MD34090 of the second axis.
    fn offset_of_the_second_axis(value: f64) -> Self {
        let any = vec![0x12, 8, 0x82, 0x62, 0x85, 0x2A, 0, 1, 0x1A, 1];
        let value = [&[0, 9, 0, 8], value.to_le_bytes().as_slice()].concat();
        Self { any, value }
    }
}

#[test]
fn an_operator_at_a_panel_is_recorded_and_runs_again() {
    let recorded = Recorded::start("panel", "20", Some("enable_all"));
    let mut client = recorded.client();
    let [x, y] = ["X", "Y"].map(|name| recorded.live.with(|machine| machine.axis(name)).unwrap());
    recorded.wait("the run-up", |machine| machine.memory().from_nck.axes[x].position_controller_active());
    // JOG with machine function REF, then the traversing key plus of the gantry, as in the worked example.
    client.write_bit(S7_AREA_DB, 11, 0, 2, true).unwrap();
    client.write_bit(S7_AREA_DB, 11, 1, 2, true).unwrap();
    client.write_bit(S7_AREA_DB, 31, 4, 7, true).unwrap();
    recorded.wait("the travel", |machine| machine.memory().from_nck.axes[x].traverse_command_plus());
    client.write_bit(S7_AREA_DB, 31, 4, 7, false).unwrap();
    recorded.wait("the references", |machine| machine.memory().from_nck.axes[x].referenced_synchronized_1());
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
    recorded.wait("rest", |machine| machine.memory().from_nck.axes[y].axis_stationary());
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
        Item::bit((FLAGS, 0), 5, 0, true),   // in the byte before
        Item::bytes((FLAGS, 0), 5, &[0x0F]), // once more
        Item::bit((FLAGS, 0), 5, 7, true),
        Item::bytes((DB, 31), 100, &[0xFF, 0xFF]), // DB31.DBX101.6 and others are the NCK's
        Item::bytes((DB, 31), 58, &[1, 2, 3, 4]),  // the PLC's up to 59, then the NCK's
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

/// Numbers that look like chance and are the same each time.
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
fn whatever_is_written_runs_again() {
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
fn a_recording_replaces_nothing_and_begins_before_the_first_step() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("exists.toml");
    fs::write(&path, "mine").unwrap();
    let heading = Heading { title: "No", machine: "g1_example", ..Heading::default() };
    let mut machine = Machine::open("g1_example").unwrap();
    let problem = Recording::begin(&path, &heading, &machine).unwrap_err();
    assert!(problem.what.contains("one that exists") && problem.to_string().contains("exists.toml"), "{problem}");
    assert_eq!(fs::read(&path).unwrap(), b"mine");
    machine.step();
    let problem = Recording::begin(&path.with_file_name("late.toml"), &heading, &machine).unwrap_err();
    assert!(problem.what.contains("just switched on"), "{problem}");
}

#[test]
fn the_file_is_a_scenario_at_any_moment() {
    let recorded = Recorded::start("any_moment", "1", None);
    let mut client = recorded.client();
    let begin = Instant::now();
    let mut longest = 0;
    while begin.elapsed() < Duration::from_millis(2500) {
        client.write_area(S7_AREA_MK, 0, 0, S7_WL_BYTE, &[1, 2]).unwrap();
        let text = fs::read_to_string(&recorded.path).unwrap();
        let scenario = Scenario::parse(&text, &recorded.path).unwrap();
        scenario.prepare(scenario.profiles[0], &Programs::ready()).unwrap();
        longest = longest.max(text.len());
    }
    assert!(longest > 1000, "it was not written meanwhile: {longest} bytes");
    recorded.runs_again();
}
