//! `opennck` without arguments: runs chapter 2.7 of the gantry manual (G1) from data embedded in the program, and prints one screen of it.

use std::path::{Path, PathBuf};

use terminal_size::{Width, terminal_size};

use super::files::Files;
use super::output::Output;
use super::run::result;
use crate::plc::Programs;
use crate::scenario::{Finished, Scenario};
use crate::source::Problem;
use crate::trace::Watch;

/// The scenario, as it is in the repository.
const SCENARIO: &str = include_str!("../../golden/worked_example/chapter_2_7.toml");

/// The built-in machine.
const MACHINE: &str = "g1_example";

/// The signals on the screen. The scenario watches more of them, for the timing diagram.
const SCREEN: &[&str] = &[
    "X.start_gantry_synchronization",
    "X.referenced_synchronized_1",
    "XF.referenced_synchronized_1",
    "X.gantry_synchronization_ready_to_start",
    "X.gantry_grouping_is_synchronized",
    "XF.gantry_warning_limit_exceeded",
];

/// Rows with these texts are not on the screen: what ends is less important than what begins.
const OMITTED: &[&str] = &["1 -> 0", "set MD active", "alarm 10655"];

/// The longest row on the screen, if its width is not known.
const WIDTH: usize = 140;

const NEXT: &str = "
What to try next:
  opennck --svg F.svg                     the whole example as a timing diagram, with all its signals
  opennck why-not SCENARIO SIGNAL@TIME    what a signal waits for; opennck why: the causes of its last edge
  opennck rule REF-02                     what a rule says, where it stands, what shows it
  opennck signals 'reference cam'         signals by name, address or everyday words
  opennck --help                          all commands: run, test, serve, machine-data check, ...
";

/// The example as a scenario that needs no file. Its text is part of the program and tested, so that it can be used.
fn scenario() -> Result<Scenario, Problem> {
    let mut scenario = Scenario::parse(SCENARIO, Path::new("chapter_2_7.toml"))?;
    MACHINE.clone_into(&mut scenario.machine.text);
    Ok(scenario)
}

pub(super) fn run(svg: Option<PathBuf>, programs: &Programs, output: &mut Output) -> u8 {
    let written = || -> Result<_, Problem> {
        let picture = svg.map(|path| Files::of([]).open("--svg", &path)).transpose()?;
        let scenario = scenario()?;
        let profile = scenario.profiles.first().copied().unwrap_or_default();
        let finished = scenario.prepare(profile, programs)?.run();
        let screen = screen(&finished)?;
        if let Some(mut picture) = picture {
            picture.write(&finished.svg())?;
            picture.finish()?;
        }
        Ok((screen, finished))
    };
    match written() {
        Ok((screen, finished)) => {
            output.print(&screen);
            let code = result(&finished, output);
            output.print(NEXT);
            code
        }
        Err(problem) => {
            output.error(problem);
            2
        }
    }
}

/// One screen of the trace: notes, alarms, data, and what begins.
fn screen(finished: &Finished) -> Result<String, Problem> {
    let session = finished.session();
    let machine = session.machine();
    let watch =
        Watch::parse(SCREEN, machine.names(), machine.memory(), machine.variables()).map_err(|(_, problem)| problem)?;
    let rows = session.trace().text(machine, &watch, true);
    let shown = rows.lines().filter(|row| !OMITTED.iter().any(|text| row.contains(text)));
    // On a terminal, a row is a line of it.
    let width = terminal_size().map_or(WIDTH, |(Width(columns), _)| usize::from(columns).clamp(40, WIDTH));
    Ok(shown.map(|row| cut(row, width) + "\n").collect())
}

fn cut(row: &str, width: usize) -> String {
    match row.char_indices().nth(width - 1) {
        Some((end, _)) if row.chars().count() > width => format!("{}\u{2026}", &row[..end]),
        Some(_) | None => row.to_owned(),
    }
}
