//! From words and commands to a block with values.

use super::block::{AxisRequest, Block, Command, Conflicts, Dwell, End, GantryTargets, PutTargets};
use super::commands::no_denominator;
use super::evaluate::{evaluate, resolved, whole};
use super::fault::{
    AXIS_MISSING, CENTRE_TWICE, DWELL_AXES, DWELL_TWICE, Error, FACTOR, FaultCode, MOTION_TWICE, TRANSITION_TWICE,
    ZERO_OFFSET_TWICE,
};
use super::head::Target;
use super::link::{AxisReference, Form as ValueForm, Link, LinkOff, Pair as ValuePair, conflict, factor_error};
use super::scope::Scope;
use super::syntax::{Address, Axis, Form, GantryTarget, HashCommand, Pair, Put, Switch, Value, Word, WordKind};

/// A block, and what the interpreter does with it.
#[derive(Debug, Default)]
pub(super) struct Composed {
    pub(super) block: Block,
    /// Messages that do not stop the program.
    pub(super) warnings: Vec<Error>,
    /// Axes with two signs, and the message for one that is no modulo axis.
    pub(super) two_signs: Vec<(String, Error)>,
    /// Where M17 or M29 is written.
    pub(super) subroutine_end: Option<usize>,
    /// The subroutine that is called behind the block, whether it is a local one, and where it is written.
    pub(super) call: Option<(String, bool, usize)>,
    /// The jump behind the block.
    pub(super) jump: Option<(Target, usize)>,
}

impl Composed {
    /// Whether there is something to execute, besides assignments, calls and jumps.
    pub(super) fn is_executable(&self) -> bool {
        let block = &self.block;
        let has_value = [
            block.feed,
            block.radius,
            block.tool,
            block.tool_data,
            block.spindle,
            block.centre[0],
            block.centre[1],
            block.centre[2],
        ]
        .iter()
        .any(Option::is_some);
        let has_list = !(block.g.is_empty() && block.m.is_empty() && block.h.is_empty() && block.axes.is_empty());
        has_value || has_list || block.dwell.is_some() || block.command.is_some()
    }
}

/// G functions of which a block has one: the number of the message where a source gives one, and what they decide.
const GROUPS: [(&[u32], Option<u32>, &str); 7] = [
    (&[0, 1, 2, 3], Some(MOTION_TWICE), "the kind of movement"),
    (&[17, 18, 19], None, "the plane"),
    (&[40, 41, 42], None, "tool radius compensation"),
    (&[53, 54, 55, 56, 57, 58, 59], Some(ZERO_OFFSET_TWICE), "zero offsets"),
    (&[60, 61, 260, 261, 359, 360], Some(TRANSITION_TWICE), "the block transition"),
    (&[90, 91], None, "absolute or incremental positions"),
    (&[161, 162], Some(CENTRE_TWICE), "the centre of circles"),
];

/// A G function beside the others of its block: two of one group exclude each other, as does the same one twice.
fn exclusive(others: &[u32], number: u32, at: usize) -> Result<(), Error> {
    let Some((group, code, what)) = GROUPS.iter().find(|(group, ..)| group.contains(&number)) else { return Ok(()) };
    let Some(other) = others.iter().find(|other| group.contains(other)) else { return Ok(()) };
    let text = format!("G{other:02} and G{number:02} stand in one block; a block has one G function for {what}");
    Err(Error::new(code.map_or(FaultCode::Syntax, FaultCode::Number), at, text))
}

/// The block of these words. Assignments are noted in the scope.
pub(super) fn compose(words: &[Word], scope: &mut Scope<'_>, lenient: bool) -> Result<Composed, Error> {
    let mut composed = Composed::default();
    let mut time = None;
    for Word { kind, at } in words {
        let block = &mut composed.block;
        match kind {
            WordKind::G(number @ (201 | 202)) => {
                let text =
                    format!("G{number} needs its axes, as in `G{number} #AXIS [X]`, and stands alone in its block");
                return Err(Error::syntax(*at, text));
            }
            WordKind::G(number) => {
                exclusive(&block.g, *number, *at)?;
                block.g.push(*number);
            }
            WordKind::M(number) => {
                block.m.push(*number);
                let end = match number {
                    2 | 30 => Some(End::Program),
                    17 | 29 => Some(End::Subroutine),
                    _ => None,
                };
                if end == Some(End::Subroutine) {
                    composed.subroutine_end = composed.subroutine_end.or(Some(*at));
                }
                block.end = block.end.or(end);
            }
            WordKind::Value(Address::H, value) => block.h.push(number(evaluate(value, scope)?, "H", *at)?),
            WordKind::Value(address, value) => {
                let (name, place) = match address {
                    Address::F => ("F", &mut block.feed),
                    Address::I => ("I", &mut block.centre[0]),
                    Address::J => ("J", &mut block.centre[1]),
                    Address::K => ("K", &mut block.centre[2]),
                    Address::R => ("R", &mut block.radius),
                    Address::T => ("T", &mut block.tool),
                    Address::D => ("D", &mut block.tool_data),
                    Address::S | Address::H => ("S", &mut block.spindle),
                };
                if place.replace(evaluate(value, scope)?).is_some() {
                    return Err(twice(name, *at));
                }
            }
            WordKind::Axis(name, sign, is_doubled, value) => {
                if block.axes.iter().any(|(other, _)| other == name) {
                    return Err(twice(name, *at));
                }
                block.axes.push((name.clone(), evaluate(value, scope)?));
                block.signs.extend(sign.map(|sign| (name.clone(), sign)));
                if *is_doubled {
                    let text = format!(
                        "two signs stand behind {name}; this is possible only for a modulo axis, where the first one is the direction"
                    );
                    composed.two_signs.push((name.clone(), Error::syntax(*at, text)));
                }
            }
            WordKind::Time(value) => time = Some((evaluate(value, scope)?, *at)),
            WordKind::Assign(place, value) => {
                let value = evaluate(value, scope)?;
                let name = resolved(place, scope)?;
                scope.written.push((name, value, *at));
            }
            WordKind::Call { name, is_local } => composed.call = Some((name.clone(), *is_local, *at)),
            WordKind::Goto(target) => composed.jump = Some((target.clone(), *at)),
        }
    }
    if composed.block.g.contains(&4) {
        dwell(words, time, &mut composed)?;
    }
    if let Some(at) = words.iter().find(|word| word.kind == WordKind::G(74)).map(|word| word.at) {
        if composed.block.axes.is_empty() {
            let text = "G74 needs the axes to home and their order, as in `G74 X1`";
            if !lenient {
                return Err(Error::syntax(at, text));
            }
            composed.warnings.push(Error::new(FaultCode::Number(AXIS_MISSING), at, text));
        }
        for (name, order) in std::mem::take(&mut composed.block.axes) {
            let at = place_of(words, &name);
            composed.block.homing.push((name, number(order, "the place of an axis in the order of homing", at)?));
        }
    }
    Ok(composed)
}

fn twice(name: &str, at: usize) -> Error {
    Error::syntax(at, format!("{name} stands twice in the block; write it once"))
}

fn place_of(words: &[Word], axis: &str) -> usize {
    words.iter().find(|word| matches!(&word.kind, WordKind::Axis(name, ..) if name == axis)).map_or(0, |word| word.at)
}

/// G04 stands alone in its block. Its time is written directly or with the first main axis; further axes are ignored with a warning.
fn dwell(words: &[Word], time: Option<(f64, usize)>, composed: &mut Composed) -> Result<(), Error> {
    let is_part = |word: &&Word| !matches!(word.kind, WordKind::G(4) | WordKind::Time(_) | WordKind::Axis(..));
    if let Some(word) = words.iter().find(is_part) {
        return Err(Error::syntax(
            word.at,
            "G04 and its time stand alone in the block; write other words in another block",
        ));
    }
    let mut axes = std::mem::take(&mut composed.block.axes).into_iter();
    let first = axes.next();
    if let Some((name, _)) = axes.next() {
        let text =
            format!("a dwell time with G04 needs one axis, the first main axis; {name} and what follows is ignored");
        composed.warnings.push(Error::new(FaultCode::Number(DWELL_AXES), place_of(words, &name), text));
    }
    let at = words.first().map_or(0, |word| word.at);
    composed.block.dwell = Some(match (time, first) {
        (Some((seconds, at)), None) => Dwell { seconds: time_of(seconds, at)?, axis: None },
        (None, Some((name, seconds))) => Dwell { seconds: time_of(seconds, place_of(words, &name))?, axis: Some(name) },
        (Some((_, at)), Some(_)) => {
            let text = "the dwell time is written both directly and with an axis; write one of them";
            return Err(Error::new(FaultCode::Number(DWELL_TWICE), at, text));
        }
        (None, None) => return Err(Error::syntax(at, "G04 needs a time in seconds, as in `G04 2.5`")),
    });
    Ok(())
}

fn time_of(seconds: f64, at: usize) -> Result<f64, Error> {
    if seconds < 0.0 {
        Err(Error::value(at, format!("a dwell time is not negative, found {seconds}")))
    } else {
        Ok(seconds)
    }
}

/// A whole number from 0 on. What is not known becomes 0.
fn number(value: f64, what: &str, at: usize) -> Result<u32, Error> {
    let number = whole(value, what, at)?.unwrap_or(0);
    u32::try_from(number)
        .map_err(|_| Error::value(at, format!("{what} is not negative and not too large, found {number}")))
}

/// The block of a command.
pub(super) fn compose_command(command: &HashCommand, scope: &Scope<'_>) -> Result<Composed, Error> {
    let mut composed = Composed::default();
    composed.block.command = Some(match command {
        HashCommand::Link { group, pairs } => Command::Link(link(group, pairs, scope, &mut composed.warnings)?),
        HashCommand::LinkOn(group) => Command::LinkOn(group.as_ref().map(|group| group_of(group, scope)).transpose()?),
        HashCommand::LinkOff(Switch::Known(off)) => Command::LinkOff(*off),
        HashCommand::LinkOff(Switch::Group(group)) => Command::LinkOff(LinkOff::Group(group_of(group, scope)?)),
        HashCommand::Gantry { is_on, targets } => {
            let targets = match targets {
                None => GantryTargets::All,
                Some(targets) => GantryTargets::Masters(
                    targets
                        .iter()
                        .map(|target| match target {
                            GantryTarget::Name(name) => Ok(AxisReference::Name(name.clone())),
                            GantryTarget::Number(value) => logical_number(value, scope).map(AxisReference::Number),
                        })
                        .collect::<Result<_, Error>>()?,
                ),
            };
            Command::Gantry { is_on: *is_on, targets }
        }
        HashCommand::Call { is_fast, conflicts: [name, number, index], requests } => Command::CallAxis {
            is_fast: *is_fast,
            conflicts: Conflicts { name: *name, number: *number, index: *index },
            requests: requests
                .iter()
                .map(|request| {
                    Ok(AxisRequest {
                        name: request.name.clone(),
                        number: logical_number(&request.number, scope)?,
                        index: value_of(&request.index, "the index of an axis in the channel", scope)?,
                        options: request.options.clone(),
                    })
                })
                .collect::<Result<_, Error>>()?,
        },
        HashCommand::Put(Put::All) => Command::PutAxis(PutTargets::All),
        HashCommand::Put(Put::Names(names)) => Command::PutAxis(PutTargets::Names(names.clone())),
        HashCommand::Put(Put::Numbers(numbers)) => {
            let numbers: Result<_, Error> = numbers.iter().map(|value| logical_number(value, scope)).collect();
            Command::PutAxis(PutTargets::Numbers(numbers?))
        }
        HashCommand::Manual { is_on, axes } => Command::Manual { is_on: *is_on, axes: axes.clone() },
        HashCommand::Time(value) => {
            let seconds = time_of(evaluate(&value.expression, scope)?, value.at)?;
            composed.block.dwell = Some(Dwell { seconds, axis: None });
            return Ok(composed);
        }
    });
    Ok(composed)
}

fn value_of(value: &Value, what: &str, scope: &Scope<'_>) -> Result<u32, Error> {
    number(evaluate(&value.expression, scope)?, what, value.at)
}

/// Logical numbers begin with 1; one that is not known is 0.
fn logical_number(value: &Value, scope: &Scope<'_>) -> Result<u32, Error> {
    let found = evaluate(&value.expression, scope)?;
    let number = number(found, "the logical number of an axis", value.at)?;
    if number == 0 && !found.is_nan() {
        return Err(Error::value(value.at, "the logical number of an axis is 1 or more, found 0"));
    }
    Ok(number)
}

fn group_of(value: &Value, scope: &Scope<'_>) -> Result<i64, Error> {
    // A number that is not known: any that is possible.
    Ok(whole(evaluate(&value.expression, scope)?, "the number of a coupling group", value.at)?.unwrap_or(1))
}

fn link(group: &Value, pairs: &[Pair], scope: &Scope<'_>, warnings: &mut Vec<Error>) -> Result<Link, Error> {
    let mut link = Link { group: group_of(group, scope)?, pairs: Vec::with_capacity(pairs.len()) };
    for pair in pairs {
        let axis = |axis: &Axis| match axis {
            Axis::Name(name) => Ok(AxisReference::Name(name.clone())),
            Axis::Number(value) => logical_number(value, scope).map(AxisReference::Number),
        };
        let form = form(&pair.form, scope)?;
        let (slave, master) = (axis(&pair.slave)?, axis(&pair.master)?);
        if form.is_scaled() {
            let text = "the coupling factor is neither -1 nor 1; it is set to 1, a standard coupling";
            let warning = Error::new(FaultCode::Number(FACTOR), pair.at, text);
            warnings.push(warning.of_pair(slave.bare(), link.group));
        }
        link.pairs.push(ValuePair { slave, master, form });
    }
    match conflict(&link.pairs) {
        Some((index, code, axis, text)) => {
            let at = pairs.get(index).map_or(group.at, |pair| pair.at);
            Err(Error::new(code, at, text).of_pair(axis.bare(), link.group))
        }
        None => Ok(link),
    }
}

fn form(form: &Form, scope: &Scope<'_>) -> Result<ValueForm, Error> {
    match form {
        Form::Bare => Ok(ValueForm::Bare),
        Form::Standard => Ok(ValueForm::Standard),
        Form::Gantry(None) => Ok(ValueForm::Gantry { limits: None }),
        Form::Gantry(Some([first, second])) => {
            let limits = [evaluate(&first.expression, scope)?, evaluate(&second.expression, scope)?];
            for (limit, value) in limits.iter().zip([first, second]) {
                if *limit <= 0.0 {
                    return Err(Error::value(
                        value.at,
                        format!("a limit of the gantry difference is greater than 0, found {limit}"),
                    ));
                }
            }
            if limits[0] >= limits[1] {
                let text = format!("the second limit is greater than the first, found {} and {}", limits[0], limits[1]);
                return Err(Error::value(second.at, text));
            }
            Ok(ValueForm::Gantry { limits: Some(limits) })
        }
        Form::Factor(numerator, None) => Err(no_denominator(numerator.at)),
        Form::Factor(numerator, Some(denominator)) => {
            let part = |value: &Value, what| whole(evaluate(&value.expression, scope)?, what, value.at);
            let values = (part(numerator, "a numerator")?, part(denominator, "a denominator")?);
            // What is not known is no error.
            if let Some((code, text)) = factor_error(values.0.unwrap_or(1), values.1.unwrap_or(1)) {
                let at = if values.0 == Some(0) { numerator.at } else { denominator.at };
                return Err(Error::new(code, at, text));
            }
            let (Some(numerator), Some(denominator)) = values else { return Ok(ValueForm::Standard) };
            Ok(ValueForm::Factor { numerator, denominator })
        }
    }
}
