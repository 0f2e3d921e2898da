//! Every scenario of `golden/` holds, and its trace is the golden one; as `opennck test` does it, for `cargo test`.

use opennck::plc::Programs;

#[test]
fn every_scenario_holds_and_its_trace_is_the_golden_one() {
    opennck::golden::check(concat!(env!("CARGO_MANIFEST_DIR"), "/golden"), &Programs::ready());
}
