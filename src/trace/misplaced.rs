//! The errors of names of values, as `X.position`, where only signals can stand.

use crate::source::Problem;
use crate::variables::AxisValue;

/// The problem of a name that stands where only a signal can stand: if it is a value of an axis, as `X.position`, it says so, and where
/// values can stand. A signal that the problem proposes stays in the remedy.
#[must_use]
pub fn value_as_signal(problem: Problem, name: &str) -> Problem {
    match name.rsplit_once('.') {
        Some((_, value)) if AxisValue::named(value).is_some() => {
            let what = format!("expected a signal, found `{name}`, which is a value and not a signal");
            let place = "values stand in expressions (`wait`, `hold`, `expect`, `capture`, rules) and in `watch`";
            Problem { what, cure: format!("{place}{}", nearest_signal(&problem)), ..problem }
        }
        Some(_) | None => problem,
    }
}

/// The nearest signal that a problem proposes, behind a remedy; nothing if it proposes none.
#[must_use]
pub fn nearest_signal(problem: &Problem) -> String {
    let near = problem.cure.strip_prefix("did you mean ").and_then(|near| near.strip_suffix('?'));
    near.map_or_else(String::new, |near| format!("; the nearest signal is {near}"))
}
