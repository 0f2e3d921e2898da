//! `opennck why`: the chain of causes behind an edge, back to the first write from outside the control.

use std::path::Path;

use super::output::Output;
use crate::plc::Programs;
use crate::scenario::Scenario;
use crate::source::{Place, Problem, read_text};
use crate::trace::Story;
use crate::units::Time;

pub(super) fn why(trace: &Path, edge: &str, case: Option<&str>, programs: &Programs, output: &mut Output) -> u8 {
    match explanation(trace, edge, case, programs) {
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

fn explanation(trace: &Path, edge: &str, case: Option<&str>, programs: &Programs) -> Result<String, Problem> {
    let (what, time) = parse_edge(edge)?;
    let is_scenario = trace.extension().is_some_and(|extension| extension == "toml");
    let story = match (is_scenario, case) {
        (true, case) => run(trace, case, programs)?,
        (false, None) => read(trace)?,
        (false, Some(case)) => {
            let what = format!("expected a scenario together with --case, found a trace and the case `{case}`");
            return Err(Problem::new(what, "a trace is of one case already; omit --case"));
        }
    };
    story.why(what, time).map_err(|problem| problem.at(&Place::file(&trace.display().to_string())))
}

fn read(trace: &Path) -> Result<Story, Problem> {
    let place = Place::file(&trace.display().to_string());
    let at = |line| place.at_line(u32::try_from(line).unwrap_or(0));
    Story::read(&read_text(trace)?).map_err(|(line, problem)| problem.at(&at(line)))
}

fn run(scenario: &Path, case: Option<&str>, programs: &Programs) -> Result<Story, Problem> {
    let scenario = Scenario::read_case(scenario, case)?;
    let profile = scenario.profiles.first().copied().unwrap_or_default();
    let finished = scenario.prepare(profile, programs)?.run();
    let session = finished.session();
    Ok(session.trace().story(session.machine()))
}

/// Parses `X.controller_enable@7.466`; the time is in seconds or has a unit.
pub(super) fn parse_edge(edge: &str) -> Result<(&str, Time), Problem> {
    let parsed = edge.rsplit_once('@').and_then(|(what, time)| Some((what, Time::parse_or_seconds(time)?)));
    parsed.filter(|(what, _)| !what.is_empty()).ok_or_else(|| {
        Problem::new(
            format!("expected SIGNAL@TIME or alarm(NUMBER)@TIME, found `{edge}`"),
            "write `X.gantry_grouping_is_synchronized@8.068`, `DB31.DBX101.5@9s`, `alarm(10654)@7.6`, `power_on@2` or `fault drive_fault[XF]@3`",
        )
    })
}
