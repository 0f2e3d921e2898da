//! The rules in the program and in `docs/rules.md` are those that scenarios, causes and the sources name; and the signals that the control
//! reads are those of its sources.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![cfg(feature = "cli")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use opennck::controls;
use opennck::golden::{cases, scenario_files};
use opennck::image::{SINUMERIK, Writer};
use opennck::variables::RuleNumber;

fn project() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &str) -> String {
    fs::read_to_string(project().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The output of the program, if it succeeds.
fn opennck(arguments: &[&str]) -> Option<String> {
    let output = Command::new(env!("CARGO_BIN_EXE_opennck")).args(arguments).output().expect("the program was built");
    output.status.success().then(|| String::from_utf8(output.stdout).expect("text"))
}

/// The values of `covers` of a scenario file.
fn covers(text: &str) -> Vec<String> {
    let table: toml::Table = text.parse().expect("golden scenarios are valid");
    let list = table.get("covers").and_then(toml::Value::as_array).cloned().unwrap_or_default();
    list.iter().filter_map(|value| Some(value.as_str()?.to_owned())).collect()
}

/// The alarms that are raised in a golden trace: `1.072  alarm 25030   Y   raised`.
fn alarms(snap: &str) -> impl Iterator<Item = &str> {
    snap.lines().filter_map(|line| {
        let mut words = line.split_whitespace();
        let alarm = words.nth(1).filter(|word| *word == "alarm").and_then(|_| words.next())?;
        words.any(|word| word == "raised").then_some(alarm)
    })
}

#[test]
fn the_scenarios_that_show_a_rule_or_an_alarm_are_listed() {
    let list = "src/cli/rule/scenarios.txt";
    let mut pairs = BTreeSet::new();
    for file in scenario_files(&[project().join("golden")]).unwrap() {
        let name = file.strip_prefix(project()).unwrap().display().to_string().replace('\\', "/");
        let cases = cases(&file).unwrap();
        assert!(!cases.is_empty(), "{name}");
        for case in cases {
            let snap = fs::read_to_string(&case.snap).unwrap();
            pairs.extend(alarms(&snap).map(|alarm| format!("{alarm} {name}\n")));
        }
        pairs.extend(covers(&fs::read_to_string(&file).unwrap()).into_iter().map(|rule| format!("{rule} {name}\n")));
    }
    let expected: String = pairs.into_iter().collect();
    if std::env::var_os("OPENNCK_ACCEPT").is_some() {
        fs::write(project().join(list), &expected).unwrap();
    }
    assert!(read(list) == expected, "{list} is old: run this test once with OPENNCK_ACCEPT=1");
}

#[test]
fn every_rule_that_a_cause_or_a_scenario_names_is_explained() {
    let mut ids: BTreeSet<String> = BTreeSet::new();
    for texts in controls::texts() {
        let rules = (0..).map(|number| texts.rule(RuleNumber(number))).take_while(|rule| rule.id != "?");
        ids.extend(rules.map(|rule| rule.id.to_owned()));
    }
    assert!(ids.len() > 60, "the rules of the control are found");
    ids.extend(read("src/cli/rule/scenarios.txt").lines().filter_map(|line| Some(line.split_once(' ')?.0.to_owned())));
    let unknown: Vec<_> =
        ids.iter().filter(|id| opennck(&["rule", id]).is_none_or(|text| !text.starts_with(*id))).collect();
    assert!(unknown.is_empty(), "add them to docs/rules.md or docs/decisions.md: {unknown:?}");
}

/// The Rust files below a folder.
fn sources(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, into);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            into.push(path);
        }
    }
}

/// A signal of the PLC or the HMI is modelled exactly if a stage of the control calls its accessor or tests its constant. Signals of two
/// blocks with one name are modelled together; there are few.
#[test]
fn signals_of_the_plc_are_modelled_exactly_if_the_control_reads_them() {
    let mut files = Vec::new();
    sources(&project().join("src/sinumerik"), &mut files);
    let is_stage = |path: &PathBuf| {
        !path.ends_with("modelled.rs") && !path.components().any(|part| part.as_os_str() == "conditions")
    };
    let text: String =
        files.iter().filter(|path| is_stage(path)).map(|path| fs::read_to_string(path).unwrap()).collect();
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let names = |before: &str, name: &str| {
        let wanted = format!("{before}{name}");
        text.match_indices(&wanted).any(|(at, _)| !text[at + wanted.len()..].starts_with(is_word))
    };
    let mut modelled: BTreeMap<&str, bool> = BTreeMap::new();
    let control = controls::texts().next().expect("there is a control");
    for signal in SINUMERIK.signals().filter(|signal| signal.writer != Writer::Nck) {
        *modelled.entry(signal.name).or_default() |= control.is_modelled(signal);
    }
    let accessors = |name: &str| text.contains(&format!(".{name}()"));
    let constants =
        ["axis_to_nck::", "channel_to_nck::", "mode_group_to_nck::", "nck_to_nck::", "nck_hmi::", "mode_group_hmi::"];
    // User alarms are read by their number.
    let is_numbered = |name: &str| name.starts_with("user_alarm_700") || name == "acknowledge_user_alarms";
    let wrong: Vec<_> = modelled
        .iter()
        .filter(|(name, _)| !is_numbered(name))
        .filter(|(name, modelled)| {
            (accessors(name) || constants.iter().any(|module| names(module, name))) != **modelled
        })
        .collect();
    assert!(wrong.is_empty(), "correct the list in src/sinumerik/modelled.rs: {wrong:?}");
}
