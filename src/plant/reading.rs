//! Reads lengths and times of `plant.toml`.

use crate::source::{Node, Problem, Value};
use crate::units::{Position, Time};

/// The largest position that the control accepts for a software limit switch; nothing is beyond it.
const FARTHEST: f64 = 1e8;

pub(super) fn position(node: &Node, what: &str) -> Result<Position, Problem> {
    let number = node.number(what)?;
    if number.abs() > FARTHEST {
        return Err(node.expected(what, "positions are from -100000000 to 100000000"));
    }
    Ok(Position::from_user(number))
}

/// A distance of at least one increment.
pub(super) fn distance(node: &Node, what: &str) -> Result<Position, Problem> {
    let distance = position(node, what)?;
    if distance <= Position::ZERO {
        return Err(node.expected(what, "write a larger number"));
    }
    Ok(distance)
}

pub(super) fn time(node: &Node) -> Result<Time, Problem> {
    let what = "a time such as \"10ms\", at most 1h";
    let cure = "write a number and us, ms, s, min or h, in quotes";
    let time = match &node.value {
        Value::Text(text) => Time::parse(text),
        Value::Integer(_) | Value::Float(_) | Value::Boolean(_) | Value::Array(_) | Value::Table(_) => None,
    };
    time.filter(|time| *time <= Time::from_millis(3_600_000)).ok_or_else(|| node.expected(what, cure))
}
