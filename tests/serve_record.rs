//! What clients and a scenario do to a live machine, recorded, is a scenario with the same trace, byte for byte; and what one request
//! reads or writes is whole, at any speed.
#![cfg(all(feature = "cli", feature = "s7"))]
#![expect(clippy::disallowed_methods, reason = "a live machine is watched in real time")]

use std::fs;
use std::io::{BufRead, BufReader, Lines, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, Command, Output, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use opennck::cli::serve::{Limits, Live, LiveOptions, Recording, Window};
use opennck::machine::Machine;
use opennck::plc::{PlcFault, PlcIo, PlcProgram, Programs};
use opennck::scenario::{Heading, Scenario};
use opennck::source::Problem;
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
        let live = Live::start_with(
            machine,
            speed.parse().expect("a speed"),
            LiveOptions { recording, trace: Some(Watch::default()), ..LiveOptions::default() },
        );
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

/// A client that sends any bytes.
struct Bare(TcpStream);

impl Bare {
    fn connect(address: SocketAddr) -> Self {
        let mut bare = Self(TcpStream::connect(address).expect("the server is there"));
        bare.0.set_read_timeout(Some(Duration::from_secs(10))).expect("it is a time");
        bare.exchange(&[3, 0, 0, 22, 17, 0xE0, 0, 0, 0, 1, 0, 0xC0, 1, 10, 0xC1, 2, 1, 0, 0xC2, 2, 1, 4]); // slot 4, the NCK's
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
        let read = || fs::read_to_string(&recorded.path).unwrap();
        let mut text = read();
        if Scenario::parse(&text, &recorded.path).is_err() {
            // Whoever reads while it is written may meet half a step; once a second that is so for a moment.
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

/// `opennck serve` on any free port.
struct Program {
    child: Child,
    log: Lines<BufReader<ChildStderr>>,
    port: u16,
}

impl Program {
    /// Starts it in a folder of its own, which is empty before.
    fn start(folder: &Path, arguments: &[&str]) -> Self {
        let mut program = Command::new(env!("CARGO_BIN_EXE_opennck"));
        program.arg("serve").args(arguments).current_dir(folder);
        Self::started(program)
    }

    fn started(mut program: Command) -> Self {
        program.args(["--s7", "127.0.0.1:0"]).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = program.spawn().expect("the program was built");
        let mut head = BufReader::new(child.stdout.take().expect("it is piped")).lines();
        let port = head.find_map(|line| line.ok()?.split_once("S7 on 127.0.0.1:")?.1.split(':').next()?.parse().ok());
        // Its output has no reader from here on.
        let log = BufReader::new(child.stderr.take().expect("it is piped")).lines();
        Self { child, log, port: port.expect("it says its port") }
    }

    fn address(&self) -> SocketAddr {
        SocketAddr::from(([127, 0, 0, 1], self.port))
    }

    /// Waits for a line of its log.
    #[track_caller]
    fn says(&mut self, what: &str) -> String {
        let line = self.log.find(|line| line.as_ref().is_ok_and(|line| line.contains(what)));
        line.unwrap_or_else(|| panic!("it did not say: {what}")).expect("text")
    }

    fn end(&mut self, signal: &str) -> Option<i32> {
        let id = self.child.id().to_string();
        assert!(Command::new("kill").args([signal, &id]).status().expect("there is a kill").success());
        self.child.wait().expect("it ends").code()
    }
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("there is space");
    folder
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_opennck")).args(arguments).current_dir(folder).output().expect("it was built")
}

fn project(path: &str) -> String {
    format!("{}/{path}", env!("CARGO_MANIFEST_DIR"))
}

#[test]
#[cfg(unix)]
fn a_scenario_acts_in_real_time_as_it_runs_and_is_recorded() {
    let folder = folder("acts");
    let scenario = project("golden/worked_example/gantry_references_and_synchronises.toml");
    let arguments = ["--scenario", &scenario, "--speed", "50", "--record", "again.toml", "--trace", "live.jsonl"];
    let mut program = Program::start(&folder, &arguments);
    let mut client = Bare::connect(program.address());
    program.says("the scenario is over, all of it held");
    // It is still served, and what clients write then is recorded, too.
    assert_eq!(client.write(&[Item::bytes((FLAGS, 0), 77, &[7])]), [0xFF]);
    assert_eq!(program.end("-TERM"), Some(0));
    let live = fs::read_to_string(folder.join("live.jsonl")).unwrap();
    let recording = fs::read_to_string(folder.join("again.toml")).unwrap();
    for said in ["# 0.002 s: the scenario", "note = \"JOG with machine function REF\"", "MB77", "plc = \"enable_all\""]
    {
        assert!(recording.contains(said), "no {said} in\n{recording}");
    }
    for (scenario, trace) in [(scenario.as_str(), "run.jsonl"), ("again.toml", "again.jsonl")] {
        let output = run(&folder, &["run", scenario, "--trace", trace]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    }
    assert!(live == fs::read_to_string(folder.join("again.jsonl")).unwrap());
    // As fast as it can is the same as in real time, up to its end.
    let alone = fs::read_to_string(folder.join("run.jsonl")).unwrap();
    assert!(live.starts_with(&alone), "{} bytes, then {}", alone.len(), live.len());
}

#[test]
#[cfg(unix)]
fn a_scenario_brings_its_plant_profile_and_image_into_the_recording() {
    let folder = folder("brings");
    let scenario = "machine = \"g1_example\"\nplc_image = \"image.toml\"\nprofile = \"828d\"\nwatch = [\"Y.slide\", \"Y.*\"]\n\
        [plant.Y]\nstart = 12.5\n[[step]]\nset = { MW90 = 5 }\n[[step]]\nrun = \"1s\"\n\
        [[step]]\nexpect = \"Y.position > 1000\"\n[[step]]\nset = { \"M0.0\" = 1 }\n";
    fs::write(folder.join("mine.toml"), scenario).unwrap();
    fs::copy(project("plc_images/recipes.toml"), folder.join("image.toml")).unwrap();
    let arguments = ["--scenario", "mine.toml", "--speed", "20", "--record", "again.toml", "--trace", "live.jsonl"];
    let mut program = Program::start(&folder, &arguments);
    // The step that fails ends it, and is said; serving goes on.
    let line = program.says("the scenario failed");
    assert!(line.contains("mine.toml:12") && line.contains("Y.position > 1000"), "{line}");
    drop(Bare::connect(program.address()));
    assert_eq!(program.end("-INT"), Some(0));
    let output = run(&folder, &["run", "again.toml", "--trace", "again.jsonl"]);
    let recording = fs::read_to_string(folder.join("again.toml")).unwrap();
    assert_eq!(output.status.code(), Some(0), "{}{recording}", String::from_utf8_lossy(&output.stderr));
    let live = fs::read_to_string(folder.join("live.jsonl")).unwrap();
    assert!(live.contains("\"symbol\":\"Y.slide\",\"value\":12.5"), "{live}");
    assert!(live == fs::read_to_string(folder.join("again.jsonl")).unwrap(), "{recording}");
    for said in ["profile = \"828d\"", "plc_image = \"image.toml\"", "plant = { \"Y\" = { \"start\" = 12.5 } }"] {
        assert!(recording.contains(said), "no {said} in\n{recording}");
    }
    assert!(!recording.contains("M0.0"), "what stands behind a failed step is not done:\n{recording}");
}

#[test]
#[cfg(unix)]
fn an_end_without_warning_loses_a_second_at_most() {
    let folder = folder("killed");
    let mut program = Program::start(&folder, &["g1_example", "--record", "killed.toml"]);
    let mut client = Bare::connect(program.address());
    assert_eq!(client.write(&[Item::bytes((FLAGS, 0), 1, &[11])]), [0xFF]);
    let text = || fs::read_to_string(folder.join("killed.toml")).unwrap();
    let cycles = |text: &str| -> u64 {
        let run = |line: &str| line.strip_prefix("run = \"")?.strip_suffix("cycles\"")?.parse::<u64>().ok();
        text.lines().filter_map(run).sum()
    };
    // It is brought to the disk again and again, not only at the end.
    let begin = Instant::now();
    while cycles(&text()) < 700 {
        assert!(begin.elapsed() < Duration::from_secs(30), "{}", text());
        std::thread::sleep(Duration::from_millis(50));
    }
    program.end("-KILL");
    let text = text();
    assert!(text.contains("\"MB1\" = 11"), "{text}");
    assert_eq!(run(&folder, &["run", "killed.toml"]).status.code(), Some(0));
}

#[test]
#[cfg(unix)]
fn a_full_disk_ends_the_recording_and_not_the_machine() {
    let folder = folder("full");
    let mut shell = Command::new("sh");
    // A file may have 4096 bytes, and who writes more is told so.
    let line = "trap '' XFSZ; ulimit -f 8; exec \"$0\" serve g1_example --record full.toml \"$@\"";
    shell.args(["-c", line, env!("CARGO_BIN_EXE_opennck")]).current_dir(&folder);
    let mut program = Program::started(shell);
    let mut client = Bare::connect(program.address());
    for round in 0..200 {
        assert_eq!(client.write(&[Item::bytes((FLAGS, 0), 1, &[round, 2, 3, 4, 5, 6, 7, 8])]), [0xFF]);
    }
    let line = program.says("the recording ends");
    assert!(line.contains("full.toml cannot be written"), "{line}");
    assert_eq!(client.write(&[Item::bytes((FLAGS, 0), 1, &[9])]), [0xFF]);
    assert_eq!(program.end("-TERM"), Some(0));
    let text = fs::read_to_string(folder.join("full.toml")).unwrap();
    assert!(text.len() <= 4096 && Scenario::parse(&text, Path::new("full.toml")).is_ok(), "{text}");
}

#[test]
fn the_doors_of_a_recording_say_what_is_wrong() {
    let folder = folder("doors");
    fs::write(folder.join("old.toml"), "mine").unwrap();
    fs::write(folder.join("wrong.toml"), "machine = \"g1_example\"\n[[step]]\nsett = { \"M0.0\" = 1 }\n").unwrap();
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let taken = taken.local_addr().unwrap().to_string();
    for (arguments, said) in [
        (vec!["g1_example", "--record", "old.toml"], ["old.toml: expected a new file", "replaces nothing"]),
        (vec!["g1_example", "--record", "none/new.toml"], ["none/new.toml", "check the path"]),
        (vec!["g1_example", "--record", "new.toml", "--s7", &taken], ["one in use", "--s7"]),
        (vec!["--scenario", "wrong.toml"], ["wrong.toml:3", "`sett`"]),
        (vec!["--scenario", "none.toml"], ["none.toml", "cannot be read"]),
        (vec![], ["<MACHINE>", "required"]),
        (vec!["g1_example", "--record", "new.toml", "--image", "new.image"], ["--record", "--image"]),
    ] {
        let output = run(&folder, &[&["serve"], arguments.as_slice()].concat());
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
        assert!(said.iter().all(|said| error.contains(said)), "{arguments:?}: {error}");
    }
    assert_eq!(fs::read(folder.join("old.toml")).unwrap(), b"mine");
    assert!(!folder.join("new.toml").exists(), "it is in the way of the next try");
}

/// The commands of the README, as they stand there.
#[test]
#[cfg(unix)]
fn the_session_of_the_readme_is_recorded_and_runs_again() {
    let folder = folder("readme");
    let readme = fs::read_to_string(project("README.md")).unwrap();
    let block = readme.split("```sh\n").find(|block| block.contains("--record")).unwrap().split("```").next().unwrap();
    let mut lines = block.lines().map(|line| line.split_whitespace().skip(1).collect::<Vec<_>>());
    let (serve, again) = (lines.next().unwrap(), lines.next().unwrap());
    let mut program = Program::start(&folder, &serve[1..]);
    let mut client = Bare::connect(program.address());
    assert_eq!(client.write(&[Item::bit((DB, 32), 4, 7, true)]), [0xFF]);
    assert_eq!(program.end("-INT"), Some(0));
    let output = run(&folder, &again);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(String::from_utf8_lossy(&output.stdout).contains("Y.traversing_key_plus"));
}

/// A PLC program that looks whether what clients wrote is whole.
struct Witness {
    torn: Arc<AtomicU64>,
    scans: Arc<AtomicU64>,
}

impl PlcProgram for Witness {
    fn name(&self) -> &'static str {
        "witness"
    }

    fn startup(&mut self, _: &mut PlcIo<'_>) -> Result<(), PlcFault> {
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

    fn scan(&mut self, io: &mut PlcIo<'_>) -> Result<(), PlcFault> {
        let block = io.blocks.get(2).map_or(&[][..], |bytes| bytes);
        let is_whole = block[..200].iter().chain(&io.flags[..100]).all(|byte| *byte == block[0]);
        self.torn.fetch_add(u64::from(!is_whole), Ordering::Relaxed);
        self.scans.fetch_add(1, Ordering::Relaxed);
        Ok(())
    }
}

#[test]
fn two_writers_at_speed_1000_and_nobody_ever_sees_half_a_request() {
    let (torn, scans) = (Arc::new(AtomicU64::new(0)), Arc::new(AtomicU64::new(0)));
    let mut machine = Machine::open("g1_example").unwrap();
    machine.load_program(Box::new(Witness { torn: Arc::clone(&torn), scans: Arc::clone(&scans) }));
    let live = Live::start(machine, "1000".parse().unwrap());
    let window = Window::open(&live, &["127.0.0.1:0"], false, Limits::default()).unwrap();
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
                // Behind function and count: 4 bytes, 200 of the block, 4 bytes, 100 flags.
                let (block, flags) = (&answer[6..206], &answer[210..310]);
                assert!(block.iter().chain(flags).all(|byte| *byte == block[0]), "half a request: {answer:x?}");
            }
        });
    });
    assert_eq!(torn.load(Ordering::Relaxed), 0);
    assert!(scans.load(Ordering::Relaxed) >= 250, "each write was a step of its own");
}

/// A step takes two seconds then, and a thousandth of that: who asks is answered, and it ends at once.
#[test]
#[cfg(unix)]
fn the_slowest_and_the_fastest_machine_answer_and_end() {
    for speed in ["0.001", "1000"] {
        let folder = folder("speeds");
        let mut program = Program::start(&folder, &["g1_example", "--speed", speed, "--record", "speed.toml"]);
        let mut client = Bare::connect(program.address());
        assert_eq!(client.write(&[Item::bytes((FLAGS, 0), 1, &[1])]), [0xFF]);
        let begin = Instant::now();
        assert_eq!(program.end("-TERM"), Some(0));
        assert!(begin.elapsed() < Duration::from_secs(10));
        assert_eq!(run(&folder, &["run", "speed.toml"]).status.code(), Some(0));
    }
}
