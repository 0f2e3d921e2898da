//! The conditions of a signal as a tree: what must hold before it has a value, what is found now, and who wrote it last.

use std::collections::BTreeSet;

use serde::Serialize;

use super::picture::Written;
use crate::image::{Location, Writer};
use crate::machine::{Machine, Subject, Tested};
use crate::source::Problem;

/// The deepest branch. A control asks for a signal only once, so a tree ends by itself; this bounds its size.
const DEEPEST: usize = 12;

/// A condition with what is found now.
#[derive(Serialize)]
pub(super) struct Tree {
    /// The signal, the fact, `all of` or `one of`.
    what: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    address: Option<String>,
    /// What is found and what is wanted; nothing for a group.
    #[serde(skip_serializing_if = "Option::is_none")]
    found: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    wanted: Option<String>,
    holds: bool,
    /// The side that writes a signal.
    #[serde(skip_serializing_if = "Option::is_none")]
    writer: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    written: Option<Written>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    parts: Vec<Self>,
}

type Writers<'a> = &'a dyn Fn(Location) -> Option<&'a Written>;

/// The tree of a signal of one bit; without a wanted value, of the other value than now.
pub(super) fn tree(
    machine: &Machine,
    signal: &str,
    wanted: Option<bool>,
    writers: Writers<'_>,
) -> Result<Tree, Problem> {
    let location = machine.names().resolve(machine.memory(), signal)?;
    if location.width != 1 {
        let what = format!("expected a signal of one bit, found {signal}");
        return Err(Problem::new(what, "ask for one bit: X.position_controller_active"));
    }
    let now = machine.memory().read(location) != 0;
    let wanted = wanted.unwrap_or(!now);
    let mut asked = BTreeSet::new();
    Ok(of_signal(machine, location, wanted, now == wanted, writers, &mut asked))
}

/// A signal, and below it what the control tests for it, once.
fn of_signal(
    machine: &Machine,
    location: Location,
    wanted: bool,
    holds: bool,
    writers: Writers<'_>,
    asked: &mut BTreeSet<(Location, bool)>,
) -> Tree {
    let names = machine.names();
    let address = names.address(location).to_string();
    let is_new = asked.insert((location, wanted)) && asked.len() < 1 << DEEPEST;
    let below = machine.conditions(location, wanted).filter(|_| !holds && is_new);
    let parts = below.map_or_else(Vec::new, |below| match below.what {
        Subject::All => below.parts.iter().map(|part| node(machine, part, writers, asked)).collect(),
        Subject::Any | Subject::Fact { .. } | Subject::Signal(..) => vec![node(machine, &below, writers, asked)],
    });
    let writer = match names.writer(location) {
        Some(Writer::Nck) => "nck",
        Some(Writer::Hmi) => "hmi",
        Some(Writer::Plc) | None => "plc",
    };
    Tree {
        what: names.symbol(location).unwrap_or_else(|| address.clone()),
        address: Some(address),
        found: Some(u8::from(holds == wanted).to_string()),
        wanted: Some(u8::from(wanted).to_string()),
        holds,
        writer: Some(writer),
        written: writers(location).cloned(),
        parts,
    }
}

fn node(machine: &Machine, tested: &Tested, writers: Writers<'_>, asked: &mut BTreeSet<(Location, bool)>) -> Tree {
    let holds = tested.holds;
    let group = |what: &str, parts| Tree {
        what: what.to_owned(),
        address: None,
        found: None,
        wanted: None,
        holds,
        writer: None,
        written: None,
        parts,
    };
    if let Subject::Signal(location, wanted) = tested.what {
        return of_signal(machine, location, wanted, holds, writers, asked);
    }
    let parts = tested.parts.iter().map(|part| node(machine, part, writers, asked)).collect();
    match &tested.what {
        Subject::Any => group("one of", parts),
        Subject::Fact { what, found, wanted } => {
            Tree { found: Some(found.clone()), wanted: Some(wanted.clone()), ..group(what, parts) }
        }
        Subject::All | Subject::Signal(..) => group("all of", parts),
    }
}
