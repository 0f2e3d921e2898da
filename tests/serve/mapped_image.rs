//! A PLC in another process with the mapped image: the same signals as a built-in program, no torn data, alarm 2000 when it is silent.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![expect(clippy::disallowed_methods, reason = "another process works in real time")]

use std::fs;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use opennck::image::mapped::{Look, MappedImage, PlcImage, Rules, State, Step};
use opennck::image::{Area, Memory, Names, SINUMERIK};
use opennck::live::{Exchange, Keeper, Live, LiveOptions, MappedPlc, Speed};
use opennck::machine::{self, Machine};
use opennck::plc::{PlcProgram, gantry_start};
use opennck::scenario::{Failure, Session};
use opennck::units::Time;
use opennck::variables::AlarmNumber;
use rust7::{S7_AREA_DB, S7_AREA_MK, S7_WL_BYTE, S7Client};

use crate::processes::EndsWithTest;

/// Longer than a computer is ever suspended during a test.
const LONG: Duration = Duration::from_secs(60);

/// A separate file for one test.
struct File(PathBuf);

impl File {
    fn new(name: &str) -> Self {
        Self::called(&format!("{name}.image"))
    }

    fn called(name: &str) -> Self {
        let file = Self(std::env::temp_dir().join(format!("opennck-{}-{name}", std::process::id())));
        let _ = fs::remove_file(&file.0);
        file
    }

    fn text(&self) -> &str {
        self.0.to_str().expect("the names of temporary folders are text")
    }
}

impl Drop for File {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}

/// Python with the module of the example; `None`, with a message, if it is not installed.
fn python() -> Option<Command> {
    if Command::new("python3").arg("--version").output().is_err() {
        eprintln!("NOT TESTED: there is no python3 here, so no PLC in Python has run");
        return None;
    }
    let mut command = Command::new("python3");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/python_plc");
    command.env("PYTHONPATH", &folder).env("PYTHONDONTWRITEBYTECODE", "1").current_dir(folder);
    Some(command)
}

/// A soft PLC on the other side of a file: it scans until the NC has ended or `scan` returns false.
fn soft_plc(path: &Path, mut scan: impl FnMut(&mut PlcImage) -> bool + Send + 'static) -> JoinHandle<()> {
    let mut plc = PlcImage::open(path).expect("the NC has created it");
    std::thread::spawn(move || {
        while plc.state() != State::Ended {
            if plc.state() == State::Stop || plc.next_step().is_none() {
                std::thread::sleep(Duration::from_micros(50));
                continue;
            }
            if !scan(&mut plc) {
                return;
            }
            plc.answer();
        }
    })
}

/// Sets or resets a bit of an axis' data block.
fn set(plc: &mut PlcImage, db: u16, byte: u32, bit: u8, value: bool) {
    let offset = plc.offset(Area::DataBlock(db), byte).expect("axes have 148 bytes");
    let byte = &mut plc.image_mut()[offset];
    *byte = *byte & !(1 << bit) | u8::from(value) << bit;
}

/// The behaviour of the built-in program `gantry_start` while REF is active from the beginning, by addresses.
fn start_gantry(plc: &mut PlcImage) -> bool {
    let is_ref = plc.offset(Area::DataBlock(11), 7).is_some_and(|offset| plc.image()[offset] & 0x04 != 0);
    for db in 31..=33 {
        set(plc, db, 1, 5, true);
        set(plc, db, 2, 1, true);
        set(plc, db, 21, 7, true);
        let ready = plc.offset(Area::DataBlock(db), 101).is_some_and(|offset| plc.image()[offset] & 0x10 != 0);
        set(plc, db, 29, 4, ready && is_ref);
    }
    true
}

fn synchronise(program: Box<dyn PlcProgram>) -> Result<String, Failure> {
    let mut gantry = Session::open("g1_example")?.with_program(program);
    gantry.watch(&["X.*", "XF.*"])?;
    gantry.set("DB11.DBX1.2", 1)?;
    gantry.pulse("X.traversing_key_plus")?;
    gantry.wait("X.gantry_grouping_is_synchronized", "60s")?;
    Ok(gantry.text())
}

#[test]
fn in_lock_step_the_trace_is_that_of_the_same_program_built_in() -> Result<(), Failure> {
    let file = File::new("same");
    let machine = Machine::open("g1_example")?;
    let mut mapped = MappedPlc::create(&file.0, &machine, Exchange { lock_step: true, time_out: LONG })?;
    // It starts before the first scan, so that it sees every scan.
    let path = file.0.clone();
    let plc = std::thread::spawn(move || soft_plc(&path, start_gantry).join());
    mapped.wait_for_plc(LONG)?;
    let there = synchronise(Box::new(mapped))?;
    plc.join().unwrap().unwrap();
    assert!(there.contains("DB31.DBX101.5     0 -> 1"), "{there}");
    assert_eq!(there, synchronise(gantry_start().boxed())?);
    Ok(())
}

/// Publishes steps as fast as possible, each with one byte value in all user blocks, until this many answers have arrived. The other side
/// inverts every bit. No answer may be torn.
fn hammer(file: &File, answers: u64, start: impl FnOnce()) {
    let mut memory = Memory::new();
    let rules = Rules { lock_step: false, time_out: Time::ZERO };
    let mut nc = MappedImage::create(&file.0, &memory, &Names::default(), rules).unwrap();
    nc.state(State::Run);
    start();
    let (begin, mut taken, mut cycle) = (Instant::now(), 0, 0_u64);
    while taken < answers {
        assert!(begin.elapsed() < LONG, "{taken} answers to {cycle} steps");
        cycle += 1;
        for db in SINUMERIK.tables().standard_blocks.iter().copied() {
            memory.blocks.get_mut(db).unwrap().fill(u8::try_from(cycle % 251).unwrap());
        }
        nc.publish(&memory, Step { cycle, time: Time::ZERO, since_last: Time::ZERO }, false);
        if let Look::Answer(number) = nc.look(0) {
            let mut answered = memory.clone();
            nc.take(&mut answered);
            let bytes: Vec<u8> = answered.blocks.iter().flat_map(|block| block.bytes.to_vec()).collect();
            assert!(bytes.iter().all(|byte| *byte == bytes[0]), "a torn answer");
            // The first step, published when the file was created, has the value 0; the others have their cycle.
            assert_eq!(bytes[0], !u8::try_from((number - 1) % 251).unwrap(), "every bit of step {number} is another");
            taken += 1;
        }
    }
}

#[test]
fn no_step_and_no_answer_is_torn() {
    let file = File::new("torn");
    let mut plc = None;
    hammer(&file, 5000, || {
        plc = Some(soft_plc(&file.0, |plc| {
            let start = |plc: &PlcImage, db| plc.offset(Area::DataBlock(db), 0).unwrap();
            let value = plc.image()[start(plc, 2)];
            for db in SINUMERIK.tables().standard_blocks.iter().copied() {
                let start = start(plc, db);
                let block = &mut plc.image_mut()[start..start + Memory::STANDARD_LENGTH];
                assert!(block.iter().all(|byte| *byte == value), "a torn step");
                block.fill(!value);
            }
            true
        }));
    });
    plc.unwrap().join().expect("it saw no torn step");
}

#[test]
fn a_process_in_python_never_sees_half_a_step_and_none_of_its_answers_is_half() {
    const SCRIPT: &str = "
import sys
from opennck_image import Image
blocks = (2, 4, 5, 7, 18, 19, 20, 71, 72, 73)
with Image(sys.argv[1]) as image:
    places = [image.find(f'DB{db}.DBB0')[0] for db in blocks]
    while image.is_served():
        image._answered = None  # as fast as it can, also where its last answer was not taken yet
        step = image.newest()
        if step is not None:
            value = step.image[places[0]]
            for place in places:
                assert step.image[place : place + 256] == bytes([value]) * 256, 'half a step'
                step.image[place : place + 256] = bytes([value ^ 0xFF]) * 256
            image.answer(step)
";
    let Some(mut python) = python() else { return };
    let file = File::new("hammer");
    let mut other = None;
    hammer(&file, 500, || other = Some(python.args(["-c", SCRIPT, file.text()]).spawn().unwrap()));
    assert!(other.unwrap().wait().unwrap().success(), "it saw a torn step");
}

#[test]
fn a_process_in_python_waits_until_the_header_is_whole_and_says_what_is_missing() {
    const SCRIPT: &str = "
import sys
from opennck_image import Image
for line in sys.stdin:
    try:
        with Image(sys.argv[1], wait=float(line)) as image:
            print(image.find('DB31.DBX101.4'), flush=True)
    except TimeoutError as error:
        print(error, flush=True)
";
    let Some(mut python) = python() else { return };
    let file = File::new("half");
    let rules = Rules { lock_step: false, time_out: Time::ZERO };
    let nc = MappedImage::create(&file.0, &Memory::new(), &Names::default(), rules).unwrap();
    let whole = fs::read(&file.0).unwrap();
    let wanted = PlcImage::open(&file.0).unwrap().offset(Area::DataBlock(31), 101).unwrap();
    let python = python.args(["-c", SCRIPT, file.text()]).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut child = python.spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    // A section table that ends after its third entry, one with writer 9, one of a larger image; invalid sizes.
    for (place, content, said) in [
        (4096 + 3 * 80, &[0; 800][..], "its section table is invalid"),
        (4096 + 40, &[9], "its section table is invalid"),
        (4096 + 24, &[0xFF; 4], "its section table is invalid"),
        (4096, &[0xFF; 8], "its section table is invalid"),
        (24, &[0xFF; 6], "its header is invalid"),
        (40, &[0xFF; 8], "its header is invalid"),
        (72, &[0], "its header is invalid"),
        (0, &[0; 8], "it is not an image"),
        (256, &[0], "its NC has ended or is about to start"),
    ] {
        let write = |bytes: &[u8]| {
            let mut file = fs::File::options().write(true).open(&file.0).unwrap();
            file.seek(SeekFrom::Start(u64::try_from(place).unwrap())).unwrap();
            file.write_all(bytes).unwrap();
        };
        write(content);
        writeln!(stdin, "0").unwrap();
        let error = lines.next().unwrap().unwrap();
        assert!(error.starts_with(&format!("no NC serves {}: {said}", file.text())), "{place}: {error}");
        writeln!(stdin, "60").unwrap();
        std::thread::sleep(Duration::from_millis(30));
        write(&whole[place..place + content.len()]);
        assert_eq!(lines.next().unwrap().unwrap(), format!("({wanted}, 1, 4)"), "{place}");
    }
    drop(stdin);
    assert!(child.wait().unwrap().success());
    drop(nc);
}

/// `opennck serve` until it is dropped.
struct Served {
    child: Child,
    _ends: EndsWithTest,
    head: Vec<String>,
}

impl Served {
    fn start(arguments: &[&str]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_opennck"));
        command.arg("serve").args(arguments).args(["--s7", "127.0.0.1:0"]);
        let mut child = command.stdout(Stdio::piped()).spawn().expect("the program was built");
        let ends = EndsWithTest::new(&child);
        let mut lines = BufReader::new(child.stdout.take().expect("it is piped")).lines();
        let mut head = Vec::new();
        while !head.iter().any(|line: &String| line.contains("Ctrl-C")) {
            head.push(lines.next().expect("it serves").expect("text"));
        }
        Self { child, _ends: ends, head }
    }

    /// The port in a line of the banner.
    fn port(&self, of: &str) -> u16 {
        let line = self.head.iter().find_map(|line| line.strip_prefix(of)).expect("the output has the port");
        let port = line.strip_prefix("127.0.0.1:").and_then(|rest| rest.split([':', '/']).next());
        port.and_then(|port| port.parse().ok()).expect("a number")
    }

    fn client(&self) -> S7Client {
        let mut client = S7Client::new();
        client.set_connection_port(self.port("S7 on ")).expect("it is not connected yet");
        client.connect_rack_slot("127.0.0.1", 0, 2).expect("the server is there");
        client
    }

    fn metrics(&self) -> String {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port("metrics on http://"))).expect("it is there");
        stream.write_all(b"GET /metrics HTTP/1.1\r\nHost: a\r\n\r\n").expect("it is connected");
        let mut text = String::new();
        stream.read_to_string(&mut text).expect("text");
        text
    }

    /// Stops it by a signal; it must end with 0, and soon.
    #[track_caller]
    fn end(mut self) {
        let killed = Command::new("kill").arg(self.child.id().to_string()).status().expect("there is a kill");
        assert!(killed.success());
        let begin = Instant::now();
        assert_eq!(self.child.wait().expect("it ends").code(), Some(0));
        assert!(begin.elapsed() < Duration::from_secs(20), "{:?}", begin.elapsed());
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// When the PLC process starts.
enum Comes {
    /// Before the file exists.
    Before,
    /// This long after the server.
    After(Duration),
    /// It is running already, with another server that served the file.
    WithAnother,
    /// Before the server, after another server that crashed: the file is still marked as served.
    BehindAnother,
}

const SCENARIO: &str = r#"
title = "somebody watches the gantry"
machine = "g1_example"
watch = ["DB31.DBB101", "MB100", "X.position"]
[[step]]
run = "1s"
[[step]]
note = "the flag is of one cycle"
set = { "MB100" = 7 }
[[step]]
wait = "X.gantry_grouping_is_synchronized"
within = "100s"
"#;

/// The worked example with a PLC in Python in lock-step while a scripted operator writes; returns the trace.
fn traced_worked_example(mut python: Command, name: &str, comes: &Comes) -> String {
    const AGAIN: &str = "import worked_example\nwhile worked_example.main(): pass";
    const ONCE: &str = "import sys, worked_example\nsys.exit(worked_example.main())";
    let file = File::new(name);
    let (scenario, trace) = (File::called(&format!("{name}.toml")), File::called(&format!("{name}.jsonl")));
    fs::write(&scenario.0, SCENARIO).unwrap();
    let program = if matches!(comes, Comes::BehindAnother) { ONCE } else { AGAIN };
    let mut plc = python.args(["-c", program, file.text()]).stdout(Stdio::piped()).stderr(Stdio::null());
    let lock_step = ["--image", file.text(), "--lock-step", "--plc-timeout", "1min"];
    let mut there = None;
    match comes {
        Comes::Before => there = Some(plc.spawn().unwrap()),
        Comes::After(_) | Comes::BehindAnother => {}
        Comes::WithAnother => {
            let mut other = Served::start(&[&["g1_example"], &lock_step[..]].concat());
            there = Some(plc.spawn().unwrap());
            let newest_answer = || fs::read(&file.0).is_ok_and(|bytes| bytes[520] > 3);
            wait("the process answers the other server", newest_answer);
            other.child.kill().unwrap(); // a crash: its file is still marked as running
            other.child.wait().unwrap();
        }
    }
    if matches!(comes, Comes::BehindAnother) {
        let mut other = Served::start(&[&["g1_example"], &lock_step[..]].concat());
        other.child.kill().unwrap();
        other.child.wait().unwrap();
        let starts = || fs::read(&file.0).unwrap()[512];
        let before = starts();
        there = Some(plc.spawn().unwrap());
        wait("the process opens the file", || starts() != before);
    }
    let with = ["--scenario", scenario.text(), "--trace", trace.text(), "--speed", "1000"];
    let served = Served::start(&[&lock_step[..], &with].concat());
    if let Comes::After(late) = comes {
        std::thread::sleep(*late);
        plc = plc.stderr(Stdio::inherit());
    }
    let output = there.unwrap_or_else(|| plc.spawn().unwrap()).wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}");
    // EX-03 and EX-05 of the manual: 101.4 with 10654, then 101.5.
    assert!(said.contains("ready to start: DB31.DBB101 = 11010000"), "{said}");
    assert!(said.contains("synchronised:   DB31.DBB101 = 11100000"), "{said}");
    served.end();
    fs::read_to_string(&trace.0).unwrap()
}

#[cfg(unix)]
#[test]
fn the_worked_example_with_a_plc_in_python_has_the_same_trace_whenever_the_process_comes() {
    let run = |name, comes| Some(traced_worked_example(python()?, name, &comes));
    let Some(first) = run("before", Comes::Before) else { return };
    assert!(first.contains("the flag is of one cycle"), "{first}");
    let late = Comes::After(Duration::from_millis(700));
    for (name, comes) in [("late", late), ("attached", Comes::WithAnother), ("behind", Comes::BehindAnother)] {
        let again = run(name, comes).unwrap();
        let differs = first.lines().zip(again.lines()).find(|(first, again)| first != again);
        assert!(first == again, "{name}: {differs:?}, {} bytes, then {}", first.len(), again.len());
    }
}

#[cfg(unix)]
#[test]
fn until_a_plc_process_comes_the_machine_is_as_it_was_switched_on() {
    let file = File::new("held");
    let lock_step = ["g1_example", "--image", file.text(), "--lock-step", "--plc-timeout", "1min"];
    let served = Served::start(&[&lock_step[..], &["--metrics", "0"]].concat());
    let said = format!("waiting for a PLC process to open {} before the first step, for example", file.text());
    assert_eq!(served.head.iter().filter(|line| **line == said).count(), 1, "{:?}", served.head);
    let mut client = served.client();
    let mut flag = [0xFF];
    client.read_area(S7_AREA_MK, 0, 0, S7_WL_BYTE, &mut flag).unwrap();
    client.write_area(S7_AREA_MK, 0, 0, S7_WL_BYTE, &[0xAB]).unwrap();
    let nc_ready = |client: &mut S7Client| client.read_bit(S7_AREA_DB, 10, 108, 7).unwrap();
    assert!(!nc_ready(&mut client) && flag == [0]);
    let metrics = served.metrics();
    assert!(metrics.contains("\nopennck_steps_total 0\n"), "{metrics}");
    let process = soft_plc(&file.0, start_gantry);
    wait("what was written acts, and the control runs up", || {
        client.read_area(S7_AREA_MK, 0, 0, S7_WL_BYTE, &mut flag).unwrap();
        flag == [0xAB] && nc_ready(&mut client)
    });
    served.end();
    process.join().unwrap();
}

#[cfg(unix)]
#[test]
fn a_signal_ends_it_while_it_waits_for_a_process_and_its_trace_has_no_cycle() {
    let (file, trace) = (File::new("never"), File::called("never.jsonl"));
    Served::start(&["g1_example", "--image", file.text(), "--lock-step", "--trace", trace.text()]).end();
    assert_eq!(fs::read_to_string(&trace.0).unwrap(), "");
}

/// Waits until a condition is true.
fn wait(what: &str, mut is_so: impl FnMut() -> bool) {
    let start = Instant::now();
    while !is_so() {
        assert!(start.elapsed() < LONG, "{what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[test]
fn a_silent_plc_raises_2000_and_another_one_restarts_the_plc() {
    for lock_step in [false, true] {
        let file = File::new(if lock_step { "silent-lock" } else { "silent" });
        let machine = Machine::open("g1_example").unwrap();
        // Long enough for a busy computer, so that only the silent process times out.
        let exchange = Exchange { lock_step, time_out: Duration::from_secs(2) };
        let mapped = MappedPlc::create(&file.0, &machine, exchange).unwrap();
        let (live, _keeper) = Keeper::start(machine, mapped, |machine| Live::start(machine, Speed::default()));
        let alarm =
            || live.with(|machine| machine.variables().alarms.iter().any(|alarm| alarm.number == AlarmNumber(2000)));
        let stopped = || live.with(|machine| machine.is_plc_stopped());
        let ready = || live.with(|machine| machine.memory().from_nck().nck.nc_ready());
        wait("the control runs up without a PLC process", ready);
        let mut scans = 0;
        let first = soft_plc(&file.0, move |plc| {
            scans += 1;
            start_gantry(plc) && scans < 20
        });
        first.join().unwrap();
        wait("no sign of life: 2000", || alarm() && stopped());
        let _second = soft_plc(&file.0, start_gantry);
        wait("another process restarts the PLC", || !stopped());
        assert!(alarm() && !ready(), "the alarm is of class POWER ON");
        PlcImage::open(&file.0).unwrap().power_off_and_on();
        wait("power off and on clears it", || !alarm() && ready() && !stopped());
    }
}

/// The two take each other's steps: in lock-step in turn, otherwise the second one takes them all. The operator is told which two they are.
#[cfg(unix)]
#[test]
fn a_second_plc_process_at_the_same_file_is_reported() {
    const SCRIPT: &str = "
import sys
from opennck_image import Image
with Image(sys.argv[1], wait=60) as image:
    for step in image.steps():
        step['DB31.DBX2.1'] = 1
        image.answer(step)
";
    for lock_step in [false, true] {
        let file = File::new(if lock_step { "doubled-lock" } else { "doubled" });
        let plc = || Some(python()?.args(["-c", SCRIPT, file.text()]).spawn().unwrap());
        let mut command = Command::new(env!("CARGO_BIN_EXE_opennck"));
        command.args(["serve", "g1_example", "--s7", "127.0.0.1:0", "--plc-timeout", "1min", "--image", file.text()]);
        command.args(lock_step.then_some("--lock-step")).stdout(Stdio::null()).stderr(Stdio::piped());
        let Some(first) = plc() else { return };
        let mut processes = vec![first, command.spawn().unwrap()];
        let mut ends: Vec<_> = processes.iter().map(EndsWithTest::new).collect();
        let mut log = BufReader::new(processes[1].stderr.take().unwrap()).lines().map_while(Result::ok);
        assert!(log.any(|line| line.ends_with("a PLC process has opened the image")));
        // The first process answers before the second one comes.
        let answers = || fs::read(&file.0).is_ok_and(|bytes| bytes[520] > 3);
        wait("the first process answers", answers);
        processes.extend(plc());
        ends.extend(processes.last().map(EndsWithTest::new));
        let [one, other] = [processes[0].id(), processes[2].id()];
        let said = log.find(|line| line.contains("two PLC processes answer") || line.contains("answers instead of"));
        for process in &mut processes {
            process.kill().unwrap();
            process.wait().unwrap();
        }
        let said = said.expect("the log has it");
        assert!(said.contains(&one.to_string()) && said.contains(&other.to_string()), "{said}: {one}, {other}");
        assert!(said.contains("end one of them") || said.contains(&format!("end {one} if it still runs")), "{said}");
    }
}

/// The machine is in the middle of a scan.
#[cfg(unix)]
#[test]
fn while_a_scan_waits_for_a_process_that_has_gone_clients_are_served_and_a_signal_ends_it() {
    let file = File::new("gone");
    let lock_step = ["g1_example", "--image", file.text(), "--lock-step", "--plc-timeout", "60min", "--speed", "2"];
    let served = Served::start(&lock_step);
    let mut scans = 0;
    let process = soft_plc(&file.0, move |_| {
        scans += 1;
        scans < 20
    });
    process.join().unwrap();
    std::thread::sleep(Duration::from_millis(500)); // the scan waits, and the status line has been drawn
    let flags = served.client().read_area(S7_AREA_MK, 0, 0, S7_WL_BYTE, &mut [0; 10]);
    assert!(flags.is_ok(), "clients see the last step meanwhile: {flags:?}");
    served.end();
}

#[test]
fn in_lock_step_each_cycle_has_its_scan_from_the_first_on_also_after_stop_and_start_of_the_plc() {
    let file = File::new("stopped");
    let machine = Machine::open("g1_example").unwrap();
    let mapped = MappedPlc::create(&file.0, &machine, Exchange { lock_step: true, time_out: LONG }).unwrap();
    let options = LiveOptions { is_held: true, ..LiveOptions::default() };
    let start = |machine| Live::start_with(machine, Speed::default(), options);
    let (live, _keeper) = Keeper::start(machine, mapped, start);
    std::thread::sleep(Duration::from_millis(50));
    assert!(live.is_held() && live.with(|machine| machine.cycle()) == 0);
    let scans = Arc::new(AtomicU64::new(0));
    let counted = Arc::clone(&scans);
    let _process = soft_plc(&file.0, move |plc| {
        counted.fetch_add(1, Ordering::Relaxed);
        start_gantry(plc)
    });
    let scans_and_cycles = || live.with(|machine| (scans.load(Ordering::Relaxed), machine.cycle()));
    wait("some scans", || scans_and_cycles().0 > 20);
    let (scans, cycles) = scans_and_cycles();
    assert_eq!(scans, cycles);
    live.with(|machine| machine.queue(machine::Command::PlcStop)).unwrap();
    wait("the PLC stops", || live.with(|machine| machine.is_plc_stopped()));
    let stopped = scans_and_cycles().0;
    live.with(|machine| machine.queue(machine::Command::PlcRun)).unwrap();
    wait("it scans again", || scans_and_cycles().0 > stopped + 20);
    assert!(live.with(|machine| machine.plc_fault().is_none() && !machine.is_plc_stopped()));
}
