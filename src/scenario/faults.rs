//! The faults of the verbs `fault` and `clear_fault`: `{ axis = "XF", kind = "block" }`.

use super::naming::axis_named;
use crate::machine::{Fault, FaultKind, Machine, Switch};
use crate::source::{Node, Problem, Value, did_you_mean};
use crate::units::Position;
use crate::variables::FaultName;

/// The fastest drift in mm or degrees per second. No real axis is faster.
const FASTEST_DRIFT: f64 = 1e6;
/// The largest push in mm or degrees: one kilometre, longer than any machine.
const FARTHEST_PUSH: f64 = 1e6;

/// Reads a fault. If the fault begins, its amount is required.
pub(super) fn fault(node: Node, begins: bool, machine: &Machine) -> Result<Fault, Problem> {
    let place = node.place.clone();
    let mut table = node.into_table("a fault, as { axis = \"XF\", kind = \"block\" }")?;
    let mut required = |key: &'static str| {
        table.take(key).ok_or_else(|| {
            place.problem(format!("expected the key `{key}`, found none"), "write { axis = \"XF\", kind = \"block\" }")
        })
    };
    let axis = required("axis")?;
    let kind = required("kind")?;
    let axis =
        axis_named(machine, axis.text("the name of a machine axis")?).map_err(|problem| problem.at(&axis.place))?;
    let mut by = |what: &str, largest: f64, cure: &str| match table.take("by") {
        None if begins => Err(place.problem("expected the key `by`, found none", "write by = 0.05")),
        None => Ok(0.0),
        Some(node) => match node.number(what)? {
            number if number.abs() <= largest => Ok(number),
            _ => Err(node.expected(what, cure)),
        },
    };
    let mut distance = || {
        let what = "a distance in mm or degrees from -1000000 to 1000000";
        Ok::<_, Problem>(Position::from_user(by(what, FARTHEST_PUSH, "write by = 0.05")?))
    };
    let kind = match kind.text("the kind of a fault")? {
        "block" => FaultKind::Block,
        "push" => FaultKind::Push { by: distance()? },
        "encoder_slip" => FaultKind::EncoderSlip { by: distance()? },
        "zero_mark_missing" => FaultKind::ZeroMarkMissing,
        "switch_stuck" => {
            let mut required = |key: &'static str, example: &str| {
                table.take(key).ok_or_else(|| {
                    place.problem(format!("expected the key `{key}`, found none"), format!("write {example}"))
                })
            };
            let which = required("which", "which = \"cam\"")?;
            let at = required("at", "at = 1")?;
            FaultKind::SwitchStuck { which: switch(&which)?, at: one_or_zero(&at)? }
        }
        "drive_fault" => FaultKind::DriveFault,
        "encoder_fault" => {
            FaultKind::EncoderFault { encoder: table.take("encoder").map(|node| encoder(&node)).transpose()? }
        }
        "friction" => {
            let share = by("a share of the velocity, 0 to 1", 1.0, "0 loses nothing, 1 loses everything")?;
            if share < 0.0 {
                return Err(place
                    .problem("expected a share of the velocity, 0 to 1, found a negative number", "0 loses nothing"));
            }
            FaultKind::Friction { by: share }
        }
        "drift" => {
            let what = "a velocity in mm or degrees per second";
            let velocity = by(what, FASTEST_DRIFT, "write a velocity from -1000000 to 1000000")?;
            FaultKind::Drift { by: velocity * Position::PER_USER_UNIT }
        }
        other => {
            let known = FaultName::ALL.map(FaultName::name);
            let fallback = format!("kinds are {}", known.join(", "));
            return Err(kind.expected("a kind of fault", &did_you_mean(other, known, &fallback)));
        }
    };
    table.finish()?;
    Ok(Fault { axis, kind })
}

fn switch(node: &Node) -> Result<Switch, Problem> {
    match node.text("the name of a switch")? {
        "cam" => Ok(Switch::Cam),
        "limit_plus" => Ok(Switch::LimitPlus),
        "limit_minus" => Ok(Switch::LimitMinus),
        other => {
            let cure =
                did_you_mean(other, ["cam", "limit_plus", "limit_minus"], "switches are cam, limit_plus, limit_minus");
            Err(node.expected("the name of a switch", &cure))
        }
    }
}

fn encoder(node: &Node) -> Result<u8, Problem> {
    match node.value {
        Value::Integer(1) => Ok(0),
        Value::Integer(2) => Ok(1),
        _ => Err(node.expected("encoder 1 or 2", "write encoder = 2, or omit it for the active encoder")),
    }
}

fn one_or_zero(node: &Node) -> Result<bool, Problem> {
    match node.value {
        Value::Integer(0) | Value::Boolean(false) => Ok(false),
        Value::Integer(1) | Value::Boolean(true) => Ok(true),
        _ => Err(node.expected("0 or 1", "write at = 1")),
    }
}
