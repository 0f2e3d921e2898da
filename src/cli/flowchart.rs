//! `opennck flowchart`: the reference point approach and the gantry grouping as a Mermaid flowchart. The chart is drawn from the tables
//! that the code runs: each row is an edge, labelled with its rule.
//!
//! `opennck test --flowchart F` also marks the edges: those that the suite took are thick, the others are dashed. G1 refers to a picture of
//! its own (figure 2-2) that is missing in the manual; this chart is drawn independently.

use std::fmt::Write;

use clap::builder::PossibleValue;

use super::output::Output;
use crate::control::{Chart, Texts};
use crate::controls;
use crate::golden::Exercised;

/// An edge as text.
struct Edge {
    from: String,
    to: String,
    label: String,
    taken: Option<bool>,
}

/// The names of the charts, as possible values of the argument.
pub(super) fn names() -> Vec<PossibleValue> {
    let charts = controls::texts().flat_map(Texts::charts);
    charts.map(|chart| PossibleValue::new(chart.name).help(chart.title)).collect()
}

pub(super) fn flowchart(chart: Option<&str>, output: &mut Output) -> u8 {
    output.print(&text(chart, &[]));
    0
}

/// One chart or all of them. The edges are marked where `taken` is known.
pub(super) fn text(only: Option<&str>, taken: &[Exercised]) -> String {
    let mut text = "flowchart TD\n".to_owned();
    let mut edges = Vec::new();
    for texts in controls::texts() {
        let exercised = taken.iter().find(|exercised| exercised.texts.name() == texts.name());
        for (place, chart) in texts.charts().iter().enumerate() {
            if only.is_none_or(|only| only == chart.name) {
                let rows = exercised.map(|exercised| exercised.taken.0[place]);
                draw(&mut text, texts, chart, |index| rows.map(|rows| rows.has(index)), &mut edges);
            }
        }
    }
    if !taken.is_empty() {
        mark(&mut text, &edges);
    }
    text
}

/// Writes the phases and edges of a chart.
fn draw(
    text: &mut String,
    words: &dyn Texts,
    chart: &Chart,
    taken: impl Fn(usize) -> Option<bool>,
    edges: &mut Vec<Edge>,
) {
    let _ = writeln!(text, "    %% {}", chart.title);
    for (phase, sentence) in &chart.phases {
        let _ = writeln!(text, "    {phase}[\"{sentence}\"]");
    }
    for (index, edge) in chart.edges.iter().enumerate() {
        let rule = words.rule(edge.rule);
        let label = format!("{}: {}", rule.id, edge.tested.unwrap_or(rule.text));
        let _ = writeln!(text, "    {} -->|\"{label}\"| {}", edge.from, edge.to);
        edges.push(Edge { from: edge.from.clone(), to: edge.to.clone(), label, taken: taken(index) });
    }
    for (rule, to) in &chart.from_anywhere {
        let rule = words.rule(*rule);
        let label = format!("{}: {}", rule.id, rule.text);
        let _ = writeln!(text, "    AnyPhase[\"any phase\"]\n    AnyPhase -.->|\"{label}\"| {to}");
        edges.push(Edge { from: "AnyPhase".to_owned(), to: to.clone(), label, taken: None });
    }
}

/// Draws taken edges thick and the others dashed. Mermaid numbers the edges of the whole text.
fn mark(text: &mut String, edges: &[Edge]) {
    for (wanted, style) in [(true, "stroke-width:4px"), (false, "stroke:#c00,stroke-dasharray:4")] {
        let styled = edges.iter().enumerate().filter(|(_, edge)| edge.taken == Some(wanted));
        let numbers: Vec<_> = styled.map(|(index, _)| index.to_string()).collect();
        if !numbers.is_empty() {
            let _ = writeln!(text, "    linkStyle {} {style}", numbers.join(","));
        }
    }
    for line in never_taken(edges) {
        let _ = writeln!(text, "    %% {line}");
    }
}

/// The number of taken edges, then each edge that was not taken.
fn never_taken(edges: &[Edge]) -> Vec<String> {
    let never: Vec<_> = edges.iter().filter(|edge| edge.taken == Some(false)).collect();
    let rows = edges.iter().filter(|edge| edge.taken.is_some()).count();
    let mut lines = vec![format!("{} of {rows} transitions taken", rows - never.len())];
    lines.extend(never.iter().map(|Edge { from, to, label, .. }| format!("never taken: {from} -> {to} ({label})")));
    lines
}

/// The lines about a suite that are printed on the terminal.
pub(super) fn summary(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| line.strip_prefix("    %% ")).filter(|line| line.contains("taken"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Taken;

    /// The lines of the edges, in order.
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
        for chart in controls::texts().flat_map(Texts::charts) {
            let text = text(Some(chart.name), &[]);
            assert_eq!(edges(&text).len(), chart.edges.len() + chart.from_anywhere.len());
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
    fn without_taken_edges_all_are_dashed_except_the_abort() {
        let nothing = controls::texts().map(|texts| Exercised {
            texts,
            taken: Taken::default(),
            remarks: Vec::new(),
            warnings: Vec::new(),
            coverage: None,
        });
        let text = text(None, &nothing.collect::<Vec<_>>());
        let dashed = styled(&text, "stroke:#c00,stroke-dasharray:4");
        let all = edges(&text);
        // What can happen in every phase is no row of a table, and no scenario can use it.
        let expected: Vec<_> = (0..all.len()).filter(|&index| !all[index].contains("AnyPhase")).collect();
        assert!(expected.len() < all.len());
        assert_eq!(dashed, expected);
        assert!(styled(&text, "stroke-width:4px").is_empty());
        assert_eq!(summary(&text).count(), 1 + dashed.len());
    }

    #[test]
    fn the_label_of_a_wait_says_what_was_tested() {
        let text = text(Some("gantry"), &[]);
        assert!(text.contains("|\"REF-11: MD37110 = 0\"| WaitingForStart"), "{text}");
        assert!(text.contains("|\"REF-11: 29.5 = 1\"| WaitingForStart"), "{text}");
    }
}
