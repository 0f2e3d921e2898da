//! The terms of an expression: their values at a moment, and the names of their operands in messages.

use super::of_control::OfControl;
use super::view::{Moment, View};
use crate::image::Location;
use crate::variables::{AlarmNumber, Describe, NamedValue, Parameter, Place, RuleNumber, place_name, six_decimals};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operator {
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

/// A term of an expression. What is large or rare is boxed: a generated scenario has 100,000 expressions, and a term takes the memory of its
/// largest variant.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Term {
    Number(f64),
    Signal(Location),
    Value(NamedValue),
    Time,
    Named(Box<(usize, String)>),
    Alarm(AlarmNumber, Option<Place>),
    AlarmParameter(AlarmNumber, usize),
    Alarms,
    Edge { rising: bool, of: Box<Self> },
    Followed(Box<FollowedTerm>),
    Cause(Box<CauseTerm>),
    OfControl(Box<OfControl>),
    Not(Box<Self>),
    Negative(Box<Self>),
    Absolute(Box<Self>),
    Pair(Operator, Box<[Self; 2]>),
}

/// `since(E)` or `count(E)`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FollowedTerm {
    pub(super) question: Question,
    pub(super) of: Term,
    /// The text of the term, for messages.
    pub(super) text: String,
    /// Its index in [`View::followed`]; none until the expression is followed.
    pub(super) index: Option<usize>,
}

/// `cause(S, 'ID')`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CauseTerm {
    pub(super) signal: Location,
    /// The ID of the rule.
    pub(super) id: &'static str,
    /// All rules with this ID.
    pub(super) rules: Box<[RuleNumber]>,
    /// Its index in [`Moment::rules`]; none until the expression is followed.
    pub(super) index: Option<usize>,
}

impl CauseTerm {
    /// The rule behind the last edge of the signal.
    fn last_rule(&self, moment: &Moment<'_>) -> Option<RuleNumber> {
        self.index.and_then(|index| moment.rules.get(index).copied().flatten())
    }
}

/// What an expression asks of the rising edges of a term.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Question {
    /// The time since the last one.
    Since,
    /// How many there were.
    Count,
}

/// 0 is false, and so is an undefined value such as 0/0.
pub(super) fn truth(value: f64) -> bool {
    value != 0.0 && !value.is_nan()
}

fn number(truth: bool) -> f64 {
    if truth { 1.0 } else { 0.0 }
}

/// A value of the caller; NaN if it is not available yet.
fn named_value(moment: &Moment<'_>, index: usize) -> f64 {
    moment.named_values.get(index).copied().unwrap_or(f64::NAN)
}

fn parameter(parameter: Parameter) -> f64 {
    match parameter {
        Parameter::None | Parameter::Text(_) | Parameter::OfControl(_) => 0.0,
        Parameter::Channel(channel) => f64::from(channel.number()),
        Parameter::Axis(axis) => f64::from(axis.number()),
        Parameter::Number(number) => number as f64,
        Parameter::Direction(direction) => f64::from(direction),
        Parameter::Milliseconds(time) => time.milliseconds(),
    }
}

impl Term {
    pub(super) fn value(&self, view: &View<'_>) -> f64 {
        let now = &view.now;
        match self {
            Self::Number(number) => *number,
            Self::Signal(location) => now.memory.value(*location),
            // The parser refuses texts.
            Self::Value(value) => value.number(now.variables).unwrap_or(f64::NAN),
            Self::Time => now.time.seconds(),
            Self::Named(named) => named_value(now, named.0),
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
            Self::Followed(term) => {
                let followed = term.index.and_then(|index| view.followed.get(index));
                match term.question {
                    Question::Since => followed.map_or(f64::INFINITY, |followed| followed.since(now.time)),
                    Question::Count => followed.map_or(0.0, |followed| followed.count() as f64),
                }
            }
            Self::OfControl(term) => term.value(now),
            Self::Cause(term) => number(term.last_rule(now).is_some_and(|rule| term.rules.contains(&rule))),
            Self::Not(of) => number(!truth(of.value(view))),
            Self::Negative(of) => -of.value(view),
            Self::Absolute(of) => of.value(view).abs(),
            Self::Pair(operator, sides) => operator.apply(sides[0].value(view), || sides[1].value(view)),
        }
    }

    fn children(&self) -> [Option<&Self>; 2] {
        match self {
            Self::Edge { of, .. } | Self::Not(of) | Self::Negative(of) | Self::Absolute(of) => [Some(of), None],
            Self::Followed(term) => [Some(&term.of), None],
            Self::Pair(_, sides) => sides.each_ref().map(Some),
            Self::Number(_)
            | Self::Signal(_)
            | Self::Value(_)
            | Self::Time
            | Self::Named(..)
            | Self::Alarm(..)
            | Self::AlarmParameter(..)
            | Self::Alarms
            | Self::OfControl(_)
            | Self::Cause(_) => [None, None],
        }
    }

    /// The same terms as those of `children`.
    fn children_mut(&mut self) -> [Option<&mut Self>; 2] {
        match self {
            Self::Edge { of, .. } | Self::Not(of) | Self::Negative(of) | Self::Absolute(of) => [Some(of), None],
            Self::Followed(term) => [Some(&mut term.of), None],
            Self::Pair(_, sides) => sides.each_mut().map(Some),
            Self::Number(_)
            | Self::Signal(_)
            | Self::Value(..)
            | Self::Time
            | Self::Named(..)
            | Self::Alarm(..)
            | Self::AlarmParameter(..)
            | Self::Alarms
            | Self::OfControl(_)
            | Self::Cause(_) => [None, None],
        }
    }

    pub(super) fn any(&self, test: &dyn Fn(&Self) -> bool) -> bool {
        test(self) || self.children().into_iter().flatten().any(|child| child.any(test))
    }

    /// The distance to the other truth: positive if true, negative if false; infinite if no comparison decides.
    pub(super) fn distance(&self, view: &View<'_>) -> f64 {
        match self {
            Self::Not(of) => -of.distance(view),
            Self::Pair(operator, sides) => self.distance_of_pair(*operator, sides, view),
            Self::Number(_)
            | Self::Signal(_)
            | Self::Value(..)
            | Self::Time
            | Self::Named(..)
            | Self::Alarm(..)
            | Self::AlarmParameter(..)
            | Self::Alarms
            | Self::Edge { .. }
            | Self::Followed(_)
            | Self::OfControl(_)
            | Self::Cause(_)
            | Self::Negative(_)
            | Self::Absolute(_) => self.not_compared(view),
        }
    }

    fn distance_of_pair(&self, operator: Operator, [left, right]: &[Self; 2], view: &View<'_>) -> f64 {
        use Operator as O;
        match operator {
            O::And => left.distance(view).min(right.distance(view)),
            O::Or => left.distance(view).max(right.distance(view)),
            O::Less | O::LessOrEqual => right.value(view) - left.value(view),
            O::Greater | O::GreaterOrEqual => left.value(view) - right.value(view),
            O::Equal | O::NotEqual | O::Add | O::Subtract | O::Multiply | O::Divide | O::Minimum | O::Maximum => {
                self.not_compared(view)
            }
        }
    }

    /// The distance of a term that compares nothing.
    fn not_compared(&self, view: &View<'_>) -> f64 {
        if truth(self.value(view)) { f64::INFINITY } else { f64::NEG_INFINITY }
    }

    /// Visits every term, the inner ones before the outer ones.
    pub(super) fn each(&mut self, visit: &mut dyn FnMut(&mut Self)) {
        self.children_mut().into_iter().flatten().for_each(|child| child.each(visit));
        visit(self);
    }

    pub(super) fn operands(&self, view: &View<'_>, describe: &dyn Describe, lines: &mut Vec<String>) {
        if let Some(name) = self.name(describe) {
            let mut line =
                format!("{name} = {}", shown(self.value(view), matches!(self, Self::Value(NamedValue::Axis(..)))));
            if let Self::Cause(term) = self {
                let rule = term.last_rule(&view.now).map(|rule| describe.rule(rule).id);
                let found = rule.map_or_else(|| "no edge with a cause".to_owned(), |id| format!("last edge by {id}"));
                line = format!("{line}, {found}");
            }
            if !lines.contains(&line) {
                lines.push(line);
            }
        }
        for child in self.children().into_iter().flatten() {
            child.operands(view, describe, lines);
        }
    }

    /// The name of this operand in a message; `None` if the term is not an operand.
    fn name(&self, describe: &dyn Describe) -> Option<String> {
        let names = describe.names();
        let name = match self {
            Self::Signal(location) => {
                let address = names.address(*location);
                names.symbol(*location).map_or_else(|| address.to_string(), |symbol| format!("{symbol} ({address})"))
            }
            Self::Cause(term) => {
                let address = names.address(term.signal).to_string();
                format!("cause({}, '{}')", names.symbol(term.signal).unwrap_or(address), term.id)
            }
            Self::Value(value) => value.name(names),
            Self::Time => "time".to_owned(),
            Self::Named(named) => named.1.clone(),
            Self::Alarm(alarm, None) => format!("alarm({})", describe.alarm_name(*alarm)),
            Self::Alarm(alarm, Some(place)) => {
                format!("alarm({}, {})", describe.alarm_name(*alarm), place_name(*place, names))
            }
            Self::AlarmParameter(alarm, index) => {
                format!("alarm_parameter({}, {})", describe.alarm_name(*alarm), index + 1)
            }
            Self::Alarms => "alarms()".to_owned(),
            Self::OfControl(term) => term.name(describe),
            Self::Followed(term) => term.text.clone(),
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

/// A value in a message: six decimals for measured values, the shortest form for all others.
fn shown(value: f64, measured: bool) -> String {
    if measured { six_decimals(value) } else { format!("{value}") }
}

impl Operator {
    /// Its precedence, as in Rust.
    pub(super) const fn binding(self) -> u8 {
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

    pub(super) const COMPARISON: u8 = 3;

    pub(super) fn of(sign: &str) -> Option<Self> {
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
        reason = "`==` in a scenario means exact equality; a scenario uses `abs` for a tolerance"
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
mod tests {
    use super::*;

    #[test]
    fn a_term_takes_16_bytes() {
        assert_eq!(size_of::<Term>(), 16);
    }
}
