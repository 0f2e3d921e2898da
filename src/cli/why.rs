//! `opennck why`: the chain of causes behind an edge, back to the first write from outside the control.

use std::path::Path;

use clap::Args;

use super::output::Output;
use crate::image::Profile;
use crate::plc::Programs;
use crate::scenario::{Failure, Finished, Prepared, Scenario, profile_named};
use crate::source::{Place, Problem, TRACE_MIB, decode, read_bytes};
use crate::trace::Story;
use crate::units::Time;

/// Which run of a scenario is used: one case under one profile.
#[derive(Clone, Debug, Args)]
pub(super) struct Run {
    /// Of a scenario with a matrix: the case whose values contain this text, as `plc = a`.
    #[arg(long, value_name = "TEXT")]
    case: Option<String>,
    /// Runs the scenario under this profile, 840d_sl or 828d, whose addresses are understood and shown [default: the first of the scenario].
    #[arg(long, value_name = "PROFILE")]
    profile: Option<String>,
}

impl Run {
    /// The case of a scenario, and the profile.
    pub(super) fn read(&self, scenario: &Path) -> Result<(Scenario, Profile), Problem> {
        let scenario = Scenario::read_case(scenario, self.case.as_deref())?;
        let profile = match &self.profile {
            Some(name) => profile_named(name)?,
            None => scenario.profiles.first().copied().unwrap_or_default(),
        };
        Ok((scenario, profile))
    }

    /// The case of a scenario under the profile, ready to run.
    fn prepare(&self, scenario: &Path, programs: &Programs) -> Result<Prepared, Problem> {
        let (scenario, profile) = self.read(scenario)?;
        scenario.prepare(profile, programs)
    }

    /// The same after its run, up to a time if one is given. A run that failed has an answer, too: `answer` says what it is, before a time.
    pub(super) fn finish(
        &self,
        scenario: &Path,
        end: Option<Time>,
        programs: &Programs,
        answer: &str,
        output: &mut Output,
    ) -> Result<Finished, Problem> {
        let finished = self.prepare(scenario, programs)?.run_until(end);
        match &finished.failure {
            None => {}
            Some(Failure::Unusable(problem)) => return Err(problem.clone()),
            Some(Failure::Missed(missed)) => {
                let (failed, ended) = (missed.time, finished.session().time());
                let time = if failed == ended { "that time".to_owned() } else { format!("its end, {ended} s") };
                let what = &missed.what;
                output.warning(format!("the scenario failed at {failed} s: {what}; the answer is {answer} {time}"));
            }
        }
        Ok(finished)
    }
}

pub(super) fn why(trace: &Path, edge: &str, run: &Run, programs: &Programs, output: &mut Output) -> u8 {
    match explanation(trace, edge, run, programs, output) {
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
    trace: &Path,
    edge: &str,
    run: &Run,
    programs: &Programs,
    output: &mut Output,
) -> Result<String, Problem> {
    let (what, time) = if edge.contains('@') {
        parse_edge(edge).ok_or_else(|| {
            Problem::new(
                format!("expected SIGNAL, SIGNAL@TIME or alarm(NUMBER)@TIME, found `{edge}`"),
                "write `X.gantry_grouping_is_synchronized@8.068`, `DB31.DBX101.5@9s`, `alarm(10654)@7.6`, `power_on@2` or \
                 `fault drive_fault[XF]@3`; without a time it is the end",
            )
        })?
    } else {
        (edge, Time::from_nanos(i64::MAX))
    };
    let is_scenario = trace.extension().is_some_and(|extension| extension == "toml");
    let story = match (is_scenario, &run.case, &run.profile) {
        (true, _, _) => {
            let finished = run.finish(trace, None, programs, "the trace up to", output)?;
            let session = finished.session();
            session.trace().story(session.machine())
        }
        (false, None, None) => read(trace)?,
        (false, Some(case), _) => {
            let what = format!("expected a scenario together with --case, found a trace and the case `{case}`");
            return Err(Problem::new(what, "a trace is of one case already; omit --case"));
        }
        (false, None, Some(profile)) => {
            let what =
                format!("expected a scenario together with --profile, found a trace and the profile `{profile}`");
            return Err(Problem::new(what, "a trace is of one profile already; omit --profile"));
        }
    };
    story.why(what, time).map_err(|problem| problem.at(&Place::file(&trace.display().to_string())))
}

fn read(trace: &Path) -> Result<Story, Problem> {
    let place = Place::file(&trace.display().to_string());
    let at = |line| place.at_line(u32::try_from(line).unwrap_or(0));
    Story::read(&decode(&read_bytes(trace, TRACE_MIB)?)).map_err(|(line, problem)| problem.at(&at(line)))
}

/// Parses `X.controller_enable@7.466`; the time is in seconds or has a unit.
pub(super) fn parse_edge(edge: &str) -> Option<(&str, Time)> {
    let parsed = edge.rsplit_once('@').and_then(|(what, time)| Some((what, Time::parse_or_seconds(time)?)));
    parsed.filter(|(what, _)| !what.is_empty())
}
