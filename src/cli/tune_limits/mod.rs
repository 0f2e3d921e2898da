//! `opennck tune-limits`: finds the warning limit and the trip limits of gantry groupings from the movements of a scenario (G1 2.7.4).
//!
//! The manual's procedure: MD37120 large, MD37110 very small, a heavy dynamic load; MD37110 is raised until the message 10652 no longer
//! appears; MD37120 is the value found and a small safety provision; at the end MD37110 < MD37120 < MD37130. A simulator need not raise
//! the limit step by step: the greatest difference in a run with large limits is where the message no longer appears, because the control
//! compares this difference with the limit. The proposal is checked by the control itself, in another run with all three limits. Limits
//! change the behaviour (below MD37110 synchronisation starts by itself), so this run can have greater differences; then they count, too.
//!
//! `search.rs` runs the scenario and measures, `limits.rs` makes the proposals.

mod limits;
mod search;

use std::path::{Path, PathBuf};

use clap::Args;

use super::files::Files;
use super::list::{Cell, Format, List};
use super::output::Output;
use super::why::Run;
use crate::machine::Machine;
use crate::plc::Programs;
use crate::scenario::Failure;
use crate::source::{Place, Problem, Replacement};
use crate::trace::{Limit, Panel, Window};
use limits::{Limits, Margin, number};
use search::{Grouping, Measured, Seen, measure};

/// How often the limits are raised before the search gives up.
const RUNS: usize = 8;

#[derive(Clone, Debug, Args)]
pub(super) struct Arguments {
    /// A scenario (*.toml) that references and synchronises the grouping, and moves it under a heavy dynamic load.
    scenario: PathBuf,
    /// The safety margin of MD37120 above MD37110: a share such as 10%, or a length in the unit of the machine data.
    #[arg(long, value_name = "MARGIN", default_value = "10%", allow_hyphen_values = true, value_parser = Margin::parse)]
    margin: Margin,
    /// The step in which the limits are raised, in the unit of the machine data.
    #[arg(long, value_name = "LENGTH", default_value = "0.001", allow_hyphen_values = true, value_parser = limits::step)]
    step: f64,
    /// Output format.
    #[arg(long, value_enum, default_value = "table")]
    format: Format,
    /// Draws the synchronism differences over time, from the first synchronisation on, with the warning and the trip limit.
    #[arg(long, value_name = "F.svg")]
    svg: Option<PathBuf>,
    #[command(flatten)]
    run: Run,
}

/// Why there are no limits.
enum Stop {
    /// The input cannot be used: exit code 2.
    Unusable(Problem),
    /// The search found nothing: exit code 1.
    Nothing(String),
}

impl From<Problem> for Stop {
    fn from(problem: Problem) -> Self {
        Self::Unusable(problem)
    }
}

pub(super) fn tune_limits(arguments: &Arguments, programs: &Programs, output: &mut Output) -> u8 {
    match search_and_print(arguments, programs, output) {
        Ok(code) => code,
        Err(Stop::Unusable(problem)) => {
            output.error(problem);
            2
        }
        Err(Stop::Nothing(what)) => {
            output.error(what);
            1
        }
    }
}

fn search_and_print(arguments: &Arguments, programs: &Programs, output: &mut Output) -> Result<u8, Stop> {
    let (scenario, profile) = arguments.run.read(&arguments.scenario)?;
    let mut picture = None;
    if let Some(path) = &arguments.svg {
        picture = Some(Files::of(scenario.inputs()).open("--svg", path)?);
    }
    let opened = scenario.prepare(profile, programs)?;
    opened.warnings().iter().for_each(|warning| output.warning(warning));
    let groupings = Grouping::all(opened.machine());
    if groupings.is_empty() {
        let machine = &scenario.machine;
        return Err(Stop::Unusable(machine.place.problem(
            format!("expected a machine with a gantry grouping, found none in `{}`", machine.text),
            "define one: MD37100 = 1 on the leading axis, 11 on the synchronous axis",
        )));
    }
    let with = |limits: &[Limits]| -> Result<Measured, Problem> {
        let mut scenario = scenario.clone();
        scenario.machine_data.extend(limits.iter().flat_map(Limits::data));
        Ok(measure(scenario.prepare(profile, programs)?, &groupings))
    };
    let large: Vec<_> = groupings.iter().map(Limits::large).collect();
    let first = with(&large)?;
    usable(&first, &arguments.scenario)?;
    let tuned = tuned(&groupings, &first, &arguments.scenario, output)?;
    let Search { proposed, seen, doubt, shown } = propose(first, &tuned, arguments, with)?;
    let list = list(&proposed, &seen, doubt.is_none(), opened.machine());
    let code = list.print(arguments.format, output);
    match doubt {
        Some(doubt) => output.warning(format!(
            "not checked: {doubt}\n  with MD37110 = 0 a grouping waits for the start of the synchronisation (29.4); above 0 it starts by itself \
             where the differences are below; adapt the scenario to the new limits"
        )),
        None if arguments.format == Format::Table => {
            output.line("\nchecked: the scenario passes with these limits, without 10652 while synchronised and without 10653");
        }
        None => {}
    }
    if let Some(file) = picture {
        draw(file, shown, &proposed)?;
    }
    Ok(code)
}

/// The first run passed, and the limits were those of the search.
fn usable(first: &Measured, scenario: &Path) -> Result<(), Stop> {
    match &first.finished.failure {
        None => {}
        Some(Failure::Unusable(problem)) => return Err(Stop::Unusable(problem.clone())),
        Some(failure) => {
            return Err(Stop::Nothing(format!(
                "{failure}\n  the search runs the scenario with MD37120 and MD37130 = {}; it must pass with them",
                number(limits::LARGE)
            )));
        }
    }
    let Some(datum) = first.own_limit() else {
        return Ok(());
    };
    let what = format!("expected a scenario that leaves the limits to the search, found one that changes {datum}");
    let place = Place::file(&scenario.display().to_string());
    Err(place
        .problem(what, "remove this step; values in `[machine_data]` at the head may stay, they are replaced")
        .into())
}

/// The groupings that were synchronised and then moved; the others are reported.
fn tuned(
    groupings: &[Grouping],
    first: &Measured,
    scenario: &Path,
    output: &mut Output,
) -> Result<Vec<Grouping>, Stop> {
    let mut tuned = Vec::new();
    let mut reasons = Vec::new();
    for (grouping, seen) in groupings.iter().zip(&first.seen) {
        if !seen.was_synchronised {
            reasons.push(format!("{} is never synchronised", grouping.title()));
        } else if !seen.moved {
            reasons.push(format!("{} does not move while it is synchronised", grouping.title()));
        } else {
            tuned.push(grouping.clone());
        }
    }
    if tuned.is_empty() {
        return Err(Stop::Nothing(format!(
            "{}: expected a grouping that is synchronised and then moves, found none: {}\n  reference it, wait for 101.5 = 1 \
             (`X.gantry_grouping_is_synchronized`), then move it as hard as the machine will",
            scenario.display(),
            reasons.join("; ")
        )));
    }
    reasons.iter().for_each(|reason| output.warning(format!("{reason} in this scenario: no limits for it")));
    Ok(tuned)
}

/// The result of a search.
struct Search {
    proposed: Vec<Limits>,
    /// Of each grouping.
    seen: Vec<Seen>,
    /// Why the proposal is not checked.
    doubt: Option<String>,
    /// The run of the picture.
    shown: Measured,
}

/// Proposes limits from the first run, and runs the scenario with them until no difference is greater.
fn propose(
    first: Measured,
    tuned: &[Grouping],
    arguments: &Arguments,
    with: impl Fn(&[Limits]) -> Result<Measured, Problem>,
) -> Result<Search, Problem> {
    let limits = |seen: &[Seen]| -> Vec<Limits> {
        let own = |grouping: &Grouping| {
            Some(Limits::of(grouping, seen.get(grouping.index)?, arguments.margin, arguments.step))
        };
        tuned.iter().filter_map(own).collect()
    };
    let mut seen = first.seen.clone();
    let mut proposed = limits(&seen);
    let mut shown = first;
    for _ in 0..RUNS {
        let proof = with(&proposed)?;
        if let Some(failure) = &proof.finished.failure {
            let doubt = Some(format!("the scenario does not pass with these limits: {failure}"));
            return Ok(Search { proposed, seen, doubt, shown });
        }
        let is_greater = proof.seen.iter().zip(&mut seen).fold(false, |any, (new, old)| old.grow(new) || any);
        let next = limits(&seen);
        if !is_greater || next == proposed {
            let doubt = proof.message().map(|alarm| format!("{alarm} is raised with these limits"));
            return Ok(Search { proposed, seen, doubt, shown: proof });
        }
        (proposed, shown) = (next, proof);
    }
    Ok(Search { proposed, seen, doubt: Some(format!("the differences still grow after {RUNS} runs")), shown })
}

/// A cell: a text, or a number with its text.
enum Value {
    Text(String),
    Number(String),
    Bit(bool),
}

impl Cell for Value {
    fn text(&self) -> &str {
        match self {
            Self::Text(text) | Self::Number(text) => text,
            Self::Bit(bit) => {
                if *bit {
                    "yes"
                } else {
                    "no"
                }
            }
        }
    }

    fn json(&self) -> serde_json::Value {
        match self {
            Self::Text(text) => text.as_str().into(),
            Self::Number(text) => text.parse::<f64>().map_or(serde_json::Value::Null, Into::into),
            Self::Bit(bit) => (*bit).into(),
        }
    }
}

/// A row for each synchronous axis.
fn list(proposed: &[Limits], seen: &[Seen], checked: bool, machine: &Machine) -> List<Value> {
    let heads = &[
        "grouping",
        "leading",
        "synchronous",
        "unit",
        "difference",
        "time",
        "MD37110",
        "MD37110 now",
        "MD37120",
        "MD37120 now",
        "MD37130",
        "MD37130 now",
        "checked",
    ];
    let mut rows = Vec::new();
    for limits in proposed {
        let grouping = &limits.grouping;
        let greatest = seen.get(grouping.index).map_or(&[][..], |seen| &seen.greatest);
        for (follower, greatest) in grouping.followers.iter().zip(greatest) {
            let value = |value: f64| Value::Number(number(value));
            let now = grouping.now(follower.axis, machine);
            rows.push(vec![
                Value::Number(grouping.number.to_string()),
                Value::Text(grouping.leader.name.clone()),
                Value::Text(follower.name.clone()),
                Value::Text(grouping.unit.to_owned()),
                value(greatest.value),
                Value::Number(greatest.time.to_string()),
                value(limits.warning),
                value(now[0]),
                value(limits.trip),
                value(now[1]),
                value(limits.not_synchronised),
                value(now[2]),
                Value::Bit(checked),
            ]);
        }
    }
    List { heads, rows }
}

/// Draws a panel for each grouping.
fn draw(mut file: Replacement, shown: Measured, proposed: &[Limits]) -> Result<(), Problem> {
    let Measured { mut finished, curves, first_synchronised, .. } = shown;
    finished.window = Window { from: first_synchronised, to: None };
    let panel = |limits: &Limits| {
        let line = |name: &str, value: f64| Limit {
            text: format!("{name} = {}", number(value)),
            value: value * limits.grouping.in_trace,
        };
        Panel {
            curves: limits.grouping.followers.iter().map(|follower| follower.curve).collect(),
            limits: vec![line("MD37110", limits.warning), line("MD37120", limits.trip)],
        }
    };
    let panels: Vec<_> = proposed.iter().map(panel).collect();
    file.write(&finished.plot(&curves, &panels))?;
    file.finish()
}
