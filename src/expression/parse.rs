//! The parser: operator precedence, and the lookup of names.

use std::collections::BTreeSet;

use super::of_control::OfControl;
use super::scope::Scope;
use super::term::{CauseTerm, FollowedTerm, Operator, Question, Term};
use super::tokens::{MACHINE_DATA, Token, excerpt, mistake, tokens};
use crate::image::Location;
use crate::source::{Problem, did_you_mean, nearest};
use crate::units::{AxisNumber, ChannelNumber};
use crate::variables::{AlarmNumber, AxisValue, NamedValue, Place, RuleNumber, short_text};

/// The maximum nesting depth of parentheses.
const DEPTH: usize = 100;

/// All functions.
const FUNCTIONS: [&str; 16] = [
    "alarm",
    "alarm_parameter",
    "alarms",
    "cause",
    "rose",
    "fell",
    "since",
    "count",
    "abs",
    "min",
    "max",
    "message",
    "warnings",
    "errors",
    "active_group",
    "parameter",
];

struct Parser<'a> {
    source: &'a str,
    words: Vec<(usize, Token)>,
    at: usize,
    depth: usize,
    inside_edge: bool,
    scope: &'a dyn Scope,
}

pub(super) fn parse(source: &str, scope: &dyn Scope) -> Result<Term, Problem> {
    let words = tokens(source)?;
    let mut parser = Parser { source, words, at: 0, depth: 0, inside_edge: false, scope };
    let term = parser.expression(0)?;
    match parser.peek() {
        Token::End => Ok(term),
        Token::Name(name) => {
            let cure = word_of_another_language(name).map(str::to_owned);
            let problem = parser.expected("an operator or the end");
            Err(Problem { cure: cure.unwrap_or_else(|| problem.cure.clone()), ..problem })
        }
        _ => Err(parser.expected("an operator or the end")),
    }
}

impl Parser<'_> {
    fn peek(&self) -> &Token {
        &self.words[self.at].1
    }

    fn next(&mut self) -> Token {
        let token = self.peek().clone();
        if self.at + 1 < self.words.len() {
            self.at += 1;
        }
        token
    }

    fn expected(&self, what: &str) -> Problem {
        let (column, token) = &self.words[self.at];
        mistake(self.source, *column, what, &token.shown())
    }

    fn sign(&mut self, sign: &'static str) -> Result<(), Problem> {
        if self.peek() == &Token::Sign(sign) {
            self.next();
            Ok(())
        } else {
            Err(self.expected(&format!("`{sign}`")))
        }
    }

    fn expression(&mut self, at_least: u8) -> Result<Term, Problem> {
        self.depth += 1;
        if self.depth > DEPTH {
            return Err(self.expected(&format!("at most {DEPTH} nested parentheses")));
        }
        let mut left = self.operand()?;
        let mut compared = false;
        while let Token::Sign(sign) = *self.peek()
            && let Some(operator) = Operator::of(sign)
            && operator.binding() > at_least
        {
            if operator.binding() == Operator::COMPARISON {
                if compared {
                    let mut problem = self.expected("one comparison");
                    "comparisons do not chain; write `a < b && b < c`".clone_into(&mut problem.cure);
                    return Err(problem);
                }
                compared = true;
            }
            self.next();
            let right = self.expression(operator.binding())?;
            left = Term::Pair(operator, Box::new([left, right]));
        }
        self.depth -= 1;
        Ok(left)
    }

    fn operand(&mut self) -> Result<Term, Problem> {
        match self.peek().clone() {
            Token::Number(number) => {
                self.next();
                Ok(Term::Number(number))
            }
            Token::Sign("(") => {
                self.next();
                let term = self.expression(0)?;
                self.sign(")")?;
                Ok(term)
            }
            Token::Sign("!") => {
                self.next();
                Ok(Term::Not(Box::new(self.nested_operand()?)))
            }
            Token::Sign("-") => {
                self.next();
                Ok(Term::Negative(Box::new(self.nested_operand()?)))
            }
            Token::Name(name) => {
                let column = self.words[self.at].0;
                self.next();
                if self.peek() == &Token::Sign("(") {
                    self.next();
                    self.function(&name, column)
                } else {
                    self.name(&name, column)
                }
            }
            Token::Quoted(_) | Token::Sign(_) | Token::End => {
                Err(self.expected("a number, a name, a function or a parenthesis"))
            }
        }
    }

    fn nested_operand(&mut self) -> Result<Term, Problem> {
        self.depth += 1;
        if self.depth > DEPTH {
            return Err(self.expected(&format!("at most {DEPTH} signs in a row")));
        }
        let term = self.operand()?;
        self.depth -= 1;
        Ok(term)
    }

    fn function(&mut self, name: &str, column: usize) -> Result<Term, Problem> {
        let term = match name {
            "alarms" => Term::Alarms,
            "alarm" => {
                let alarm = self.alarm()?;
                let place = if self.peek() == &Token::Sign(",") {
                    self.next();
                    Some(self.place()?)
                } else {
                    None
                };
                Term::Alarm(alarm, place)
            }
            "message" => {
                let number = self.alarm()?;
                let place = self.further_place()?;
                Term::OfControl(Box::new(OfControl::Message(number, place)))
            }
            "warnings" | "errors" => {
                let place = if self.peek() == &Token::Sign(")") { None } else { Some(self.place()?) };
                Term::OfControl(Box::new(OfControl::Messages { warnings: name == "warnings", place }))
            }
            "active_group" => {
                let whole = self.expected("the number of a coupling group");
                let Token::Number(number) = self.next() else { return Err(whole) };
                let group = whole_number(number, 7).and_then(|group| u8::try_from(group).ok()).ok_or(whole)?;
                let problem = self.expected("the name of a channel");
                let channel = match self.further_place()? {
                    None => ChannelNumber::FIRST,
                    Some(Place::Channel(channel)) => channel,
                    Some(_) => return Err(problem),
                };
                Term::OfControl(Box::new(OfControl::ActiveGroup(group, channel)))
            }
            "parameter" => self.parameter()?,
            "alarm_parameter" => {
                let alarm = self.alarm()?;
                self.sign(",")?;
                Term::AlarmParameter(alarm, self.parameter_index()?)
            }
            "cause" => {
                let signal = self.cause_signal()?;
                self.sign(",")?;
                let (id, rules) = self.rule()?;
                Term::Cause(Box::new(CauseTerm { signal, id, rules, index: None }))
            }
            "rose" | "fell" => {
                let of = Box::new(self.over_time(name, column)?);
                Term::Edge { rising: name == "rose", of }
            }
            "since" | "count" => {
                let from = self.words[self.at].0;
                let of = self.over_time(name, column)?;
                let length = self.words[self.at].0 - from;
                let inside: String = self.source.chars().skip(from - 1).take(length).collect();
                let question = if name == "since" { Question::Since } else { Question::Count };
                let text = format!("{name}({})", inside.trim());
                Term::Followed(Box::new(FollowedTerm { question, of, text, index: None }))
            }
            "abs" => Term::Absolute(Box::new(self.expression(0)?)),
            "min" | "max" => {
                let operator = if name == "min" { Operator::Minimum } else { Operator::Maximum };
                let mut left = self.expression(0)?;
                self.sign(",")?;
                loop {
                    let right = self.expression(0)?;
                    left = Term::Pair(operator, Box::new([left, right]));
                    if self.peek() != &Token::Sign(",") {
                        break;
                    }
                    self.next();
                }
                left
            }
            _ => {
                let mut problem = mistake(self.source, column, "a function", &format!("`{name}`"));
                problem.cure = did_you_mean(name, FUNCTIONS, &format!("functions are {}", FUNCTIONS.join(", ")));
                return Err(problem);
            }
        };
        self.sign(")")?;
        Ok(term)
    }

    /// The place after a comma, if there is one.
    fn further_place(&mut self) -> Result<Option<Place>, Problem> {
        if self.peek() != &Token::Sign(",") {
            return Ok(None);
        }
        self.next();
        self.place().map(Some)
    }

    /// `parameter(ax5, 'getriebe[0].dynamik.a_max')`, or with a word as third argument.
    fn parameter(&mut self) -> Result<Term, Problem> {
        let place = self.place()?;
        self.sign(",")?;
        let unknown = self.expected("the list name or the ID of a parameter, in quotes");
        let Token::Quoted(name) = self.next() else { return Err(unknown) };
        let (number, index) = self.scope.describe().parameter(&name, place).ok_or(unknown)?;
        let word = if self.peek() == &Token::Sign(",") {
            self.next();
            let problem = self.expected("a word in quotes");
            let Token::Quoted(word) = self.next() else { return Err(problem) };
            Some(short_text(&word))
        } else {
            None
        };
        Ok(Term::OfControl(Box::new(OfControl::Parameter { number, index, place, name, word })))
    }

    /// The condition of a function that looks at several cycles.
    fn over_time(&mut self, name: &str, column: usize) -> Result<Term, Problem> {
        if self.inside_edge {
            let mut problem = mistake(self.source, column, "a signal or a condition", &format!("`{name}`"));
            "rose, fell, since and count cannot be nested; combine them with && or ||".clone_into(&mut problem.cure);
            return Err(problem);
        }
        self.inside_edge = true;
        let of = self.expression(0)?;
        self.inside_edge = false;
        Ok(of)
    }

    /// The number of an alarm, or the quoted name of an alarm that has no number.
    fn alarm(&mut self) -> Result<AlarmNumber, Problem> {
        let whole = self.expected("the number of an alarm");
        match self.next() {
            Token::Number(number) => {
                let known = |alarm: &AlarmNumber| self.scope.describe().has_alarm(*alarm);
                whole_number(number, AlarmNumber::OWN - 1).map(AlarmNumber).filter(known).ok_or_else(|| Problem {
                    cure: "`opennck alarms` lists the alarms of the control".to_owned(),
                    ..whole
                })
            }
            Token::Quoted(name) => self.scope.describe().alarm_number(&name).ok_or_else(|| {
                let names = self.scope.describe().alarm_names();
                let cure = match nearest(&name, names.iter().map(String::as_str)) {
                    Some(near) => format!("did you mean '{near}'?"),
                    None => "write a number; `opennck alarms` lists the alarms of the control".to_owned(),
                };
                Problem { cure, ..whole }
            }),
            Token::Name(name) => Err(Problem { cure: format!("put a name in quotes: alarm('{name}')"), ..whole }),
            Token::Sign(_) | Token::End => Err(whole),
        }
    }

    /// The signal whose last edge is asked for.
    fn cause_signal(&mut self) -> Result<Location, Problem> {
        let column = self.words[self.at].0;
        let cure = "name a signal of the control and a rule: cause(X.traverse_command_plus, 'REF-02')".to_owned();
        let problem = Problem { cure, ..self.expected("a signal") };
        let Token::Name(name) = self.next() else { return Err(problem) };
        match self.name(&name, column)? {
            Term::Signal(location) => Ok(location),
            _ => Err(problem),
        }
    }

    /// The quoted ID of a rule, with the numbers of all rules that have it.
    fn rule(&mut self) -> Result<(&'static str, Box<[RuleNumber]>), Problem> {
        let problem = self.expected("the ID of a rule that causes name");
        let Token::Quoted(wanted) = self.next() else {
            return Err(Problem {
                cure: "put the ID in quotes, as the trace shows it: 'REF-02', 'O-27'".to_owned(),
                ..problem
            });
        };
        let all = self.scope.describe().rules();
        let numbered = (0..).map(RuleNumber).zip(all);
        let rules: Box<[_]> = numbered.filter(|(_, rule)| rule.id == wanted).map(|(number, _)| number).collect();
        match all.iter().find(|rule| rule.id == wanted) {
            Some(rule) => Ok((rule.id, rules)),
            None => Err(Problem { cure: near_rules(&wanted, all.iter().map(|rule| rule.id)), ..problem }),
        }
    }

    fn parameter_index(&mut self) -> Result<usize, Problem> {
        let problem = self.expected("the number of a parameter, 1 to 4");
        match self.next() {
            Token::Number(number) => match whole_number(number, 4) {
                Some(index @ 1..) => Ok(index as usize - 1),
                _ => Err(problem),
            },
            _ => Err(problem),
        }
    }

    /// An axis or a channel by its name.
    fn place(&mut self) -> Result<Place, Problem> {
        let problem = self.expected("the name of an axis or a channel");
        let Token::Name(name) = self.next() else {
            return Err(problem);
        };
        let names = self.scope.describe().names();
        if let Some(axis) = names.axis(&name) {
            return Ok(Place::Axis(axis));
        }
        names.channel(&name).map(Place::Channel).ok_or_else(|| {
            let axes = AxisNumber::all().filter_map(|axis| names.axes[axis].as_deref());
            let channels = ChannelNumber::all().filter_map(|channel| names.channels[channel].as_deref());
            let known: Vec<_> = axes.chain(channels).collect();
            let fallback = format!("known names are {}", known.join(", "));
            Problem { cure: did_you_mean(&name, known.iter().copied(), &fallback), ..problem }
        })
    }

    /// `time`, a value of the caller, `X.position`, `CHAN1.block`, `R5`, a symbol or an address.
    fn name(&self, name: &str, column: usize) -> Result<Term, Problem> {
        if name == "time" {
            return Ok(Term::Time);
        }
        if let Some(index) = self.scope.named_values().iter().position(|named| named == name) {
            return Ok(Term::Named(Box::new((index, name.to_owned()))));
        }
        let problem = mistake(self.source, column, "a known name", &format!("`{name}`"));
        if FUNCTIONS.contains(&name) {
            return Err(Problem { cure: format!("a function has parentheses: `{name}(…)`"), ..problem });
        }
        if let Some(cure) = word_of_another_language(name) {
            return Err(Problem { cure: cure.to_owned(), ..problem });
        }
        let describe = self.scope.describe();
        let at = |problem: Problem| Problem {
            what: format!("{} (at character {column} of `{}`)", problem.what, excerpt(self.source, column)),
            ..problem
        };
        match NamedValue::named(name, describe.names(), |channel| describe.r_parameter_count(channel)).map_err(at)? {
            Some(NamedValue::Program(_)) => {
                let what = format!("expected a number, found `{name}`, which is a text");
                return Err(at(Problem::new(
                    what,
                    format!("write watch = [\"{name}\"]: each change is a row of the trace"),
                )));
            }
            Some(value) => return Ok(Term::Value(value)),
            None => {}
        }
        match self.scope.signal(name) {
            Ok(location) => Ok(Term::Signal(location)),
            Err(_) if is_machine_datum(name) => Err(Problem { cure: MACHINE_DATA.to_owned(), ..problem }),
            Err(unknown) => Err(self.unknown(name, column, unknown)),
        }
    }

    /// The problem of an unknown name: what it looks like, and the nearest known name of this kind.
    fn unknown(&self, name: &str, column: usize, no_signal: Problem) -> Problem {
        let names = self.scope.describe().names();
        let values = AxisValue::names(names.interface());
        let at = format!("at character {column} of `{}`", excerpt(self.source, column));
        if let Some((head, tail)) = name.rsplit_once('.') {
            let near_value = nearest(tail, NamedValue::names_of_channel()).filter(|_| names.channel(head).is_some());
            if let (Some(value), false) = (near_value, no_signal.cure.starts_with("did you mean")) {
                return Problem {
                    place: None,
                    what: format!("expected a signal or a value of `{head}`, found `{name}` ({at})"),
                    cure: format!("did you mean `{head}.{value}`?"),
                };
            }
            let Some(_) = names.axis(head) else {
                return Problem { place: None, what: format!("{} ({at})", no_signal.what), cure: no_signal.cure };
            };
            // The cure of a signal names a signal that is near, or the catalogue.
            let cure = match nearest(tail, values) {
                Some(value) => format!("did you mean `{head}.{value}`?"),
                None if no_signal.cure.starts_with("did you mean") => no_signal.cure,
                None => format!("values of an axis are {}; `opennck signals` lists all signals", values.join(", ")),
            };
            return Problem {
                place: None,
                what: format!("expected a signal or a value of `{head}`, found `{name}` ({at})"),
                cure,
            };
        }
        let has_digit = name.contains(|c: char| c.is_ascii_digit());
        let is_owner = names.owners().any(|(owner, ..)| owner == name);
        let own = self.scope.named_values().iter().map(String::as_str).chain(["time"]);
        match nearest(name, own.chain(FUNCTIONS)) {
            Some(near) if FUNCTIONS.contains(&near) => Problem {
                place: None,
                what: format!("expected a name, found `{name}` ({at})"),
                cure: format!("did you mean `{near}(…)`?"),
            },
            Some(near) => Problem {
                place: None,
                what: format!("expected a name, found `{name}` ({at})"),
                cure: format!("did you mean `{near}`?"),
            },
            // Something like an address, or the name of an axis alone.
            None if has_digit || is_owner => {
                Problem { place: None, what: format!("{} ({at})", no_signal.what), cure: no_signal.cure }
            }
            None => Problem::new(
                format!("expected a signal, a value, an address, a captured name or `time`, found `{name}` ({at})"),
                "write X.controller_enable, X.position or DB31.DBX2.1; a captured name is known after its `capture`",
            ),
        }
    }
}

/// The remedy for an ID that no cause has: the IDs of the same group (`REF-`), else the nearest one, else all.
fn near_rules(wanted: &str, known: impl Iterator<Item = &'static str>) -> String {
    let known: BTreeSet<&str> = known.collect();
    let group = |id: &str| id.split_once('-').map(|(group, _)| group.to_ascii_uppercase());
    let mut same: Vec<_> =
        known.iter().copied().filter(|id| group(id).is_some() && group(id) == group(wanted)).collect();
    same.sort_by_key(|id| (id.len(), *id));
    if !same.is_empty() {
        return format!("causes name {}; the trace shows the ID of each cause", same.join(", "));
    }
    let all: Vec<_> = known.iter().copied().collect();
    did_you_mean(wanted, known, &format!("causes name {}", all.join(", ")))
}

/// Whether a name is `MD10000` or `SD41110`: `MD20` is a double word of flags.
fn is_machine_datum(name: &str) -> bool {
    let number = name.strip_prefix("MD").or_else(|| name.strip_prefix("SD"));
    number.is_some_and(|number| number.len() == 5 && number.bytes().all(|byte| byte.is_ascii_digit()))
}

/// The remedy for a word that is an operator or a constant in other languages.
fn word_of_another_language(name: &str) -> Option<&'static str> {
    Some(match name.to_ascii_lowercase().as_str() {
        "true" => "a bit is 1 or 0, and an expression is true if it is not 0: write `X.controller_enable`, or `== 1`",
        "false" => "a bit is 1 or 0, and an expression is false if it is 0: write `!X.controller_enable`, or `== 0`",
        "and" => "write `&&` for `and`",
        "or" => "write `||` for `or`",
        "not" => "write `!` for `not`",
        _ => return None,
    })
}

/// The number as an integer, if it is whole, not negative and not above `largest`.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "tested before the cast")]
fn whole_number(number: f64, largest: u32) -> Option<u32> {
    (number.fract() == 0.0 && (0.0..=f64::from(largest)).contains(&number)).then_some(number as u32)
}
