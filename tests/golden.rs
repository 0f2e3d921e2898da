//! Runs every scenario of `golden/` and compares its trace with the golden trace, like `opennck test`, for `cargo test`.

use opennck::plc::Programs;

#[test]
fn every_scenario_passes_and_has_its_golden_trace() {
    opennck::golden::check(concat!(env!("CARGO_MANIFEST_DIR"), "/golden"), &Programs::ready());
}
