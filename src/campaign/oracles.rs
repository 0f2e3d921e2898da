//! What must hold in every case, in addition to the expectations of the base scenario, and what at least one case must reach.

use super::apply::add;
use crate::source::{Node, Problem, Table, Value};

/// The name of the rule that notes whether a condition was reached begins with this.
pub(super) const SOMETIMES: &str = "sometimes ";

#[derive(Clone, Debug, Default)]
pub(super) struct Oracles {
    /// The alarms that may come; `None`: any.
    pub(super) may: Option<Vec<u32>>,
    /// The alarms that must come in every case.
    pub(super) must: Vec<u32>,
    /// What at least one case must reach: conditions, and transitions of a chart such as `gantry: Waiting -> Synchronised`.
    pub(super) sometimes: Vec<String>,
    pub(super) transitions: Vec<String>,
}

impl Oracles {
    /// Reads what must hold, and adds its rules to the base scenario, so that the scenario of a case has them.
    pub(super) fn read(table: &mut Table, base: &mut Table) -> Result<Self, Problem> {
        let mut oracles = Self::default();
        add(base, "never", table.take("never"));
        add(base, "always", table.take("always"));
        add(base, "rule", table.take("rule"));
        if let Some(node) = table.take("alarms") {
            let mut alarms = node.into_table("the alarms that may or must come")?;
            oracles.may = alarms.take("may").map(numbers).transpose()?;
            oracles.must = alarms.take("must").map(numbers).transpose()?.unwrap_or_default();
            alarms.finish()?;
        }
        for node in table.take("reach").map_or_else(Vec::new, Node::into_list) {
            oracles.transitions.push(node.text("a transition, as \"gantry: From -> To\"")?.to_owned());
        }
        for node in table.take("sometimes").map_or_else(Vec::new, Node::into_list) {
            let text = node.text("an expression")?.to_owned();
            let place = node.place.clone();
            let with = |value| Node { place: place.clone(), value };
            let mut rule = Table::empty(place.clone());
            // A path of one key in an empty table is always free.
            let _ = rule.put(&["name"], &place, with(Value::Text(format!("{SOMETIMES}{text}"))));
            let _ = rule.put(&["when"], &place, with(Value::Text(text.clone())));
            let _ = rule.put(&["then"], &place, with(Value::Text("1 == 1".to_owned())));
            let _ = rule.put(&["from_start"], &place, with(Value::Boolean(true)));
            add(base, "rule", Some(with(Value::Array(vec![with(Value::Table(rule))]))));
            oracles.sometimes.push(text);
        }
        Ok(oracles)
    }
}

fn numbers(node: Node) -> Result<Vec<u32>, Problem> {
    let number = |node: &Node| {
        let number = node.integer("the number of an alarm")?;
        u32::try_from(number).map_err(|_| node.expected("the number of an alarm", "write may = [10652]"))
    };
    node.into_list().iter().map(number).collect()
}
