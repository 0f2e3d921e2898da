//! Applies the values of a case to the tables of its base scenario.

use super::dimension::{Choice, Edit};
use crate::source::{Node, Place, Problem, Table, Value};

/// The keys of the head that a campaign can vary; other keys are machine data.
const HEAD: [&str; 9] = ["machine", "profile", "plc", "plc_image", "program", "nc", "program_path", "limit", "causes"];

/// The path of a key of `[vary]` in the tables of a scenario: `plant.XF.start`, `plc`, `37110[XF]`.
pub(super) fn path(key: &str) -> Vec<String> {
    match key.strip_prefix("plant.") {
        Some(rest) => std::iter::once("plant").chain(rest.split('.')).map(str::to_owned).collect(),
        None if HEAD.contains(&key) => vec![key.to_owned()],
        None => vec!["machine_data".to_owned(), key.to_owned()],
    }
}

/// The base with the values of a case.
pub(super) fn applied<'a>(base: &Table, choices: impl IntoIterator<Item = &'a Choice>) -> Result<Table, Problem> {
    let mut table = base.clone();
    let mut delays: Vec<(usize, u64)> = Vec::new();
    for edit in choices.into_iter().flat_map(|choice| &choice.edits) {
        match edit {
            Edit::Put(path, node) => put(&mut table, path, node)?,
            Edit::At(entry) => {
                let place = entry.place.clone();
                append(&mut table, "at", Node { place, value: Value::Table(entry.clone()) });
            }
            Edit::Delay(step, cycles) if *cycles > 0 => delays.push((*step, *cycles)),
            Edit::Delay(..) => {}
        }
    }
    delays.sort_unstable();
    for (step, cycles) in delays.into_iter().rev() {
        edit_list(&mut table, "step", |steps| {
            let place = steps.get(step).map_or_else(|| base.place.clone(), |node| node.place.clone());
            steps.insert(step.min(steps.len()), run_of(cycles, &place));
        });
    }
    Ok(table)
}

/// The step that lets so many cycles pass.
fn run_of(cycles: u64, place: &Place) -> Node {
    let mut step = Table::empty(place.clone());
    let value = Value::Text(format!("{cycles}cycles"));
    let _ = step.put(&["run"], place, Node { place: place.clone(), value });
    Node { place: place.clone(), value: Value::Table(step) }
}

pub(super) fn put(table: &mut Table, path: &[String], node: &Node) -> Result<(), Problem> {
    let keys: Vec<&str> = path.iter().map(String::as_str).collect();
    table.put(&keys, &node.place, node.clone()).map_err(|part| {
        let what =
            format!("expected a table `{part}`, found another value, so `{}` cannot be set in it", keys.join("."));
        node.place.problem(what, "remove that value from the scenario")
    })
}

/// Adds a value to the end of a list, which is created.
pub(super) fn append(table: &mut Table, key: &str, node: Node) {
    edit_list(table, key, |list| list.push(node));
}

/// Changes a list; one value counts as a list of one, none as an empty list.
pub(super) fn edit_list(table: &mut Table, key: &str, edit: impl FnOnce(&mut Vec<Node>)) {
    let old = table.entries().find(|(known, _)| *known == key).map(|(_, node)| node.clone());
    let place = old.as_ref().map_or_else(|| table.place.clone(), |node| node.place.clone());
    let mut list = old.map_or_else(Vec::new, Node::into_list);
    edit(&mut list);
    // A path of one key can always be put.
    let _ = table.put(&[key], &place, Node { place: place.clone(), value: Value::Array(list) });
}

/// Adds the rules and conditions of a campaign to its scenario.
pub(super) fn add(base: &mut Table, key: &str, node: Option<Node>) {
    if let Some(node) = node {
        edit_list(base, key, |list| list.extend(node.into_list()));
    }
}
