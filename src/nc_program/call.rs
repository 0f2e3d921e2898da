//! Calls of subprograms: search, PROC, parameters by value and VAR.

use std::sync::Arc;

use super::alarm::{Fault, Span};
use super::auxiliary::AuxiliaryKind;
use super::block::parse;
use super::environment::Environment;
use super::evaluate::evaluate;
use super::expression::Expression;
use super::head::word;
use super::interpreter::{Stopped, Work, first_statement};
use super::prepared::AuxiliaryFunction;
use super::scope::{Place, Running};
use super::source::{Program, Request, normalised, requested};
use super::state::{Interpreter, Level, Saved};
use super::syntax::{Call, Called, Parameter, Procedure, Statement};
use super::value::{Type, Value, integer};
use super::variables::{Content, Reference, Variable};

impl Interpreter {
    /// Begins a subprogram.
    pub(super) fn call(&mut self, call: &Call, work: &Work<'_>, environment: &dyn Environment) -> Result<(), Stopped> {
        let passes = match &call.passes {
            Some(passes) => {
                let number = self.value_as(passes, Type::Real, call.at, work, environment)?;
                integer(number.number().unwrap_or_default(), call.at)?
            }
            None => 1,
        };
        let passes = u32::try_from(passes).ok().filter(|passes| *passes > 0);
        let passes = passes.ok_or_else(|| Fault::new(14013, call.at, "at least one pass"))?;
        let text = match &call.program {
            Called::Name(name) => name.clone(),
            Called::Text(text) | Called::External(text) => {
                match self.value_as(text, Type::Text(u16::MAX), call.at, work, environment)? {
                    Value::Text(text) => text,
                    _ => return Err(Fault::new(12150, call.at, "the name of a program is a text").into()),
                }
            }
        };
        let most = work.dialect.program_levels;
        if self.levels.len() >= most {
            return Err(Fault::new(14012, call.at, format!("at most {most} levels with the main program")).into());
        }
        let program = found(&text, work.program, environment)
            .ok_or_else(|| Fault::new(14011, call.at, "no such program in the search path").about(normalised(&text)))?;
        let procedure = procedure(&program, work)?;
        let mut level = Level::new(program.path());
        level.passes = passes;
        match (&procedure, &call.arguments) {
            (None, Some(arguments)) if !arguments.is_empty() => {
                return Err(Fault::new(14510, call.at, format!("{} has no PROC", program.name())).into());
            }
            (None, _) => {}
            (Some(procedure), arguments) => {
                let arguments = arguments.as_deref().unwrap_or_default();
                level.variables = self.bound(procedure, arguments, call.at, work, environment)?;
                level.parameters = level.variables.len();
                if procedure.saves {
                    level.saved = Some(Saved { modal: self.modal, offset: self.offset.clone() });
                }
                level.is_single_block_off = procedure.is_single_block_off;
                level.is_display_off = procedure.is_display_off;
            }
        }
        let caller = self.levels.last();
        level.is_single_block_off |= caller.is_some_and(|caller| caller.is_single_block_off);
        level.is_display_off |= caller.is_some_and(|caller| caller.is_display_off);
        self.levels.push(level);
        Ok(())
    }

    /// The subprogram that replaces an M function of a block (MD10715), as a level that begins behind the block. The function is not output.
    /// Inside such a subprogram M functions are what they are.
    pub(super) fn replacement(
        &self,
        auxiliary: &mut Vec<AuxiliaryFunction>,
        at: Span,
        work: &Work<'_>,
        environment: &dyn Environment,
    ) -> Result<Option<Level>, Stopped> {
        if self.levels.iter().any(|level| level.replaces_function) {
            return Ok(None);
        }
        let mut found: Option<String> = None;
        let mut is_double = false;
        auxiliary.retain(|function| {
            let is_m = function.kind == AuxiliaryKind::M && function.extension.unwrap_or(0) == 0;
            let Some(name) = is_m.then(|| environment.replacing_program(function.value)).flatten() else { return true };
            is_double |= found.replace(name).is_some();
            false
        });
        let Some(name) = found else { return Ok(None) };
        if is_double {
            return Err(Fault::new(14016, at, "a block has one M function that a subprogram replaces").into());
        }
        let most = work.dialect.program_levels;
        if self.levels.len() >= most {
            return Err(Fault::new(14012, at, format!("at most {most} levels with the main program")).into());
        }
        let missing = || Fault::new(14011, at, "MD10716 names a program that does not exist").about(normalised(&name));
        let program = self::found(&name, work.program, environment).ok_or_else(missing)?;
        let mut level = Level::new(program.path());
        level.replaces_function = true;
        let caller = self.levels.last();
        level.is_single_block_off = caller.is_some_and(|caller| caller.is_single_block_off);
        level.is_display_off = caller.is_some_and(|caller| caller.is_display_off);
        Ok(Some(level))
    }

    /// PROC of the level that begins. Parameters of a main program, which nobody calls, have their initial values.
    pub(super) fn enter(&mut self, procedure: &Procedure) -> Result<(), Fault> {
        let Some(level) = self.levels.last_mut() else { return Ok(()) };
        if level.parameters == 0 {
            for parameter in &procedure.parameters {
                let dimensions = vec![1; parameter.dimensions];
                level.variables.push(Variable::new(&parameter.name, parameter.kind, dimensions, procedure.at)?);
            }
            level.parameters = level.variables.len();
            level.is_single_block_off |= procedure.is_single_block_off;
            level.is_display_off |= procedure.is_display_off;
        }
        Ok(())
    }

    /// The parameters of a call as variables of the new level.
    fn bound(
        &self,
        procedure: &Procedure,
        arguments: &[Option<Expression>],
        at: Span,
        work: &Work<'_>,
        environment: &dyn Environment,
    ) -> Result<Vec<Variable>, Fault> {
        if arguments.len() > procedure.parameters.len() {
            let reason = format!("{} parameters, PROC has {}", arguments.len(), procedure.parameters.len());
            return Err(Fault::new(12340, at, reason));
        }
        let mut variables: Vec<Variable> = Vec::new();
        for (index, parameter) in procedure.parameters.iter().enumerate() {
            if variables.iter().any(|other| other.name == parameter.name) {
                return Err(Fault::new(12170, at, "two parameters of PROC").about(parameter.name.clone()));
            }
            let argument = arguments.get(index).and_then(Option::as_ref);
            variables.push(self.parameter(parameter, argument, at, work, environment)?);
        }
        Ok(variables)
    }

    fn parameter(
        &self,
        parameter: &Parameter,
        argument: Option<&Expression>,
        at: Span,
        work: &Work<'_>,
        environment: &dyn Environment,
    ) -> Result<Variable, Fault> {
        let name = parameter.name.as_str();
        if parameter.is_reference {
            let missing = || Fault::new(12300, at, "a VAR parameter is missing").about(name);
            return self.reference(parameter, argument.ok_or_else(missing)?, at, work, environment);
        }
        let Some(expression) = argument.or(parameter.default.as_ref()) else {
            // 0, FALSE, or an empty text; only an axis has no such value.
            if parameter.kind == Type::Axis {
                return Err(Fault::new(14010, at, format!("{name} was omitted")));
            }
            return Variable::new(name, parameter.kind, vec![1; parameter.dimensions], at);
        };
        if parameter.dimensions > 0 {
            return self.copied_array(parameter, expression, at, work, environment);
        }
        let value = self.value(expression, work, environment)?;
        let value = fitting(value, parameter.kind, at).map_err(|fault| fault.about(name))?;
        let mut variable = Variable::new(name, parameter.kind, Vec::new(), at)?;
        variable.content = Content::Values(vec![value]);
        Ok(variable)
    }

    /// A VAR parameter: the variable of the caller must have exactly its type.
    fn reference(
        &self,
        parameter: &Parameter,
        argument: &Expression,
        at: Span,
        work: &Work<'_>,
        environment: &dyn Environment,
    ) -> Result<Variable, Fault> {
        let name = parameter.name.as_str();
        let wrong = |reason: String| Fault::new(12330, at, reason).about(name);
        let no_variable = || Fault::new(12320, at, "a VAR parameter needs a variable").about(name);
        let scope = &mut Running { levels: &self.levels, environment, axes: work.axes, offset: &self.offset };
        if let Expression::Variable { name: given, indices, at } = argument
            && parameter.dimensions > 0
            && indices.is_empty()
        {
            let (level, variable, found) = scope.find(given, *at)?;
            if found.dimensions.len() != parameter.dimensions {
                return Err(wrong(format!("{given} has {} dimensions", found.dimensions.len())));
            }
            if !is_same(found.kind, parameter.kind) {
                return Err(wrong(format!("{given} is {}", found.kind.name())));
            }
            let reference = match found.content {
                Content::Values(_) => Reference::Variable { level, variable, element: None },
                Content::Reference(reference) => reference,
            };
            return Ok(Variable::reference(name, parameter.kind, found.dimensions.clone(), reference));
        }
        let place = match argument {
            Expression::Variable { .. } | Expression::RParameter { .. } => scope.place(argument)?,
            _ => return Err(no_variable()),
        };
        let (reference, kind) = match place {
            Place::RParameter(index) => (Reference::RParameter(index), Type::Real),
            Place::Element { level, variable, element, kind } => {
                (Reference::Variable { level, variable, element: Some(element) }, kind)
            }
            Place::System { .. } | Place::Offset { .. } | Place::Programmable(_) => return Err(no_variable()),
        };
        if parameter.dimensions > 0 || !is_same(kind, parameter.kind) {
            return Err(wrong(format!("a variable of type {} is needed", parameter.kind.name())));
        }
        Ok(Variable::reference(name, parameter.kind, Vec::new(), reference))
    }

    /// An array by value: a copy.
    fn copied_array(
        &self,
        parameter: &Parameter,
        argument: &Expression,
        at: Span,
        work: &Work<'_>,
        environment: &dyn Environment,
    ) -> Result<Variable, Fault> {
        let name = parameter.name.as_str();
        let wrong = || Fault::new(12330, at, "an array of the same type is needed").about(name);
        let Expression::Variable { name: given, indices, .. } = argument else { return Err(wrong()) };
        let scope = Running { levels: &self.levels, environment, axes: work.axes, offset: &self.offset };
        let (_, _, found) = scope.find(given, at)?;
        let is_array = indices.is_empty() && found.dimensions.len() == parameter.dimensions;
        if !is_array || !is_same(found.kind, parameter.kind) {
            return Err(wrong());
        }
        let content = match &found.content {
            Content::Values(values) => Content::Values(values.clone()),
            Content::Reference(Reference::Variable { level, variable, .. }) => {
                let behind = self.levels.get(*level).and_then(|level| level.variables.get(*variable));
                behind.map(|behind| behind.content.clone()).ok_or_else(wrong)?
            }
            Content::Reference(Reference::RParameter(_)) => return Err(wrong()),
        };
        Ok(Variable { name: name.to_owned(), kind: parameter.kind, dimensions: found.dimensions.clone(), content })
    }
}

/// A value for a parameter: a type that does not convert is an error of the call.
pub(super) fn fitting(value: Value, kind: Type, at: Span) -> Result<Value, Fault> {
    let of_type = value.of_type();
    value.convert(kind, at).map_err(|fault| match fault.number {
        12150 => Fault::new(12330, at, format!("{} does not convert to {}", of_type.name(), kind.name())),
        _ => fault,
    })
}

/// Whether two types are the same; strings may have different lengths.
pub(super) fn is_same(one: Type, other: Type) -> bool {
    matches!((one, other), (Type::Text(_), Type::Text(_))) || one == other
}

fn found(text: &str, caller: &Program, environment: &dyn Environment) -> Option<Arc<Program>> {
    let (name, folder) = requested(text);
    environment.find_program(&Request { name: &name, folder, caller: caller.folder() })
}

/// PROC of a program, if it has one. An error in it is an alarm of that program.
fn procedure(program: &Arc<Program>, work: &Work<'_>) -> Result<Option<Procedure>, Stopped> {
    let Some(line) = first_statement(program, work.dialect) else { return Ok(None) };
    let Some((head, text)) = program.head(line) else { return Ok(None) };
    if !word(text, head.rest).eq_ignore_ascii_case("PROC") {
        return Ok(None);
    }
    match parse(text, work.dialect, work.axes) {
        Ok(block) => match block.statement {
            Statement::Procedure(procedure) => Ok(Some(procedure)),
            _ => Ok(None),
        },
        Err(fault) => Err(Stopped::Alarm(Box::new(fault.alarm(&program.path(), &head.name(line), line, text)))),
    }
}

/// Evaluates nothing that a call needs, but keeps the errors of its parameters for the static check.
pub(super) fn judged(
    expression: &Expression,
    kind: Type,
    at: Span,
    scope: &mut dyn super::evaluate::Scope,
) -> Result<(), Fault> {
    let term = evaluate(expression, scope)?;
    if term.certainty == super::evaluate::Certainty::Nothing {
        return Ok(());
    }
    match fitting(term.value, kind, at) {
        Err(fault) if term.certainty == super::evaluate::Certainty::Value || fault.number == 12330 => Err(fault),
        Ok(_) | Err(_) => Ok(()),
    }
}
