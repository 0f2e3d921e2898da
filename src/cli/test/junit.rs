//! `--junit`: a report in the format of JUnit, which CI servers show.
//!
//! A case has its name, its time by the clock of the computer in seconds, its folder as `classname` (`golden.jog`), the `file` of its
//! scenario, and a property `rule` for each rule that it cites.

use std::path::{Component, Path};
use std::time::Duration;

use quick_junit::{NonSuccessKind, Property, Report, TestCase, TestCaseStatus, TestSuite};

use super::work::{Ran, Work};
use crate::golden::Outcome;
use crate::source::Problem;

/// The report of all cases that ran.
pub(super) fn text(done: &[(&Work, Ran)], took: Duration) -> Result<String, Problem> {
    let mut suite = TestSuite::new("scenarios");
    suite.set_time(took);
    suite.add_test_cases(done.iter().map(|(work, ran)| case(work, ran)));
    let mut report = Report::new("opennck");
    report.set_time(took).add_test_suite(suite);
    report
        .to_string()
        .map_err(|error| Problem::new(format!("the report cannot be written: {error}"), "report this as a bug"))
}

fn case(work: &Work, Ran { outcome, time, .. }: &Ran) -> TestCase {
    let status = match outcome {
        Outcome::Held | Outcome::Accepted => TestCaseStatus::success(),
        Outcome::Failed(_) | Outcome::Untrue(_) | Outcome::Differs(_) | Outcome::Missing(_) => {
            bad(NonSuccessKind::Failure, outcome)
        }
        Outcome::Unusable(_) => bad(NonSuccessKind::Error, outcome),
    };
    let mut case = TestCase::new(work.name.as_str(), status);
    case.set_classname(class(&work.file)).set_time(*time);
    case.extra.insert("file".into(), work.file.display().to_string().into());
    if let Some(known) = work.case() {
        case.add_properties(known.scenario.covers.iter().map(|rule| Property::new("rule", rule.as_str())));
    }
    case
}

/// The folder of a scenario as the name of a class: `golden/jog/a.toml` is in `golden.jog`.
fn class(file: &Path) -> String {
    let folders = file.parent().into_iter().flat_map(Path::components).filter_map(|component| match component {
        Component::Normal(name) => Some(name.to_string_lossy().replace('.', "_")),
        Component::Prefix(_) | Component::RootDir | Component::CurDir | Component::ParentDir => None,
    });
    let class = folders.collect::<Vec<_>>().join(".");
    if class.is_empty() { "scenarios".to_owned() } else { class }
}

fn bad(kind: NonSuccessKind, outcome: &Outcome) -> TestCaseStatus {
    let text = outcome.to_string();
    let mut status = TestCaseStatus::non_success(kind);
    status.set_message(text.lines().next().unwrap_or_default().to_owned()).set_description(text);
    status
}
