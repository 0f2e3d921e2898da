//! The cost of a scan by a PLC in another process: an empty program in Python, compared with a bare ping-pong of one counter between the
//! same two processes over the same file, in one run. `benches/README.md` describes how to run it and its results.

#![expect(
    clippy::disallowed_methods,
    clippy::cast_precision_loss,
    reason = "it measures time, and prints rounded numbers"
)]

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::{Child, Command};
use std::time::{Duration, Instant};

use opennck::image::mapped::{MappedImage, Rules, State};
use opennck::live::{Exchange, MappedPlc};
use opennck::machine::Machine;
use opennck::units::Time;

/// Rounds of each row; medians are shown.
const ROUNDS: usize = 5;
/// Duration of a round.
const ROUND: Duration = Duration::from_secs(1);

/// The counter goes by two words of the header: the NC writes the one, the PLC the other.
const PING: &str = "
import sys, time
from opennck_image import Image, POWER, STATE
with Image(sys.argv[1]) as image:
    words, seen, spins = image.words, 0, sys.argv[2] == 'spin'
    while words[STATE // 8]:
        begin = time.perf_counter()
        while (number := words[112 // 8]) == seen and words[STATE // 8]:
            if not spins and time.perf_counter() - begin > 0.0002: time.sleep(0.00005)
        words[POWER // 8] = seen = number
";

/// A program that answers and does nothing else.
const EMPTY: &str = "
import sys
from opennck_image import Image
with Image(sys.argv[1]) as image:
    for step in image.steps():
        image.answer(step)
";

/// The worked example's enables and one word: what a small program does.
const SMALL: &str = "
import sys
from opennck_image import Image
with Image(sys.argv[1]) as image:
    for step in image.steps():
        for axis in ('DB31', 'DB32', 'DB33'):
            step[axis + '.DBX1.5'] = step[axis + '.DBX2.1'] = step[axis + '.DBX21.7'] = 1
        step['MW20'] = (step['MW20'] + 1) % 30000
        image.answer(step)
";

fn main() -> Result<(), Box<dyn Error>> {
    let mut rates: [Vec<f64>; 4] = Default::default();
    for _ in 0..ROUNDS {
        rates[0].push(ping("spin")?);
        rates[1].push(ping("as a scan")?);
        rates[2].push(scans(EMPTY)?);
        rates[3].push(scans(SMALL)?);
    }
    let [spin, bare, empty, small] = rates.map(|mut rates| {
        rates.sort_by(f64::total_cmp);
        rates[ROUNDS / 2]
    });
    println!("| exchange | per second |\n|---|---|");
    println!("| bare ping-pong, both sides look without a pause | {spin:.0} |");
    println!("| bare ping-pong, both sides wait as a scan does | {bare:.0} |");
    println!("| scan of an empty program | {empty:.0} |");
    println!("| scan of a small program | {small:.0} |");
    let verdict = if empty / bare >= 0.5 { "" } else { " MISSED" };
    println!("\nempty program / bare ping-pong that waits as a scan does: {:.2}, at least 0.5{verdict}", empty / bare);
    println!("empty program / bare ping-pong without a pause: {:.2}", empty / spin);
    Ok(())
}

/// A file for one round.
fn file() -> PathBuf {
    let folder = if Path::new("/dev/shm").is_dir() { PathBuf::from("/dev/shm") } else { std::env::temp_dir() };
    folder.join(format!("opennck-bench-{}.image", std::process::id()))
}

fn python(program: &str, file: &Path, how: &str) -> std::io::Result<Child> {
    let module = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/python_plc");
    Command::new("python3").args(["-c", program]).arg(file).arg(how).env("PYTHONPATH", module).spawn()
}

/// Exchanges of a counter per second.
fn ping(how: &str) -> Result<f64, Box<dyn Error>> {
    let machine = Machine::open("g1_example")?;
    let file = file();
    let rules = Rules { lock_step: true, time_out: Time::from_millis(1000) };
    let image = MappedImage::create(&file, machine.memory(), machine.names(), rules)?;
    image.cycle_time(Time::ZERO);
    image.state(State::Run);
    let mut child = python(PING, &file, how)?;
    let exchange = |number: i64| {
        image.cycle_time(Time::from_nanos(number));
        let wanted = number.unsigned_abs();
        let begin = Instant::now();
        while image.power_requests() != wanted {
            if how == "spin" || begin.elapsed() < Duration::from_micros(200) {
                std::hint::spin_loop();
            } else {
                std::thread::sleep(Duration::from_micros(50));
            }
            assert!(begin.elapsed() < Duration::from_secs(20), "the other process does not answer");
        }
    };
    (1..100).for_each(exchange);
    let (begin, mut number) = (Instant::now(), 100);
    while begin.elapsed() < ROUND {
        exchange(number);
        number += 1;
    }
    let rate = (number - 100) as f64 / begin.elapsed().as_secs_f64();
    drop(image);
    child.wait()?;
    std::fs::remove_file(&file)?;
    Ok(rate)
}

/// Scans per second, each with a step of the machine.
fn scans(program: &str) -> Result<f64, Box<dyn Error>> {
    let mut machine = Machine::open("g1_example")?;
    let file = file();
    let exchange = Exchange { lock_step: true, time_out: Duration::from_secs(20) };
    let mut plc = MappedPlc::create(&file, &machine, exchange)?;
    let mut child = python(program, &file, "")?;
    plc.wait_for_plc(Duration::from_secs(20))?;
    machine.load_program(Box::new(plc));
    let mut step = || {
        machine.step();
        machine.drain();
        assert!(machine.plc_fault().is_none(), "{:?}", machine.plc_fault());
    };
    (0..100).for_each(|_| step());
    let (begin, mut count) = (Instant::now(), 0_u32);
    while begin.elapsed() < ROUND {
        step();
        count += 1;
    }
    let rate = f64::from(count) / begin.elapsed().as_secs_f64();
    drop(machine);
    child.wait()?;
    std::fs::remove_file(&file)?;
    Ok(rate)
}
