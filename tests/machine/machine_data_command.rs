//! Tests of `opennck machine-data`: mistyped data, the machine of a scenario, the list; and of what a scenario changes in the plant.
#![cfg(feature = "cli")]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;

use crate::cli::{directory, err, opennck, out};

/// The lines of a command's output that start with a text.
fn lines<'a>(output: &'a str, start: &str) -> Vec<&'a str> {
    output.lines().filter(|line| line.starts_with(start)).collect()
}

#[test]
fn a_mistyped_datum_is_a_finding_that_ends_with_1() {
    let directory = directory("mistyped_data");
    fs::create_dir(directory.join("m")).unwrap();
    fs::write(directory.join("m/a.tea"), "N32000 $MA_MAX_AX_VELO[X1]=1000\nN36901 $MA_SAFE_FUNCTION_ENABLE[X1]=0\n")
        .unwrap();
    let check = || opennck(&["machine-data", "check", "m"], &directory);
    let output = check();
    assert_eq!(output.status.code(), Some(0), "a datum beside the catalogue: {}", out(&output));
    fs::write(directory.join("m/b.tea"), "$MA_MAX_AX_VEL0[X1]=5000\n").unwrap();
    let output = check();
    assert_eq!(output.status.code(), Some(1), "{}{}", out(&output), err(&output));
    let expected = "\nunknown, perhaps mistyped: 1\n  m/b.tea:1: unknown: $MA_MAX_AX_VEL0[X1] = 5000: ";
    assert!(
        out(&output).contains(expected) && out(&output).contains("did you mean `MAX_AX_VELO`?"),
        "{}",
        out(&output)
    );
    fs::write(directory.join("m/b.tea"), "N32000=5\n").unwrap();
    assert_eq!(check().status.code(), Some(2));
}

#[test]
fn a_machine_is_checked_as_a_scenario_changes_it() {
    let directory = directory("machine_of_a_scenario");
    let scenario = "title = \"A\"\nmachine = \"g1_example\"\n[machine_data]\n\"34070[X]\" = 0\n\"34000[Y]\" = 0\n[plant.Y]\ncam = { from = 1.0, to = 5.0 }\n\
        [[step]]\nrun = \"10ms\"\n";
    fs::write(directory.join("s.toml"), scenario).unwrap();
    let output = opennck(&["machine-data", "check", "s.toml"], &directory);
    assert_eq!(output.status.code(), Some(1), "{}{}", out(&output), err(&output));
    let text = out(&output);
    let expected = [
        "  s.toml:4: implausible: MD34070 $MA_REFP_VELO_POS[AX1] = 0, axis X: expected more than 0",
        "  s.toml:5: implausible: MD34000 $MA_REFP_CAM_IS_ACTIVE[AX2] = 0, axis Y: the reference point approach does not use the cam \
         of s.toml:7",
    ];
    let found = lines(&text, "  s.toml:");
    assert_eq!(found.len(), expected.len(), "{text}");
    assert!(found.iter().zip(expected).all(|(found, expected)| found.starts_with(expected)), "{text}");
    let output = opennck(&["run", "s.toml"], &directory);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    let line = "warning: machine data of s.toml: 2 implausible; `opennck machine-data check s.toml` lists them\n";
    assert_eq!(err(&output), line);
    // Cases with the same findings are one; --case selects.
    let matrix =
        scenario.replace("[machine_data]\n\"34070[X]\" = 0", "[matrix]\n\"34070[X]\" = [0, 1, 2]\n[machine_data]");
    fs::write(directory.join("c.toml"), matrix).unwrap();
    let output = opennck(&["machine-data", "check", "c.toml"], &directory);
    assert_eq!(lines(&out(&output), "case ").len(), 3, "{}", out(&output));
    assert_eq!(lines(&out(&output), "findings: ").len(), 2, "{}", out(&output));
    let output = opennck(&["machine-data", "check", "c.toml", "--case", "34070[X] = 2"], &directory);
    assert_eq!(lines(&out(&output), "findings: "), ["findings: 1 implausible"]);
    // A machine has no cases.
    let output = opennck(&["machine-data", "check", "g1_example", "--case", "a"], &directory);
    assert_eq!(output.status.code(), Some(2));
    // A value of the scenario ends the finding about the value that it replaces.
    fs::write(directory.join("a.tea"), "N34070 $MA_REFP_VELO_POS[X1]=0\n").unwrap();
    assert_eq!(opennck(&["machine-data", "check", "a.tea"], &directory).status.code(), Some(1));
    let scenario = "title = \"A\"\nmachine = \"a.tea\"\n[machine_data]\n\"34070[X1]\" = 7\n[[step]]\nrun = \"10ms\"\n";
    fs::write(directory.join("a.toml"), scenario).unwrap();
    let output = opennck(&["machine-data", "check", "a.toml"], &directory);
    assert_eq!(output.status.code(), Some(0), "{}{}", out(&output), err(&output));
}

#[test]
fn an_unusable_step_of_the_scenario_ends_with_2() {
    let directory = directory("steps_of_a_scenario");
    let scenario = "machine = \"g1_example\"\n[[step]]\nset = { \"X.controler_enable\" = 1 }\n";
    fs::write(directory.join("s.toml"), scenario).unwrap();
    let output = opennck(&["machine-data", "check", "s.toml"], &directory);
    assert_eq!(output.status.code(), Some(2), "{}{}", out(&output), err(&output));
    assert!(out(&output).starts_with("findings: 1 error\n"), "{}", out(&output));
    assert_eq!(lines(&out(&output), "  s.toml:3: error: ").len(), 1, "{}", out(&output));
}

#[test]
fn one_datum_of_several_axes_that_acts_otherwise_is_one_entry() {
    let directory = directory("several_axes");
    let data = "N36052 $MA_STOP_ON_CLAMPING[AX1]=1\nN36052 $MA_STOP_ON_CLAMPING[AX2]=1\nN36730 $MA_DRIVE_SIGNAL_TRACKING[AX2]=1\n";
    fs::write(directory.join("a.tea"), data).unwrap();
    let output = opennck(&["machine-data", "check", "a.tea"], &directory);
    let text = out(&output);
    let expected = [
        "  a.tea:1: acts otherwise: MD36052 $MA_STOP_ON_CLAMPING = 1, axes X1, Y1: clamping has no special functions",
        "  a.tea:3: acts otherwise: MD36730 $MA_DRIVE_SIGNAL_TRACKING[AX2] = 1, axis Y1: the signals of the drive are those of the plant",
    ];
    assert_eq!(lines(&text, "  a.tea:"), [&["  a.tea: 3 assignments"][..], &expected].concat(), "{text}");
    assert!(text.contains("fault = { axis = \"Y1\", kind = \"drive_fault\" }"), "{text}");
    assert!(text.contains("\ngantry groupings: none\n"), "{text}");
    let all = out(&opennck(&["machine-data", "check", "a.tea", "--all"], &directory));
    assert_eq!(lines(&all, "  a.tea:").len(), 4, "{all}");
}

#[test]
fn the_list_finds_a_datum_as_manuals_and_scenarios_name_it() {
    let directory = directory("list_of_a_datum");
    for (name, number) in [("MD32000", "32000"), ("32000", "32000"), ("MD34080[0,XF]", "34080"), ("SD41110", "41110")] {
        let output = opennck(&["machine-data", "list", name], &directory);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", err(&output));
        // The head and one row.
        assert_eq!(
            (out(&output).lines().count(), lines(&out(&output), number).len()),
            (2, 1),
            "{name}: {}",
            out(&output)
        );
    }
}

#[test]
fn signals_of_a_machine_are_those_of_its_channels_and_mode_groups() {
    let directory = directory("signals_that_exist");
    let signals = |arguments: &[&str]| {
        let output = opennck(&[&["signals"], arguments].concat(), &directory);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", err(&output));
        out(&output)
    };
    let all = signals(&["--machine", "g1_example"]);
    assert!(all.contains("CHAN1.") && all.contains("mode_group_1."), "{all}");
    assert!(!all.contains("CHAN2.") && !all.contains("mode_group_2."), "{all}");
    // Without a machine there is no axis X: the signal of the first axis is shown.
    assert!(signals(&["X.controller_enable"]).contains("AX1.controller_enable"));
}

#[test]
fn a_plant_that_a_scenario_spoils_is_refused_at_the_line_of_the_scenario() {
    let directory = directory("plant_of_a_scenario");
    let refused = |plant: &str| {
        let text = format!("title = \"A\"\nmachine = \"g1_example\"\n{plant}\n[[step]]\nrun = \"10ms\"\n");
        fs::write(directory.join("s.toml"), text).unwrap();
        let output = opennck(&["run", "s.toml"], &directory);
        assert_eq!(output.status.code(), Some(2), "{}", err(&output));
        err(&output)
    };
    let cam = refused("[plant.X]\nstart = 1.0\ncam = { from = 5.0, to = 1.0 }");
    assert!(cam.contains("s.toml:5: expected a cam with `from` at most `to`, found 5.000 and 1.000"), "{cam}");
    let limits = refused("[plant.X]\nlimit_minus = { at = 5000.0 }\nlimit_plus = { at = 1.0 }");
    assert!(limits.contains("s.toml:3: expected limit_plus above limit_minus"), "{limits}");
    let cycle = refused("[plant.machine]\nplc_cycle = \"3ms\"");
    assert!(cycle.contains("s.toml:3: expected plc_cycle to be a whole multiple"), "{cycle}");
}

#[test]
fn the_catalogue_of_machine_data_is_listed() {
    let directory = directory("list_of_machine_data");
    let list = |arguments: &[&str]| out(&opennck(&[&["machine-data", "list"], arguments].concat(), &directory));
    let csv = list(&["--format", "csv"]);
    assert!(csv.starts_with("number,name,unit,range,default,takes effect,modelled,meaning\n"), "{csv}");
    assert!(csv.lines().count() > 150, "{}", csv.lines().count());
    let velocity = list(&["32000", "--format", "csv"]);
    let expected = "32000,$MA_MAX_AX_VELO[axis],mm/min,more than 0 and at most 1000000000,10000 (rotary axis 27.77),NEWCONF,yes,largest velocity of the axis\n";
    assert!(velocity.ends_with(expected) && velocity.lines().count() == 2, "{velocity}");
    let by_text = list(&["gantry_axis", "--format", "json"]);
    assert!(by_text.contains("\"number\": \"37100\""), "{by_text}");
    let row = list(&["30242"]);
    assert!(row.contains("$MA_ENC_IS_INDEPENDENT[0..1,axis]") && row.contains("  no  "), "{row}");
    let scenario = "title = \"A\"\nmachine = \"g1_example\"\n[machine_data]\n\"99999\" = 0\n[[step]]\nrun = \"10ms\"\n";
    fs::write(directory.join("s.toml"), scenario).unwrap();
    let refused = err(&opennck(&["run", "s.toml"], &directory));
    assert!(refused.contains("`opennck machine-data list` shows the known ones"), "{refused}");
}
