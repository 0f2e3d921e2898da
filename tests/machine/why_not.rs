//! The conditions of signals: in every golden scenario they agree with the signals, and what they name is what the control waits for.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::{BTreeMap, VecDeque};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use opennck::golden::{cases, scenario_files};
use opennck::image::{Location, Memory, Part, Writer};
use opennck::machine::{Machine, Subject, Tested};
use opennck::plc::Programs;
use opennck::scenario::{Operator, State};
use opennck::units::Time;

/// Every so many cycles all signals are checked, in addition to the cycles with an edge.
const SAMPLE: u64 = 250;

/// The number of cycles in which a signal follows when everything that is named for its next step holds: the enabling sequence takes
/// 3 steps of 2 cycles, and another step may precede it.
const PATIENCE: u64 = 16;

/// The bits of a machine that the control writes and for which it gives conditions.
fn bits(machine: &Machine) -> Vec<Location> {
    let (names, interface) = (machine.names(), machine.names().interface());
    let owners: Vec<_> = names.owners().map(|(_, block, number)| (block, number)).collect();
    let signals = interface.signals().filter(|signal| signal.writer == Writer::Nck && signal.kind.width() == 1);
    let all = signals.flat_map(|signal| {
        let own = owners.iter().filter(|(block, _)| *block == signal.block);
        own.filter_map(|(_, number)| interface.location(signal, *number)).collect::<Vec<_>>()
    });
    all.filter(|&location| machine.conditions(location, true).is_some()).collect()
}

/// A fact that does not hold although everything that is named for its next step holds.
fn stuck(tested: &Tested) -> bool {
    match &tested.what {
        Subject::Fact { .. } => {
            !tested.holds && !tested.parts.is_empty() && tested.parts.iter().all(|part| part.holds)
                || tested.parts.iter().any(stuck)
        }
        Subject::All | Subject::Any => tested.parts.iter().any(stuck),
        Subject::Signal(..) => false,
    }
}

/// The signals of a tree, with the value that is found.
fn leaves(tested: &Tested) -> Vec<(Location, bool)> {
    match tested.what {
        Subject::Signal(location, wanted) => vec![(location, tested.holds == wanted)],
        Subject::Fact { .. } | Subject::All | Subject::Any => tested.parts.iter().flat_map(leaves).collect(),
    }
}

struct Check {
    scenario: String,
    /// The memories of the cycles that the control has not read yet, with the one that it has read last (O-28).
    memories: VecDeque<Memory>,
    bits: Vec<Location>,
    /// What is stuck, since which cycle.
    stuck: BTreeMap<(Location, bool), u64>,
    wrong: Findings,
}

/// Findings by symbol, the value that is wanted, and their kind: one of each is enough.
type Findings = BTreeMap<(String, bool, &'static str), String>;

impl Check {
    fn find(&mut self, machine: &Machine, bit: Location, wanted: bool, what: &'static str, tested: &Tested) {
        let symbol = machine.names().symbol(bit).unwrap_or_default();
        let name = symbol.rsplit('.').next().unwrap_or_default().to_owned();
        let (scenario, time) = (&self.scenario, machine.time());
        let text = format!("{scenario} at {time}: {symbol} to {wanted}: {what}: {tested:?}");
        self.wrong.entry((name, wanted, what)).or_insert(text);
    }

    fn look(&mut self, machine: &Machine) {
        for bit in self.bits.clone() {
            let value = machine.memory().read(bit) != 0;
            for wanted in [false, true] {
                let tested = machine.conditions(bit, wanted).expect("it has conditions");
                let key = (bit, wanted);
                if tested.holds != (value == wanted) {
                    self.find(machine, bit, wanted, "the conditions contradict the signal", &tested);
                }
                for (location, found) in leaves(&tested) {
                    let is_late = location.part == Part::ToNck;
                    let memory = self.memories.front().filter(|_| is_late).unwrap_or_else(|| machine.memory());
                    if (memory.read(location) != 0) != found {
                        self.find(machine, bit, wanted, "a condition is not what the control has read", &tested);
                    }
                }
                if value == wanted || !stuck(&tested) {
                    self.stuck.remove(&key);
                    continue;
                }
                let since = *self.stuck.entry(key).or_insert_with(|| machine.cycle());
                if machine.cycle() - since > PATIENCE {
                    self.find(machine, bit, wanted, "nothing holds the signal back, and it does not follow", &tested);
                }
            }
        }
    }
}

/// `delay`: the cycles until the control reads a byte of the PLC.
fn follow(mut machine: Machine, mut operator: Operator, scenario: String, delay: usize) -> Findings {
    let (bits, stuck, wrong) = (bits(&machine), BTreeMap::new(), Findings::new());
    let memories = std::iter::repeat_n(machine.memory().clone(), delay).collect();
    let mut check = Check { scenario, memories, bits, stuck, wrong };
    loop {
        operator.act(&mut machine);
        if *operator.state() != State::Acting {
            return check.wrong;
        }
        machine.step();
        operator.look(&machine);
        if delay > 0 {
            check.memories.push_back(machine.memory().clone());
            check.memories.drain(..check.memories.len().saturating_sub(delay + 1));
        }
        let phase = machine.cycle() % SAMPLE;
        // What is stuck in a sample must not be stuck some cycles later. An edge is a sample, too.
        if phase == 0 || phase == PATIENCE + 1 || !machine.recorder().rows().is_empty() {
            check.look(&machine);
        }
        machine.drain();
    }
}

/// Follows the files that no other thread has taken.
fn follow_files(root: &Path, files: &[PathBuf], next: &AtomicUsize) -> Findings {
    let programs = Programs::ready();
    let mut wrong = Findings::new();
    while let Some(file) = files.get(next.fetch_add(1, Ordering::Relaxed)) {
        let name = file.strip_prefix(root).unwrap_or(file).display().to_string();
        for case in cases(file).unwrap() {
            let prepared = case.scenario.prepare(case.profile, &programs).unwrap();
            let (machine, operator, _) = prepared.into_operator();
            let text = std::fs::read_to_string(file).unwrap();
            let delay = text.lines().find_map(|line| line.strip_prefix("to_nck_delay")?.split('"').nth(1));
            let delay = delay.map_or(0, |delay| Time::parse(delay).unwrap().in_cycles(machine.cycle_time()));
            wrong.extend(follow(machine, operator, name.clone(), usize::try_from(delay).unwrap()));
        }
    }
    wrong
}

#[test]
fn conditions_have_the_value_of_their_signal_and_name_what_it_waits_for() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = scenario_files(&[root.join("golden")]).unwrap();
    let next = AtomicUsize::new(0);
    // The longest test of all: each processor takes the next file.
    let wrong = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..std::thread::available_parallelism().map_or(1, usize::from))
            .map(|_| scope.spawn(|| follow_files(root, &files, &next)))
            .collect();
        threads.into_iter().flat_map(|thread| thread.join().unwrap()).collect::<Findings>()
    });
    assert!(
        wrong.is_empty(),
        "{} findings\n{}",
        wrong.len(),
        wrong.values().map(String::as_str).collect::<Vec<_>>().join("\n")
    );
}

/// The limit in effect, its datum, and what it counts from (E-14).
#[test]
fn the_limits_of_the_difference_are_those_in_effect() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let file = root.join("golden/monitoring/base_after_synchronism_was_lost.toml");
    let scenario = opennck::scenario::Scenario::read(&file).unwrap();
    let unmonitored = "the difference of XF is monitored: the grouping is closed and not in follow-up: no, wanted yes";
    for (milliseconds, bit, words) in [
        (7_900, 2, "synchronism difference of XF: 0.000000, wanted above 0.500000 (MD37120)"),
        (7_900, 3, "synchronism difference of XF: 0.000000, wanted above 0.200000 (MD37110)"),
        (8_100, 2, unmonitored),
        (8_100, 3, unmonitored),
        (8_270, 2, "distance of XF from its base 1.000000: 0.200000, wanted above 0.500000 (MD37120)"),
        (8_270, 3, "distance of XF from its base 1.000000: 0.200000, wanted above 0.200000 (MD37110)"),
        (8_274, 3, "distance of XF from its base 1.000000: 0.200100, wanted not above 0.200000 (MD37110)"),
    ] {
        let prepared = scenario.prepare(scenario.profiles[0], &Programs::ready()).unwrap();
        let finished = prepared.run_until(Some(Time::from_millis(milliseconds)));
        let tree = finished.session().why_not(&format!("DB33.DBX101.{bit}"), false).unwrap();
        assert!(tree.contains(words), "{milliseconds} ms, {words} in {tree}");
    }
}

/// What NC start tests beside signals; another channel can start a program, too. REF waits for the end of a program (16914).
#[test]
fn a_start_and_ref_name_what_they_wait_for() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let running = "CHAN1.program_state_running";
    let restored = "encoders/start_with_restored_position";
    let started = "channels/wait_directly_behind_start";
    for (name, milliseconds, signal, words) in [
        (restored, 30, running, "mode_group_1.active_mode_automatic"),
        (restored, 50, running, "axes of CHAN1 that are neither referenced nor restored (MD20700 = 2): Y, wanted none"),
        (restored, 98, running, "CHAN1.nc_start"),
        (started, 36, "CHAN2.program_state_running", "selected program of CHAN2: none, wanted one"),
        (started, 36, "CHAN2.program_state_running", "START(2) in the program of another channel: none, wanted one"),
        (started, 100, running, "wait of CHAN1: for the end of programs of other channels, wanted none"),
        (
            "channels/reference_while_a_program_is_stopped",
            254,
            "mode_group_1.active_machine_function_ref",
            "program of mode group 1 that has not ended: CHAN1, wanted none",
        ),
    ] {
        let scenario = opennck::scenario::Scenario::read(&root.join(format!("golden/{name}.toml"))).unwrap();
        let prepared = scenario.prepare(scenario.profiles[0], &Programs::ready()).unwrap();
        let finished = prepared.run_until(Some(Time::from_millis(milliseconds)));
        let tree = finished.session().why_not(signal, false).unwrap();
        assert!(tree.contains(words), "{name} {milliseconds} ms, {words} in {tree}");
    }
    let overridden = opennck::scenario::Scenario::read(&root.join("golden/overlay/handwheel_override_of_an_axis.toml"));
    let prepared = overridden.unwrap().prepare(opennck::image::Profile::default(), &Programs::ready()).unwrap();
    let finished = prepared.run_until(Some(Time::from_millis(60)));
    // 20080: the block with FDA runs, and no handwheel is assigned.
    let expected = "    0.060  Y.handwheel_override_active (DB32.DBX62.1) is 0 (no), because
             ✗ one of
               ✗ Y.activate_handwheel_1 (DB32.DBX4.0) = 0, wanted 1: never changed
               ✗ Y.activate_handwheel_2 (DB32.DBX4.1) = 0, wanted 1: never changed
               ✗ Y.activate_handwheel_3 (DB32.DBX4.2) = 0, wanted 1: never changed
               ✗ handwheel that the HMI selects for Y: none, wanted one
";
    assert_eq!(finished.session().why_not("Y.handwheel_override_active", false).unwrap(), expected);
    let mut session = opennck::scenario::Session::open("portal").unwrap();
    session.set("DB11.DBX0.1", 1).unwrap();
    session.run("100ms").unwrap();
    let tree = session.why_not(running, false).unwrap();
    assert!(tree.contains("block entered in MDA of CHAN1: none, wanted one"), "{tree}");
}

/// What ends a state is named, not only that it is to end.
#[test]
fn a_state_ends_with_what_is_named() {
    let mut session = opennck::scenario::Session::open("portal").unwrap();
    session = session.with_program(opennck::plc::enable_all().boxed());
    session.wait("X.position_controller_active", "1s").unwrap();
    session.set("mode_group_1.mode_automatic", 1).unwrap();
    session.nc("N10 G1 X100 F1000\nM30", 1).unwrap();
    session.run("1cycles").unwrap();
    session.pulse("CHAN1.nc_start").unwrap();
    session.run("100ms").unwrap();
    for (signal, words) in [
        ("CHAN1.program_state_running", "CHAN1.nc_stop (DB21.DBX7.3) = 0, wanted 1"),
        ("CHAN1.program_state_running", "next block of CHAN1: N10, runs, wanted M2 or M30"),
        ("CHAN1.program_state_interrupted", "mode_group_1.active_mode_jog (DB11.DBX6.2) = 0, wanted 1"),
        ("CHAN1.m0_m1_active", "next block of CHAN1: N10, runs, wanted one with M0 or M1"),
        ("CHAN1.block_search_active", "order of a block search of CHAN1: none, wanted one"),
        ("mode_group_1.active_mode_automatic", "mode_group_1.mode_jog (DB11.DBX0.2) = 0, wanted 1"),
        ("X.axis_replacement_possible", "next block of CHAN1: N10, runs, wanted one that does not use the axis"),
        ("Y.neutral_axis", "next block of CHAN1: N10, runs, wanted one that releases the axis (RELEASE, WAITP)"),
        ("Y.plc_axis", "Y.request_plc_axis (DB32.DBX8.7) = 0, wanted 1"),
    ] {
        let tree = session.why_not(signal, false).unwrap();
        assert!(tree.contains(words), "{signal}, {words} in {tree}");
    }
}

/// The tree in the page for commissioning engineers is that of the program.
#[test]
fn the_tree_in_the_page_is_that_of_the_program() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("docs/commissioning_engineer.md")).unwrap();
    let (_, block) = page.split_once("```text\n    0.004  ").unwrap();
    let (block, _) = block.split_once("```").unwrap();
    let block = format!("    0.004  {block}");
    let file = root.join("golden/worked_example/gantry_references_and_synchronises.toml");
    let scenario = opennck::scenario::Scenario::read(&file).unwrap();
    let prepared = scenario.prepare(scenario.profiles[0], &Programs::ready()).unwrap();
    let finished = prepared.run_until(Some(Time::from_millis(4)));
    let tree = finished.session().why_not("X.position_controller_active", false).unwrap();
    assert!(tree.starts_with(&block), "{tree}");
}
