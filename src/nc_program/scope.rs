//! What the expressions of a running program read and write: variables of its levels, R parameters, system variables.

use super::alarm::{Fault, Span};
use super::condition::{r_index, read_system, refused};
use super::environment::{Environment, SystemVariable};
use super::evaluate::{Scope, Term, evaluate, system_indices, variable_indices};
use super::expression::Expression;
use super::frames::{component, offset_of, programmable, set_offset};
use super::names::{AxisIndex, AxisNames};
use super::state::Level;
use super::value::{Type, Value};
use super::variables::{Content, Reference, Variable, element, index};

/// The scope of the innermost level.
pub(super) struct Running<'a> {
    pub(super) levels: &'a [Level],
    pub(super) environment: &'a dyn Environment,
    pub(super) axes: &'a AxisNames,
    /// The programmable offset.
    pub(super) offset: &'a [(AxisIndex, f64)],
}

/// A place that can be written, with its indices.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Place {
    RParameter(u32),
    Element {
        level: usize,
        variable: usize,
        element: usize,
        kind: Type,
    },
    /// `FRAME1[X,TR]`: the offset of an axis in a variable of type FRAME.
    Offset {
        level: usize,
        variable: usize,
        element: usize,
        axis: AxisIndex,
    },
    /// `$P_PFRAME`, `$P_PFRAME[X,TR]`: the programmable offset, or that of one axis.
    Programmable(Option<AxisIndex>),
    System {
        name: String,
        indices: Vec<Value>,
    },
}

impl Scope for Running<'_> {
    fn axes(&self) -> &AxisNames {
        self.axes
    }

    fn r_parameter(&mut self, index: &Term, at: Span) -> Result<Term, Fault> {
        let index = r_index(&index.value, self.environment.r_parameters(), at)?;
        Ok(Term::known(Value::Real(self.environment.r_parameter(index))))
    }

    fn variable(&mut self, name: &str, indices: &[Term], at: Span) -> Result<Term, Fault> {
        let place = self.element_of(name, indices, at)?;
        self.read(&place, at).map(Term::known)
    }

    fn system(&mut self, name: &str, indices: &[Term], at: Span) -> Result<Term, Fault> {
        let indices: Vec<_> = indices.iter().map(|term| term.value.clone()).collect();
        if let Some(value) = self.of_the_levels(name, &indices, at)? {
            return Ok(Term::known(value));
        }
        read_system(self.environment, name, &indices, at).map(Term::known)
    }
}

impl Running<'_> {
    /// `$P_STACK`, the program level, and `$P_PROG[level]`, the name of a program.
    fn of_the_levels(&self, name: &str, indices: &[Value], at: Span) -> Result<Option<Value>, Fault> {
        let highest = self.levels.len().saturating_sub(1);
        match (name, indices) {
            ("$P_STACK", []) => Ok(Some(Value::Int(i32::try_from(highest).unwrap_or(i32::MAX)))),
            ("$P_PROG", [level]) => {
                let level = usize::try_from(index(level, at)?).ok().and_then(|level| self.levels.get(level));
                let level = level.ok_or_else(|| Fault::new(17020, at, format!("the levels are 0 to {highest}")))?;
                let file = level.program.rsplit('/').next().unwrap_or_default();
                Ok(Some(Value::Text(format!("_N_{}", file.replace('.', "_")))))
            }
            ("$P_PFRAME", _) => {
                let place = Place::Programmable(programmable(indices, at)?);
                self.read(&place, at).map(Some)
            }
            _ => Ok(None),
        }
    }

    /// The variable of this name in the innermost level, with its level and its place there.
    pub(super) fn find(&self, name: &str, at: Span) -> Result<(usize, usize, &Variable), Fault> {
        let found = self.levels.last().and_then(|level| {
            let variable = level.variable(name)?;
            Some((self.levels.len() - 1, variable, &level.variables[variable]))
        });
        found.ok_or_else(|| Fault::new(12550, at, "neither a variable nor an axis has this name").about(name))
    }

    fn element_of(&self, name: &str, indices: &[Term], at: Span) -> Result<Place, Fault> {
        let (level, variable, found) = self.find(name, at)?;
        let values: Vec<_> = indices.iter().map(|term| term.value.clone()).collect();
        let axis = component(found, &values, at)?;
        let values = if axis.is_some() { &values[..found.dimensions.len()] } else { &values[..] };
        let indices: Vec<i32> = values.iter().map(|value| index(value, at)).collect::<Result<_, _>>()?;
        let element = element(&found.dimensions, &indices, at)?;
        let kind = found.kind;
        let place = match &found.content {
            Content::Values(_) => Place::Element { level, variable, element, kind },
            Content::Reference(Reference::RParameter(index)) => Place::RParameter(*index),
            Content::Reference(Reference::Variable { level, variable, element: one }) => {
                let (level, variable) = (*level, *variable);
                // The type of the variable behind the parameter counts.
                let behind = self.levels.get(level).and_then(|level| level.variables.get(variable));
                let kind = behind.map_or(kind, |behind| behind.kind);
                Place::Element { level, variable, element: one.unwrap_or(element), kind }
            }
        };
        Ok(match (axis, place) {
            (Some(axis), Place::Element { level, variable, element, .. }) => {
                Place::Offset { level, variable, element, axis }
            }
            (_, place) => place,
        })
    }

    /// The place that an expression names, with its indices evaluated.
    pub(super) fn place(&mut self, expression: &Expression) -> Result<Place, Fault> {
        match expression {
            Expression::RParameter { index, at } => {
                let index = evaluate(index, self)?;
                r_index(&index.value, self.environment.r_parameters(), *at).map(Place::RParameter)
            }
            Expression::Variable { name, indices, at } => {
                let indices = variable_indices(indices, self)?;
                self.element_of(name, &indices, *at)
            }
            Expression::System { name, indices, .. } => {
                let indices: Vec<_> = system_indices(indices, self)?.into_iter().map(|term| term.value).collect();
                if name == "$P_PFRAME" {
                    return programmable(&indices, Span::default()).map(Place::Programmable);
                }
                Ok(Place::System { name: name.clone(), indices })
            }
            Expression::Constant(_)
            | Expression::Prefixed { .. }
            | Expression::Binary { .. }
            | Expression::Function { .. }
            | Expression::List { .. } => Err(Fault::new(12080, Span::default(), "a variable is missing")),
        }
    }

    /// The value of a place.
    pub(super) fn read(&self, place: &Place, at: Span) -> Result<Value, Fault> {
        match place {
            Place::RParameter(index) => Ok(Value::Real(self.environment.r_parameter(*index))),
            Place::Programmable(None) => Ok(Value::Frame(self.offset.to_vec())),
            Place::Programmable(Some(axis)) => Ok(Value::Real(offset_of(self.offset, *axis))),
            Place::Offset { level, variable, element, axis } => {
                let (level, variable, element) = (*level, *variable, *element);
                let frame = self.read(&Place::Element { level, variable, element, kind: Type::Frame }, at)?;
                let Value::Frame(offsets) = frame else { return Err(Fault::new(12150, at, "no FRAME")) };
                Ok(Value::Real(offset_of(&offsets, *axis)))
            }
            Place::Element { level, variable, element, .. } => {
                let found = self.levels.get(*level).and_then(|level| level.variables.get(*variable));
                let value = found.and_then(|variable| match &variable.content {
                    Content::Values(values) => values.get(*element).cloned(),
                    Content::Reference(_) => None,
                });
                value.ok_or_else(|| Fault::new(12400, at, "the element does not exist"))
            }
            Place::System { name, indices } => read_system(self.environment, name, indices, at),
        }
    }
}

/// Writes a place. The value gets the type of the place.
pub(super) fn write(
    place: &Place,
    value: Value,
    (levels, offset): (&mut [Level], &mut Vec<(AxisIndex, f64)>),
    environment: &mut dyn Environment,
    at: Span,
) -> Result<(), Fault> {
    match place {
        Place::RParameter(index) => {
            let Value::Real(number) = value.convert(Type::Real, at)? else { return Ok(()) };
            environment.set_r_parameter(*index, number);
        }
        Place::Element { level, variable, element, kind } => {
            let value = value.convert(*kind, at)?;
            let found = levels.get_mut(*level).and_then(|level| level.variables.get_mut(*variable));
            if let Some(Content::Values(values)) = found.map(|variable| &mut variable.content)
                && let Some(place) = values.get_mut(*element)
            {
                *place = value;
            }
        }
        Place::Offset { level, variable, element, axis } => {
            let Value::Real(number) = value.convert(Type::Real, at)? else { return Ok(()) };
            let found = levels.get_mut(*level).and_then(|level| level.variables.get_mut(*variable));
            if let Some(Content::Values(values)) = found.map(|variable| &mut variable.content)
                && let Some(Value::Frame(offsets)) = values.get_mut(*element)
            {
                set_offset(offsets, *axis, number);
            }
        }
        Place::Programmable(None) => {
            if let Value::Frame(offsets) = value.convert(Type::Frame, at)? {
                *offset = offsets;
            }
        }
        Place::Programmable(Some(axis)) => {
            if let Value::Real(number) = value.convert(Type::Real, at)? {
                set_offset(offset, *axis, number);
            }
        }
        Place::System { name, indices } => {
            if name == "$R" {
                let [index] = indices.as_slice() else { return Err(Fault::new(12400, at, "$R has one index")) };
                let index = r_index(index, environment.r_parameters(), at)?;
                return write(&Place::RParameter(index), value, (levels, offset), environment, at);
            }
            let variable = SystemVariable { name, indices };
            environment.set_system(&variable, &value).map_err(|refusal| refused(refusal, name, at))?;
        }
    }
    Ok(())
}
