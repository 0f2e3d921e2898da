//! `opennck flowchart`: the reference point approach and the gantry grouping as a Mermaid flowchart, drawn from the tables by
//! which the code runs: a row is an edge, labelled with its rule.
//!
//! With what a suite has taken, the edges that it took are thick and the others are dashed; `opennck test --flowchart F`
//! writes that. The manual's own picture of a grouping (G1, figure 2-2) is missing there; this one is ours.

use std::fmt::{Debug, Write};

use clap::ValueEnum;

use super::output::Output;
use crate::machine::TakenTransitions;
use crate::sinumerik::{
    APPROACH_TRANSITIONS, ApproachPhase, GROUPING_TRANSITIONS, GroupingPhase, Rows, Rule, Transition,
};

/// A state machine of the control.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Chart {
    /// The reference point approach of one axis.
    Approach,
    /// A gantry grouping.
    Gantry,
}

/// A row of a table, in words.
struct Edge {
    from: String,
    to: String,
    label: String,
    taken: Option<bool>,
}

pub(super) fn flowchart(chart: Option<Chart>, output: &mut Output) -> u8 {
    output.print(&text(chart, None));
    0
}

/// One chart or both, with what was taken if that is known.
pub(super) fn text(chart: Option<Chart>, taken: Option<TakenTransitions>) -> String {
    let mut text = "flowchart TD\n".to_owned();
    let mut all = Vec::new();
    if chart != Some(Chart::Gantry) {
        let rows = taken.map(|taken| taken.approach);
        all.extend(subgraph(&mut text, "Reference point approach", APPROACH_TRANSITIONS, ApproachPhase::text, rows));
        // An abort is no row: it leads from wherever the approach is.
        let aborted = label(Rule::ApproachAborted);
        let idle = ApproachPhase::Idle;
        let _ = writeln!(text, "    AnyPhase[\"any phase\"]\n    AnyPhase -.->|\"{aborted}\"| {idle:?}");
    }
    if chart != Some(Chart::Approach) {
        let rows = taken.map(|taken| taken.grouping);
        all.extend(subgraph(&mut text, "Gantry grouping", GROUPING_TRANSITIONS, GroupingPhase::text, rows));
    }
    if taken.is_some() {
        mark(&mut text, chart, &all);
    }
    text
}

/// Writes the phases and rows of a table, and gives the rows.
fn subgraph<P: Copy + Debug + PartialEq>(
    text: &mut String,
    title: &str,
    table: &[Transition<P>],
    phase_text: fn(P) -> &'static str,
    taken: Option<Rows>,
) -> Vec<Edge> {
    let _ = writeln!(text, "    %% {title}");
    let mut phases: Vec<P> = Vec::new();
    for phase in table.iter().flat_map(|row| [row.from, row.to]) {
        if !phases.contains(&phase) {
            phases.push(phase);
        }
    }
    for phase in phases {
        let _ = writeln!(text, "    {phase:?}[\"{}\"]", phase_text(phase));
    }
    let edge = |(index, row): (usize, &Transition<P>)| Edge {
        from: format!("{:?}", row.from),
        to: format!("{:?}", row.to),
        label: label(row.by),
        taken: taken.map(|taken| taken.has(index)),
    };
    let edges: Vec<_> = table.iter().enumerate().map(edge).collect();
    for Edge { from, to, label, .. } in &edges {
        let _ = writeln!(text, "    {from} -->|\"{label}\"| {to}");
    }
    edges
}

/// The rule of an edge. Two rules say in a trace what they tested and no more.
fn label(rule: Rule) -> String {
    let written = Rule::text(rule.number());
    let tested = [(Rule::WaitWarningLimitZero, "MD37110 = 0"), (Rule::WaitLocked, "29.5 = 1")];
    let sentence = tested.iter().find(|(wait, _)| *wait == rule).map_or(written.text, |(_, text)| text);
    format!("{}: {sentence}", written.id)
}

/// Makes what was taken thick and what was not dashed. Mermaid counts the edges of the whole text, with the abort between.
fn mark(text: &mut String, chart: Option<Chart>, edges: &[Edge]) {
    let abort = if chart == Some(Chart::Gantry) { usize::MAX } else { APPROACH_TRANSITIONS.len() };
    for (wanted, style) in [(true, "stroke-width:4px"), (false, "stroke:#c00,stroke-dasharray:4")] {
        let numbers: Vec<_> = edges
            .iter()
            .enumerate()
            .filter(|(_, edge)| edge.taken == Some(wanted))
            .map(|(index, _)| (index + usize::from(index >= abort)).to_string())
            .collect();
        if !numbers.is_empty() {
            let _ = writeln!(text, "    linkStyle {} {style}", numbers.join(","));
        }
    }
    for line in never_taken(edges) {
        let _ = writeln!(text, "    %% {line}");
    }
}

/// How many were taken, and each that was not.
fn never_taken(edges: &[Edge]) -> Vec<String> {
    let never: Vec<_> = edges.iter().filter(|edge| edge.taken == Some(false)).collect();
    let mut lines = vec![format!("{} of {} transitions taken", edges.len() - never.len(), edges.len())];
    lines.extend(never.iter().map(|Edge { from, to, label, .. }| format!("never taken: {from} -> {to} ({label})")));
    lines
}

/// What the terminal says of a suite.
pub(super) fn summary(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| line.strip_prefix("    %% ")).filter(|line| line.contains("taken"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a chart says of its edges, in their order.
    fn edges(text: &str) -> Vec<&str> {
        text.lines().filter(|line| line.contains("-->") || line.contains("-.->")).collect()
    }

    /// The numbers of the edges in this style.
    fn styled(text: &str, style: &str) -> Vec<usize> {
        let line = text.lines().find_map(|line| line.strip_prefix("    linkStyle ")?.strip_suffix(style));
        line.map_or_else(Vec::new, |line| line.trim().split(',').map(|number| number.parse().unwrap()).collect())
    }

    #[test]
    fn a_chart_has_an_edge_for_each_row_of_its_table_and_every_phase_of_an_edge_a_text() {
        for (chart, rows) in
            [(Chart::Approach, APPROACH_TRANSITIONS.len() + 1), (Chart::Gantry, GROUPING_TRANSITIONS.len())]
        {
            let text = text(Some(chart), None);
            assert_eq!(edges(&text).len(), rows);
            for edge in edges(&text) {
                let (from, to) = (edge.split_whitespace().next().unwrap(), edge.split_whitespace().last().unwrap());
                for phase in [from, to] {
                    let node = format!("    {phase}[\"");
                    assert!(text.lines().any(|line| line.starts_with(&node)), "{phase}");
                }
                let label = edge.split('"').nth(1).unwrap();
                assert!(
                    label.split_once(": ").is_some_and(|(id, sentence)| !id.is_empty() && !sentence.is_empty()),
                    "{edge}"
                );
            }
        }
    }

    #[test]
    fn nothing_taken_is_all_dashed_but_the_abort_which_is_no_row() {
        let text = text(None, Some(TakenTransitions::default()));
        let dashed = styled(&text, "stroke:#c00,stroke-dasharray:4");
        let abort = edges(&text).iter().position(|edge| edge.contains("AnyPhase")).unwrap();
        let expected: Vec<_> = (0..edges(&text).len()).filter(|&index| index != abort).collect();
        assert_eq!(dashed, expected);
        assert!(styled(&text, "stroke-width:4px").is_empty());
        assert_eq!(summary(&text).count(), 1 + dashed.len());
    }

    #[test]
    fn the_label_of_a_wait_says_what_was_tested() {
        let text = text(Some(Chart::Gantry), None);
        assert!(text.contains("|\"REF-11: MD37110 = 0\"| WaitingForStart"), "{text}");
        assert!(text.contains("|\"REF-11: 29.5 = 1\"| WaitingForStart"), "{text}");
    }
}
