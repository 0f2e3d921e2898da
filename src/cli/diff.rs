//! `opennck diff`: reports the first difference between two traces.

use std::path::Path;

use super::output::Output;
use crate::source::{Place, Problem, TRACE_MIB, decode, read_bytes};
use crate::trace::{Comparison, Reading};

pub(super) fn diff(expected: &Path, found: &Path, output: &mut Output) -> u8 {
    let both = read(expected).and_then(|one| Ok((one, read(found)?))).and_then(|(one, other)| {
        if one.is_json() == other.is_json() {
            return Ok((one, other));
        }
        Err(Problem::new(
            "expected two traces in the same format, found JSON lines and a table",
            "compare two files of `opennck run --trace`, or two golden files",
        ))
    });
    match both.map(|(one, other)| one.compare(&other)) {
        Ok(Comparison::Same) => {
            output.line("the traces are the same");
            0
        }
        Ok(Comparison::OtherCauses(first)) => {
            output.line(format!("the traces are the same except for causes\n{first}"));
            0
        }
        Ok(Comparison::Different(difference)) => {
            output.line(difference);
            1
        }
        Err(problem) => {
            output.error(problem);
            2
        }
    }
}

fn read(path: &Path) -> Result<Reading, Problem> {
    let text = decode(&read_bytes(path, TRACE_MIB)?);
    // The header of a golden file does not describe the machine. Its lines still count so that line numbers are right.
    let text = match text.strip_prefix("---").and_then(|rest| rest.split_once("\n---")) {
        Some((header, body)) => "\n".repeat(header.lines().count()) + body,
        None => text,
    };
    let place = Place::file(&path.display().to_string());
    Reading::read(&text).map_err(|(line, problem)| problem.at(&place.at_line(u32::try_from(line).unwrap_or(0))))
}
