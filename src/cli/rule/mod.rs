//! `opennck rule`: what a rule says, where it stands, which decisions touch it, and which scenarios show it.

use serde_json::json;

use super::list::{Format, List};
use super::output::Output;
use crate::control::Texts;
use crate::controls;
use crate::controls::documented::{Decision, RuleRow, contains, decisions, rules, without_row};
use crate::source::{Problem, did_you_mean};
use crate::variables::AlarmNumber;

/// A rule and a scenario that cites it in `covers`, or an alarm and a scenario whose golden trace has it; one pair a line. A test compares
/// this file with the scenarios.
const SCENARIOS: &str = include_str!("scenarios.txt");

/// Everything about one ID.
struct Entry {
    id: String,
    text: String,
    source: String,
    decisions: Vec<Decision>,
    scenarios: Vec<String>,
}

/// Prints the rule of an ID, or the rows that contain a text.
pub(super) fn rule(filter: Option<&str>, format: Format, output: &mut Output) -> u8 {
    let Some(filter) = filter else { return list(None, format, output) };
    if let Some(entry) = entry(filter) {
        return match format {
            Format::Table => {
                output.print(&entry.text());
                0
            }
            Format::Json => {
                output.line(format!("{:#}", entry.json()));
                0
            }
            Format::Csv => list(Some(&entry.id), format, output),
        };
    }
    if is_id(filter) {
        output.error(unknown(filter));
        return 2;
    }
    list(Some(filter), format, output)
}

/// The scenarios that show a rule or an alarm.
fn scenarios(id: &str) -> Vec<&'static str> {
    let pairs = SCENARIOS.lines().filter_map(|line| line.split_once(' '));
    pairs.filter(|(rule, _)| rule.eq_ignore_ascii_case(id)).map(|(_, scenario)| scenario).collect()
}

/// Letters or digits, a hyphen, and a number; or an alarm number.
fn is_id(text: &str) -> bool {
    let digits = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
    let letters = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric());
    digits(text) || text.split_once('-').is_some_and(|(front, number)| letters(front) && digits(number))
}

fn unknown(id: &str) -> Problem {
    let (rules, decisions) = (rules(), decisions());
    let known = rules.iter().map(|rule| rule.id).chain(decisions.iter().map(Decision::own_id));
    Problem::new(
        format!("expected the ID of a rule or a decision, found `{id}`"),
        did_you_mean(&id.to_uppercase(), known, "`opennck rule` lists all IDs; `opennck rule referenced` finds a text"),
    )
}

fn list(filter: Option<&str>, format: Format, output: &mut Output) -> u8 {
    let number = |id: &str| scenarios(id).len().to_string();
    let of_rules = rules().into_iter().map(|rule| {
        let scenarios = number(rule.id);
        vec![rule.id.to_owned(), scenarios, source_name(rule.source).to_owned(), rule.text]
    });
    let of_decisions = decisions().into_iter().map(|decision| {
        let scenarios = number(decision.own_id());
        let text = format!("{}: {}", decision.question, decision.decision);
        vec![decision.id.to_owned(), scenarios, "decision".to_owned(), text]
    });
    let rows = of_rules.chain(of_decisions).collect();
    let mut list = List { heads: &["id", "scenarios", "source", "rule"], rows };
    let found = list.retain_with(filter, output);
    list.print(format, output).max(found)
}

/// Manual and chapter, without the remark behind them.
fn source_name(source: &str) -> &str {
    source.split(". ").next().unwrap_or(source)
}

fn entry(id: &str) -> Option<Entry> {
    let all = rules();
    if let Some(rule) = all.iter().find(|rule| rule.id.eq_ignore_ascii_case(id)) {
        return Some(of_rule(rule));
    }
    let own: Vec<_> = decisions().into_iter().filter(|decision| decision.own_id().eq_ignore_ascii_case(id)).collect();
    if let Some(first) = own.first() {
        let id = first.own_id();
        let touches: Vec<_> = all.iter().filter(|rule| contains(&rule.text, id)).map(|rule| rule.id).collect();
        let text = if touches.is_empty() {
            "A decision of this project.".to_owned()
        } else {
            format!("A decision of this project. It touches {}.", touches.join(", "))
        };
        let source = "docs/decisions.md".to_owned();
        let of_tests = own.iter().filter(|row| row.test.starts_with("golden/")).map(|row| row.test.clone() + ".toml");
        let mut scenarios: Vec<_> = of_tests.chain(cited(id)).collect();
        scenarios.sort();
        scenarios.dedup();
        return Some(Entry { id: id.to_owned(), text, source, scenarios, decisions: own });
    }
    if let Some(text) = without_row(&id.to_uppercase()) {
        let (id, source) = (id.to_uppercase(), "docs/decisions.md".to_owned());
        return Some(Entry { id, text, source, decisions: Vec::new(), scenarios: Vec::new() });
    }
    let listed = controls::texts().flat_map(Texts::alarms).find(|alarm| alarm.name == id);
    // Numbers that programs choose (SETAL) are in no list.
    let chosen = || controls::texts().find_map(|texts| texts.alarm(AlarmNumber(id.parse().ok()?)));
    let alarm = listed.or_else(chosen)?;
    let raised = if alarm.raised { "" } else { " The model does not raise it yet." };
    let text =
        format!("Alarm: {}. Cleared by {}; reactions: {}.{raised}", alarm.text, alarm.cancelled_by, alarm.reaction);
    let touching = decisions().into_iter().filter(|decision| decision.names(id)).collect();
    let source = "the list of alarms: `opennck alarms`".to_owned();
    Some(Entry { id: alarm.name, text, source, decisions: touching, scenarios: cited(id) })
}

fn cited(id: &str) -> Vec<String> {
    scenarios(id).into_iter().map(str::to_owned).collect()
}

/// A decision touches a rule if one names the other, or if the decision is shown by a scenario that shows the rule.
fn of_rule(rule: &RuleRow) -> Entry {
    let scenarios = cited(rule.id);
    let shown = |decision: &Decision| scenarios.iter().any(|name| name.trim_end_matches(".toml") == decision.test);
    let touches =
        |decision: &Decision| decision.names(rule.id) || contains(&rule.text, decision.own_id()) || shown(decision);
    Entry {
        id: rule.id.to_owned(),
        text: rule.text.clone(),
        source: rule.source.to_owned(),
        decisions: decisions().into_iter().filter(touches).collect(),
        scenarios,
    }
}

impl Entry {
    fn text(&self) -> String {
        let mut text = format!("{}  {}\n\nsource: {}\n", self.id, self.text, self.source);
        if !self.decisions.is_empty() {
            text.push_str("\ndecisions:\n");
        }
        for decision in &self.decisions {
            let Decision { id, question, decision, reason, module, test } = decision;
            text.push_str(&format!(
                "  {id}  {question}: {decision}\n    reason: {reason}\n    module: {module}, test: {test}\n"
            ));
        }
        let list = self.scenarios.iter().map(|name| format!("  {name}\n")).collect::<String>();
        let list = if list.is_empty() { "  none cites it\n".to_owned() } else { list };
        text.push_str(&format!("\nscenarios:\n{list}"));
        text
    }

    fn json(&self) -> serde_json::Value {
        let decisions: Vec<_> = self.decisions.iter().map(|decision| {
            let Decision { id, question, decision, reason, module, test } = decision;
            json!({ "id": id, "question": question, "decision": decision, "reason": reason, "module": module, "test": test })
        }).collect();
        json!({
            "id": self.id, "rule": self.text, "source": self.source, "decisions": decisions, "scenarios": self.scenarios,
        })
    }
}
