//! Tests that the same input gives the same bytes: in one process, in two processes, after save and restore, and in a fork.

use std::path::{Path, PathBuf};
use std::process::Command as Process;

use opennck::image::Profile;
use opennck::machine::{Command, DatumValue, Fault, FaultKind, Machine};
use opennck::plc::{OnDelay, PlcProgram, Programs, program};
use opennck::scenario::{Scenario, State};
use opennck::units::{Position, Time};

const SCENARIO: &str = "golden/worked_example/gantry_references_and_synchronises.toml";

/// The number of cycles of the timeline below. The grouping becomes synchronised and loses synchronism again.
const CYCLES: u64 = 5_000;

/// A program with its own state: pulse enable follows the other enables after 100 ms, and MW20 counts scans.
fn plc() -> Box<dyn PlcProgram> {
    program("delayed", (OnDelay::default(), 0_u16), |(delay, scans), io| {
        *scans = scans.wrapping_add(1);
        io.flags.set_word(20, *scans);
        let on = delay.scan(true, Time::from_millis(100), io.time);
        for axis in io.axes() {
            let signals = io.to_nck.axis(axis);
            signals.set_position_measuring_system_1(true);
            signals.set_controller_enable(true);
            signals.set_pulse_enable(on);
        }
    })
    .boxed()
}

fn machine() -> Machine {
    let mut machine = Machine::open("g1_example").expect("it is built in");
    machine.load_program(plc());
    machine
}

fn write(machine: &mut Machine, signal: &str, value: u64) {
    let location = machine.names().resolve(machine.memory(), signal).expect("a signal");
    machine.queue(Command::Write { location, value }).expect("a write");
}

fn fault(machine: &mut Machine, axis: &str, kind: FaultKind) {
    let axis = machine.axis(axis).expect("an axis");
    machine.queue(Command::Fault(Fault { axis, kind })).expect("a fault");
}

/// The events before the next step of a machine, by cycle: referencing, faults, machine data, a start, a force.
fn act(machine: &mut Machine) {
    let slip = FaultKind::EncoderSlip { by: Position::from_user(0.01) };
    match machine.cycle() {
        10 => {
            write(machine, "DB11.DBX0.2", 1);
            write(machine, "DB11.DBX1.2", 1);
        }
        100 => write(machine, "X.traversing_key_plus", 1),
        150 => write(machine, "X.traversing_key_plus", 0),
        900 => fault(machine, "XF", slip),
        1_500 => fault(machine, "Y", FaultKind::Block),
        2_000 => {
            let value = DatumValue::Real(-0.941);
            machine.queue(Command::MachineDatum { target: "34090[XF]".to_owned(), value }).expect("a datum");
        }
        4_000 => write(machine, "X.start_gantry_synchronization", 1),
        4_400 => {
            let location = machine.names().resolve(machine.memory(), "X.controller_enable").expect("a signal");
            machine.queue(Command::Force { location, value: 0 }).expect("a force");
        }
        4_600 => machine.queue(Command::PowerOn).expect("power"),
        _ => {}
    }
}

/// One step of a machine. The record of the step stays in the machine.
fn step(machine: &mut Machine) {
    machine.drain();
    act(machine);
    machine.step();
}

/// Fails in the first cycle in which two machines differ, and reports the difference.
fn assert_same(expected: &Machine, found: &Machine, what: &str) {
    let cycle = expected.cycle();
    assert_eq!(cycle, found.cycle(), "{what}: the cycles differ");
    assert!(expected.memory() == found.memory(), "{what}: memory differs first in cycle {cycle}");
    assert_eq!(expected.variables(), found.variables(), "{what}: variables differ first in cycle {cycle}");
    let (rows, events) = (expected.recorder().rows(), expected.recorder().new_events());
    assert_eq!(rows, found.recorder().rows(), "{what}: the record differs first in cycle {cycle}");
    assert_eq!(events, found.recorder().new_events(), "{what}: the events differ first in cycle {cycle}");
}

fn run_to(machine: &mut Machine, cycle: u64) {
    while machine.cycle() < cycle {
        step(machine);
    }
}

#[test]
fn the_timeline_of_these_tests_references_synchronises_and_loses_synchronism() {
    let mut machine = machine();
    let x = machine.axis("X").expect("an axis");
    run_to(&mut machine, 4_390);
    assert!(machine.memory().from_nck().axes[x].gantry_grouping_is_synchronized());
    run_to(&mut machine, CYCLES);
    assert!(!machine.memory().from_nck().axes[x].gantry_grouping_is_synchronized());
}

#[test]
fn one_scenario_gives_the_same_bytes_twice_in_one_process() {
    let run = || {
        let scenario = Scenario::read(Path::new(SCENARIO)).expect("a scenario");
        let finished = scenario.prepare(Profile::default(), &Programs::ready()).expect("it can be used").run();
        [finished.golden(), finished.text(), finished.json_lines()]
    };
    let (first, second) = (run(), run());
    assert!(first[2].contains("10654"));
    for (first, second) in first.iter().zip(&second) {
        let line = first.lines().zip(second.lines()).find(|(first, second)| first != second);
        assert!(first == second, "first different line: {line:?}");
    }
}

/// All scenarios of the test suite.
fn scenarios() -> Vec<PathBuf> {
    let areas = std::fs::read_dir("golden").expect("the test suite must exist");
    let files = areas.flat_map(|area| std::fs::read_dir(area.expect("an area").path()).expect("an area"));
    let mut files: Vec<_> = files.map(|file| file.expect("a file").path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    files
}

#[test]
fn resting_axes_change_no_trace() {
    let files = scenarios();
    assert!(files.len() > 100);
    for file in files {
        let scenario = Scenario::read_cases(&file).expect("a scenario").remove(0);
        let prepare = || scenario.prepare(scenario.profiles[0], &Programs::ready()).expect("it can be used");
        let always = prepare().decide_always().run().json_lines();
        for other in [prepare().run().json_lines(), prepare().never_rest().run().json_lines()] {
            let line = always.lines().zip(other.lines()).find(|(always, other)| always != other);
            assert!(always == other, "{}: first different line: {line:?}", file.display());
        }
    }
}

#[test]
fn resting_axes_change_no_saved_state() {
    compare_resting(machine(), machine());
}

/// Jerk filters, feed-forward with dead time, and matching have an internal state.
#[test]
fn resting_axes_change_no_filters_or_delays() {
    let filtered = || {
        let mut machine = machine();
        for axis in ["X", "Y", "XF"] {
            for (number, value) in [("32400", 1.0), ("32410", 0.05), ("32420", 1.0), ("32620", 3.0), ("32900", 1.0)] {
                let (target, value) = (format!("{number}[{axis}]"), DatumValue::Real(value));
                machine.queue(Command::MachineDatum { target, value }).expect("a datum");
            }
            let (target, value) = (format!("32910[0,{axis}]"), DatumValue::Real(0.002));
            machine.queue(Command::MachineDatum { target, value }).expect("a datum");
        }
        machine.queue(Command::PowerOn).expect("power");
        machine
    };
    compare_resting(filtered(), filtered());
}

fn compare_resting(mut resting: Machine, mut always: Machine) {
    always.decide_always();
    for cycle in 1..=CYCLES {
        step(&mut resting);
        step(&mut always);
        assert_same(&always, &resting, "all axes computed in every cycle, and only active axes computed");
        if cycle % 100 == 0 {
            assert!(resting.save() == always.save(), "the saved states differ in cycle {cycle}");
        }
    }
}

#[cfg(feature = "cli")]
#[test]
fn one_scenario_gives_the_same_bytes_in_two_processes() {
    let run = |name: &str| {
        let trace = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
        let output = Process::new(env!("CARGO_BIN_EXE_opennck"))
            .args(["run", SCENARIO, "--trace"])
            .arg(&trace)
            .output()
            .expect("the program was built");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        (output.stdout, std::fs::read(&trace).expect("the trace was written"))
    };
    let (first, second) = (run("first.jsonl"), run("second.jsonl"));
    assert!(first.1.len() > 1_000);
    assert!(first == second, "two processes wrote different bytes");
}

#[test]
fn a_saved_machine_continues_in_another_machine_byte_for_byte() {
    // During run-up, search for the cam, travel to the zero mark, section 2, waiting, synchronising, synchronised, braking.
    for saved_at in [0, 13, 400, 1_700, 2_300, 3_900, 4_050, 4_399, 4_420, 4_601] {
        let mut origin = machine();
        run_to(&mut origin, saved_at);
        // Writes that wait for the next step must be saved, too.
        write(&mut origin, "MB100", 0xA5);
        let saved = origin.save();
        let mut restored = machine();
        // The earlier history of the other machine must have no effect.
        run_to(&mut restored, 700);
        restored.restore(&saved).expect("it was saved on the same machine");
        assert_eq!(origin.cycle(), restored.cycle());
        let what = format!("saved in cycle {saved_at}");
        assert!(restored.save() == saved, "{what}: the restored machine is saved with other bytes");
        while origin.cycle() < CYCLES {
            step(&mut origin);
            step(&mut restored);
            assert_same(&origin, &restored, &what);
            // What is not saved, or not restored, shows in what is saved next.
            if origin.cycle() < saved_at + 20 || origin.cycle().is_multiple_of(100) {
                assert!(origin.save() == restored.save(), "{what}: saved states differ in cycle {}", origin.cycle());
            }
        }
    }
}

/// A cycle is compared with the previous cycle, not with the last computed cycle.
#[test]
fn a_machine_that_is_set_back_continues_byte_for_byte() {
    let opens = |machine: &mut Machine| {
        let value = match machine.cycle() {
            120 => 1.0,
            130 => 0.0,
            _ => return,
        };
        let value = DatumValue::Real(value);
        machine.queue(Command::MachineDatum { target: "37140[XF]".to_owned(), value }).expect("a datum");
        machine.queue(Command::NewConf).expect("it is effective now");
    };
    for (back_at, ahead) in (115..140).flat_map(|cycle| [(cycle, 1), (cycle, 2), (cycle, 7)]) {
        let (mut back, mut never) = (machine(), machine());
        never.decide_always();
        while never.cycle() < 150 {
            opens(&mut back);
            opens(&mut never);
            if back.cycle() == back_at {
                let saved = back.save();
                for _ in 0..ahead {
                    back.step();
                }
                back.restore(&saved).expect("it was saved here");
            }
            step(&mut back);
            step(&mut never);
            let what = format!("from {ahead} cycles ahead back to {back_at}");
            assert_same(&never, &back, &what);
            // A saved state is a hundred times as long as a step: it is compared where it can differ.
            if (back_at..=back_at + 10).contains(&back.cycle()) || back.cycle() == 150 {
                assert!(never.save() == back.save(), "{what}: the saved states differ in cycle {}", never.cycle());
            }
        }
    }
}

#[test]
fn every_fault_is_saved_and_forked() {
    let faults = [
        FaultKind::DriveFault,
        FaultKind::EncoderFault { encoder: None },
        FaultKind::EncoderFault { encoder: Some(1) },
        FaultKind::Friction { by: 0.5 },
        FaultKind::Drift { by: 1e6 },
    ];
    for kind in faults {
        let mut origin = machine();
        run_to(&mut origin, 100);
        fault(&mut origin, "X", kind);
        run_to(&mut origin, 120);
        let mut restored = machine();
        restored.restore(&origin.save()).expect("it was saved on the same machine");
        let mut fork = origin.fork().expect("a closure over its state");
        while origin.cycle() < 700 {
            step(&mut origin);
            step(&mut restored);
            step(&mut fork);
            assert_same(&origin, &restored, &format!("{kind:?} restored"));
            assert_same(&origin, &fork, &format!("{kind:?} forked"));
        }
    }
}

#[test]
fn a_fork_continues_like_its_origin_and_does_not_affect_it() {
    let mut untouched = machine();
    let mut origin = machine();
    run_to(&mut untouched, 1_000);
    run_to(&mut origin, 1_000);
    let mut fork = origin.fork().expect("a closure over its state");
    let mut other = origin.fork().expect("a closure over its state");
    // The other fork gets different input.
    fault(&mut other, "X", FaultKind::Block);
    write(&mut other, "MB100", 1);
    let location = other.names().resolve(other.memory(), "XF.feed_stop").expect("a signal");
    other.queue(Command::Force { location, value: 1 }).expect("a force");
    while origin.cycle() < CYCLES {
        for machine in [&mut untouched, &mut origin, &mut fork, &mut other] {
            step(machine);
        }
        assert_same(&untouched, &origin, "the origin of a fork");
        assert_same(&untouched, &fork, "the fork");
    }
    assert!(untouched.memory() != other.memory(), "the other fork must differ");
}

#[test]
fn a_machine_rejects_the_state_of_another_program_and_stays_unchanged() {
    let mut origin = machine();
    run_to(&mut origin, 50);
    let saved = origin.save();
    let mut other = Machine::open("g1_example").expect("it is built in");
    let before = other.save();
    let problem = other.restore(&saved).expect_err("the machine has no program");
    assert!(problem.to_string().contains("delayed"), "{problem}");
    assert!(other.save() == before, "a rejected state must not change the machine");
}

#[test]
fn a_machine_rejects_damaged_bytes_and_stays_unchanged() {
    let mut machine = machine();
    run_to(&mut machine, 50);
    let saved = machine.save();
    for length in [0, 3, 4, 11, 12, saved.len() / 2, saved.len() - 1] {
        assert!(machine.restore(&saved[..length]).is_err(), "{length} bytes");
    }
    for place in (0..saved.len()).step_by(97) {
        let mut damaged = saved.clone();
        damaged[place] ^= 0x04;
        assert!(machine.restore(&damaged).is_err(), "byte {place}");
    }
    assert!(machine.save() == saved, "a rejected state must not change the machine");
}

/// The scenarios of the second control, each run by two machines. One of them is saved and restored in a third machine, or replaced by its
/// fork, again and again; at other moments power goes off and on. Homing, clearing, and programs that wait are among these moments.
#[test]
fn the_second_control_is_saved_forked_and_switched_off_at_any_moment() {
    let mut files = scenarios();
    files.retain(|file| file.components().any(|part| part.as_os_str().to_string_lossy().starts_with("isg_")));
    assert!(files.len() > 60);
    for file in files {
        let scenario = Scenario::read_cases(&file).expect("a scenario").remove(0);
        let open = || {
            let prepared = scenario.prepare(scenario.profiles[0], &Programs::ready()).expect("it can be used");
            prepared.into_operator()
        };
        let (mut origin, mut operator, _) = open();
        let (mut replaced, mut second, _) = open();
        let (mut spare, _, _) = open();
        loop {
            operator.act(&mut origin);
            second.act(&mut replaced);
            if *operator.state() != State::Acting {
                break;
            }
            origin.step();
            replaced.step();
            operator.look(&origin);
            second.look(&replaced);
            let what = format!("{}: saved, restored and forked", file.display());
            assert_same(&origin, &replaced, &what);
            origin.drain();
            replaced.drain();
            match origin.cycle() % 74 {
                17 => {
                    let saved = replaced.save();
                    assert!(saved == origin.save(), "{what}: saved states differ in cycle {}", origin.cycle());
                    spare.restore(&saved).expect("it was saved on the same machine");
                    std::mem::swap(&mut spare, &mut replaced);
                    replaced.drain();
                }
                54 => replaced = replaced.fork().expect("a program that can be forked"),
                _ => {}
            }
            if origin.cycle() % 101 == 7 {
                switch_off(&origin, &replaced, &format!("{}: power off and on", file.display()));
            }
        }
    }
}

/// Power off and on stops programs and coupling groups, in two machines alike.
fn switch_off(one: &Machine, other: &Machine, what: &str) {
    let mut forks = [one, other].map(|machine| machine.fork().expect("a program that can be forked"));
    for machine in &mut forks {
        machine.queue(Command::PowerOn).expect("power");
    }
    for _ in 0..40 {
        for machine in &mut forks {
            machine.drain();
            machine.step();
            let location = machine.names().resolve(machine.memory(), "channel_1.program_active").expect("a signal");
            assert_eq!(machine.memory().read(location), 0, "{what}, cycle {}", machine.cycle());
            assert!(machine.variables().channels.iter().all(|(_, channel)| channel.coupling_groups == 0), "{what}");
        }
        let [one, other] = &forks;
        assert_same(one, other, what);
    }
}
