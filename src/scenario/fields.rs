//! Values of keys that several parts of a scenario have: texts with their places, lists of them, durations.

use super::duration::Duration;
use crate::source::{Node, Place, Problem, Value};

/// A text in a file, with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Named {
    /// The text.
    pub text: String,
    /// Its place in the file.
    pub place: Place,
}

pub(super) fn named(node: &Node, what: &str) -> Result<Named, Problem> {
    Ok(Named { text: node.text(what)?.to_owned(), place: node.place.clone() })
}

/// A text or a list of texts.
pub(super) fn texts(node: Option<Node>, what: &str) -> Result<Vec<Named>, Problem> {
    node.map_or_else(Vec::new, Node::into_list).iter().map(|node| named(node, what)).collect()
}

pub(super) fn duration(node: &Node, what: &str) -> Result<Duration, Problem> {
    let number = match &node.value {
        Value::Integer(number) => Some(number.to_string()),
        Value::Float(number) => Some(number.to_string()),
        Value::Text(_) | Value::Boolean(_) | Value::Array(_) | Value::Table(_) => None,
    };
    if let Some(number) = number {
        let cure = format!("write \"{number}s\"; units are us, ms, s, min, h and cycles");
        return Err(node.expected(&format!("{what} with its unit"), &cure));
    }
    Duration::parse(node.text(what)?).map_err(|problem| problem.at(&node.place))
}

/// The same problem, with the values of the case in which it occurs.
pub(super) fn in_the_case(problem: Problem, case: Option<&str>) -> Problem {
    match case {
        Some(case) => Problem { what: format!("{} (in the case {case})", problem.what), ..problem },
        None => problem,
    }
}
