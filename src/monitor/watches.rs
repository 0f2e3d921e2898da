//! The progress of rules: open watches, breaches, margins.

use std::collections::VecDeque;

use super::rule::{Claim, Consequence, Rule};
use super::span::{Point, Span};
use crate::expression::{Expression, View};
use crate::units::Time;

/// The rules of a run and their progress.
#[derive(Clone, Debug, Default)]
pub struct Monitor {
    rules: Vec<Rule>,
    states: Vec<State>,
    /// Whether the distances of conditions to their limits are measured.
    measures: bool,
    /// The last cycle that was shown.
    last: Point,
}

/// The progress of a rule.
#[derive(Clone, Debug, Default)]
struct State {
    /// Whether `when` was true, or a condition was broken, after the last cycle.
    was: bool,
    /// The cycles in which the open watches began, the oldest first.
    open: VecDeque<Point>,
    /// The number of watches that began.
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
    pub at: Point,
    /// The length of a cycle then.
    pub cycle: Time,
}

/// A rule that was broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Breach {
    /// The index of the rule.
    pub rule: usize,
    /// The cycle in which the watch or the violation began.
    pub began: Point,
    /// The cycle in which the rule failed.
    pub failed: Point,
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
    pub open: Option<(usize, Point)>,
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

    /// Starts the rules from `first` on with the state before the next cycle, which has this length, after cycle `cycle`. Reports each
    /// breach.
    pub fn begin(
        &mut self,
        first: usize,
        view: &View<'_>,
        (cycle, length): (u64, Time),
        report: &mut dyn FnMut(Breach),
    ) {
        let now = self.show(cycle, view).0;
        for (index, (rule, state)) in self.rules.iter().zip(&mut self.states).enumerate().skip(first) {
            if let Claim::Follows(consequence) = &rule.claim {
                state.was = consequence.when.holds(view);
                if state.was && consequence.from_start {
                    state.open(now);
                    state.follow(index, consequence, view, (now, length), report);
                }
            }
        }
    }

    /// Takes up the state after a cycle. Reports each breach, in the order of the rules.
    pub fn observe(&mut self, view: &View<'_>, cycle: u64, report: &mut dyn FnMut(Breach)) {
        let (now, length) = self.show(cycle, view);
        for (index, (rule, state)) in self.rules.iter().zip(&mut self.states).enumerate() {
            match &rule.claim {
                Claim::Always(condition) => {
                    state.condition(index, condition.holds(view), now, report);
                    if self.measures {
                        state.measure(condition.distance(view), now, length);
                    }
                }
                Claim::Never(condition) => {
                    state.condition(index, !condition.holds(view), now, report);
                    if self.measures {
                        state.measure(condition.distance(view).map(|distance| -distance), now, length);
                    }
                }
                Claim::Follows(consequence) => {
                    let is = consequence.when.holds(view);
                    if is && !state.was {
                        state.open(now);
                    }
                    state.was = is;
                    if !state.open.is_empty() {
                        state.follow(index, consequence, view, (now, length), report);
                    }
                }
            }
        }
    }

    /// Power on, with the state before its first cycle: closes all open watches without a result. A signal that this cycle sets is an edge.
    pub fn power_on(&mut self, view: &View<'_>) {
        for (rule, state) in self.rules.iter().zip(&mut self.states) {
            state.closed += state.open.len() as u64;
            state.open.clear();
            if let Claim::Follows(consequence) = &rule.claim {
                state.was = consequence.when.holds(view);
            }
        }
    }

    /// The end of a run, after the last cycle that was shown: reports the rules that had to begin and did not.
    pub fn end(&mut self, report: &mut dyn FnMut(Breach)) {
        let now = self.last;
        for (index, (rule, state)) in self.rules.iter().zip(&mut self.states).enumerate() {
            if let Claim::Follows(consequence) = &rule.claim
                && consequence.must_begin
                && state.begun == 0
            {
                state.breaches += 1;
                report(Breach { rule: index, began: now, failed: now, reason: Reason::NeverBegan });
            }
        }
    }

    /// Takes up the number of a cycle and its time; returns its length, too.
    fn show(&mut self, cycle: u64, view: &View<'_>) -> (Point, Time) {
        let now = Point { cycle, time: view.now.time };
        let length = now.time - self.last.time;
        self.last = now;
        (now, length)
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
    fn open(&mut self, now: Point) {
        self.open.push_back(now);
        self.begun += 1;
    }

    fn breach(&mut self, breach: Breach, report: &mut dyn FnMut(Breach)) {
        self.breaches += 1;
        report(breach);
    }

    /// A condition that must hold; a violation of several cycles is one breach.
    fn condition(&mut self, rule: usize, holds: bool, now: Point, report: &mut dyn FnMut(Breach)) {
        if !holds && !self.was {
            self.breach(Breach { rule, began: now, failed: now, reason: Reason::Condition }, report);
        }
        self.was = !holds;
    }

    /// Closes the watches that the consequence ends, and those that are too late, in a cycle of this length.
    fn follow(
        &mut self,
        rule: usize,
        consequence: &Consequence,
        view: &View<'_>,
        (now, length): (Point, Time),
        report: &mut dyn FnMut(Breach),
    ) {
        let Consequence { then, within, not_before, .. } = consequence;
        if then.holds(view) {
            // Every open watch has seen no consequence so far, so this is the first one for all of them.
            while let Some(began) = self.open.pop_front() {
                if !not_before.is_over(began, now) {
                    self.breach(Breach { rule, began, failed: now, reason: Reason::Early }, report);
                    continue;
                }
                self.met += 1;
                let late = within.cycles_left(began, now, length);
                let early = || not_before.cycles_beyond(began, now, length);
                let margin = if *not_before == Span::NONE { late } else { late.min(early()) };
                self.measure(Some(margin as f64), began, length);
            }
            return;
        }
        while let Some(began) = self.open.front().copied()
            && within.is_over(began, now)
        {
            self.open.pop_front();
            self.breach(Breach { rule, began, failed: now, reason: Reason::Late }, report);
        }
    }

    fn measure(&mut self, amount: Option<f64>, at: Point, cycle: Time) {
        let Some(amount) = amount.filter(|amount| amount.is_finite()) else {
            return;
        };
        if self.margin.is_none_or(|margin| amount < margin.amount) {
            self.margin = Some(Margin { amount, at, cycle });
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
