//! Commands of a block, and synchronised actions.

use super::addresses::dimension;
use super::alarm::{Fault, Span};
use super::auxiliary::{AuxiliaryKind, judged_value};
use super::composer::{Composer, UNKNOWN};
use super::condition::{Condition, MainRunValue};
use super::evaluate::{evaluate, frozen, system_indices};
use super::expression::Expression;
use super::names::AxisIndex;
use super::operator::Operator;
use super::prepared::{Action, CouplingKind, MainRunAction, SynchronisedAction};
use super::syntax::{Address, AddressWord, Synchronised, SynchronisedWord};
use super::value::Value;
use super::vocabulary::Command;

type Arguments<'a> = &'a [Option<Expression>];

/// The numbers of channels, marks and spindles.
const CHANNELS: (u16, u16) = (1, 10);
const MARKS: (u16, u16) = (0, 99);
const SPINDLES: (u16, u16) = (1, 31);

impl Composer<'_> {
    pub(super) fn command(&mut self, command: Command, arguments: Arguments<'_>, at: Span) -> Result<(), Fault> {
        let action = match command {
            Command::StopPreparation => return none(arguments, at),
            Command::SingleBlockOff | Command::SingleBlockOn => {
                self.done.single_block_off = Some(command == Command::SingleBlockOff);
                return none(arguments, at);
            }
            Command::Message => {
                self.separated(at)?;
                match arguments {
                    [] => Action::Message(None),
                    // A number becomes a text, as with `<<`.
                    [Some(text)] => {
                        let (left, right) = (Expression::Constant(Value::Text(String::new())), text.clone());
                        let (left, right) = (Box::new(left), Box::new(right));
                        let text = Expression::Binary { operator: Operator::Join, left, right, at };
                        Action::Message(Some(self.text(&text, at)?.unwrap_or_default()))
                    }
                    _ => return Err(count(at, "MSG has one text")),
                }
            }
            Command::CycleAlarm => self.cycle_alarm(arguments, at)?,
            Command::WaitForPosition => Action::WaitForPosition(self.axes(arguments, at)?),
            Command::WaitForSpindle => Action::WaitForSpindle(self.numbers(arguments, SPINDLES, 16100, at)?),
            Command::Release => Action::Release(self.axes(arguments, at)?),
            Command::Get | Command::GetDirectly => {
                self.done.stops_preparation = true;
                Action::Get { axes: self.axes(arguments, at)?, is_direct: command == Command::GetDirectly }
            }
            Command::Preset => self.preset(arguments, at)?,
            Command::TrailOn => self.coupling(CouplingKind::Trail, true, arguments, at)?,
            Command::TrailOff => self.coupling(CouplingKind::Trail, false, arguments, at)?,
            Command::LeadOn => self.coupling(CouplingKind::Lead, true, arguments, at)?,
            Command::LeadOff => self.coupling(CouplingKind::Lead, false, arguments, at)?,
            Command::CouplingOn => self.coupling(CouplingKind::Synchronous, true, arguments, at)?,
            Command::CouplingOff => self.coupling(CouplingKind::Synchronous, false, arguments, at)?,
            Command::ElectronicGearOn => self.coupling(CouplingKind::ElectronicGear, true, arguments, at)?,
            Command::ElectronicGearOff => self.coupling(CouplingKind::ElectronicGear, false, arguments, at)?,
            Command::FeedGroup if arguments.is_empty() => Action::FeedGroup(Vec::new()),
            Command::FeedGroup => Action::FeedGroup(self.axes(arguments, at)?),
            Command::SetMark => {
                self.separated(at)?;
                Action::SetMarks(self.some_numbers(arguments, MARKS, at)?)
            }
            Command::ClearMark => {
                self.separated(at)?;
                Action::ClearMarks(self.numbers(arguments, MARKS, 14020, at)?)
            }
            Command::WaitMark | Command::WaitMarkConditionally => {
                let is_conditional = command == Command::WaitMarkConditionally;
                if is_conditional {
                    self.separated(at)?;
                }
                let [Some(mark), channels @ ..] = arguments else { return Err(count(at, "a mark is missing")) };
                let mark = self.limited(mark, MARKS, 14020, at)?;
                let channels = self.some_numbers(channels, CHANNELS, at)?;
                Action::WaitMark { mark, channels, is_conditional }
            }
            Command::Initialise => self.initialise(arguments, at)?,
            Command::Start => Action::Start(self.some_numbers(arguments, CHANNELS, at)?),
            Command::WaitEnd => Action::WaitEnd(self.some_numbers(arguments, CHANNELS, at)?),
            Command::NewConfiguration => {
                self.done.stops_preparation = true;
                none(arguments, at)?;
                Action::NewConfiguration
            }
            Command::EndOverlays => {
                self.done.stops_preparation = true;
                none(arguments, at)?;
                Action::EndOverlays
            }
            Command::Cancel => {
                let mut ids = Vec::new();
                for argument in given(arguments, at)? {
                    let id = self.whole(argument, at)?;
                    ids.push(self.id(id, at)?);
                }
                Action::Cancel(ids)
            }
            Command::ReadInDisable => return Err(Fault::new(12080, at, "it belongs to synchronised actions")),
        };
        self.done.actions.push(action);
        Ok(())
    }

    /// MSG, SETM, CLEARM and WAITMC need an executable block between them.
    fn separated(&mut self, at: Span) -> Result<(), Fault> {
        if self.before.is_unseparated {
            return Err(Fault::new(16930, at, "the last block with MSG, SETM, CLEARM or WAITMC comes just before"));
        }
        self.done.needs_separation = true;
        Ok(())
    }

    fn cycle_alarm(&mut self, arguments: Arguments<'_>, at: Span) -> Result<Action, Fault> {
        let (number, text) = match arguments {
            [Some(number)] => (number, None),
            [Some(number), Some(text)] => (number, self.text(text, at)?),
            _ => return Err(count(at, "SETAL has a number and a text")),
        };
        let (least, most) = self.before.dialect.cycle_alarms;
        let number = self.whole(number, at)?.unwrap_or(least);
        match u32::try_from(number) {
            Ok(found) if (least..=most).contains(&number) => {
                // An alarm that stops the program: nothing behind it is prepared.
                self.done.stops_preparation |= number < self.before.dialect.shown_alarms;
                Ok(Action::CycleAlarm { number: found, text })
            }
            _ => {
                let reason = format!("the numbers are {least} to {most}");
                Err(Fault::new(15700, at, reason).about(number.to_string()))
            }
        }
    }

    fn preset(&mut self, arguments: Arguments<'_>, at: Span) -> Result<Action, Fault> {
        if arguments.is_empty() || !arguments.len().is_multiple_of(2) {
            return Err(count(at, "PRESETON has pairs of an axis and a value"));
        }
        self.done.stops_preparation = true;
        let given = given(arguments, at)?;
        let mut values = Vec::new();
        for pair in given.chunks(2) {
            let [axis, value] = pair else { continue };
            let axis = self.axis(axis, at)?;
            self.position(axis, at)?;
            values.push((axis, self.number(value, at)?));
        }
        Ok(Action::Preset(values))
    }

    fn initialise(&mut self, arguments: Arguments<'_>, at: Span) -> Result<Action, Fault> {
        let (channel, program, mode) = match arguments {
            [Some(channel), Some(program)] => (channel, program, None),
            [Some(channel), Some(program), Some(mode)] => (channel, program, self.text(mode, at)?),
            _ => return Err(count(at, "INIT has a channel, a program, and \"S\" or \"N\"")),
        };
        let waits = match mode.as_deref() {
            None | Some("S" | "s") => true,
            Some("N" | "n") => false,
            Some(_) => return Err(Fault::new(14020, at, "the third parameter is \"S\" or \"N\"")),
        };
        let channel = self.limited(channel, CHANNELS, 14020, at)?;
        let program = self.text(program, at)?.unwrap_or_default();
        Ok(Action::Initialise { channel, program, waits })
    }

    /// Following axis, leading axis, and the rest. EGON has its kind of block change between them.
    fn coupling(
        &mut self,
        kind: CouplingKind,
        is_on: bool,
        arguments: Arguments<'_>,
        at: Span,
    ) -> Result<Action, Fault> {
        let [Some(following), rest @ ..] = arguments else { return Err(count(at, "the following axis is missing")) };
        let following = self.axis(following, at)?;
        let place = usize::from(kind == CouplingKind::ElectronicGear && is_on);
        let leading = match rest.get(place) {
            Some(Some(leading)) => Some(self.axis(leading, at)?),
            Some(None) | None if is_on => return Err(count(at, "the leading axis is missing")),
            Some(None) | None => None,
        };
        if leading == Some(following) && following != UNKNOWN {
            return Err(Fault::new(16785, at, "").about(self.scope.axes().name(following)));
        }
        let mut parameters = Vec::new();
        for (index, argument) in rest.iter().enumerate().filter(|(index, _)| *index != place) {
            let value = match argument {
                Some(argument) => Some(evaluate(argument, self.scope)?.value),
                None => None,
            };
            if index < MOST_PARAMETERS {
                parameters.push(value);
            }
        }
        Ok(Action::Coupling { kind, is_on, following, leading, parameters })
    }

    fn axes(&mut self, arguments: Arguments<'_>, at: Span) -> Result<Vec<AxisIndex>, Fault> {
        let mut axes = Vec::new();
        for argument in given(arguments, at)? {
            axes.push(self.axis(argument, at)?);
        }
        if axes.is_empty() { Err(count(at, "an axis is missing")) } else { Ok(axes) }
    }

    fn numbers(
        &mut self,
        arguments: Arguments<'_>,
        range: (u16, u16),
        number: u32,
        at: Span,
    ) -> Result<Vec<u16>, Fault> {
        let mut numbers = Vec::new();
        for argument in given(arguments, at)? {
            numbers.push(self.limited(argument, range, number, at)?);
        }
        Ok(numbers)
    }

    fn some_numbers(&mut self, arguments: Arguments<'_>, range: (u16, u16), at: Span) -> Result<Vec<u16>, Fault> {
        let numbers = self.numbers(arguments, range, 14020, at)?;
        if numbers.is_empty() { Err(count(at, "a number is missing")) } else { Ok(numbers) }
    }

    fn id(&self, id: Option<i32>, at: Span) -> Result<i32, Fault> {
        let (least, most) = self.before.dialect.synchronised_ids;
        let id = id.unwrap_or(least);
        if (least..=most).contains(&id) {
            return Ok(id);
        }
        Err(Fault::new(14025, at, format!("{id} is outside {least} to {most}")))
    }

    pub(super) fn synchronised(&mut self, source: &Synchronised) -> Result<(), Fault> {
        let (id, is_static) = match &source.id {
            Some((id, is_static)) => {
                let number = self.whole(id, source.at)?;
                (Some(self.id(number, source.at)?), *is_static)
            }
            None => (None, false),
        };
        let condition = match &source.condition {
            Some(condition) => {
                // A check finds errors of types that the main run would find.
                evaluate_quietly(self, condition)?;
                Some(Condition(frozen(condition, self.scope)?))
            }
            None => None,
        };
        let mut actions = Vec::new();
        for word in &source.actions {
            actions.push(self.action(word)?);
        }
        let frequency = source.frequency;
        let action = SynchronisedAction { id, is_static, frequency, condition, actions };
        self.done.actions.push(Action::Synchronised(Box::new(action)));
        Ok(())
    }

    fn action(&mut self, word: &SynchronisedWord) -> Result<MainRunAction, Fault> {
        match word {
            SynchronisedWord::Address(word) => self.action_address(word),
            SynchronisedWord::Assign(assignment) => {
                let Expression::System { name, indices, .. } = &assignment.place else {
                    let reason = "only system variables are written in the main run; an R parameter is $R[n]";
                    return Err(Fault::new(14757, assignment.at, reason));
                };
                let indices = system_indices(indices, self.scope)?.into_iter().map(|term| term.value).collect();
                let value = MainRunValue(frozen(&assignment.value, self.scope)?);
                Ok(MainRunAction::Assign { name: name.clone(), indices, value })
            }
            SynchronisedWord::Command { command, arguments, at } => Ok(match command {
                Command::SetMark => MainRunAction::SetMarks(self.some_numbers(arguments, MARKS, *at)?),
                Command::ClearMark => MainRunAction::ClearMarks(self.numbers(arguments, MARKS, 14020, *at)?),
                _ => {
                    none(arguments, *at)?;
                    MainRunAction::ReadInDisable
                }
            }),
        }
    }

    fn action_address(&mut self, word: &AddressWord) -> Result<MainRunAction, Fault> {
        let value = MainRunValue(frozen(&word.value, self.scope)?);
        let kind = match word.address {
            Address::Position | Address::AxisFeed => {
                let axis = self.bracket_axis(word.extension.as_ref(), word.at)?;
                if word.address == Address::AxisFeed {
                    return Ok(MainRunAction::AxisFeed(axis, value));
                }
                let dimension = match word.modifier {
                    None => self.default_dimension_of(axis),
                    Some(modifier) => dimension(modifier, word.at)?,
                };
                return Ok(MainRunAction::Position { axis, value, dimension });
            }
            Address::S => AuxiliaryKind::S,
            Address::H => AuxiliaryKind::H,
            _ => AuxiliaryKind::M,
        };
        let extension = match &word.extension {
            Some(extension) => Some(self.limited(extension, (0, 99), 12560, word.at)?),
            None => None,
        };
        // What the program knows already is judged as in a block; the rest when the action is executed.
        if value.is_constant() {
            let known = self.number(&word.value, word.at)?;
            judged_value(kind, known).map_err(|(number, reason)| Fault::new(number, word.at, reason))?;
        }
        Ok(MainRunAction::Auxiliary { kind, extension, value })
    }
}

/// Parameters of a coupling that are kept.
const MOST_PARAMETERS: usize = 16;

/// Evaluates a condition for its errors of types only: its values belong to the main run.
fn evaluate_quietly(composer: &mut Composer<'_>, condition: &Expression) -> Result<(), Fault> {
    match evaluate(condition, composer.scope) {
        Err(fault) if matches!(fault.number, 12150 | 12400 | 12550 | 12553) => Err(fault),
        Ok(_) | Err(_) => Ok(()),
    }
}

/// All parameters; an omitted one is an error.
fn given<'a>(arguments: Arguments<'a>, at: Span) -> Result<Vec<&'a Expression>, Fault> {
    let given: Option<Vec<_>> = arguments.iter().map(Option::as_ref).collect();
    given.ok_or_else(|| count(at, "a parameter is missing"))
}

fn none(arguments: Arguments<'_>, at: Span) -> Result<(), Fault> {
    if arguments.is_empty() { Ok(()) } else { Err(count(at, "it has no parameters")) }
}

fn count(at: Span, reason: &str) -> Fault {
    Fault::new(14020, at, reason)
}
