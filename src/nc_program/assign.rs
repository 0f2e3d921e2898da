//! Assignments: one value, or the values of an array (SET, REP).

use super::alarm::{Fault, Span};
use super::environment::Environment;
use super::evaluate::{Certainty, evaluate};
use super::expression::Expression;
use super::interpreter::Work;
use super::known::Known;
use super::scope::{Place, Running, write};
use super::state::Interpreter;
use super::syntax::Assignment;
use super::value::{Type, Value, integer};
use super::variables::Content;

/// Places that get a value, in the order of the writes.
type Writes = Vec<(Place, Value)>;

impl Interpreter {
    /// Assignments of a block: all of them, or none.
    pub(super) fn assign(
        &mut self,
        assignments: &[Assignment],
        work: &Work<'_>,
        environment: &mut dyn Environment,
    ) -> Result<(), Fault> {
        let mut undone: Vec<(Place, Value, Span)> = Vec::new();
        for assignment in assignments {
            if let Err(fault) = self.assign_one(assignment, &mut undone, work, environment) {
                for (place, value, at) in undone.into_iter().rev() {
                    // It had this value, so it can have it again.
                    let _ = write(&place, value, (&mut self.levels, &mut self.offset), environment, at);
                }
                return Err(fault);
            }
        }
        Ok(())
    }

    /// Adds the places with their values before, if they can be read.
    fn assign_one(
        &mut self,
        assignment: &Assignment,
        undone: &mut Vec<(Place, Value, Span)>,
        work: &Work<'_>,
        environment: &mut dyn Environment,
    ) -> Result<(), Fault> {
        let at = assignment.at;
        let mut scope = Running { levels: &self.levels, environment, axes: work.axes, offset: &self.offset };
        let place = scope.place(&assignment.place)?;
        let writes = match &assignment.value {
            Expression::List { is_repeated, values, at } => listed(&place, *is_repeated, values, *at, &mut scope)?,
            value => vec![(place, evaluate(value, &mut scope)?.value)],
        };
        for (place, value) in writes {
            let scope = Running { levels: &self.levels, environment, axes: work.axes, offset: &self.offset };
            let before = scope.read(&place, at).ok();
            write(&place, value, (&mut self.levels, &mut self.offset), environment, at)?;
            undone.extend(before.map(|before| (place, before, at)));
        }
        Ok(())
    }
}

/// The elements that SET and REP write, from the named one on.
fn listed(
    first: &Place,
    is_repeated: bool,
    values: &[Option<Expression>],
    at: Span,
    scope: &mut Running<'_>,
) -> Result<Writes, Fault> {
    let room = match first {
        Place::Element { level, variable, element, .. } => {
            let found = scope.levels.get(*level).and_then(|level| level.variables.get(*variable));
            let count = found.map_or(0, |variable| match &variable.content {
                Content::Values(values) => values.len(),
                Content::Reference(_) => 0,
            });
            count.saturating_sub(*element)
        }
        Place::RParameter(index) => scope.environment.r_parameters().saturating_sub(*index) as usize,
        Place::System { .. } | Place::Offset { .. } | Place::Programmable(_) => {
            return Err(Fault::new(12150, at, "SET and REP need an array"));
        }
    };
    let too_many = |count: usize| Fault::new(12260, at, format!("{count} values, the array has room for {room}"));
    let mut writes = Writes::new();
    if !is_repeated {
        if values.len() > room {
            return Err(too_many(values.len()));
        }
        for (index, value) in values.iter().enumerate() {
            if let Some(value) = value {
                writes.push((behind(first, index), evaluate(value, scope)?.value));
            }
        }
        return Ok(writes);
    }
    let [Some(value), count @ ..] = values else { return Ok(writes) };
    let value = evaluate(value, scope)?.value;
    let count = match count {
        [Some(count)] => {
            let count = evaluate(count, scope)?.value.convert(Type::Real, at)?;
            let count = integer(count.number().unwrap_or_default(), at)?;
            usize::try_from(count).map_err(|_| Fault::new(12560, at, "the number of elements is not negative"))?
        }
        _ => room,
    };
    if count > room {
        return Err(too_many(count));
    }
    writes.extend((0..count).map(|index| (behind(first, index), value.clone())));
    Ok(writes)
}

/// The element this far behind the first one.
fn behind(first: &Place, by: usize) -> Place {
    match first {
        Place::Element { level, variable, element, kind } => {
            Place::Element { level: *level, variable: *variable, element: element + by, kind: *kind }
        }
        Place::RParameter(index) => Place::RParameter(index.saturating_add(u32::try_from(by).unwrap_or(u32::MAX))),
        other => other.clone(),
    }
}

/// Whether the types of an assignment fit, in a check.
pub(super) fn judge(known: &mut Known<'_>, assignment: &Assignment) -> Result<(), Fault> {
    let mut values = Vec::new();
    match &assignment.value {
        Expression::List { is_repeated, values: list, .. } => {
            let count = if *is_repeated { 1 } else { list.len() };
            for value in list.iter().take(count).flatten() {
                values.push(evaluate(value, known)?);
            }
        }
        value => values.push(evaluate(value, known)?),
    }
    let place = evaluate(&assignment.place, known)?;
    if place.certainty == Certainty::Nothing {
        return Ok(());
    }
    // The length of a STRING is not a part of the type of a value.
    let of_variable = match &assignment.place {
        Expression::Variable { name, .. } => known.variables.iter().find(|variable| variable.name == *name),
        _ => None,
    };
    let length = of_variable.map(|variable| variable.kind).filter(|kind| matches!(kind, Type::Text(_)));
    let kind = length.unwrap_or_else(|| place.value.of_type());
    values.into_iter().try_for_each(|value| value.convert(kind, assignment.at).map(|_| ()))
}
