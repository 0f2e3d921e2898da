//! The rules of a scenario, `[[rule]]`, as written in the file.

use super::duration::Duration;
use super::fields::{Named, duration, named};
use crate::source::{Node, Place, Problem, Table, Value};

/// A rule as written in the file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Written {
    pub(super) name: String,
    pub(super) place: Place,
    pub(super) claim: WrittenClaim,
    pub(super) go_on: bool,
}

/// What must hold, as written in the file.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum WrittenClaim {
    Always(Named),
    Never(Named),
    Follows {
        when: Named,
        then: Named,
        within: Option<Duration>,
        not_before: Option<Duration>,
        from_start: bool,
        must_begin: bool,
    },
}

/// The keys that belong to a rule with `when`.
const OF_WHEN: [&str; 5] = ["then", "within", "not_before", "from_start", "must_begin"];

/// Reads `[[rule]]`.
pub(super) fn written(node: Option<Node>) -> Result<Vec<Written>, Problem> {
    let Some(node) = node else {
        return Ok(Vec::new());
    };
    if !matches!(node.value, Value::Array(_)) {
        return Err(node.expected("a list of rules", "write [[rule]] with two brackets"));
    }
    node.into_list().into_iter().map(|rule| one(rule.into_table("a rule")?)).collect()
}

fn one(mut table: Table) -> Result<Written, Problem> {
    let place = table.place.clone();
    let name = table.take("name").map(|node| node.text("a name").map(str::to_owned)).transpose()?;
    let go_on = flag(&mut table, "go_on")?;
    let mut expression = |key| table.take(key).map(|node| named(&node, "an expression")).transpose();
    let kinds = [expression("when")?, expression("always")?, expression("never")?];
    let (usual, claim) = match kinds {
        [Some(when), None, None] => {
            let then = table.take("then").ok_or_else(|| {
                place
                    .problem("expected `then` together with `when`, found none", "write then = \"…\": what must follow")
            })?;
            let then = named(&then, "an expression")?;
            (format!("{} -> {}", when.text, then.text), follows(when, then, &mut table, &place)?)
        }
        [None, Some(condition), None] => (condition.text.clone(), WrittenClaim::Always(condition)),
        [None, None, Some(condition)] => (format!("never {}", condition.text), WrittenClaim::Never(condition)),
        [None, None, None] => {
            table.finish()?;
            let cure = "write when = \"…\" and then = \"…\", or always = \"…\", or never = \"…\"";
            return Err(place.problem("expected a rule with `when`, `always` or `never`, found none of them", cure));
        }
        _ => {
            let what = "expected one of `when`, `always` and `never` in a rule, found several";
            return Err(place.problem(what, "write one [[rule]] for each"));
        }
    };
    for key in OF_WHEN {
        if let Some(node) = table.take(key) {
            let what = format!("expected `{key}` in a rule with `when`, found it in another one");
            return Err(node.place.problem(what, "`always` and `never` hold in every cycle; remove it"));
        }
    }
    table.finish()?;
    Ok(Written { name: name.unwrap_or(usual), place, claim, go_on })
}

fn follows(when: Named, then: Named, table: &mut Table, place: &Place) -> Result<WrittenClaim, Problem> {
    let mut time = |key, what| table.take(key).map(|node| duration(&node, what)).transpose();
    let within = time("within", "the longest time until the consequence")?;
    let not_before = time("not_before", "the shortest time until the consequence")?;
    if not_before.is_some() && within.is_none() {
        let what = "expected `within` together with `not_before`, found none";
        return Err(place.problem(what, "without `within` the consequence must be true in the cycle of the edge"));
    }
    let (from_start, must_begin) = (flag(table, "from_start")?, flag(table, "must_begin")?);
    Ok(WrittenClaim::Follows { when, then, within, not_before, from_start, must_begin })
}

fn flag(table: &mut Table, key: &'static str) -> Result<bool, Problem> {
    table.take(key).map_or(Ok(false), |node| node.boolean("true or false"))
}
