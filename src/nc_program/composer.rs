//! The words of a block become what it does: the state of this work, and values of its expressions. Reads a [`Scope`], writes nothing.

use super::alarm::{Fault, Span};
use super::dialect::Dialect;
use super::evaluate::{Certainty, Scope, Term, evaluate};
use super::expression::Expression;
use super::functions::{GFunction, Modal, g};
use super::names::AxisIndex;
use super::prepared::{Action, AuxiliaryFunction, AxisWord, Circle, Dimension, End};
use super::value::{Type, Value};

/// What holds before the block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Before<'a> {
    pub(super) dialect: &'static Dialect,
    pub(super) modal: Modal,
    pub(super) feed: Option<f64>,
    pub(super) offset: &'a [(AxisIndex, f64)],
    /// MSG, SETM, CLEARM or WAITMC, and no executable block since.
    pub(super) is_unseparated: bool,
    /// The block is of the main program.
    pub(super) is_main: bool,
    /// Whether a feed that nobody programmed is an error. A check of a subprogram does not know what its caller programmed.
    pub(super) needs_feed: bool,
}

/// What the block does.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Composed {
    pub(super) modal: Modal,
    pub(super) once: Vec<GFunction>,
    pub(super) feed: Option<f64>,
    pub(super) offset: Vec<(AxisIndex, f64)>,
    pub(super) axes: Vec<AxisWord>,
    pub(super) circle: Circle,
    pub(super) auxiliary: Vec<AuxiliaryFunction>,
    pub(super) actions: Vec<Action>,
    pub(super) end: Option<End>,
    pub(super) stops_preparation: bool,
    /// MSG, SETM, CLEARM or WAITMC.
    pub(super) needs_separation: bool,
    /// SBLOF, SBLON.
    pub(super) single_block_off: Option<bool>,
}

pub(super) struct Composer<'a> {
    pub(super) scope: &'a mut dyn Scope,
    pub(super) before: Before<'a>,
    pub(super) done: Composed,
    /// Axes with a position, with their words.
    pub(super) positioned: Vec<AxisIndex>,
    /// Addresses that were programmed, with their extension.
    pub(super) programmed: Vec<(&'static str, Option<u16>)>,
    /// Groups of G functions in the block, and where.
    pub(super) groups: Vec<(GFunction, Span)>,
    /// Where circle parameters are.
    pub(super) circle_at: Option<Span>,
    /// S in the block, for G4, G25 and G26.
    pub(super) speeds: Vec<(Option<u16>, f64)>,
    /// F in the block.
    pub(super) new_feed: Option<f64>,
    /// FDA with its axis, FD without one, and where.
    pub(super) handwheels: Vec<(Option<AxisIndex>, Span)>,
}

impl<'a> Composer<'a> {
    pub(super) fn new(scope: &'a mut dyn Scope, before: Before<'a>) -> Self {
        let done = Composed {
            modal: before.modal,
            once: Vec::new(),
            feed: before.feed,
            offset: before.offset.to_vec(),
            axes: Vec::new(),
            circle: Circle::default(),
            auxiliary: Vec::new(),
            actions: Vec::new(),
            end: None,
            stops_preparation: false,
            needs_separation: false,
            single_block_off: None,
        };
        Self {
            scope,
            before,
            done,
            positioned: Vec::new(),
            programmed: Vec::new(),
            groups: Vec::new(),
            circle_at: None,
            speeds: Vec::new(),
            new_feed: None,
            handwheels: Vec::new(),
        }
    }

    pub(super) fn has_function(&self, function: GFunction) -> bool {
        self.groups.iter().any(|(found, _)| *found == function)
    }

    pub(super) fn has_group(&self, group: u8) -> bool {
        self.groups.iter().any(|(found, _)| found.group == group)
    }

    pub(super) fn default_dimension(&self) -> Dimension {
        if self.done.modal.is(g::G91) { Dimension::Incremental } else { Dimension::Absolute }
    }

    pub(super) fn term(&mut self, expression: &Expression) -> Result<Term, Fault> {
        evaluate(expression, self.scope)
    }

    /// A number. In a check, an unknown one is not a number: no comparison with it is an error.
    pub(super) fn number(&mut self, expression: &Expression, at: Span) -> Result<f64, Fault> {
        let term = self.term(expression)?.convert(Type::Real, at)?;
        match term.value {
            Value::Real(number) if term.is_known() => Ok(number),
            _ => Ok(f64::NAN),
        }
    }

    /// A whole number; None in a check, if it is unknown.
    pub(super) fn whole(&mut self, expression: &Expression, at: Span) -> Result<Option<i32>, Fault> {
        let term = self.term(expression)?.convert(Type::Int, at)?;
        match term.value {
            Value::Int(number) if term.is_known() => Ok(Some(number)),
            _ => Ok(None),
        }
    }

    /// A number in a range, for marks, channels and extensions. An unknown one in a check is the least.
    pub(super) fn limited(
        &mut self,
        expression: &Expression,
        (least, most): (u16, u16),
        number: u32,
        at: Span,
    ) -> Result<u16, Fault> {
        let Some(whole) = self.whole(expression, at)? else { return Ok(least) };
        let found = u16::try_from(whole).ok().filter(|found| (least..=most).contains(found));
        found.ok_or_else(|| Fault::new(number, at, format!("{whole} is outside {least} to {most}")))
    }

    /// A text; None in a check, if it is unknown.
    pub(super) fn text(&mut self, expression: &Expression, at: Span) -> Result<Option<String>, Fault> {
        let term = self.term(expression)?.convert(Type::Text(u16::MAX), at)?;
        match term.value {
            Value::Text(text) if term.is_known() => Ok(Some(text)),
            _ => Ok(None),
        }
    }

    /// An axis; [`UNKNOWN`] in a check, if it is not known.
    pub(super) fn axis(&mut self, expression: &Expression, at: Span) -> Result<AxisIndex, Fault> {
        let term = self.term(expression)?;
        match (term.value, term.certainty) {
            (Value::Axis(axis), Certainty::Value) if self.scope.axes().row(axis).is_none() => {
                Err(Fault::new(14092, at, "the variable has no axis"))
            }
            (Value::Axis(axis), Certainty::Value) => Ok(axis),
            (Value::Axis(_), Certainty::Type) | (_, Certainty::Nothing) => Ok(UNKNOWN),
            (other, Certainty::Value | Certainty::Type) => {
                let reason = format!("an axis is needed, this is {}", other.of_type().name());
                Err(Fault::new(12040, at, reason))
            }
        }
    }

    /// Notes a position of an axis: each axis has at most one.
    pub(super) fn position(&mut self, axis: AxisIndex, at: Span) -> Result<(), Fault> {
        if axis != UNKNOWN && self.positioned.contains(&axis) {
            return Err(Fault::new(16420, at, "").about(self.scope.axes().name(axis)));
        }
        self.positioned.push(axis);
        Ok(())
    }
}

/// An axis that a check does not know.
pub(super) const UNKNOWN: AxisIndex = AxisIndex(u16::MAX - 1);
