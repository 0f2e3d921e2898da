//! Tests that the README is up to date: its test crate word for word, its scenario, its trace.
#![cfg(feature = "cli")]

use std::fs;
use std::path::Path;
use std::process::Command;

use opennck::plc::{MACHINE_CONTROL_PANEL_LAYOUT, Programs};
use opennck::scenario::Scenario;

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).expect("the file must exist")
}

/// The contents of the code blocks in this language.
fn blocks(text: &str, language: &str) -> Vec<String> {
    let fence = format!("```{language}\n");
    let inside = |rest: &str| rest.split("```").next().unwrap_or_default().to_owned();
    text.split(&fence).skip(1).map(inside).collect()
}

#[test]
fn the_crate_in_the_readme_is_the_example_word_for_word() {
    let example = read("examples/gantry_in_ci/tests/gantry.rs");
    let (head, code) = example.split_once("\n\n").unwrap();
    assert!(head.starts_with("//! "));
    assert_eq!(blocks(&read("README.md"), "rust"), [code.to_owned()]);
}

#[test]
fn the_scenario_in_the_readme_passes() {
    let blocks = blocks(&read("README.md"), "toml");
    let scenario = blocks.iter().find(|block| block.starts_with("title")).unwrap();
    let scenario = Scenario::parse(scenario, Path::new("README.toml")).unwrap();
    let finished = scenario.prepare(scenario.profiles[0], &Programs::ready()).unwrap().run();
    assert!(finished.failure.is_none(), "{:?}", finished.failure);
}

#[test]
fn every_row_in_the_readme_is_in_the_worked_example() {
    let output = Command::new(env!("CARGO_BIN_EXE_opennck")).output().unwrap();
    let output = String::from_utf8(output.stdout).unwrap();
    for row in blocks(&read("README.md"), "text")[0].lines() {
        assert!(output.lines().any(|line| line == row), "not in the output of `opennck`: {row}");
    }
}

#[test]
fn the_test_command_of_the_readme_is_the_one_of_the_ci() {
    let test =
        blocks(&read("README.md"), "sh")[0].lines().find(|line| line.starts_with("cargo test")).unwrap().to_owned();
    assert!(read(".ci/run").lines().any(|line| line == format!("step {test} --locked")), "{test}");
}

#[test]
fn the_flowcharts_in_the_readme_are_the_ones_that_the_program_prints() {
    let print = |chart| {
        let output = Command::new(env!("CARGO_BIN_EXE_opennck")).args(["flowchart", chart]).output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    assert_eq!(blocks(&read("README.md"), "mermaid"), [print("gantry"), print("approach")]);
}

#[test]
fn the_layout_of_the_panel_in_the_readme_is_the_one_of_the_program() {
    assert_eq!(blocks(&read("README.md"), "text")[1], MACHINE_CONTROL_PANEL_LAYOUT);
}

#[test]
fn the_readme_names_every_built_in_program() {
    let readme = read("README.md");
    for name in Programs::ready().names() {
        assert!(readme.contains(&format!("`{name}`")), "{name}");
    }
}
