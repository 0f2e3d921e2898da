//! What the static check knows of a program: its variables with their types, and no values.

use super::alarm::{Fault, Span};
use super::evaluate::{Certainty, Scope, Term};
use super::frames::component;
use super::names::AxisNames;
use super::value::Type;
use super::variables::{Variable, element, index};

/// The types of variables.
pub(super) struct Known<'a> {
    pub(super) axes: &'a AxisNames,
    pub(super) variables: Vec<Variable>,
    /// A definition has an error: names that are not known may be its own.
    pub(super) is_incomplete: bool,
}

impl Scope for Known<'_> {
    fn axes(&self) -> &AxisNames {
        self.axes
    }

    fn r_parameter(&mut self, found: &Term, at: Span) -> Result<Term, Fault> {
        if found.certainty != Certainty::Nothing && index(&found.value, at)? < 0 && found.is_known() {
            return Err(Fault::new(17020, at, "an index is not negative"));
        }
        Ok(Term::of_type(Type::Real))
    }

    fn variable(&mut self, name: &str, indices: &[Term], at: Span) -> Result<Term, Fault> {
        let Some(variable) = self.variables.iter().find(|variable| variable.name == name) else {
            if self.is_incomplete {
                return Ok(Term::unknown());
            }
            return Err(Fault::new(12550, at, "neither a variable nor an axis has this name").about(name));
        };
        let values: Vec<_> = indices.iter().map(|term| term.value.clone()).collect();
        let axis = component(variable, &values, at)?;
        let indices = if axis.is_some() { &indices[..variable.dimensions.len()] } else { indices };
        let kind = if axis.is_some() { Type::Real } else { variable.kind };
        let mut found = Vec::new();
        for term in indices {
            found.push(if term.certainty == Certainty::Nothing { 0 } else { index(&term.value, at)? });
        }
        let is_known = indices.iter().all(Term::is_known);
        match element(&variable.dimensions, &found, at) {
            Err(fault) if fault.number == 12400 || is_known => Err(fault),
            Ok(_) | Err(_) => Ok(Term::of_type(kind)),
        }
    }

    fn system(&mut self, _: &str, _: &[Term], _: Span) -> Result<Term, Fault> {
        Ok(Term::unknown())
    }
}

/// What the last statement of the text does at its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Last {
    Nothing,
    /// It ends the program, or the program never goes on behind it.
    Ends,
    /// The program goes on behind it.
    GoesOn,
    /// It has an error.
    Unknown,
}
