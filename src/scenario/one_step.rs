//! One step of a scenario as commands, for servers whose clients use the verbs of scenarios.

use std::path::Path;

use super::steps::Reader;
use crate::machine::{Command, Machine};
use crate::source::{Problem, Table, did_you_mean};

/// The verbs that act at once and need no file, without those of faults.
const AT_ONCE: [&str; 16] = [
    "set",
    "write",
    "force",
    "release",
    "machine_data",
    "list",
    "r_parameters",
    "mdi",
    "preset",
    "search",
    "function_generator",
    "new_conf",
    "power_on",
    "plc",
    "cancel",
    "handwheel",
];

/// Those of faults.
const FAULTS: [&str; 2] = ["fault", "clear_fault"];

/// The commands of a step, `{ set = { "X.traversing_key_plus" = 1 } }`, checked against the machine. Its verb acts at once. `others` are
/// words that the caller executes itself: an error lists them with the verbs.
///
/// # Errors
/// The step has no such verb, or a name or a value in it is wrong.
pub fn commands(step: Table, machine: &Machine, others: &[&'static str]) -> Result<Vec<Command>, Problem> {
    let known = || AT_ONCE.into_iter().chain(FAULTS).chain(others.iter().copied());
    if let Some(other) = step.keys().find(|key| *key != "channel" && !known().any(|verb| verb == *key)) {
        let fallback = format!("verbs are {}", known().collect::<Vec<_>>().join(", "));
        let what = format!("expected a verb that acts at once, found `{other}`");
        return Err(Problem::new(what, did_you_mean(other, known(), &fallback)));
    }
    let place = step.place.clone();
    let step = Reader::new(machine, Path::new("")).step(step, place, None)?;
    Ok(step.action.commands(machine.cycle_time()).unwrap_or_default())
}
