//! The rules of a session: what a breach says, and what is said about rules at the end.

use super::failure::{Failure, Missed};
use super::passing::Book;
use crate::expression::{Expression, Followed, View};
use crate::machine::Machine;
use crate::monitor::{Breach, Claim, Monitor, Reason, Rule, Span, Summary};
use crate::units::Time;

impl Book {
    /// Watches over these rules from now on, together with those before.
    pub(super) fn watch_over(&mut self, rules: Vec<Rule>, followed: Followed, machine: &Machine) {
        self.follow(followed, machine);
        let first = self.monitor.rules().len();
        rules.into_iter().for_each(|rule| self.monitor.add(rule));
        let now = (machine.cycle() - self.start.0, machine.cycle_time());
        if let Err(failure) = self.judge(machine, |monitor, view, report| monitor.begin(first, view, now, report)) {
            self.broken.get_or_insert(failure);
        }
    }

    /// Takes over conditions and signals to follow; conditions that are known keep their histories.
    pub(super) fn follow(&mut self, followed: Followed, machine: &Machine) {
        let known = self.followed.conditions.len();
        self.followed.edges = followed.edges;
        let mut conditions = followed.conditions;
        self.with_view(self.last(machine), machine, |view| conditions.begin(known, view));
        self.followed.conditions = conditions;
    }

    /// Shows the state after the last cycle to the monitor. Returns the first breach that ends the run, with the others of this cycle that
    /// end it, too; notes those after which the run goes on.
    pub(super) fn judge(
        &mut self,
        machine: &Machine,
        look: impl FnOnce(&mut Monitor, &View<'_>, &mut dyn FnMut(Breach)),
    ) -> Result<(), Failure> {
        let mut monitor = std::mem::take(&mut self.monitor);
        let mut breaches = Vec::new();
        self.with_view(self.last(machine), machine, |view| {
            look(&mut monitor, view, &mut |breach| breaches.push(breach));
        });
        self.monitor = monitor;
        let mut ending: Option<Missed> = None;
        for breach in breaches {
            let rule = &self.monitor.rules()[breach.rule];
            let (note, missed) = self.broken_rule(rule, breach, machine);
            match &mut ending {
                _ if rule.go_on => {
                    self.notes.push(note);
                    self.noted.push(missed);
                }
                Some(first) => first.operands.push(format!("also: {}", missed.what)),
                None => ending = Some(missed),
            }
        }
        ending.map_or(Ok(()), |missed| Err(missed.into()))
    }

    /// The text of a breach for the trace, and as a failure.
    fn broken_rule(&self, rule: &Rule, breach: Breach, machine: &Machine) -> (String, Missed) {
        let name = rule.name.as_deref().unwrap_or_default();
        let (what, expressions) = match (&rule.claim, &rule.name) {
            (Claim::Always(condition), None) => {
                (format!("`always` is violated: `{}` is false", condition.source()), vec![condition])
            }
            (Claim::Never(condition), None) => {
                (format!("`never` is violated: `{}` is true", condition.source()), vec![condition])
            }
            (Claim::Always(condition), Some(_)) => {
                (format!("rule `{name}` is broken: `{}` is false", condition.source()), vec![condition])
            }
            (Claim::Never(condition), Some(_)) => {
                (format!("rule `{name}` is broken: `{}` is true", condition.source()), vec![condition])
            }
            (Claim::Follows(consequence), _) => {
                let (when, then) = (consequence.when.source(), consequence.then.source());
                let what = match breach.reason {
                    Reason::Late | Reason::Condition if consequence.within == Span::NONE => {
                        format!("`{then}` is not true in the cycle in which `{when}` became true")
                    }
                    Reason::Late | Reason::Condition => {
                        let within = length(consequence.within);
                        format!("`{then}` did not become true within {within} after `{when}`")
                    }
                    Reason::Early => {
                        let not_before = length(consequence.not_before);
                        format!("`{then}` is true earlier than {not_before} after `{when}`")
                    }
                    Reason::NeverBegan => format!("it never began: `{when}` did not become true"),
                };
                (format!("rule `{name}` is broken: {what}"), vec![&consequence.when, &consequence.then])
            }
        };
        let mut lines = Vec::new();
        let (began, failed) = (breach.began, breach.failed);
        let is_watch = matches!((&rule.claim, breach.reason), (Claim::Follows(_), Reason::Late | Reason::Early));
        if is_watch {
            lines.push(format!("began in cycle {}, at {} s", began.cycle, began.time));
            lines.push(format!("failed in cycle {}, at {} s", failed.cycle, failed.time));
        }
        let note = if is_watch { format!("{what}; it began at {} s", began.time) } else { what.clone() };
        self.with_view(self.last(machine), machine, |view| {
            for expression in expressions {
                for operand in Expression::operands(expression, view, machine) {
                    if !lines.contains(&operand) {
                        lines.push(operand);
                    }
                }
            }
        });
        let missed = Missed { place: rule.place.clone(), ..self.missed_now(what, lines, machine) };
        (note, missed)
    }

    /// The notes about breaches since the last call.
    pub(super) fn take_notes(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notes)
    }

    /// The result of the session: `failure` if it failed, else the breaches that were noted, and the rules that had to begin.
    pub(super) fn finish(&mut self, failure: Option<Failure>, machine: &Machine) -> Option<Failure> {
        // A rule that was broken before the first cycle ends also a run without a cycle.
        let ended = match (&failure, self.broken.take()) {
            (None, Some(broken)) => Some(broken),
            (None, None) => self.judge(machine, |monitor, _, report| monitor.end(report)).err(),
            (Some(_), _) => None,
        };
        let noted = std::mem::take(&mut self.noted);
        match failure.or(ended) {
            Some(Failure::Missed(mut missed)) => {
                missed
                    .operands
                    .extend(noted.iter().map(|other| format!("before: {} (at {} s)", other.what, other.time)));
                Some(Failure::Missed(missed))
            }
            Some(failure) => Some(failure),
            None => together(noted),
        }
    }

    /// Rules that never began, and watches that are open.
    pub(super) fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        for summary in self.monitor.summaries() {
            let (Some(name), Claim::Follows(consequence)) = (&summary.rule.name, &summary.rule.claim) else {
                continue;
            };
            if summary.begun == 0 {
                let when = consequence.when.source();
                remarks.push(format!("rule `{name}` never began: `{when}` did not become true"));
            }
            if let Some((count, oldest)) = summary.open {
                let oldest = oldest.time;
                remarks.push(match count {
                    1 => format!("rule `{name}`: 1 watch was open at the end; it began at {oldest} s"),
                    count => {
                        format!("rule `{name}`: {count} watches were open at the end; the first began at {oldest} s")
                    }
                });
            }
            if summary.closed > 0 {
                let noun = if summary.closed == 1 { "watch" } else { "watches" };
                remarks.push(format!("rule `{name}`: power on ended {} {noun} without a result", summary.closed));
            }
        }
        remarks
    }

    /// What became of each rule.
    pub(super) fn rules(&self) -> Vec<RuleResult> {
        let of_rule = |summary: Summary<'_>| {
            let (name, in_cycles) = name(summary.rule);
            let has_begun = !in_cycles || summary.begun > 0;
            let margin = summary.margin.map(|margin| margin.amount);
            RuleResult { name, in_cycles, has_begun, is_broken: summary.breaches > 0, margin }
        };
        self.monitor.summaries().map(of_rule).collect()
    }

    /// The smallest margin of each rule.
    pub(super) fn margins(&self) -> Vec<String> {
        let of_rule = |summary: Summary<'_>| {
            let (name, is_watch) = name(summary.rule);
            let margin = match (summary.margin, is_watch) {
                (Some(margin), true) => {
                    let cycles = margin.amount;
                    let (length, began) = (cycles * margin.cycle.seconds(), margin.at.time);
                    let length = Time::from_seconds(length);
                    let (met, begun) = (summary.met, summary.begun);
                    let noun = if (cycles - 1.0).abs() < 0.5 { "cycle" } else { "cycles" };
                    format!("{cycles} {noun} ({length} s), began at {began} s; {met} of {begun} in time")
                }
                (Some(margin), false) => format!("{} at {} s", margin.amount, margin.at.time),
                (None, true) if summary.begun == 0 => "none: `when` never became true".to_owned(),
                (None, true) => format!("none: it began {}", times(summary.begun)),
                (None, false) => "none: no `<`, `<=`, `>` or `>=` decides it".to_owned(),
            };
            format!("margin of `{name}`: {margin}")
        };
        self.monitor.summaries().map(of_rule).collect()
    }
}

/// What became of a rule in a run.
#[derive(Clone, Debug, PartialEq)]
pub struct RuleResult {
    /// Its name, or its condition.
    pub name: String,
    /// Whether it is a consequence, whose margin is in cycles; else the margin is in the unit of the compared value.
    pub in_cycles: bool,
    /// Whether its condition became true, for a consequence.
    pub has_begun: bool,
    /// Whether it is broken.
    pub is_broken: bool,
    /// Its smallest margin, if it was measured.
    pub margin: Option<f64>,
}

/// The name of a rule, and whether it is a consequence.
fn name(rule: &Rule) -> (String, bool) {
    match (&rule.name, &rule.claim) {
        (Some(name), Claim::Follows(_)) => (name.clone(), true),
        (Some(name), Claim::Always(_) | Claim::Never(_)) => (name.clone(), false),
        (None, Claim::Always(condition)) => (format!("always {}", condition.source()), false),
        (None, Claim::Never(condition)) => (format!("never {}", condition.source()), false),
        (None, Claim::Follows(consequence)) => (consequence.when.source().to_owned(), true),
    }
}

/// A limit of a rule, with its unit.
fn length(span: Span) -> String {
    match span {
        Span { cycles: 0 | 1, time } if time > Time::ZERO => format!("{time} s"),
        Span { cycles: 1, .. } => "1 cycle".to_owned(),
        Span { cycles, .. } => format!("{cycles} cycles"),
    }
}

fn times(count: u64) -> String {
    if count == 1 { "once".to_owned() } else { format!("{count} times") }
}

/// All noted breaches as one failure.
fn together(noted: Vec<Missed>) -> Option<Failure> {
    let mut noted = noted.into_iter();
    let mut first = noted.next()?;
    first.operands.extend(noted.map(|other| format!("also: {} (at {} s)", other.what, other.time)));
    Some(first.into())
}
