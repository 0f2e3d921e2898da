//! A group of failures with its smallest scenario, and what the screen and the page say about it.

use std::path::Path;

use crate::campaign::{Boundary, Group, Smallest, Summary, Verdict};

/// A group with the file of its smallest scenario.
pub(super) struct Answer {
    pub(super) group: Group,
    /// The file below the folder of the results.
    pub(super) file: Option<String>,
    pub(super) smallest: Option<Smallest>,
}

/// The counts in one line.
pub(super) fn counts(summary: &Summary) -> String {
    let noun = if summary.cases == 1 { "case" } else { "cases" };
    let counts: Vec<_> = summary.verdicts.iter().map(|(verdict, count)| format!("{count} {verdict}")).collect();
    format!("{} {noun}: {}", summary.cases, counts.join(", "))
}

/// The values of a group in one line each.
pub(super) fn values(group: &Group) -> impl Iterator<Item = String> {
    group.values.iter().map(|(key, values)| {
        let more = if values.len() >= 10 { ", …" } else { "" };
        format!("{key}: {}{more}", values.join(", "))
    })
}

/// What a person does next about a group.
pub(super) fn next(answer: &Answer, folder: &Path) -> String {
    match (&answer.file, answer.group.first.verdict) {
        (Some(file), _) => format!("opennck run {}", folder.join(file).display()),
        (None, Verdict::Unusable) => "remove these values from the campaign, or add what they need".to_owned(),
        (None, _) => format!("look at case {} in results.jsonl", answer.group.first.case),
    }
}

/// Where a result changes.
pub(super) fn in_words(boundary: &Boundary) -> String {
    let Boundary { values, key, held, failed } = boundary;
    let others: Vec<_> = values.iter().map(|(key, value)| format!("{key} = {value}")).collect();
    let with = if others.is_empty() { String::new() } else { format!(", with {}", others.join(", ")) };
    format!("{key} = {held} holds, {key} = {failed} fails{with}")
}
