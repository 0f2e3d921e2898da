//! Measures a program: a path of short lines on three axes, one of which leads a gantry grouping, compared with the same axes in JOG; and the
//! preparation of blocks. `benches/README.md` describes how to run it and its results.

use divan::Bencher;
use divan::counter::ItemsCount;
use opennck::machine::Machine;
use opennck::plc::enable_all;
use opennck::scenario::Session;

/// The number of steps of one sample: two seconds of the machine.
const STEPS: u64 = 1_000;

fn main() {
    divan::main();
}

/// The portal in AUTOMATIC with this program, started.
fn running(nc: &str) -> Machine {
    let mut session =
        Session::open("machine_data/portal").expect("the machine opens").with_program(enable_all().boxed());
    let mut wanted = || {
        session.run("200ms")?;
        session.set("mode_group_1.mode_automatic", 1)?;
        session.nc(nc, 1)?;
        session.run("10ms")?;
        session.pulse_for("CHAN1.nc_start", "10ms")?;
        session.run("200ms")?;
        session.expect("CHAN1.program_state_running")
    };
    wanted().expect("the program runs");
    session.machine().fork().expect("a machine can be copied")
}

fn steps(machine: &mut Machine) -> u64 {
    for _ in 0..STEPS {
        machine.step();
        machine.drain();
    }
    machine.cycle()
}

/// 10,000 lines of half a millimetre on X, Y and Z with continuous path, which begin again at their end.
#[divan::bench]
fn short_lines(bencher: Bencher<'_, '_>) {
    let mut nc = String::from("G64 G1 F3000\nAGAIN:\n");
    for number in 0..10_000_i32 {
        // A zigzag of small angles in a box of 50 mm.
        let at = |phase: i32| f64::from((number + phase).rem_euclid(200) - 100).abs() / 2.0;
        nc += &format!("X{} Y{} Z{}\n", at(0), at(50), at(100));
    }
    nc += "GOTOB AGAIN\nM30\n";
    let mut machine = running(&nc);
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| steps(&mut machine));
}

/// One long line, over and over: no block changes to speak of.
#[divan::bench]
fn long_lines(bencher: Bencher<'_, '_>) {
    let mut machine = running("G1 F3000\nAGAIN:\nX400 Y400 Z400\nX0 Y0 Z0\nGOTOB AGAIN\nM30\n");
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| steps(&mut machine));
}

/// The same axes without a program, at rest in AUTOMATIC: what the machine costs itself.
#[divan::bench]
fn at_rest(bencher: Bencher<'_, '_>) {
    let mut machine = running("G4 F10000\nM30\n");
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| steps(&mut machine));
}
