//! Random programs with random interventions: nothing panics, no axis exceeds its limits, and RESET always ends the program.

use proptest::prelude::*;

use super::{automatic, prepare, start};
use opennck::machine::Machine;
use opennck::plc::enable_all;
use opennck::scenario::Session;

/// Blocks and parts of blocks.
fn block() -> impl Strategy<Value = String> {
    let axis = prop::sample::select(vec!["X", "Y", "Z", "A"]);
    let move_to = (prop::sample::select(vec!["G0", "G1", ""]), axis.clone(), -50..50_i32, axis, -50..50_i32).prop_map(
        |(function, first, to, second, other)| {
            if first == second {
                format!("{function} {first}{to}")
            } else {
                format!("{function} {first}{to} {second}{other}")
            }
        },
    );
    let circle = (2..=3_i32, -20..20_i32, -20..20_i32, 1..40_i32)
        .prop_map(|(function, x, y, radius)| format!("G91 G{function} X{x} Y{y} CR={radius}\nG90 G1"));
    let others = prop::sample::select(vec![
        "G64",
        "G60",
        "G91",
        "G90",
        "F500",
        "F12000",
        "M8",
        "M7 M9",
        "S100 M3",
        "T1 D1 M6",
        "G4 F0.05",
        "POS[Z]=IC(3)",
        "POSA[A]=IC(20)",
        "WAITP(A)",
        "STOPRE",
        "R1=R1+1",
        "G9 X=IC(2)",
        "M0",
        "M1",
        "G53 X0",
        "TRANS X1",
        "TRANS",
        "/X=IC(1)",
        "R1=$AA_IM[X]",
        "IF R1>3\nR1=0\nENDIF",
        "X2=1",
        "FOO",
        "SETAL(65001)",
        "G601",
        "G603",
        "MSG(\"A\")",
    ])
    .prop_map(str::to_owned);
    prop_oneof![4 => move_to, 1 => circle, 4 => others]
}

/// Signals of the PLC that are set for some cycles.
fn intervention() -> impl Strategy<Value = (&'static str, u32, u32)> {
    let signals = vec![
        "CHAN1.nc_start",
        "CHAN1.nc_stop",
        "CHAN1.nc_stop_at_block_limit",
        "CHAN1.read_in_disable",
        "CHAN1.feed_disable",
        "CHAN1.delete_distance_to_go",
        "CHAN1.activate_single_block",
        "CHAN1.channel_reset",
        "CHAN1.activate_dry_run_feedrate",
        "X.feed_stop",
        "Y.feed_stop",
        "mode_group_1.mode_jog",
        "Y.traversing_key_plus",
        "nck.emergency_stop",
    ];
    (prop::sample::select(signals), 1..40_u32, 1..120_u32)
}

/// The largest velocity and acceleration of the setpoints, in units per second: MD32000 and MD32300 of X, Y, Z with MD32310 = 1.2, the
/// emergency ramp of MD36610 = 0.05 s, and some increments of rounding.
fn within_limits(session: &Session, before: &mut [(f64, f64); 3]) {
    for (axis, (position, velocity)) in ["X", "Y", "Z"].iter().zip(before) {
        let now = session.value(&format!("{axis}.setpoint")).unwrap();
        let new = (now - *position) / 0.002;
        if session.value(&format!("{axis}.position_controller_active")).unwrap() == 0.0 {
            // In follow-up the setpoint is the actual value.
            (*position, *velocity) = (now, 0.0);
            continue;
        }
        assert!(new.abs() <= 20_000.0 / 60.0 * 1.01 + 0.1, "{axis} moves with {new} mm/s\n{}", session.text());
        let change = (new - *velocity).abs() / 0.002;
        assert!(change <= 7_000.0, "{axis} changes its velocity by {change} mm/s²\n{}", session.text());
        (*position, *velocity) = (now, new);
    }
}

/// The trace of the same run on a machine that decides about every axis in every cycle.
fn always_deciding(nc: &str, interventions: &[(&'static str, u32, u32)]) -> String {
    let mut machine = Machine::open("machine_data/portal").unwrap();
    machine.decide_always();
    machine.load_program(enable_all().boxed());
    let mut session = Session::new(machine);
    prepare(&mut session, nc);
    start(&mut session);
    for (signal, length, pause) in interventions {
        session.set(signal, 1).unwrap();
        session.run(&format!("{length}cycles")).unwrap();
        session.set(signal, 0).unwrap();
        session.run(&format!("{pause}cycles")).unwrap();
    }
    session.text()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_program_with_any_interventions_keeps_the_limits(
        blocks in prop::collection::vec(block(), 1..25),
        interventions in prop::collection::vec(intervention(), 0..12),
    ) {
        let nc = format!("F2000\n{}\nM30", blocks.join("\n"));
        let mut session = automatic(&nc);
        start(&mut session);
        let read = |session: &Session, axis: &str| session.value(&format!("{axis}.setpoint")).unwrap();
        let mut before = ["X", "Y", "Z"].map(|axis| (read(&session, axis), 0.0));
        let mut cycle = |session: &mut Session| {
            session.run("1cycles").unwrap();
            within_limits(session, &mut before);
        };
        for &(signal, length, pause) in &interventions {
            session.set(signal, 1).unwrap();
            (0..length).for_each(|_| cycle(&mut session));
            session.set(signal, 0).unwrap();
            (0..pause).for_each(|_| cycle(&mut session));
        }
        let text = session.text();
        prop_assert_eq!(&text, &always_deciding(&nc, &interventions), "an axis rests that must not");
        // Whatever has happened: RESET ends it.
        session.set("nck.acknowledge_emergency_stop", 1).unwrap();
        session.set("mode_group_1.mode_group_reset", 1).unwrap();
        (0..400).for_each(|_| cycle(&mut session));
        session.expect_all(&["CHAN1.program_state_aborted", "CHAN1.channel_state_reset"]).unwrap();
    }
}
