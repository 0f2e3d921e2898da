//! Transition tables: a state machine of a control makes only the transitions in its table, and the use of each row is recorded. A
//! [`Chart`] is a table in readable form.

use std::fmt::Debug;

use crate::units::AxisNumber;
use crate::variables::RuleNumber;

/// A transition from one phase to another by a rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Transition<P, R> {
    /// Initial phase.
    pub from: P,
    /// Next phase.
    pub to: P,
    /// Rule.
    pub by: R,
}

/// A row of a table.
pub const fn row<P, R>(from: P, by: R, to: P) -> Transition<P, R> {
    Transition { from, to, by }
}

/// The next phase for a phase and a rule. A transition that is not in the table is an error of the caller and leads to the first phase.
pub fn next<P, R>(table: &[Transition<P, R>], taken: &mut Rows, from: P, by: R) -> P
where
    P: Copy + PartialEq + Default + Debug,
    R: Copy + PartialEq + Debug,
{
    let index = table.iter().position(|row| row.from == from && row.by == by);
    debug_assert!(index.is_some(), "no transition from {from:?} by {by:?}");
    index.map_or_else(P::default, |index| {
        taken.0 |= 1 << index;
        table[index].to
    })
}

/// A set of rows of a table, one bit for each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rows(u64);

impl Rows {
    /// The largest number of rows in a table.
    pub const CAPACITY: usize = u64::BITS as usize;

    /// Whether the set contains this row.
    #[must_use]
    pub const fn has(self, index: usize) -> bool {
        index < Self::CAPACITY && self.0 >> index & 1 == 1
    }
}

/// The largest number of charts of a control.
pub const CHARTS: usize = 8;

/// The rows that a control has used since it was created, for all axes and groupings: one entry for each of its charts. They have no effect
/// on behaviour and are neither saved nor restored. They show the coverage of a suite of scenarios.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Taken(pub [Rows; CHARTS]);

impl Taken {
    /// Adds the rows that another control of the same kind has used.
    pub fn add(&mut self, other: Self) {
        for (rows, more) in self.0.iter_mut().zip(other.0) {
            rows.0 |= more.0;
        }
    }
}

/// Where a part of a machine is in a chart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChartPosition {
    /// The name of the chart.
    pub chart: &'static str,
    /// The axes of the part; of a gantry the leading axis first.
    pub axes: Vec<AxisNumber>,
    /// The identifier of the phase.
    pub phase: String,
    /// The name of the signal of the first axis that shows the aim of the chart; what it waits for is what the part waits for.
    pub aim: &'static str,
}

/// A transition table in readable form.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chart {
    /// The name used on the command line: `approach`.
    pub name: &'static str,
    /// Its title: `Reference point approach`.
    pub title: &'static str,
    /// The phases in the order of the table: an identifier and a text.
    pub phases: Vec<(String, &'static str)>,
    /// The rows of the table, in its order.
    pub edges: Vec<Edge>,
    /// Transitions from every phase, which are not rows: a rule and the next phase.
    pub from_anywhere: Vec<(RuleNumber, String)>,
}

/// A row of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edge {
    /// The identifier of the initial phase.
    pub from: String,
    /// The identifier of the next phase.
    pub to: String,
    /// The rule that allows the transition.
    pub rule: RuleNumber,
    /// The condition that the rule tests here, if the text of the rule leaves it to its inputs.
    pub tested: Option<&'static str>,
}

impl Chart {
    /// The chart of a table. `text` returns the text of a phase, `tested` the condition that a rule tests, if the text of the rule does not
    /// contain it.
    #[must_use]
    pub fn of<P, R>(
        name: &'static str,
        title: &'static str,
        table: &[Transition<P, R>],
        text: impl Fn(P) -> &'static str,
        tested: impl Fn(R) -> Option<&'static str>,
    ) -> Self
    where
        P: Copy + PartialEq + Debug,
        R: Copy + Into<RuleNumber>,
    {
        let mut phases: Vec<P> = Vec::new();
        for phase in table.iter().flat_map(|row| [row.from, row.to]) {
            if !phases.contains(&phase) {
                phases.push(phase);
            }
        }
        let edge = |row: &Transition<P, R>| Edge {
            from: format!("{:?}", row.from),
            to: format!("{:?}", row.to),
            rule: row.by.into(),
            tested: tested(row.by),
        };
        Self {
            name,
            title,
            phases: phases.into_iter().map(|phase| (format!("{phase:?}"), text(phase))).collect(),
            edges: table.iter().map(edge).collect(),
            from_anywhere: Vec::new(),
        }
    }

    /// The chart with one more transition, from every phase to the phase with this identifier.
    #[must_use]
    pub fn with_step_from_anywhere(mut self, rule: impl Into<RuleNumber>, to: impl Debug) -> Self {
        self.from_anywhere.push((rule.into(), format!("{to:?}")));
        self
    }
}
