//! The cases of `opennck test`, before and after their run.

use std::path::PathBuf;
use std::time::Duration;

use crate::golden::{Case, Outcome};
use crate::source::Problem;

/// A case, or the reason why a file has none.
pub(super) enum Item {
    Case(Box<Case>),
    Unusable(Problem),
}

/// A case with its name and the file of its scenario.
pub(super) struct Work {
    pub(super) name: String,
    pub(super) file: PathBuf,
    pub(super) item: Item,
}

impl Work {
    /// The case, if its file is usable.
    pub(super) fn case(&self) -> Option<&Case> {
        match &self.item {
            Item::Case(case) => Some(case),
            Item::Unusable(_) => None,
        }
    }

    /// The files and folders that it reads, the golden file included.
    pub(super) fn inputs(&self) -> Vec<PathBuf> {
        let of_case = self.case().map(|case| {
            let mut inputs = case.scenario.inputs();
            inputs.push(case.snap.clone());
            inputs
        });
        of_case.unwrap_or_else(|| vec![self.file.clone()])
    }
}

/// A case that has run.
pub(super) struct Ran {
    pub(super) outcome: Outcome,
    /// By the clock of the computer.
    pub(super) time: Duration,
    /// The timing diagram of a case that did not pass; it needs a run.
    pub(super) picture: Option<String>,
}

/// The number of cases, and how many ended how.
pub(super) fn sum(done: &[(&Work, Ran)], left: usize, has_shard: bool) -> String {
    let count = done.len() + left;
    let noun = if count == 1 { "case" } else { "cases" };
    let counts = counts(done, left);
    match (counts.is_empty(), has_shard) {
        (false, _) => format!("{count} {noun}: {counts}"),
        (true, true) => format!("{count} {noun}: none in this shard"),
        (true, false) => format!("{count} {noun}"),
    }
}

/// How many cases ended how; empty without cases.
fn counts(done: &[(&Work, Ran)], left: usize) -> String {
    let count = |test: fn(&Outcome) -> bool| done.iter().filter(|(_, ran)| test(&ran.outcome)).count();
    let counts = [
        (count(|outcome| matches!(outcome, Outcome::Held)), "passed"),
        (count(|outcome| matches!(outcome, Outcome::Accepted)), "accepted"),
        (count(|outcome| matches!(outcome, Outcome::Failed(_))), "failed"),
        (count(|outcome| matches!(outcome, Outcome::Untrue(_))), "with wrong causes"),
        (count(|outcome| matches!(outcome, Outcome::Differs(_))), "differ"),
        (count(|outcome| matches!(outcome, Outcome::Missing(_))), "without a golden file"),
        (count(|outcome| matches!(outcome, Outcome::Unusable(_))), "unusable"),
        (left, "not run"),
    ];
    let counts = counts.iter().filter(|(count, _)| *count > 0).map(|(count, word)| format!("{count} {word}"));
    counts.collect::<Vec<_>>().join(", ")
}
