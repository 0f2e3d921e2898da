//! `opennck tune-limits` as users call it: the limits of a grouping from the movements of a scenario (EX-06).
#![cfg(feature = "cli")]

use std::fs;
use std::path::{Path, PathBuf};

use super::cli::{directory, err, opennck, out};
use opennck::plc::Programs;
use opennck::scenario::Scenario;

const SCENARIO: &str = "golden/worked_example/heavy_load.toml";

fn project() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The scenario with other steps and machine data, in a directory of its own.
fn changed(name: &str, change: impl Fn(String) -> String) -> PathBuf {
    let directory = directory(name);
    let text = fs::read_to_string(project().join(SCENARIO)).expect("the project has it");
    let text = text.replace("\"../../machine_data/g1_example\"", "\"g1_example\"");
    fs::write(directory.join("s.toml"), change(text)).expect("the target directory is writable");
    directory
}

/// EX-06: the arithmetic of the expected limits is in the scenario.
#[test]
fn the_limits_are_those_of_the_greatest_difference_under_load() {
    let output = opennck(&["tune-limits", SCENARIO, "--format", "json"], &project());
    assert_eq!((output.status.code(), err(&output).as_str()), (Some(0), ""), "{}", out(&output));
    let rows: serde_json::Value = serde_json::from_str(&out(&output)).unwrap();
    let row = &rows[0];
    assert_eq!(rows.as_array().unwrap().len(), 1);
    for (key, value) in [
        ("grouping", 1.0),
        ("MD37110", 0.527),
        ("MD37110 now", 0.0),
        ("MD37120", 0.58),
        ("MD37120 now", 1.0),
        ("MD37130", 100.0),
        ("MD37130 now", 100.0),
    ] {
        assert_eq!(row[key].as_f64(), Some(value), "{key}: {row}");
    }
    assert!((row["difference"].as_f64().unwrap() - 0.5263).abs() < 0.0005, "{row}");
    assert_eq!((row["synchronous"].as_str(), row["unit"].as_str()), (Some("XF"), Some("mm")));
    assert_eq!(row["checked"].as_bool(), Some(true));
}

/// EX-06: the control itself warns with a limit that is one step smaller, and not with the proposed one.
#[test]
fn the_message_appears_one_step_below_the_proposed_limit() {
    for (limit, warns) in [("0.526", true), ("0.527", false)] {
        let text = fs::read_to_string(project().join(SCENARIO)).unwrap();
        let data = format!("[machine_data]\n\"37110[X]\" = {limit}\n\"37110[XF]\" = {limit}\n");
        let text = text.replace("[machine_data]\n", &data);
        let scenario = Scenario::parse(&text, &project().join(SCENARIO)).unwrap();
        let prepared = scenario.prepare(scenario.profiles[0], &Programs::ready()).unwrap();
        let synchronised = prepared.machine().names().resolve(prepared.machine().memory(), "DB31.DBX101.5").unwrap();
        let warning = prepared.machine().names().resolve(prepared.machine().memory(), "DB33.DBX101.3").unwrap();
        let mut warned = false;
        let finished = prepared.run_with(None, &mut |machine| {
            let memory = machine.memory();
            warned |= memory.read(synchronised) != 0 && memory.read(warning) != 0;
        });
        assert_eq!((warned, finished.failure.is_none()), (warns, true), "{limit}");
    }
}

#[test]
fn margin_and_step_are_options() {
    let proposed = |options: &[&str]| {
        let output = opennck(&[&["tune-limits", SCENARIO, "--format", "json"], options].concat(), &project());
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        let rows: serde_json::Value = serde_json::from_str(&out(&output)).unwrap();
        ["MD37110", "MD37120", "MD37130"].map(|key| rows[0][key].to_string())
    };
    // 0.53 + 0.12 = 0.65, and in steps of 0.05: 0.55, 0.55 + 0.12 = 0.67, so 0.7.
    assert_eq!(proposed(&["--step", "0.01", "--margin", "0.12"]), ["0.53", "0.65", "100.0"]);
    assert_eq!(proposed(&["--step", "0.05", "--margin", "0.12"]), ["0.55", "0.7", "100.0"]);
    // Without a margin the trip limit is a step above, because the limits must differ (MON-16).
    assert_eq!(proposed(&["--margin", "0"]), ["0.527", "0.528", "100.0"]);
    for options in [["--margin", "-5%"], ["--margin", "much"], ["--step", "0"], ["--step", "nan"]] {
        let output = opennck(&[&["tune-limits", SCENARIO], &options[..]].concat(), &project());
        assert_eq!(output.status.code(), Some(2), "{options:?}");
        assert!(err(&output).contains("expected a "), "{}", err(&output));
    }
}

/// MON-16: MD37130 belongs to the proposal where it is not above MD37120.
#[test]
fn the_limit_before_synchronism_is_raised_where_the_order_asks_for_it() {
    let directory =
        changed("tune_order", |text| text.replace("[machine_data]\n", "[machine_data]\n\"37130[XF]\" = 0.2\n"));
    let output = opennck(&["tune-limits", "s.toml", "--format", "csv"], &directory);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    let row = out(&output).lines().nth(1).unwrap().to_owned();
    let cells: Vec<_> = row.split(',').collect();
    // Before synchronism: the same 5 % at 5000 mm/min are 0.2632 mm, less than MD37120 = 0.58. 0.58 * 1.1 = 0.638.
    assert_eq!(cells[6..12], ["0.527", "0", "0.58", "1", "0.638", "0.2"], "{row}");
}

#[test]
fn the_picture_has_the_curve_and_both_limits() {
    let directory = changed("tune_picture", |text| text);
    let output = opennck(&["tune-limits", "s.toml", "--svg", "d.svg"], &directory);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    assert!(out(&output).contains("checked: the scenario passes with these limits"), "{}", out(&output));
    let svg = fs::read_to_string(directory.join("d.svg")).unwrap();
    for text in ["MD37110 = 0.527", "MD37120 = 0.58", "XF.synchronism_difference: -0.526", "Rapid traverse"] {
        assert!(svg.contains(text), "{text}: {svg}");
    }
    // Two limits in two directions.
    assert_eq!(svg.matches("class=\"level\"").count(), 4, "{svg}");
    let output = opennck(&["tune-limits", "s.toml", "--svg", "s.toml"], &directory);
    assert_eq!(output.status.code(), Some(2));
}

/// A directory, a change of the scenario, the exit code and a text on standard error.
type Case<'a> = (&'a str, &'a dyn Fn(String) -> String, i32, &'a str);

#[test]
fn a_search_without_a_result_says_what_is_missing() {
    let cut = |text: String, from: &str| text[..text.find(from).unwrap()].to_owned();
    let no_gantry =
        |text: String| text.replace("[machine_data]\n", "[machine_data]\n\"37100[X]\" = 0\n\"37100[XF]\" = 0\n");
    let rests = |text: String| cut(text, "[[step]]\nnote = \"Rapid traverse");
    let never = |text: String| cut(text, "[[step]]\npulse = [\"X.traversing_key_plus\"]") + "[[step]]\nrun = \"1s\"\n";
    let fails = |text: String| text + "[[step]]\nexpect = \"alarm(10653)\"\n";
    let own = |text: String| text + "[[step]]\nmachine_data = { \"37110[XF]\" = 0.3 }\n[[step]]\nrun = \"1s\"\n";
    let cases: [Case<'_>; 5] = [
        (
            "tune_no_gantry",
            &no_gantry,
            2,
            "s.toml:2: expected a machine with a gantry grouping, found none in `g1_example`",
        ),
        ("tune_rests", &rests, 1, "gantry grouping 1 (X) does not move while it is synchronised"),
        ("tune_never", &never, 1, "gantry grouping 1 (X) is never synchronised"),
        (
            "tune_fails",
            &fails,
            1,
            "the search runs the scenario with MD37120 and MD37130 = 1000; it must pass with them",
        ),
        ("tune_own", &own, 2, "found one that changes 37110[XF] at "),
    ];
    for (name, change, code, text) in cases {
        let output = opennck(&["tune-limits", "s.toml"], &changed(name, change));
        assert_eq!(output.status.code(), Some(code), "{name}: {}{}", out(&output), err(&output));
        assert!(err(&output).contains(text) && out(&output).is_empty(), "{name}: {}", err(&output));
    }
}

/// A scenario that waits for 101.4 cannot pass with a warning limit above the differences: the proposal is not checked, and this is said.
#[test]
fn a_scenario_that_does_not_pass_with_the_limits_is_reported() {
    let directory = changed("tune_doubt", |text| text + "[[step]]\nexpect = \"count(alarm(10654)) == 1\"\n");
    let output = opennck(&["tune-limits", "s.toml"], &directory);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    assert!(out(&output).contains("0.527") && !out(&output).contains("checked:"), "{}", out(&output));
    assert!(err(&output).contains("not checked: the scenario does not pass with these limits"), "{}", err(&output));
}

/// The table in the page for commissioning engineers is that of the program.
#[test]
fn the_table_in_the_page_is_that_of_the_program() {
    let page = fs::read_to_string(project().join("docs/commissioning_engineer.md")).unwrap();
    let output = opennck(&["tune-limits", SCENARIO], &project());
    assert!(page.contains(&format!("```text\n{}```\n", out(&output))), "{}", out(&output));
    assert!(Path::new(SCENARIO).is_file());
}
