//! Values of expressions. Variables come from a [`Scope`]: the interpreter has values, the static check has types only.

use super::alarm::{Fault, Span};
use super::expression::{Expression, is_main_run};
use super::function::apply;
use super::names::AxisNames;
use super::operator::{Operator, binary, prefix};
use super::value::{Type, Value, shown};

/// How much of a value is known. A run knows everything.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Certainty {
    /// Not even the type.
    Nothing,
    /// The type; the value is an example of it.
    Type,
    /// The value.
    Value,
}

/// A value, or an example of an unknown one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Term {
    pub(super) value: Value,
    pub(super) certainty: Certainty,
}

impl Term {
    pub(super) fn known(value: Value) -> Self {
        Self { value, certainty: Certainty::Value }
    }

    /// An unknown value of a type.
    pub(super) fn of_type(kind: Type) -> Self {
        let value = match kind {
            Type::Int => Value::Int(1),
            Type::Real => Value::Real(1.0),
            Type::Bool => Value::Bool(true),
            Type::Char => Value::Char(b'1'),
            Type::Text(_) => Value::Text("1".to_owned()),
            Type::Axis => Value::Axis(super::names::AxisIndex(0)),
            Type::Frame => Value::Frame(Vec::new()),
        };
        Self { value, certainty: Certainty::Type }
    }

    pub(super) fn unknown() -> Self {
        Self { value: Value::Real(1.0), certainty: Certainty::Nothing }
    }

    pub(super) fn is_known(&self) -> bool {
        self.certainty == Certainty::Value
    }

    /// The value as another type. An unknown value cannot be outside the range of the type.
    pub(super) fn convert(self, to: Type, at: Span) -> Result<Self, Fault> {
        if self.certainty == Certainty::Nothing {
            return Ok(Self { certainty: Certainty::Nothing, ..Self::of_type(to) });
        }
        let certainty = self.certainty;
        match self.value.convert(to, at) {
            Ok(value) => Ok(Self { value, certainty }),
            Err(fault) if certainty == Certainty::Value || fault.number == 12150 => Err(fault),
            Err(_) => Ok(Self::of_type(to)),
        }
    }
}

/// What an expression can read.
pub(super) trait Scope {
    fn axes(&self) -> &AxisNames;
    fn r_parameter(&mut self, index: &Term, at: Span) -> Result<Term, Fault>;
    fn variable(&mut self, name: &str, indices: &[Term], at: Span) -> Result<Term, Fault>;
    fn system(&mut self, name: &str, indices: &[Term], at: Span) -> Result<Term, Fault>;
}

/// The value of an expression.
pub(super) fn evaluate(expression: &Expression, scope: &mut dyn Scope) -> Result<Term, Fault> {
    match expression {
        Expression::Constant(value) => Ok(Term::known(value.clone())),
        Expression::RParameter { index, at } => {
            let index = evaluate(index, scope)?;
            scope.r_parameter(&index, *at)
        }
        Expression::Variable { name, indices, at } => {
            let indices = variable_indices(indices, scope)?;
            scope.variable(name, &indices, *at)
        }
        Expression::System { name, indices, at } => {
            let indices = system_indices(indices, scope)?;
            scope.system(name, &indices, *at)
        }
        Expression::Prefixed { operator, operand, at } => {
            let operand = evaluate(operand, scope)?;
            settled(&[&operand], prefix(*operator, &operand.value, *at))
        }
        Expression::Binary { operator, left, right, at } => {
            let left = evaluate(left, scope)?;
            let right = evaluate(right, scope)?;
            if *operator == Operator::Join {
                let (from, to) = (joined(&left.value, scope.axes()), joined(&right.value, scope.axes()));
                return settled(&[&left, &right], binary(*operator, &from, &to, *at));
            }
            settled(&[&left, &right], binary(*operator, &left.value, &right.value, *at))
        }
        Expression::Function { function, arguments, at } => {
            let terms = evaluate_all(arguments, scope)?;
            let values: Vec<_> = terms.iter().map(|term| term.value.clone()).collect();
            settled(&terms.iter().collect::<Vec<_>>(), apply(*function, &values, *at))
        }
        Expression::List { at, .. } => Err(Fault::new(12080, *at, "SET and REP only assign values to an array")),
    }
}

/// The values of several expressions.
pub(super) fn evaluate_all(expressions: &[Expression], scope: &mut dyn Scope) -> Result<Vec<Term>, Fault> {
    expressions.iter().map(|one| evaluate(one, scope)).collect()
}

/// The indices of a variable. Behind an axis, the part of a frame is a name: `FRAME1[X,TR]`.
pub(super) fn variable_indices(indices: &[Expression], scope: &mut dyn Scope) -> Result<Vec<Term>, Fault> {
    if let [before @ .., last] = indices
        && let Some(part) = part(last)
    {
        let mut found = evaluate_all(before, scope)?;
        if matches!(found.last(), Some(Term { value: Value::Axis(_), .. })) {
            found.push(part);
            return Ok(found);
        }
    }
    evaluate_all(indices, scope)
}

/// The indices of a system variable. Parts of frames (`TR`, `FI`) are names.
pub(super) fn system_indices(indices: &[Expression], scope: &mut dyn Scope) -> Result<Vec<Term>, Fault> {
    indices.iter().map(|one| part(one).map_or_else(|| evaluate(one, scope), Ok)).collect()
}

/// The part of a frame that an index names.
fn part(index: &Expression) -> Option<Term> {
    match index {
        Expression::Variable { name, indices, .. } if indices.is_empty() && FRAME_PARTS.contains(&name.as_str()) => {
            Some(Term::known(Value::Text(name.clone())))
        }
        _ => None,
    }
}

/// Parts of frames in an index: offset, fine offset, rotation, scale, mirror.
const FRAME_PARTS: &[&str] = &["TR", "FI", "RT", "SC", "MI"];

/// The result of operands. An error that only an example caused is none.
fn settled(operands: &[&Term], result: Result<Value, Fault>) -> Result<Term, Fault> {
    let certainty = operands.iter().map(|term| term.certainty).min().unwrap_or(Certainty::Value);
    match (result, certainty) {
        (Ok(value), _) => Ok(Term { value, certainty }),
        (Err(fault), Certainty::Value) => Err(fault),
        (Err(fault), Certainty::Type) if fault.number == 12150 => Err(fault),
        (Err(_), Certainty::Type | Certainty::Nothing) => Ok(Term::unknown()),
    }
}

/// A value as a part of a text.
fn joined(value: &Value, axes: &AxisNames) -> Value {
    Value::Text(match value {
        Value::Int(value) => value.to_string(),
        Value::Real(value) => shown(*value),
        Value::Bool(value) => if *value { "TRUE" } else { "FALSE" }.to_owned(),
        Value::Char(code) => char::from(*code).to_string(),
        Value::Text(text) => text.clone(),
        Value::Axis(axis) => axes.name(*axis).to_owned(),
        // No text: the operator refuses it.
        Value::Frame(_) => return value.clone(),
    })
}

/// The expression with everything that preparation knows as a constant; variables of the main run stay, with their indices as constants.
pub(super) fn frozen(expression: &Expression, scope: &mut dyn Scope) -> Result<Expression, Fault> {
    let is_main = |part: &Expression| matches!(part, Expression::System { name, .. } if is_main_run(name));
    if !expression.any(&is_main) {
        let value = evaluate(expression, scope)?.value;
        return Ok(Expression::Constant(value));
    }
    Ok(match expression {
        Expression::System { name, indices, at } => {
            let indices = system_indices(indices, scope)?.into_iter().map(|term| Expression::Constant(term.value));
            Expression::System { name: name.clone(), indices: indices.collect(), at: *at }
        }
        Expression::Prefixed { operator, operand, at } => {
            let operand = Box::new(frozen(operand, scope)?);
            Expression::Prefixed { operator: *operator, operand, at: *at }
        }
        Expression::Binary { operator, left, right, at } => {
            let (left, right) = (Box::new(frozen(left, scope)?), Box::new(frozen(right, scope)?));
            Expression::Binary { operator: *operator, left, right, at: *at }
        }
        Expression::Function { function, arguments, at } => {
            let arguments = arguments.iter().map(|one| frozen(one, scope)).collect::<Result<_, _>>()?;
            Expression::Function { function: *function, arguments, at: *at }
        }
        Expression::Constant(_)
        | Expression::RParameter { .. }
        | Expression::Variable { .. }
        | Expression::List { .. } => expression.clone(),
    })
}
