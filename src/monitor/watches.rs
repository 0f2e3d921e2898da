//! The progress of rules: open watches, breaches, margins.

use std::collections::VecDeque;

use super::rule::{Claim, Consequence, Rule};
use crate::expression::{Expression, View};

/// The rules of a run and their progress.
#[derive(Clone, Debug, Default)]
pub struct Monitor {
    rules: Vec<Rule>,
    states: Vec<State>,
    /// Whether the distances of conditions to their limits are measured.
    measures: bool,
}

/// The progress of a rule.
#[derive(Clone, Debug, Default)]
struct State {
    /// Whether `when` was true, or a condition was broken, after the last cycle.
    was: bool,
    /// The cycles in which the open watches began, the oldest first.
    open: VecDeque<u64>,
    /// The number of watches that began, and of those that ended as they must.
    begun: u64,
    met: u64,
    /// The number of watches that power on closed.
    closed: u64,
    breaches: u64,
    margin: Option<Margin>,
}

/// The smallest distance of a rule to its breach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margin {
    /// Cycles of a consequence, or the distance of a compared value in its own unit.
    pub amount: f64,
    /// The cycle in which the watch began, or in which the value was nearest.
    pub cycle: u64,
}

/// A rule that was broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Breach {
    /// The index of the rule.
    pub rule: usize,
    /// The cycle in which the watch or the violation began.
    pub began: u64,
    /// The cycle in which the rule failed.
    pub failed: u64,
    /// Why.
    pub reason: Reason,
}

/// Why a rule is broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The condition of `always` is false, or that of `never` is true.
    Condition,
    /// The consequence did not become true in time.
    Late,
    /// The consequence was true too early.
    Early,
    /// No edge began the rule, and it must begin.
    NeverBegan,
}

/// A rule at the end of a run.
#[derive(Clone, Copy, Debug)]
pub struct Summary<'a> {
    /// The rule.
    pub rule: &'a Rule,
    /// The number of watches that began, and of those that ended as they must.
    pub begun: u64,
    /// The number of watches whose consequence came in time.
    pub met: u64,
    /// The number of watches that power on closed.
    pub closed: u64,
    /// The number of watches that are open, and the cycle in which the oldest began.
    pub open: Option<(usize, u64)>,
    /// The number of breaches.
    pub breaches: u64,
    /// The smallest margin, if it was measured.
    pub margin: Option<Margin>,
}

impl Monitor {
    /// Adds a rule. [`Monitor::begin`] must follow before the next cycle.
    pub fn add(&mut self, rule: Rule) {
        self.rules.push(rule);
        self.states.push(State::default());
    }

    /// The rules.
    #[must_use]
    pub fn rules(&self) -> &[Rule] {
        &self.rules
    }

    /// Measures how near conditions come to their limits, too; this takes time in every cycle.
    pub fn measure(&mut self) {
        self.measures = true;
    }

    /// Starts the rules from `first` on with the state before the next cycle, after cycle `cycle`. Reports each breach.
    pub fn begin(&mut self, first: usize, view: &View<'_>, cycle: u64, report: &mut dyn FnMut(Breach)) {
        for (index, (rule, state)) in self.rules.iter().zip(&mut self.states).enumerate().skip(first) {
            if let Claim::Follows(consequence) = &rule.claim {
                state.was = consequence.when.holds(view);
                if state.was && consequence.from_start {
                    state.open(cycle);
                    state.follow(index, consequence, view, cycle, report);
                }
            }
        }
    }

    /// Takes up the state after a cycle. Reports each breach, in the order of the rules.
    pub fn observe(&mut self, view: &View<'_>, cycle: u64, report: &mut dyn FnMut(Breach)) {
        for (index, (rule, state)) in self.rules.iter().zip(&mut self.states).enumerate() {
            match &rule.claim {
                Claim::Always(condition) => {
                    state.condition(index, condition.holds(view), cycle, report);
                    if self.measures {
                        state.measure(condition.distance(view), cycle);
                    }
                }
                Claim::Never(condition) => {
                    state.condition(index, !condition.holds(view), cycle, report);
                    if self.measures {
                        state.measure(condition.distance(view).map(|distance| -distance), cycle);
                    }
                }
                Claim::Follows(consequence) => {
                    let is = consequence.when.holds(view);
                    if is && !state.was {
                        state.open(cycle);
                    }
                    state.was = is;
                    if !state.open.is_empty() {
                        state.follow(index, consequence, view, cycle, report);
                    }
                }
            }
        }
    }

    /// Power on: closes all open watches without a result.
    pub fn power_on(&mut self) {
        for state in &mut self.states {
            state.closed += state.open.len() as u64;
            state.open.clear();
        }
    }

    /// The end of a run, in this cycle: reports the rules that had to begin and did not.
    pub fn end(&mut self, cycle: u64, report: &mut dyn FnMut(Breach)) {
        for (index, (rule, state)) in self.rules.iter().zip(&mut self.states).enumerate() {
            if let Claim::Follows(consequence) = &rule.claim
                && consequence.must_begin
                && state.begun == 0
            {
                state.breaches += 1;
                report(Breach { rule: index, began: cycle, failed: cycle, reason: Reason::NeverBegan });
            }
        }
    }

    /// The progress of every rule.
    pub fn summaries(&self) -> impl Iterator<Item = Summary<'_>> {
        self.rules.iter().zip(&self.states).map(|(rule, state)| Summary {
            rule,
            begun: state.begun,
            met: state.met,
            closed: state.closed,
            open: state.open.front().map(|oldest| (state.open.len(), *oldest)),
            breaches: state.breaches,
            margin: state.margin,
        })
    }
}

impl State {
    fn open(&mut self, cycle: u64) {
        self.open.push_back(cycle);
        self.begun += 1;
    }

    fn breach(&mut self, breach: Breach, report: &mut dyn FnMut(Breach)) {
        self.breaches += 1;
        report(breach);
    }

    /// A condition that must hold; a violation of several cycles is one breach.
    fn condition(&mut self, rule: usize, holds: bool, cycle: u64, report: &mut dyn FnMut(Breach)) {
        if !holds && !self.was {
            self.breach(Breach { rule, began: cycle, failed: cycle, reason: Reason::Condition }, report);
        }
        self.was = !holds;
    }

    /// Closes the watches that the consequence ends, and those that are too late.
    fn follow(
        &mut self,
        rule: usize,
        consequence: &Consequence,
        view: &View<'_>,
        cycle: u64,
        report: &mut dyn FnMut(Breach),
    ) {
        let Consequence { then, within, not_before, .. } = consequence;
        if then.holds(view) {
            // Every open watch has seen no consequence so far, so this is the first one for all of them.
            while let Some(began) = self.open.pop_front() {
                let passed = cycle - began;
                if passed < *not_before {
                    self.breach(Breach { rule, began, failed: cycle, reason: Reason::Early }, report);
                } else {
                    self.met += 1;
                    let early = if *not_before > 0 { passed - not_before } else { u64::MAX };
                    let margin = (within - passed).min(early);
                    self.measure(Some(margin as f64), began);
                }
            }
            return;
        }
        while let Some(began) = self.open.front().copied()
            && cycle - began >= *within
        {
            self.open.pop_front();
            self.breach(Breach { rule, began, failed: cycle, reason: Reason::Late }, report);
        }
    }

    fn measure(&mut self, amount: Option<f64>, cycle: u64) {
        let Some(amount) = amount.filter(|amount| amount.is_finite()) else {
            return;
        };
        if self.margin.is_none_or(|margin| amount < margin.amount) {
            self.margin = Some(Margin { amount, cycle });
        }
    }
}

impl Breach {
    /// The expression whose value broke the rule.
    #[must_use]
    pub fn expression<'a>(&self, rule: &'a Rule) -> &'a Expression {
        match (&rule.claim, self.reason) {
            (Claim::Always(condition) | Claim::Never(condition), _) => condition,
            (Claim::Follows(consequence), Reason::NeverBegan) => &consequence.when,
            (Claim::Follows(consequence), Reason::Condition | Reason::Late | Reason::Early) => &consequence.then,
        }
    }
}
