//! The answer on the screen and in files: what fails, what to do next, margins, what no case reached.

use std::path::Path;

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use serde_json::json;

use super::answer::{Answer, counts, in_words, next, values};
use super::page;
use crate::campaign::{Group, Spec, Summary, Verdict};
use crate::cli::output::Output;
use crate::plc::Programs;
use crate::source::{Problem, replace, unwritable};

/// The number of groups that are shrunk and printed.
const GROUPS: usize = 20;

/// Writes the report into the folder of the results and prints its first screen. Returns the exit code.
pub(super) fn report(
    spec: &Spec,
    mut summary: Summary,
    folder: &Path,
    programs: &Programs,
    output: &mut Output,
) -> Result<u8, Problem> {
    summary.finish(spec, programs)?;
    let missing = summary.not_reached(spec, programs)?;
    let failures = folder.join("failures");
    if failures.is_dir() {
        // Those of an earlier run.
        for entry in std::fs::read_dir(&failures).map_err(|error| unwritable(&failures, &error))?.flatten() {
            let path = entry.path();
            if path.extension().is_some_and(|extension| extension == "toml") {
                std::fs::remove_file(&path).map_err(|error| unwritable(&path, &error))?;
            }
        }
    }
    let mut answers = Vec::new();
    for (index, group) in summary.groups.iter().enumerate() {
        let mut answer = Answer { group: group.clone(), file: None, smallest: None };
        if index < GROUPS {
            std::fs::create_dir_all(&failures).map_err(|error| unwritable(&failures, &error))?;
            if let Some(smallest) = spec.shrink(&group.first, &failures, programs) {
                let name = format!("failures/{}.toml", index + 1);
                replace(&folder.join(&name), &smallest.text)?;
                (answer.file, answer.smallest) = (Some(name), Some(smallest));
            }
        }
        answers.push(answer);
    }
    replace(&folder.join("report.json"), &json_text(spec, &summary, &answers, &missing))?;
    replace(&folder.join("junit.xml"), &junit(spec, &summary, &answers)?)?;
    replace(&folder.join("report.html"), &page::text(spec, &summary, &answers, &missing))?;
    screen(&summary, &answers, folder, output);
    let has = |verdict| summary.verdicts.get(verdict).is_some_and(|count| *count > 0);
    Ok(match summary.is_good() {
        true => 0,
        false if has("unusable") && !has("failed") => 2,
        false => 1,
    })
}

fn screen(summary: &Summary, answers: &[Answer], folder: &Path, output: &mut Output) {
    output.line(counts(summary));
    for (index, answer) in answers.iter().take(GROUPS).enumerate() {
        let group = &answer.group;
        let noun = if group.count == 1 { "case" } else { "cases" };
        output.line(format!("\n{}. {} {noun}: {}", index + 1, group.count, group.failure));
        if !group.chain.is_empty() {
            output.line(format!("   because of {}", group.chain.join(" <- ")));
        }
        values(group).for_each(|line| output.line(format!("   {line}")));
        if let Some(smallest) = &answer.smallest {
            let needed: Vec<_> = smallest.needed.iter().map(|(key, value)| format!("{key} = {value}")).collect();
            let (steps, of) = smallest.steps;
            let needed = if needed.is_empty() { "nothing that varies".to_owned() } else { needed.join(", ") };
            output.line(format!("   the smallest scenario needs {needed}, and {steps} of {of} steps"));
        }
        output.line(format!("   next: {}", next(answer, folder)));
    }
    if answers.len() > GROUPS {
        output.line(format!("\n{} more groups are in the report", answers.len() - GROUPS));
    }
    for text in &summary.never_reached {
        output.line(format!("\nno case reached {text}\n   next: vary more, or longer; or this cannot happen"));
    }
    for boundary in &summary.boundaries {
        output.line(format!("\nboundary: {}", in_words(boundary)));
    }
    if !summary.margins.is_empty() {
        output.line("\nsmallest margins:");
        for margin in summary.margins.iter().take(GROUPS) {
            let unit = if margin.in_cycles { " cycles" } else { "" };
            output.line(format!("   {}{unit} in case {}: {}", margin.amount, margin.case, margin.rule));
        }
    }
    output.line(format!("\nreport: {}", folder.join("report.html").display()));
}

fn json_text(spec: &Spec, summary: &Summary, answers: &[Answer], missing: &[String]) -> String {
    let pairs = |pairs: &[(String, String)]| {
        pairs.iter().map(|(key, value)| (key.clone(), json!(value))).collect::<serde_json::Map<_, _>>()
    };
    let groups: Vec<_> = answers
        .iter()
        .map(|answer| {
            let Group { failure, chain, count, first, values } = &answer.group;
            json!({
                "failure": failure, "chain": chain, "cases": count, "first_case": first.case, "at": first.at,
                "values": values.iter().map(|(key, values)| (key.clone(), json!(values))).collect::<serde_json::Map<_, _>>(),
                "scenario": answer.file,
                "needed": answer.smallest.as_ref().map(|smallest| pairs(&smallest.needed)),
            })
        })
        .collect();
    let margins: Vec<_> = summary
        .margins
        .iter()
        .map(|row| json!({ "rule": row.rule, "amount": row.amount, "in_cycles": row.in_cycles, "case": row.case, "values": pairs(&row.values) }))
        .collect();
    let boundaries: Vec<_> = summary
        .boundaries
        .iter()
        .map(|one| json!({ "values": pairs(&one.values), "key": one.key, "held": one.held, "failed": one.failed }))
        .collect();
    let report = json!({
        "title": spec.title, "spec": spec.hash, "strategy": spec.strategy(), "cases": summary.cases,
        "verdicts": summary.verdicts, "groups": groups, "never_reached": summary.never_reached, "margins": margins, "boundaries": boundaries,
        "reached": summary.reached, "not_reached": missing,
    });
    format!("{report:#}\n")
}

/// Each group of failures is a test that failed, what no case reached another one; all cases that held are one test.
fn junit(spec: &Spec, summary: &Summary, answers: &[Answer]) -> Result<String, Problem> {
    let mut suite = TestSuite::new(spec.title.as_str());
    let bad = |kind, text: &str, shown: &str| {
        let mut status = TestCaseStatus::non_success(kind);
        status.set_message(text.to_owned()).set_description(shown.to_owned());
        status
    };
    let mut add = |name: String, status| {
        let mut case = TestCase::new(name, status);
        case.set_classname("campaign");
        suite.add_test_case(case);
    };
    if let Some(held) = summary.verdicts.get("held") {
        add(format!("{held} cases held"), TestCaseStatus::success());
    }
    for answer in answers {
        let group = &answer.group;
        let kind = match group.first.verdict {
            Verdict::Unusable => NonSuccessKind::Error,
            Verdict::Held | Verdict::Failed => NonSuccessKind::Failure,
        };
        add(format!("{} cases: {}", group.count, group.failure), bad(kind, &group.failure, &group.first.text));
    }
    for text in &summary.never_reached {
        let shown = format!("no case reached {text}");
        add(shown.clone(), bad(NonSuccessKind::Failure, &shown, &shown));
    }
    let mut report = Report::new("opennck campaign");
    report.add_test_suite(suite);
    let text = report.to_string();
    text.map_err(|error| Problem::new(format!("the report cannot be written: {error}"), "report this as a bug"))
}
