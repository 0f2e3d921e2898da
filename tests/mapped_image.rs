//! A PLC in another process, by the mapped image: the same bits as a built-in program, nothing torn, alarm 2000 where it is silent.
#![cfg(all(feature = "cli", feature = "s7"))]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![expect(clippy::disallowed_methods, reason = "another process works in real time")]

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use opennck::cli::serve::{Exchange, Keeper, Live, MappedPlc, Speed};
use opennck::image::mapped::{Look, MappedImage, PlcImage, Rules, State, Step};
use opennck::image::{Area, Memory, Names};
use opennck::machine::Machine;
use opennck::plc::{PlcProgram, gantry_start};
use opennck::scenario::{Failure, Session};
use opennck::units::Time;
use opennck::variables::AlarmNumber;

/// Longer than any computer sleeps in between.
const LONG: Duration = Duration::from_secs(60);

/// A file of its own for one test.
struct File(PathBuf);

impl File {
    fn new(name: &str) -> Self {
        let file = Self(std::env::temp_dir().join(format!("opennck-{}-{name}.image", std::process::id())));
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

/// Python with the module of the example; where there is none, it says so.
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

/// A soft PLC on the other side of a file: scans until the NC has ended, or `scan` says that it is enough.
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

/// What the ready program `gantry_start` does, by addresses.
fn start_gantry(plc: &mut PlcImage) -> bool {
    for db in 31..=33 {
        set(plc, db, 1, 5, true);
        set(plc, db, 2, 1, true);
        set(plc, db, 21, 7, true);
        let ready = plc.offset(Area::DataBlock(db), 101).is_some_and(|offset| plc.image()[offset] & 0x10 != 0);
        set(plc, db, 29, 4, ready);
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
    // It comes before the first scan, so that it sees every one.
    let path = file.0.clone();
    let plc = std::thread::spawn(move || soft_plc(&path, start_gantry).join());
    mapped.wait_for_plc(LONG)?;
    let there = synchronise(Box::new(mapped))?;
    plc.join().unwrap().unwrap();
    assert!(there.contains("DB31.DBX101.5     0 -> 1"), "{there}");
    assert_eq!(there, synchronise(gantry_start().boxed())?);
    Ok(())
}

/// Publishes steps as fast as it can, each with one byte value in all own blocks, until so many answers have come; the other side
/// inverts every bit of them. No answer is half.
fn hammer(file: &File, answers: u64, start: impl FnOnce()) {
    let mut memory = Memory::new();
    let rules = Rules { lock_step: false, time_out: Time::ZERO };
    let mut nc = MappedImage::create(&file.0, &memory, &Names::default(), rules).unwrap();
    start();
    let (begin, mut taken, mut cycle) = (Instant::now(), 0, 0_u64);
    while taken < answers {
        assert!(begin.elapsed() < LONG, "{taken} answers to {cycle} steps");
        cycle += 1;
        for db in Memory::STANDARD_BLOCKS {
            memory.blocks.get_mut(db).unwrap().fill(u8::try_from(cycle % 251).unwrap());
        }
        nc.publish(&memory, Step { cycle, time: Time::ZERO, since_last: Time::ZERO }, false);
        if let Look::Answer(number) = nc.look(0) {
            let mut answered = memory.clone();
            nc.take(&mut answered);
            let bytes: Vec<u8> = answered.blocks.iter().flat_map(|block| block.bytes.to_vec()).collect();
            assert!(bytes.iter().all(|byte| *byte == bytes[0]), "half an answer");
            // The first step, which creating the file has published, has 0 in it; the others have their cycle.
            assert_eq!(bytes[0], !u8::try_from((number - 1) % 251).unwrap(), "every bit of step {number} is another");
            taken += 1;
        }
    }
}

#[test]
fn nobody_takes_half_a_step_or_half_an_answer() {
    let file = File::new("torn");
    let mut plc = None;
    hammer(&file, 5000, || {
        plc = Some(soft_plc(&file.0, |plc| {
            let start = |plc: &PlcImage, db| plc.offset(Area::DataBlock(db), 0).unwrap();
            let value = plc.image()[start(plc, 2)];
            for db in Memory::STANDARD_BLOCKS {
                let start = start(plc, db);
                let block = &mut plc.image_mut()[start..start + Memory::STANDARD_LENGTH];
                assert!(block.iter().all(|byte| *byte == value), "half a step");
                block.fill(!value);
            }
            true
        }));
    });
    plc.unwrap().join().expect("it saw no half step");
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
    assert!(other.unwrap().wait().unwrap().success(), "it saw half a step");
}

/// `opennck serve` until it is dropped.
struct Served(Child);

impl Served {
    fn start(arguments: &[&str]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_opennck"));
        command.arg("serve").args(arguments).args(["--s7", "127.0.0.1:0"]);
        let mut child = command.stdout(Stdio::piped()).spawn().expect("the program was built");
        let mut lines = BufReader::new(child.stdout.take().expect("it is piped")).lines();
        assert!(lines.any(|line| line.expect("text").contains("Ctrl-C ends")), "it serves");
        Self(child)
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn the_worked_example_runs_with_a_plc_in_python() {
    let Some(mut python) = python() else { return };
    let file = File::new("example");
    let _served =
        Served::start(&["g1_example", "--image", file.text(), "--lock-step", "--speed", "50", "--plc-timeout", "1min"]);
    let output = python.args(["worked_example.py", file.text()]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    // EX-03 and EX-05 of the manual: 101.4 with 10654, then 101.5.
    assert!(said.contains("ready to start: DB31.DBB101 = 11010000"), "{said}");
    assert!(said.contains("synchronised:   DB31.DBB101 = 11100000"), "{said}");
}

/// Waits until something is so.
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
        // Long enough for a busy computer, so that only the silent one is silent.
        let exchange = Exchange { lock_step, time_out: Duration::from_secs(2) };
        let mapped = MappedPlc::create(&file.0, &machine, exchange).unwrap();
        let (live, _keeper) = Keeper::start(machine, mapped, |machine| Live::start(machine, Speed::default()));
        let alarm =
            || live.with(|machine| machine.variables().alarms.iter().any(|alarm| alarm.number == AlarmNumber(2000)));
        let stopped = || live.with(|machine| machine.is_plc_stopped());
        let ready = || live.with(|machine| machine.memory().from_nck.nck.nc_ready());
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

/// The machine is in the middle of a scan then, and everybody waits for it.
#[cfg(unix)]
#[test]
fn a_signal_ends_it_while_a_scan_waits_for_a_process_that_has_gone() {
    let file = File::new("gone");
    let mut served = Served::start(&["g1_example", "--image", file.text(), "--lock-step", "--plc-timeout", "60min"]);
    let mut scans = 0;
    let process = soft_plc(&file.0, move |_| {
        scans += 1;
        scans < 20
    });
    process.join().unwrap();
    std::thread::sleep(Duration::from_millis(500)); // the scan waits, and the status line has been drawn
    let killed = Command::new("kill").arg(served.0.id().to_string()).status().unwrap();
    assert!(killed.success());
    let begin = Instant::now();
    assert_eq!(served.0.wait().unwrap().code(), Some(0));
    assert!(begin.elapsed() < Duration::from_secs(20), "{:?}", begin.elapsed());
}
