//! The smallest scenario that fails in the same way as a case, as a file that runs alone.

use std::ops::Range;
use std::path::{Component, Path, PathBuf};

use super::apply::{applied, edit_list};
use super::dimension::{Choice, Edit};
use super::oracles::SOMETIMES;
use super::record::Record;
use super::run::{chain, signature};
use super::spec::Spec;
use super::written;
use crate::plc::Programs;
use crate::scenario::{Failure, Missed, Scenario};
use crate::source::{Node, Table, Value};

/// The number of rules in the chain of causes that must be the same.
const NEAREST: usize = 3;

/// The smallest scenario that fails in the same way.
#[derive(Clone, Debug, PartialEq)]
pub struct Smallest {
    /// The file.
    pub text: String,
    /// The values that are needed: the others are those of the base scenario.
    pub needed: Vec<(String, String)>,
    /// The number of its steps, and of those of the base scenario.
    pub steps: (usize, usize),
}

/// The lists of the base scenario of which parts are removed, in this order.
const LISTS: [&str; 4] = ["rule", "never", "always", "step"];

/// The indices of the entries of each list that are kept.
#[derive(Clone, Debug)]
struct Kept(Vec<(&'static str, Vec<usize>)>);

impl Kept {
    fn all(base: &Table) -> Self {
        let list = LISTS.into_iter().map(|key| (key, (0..count(base, key)).collect::<Vec<_>>()));
        Self(list.filter(|(_, indices)| !indices.is_empty()).collect())
    }

    fn count(&self, key: &str) -> usize {
        self.0.iter().find(|(known, _)| *known == key).map_or(0, |(_, indices)| indices.len())
    }

    fn without(&self, key: &str, range: Range<usize>) -> Self {
        let mut fewer = self.clone();
        if let Some((_, indices)) = fewer.0.iter_mut().find(|(known, _)| *known == key) {
            indices.drain(range);
        }
        fewer
    }
}

impl Spec {
    /// Shrinks a case that failed to a scenario that runs alone from the folder `folder` and fails in the same way. `None` if it only fails
    /// together with its campaign: a trace that differs from the golden one.
    #[must_use]
    pub fn shrink(&self, record: &Record, folder: &Path, programs: &Programs) -> Option<Smallest> {
        let mut choices = self.choices_of(record);
        let mut kept = Kept::all(&self.base);
        let all = kept.count("step");
        let mut missed = self.fails(&choices, &kept, record, programs)?;
        // First each value back to that of the base scenario.
        for index in 0..choices.len() {
            let mut fewer = choices.clone();
            fewer[index].edits.clear();
            if let Some(now) = self.fails(&fewer, &kept, record, programs) {
                (choices, missed) = (fewer, now);
            }
        }
        let base: Vec<Choice> = choices.iter().map(|_| Choice { text: String::new(), edits: Vec::new() }).collect();
        let is_needed = choices.iter().any(|choice| !choice.edits.is_empty());
        // Then rules, conditions and steps: halves first, then single ones, the last ones first.
        for key in LISTS {
            let mut size = kept.count(key);
            while size > 0 {
                let mut end = kept.count(key);
                while end > 0 {
                    let start = end.saturating_sub(size);
                    let fewer = kept.without(key, start..end);
                    end = start;
                    if fewer.count("step") == 0 {
                        continue;
                    }
                    let Some(now) = self.fails(&choices, &fewer, record, programs) else { continue };
                    // What fails with the values of the base scenario, too, shows nothing: a step that others made true was removed.
                    if is_needed && self.fails(&base, &fewer, record, programs).is_some() {
                        continue;
                    }
                    (kept, missed) = (fewer, now);
                }
                size /= 2;
            }
        }
        let smallest = self.table(&choices, &kept, record)?;
        let steps = kept.count("step");
        let needed = self.dimensions.iter().zip(&choices).filter(|(_, choice)| !choice.edits.is_empty());
        let needed: Vec<_> = needed.map(|(one, choice)| (one.name.clone(), choice.text.clone())).collect();
        let text = self.file(smallest, record, &missed, &needed, folder);
        Some(Smallest { text, needed, steps: (steps, all) })
    }

    /// The tables of a scenario with these values and these parts of the base scenario.
    fn table(&self, choices: &[Choice], kept: &Kept, record: &Record) -> Option<Table> {
        let mut base = self.base.clone();
        for (key, indices) in &kept.0 {
            let is_kept = |index: &usize| indices.contains(index);
            edit_list(&mut base, key, |list| {
                let old = std::mem::take(list);
                list.extend(old.into_iter().enumerate().filter(|(index, _)| is_kept(index)).map(|(_, node)| node));
            });
        }
        let mut choices = choices.to_vec();
        let steps =
            kept.0.iter().find(|(key, _)| *key == "step").map(|(_, indices)| indices.as_slice()).unwrap_or_default();
        for choice in &mut choices {
            choice.edits.retain_mut(|edit| match edit {
                // A delay belongs to its step.
                Edit::Delay(step, _) => match steps.iter().position(|known| known == step) {
                    Some(index) => {
                        *step = index;
                        true
                    }
                    None => false,
                },
                Edit::Put(..) | Edit::At(_) => true,
            });
        }
        let mut table = applied(&base, &choices).ok()?;
        self.with_condition(&mut table, &record.failure);
        Some(table)
    }

    /// The failure of this scenario, if it is that of the record.
    fn fails(&self, choices: &[Choice], kept: &Kept, record: &Record, programs: &Programs) -> Option<Missed> {
        let (missed, chain) = self.failure_of(&self.table(choices, kept, record)?, programs)?;
        // The rules before these are the history of the machine, which fewer steps change.
        let is_same = record.chain.is_empty() || record.chain.iter().take(NEAREST).eq(chain.iter().take(NEAREST));
        (is_same && signature(&missed.what) == self.wanted(&record.failure)).then_some(missed)
    }

    /// The choices of the case of a record; a value that was bisected has its own.
    fn choices_of(&self, record: &Record) -> Vec<Choice> {
        let mut choices = self.choices(record.case);
        if let Some((index, key, ..)) = self.bisected()
            && let Some(value) = record.values.get(index).and_then(|(_, text)| text.parse().ok())
        {
            choices[index] = self.dimensions[index].put(key, value);
        }
        choices
    }

    /// The text of the failure when the scenario runs alone.
    fn wanted(&self, failure: &str) -> String {
        let number = || failure.split_whitespace().nth(1).unwrap_or_default().to_owned();
        if failure.contains("`alarms.may`") {
            format!("`never` is violated: `alarm({})` is true", number())
        } else if failure.contains("`alarms.must`") {
            format!("expected `count(alarm({})) > 0`, but it is false", number())
        } else {
            failure.to_owned()
        }
    }

    fn failure_of(&self, table: &Table, programs: &Programs) -> Option<(Missed, Vec<String>)> {
        let scenario = Scenario::of_table(table.clone(), &self.scenario).ok()?;
        let finished = scenario.prepare(self.profile, programs).ok()?.run();
        match &finished.failure {
            Some(Failure::Missed(missed)) => Some(((**missed).clone(), chain(missed, &finished))),
            Some(Failure::Unusable(_)) | None => None,
        }
    }

    /// The scenario as a file in a folder: its paths are relative to this.
    fn file(
        &self,
        mut table: Table,
        record: &Record,
        missed: &Missed,
        needed: &[(String, String)],
        folder: &Path,
    ) -> String {
        edit_list(&mut table, "rule", |rules| rules.retain(|rule| !is_sometimes(rule)));
        let place = table.place.clone();
        let node = |value| Node { place: place.clone(), value };
        let base = self.base_title();
        let of = if base == self.title { String::new() } else { format!(" of {}", self.title) };
        let title = format!("{base} [case {}{of}]", record.case);
        let _ = table.put(&["title"], &place, node(Value::Text(title)));
        let mut text = String::new();
        text += &format!(
            "# The smallest scenario that fails like case {} of the campaign \"{}\".\n",
            record.case, self.title
        );
        text += &format!("# At {} s: {}\n", missed.time, missed.what);
        for (key, value) in needed {
            text += &format!("# Needed: {key} = {value}\n");
        }
        // What belongs to a suite and not to one failing case.
        let mut own = Table::empty(place.clone());
        let from = absolute(self.scenario.parent().unwrap_or_else(|| Path::new("")));
        let to = absolute(folder);
        for (key, node) in table.entries() {
            if ["covers", "profile"].contains(&key) || matches!(&node.value, Value::Array(list) if list.is_empty()) {
                continue;
            }
            let moved = moved(key, node, &from, &to);
            let _ = own.put(&[key], &place, moved);
        }
        let profile = Value::Text(self.profile.name().to_owned());
        let _ = own.put(&["profile"], &place, node(profile));
        text + &written::scenario(&own)
    }

    fn base_title(&self) -> String {
        let title = self.base.entries().find(|(key, _)| *key == "title");
        title.map_or_else(|| self.title.clone(), |(_, node)| written::plain(node))
    }
}

fn is_sometimes(rule: &Node) -> bool {
    let Value::Table(table) = &rule.value else { return false };
    table.entries().any(|(key, node)| key == "name" && written::plain(node).starts_with(SOMETIMES))
}

fn count(table: &Table, key: &str) -> usize {
    table.entries().find(|(known, _)| *known == key).map_or(0, |(_, node)| node.clone().into_list().len())
}

/// A value of the head or a list of steps, with its paths relative to another folder.
fn moved(key: &str, node: &Node, from: &Path, to: &Path) -> Node {
    let text = |text: &str| Node { place: node.place.clone(), value: Value::Text(relative(&from.join(text), to)) };
    match (key, &node.value) {
        ("machine", Value::Text(path)) if from.join(path).exists() => text(path),
        ("plc", Value::Text(path)) if path.contains('/') && from.join(path).exists() => text(path),
        ("plc_image", Value::Text(path)) if path.ends_with(".toml") => text(path),
        ("plc_image", Value::Text(name)) => image(name, from).map_or_else(|| node.clone(), |path| text(&path)),
        ("program" | "include", Value::Text(path)) => text(path),
        ("program_path" | "step", Value::Array(list)) => {
            let inner = |one: &Node| match &one.value {
                Value::Table(table) => {
                    let mut step = Table::empty(table.place.clone());
                    for (key, node) in table.entries() {
                        let _ = step.put(&[key], &node.place, moved(key, node, from, to));
                    }
                    Node { place: one.place.clone(), value: Value::Table(step) }
                }
                Value::Text(_) => moved("program", one, from, to),
                _ => one.clone(),
            };
            Node { place: node.place.clone(), value: Value::Array(list.iter().map(inner).collect()) }
        }
        _ => node.clone(),
    }
}

/// The file of a PLC image that is found by its name above a folder.
fn image(name: &str, from: &Path) -> Option<String> {
    let file = Path::new("plc_images").join(format!("{name}.toml"));
    let found = from.ancestors().map(|folder| folder.join(&file)).find(|file| file.is_file())?;
    Some(found.display().to_string())
}

fn absolute(path: &Path) -> PathBuf {
    let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}

/// A path relative to a folder, with `/`.
fn relative(path: &Path, to: &Path) -> String {
    let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let (mut from, mut to) = (path.components().peekable(), to.components().peekable());
    if from.peek() != to.peek() {
        return path.display().to_string();
    }
    while from.peek().is_some() && from.peek() == to.peek() {
        from.next();
        to.next();
    }
    let up = to.map(|_| "..".to_owned());
    let down = from.map(|part| match part {
        Component::Normal(name) => name.to_string_lossy().into_owned(),
        other => other.as_os_str().to_string_lossy().into_owned(),
    });
    up.chain(down).collect::<Vec<_>>().join("/")
}
