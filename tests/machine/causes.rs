//! In every golden scenario, the causes of the most important signals are correct: each input had the value in the cause, in the cycle of
//! the edge.

use std::path::Path;

use opennck::golden::{cases, scenario_files};
use opennck::plc::Programs;
use opennck::scenario::Session;
use opennck::trace::{CauseFinding, Watch};

/// DBX60.6, 60.7, 61.4 to 61.7, 64.4 to 64.7, 93.5, 93.7 and 101.x of the axes, DBX35.x of the channels.
const CHECKED: &[&str] = &[
    "*.position_reached_exact_stop_coarse",
    "*.position_reached_exact_stop_fine",
    "*.axis_stationary",
    "*.position_controller_active",
    "*.speed_controller_active",
    "*.current_controller_active",
    "*.traverse_request_*",
    "*.traverse_command_*",
    "*.drive_ready",
    "*.pulses_enabled",
    "*.gantry_*",
    "*.channel_state_*",
    "*.program_state_*",
];

fn findings(session: &Session) -> Vec<CauseFinding> {
    let machine = session.machine();
    let watch = Watch::parse(CHECKED, machine.names(), machine.memory()).expect("the tables have these signals");
    session.trace().check_causes(machine, &watch)
}

#[test]
fn every_cause_in_the_golden_scenarios_is_correct() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let programs = Programs::ready();
    let mut wrong = Vec::new();
    for file in scenario_files(&[root.join("golden")]).unwrap() {
        for case in cases(&file).unwrap() {
            let finished = case.scenario.prepare(case.profile, &programs).unwrap().run();
            let name = file.strip_prefix(root).unwrap_or(&file).display();
            wrong.extend(findings(finished.session()).iter().map(|finding| format!("{name}: {finding}")));
        }
    }
    assert!(wrong.is_empty(), "{} causes are wrong\n{}", wrong.len(), wrong[..wrong.len().min(20)].join("\n"));
}
