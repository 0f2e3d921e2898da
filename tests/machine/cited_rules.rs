//! Tests of what belongs to scenarios: the rules that they cite, the alarms in their traces, their golden files.
#![cfg(feature = "cli")]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;

use crate::cli::{directory, err, opennck, out};

#[test]
fn a_scenario_cites_rules_that_exist_or_ids_of_the_user() {
    let directory = directory("cited_rules");
    let run = |covers: &str| {
        let text = format!("title = \"A\"\nmachine = \"g1_example\"\ncovers = [{covers}]\n[[step]]\nrun = \"10ms\"\n");
        fs::write(directory.join("s.toml"), text).unwrap();
        opennck(&["run", "s.toml"], &directory)
    };
    assert_eq!(run("\"REF-02\", \"O-30\", \"SPEC-12\"").status.code(), Some(0));
    let refused = run("\"REF-02\",\n \"REF-99\"");
    assert_eq!(refused.status.code(), Some(2));
    let text = err(&refused);
    assert!(text.contains("s.toml:4: expected the ID of a rule or a decision, found `REF-99`"), "{text}");
    assert!(text.contains("did you mean `REF-") && text.contains("`opennck rule REF-` lists"), "{text}");
}

#[test]
fn golden_files_without_a_case_are_named_and_those_of_scenarios_that_run_are_removed() {
    let directory = directory("golden_files_without_a_case");
    let golden = directory.join("golden");
    fs::create_dir(&golden).unwrap();
    let scenario = "title = \"A\"\nmachine = \"g1_example\"\n[[step]]\nrun = \"10ms\"\n";
    for name in ["a.toml", "a.b.toml"] {
        fs::write(golden.join(name), scenario).unwrap();
    }
    assert_eq!(opennck(&["test", "golden", "--accept"], &directory).status.code(), Some(0));
    let own = fs::read_to_string(golden.join("a.snap")).unwrap();
    for name in ["a@1.snap", "gone.snap"] {
        fs::write(golden.join(name), &own).unwrap();
    }
    fs::write(golden.join("a@2.snap"), "---\nsource: tests/a.rs\n---\nof another program\n").unwrap();
    let output = opennck(&["test", "golden"], &directory);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    let expected = format!("2 golden files belong to no case: {}, {};", "golden/a@1.snap", "golden/gone.snap");
    assert!(err(&output).replace('\\', "/").contains(&expected), "{}", err(&output));
    // One file: only what has its name; the golden file of the other scenario is not one of it.
    let output = opennck(&["test", "golden/a.toml"], &directory);
    assert!(err(&output).contains("1 golden file belongs to no case: golden/a@1.snap;"), "{}", err(&output));
    let output = opennck(&["test", "golden", "--accept", "--filter", "a.b.toml"], &directory);
    assert!(golden.join("a@1.snap").exists(), "{}", out(&output));
    let output = opennck(&["test", "golden", "--accept"], &directory);
    assert!(out(&output).contains("removed  golden/a@1.snap"), "{}", out(&output));
    let kept = ["a.snap", "a.b.snap", "gone.snap", "a@2.snap"].map(|name| golden.join(name).exists());
    assert_eq!((golden.join("a@1.snap").exists(), kept), (false, [true; 4]));
    assert!(err(&output).contains("1 golden file belongs to no case: golden/gone.snap;"), "{}", err(&output));
    // A scenario that cannot be read: nothing is known about its golden files.
    fs::write(golden.join("a.toml"), "title = \n").unwrap();
    let output = opennck(&["test", "golden"], &directory);
    assert!(!err(&output).contains("a.snap") && err(&output).contains("gone.snap"), "{}", err(&output));
}

#[test]
fn an_alarm_lists_the_scenarios_whose_traces_have_it() {
    let directory = directory("scenarios_of_an_alarm");
    let output = opennck(&["rule", "10653"], &directory);
    assert!(out(&output).contains("\n  golden/monitoring/"), "{}", out(&output));
}
