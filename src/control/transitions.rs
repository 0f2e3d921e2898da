//! Tables of transitions: a state machine of a control takes only the steps that stand in its table, and each row remembers that it
//! was taken. A [`Chart`] shows a table to people.

use std::fmt::Debug;

use crate::variables::RuleNumber;

/// A step from one phase to another by a rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Transition<P, R> {
    /// From.
    pub from: P,
    /// To.
    pub to: P,
    /// By.
    pub by: R,
}

/// A row of a table.
pub const fn row<P, R>(from: P, by: R, to: P) -> Transition<P, R> {
    Transition { from, to, by }
}

/// Where a rule leads from a phase. A step that is not in the table is a mistake of the caller and leads to the first phase.
pub fn next<P, R>(table: &[Transition<P, R>], taken: &mut Rows, from: P, by: R) -> P
where
    P: Copy + PartialEq + Default + Debug,
    R: Copy + PartialEq + Debug,
{
    let index = table.iter().position(|row| row.from == from && row.by == by);
    debug_assert!(index.is_some(), "no step from {from:?} by {by:?}");
    index.map_or_else(P::default, |index| {
        taken.0 |= 1 << index;
        table[index].to
    })
}

/// Rows of a table, a bit each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rows(u64);

impl Rows {
    /// How many rows a table can have.
    pub const CAPACITY: usize = u64::BITS as usize;

    /// Whether this row is among them.
    #[must_use]
    pub const fn has(self, index: usize) -> bool {
        index < Self::CAPACITY && self.0 >> index & 1 == 1
    }
}

/// How many charts a control can have.
pub const CHARTS: usize = 8;

/// The rows by which a control has gone since it was made, of whichever axis and grouping: one entry for each of its charts. They
/// decide nothing and are neither saved nor taken back: they show what a suite of scenarios has exercised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Taken(pub [Rows; CHARTS]);

impl Taken {
    /// Adds what another control of the same kind has taken.
    pub fn add(&mut self, other: Self) {
        for (rows, more) in self.0.iter_mut().zip(other.0) {
            rows.0 |= more.0;
        }
    }
}

/// A table of transitions as people see it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chart {
    /// The word by which a command line asks for it: `approach`.
    pub name: &'static str,
    /// Its title: `Reference point approach`.
    pub title: &'static str,
    /// The phases in the order in which the table names them: an identifier and a text.
    pub phases: Vec<(String, &'static str)>,
    /// The rows of the table, in its order.
    pub edges: Vec<Edge>,
    /// Steps that are possible from every phase and are no rows: a rule and the phase that it leads to.
    pub from_anywhere: Vec<(RuleNumber, String)>,
}

/// A row of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edge {
    /// The identifier of the phase that it starts from.
    pub from: String,
    /// The identifier of the phase that it leads to.
    pub to: String,
    /// The rule that allows it.
    pub rule: RuleNumber,
    /// What the rule tests here, where its own text leaves that to its inputs.
    pub tested: Option<&'static str>,
}

impl Chart {
    /// The chart of a table. `text` gives the text of a phase, `tested` what a rule tests where its own text does not say it.
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

    /// The same with a step from every phase, to the phase of this identifier.
    #[must_use]
    pub fn with_step_from_anywhere(mut self, rule: impl Into<RuleNumber>, to: impl Debug) -> Self {
        self.from_anywhere.push((rule.into(), format!("{to:?}")));
        self
    }
}
