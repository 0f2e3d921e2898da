//! The verb `include`: the steps of another file, once or several times.
//!
//! The included file is a list of steps; if it is a scenario, its head is checked and has no other effect. Its steps are read where they are
//! included, so captured names are shared in both directions. Steps that repeat are stored once.

use std::path::{Path, PathBuf};

use super::file::steps_of;
use super::steps::{Action, Included, Reader, Step, Steps, whole};
use super::written::WrittenSteps;
use crate::source::{Node, Problem, Table, read_text};

/// The largest number of times that steps can be repeated, with the repetitions of the files that include them.
const TIMES: u64 = 1_000_000;

impl Reader<'_> {
    /// Reads `include = "file.toml"`, `times = 3`.
    pub(super) fn include(
        &mut self,
        node: &Node,
        table: &mut Table,
        note: Option<Box<str>>,
        list: &mut Steps,
    ) -> Result<(), Problem> {
        let place = table.place.clone();
        let name = node.text("the file whose steps run here")?;
        let times = table.take("times").map(|node| {
            let what = format!("a number of times from 1 to {TIMES}");
            whole(&node, &what, 1..=TIMES)
        });
        let times = times.transpose()?.unwrap_or(1);
        if let Some(verb) = table.keys().next().map(str::to_owned) {
            let what = format!("expected `include` as the only verb of a step, found `{verb}`, too");
            return Err(place.problem(what, "`include` takes `times` and `note`; write another [[step]] for the rest"));
        }
        let including = self.files.last().map(PathBuf::as_path).unwrap_or_else(|| Path::new(""));
        let file = including.parent().unwrap_or_else(|| Path::new("")).join(name);
        self.refuse_circle(&file).map_err(|problem| problem.at(&node.place))?;
        let steps = steps_of(&file).map_err(|problem| match file.is_file() {
            true => problem,
            // The place where the name is wrong helps more than the file that is not there.
            false => {
                let what = format!("{} {}", file.display(), problem.what);
                node.place.problem(what, "check the path; it is relative to the file with `include`")
            }
        })?;
        if note.is_some() {
            list.steps.push(Step { place: place.clone(), note, action: Action::Nothing });
        }
        let from = list.steps.len();
        let outer = self.times;
        self.times = outer.saturating_mul(times);
        if self.times > TIMES {
            let what = format!("expected steps that run at most {TIMES} times, found {} times", self.times);
            return Err(place.problem(what, "the `times` of nested includes multiply; make one of them smaller"));
        }
        self.files.push(file);
        self.steps(&steps, list)?;
        self.files.pop();
        self.times = outer;
        if times > 1 {
            list.steps.push(Step { place: place.clone(), note: None, action: Action::Repeat { from, times } });
        }
        list.included.push(Included { place, range: from..list.steps.len(), times });
        Ok(())
    }

    /// A file must not include itself, not even by others.
    fn refuse_circle(&self, file: &Path) -> Result<(), Problem> {
        let real = |file: &Path| file.canonicalize().unwrap_or_else(|_| file.to_owned());
        let new = real(file);
        let Some(first) = self.files.iter().position(|known| real(known) == new) else {
            return Ok(());
        };
        let chain: Vec<String> = self.files[first..].iter().map(|file| file.display().to_string()).collect();
        Err(Problem::new(
            format!(
                "expected files that do not include each other in a circle, found {} -> {}",
                chain.join(" -> "),
                file.display()
            ),
            "move the shared steps into a file of their own",
        ))
    }
}

/// The files whose steps a file includes, without looking into them; nothing if the file cannot be read as a scenario.
///
/// # Errors
/// The file cannot be read, or is not TOML with steps.
pub fn included_by(file: &Path) -> Result<Vec<PathBuf>, Problem> {
    let text = read_text(file)?;
    if !text.contains("include") {
        return Ok(Vec::new());
    }
    let directory = file.parent().unwrap_or_else(|| Path::new(""));
    let mut files = Vec::new();
    let (_, steps) = WrittenSteps::read(&text, &file.display().to_string())?;
    steps.each(|mut step| {
        files.extend(step.take("include").and_then(|name| name.text("a file").map(|name| directory.join(name)).ok()));
        Ok(())
    })?;
    Ok(files)
}

/// Whether a file names a machine, as every scenario does.
#[must_use]
pub fn names_machine(file: &Path) -> bool {
    let head = read_text(file).and_then(|text| Table::parse(&text, &file.display().to_string()));
    head.is_ok_and(|mut head| head.take("machine").is_some())
}
