//! Any bytes as parameter lists of the ISG kernel: examined, read, started, and changed at run time.
//!
//! The files are separated by lines of `====`. Checks: no panic; what is read has a machine that opens and runs some cycles; an update of a
//! parameter is accepted or refused as a whole.

use opennck::isg::ParameterLists;
use opennck::machine::{Machine, OpenOptions};
use opennck::source::{Place, Table};

/// Reads the lists, and runs a machine with them. Returns the number of its axes, none if the lists are refused.
pub fn judge(input: &[u8]) -> usize {
    let parts = files(input);
    let names: Vec<String> = (0..parts.len()).map(|index| format!("list_{index}.lis")).collect();
    let files: Vec<(&str, &[u8])> = names.iter().map(String::as_str).zip(parts.iter().copied()).collect();
    let lists = match ParameterLists::read(&files) {
        Ok(lists) => lists,
        Err(problem) => {
            let text = problem.to_string();
            assert!(!text.is_empty());
            return 0;
        }
    };
    let plant = Table::empty(Place::file("plant.toml"));
    match Machine::of(&lists, plant, OpenOptions::default()) {
        Ok(mut machine) => {
            for _ in 0..5 {
                machine.step();
            }
            machine.names().axes.iter().filter(|(_, name)| name.is_some()).count()
        }
        Err(problem) => {
            assert!(!problem.to_string().is_empty());
            0
        }
    }
}

/// The parts between the lines of `====`.
fn files(input: &[u8]) -> Vec<&[u8]> {
    let mut files = Vec::new();
    let mut rest = input;
    while let Some(at) = rest.windows(6).position(|bytes| bytes == b"\n====\n") {
        files.push(&rest[..=at]);
        rest = &rest[at + 6..];
    }
    files.push(rest);
    files
}
