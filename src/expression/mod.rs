//! EXPRESSIONS over the interface: `X.gantry_synchronization_ready_to_start && alarm(10654)`.
//!
//! Numbers are `f64`, and 0 is false. Operators and their precedence are Rust's; comparisons do not chain.
//!
//! # Contract
//!
//! A caller meets this module twice.
//!
//! 1. **Reading.** [`Expression::parse`] looks up every name in a [`Scope`]. The scope is a trait, implemented where the names are
//!    known: `Machine` knows signals, axes, channels and alarms, a scenario adds its captured values. An
//!    unknown name is refused here, before anything runs, and the nearest known name is in the error. The result holds
//!    places in memory and numbers, no names to look up.
//! 2. **Evaluation.** [`Expression::value`] and [`Expression::holds`] read a [`View`]: three borrowed [`Moment`]s of the same machine
//!    that the expression was read for. Nothing is allocated, copied or kept, and the same view gives the same value. A caller
//!    that keeps no history passes [`View::at`], in which no edge occurs.
//!
//! | in an expression | means | read from |
//! |---|---|---|
//! | `X.controller_enable`, `DB31.DBX2.1`, `MD24:REAL` | [`Scope::signal`] | [`Moment::memory`] of `now` |
//! | `X.position` | [`AxisValue`] of an axis in [`Scope::describe`] | [`Moment::variables`] of `now` |
//! | `alarm(10654)`, `alarm(10651, X)`, `alarm_parameter(10651, 1)`, `alarms()` | alarms in [`Scope::describe`] | [`Moment::variables`] of `now` |
//! | `time` | seconds since the caller's time zero | [`Moment::time`] of `now` |
//! | any other plain name | [`Scope::named_values`] | [`Moment::named_values`] of `now` |
//! | `rose(…)`, `fell(…)` | an edge between two cycles | the same of `before` and `last` |
//! | `abs`, `min`, `max` | arithmetic | |
//!
//! `now` can be ahead of `last`: a scenario sees in it what it wrote and no cycle has taken up yet. A caller that evaluates edges has
//! to provide `before`, the state one cycle earlier; [`Expression::looks_back`] says whether it is needed.

mod parse;
mod tokens;

use crate::image::{Location, Memory};
use crate::source::Problem;
use crate::units::{AxisNumber, Time};
use crate::variables::{
    AlarmNumber, AxisValue, Describe, Parameter, Place, Variables, axis_name, place_name, six_decimals,
};

/// What the names of an expression mean.
pub trait Scope {
    /// The names of axes and channels, and the alarms of the control.
    fn describe(&self) -> &dyn Describe;

    /// The place in memory of a symbol or an address.
    ///
    /// # Errors
    /// There is no such signal; the cure names the nearest known one.
    fn signal(&self, name: &str) -> Result<Location, Problem>;

    /// The names of values that the caller gives beside the machine, such as captured values or constants, in the order of
    /// [`Moment::named_values`].
    fn named_values(&self) -> &[String] {
        &[]
    }
}

/// Everything that an expression looks at, at one moment.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// The signals.
    pub memory: &'a Memory,
    /// Axis values and alarms.
    pub variables: &'a Variables,
    /// Since the caller's time zero, such as the start of a scenario.
    pub time: Time,
    /// The caller's own values, in the order of [`Scope::named_values`]; one that is not there yet has no value (NaN).
    pub named_values: &'a [f64],
}

/// Now, and the last two cycles, between which edges are found.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// What everything but an edge looks at.
    pub now: Moment<'a>,
    /// After the last cycle.
    pub last: Moment<'a>,
    /// After the cycle before it.
    pub before: Moment<'a>,
}

impl<'a> View<'a> {
    /// One moment without a history, in which nothing rises or falls.
    #[must_use]
    pub fn at(now: Moment<'a>) -> Self {
        Self { now, last: now, before: now }
    }
}

/// An expression whose names have been looked up.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    source: String,
    root: Term,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Operator {
    Or,
    And,
    Equal,
    NotEqual,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Add,
    Subtract,
    Multiply,
    Divide,
    Minimum,
    Maximum,
}

#[derive(Clone, Debug, PartialEq)]
enum Term {
    Number(f64),
    Signal(Location),
    Value(AxisNumber, AxisValue),
    Time,
    Named(usize, String),
    Alarm(AlarmNumber, Option<Place>),
    AlarmParameter(AlarmNumber, usize),
    Alarms,
    Edge { rising: bool, of: Box<Self> },
    Not(Box<Self>),
    Negative(Box<Self>),
    Absolute(Box<Self>),
    Pair(Operator, Box<Self>, Box<Self>),
}

impl Expression {
    /// Reads an expression and looks its names up.
    ///
    /// # Errors
    /// It is not one, or a name in it is unknown; the problem names the nearest known one.
    pub fn parse(source: &str, scope: &dyn Scope) -> Result<Self, Problem> {
        Ok(Self { source: source.trim().to_owned(), root: parse::parse(source.trim(), scope)? })
    }

    /// The expression as it was written.
    #[must_use]
    pub fn source(&self) -> &str {
        &self.source
    }

    /// Its value; allocates nothing.
    #[must_use]
    pub fn value(&self, view: &View<'_>) -> f64 {
        self.root.value(view)
    }

    /// Whether its value is true, that is neither 0 nor undefined.
    #[must_use]
    pub fn holds(&self, view: &View<'_>) -> bool {
        truth(self.value(view))
    }

    /// Whether it compares two cycles, so that somebody has to remember the last one.
    #[must_use]
    pub fn looks_back(&self) -> bool {
        self.root.any(&|term| matches!(term, Term::Edge { .. }))
    }

    /// Every signal and value in it with what it is now, one line each, each once.
    #[must_use]
    pub fn operands(&self, view: &View<'_>, describe: &dyn Describe) -> Vec<String> {
        let mut lines = Vec::new();
        self.root.operands(view, describe, &mut lines);
        lines
    }
}

/// 0 is false; so is what has no value, as 0/0.
fn truth(value: f64) -> bool {
    value != 0.0 && !value.is_nan()
}

fn number(truth: bool) -> f64 {
    if truth { 1.0 } else { 0.0 }
}

/// A value of the caller; one that is not there yet has no value.
fn named_value(moment: &Moment<'_>, index: usize) -> f64 {
    moment.named_values.get(index).copied().unwrap_or(f64::NAN)
}

fn parameter(parameter: Parameter) -> f64 {
    match parameter {
        Parameter::None => 0.0,
        Parameter::Channel(channel) => f64::from(channel.number()),
        Parameter::Axis(axis) => f64::from(axis.number()),
        Parameter::Number(number) => number as f64,
        Parameter::Direction(direction) => f64::from(direction),
    }
}

impl Term {
    fn value(&self, view: &View<'_>) -> f64 {
        let now = &view.now;
        match self {
            Self::Number(number) => *number,
            Self::Signal(location) => now.memory.value(*location),
            Self::Value(axis, value) => value.of(*axis, now.variables),
            Self::Time => now.time.seconds(),
            Self::Named(index, _) => named_value(now, *index),
            Self::Alarm(alarm, place) => number(now.variables.alarms.find(*alarm, *place).is_some()),
            Self::AlarmParameter(alarm, index) => {
                let raised = now.variables.alarms.find(*alarm, None);
                raised.map_or(0.0, |raised| parameter(raised.parameters[*index]))
            }
            Self::Alarms => now.variables.alarms.count() as f64,
            Self::Edge { rising, of } => {
                let last = truth(of.value(&View { now: view.last, ..*view }));
                let before = truth(of.value(&View { now: view.before, ..*view }));
                number(last != before && last == *rising)
            }
            Self::Not(of) => number(!truth(of.value(view))),
            Self::Negative(of) => -of.value(view),
            Self::Absolute(of) => of.value(view).abs(),
            Self::Pair(operator, left, right) => operator.apply(left.value(view), || right.value(view)),
        }
    }

    fn children(&self) -> [Option<&Self>; 2] {
        match self {
            Self::Edge { of, .. } | Self::Not(of) | Self::Negative(of) | Self::Absolute(of) => [Some(of), None],
            Self::Pair(_, left, right) => [Some(left), Some(right)],
            Self::Number(_)
            | Self::Signal(_)
            | Self::Value(..)
            | Self::Time
            | Self::Named(..)
            | Self::Alarm(..)
            | Self::AlarmParameter(..)
            | Self::Alarms => [None, None],
        }
    }

    fn any(&self, test: &dyn Fn(&Self) -> bool) -> bool {
        test(self) || self.children().into_iter().flatten().any(|child| child.any(test))
    }

    fn operands(&self, view: &View<'_>, describe: &dyn Describe, lines: &mut Vec<String>) {
        if let Some(name) = self.name(describe) {
            let line = format!("{name} = {}", shown(self.value(view), matches!(self, Self::Value(..))));
            if !lines.contains(&line) {
                lines.push(line);
            }
        }
        for child in self.children().into_iter().flatten() {
            child.operands(view, describe, lines);
        }
    }

    /// What a person calls this operand; nothing for what is no operand.
    fn name(&self, describe: &dyn Describe) -> Option<String> {
        let names = describe.names();
        let name = match self {
            Self::Signal(location) => {
                let address = names.address(*location);
                names.symbol(*location).map_or_else(|| address.to_string(), |symbol| format!("{symbol} ({address})"))
            }
            Self::Value(axis, value) => format!("{}.{value}", axis_name(*axis, names)),
            Self::Time => "time".to_owned(),
            Self::Named(_, name) => name.clone(),
            Self::Alarm(alarm, None) => format!("alarm({})", describe.alarm_name(*alarm)),
            Self::Alarm(alarm, Some(place)) => {
                format!("alarm({}, {})", describe.alarm_name(*alarm), place_name(*place, names))
            }
            Self::AlarmParameter(alarm, index) => {
                format!("alarm_parameter({}, {})", describe.alarm_name(*alarm), index + 1)
            }
            Self::Alarms => "alarms()".to_owned(),
            Self::Number(_)
            | Self::Edge { .. }
            | Self::Not(_)
            | Self::Negative(_)
            | Self::Absolute(_)
            | Self::Pair(..) => return None,
        };
        Some(name)
    }
}

/// A value for a message: six decimals for what is measured, as short as possible for the rest.
fn shown(value: f64, measured: bool) -> String {
    if measured { six_decimals(value) } else { format!("{value}") }
}

impl Operator {
    /// How strongly it binds, as in Rust.
    const fn binding(self) -> u8 {
        match self {
            Self::Or => 1,
            Self::And => 2,
            Self::Equal | Self::NotEqual | Self::Less | Self::LessOrEqual | Self::Greater | Self::GreaterOrEqual => {
                Self::COMPARISON
            }
            Self::Add | Self::Subtract => 4,
            Self::Multiply | Self::Divide => 5,
            Self::Minimum | Self::Maximum => 6,
        }
    }

    const COMPARISON: u8 = 3;

    fn of(sign: &str) -> Option<Self> {
        Some(match sign {
            "||" => Self::Or,
            "&&" => Self::And,
            "==" => Self::Equal,
            "!=" => Self::NotEqual,
            "<" => Self::Less,
            "<=" => Self::LessOrEqual,
            ">" => Self::Greater,
            ">=" => Self::GreaterOrEqual,
            "+" => Self::Add,
            "-" => Self::Subtract,
            "*" => Self::Multiply,
            "/" => Self::Divide,
            _ => return None,
        })
    }

    #[expect(
        clippy::float_cmp,
        reason = "`==` in a scenario means equal; the writer of a scenario takes `abs` where not"
    )]
    fn apply(self, left: f64, right: impl FnOnce() -> f64) -> f64 {
        match self {
            Self::Or => number(truth(left) || truth(right())),
            Self::And => number(truth(left) && truth(right())),
            Self::Equal => number(left == right()),
            Self::NotEqual => number(left != right()),
            Self::Less => number(left < right()),
            Self::LessOrEqual => number(left <= right()),
            Self::Greater => number(left > right()),
            Self::GreaterOrEqual => number(left >= right()),
            Self::Add => left + right(),
            Self::Subtract => left - right(),
            Self::Multiply => left * right(),
            Self::Divide => left / right(),
            Self::Minimum => left.min(right()),
            Self::Maximum => left.max(right()),
        }
    }
}

#[cfg(test)]
mod tests;
