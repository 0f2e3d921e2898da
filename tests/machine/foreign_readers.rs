//! Tests that other programs read our files: they must find the same data as the trace.
//!
//! `vcdvcd` and `pyvcd` for Python read the waveform, the XML parser of Python reads the diagram. If python3 or a package is missing, the
//! test reports this on standard error, past the capture of the test runner, and checks the rest.

use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use opennck::plc::Programs;
use opennck::scenario::{Finished, Scenario};

fn worked_example() -> Finished {
    let file =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("golden/worked_example/gantry_references_and_synchronises.toml");
    let scenario = Scenario::read(&file).expect("the worked example can be read");
    scenario.prepare(scenario.profiles[0], &Programs::ready()).expect("the worked example can be used").run()
}

fn written(name: &str, text: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::write(&path, text).expect("the target directory is writable");
    path
}

/// Edges such as `X.traversing_key_plus 40 1` (signal, milliseconds, value) from the JSON lines.
fn edges_of_the_trace(finished: &Finished) -> BTreeSet<String> {
    let mut edges = BTreeSet::new();
    for line in finished.json_lines().lines() {
        let line: serde_json::Value = serde_json::from_str(line).expect("JSON");
        if let (Some(symbol), Some(_)) = (line["symbol"].as_str(), line["signal"].as_str()) {
            let milliseconds = (line["t"].as_f64().expect("a time") * 1e3).round();
            edges.insert(format!("{symbol} {milliseconds} {}", line["value"]));
        }
    }
    edges
}

/// The output of a Python program; `None` and a message on standard error if Python or a package is missing.
fn python(needs: &str, program: &str, file: &Path) -> Option<String> {
    let is_there = Command::new("python3").args(["-c", &format!("import {needs}")]).output();
    if !is_there.is_ok_and(|output| output.status.success()) {
        let word = format!("\nNOT CHECKED: python3 with the module `{needs}` is missing\n");
        std::io::stderr().write_all(word.as_bytes()).expect("standard error");
        return None;
    }
    let output = Command::new("python3").args(["-c", program]).arg(file).output().expect("python3 is there");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(String::from_utf8(output.stdout).expect("text"))
}

#[test]
fn vcdvcd_finds_every_edge_at_its_time() {
    let finished = worked_example();
    let file = written("vcdvcd.vcd", &finished.vcd());
    let program = "
import sys
from vcdvcd import VCDVCD
vcd = VCDVCD(sys.argv[1])
for name in vcd.signals:
    for time, value in vcd[name].tv:
        if time > 0 and 'alarm' not in name:
            print(name, int(time * vcd.timescale['factor'] * 1000), value)
";
    if let Some(found) = python("vcdvcd", program, &file) {
        let found: BTreeSet<String> = found.lines().map(str::to_owned).collect();
        assert_eq!(found, edges_of_the_trace(&finished));
    }
}

#[test]
fn pyvcd_reads_every_token() {
    let file = written("pyvcd.vcd", &worked_example().vcd());
    let program = "
import sys
from vcd.reader import tokenize
print(sum(1 for _ in tokenize(open(sys.argv[1], 'rb'))))
";
    if let Some(found) = python("vcd.reader", program, &file) {
        assert!(found.trim().parse::<u32>().expect("a count") > 100, "{found}");
    }
}

#[test]
fn the_diagram_is_well_formed_and_contains_every_row() {
    let finished = worked_example();
    let file = written("diagram.svg", &finished.svg());
    let program = "
import sys, xml.etree.ElementTree as tree
for text in tree.parse(sys.argv[1]).getroot().iter('{http://www.w3.org/2000/svg}text'):
    print(text.text)
";
    if let Some(found) = python("xml.etree", program, &file) {
        for expected in
            ["X.gantry_synchronization_ready_to_start", "DB31.DBX101.4", "10654", "The PLC starts synchronisation"]
        {
            assert!(found.lines().any(|line| line == expected), "{expected} in {found}");
        }
    }
}

#[test]
fn the_parser_of_the_crate_finds_scopes_start_values_and_the_end() {
    let text = worked_example().vcd();
    let mut parser = vcd::Parser::new(text.as_bytes());
    let header = parser.parse_header().expect("a header");
    assert_eq!((header.timescale, header.date.as_ref()), (Some((1, vcd::TimescaleUnit::MS)), None));
    for path in [["nck", "nc_ready"], ["X", "traversing_key_plus"], ["XF", "gantry_axis"], ["X", "alarm_10654"]] {
        assert!(header.find_var(&path).is_some(), "{path:?}");
    }
    let commands: Vec<vcd::Command> = parser.map(|command| command.expect("a command")).collect();
    let key = header.find_var(&["X", "traversing_key_plus"]).expect("a variable").code;
    let at_start = commands.iter().take_while(|command| !matches!(command, vcd::Command::Timestamp(1..)));
    assert!(at_start.into_iter().any(|command| *command == vcd::Command::ChangeScalar(key, vcd::Value::V0)));
    let last = commands.iter().rev().find_map(|command| match command {
        vcd::Command::Timestamp(time) => Some(*time),
        _ => None,
    });
    assert_eq!(last, Some(8568), "the file ends with the scenario");
}

#[test]
fn the_same_scenario_gives_the_same_bytes() {
    let (one, other) = (worked_example(), worked_example());
    assert_eq!(one.vcd(), other.vcd());
    assert_eq!(one.svg(), other.svg());
    assert_eq!(one.json_lines(), other.json_lines());
}
