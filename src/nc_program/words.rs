//! The parser of words: addresses, G functions, commands, assignments, synchronised actions.

use super::alarm::{Fault, Span};
use super::expression::{Expression, Parser};
use super::function::Function;
use super::syntax::{Address, AddressWord, Assignment, Frequency, Modifier, Synchronised, SynchronisedWord, Word};
use super::token::{Kind, Numbered, Symbol};
use super::value::Value;
use super::vocabulary::{Command, is_keyword};

/// A word, or an assignment.
#[derive(Debug)]
pub(super) enum Item {
    Word(Word),
    Assignment(Assignment),
}

/// Addresses of several letters, and whether they have an axis or a number in brackets: never, always, or sometimes.
pub(super) const ADDRESSES: &[(&str, Address, Option<bool>)] = &[
    ("CR", Address::Radius, Some(false)),
    ("AR", Address::OpeningAngle, Some(false)),
    ("TURN", Address::Turns, Some(false)),
    ("FA", Address::AxisFeed, Some(true)),
    ("FD", Address::PathHandwheelFeed, Some(false)),
    ("FDA", Address::HandwheelFeed, Some(true)),
    ("POS", Address::Position, Some(true)),
    ("POSA", Address::PositionAcross, Some(true)),
    ("SPOS", Address::SpindlePosition, None),
    ("SPOSA", Address::SpindlePositionAcross, None),
    ("OVR", Address::Override, Some(false)),
    ("ACC", Address::Acceleration, Some(true)),
    ("AX", Address::AxisOf, Some(true)),
    ("DL", Address::SumOffset, Some(false)),
];

/// Whether a name is an address of several letters.
pub(super) fn is_address(name: &str) -> bool {
    ADDRESSES.iter().any(|row| row.0 == name)
}

/// Letters with a meaning of their own. All but I, J, K and P may have an extension.
const LETTERS: &[(char, Address)] = &[
    ('F', Address::F),
    ('S', Address::S),
    ('T', Address::T),
    ('D', Address::D),
    ('H', Address::H),
    ('M', Address::M),
    ('I', Address::Centre(0)),
    ('J', Address::Centre(1)),
    ('K', Address::Centre(2)),
    ('P', Address::Passes),
];

fn letter(letter: char) -> Option<Address> {
    LETTERS.iter().find(|row| row.0 == letter).map(|row| row.1.clone())
}

fn has_extension(address: &Address) -> bool {
    matches!(address, Address::F | Address::S | Address::T | Address::D | Address::H | Address::M)
}

impl Parser<'_> {
    /// The next word.
    pub(super) fn item(&mut self) -> Result<Item, Fault> {
        let at = self.here();
        match self.kind(0) {
            Some(Kind::Numbered(numbered)) => self.numbered(&numbered.clone(), at),
            Some(Kind::Name(name)) => self.named_word(name, at),
            Some(Kind::System(_)) => self.assignment().map(Item::Assignment),
            Some(_) => Err(self.syntax("a word begins with a letter")),
            None => Err(self.syntax("a word is missing")),
        }
    }

    /// `X10`, `G1`, `M2=3`, `X1=10`, `R1=5`.
    fn numbered(&mut self, numbered: &Numbered, at: Span) -> Result<Item, Fault> {
        if self.is_symbol(1, Symbol::Assign) {
            return self.extended(numbered, at);
        }
        self.at += 1;
        if numbered.letter == 'G' {
            return self.function_of(numbered, at).map(Item::Word);
        }
        let value = Expression::Constant(number_of(numbered));
        if let Some(address) = letter(numbered.letter) {
            return Ok(Item::Word(word(address, None, None, value, at)));
        }
        match self.axes.find(&numbered.letter.to_string()) {
            Some(axis) => Ok(Item::Word(word(Address::Axis(axis), None, None, value, at))),
            None if matches!(numbered.letter, 'R' | 'N' | 'L') => {
                let reason = match numbered.letter {
                    'R' => "`=` and a value must follow an R parameter; the radius of a circle is `CR=`",
                    'N' => "a block number is at the beginning of the block",
                    _ => "a call is alone in its block",
                };
                Err(Fault::new(12080, at, reason))
            }
            None => Err(Fault::new(12550, at, "no axis and no address has this name")),
        }
    }

    /// A name with digits, and `=`.
    fn extended(&mut self, numbered: &Numbered, at: Span) -> Result<Item, Fault> {
        if numbered.letter == 'R' && numbered.whole().is_some() {
            return self.assignment().map(Item::Assignment);
        }
        self.at += 1;
        if let Some(axis) = self.axes.find(&numbered.name()) {
            return self.assigned(Address::Axis(axis), None, at);
        }
        match (letter(numbered.letter), numbered.whole()) {
            (Some(address), Some(extension)) if has_extension(&address) => {
                let extension = Value::Int(i32::try_from(extension).unwrap_or(i32::MAX));
                self.assigned(address, Some(Expression::Constant(extension)), at)
            }
            _ => Err(Fault::new(12550, at, "no axis and no address has this name")),
        }
    }

    fn function_of(&mut self, numbered: &Numbered, at: Span) -> Result<Word, Fault> {
        let unknown = || Fault::new(12470, at, "there is no G function of this number");
        let name = format!("G{}", numbered.whole().ok_or_else(unknown)?);
        if let Some(function) = self.dialect.function(&name) {
            return Ok(Word::Function { function, at });
        }
        match self.dialect.refused(&name) {
            Some(what) => Err(Fault::refused(at, what)),
            None => Err(unknown()),
        }
    }

    fn named_word(&mut self, name: &str, at: Span) -> Result<Item, Fault> {
        if matches!(name, "ID" | "IDS" | "WHEN" | "WHENEVER" | "EVERY" | "FROM" | "DO") {
            return self.synchronised(at).map(|action| Item::Word(Word::Synchronised(Box::new(action))));
        }
        let is_indexed = self.is_symbol(1, Symbol::OpenIndex);
        let is_assigned = self.is_symbol(1, Symbol::Assign);
        if let Some(item) = self.single_letter(name, is_indexed, is_assigned, at) {
            return item;
        }
        if let Some((_, address, brackets)) = ADDRESSES.iter().find(|row| row.0 == name)
            && (is_assigned || is_indexed)
        {
            self.at += 1;
            let mut indices = self.indices()?;
            let fits = brackets.is_none_or(|wanted| wanted != indices.is_empty());
            if !fits || indices.len() > 1 {
                let what = if *brackets == Some(true) { "one axis in brackets" } else { "no brackets" };
                return Err(Fault::new(12080, at, format!("{name} has {what}")));
            }
            return self.assigned(address.clone(), indices.pop(), at);
        }
        if let Some(function) = self.dialect.function(name) {
            self.at += 1;
            return Ok(Item::Word(Word::Function { function, at }));
        }
        if let Some(command) = Command::find(name) {
            self.at += 1;
            let arguments = self.arguments()?.unwrap_or_default();
            return Ok(Item::Word(Word::Command { command, arguments, at: at.until(self.before()) }));
        }
        if let Some(what) = self.dialect.refused(name) {
            return Err(Fault::refused(at, what));
        }
        if let Some(axis) = self.axes.find(name) {
            self.at += 1;
            return self.assigned(Address::Axis(axis), None, at);
        }
        if is_keyword(name) {
            return Err(Fault::new(12080, at, "this word of the language does not belong here"));
        }
        if is_address(name) {
            return Err(Fault::new(12080, at, "`=` and a value must follow"));
        }
        if is_assigned || is_indexed {
            return self.assignment().map(Item::Assignment);
        }
        if Function::find(name).is_some() {
            return Err(Fault::new(12080, at, "a function belongs to an expression"));
        }
        Err(Fault::new(12550, at, "the name is no address, function, command or axis"))
    }

    /// A letter alone: `X-10`, `X=10`, `M[2]=3`, `G=R1`.
    fn single_letter(
        &mut self,
        name: &str,
        is_indexed: bool,
        is_assigned: bool,
        at: Span,
    ) -> Option<Result<Item, Fault>> {
        let mut letters = name.chars();
        let (Some(first), None) = (letters.next(), letters.next()) else { return None };
        if first == 'R' && is_indexed {
            return None; // `R[1]=…` is an assignment
        }
        let axis = self.axes.find(name).map(Address::Axis);
        let address = match first {
            'G' => None,
            _ => Some(letter(first).or(axis)?),
        };
        self.at += 1;
        Some(self.after_letter(address, is_indexed, is_assigned, at))
    }

    fn after_letter(
        &mut self,
        address: Option<Address>,
        is_indexed: bool,
        is_assigned: bool,
        at: Span,
    ) -> Result<Item, Fault> {
        let Some(address) = address else {
            let group = self.indices()?.pop();
            self.need(Symbol::Assign, "`=`")?;
            let number = self.expression()?;
            return Ok(Item::Word(Word::Indirect { group, number, at: at.until(self.before()) }));
        };
        if is_indexed && has_extension(&address) {
            let extension = self.indices()?.pop();
            return self.assigned(address, extension, at);
        }
        if is_assigned {
            return self.assigned(address, None, at);
        }
        let value = self.literal()?;
        Ok(Item::Word(word(address, None, None, value, at.until(self.before()))))
    }

    /// A number with a sign, without `=`.
    fn literal(&mut self) -> Result<Expression, Fault> {
        let is_negative = self.take_symbol(Symbol::Minus);
        if !is_negative {
            self.take_symbol(Symbol::Plus);
        }
        let value = match self.kind(0) {
            Some(Kind::Int(value)) if is_negative => Value::Int(value.wrapping_neg()),
            Some(Kind::Int(value)) => Value::Int(*value),
            Some(Kind::Real(value)) => Value::Real(if is_negative { -value } else { *value }),
            _ => return Err(self.syntax("a number, or `=` and an expression, must follow")),
        };
        self.at += 1;
        Ok(Expression::Constant(value))
    }

    /// `= value` with its modifier.
    fn assigned(&mut self, address: Address, extension: Option<Expression>, at: Span) -> Result<Item, Fault> {
        self.need(Symbol::Assign, "`=`")?;
        let modifier = self.name().and_then(Modifier::find).filter(|_| self.is_symbol(1, Symbol::Open));
        let value = if modifier.is_some() {
            self.at += 2;
            let value = self.expression()?;
            self.need(Symbol::Close, "`)`")?;
            value
        } else {
            self.expression()?
        };
        Ok(Item::Word(word(address, extension, modifier, value, at.until(self.before()))))
    }

    /// `place = value`.
    pub(super) fn assignment(&mut self) -> Result<Assignment, Fault> {
        let at = self.here();
        let place = self.place()?;
        self.need(Symbol::Assign, "`=`")?;
        let value = match self.list()? {
            Some(list) => list,
            None => self.expression()?,
        };
        Ok(Assignment { place, value, at: at.until(self.before()) })
    }

    /// `SET(1,,3)`, `REP(0)`, `REP(0,5)`.
    fn list(&mut self) -> Result<Option<Expression>, Fault> {
        let at = self.here();
        let is_repeated = self.name() == Some("REP");
        if !(is_repeated || self.name() == Some("SET")) || !self.is_symbol(1, Symbol::Open) {
            return Ok(None);
        }
        self.at += 1;
        let values = self.arguments()?.unwrap_or_default();
        let at = at.until(self.before());
        let fits =
            if is_repeated { matches!(values.as_slice(), [Some(_)] | [Some(_), Some(_)]) } else { !values.is_empty() };
        if !fits {
            return Err(Fault::new(12080, at, "SET has values, REP has a value and how many elements get it"));
        }
        Ok(Some(Expression::List { is_repeated, values, at }))
    }

    /// What can have a value: an R parameter, a variable, a system variable.
    pub(super) fn place(&mut self) -> Result<Expression, Fault> {
        let at = self.here();
        let tokens = self.tokens;
        let place = match self.kind(0) {
            Some(Kind::Numbered(numbered)) if numbered.letter == 'R' && numbered.whole().is_some() => {
                let index = Value::Real(numbered.value);
                self.at += 1;
                return Ok(Expression::RParameter { index: Box::new(Expression::Constant(index)), at });
            }
            Some(Kind::Name(_)) if self.is_assignable() => tokens.get(self.at),
            Some(Kind::System(_)) => tokens.get(self.at),
            _ => None,
        };
        let Some(token) = place else { return Err(self.syntax("a variable is missing")) };
        self.at += 1;
        let mut indices = self.indices()?;
        let at = at.until(self.before());
        Ok(match &token.kind {
            Kind::Name(name) if name == "R" && indices.len() == 1 => {
                let index = Box::new(indices.remove(0));
                Expression::RParameter { index, at }
            }
            Kind::Name(name) => Expression::Variable { name: name.clone(), indices, at },
            Kind::System(name) => Expression::System { name: name.clone(), indices, at },
            _ => return Err(Fault::new(12080, at, "a variable is missing")),
        })
    }

    fn is_assignable(&self) -> bool {
        self.name().is_some_and(|name| self.axes.find(name).is_none())
    }

    /// Parameters in parentheses; None without them.
    pub(super) fn arguments(&mut self) -> Result<Option<Vec<Option<Expression>>>, Fault> {
        if !self.take_symbol(Symbol::Open) {
            return Ok(None);
        }
        let mut arguments = Vec::new();
        if self.take_symbol(Symbol::Close) {
            return Ok(Some(arguments));
        }
        loop {
            let is_omitted = self.is_symbol(0, Symbol::Comma) || self.is_symbol(0, Symbol::Close);
            arguments.push(if is_omitted { None } else { Some(self.expression()?) });
            if !self.take_symbol(Symbol::Comma) {
                break;
            }
        }
        self.need(Symbol::Close, "`)`")?;
        Ok(Some(arguments))
    }

    /// `[ID=n | IDS=n] [WHEN | WHENEVER | EVERY | FROM condition] DO action …`.
    fn synchronised(&mut self, at: Span) -> Result<Synchronised, Fault> {
        let id = match self.name() {
            Some(name @ ("ID" | "IDS")) => {
                self.at += 1;
                self.need(Symbol::Assign, "`=`")?;
                Some((self.expression()?, name == "IDS"))
            }
            _ => None,
        };
        let frequency = match self.name() {
            Some("WHEN") => Frequency::Once,
            Some("WHENEVER") => Frequency::Whenever,
            Some("EVERY") => Frequency::Every,
            Some("FROM") => Frequency::From,
            _ => Frequency::Always,
        };
        let condition = if frequency == Frequency::Always {
            None
        } else {
            self.at += 1;
            if self.name() == Some("DO") || self.is_at_end() {
                return Err(self.syntax("the condition is missing"));
            }
            Some(self.expression()?)
        };
        if !self.take_name("DO") {
            return Err(self.syntax("DO is missing"));
        }
        let mut actions = Vec::new();
        while !self.is_at_end() {
            actions.push(self.synchronised_word()?);
        }
        if actions.is_empty() {
            return Err(self.syntax("the action is missing"));
        }
        Ok(Synchronised { id, frequency, condition, actions, at: at.until(self.before()) })
    }

    fn synchronised_word(&mut self) -> Result<SynchronisedWord, Fault> {
        let at = self.here();
        let wrong = || Fault::new(14757, at, "POS, FA, M, H, S, RDISABLE, SETM, CLEARM and assignments are possible");
        match self.item()? {
            Item::Assignment(assignment) => Ok(SynchronisedWord::Assign(assignment)),
            Item::Word(Word::Address(word)) => match word.address {
                Address::Position | Address::AxisFeed | Address::M | Address::H | Address::S => {
                    Ok(SynchronisedWord::Address(word))
                }
                _ => Err(wrong()),
            },
            Item::Word(Word::Command { command, arguments, at }) => match command {
                Command::ReadInDisable | Command::SetMark | Command::ClearMark => {
                    Ok(SynchronisedWord::Command { command, arguments, at })
                }
                _ => Err(wrong()),
            },
            Item::Word(Word::Function { .. } | Word::Indirect { .. } | Word::Synchronised(_)) => Err(wrong()),
        }
    }
}

fn number_of(numbered: &Numbered) -> Value {
    match numbered.digits.parse() {
        Ok(whole) if numbered.whole().is_some() => Value::Int(whole),
        Ok(_) | Err(_) => Value::Real(numbered.value),
    }
}

fn word(
    address: Address,
    extension: Option<Expression>,
    modifier: Option<Modifier>,
    value: Expression,
    at: Span,
) -> Word {
    Word::Address(AddressWord { address, extension, modifier, value, at })
}
