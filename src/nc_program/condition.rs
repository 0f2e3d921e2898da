//! Expressions of synchronised actions, which the channel evaluates in its cycles. What preparation knew is a constant in them; `$A…`,
//! `$V…` and `$R[n]` are read when they are evaluated.

use serde::{Deserialize, Serialize};

use super::alarm::{Fault, Span};
use super::auxiliary::{AuxiliaryKind, judged_value};
use super::environment::{Environment, SystemVariable, VariableRefusal};
use super::evaluate::{Scope, Term, evaluate};
use super::expression::Expression;
use super::names::AxisNames;
use super::value::{Type, Value, integer};

/// A condition.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Condition(pub(super) Expression);

/// A value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MainRunValue(pub(super) Expression);

impl Condition {
    /// Whether it holds now.
    ///
    /// # Errors
    /// The number of the alarm of the expression, for example 14051 for a division by zero.
    pub fn holds(&self, environment: &dyn Environment) -> Result<bool, u32> {
        let term = value(&self.0, environment)?;
        let result = term.convert(Type::Bool, Span::default()).map_err(|fault| fault.number)?;
        Ok(result == Value::Bool(true))
    }
}

impl MainRunValue {
    /// The number now.
    ///
    /// # Errors
    /// The number of the alarm of the expression.
    pub fn number(&self, environment: &dyn Environment) -> Result<f64, u32> {
        value(&self.0, environment)?.number().ok_or(12150)
    }

    /// The number of an auxiliary function now.
    ///
    /// # Errors
    /// The number of the alarm of the expression, or of a value that the function cannot have.
    pub fn auxiliary(&self, kind: AuxiliaryKind, environment: &dyn Environment) -> Result<f64, u32> {
        let number = self.number(environment)?;
        judged_value(kind, number).map(|()| number).map_err(|(alarm, _)| alarm)
    }

    /// Whether it has the same value whenever it is evaluated.
    pub(super) fn is_constant(&self) -> bool {
        matches!(self.0, Expression::Constant(_))
    }

    /// The value now.
    ///
    /// # Errors
    /// The number of the alarm of the expression.
    pub fn value(&self, environment: &dyn Environment) -> Result<Value, u32> {
        value(&self.0, environment)
    }
}

fn value(expression: &Expression, environment: &dyn Environment) -> Result<Value, u32> {
    let axes = environment.axes();
    let mut scope = MainRun { environment, axes: &axes };
    evaluate(expression, &mut scope).map(|term| term.value).map_err(|fault| fault.number)
}

struct MainRun<'a> {
    environment: &'a dyn Environment,
    axes: &'a AxisNames,
}

impl Scope for MainRun<'_> {
    fn axes(&self) -> &AxisNames {
        self.axes
    }

    fn r_parameter(&mut self, index: &Term, at: Span) -> Result<Term, Fault> {
        let index = r_index(&index.value, self.environment.r_parameters(), at)?;
        Ok(Term::known(Value::Real(self.environment.r_parameter(index))))
    }

    fn variable(&mut self, name: &str, _: &[Term], at: Span) -> Result<Term, Fault> {
        Err(Fault::new(12550, at, "variables of programs do not exist in the main run").about(name))
    }

    fn system(&mut self, name: &str, indices: &[Term], at: Span) -> Result<Term, Fault> {
        let indices: Vec<_> = indices.iter().map(|term| term.value.clone()).collect();
        read_system(self.environment, name, &indices, at).map(Term::known)
    }
}

/// The value of a system variable. `$R[n]` is an R parameter in the main run.
pub(super) fn read_system(
    environment: &dyn Environment,
    name: &str,
    indices: &[Value],
    at: Span,
) -> Result<Value, Fault> {
    if name == "$R" {
        let [index] = indices else { return Err(Fault::new(12400, at, "$R has one index")) };
        let index = r_index(index, environment.r_parameters(), at)?;
        return Ok(Value::Real(environment.r_parameter(index)));
    }
    let variable = SystemVariable { name, indices };
    environment.system(&variable).map_err(|refusal| refused(refusal, name, at))
}

/// The error of a system variable that cannot be read or written.
pub(super) fn refused(refusal: VariableRefusal, name: &str, at: Span) -> Fault {
    if refusal == VariableRefusal::NotModelled {
        return Fault::refused(at, "this system variable").about(name);
    }
    Fault::new(refusal.number(), at, refusal.reason()).about(name)
}

/// The index of an R parameter.
pub(super) fn r_index(index: &Value, count: u32, at: Span) -> Result<u32, Fault> {
    let number = index.number().ok_or_else(|| Fault::new(12410, at, "the index of an R parameter is a number"))?;
    let index = integer(number, at)?;
    let found = u32::try_from(index).ok().filter(|index| *index < count);
    found.ok_or_else(|| Fault::new(17020, at, format!("R{index}: the control has R0 to R{}", i64::from(count) - 1)))
}
