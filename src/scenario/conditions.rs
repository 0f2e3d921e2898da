//! The rules of a scenario for one machine: names are looked up before anything runs.

use super::duration::Duration;
use super::fields::Named;
use super::rules::{Written, WrittenClaim};
use super::steps::Reader;
use crate::expression::Expression;
use crate::monitor::{Claim, Consequence, Rule, Span};
use crate::source::Problem;
use crate::units::Time;

impl Written {
    /// The rule for a machine with this cycle.
    pub(super) fn prepared(&self, reader: &mut Reader<'_>, cycle: Time) -> Result<Rule, Problem> {
        let mut expression = |text: &Named| condition(text, reader);
        let claim = match &self.claim {
            WrittenClaim::Always(text) => Claim::Always(expression(text)?),
            WrittenClaim::Never(text) => Claim::Never(expression(text)?),
            WrittenClaim::Follows { when, then, within, not_before, from_start, must_begin } => {
                // Only their present lengths can be compared where one is a time and the other a number of cycles.
                let cycles = |duration: &Option<Duration>| duration.map_or(0, |duration| duration.cycles(cycle));
                if cycles(not_before) > cycles(within) {
                    let what = "expected `not_before` at most as long as `within`, found it longer";
                    return Err(self.place.problem(what, "no consequence could be in time; exchange the two"));
                }
                let span = |duration: &Option<Duration>| duration.map_or(Span::NONE, Duration::span);
                Claim::Follows(Box::new(Consequence {
                    when: expression(when)?,
                    then: expression(then)?,
                    within: span(within),
                    not_before: span(not_before),
                    from_start: *from_start,
                    must_begin: *must_begin,
                }))
            }
        };
        Ok(Rule { name: Some(self.name.clone()), place: Some(self.place.clone()), claim, go_on: self.go_on })
    }
}

/// A condition of the head, which holds from the first cycle on and cannot use a value that a later step captures.
pub(super) fn condition(text: &Named, reader: &mut Reader<'_>) -> Result<Expression, Problem> {
    let captured = std::mem::take(&mut reader.captured);
    let parsed = reader.expression(&text.text, &text.place);
    let uses_captured = |problem: &Problem| captured.iter().any(|name| problem.what.contains(&format!("`{name}`")));
    let parsed = parsed.map_err(|mut problem| {
        if uses_captured(&problem) {
            "a captured value exists only after its step; rules, `never` and `always` apply from the start"
                .clone_into(&mut problem.cure);
        }
        problem
    });
    reader.captured = captured;
    parsed
}
