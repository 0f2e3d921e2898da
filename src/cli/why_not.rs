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
    match explanation(scenario, signal, run, complete, programs) {
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
) -> Result<String, Problem> {
    let (what, time) = match signal.contains('@') {
        true => parse_edge(signal).map(|(what, time)| (what, Some(time)))?,
        false => (signal, None),
    };
    let finished = run.prepare(scenario, programs)?.run_until(time);
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
