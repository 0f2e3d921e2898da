//! Tests of the memory of a long scenario: a generated one can have 100,000 steps.

use std::path::Path;

use opennck::plc::Programs;
use opennck::scenario::Scenario;

/// The most that a step may take on the average: its text, what it needs to run, and its changes in the trace.
const BYTES: u64 = 300;
/// The number of steps that are measured.
const STEPS: u64 = 10_000;

/// The bytes that are in use when this number of steps has run.
fn in_use(part: &str, steps: u64) -> u64 {
    let mut text = "machine = \"g1_example\"\nplc = \"enable_all\"\nlimit = \"1h\"\n".to_owned();
    for index in 0..steps / part.matches("[[step]]").count() as u64 {
        text += &part.replace("{bit}", &(index % 2).to_string());
    }
    let mut ready = None;
    let allocated = allocation_counter::measure(|| {
        let scenario = Scenario::parse(&text, Path::new("long.toml")).expect("a scenario");
        let prepared = scenario.prepare(scenario.profiles[0], &Programs::ready()).expect("it can run");
        ready = Some((scenario, prepared));
    });
    let (_scenario, prepared) = ready.expect("it is prepared");
    let finished = prepared.run();
    assert!(finished.failure.is_none(), "{:?}", finished.failure);
    allocated.bytes_current.unsigned_abs() + finished.session().trace().bytes() as u64
}

#[test]
fn a_step_of_a_long_scenario_takes_less_than_300_bytes() {
    for part in [
        "[[step]]\nrun = \"1cycle\"\n",
        "[[step]]\nset = { \"M0.0\" = {bit} }\n[[step]]\nrun = \"1cycle\"\n",
        "[[step]]\npulse = \"M0.0\"\nfor = \"1cycle\"\n",
        "[[step]]\nexpect = \"M0.0 == 0\"\n",
        "[[step]]\nwait = \"M0.0 == 0\"\n",
        "[[step]]\nimage = { \"MB0\" = 0 }\n",
    ] {
        let bytes = (in_use(part, STEPS) - in_use(part, 2)) / (STEPS - 2);
        assert!(bytes < BYTES, "{bytes} bytes: {part}");
        println!("{bytes} bytes: {part}");
    }
}
