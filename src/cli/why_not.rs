//! `opennck why-not`: what the control waits for before a signal changes.

use std::path::Path;

use super::output::Output;
use super::why::{Run, parse_edge};
use crate::plc::Programs;
use crate::source::{Place, Problem};
use crate::units::Time;

pub(super) fn why_not(
    scenario: &Path,
    signal: &str,
    run: &Run,
    complete: bool,
    programs: &Programs,
    output: &mut Output,
) -> u8 {
    match explanation(scenario, signal, run, complete, programs, output) {
        Ok(text) => {
            output.print(&text);
            0
        }
        Err(problem) => {
            output.error(problem);
            2
        }
    }
}

fn explanation(
    scenario: &Path,
    signal: &str,
    run: &Run,
    complete: bool,
    programs: &Programs,
    output: &mut Output,
) -> Result<String, Problem> {
    let (what, time) = if signal.contains('@') {
        let (what, time) = parse_edge(signal).ok_or_else(|| {
            Problem::new(
                format!("expected a signal of one bit, or SIGNAL@TIME, found `{signal}`"),
                "write `X.position_controller_active@0.3` or `DB31.DBX61.5@300ms`; without a time it is the end",
            )
        })?;
        (what, Some(time))
    } else {
        (signal, None)
    };
    let finished = run.finish(scenario, time, programs, "the state at", output)?;
    let session = finished.session();
    let end = session.time();
    if let Some(time) = time.filter(|&time| end + session.machine().cycle_time() <= time) {
        return Err(beyond(scenario, what, time, end));
    }
    session.why_not(what, complete).map_err(|problem| problem.at(&Place::file(&scenario.display().to_string())))
}

fn beyond(scenario: &Path, what: &str, time: Time, end: Time) -> Problem {
    Problem::new(
        format!("expected a time up to {end} s, at which the scenario ends, found {time} s"),
        format!("write `{what}` without a time for the end, or let the scenario run longer"),
    )
    .at(&Place::file(&scenario.display().to_string()))
}
