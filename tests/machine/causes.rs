//! In every golden scenario, the causes of all signals of the control and of all alarms are correct, without exceptions: each input had the
//! value in the cause, in the cycle of the edge, and each length and velocity was that of the axis.

use std::path::Path;

use opennck::golden::{cases, scenario_files};
use opennck::machine::FaultKind;
use opennck::plc::{Programs, program};
use opennck::scenario::Session;
use opennck::trace::{CauseFault, CauseFinding, Watch};

fn findings(session: &Session) -> Vec<CauseFinding> {
    session.trace().check_causes(session.machine(), &Watch::default())
}

#[test]
fn every_cause_in_the_golden_scenarios_is_correct() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let programs = Programs::ready();
    let mut wrong = Vec::new();
    for file in scenario_files(&[root.join("golden")]).unwrap() {
        for case in cases(&file).unwrap() {
            let finished = case.scenario.prepare(case.profile, &programs).unwrap().measure_causes().run();
            let name = file.strip_prefix(root).unwrap_or(&file).display().to_string();
            wrong.extend(findings(finished.session()).iter().map(|finding| format!("{name}: {finding}")));
        }
    }
    assert!(wrong.is_empty(), "{} causes are wrong\n{}", wrong.len(), wrong[..wrong.len().min(20)].join("\n"));
}

/// The chain of causes of the last edge of a signal.
fn chain(session: &Session, signal: &str) -> String {
    let machine = session.machine();
    let location = machine.names().resolve(machine.memory(), signal).expect("a signal");
    session.trace().why(location, machine.time(), machine).expect("an edge")
}

/// A gantry whose axes have all enables.
fn gantry() -> Session {
    let plc = program("everything_on", (), |(), io| {
        for axis in io.axes() {
            io.to_nck.axis(axis).set_position_measuring_system_1(true);
            io.to_nck.axis(axis).set_controller_enable(true);
            io.to_nck.axis(axis).set_pulse_enable(true);
        }
    });
    Session::open("g1_example").expect("a built-in machine").with_program(plc.boxed())
}

#[test]
fn edges_name_the_machine_data_the_fault_and_the_power_on_that_they_follow_from() {
    let mut gantry = gantry();
    gantry.watch(&["X.axis_stationary", "X.drive_ready", "X.traverse_command_minus"]).unwrap();
    gantry.set("X.traversing_key_minus", 1).unwrap();
    gantry.wait("X.axis_stationary == 0 && X.velocity < -1990", "5s").unwrap();
    // 33.3 mm/s at 1 m/s²: the setpoints rest after 34 ms, and the slide still runs out.
    gantry.set("X.feed_stop", 1).unwrap();
    gantry.run("40ms").unwrap();
    gantry.expect("X.axis_stationary == 0 && X.velocity < -100").unwrap();
    // MD36060 (NEWCONF): the limit of "axis stationary" is now above the velocity, which is negative in the cause, too.
    gantry.machine_data("36060[X]", 100_000.0).unwrap();
    gantry.new_conf().unwrap();
    gantry.wait("X.axis_stationary", "100ms").unwrap();
    let why = chain(&gantry, "X.axis_stationary");
    assert!(why.contains("X.velocity = -") && why.contains("MD36060[X] = 100000"), "{why}");
    assert!(why.contains("after O-23: machine data became active, MD36060[X] = 100000"), "{why}");
    assert!(why.contains("after O-23: set machine data active"), "{why}");
    gantry.fault("X", FaultKind::DriveFault).unwrap();
    gantry.wait("X.drive_ready == 0", "100ms").unwrap();
    let why = chain(&gantry, "X.drive_ready");
    assert!(why.contains("after fault: a fault begins, drive_fault  [X]"), "{why}");
    gantry.clear_fault("X", FaultKind::DriveFault).unwrap();
    gantry.wait("X.drive_ready", "5s").unwrap();
    let why = chain(&gantry, "X.drive_ready");
    assert!(why.contains("after fault: a fault ends, drive_fault  [X]"), "{why}");
    gantry.power_on().unwrap();
    gantry.wait("X.drive_ready == 0", "1s").unwrap();
    gantry.wait("X.drive_ready", "5s").unwrap();
    let why = chain(&gantry, "X.drive_ready");
    assert!(why.contains("after power on: power was switched on"), "{why}");
    let text = gantry.text();
    for row in ["MD36060 = 100000", "set MD active", "fault drive_fault", "power "] {
        assert!(text.contains(row), "{row}\n{text}");
    }
}

/// O-28: with `to_nck_delay` a key that the PLC has already released is still pressed for the control, and its cause is true.
#[test]
fn causes_are_compared_with_what_the_control_read() {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("causes_delay.toml");
    let scenario = "title = \"t\"\nmachine = \"g1_example\"\nplc = \"enable_all\"\n[plant.machine]\nto_nck_delay = \"20ms\"\n\
        [[step]]\nrun = \"300ms\"\n[[step]]\npulse = [\"Y.traversing_key_plus\"]\nfor = \"10ms\"\n\
        [[step]]\nexpect = [\"!Y.traversing_key_plus\", \"!Y.traverse_command_plus\"]\n\
        [[step]]\nwait = \"Y.traverse_command_plus\"\nwithin = \"20ms\"\n[[step]]\nrun = \"300ms\"\n";
    std::fs::write(&file, scenario).unwrap();
    let [case] = &cases(&file).unwrap()[..] else { panic!("one case") };
    let prepared = case.scenario.prepare(case.profile, &Programs::ready()).unwrap();
    let finished = prepared.measure_causes().run();
    assert_eq!(finished.failure, None);
    assert_eq!(findings(finished.session()), []);
    // The same trace without what the control read: the cause seems to name a key that is not pressed.
    let unmeasured = case.scenario.prepare(case.profile, &Programs::ready()).unwrap().run();
    let [finding, ..] = &findings(unmeasured.session())[..] else { panic!("a finding") };
    assert_eq!(finding.fault, CauseFault::Untrue("Y.traversing_key_plus".to_owned(), 1, 0), "{finding}");
}

/// The chain of 61.5 leads to the last of its conditions that became true, not only to a controller enable that was always there.
#[test]
fn position_control_names_what_let_it_go_on() {
    let mut gantry = gantry();
    gantry.watch(&["X.position_controller_active", "X.speed_controller_active"]).unwrap();
    gantry.wait("X.position_controller_active", "1s").unwrap();
    let why = chain(&gantry, "X.position_controller_active");
    assert!(why.contains("after O-20: pulses enabled"), "{why}");
    gantry.set("nck.emergency_stop", 1).unwrap();
    gantry.wait("!X.position_controller_active", "3s").unwrap();
    gantry.set("nck.emergency_stop", 0).unwrap();
    gantry.run("200ms").unwrap();
    gantry.set("nck.acknowledge_emergency_stop", 1).unwrap();
    gantry.set("mode_group_1.mode_group_reset", 1).unwrap();
    gantry.wait("X.position_controller_active", "1s").unwrap();
    for signal in ["X.position_controller_active", "X.speed_controller_active"] {
        let why = chain(&gantry, signal);
        assert!(why.contains("after E-06: emergency stop acknowledged"), "{why}");
    }
}
