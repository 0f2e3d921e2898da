//! The words of a block as tokens. A name that begins with one letter and digits (`X10`, `M2`, `R1`) is one token; the parser decides
//! whether the digits are a value or a part of the name.

use super::alarm::{Fault, Span};
use super::dialect::Dialect;
use super::names::AxisNames;

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Token {
    pub(super) kind: Kind,
    pub(super) at: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    /// Letters, digits and `_`; in capitals.
    Name(String),
    /// A letter and a number without sign: `X10`, `X10.5`, `M2`.
    Numbered(Numbered),
    /// `$AA_IM`, in capitals.
    System(String),
    /// A whole number that fits into INT.
    Int(i32),
    Real(f64),
    Text(String),
    Character(u8),
    Symbol(Symbol),
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Numbered {
    pub(super) letter: char,
    /// The number as written.
    pub(super) digits: String,
    pub(super) value: f64,
}

impl Numbered {
    /// The number without point and exponent: what can belong to the name.
    pub(super) fn whole(&self) -> Option<u32> {
        self.digits.bytes().all(|byte| byte.is_ascii_digit()).then(|| self.digits.parse().ok()).flatten()
    }

    pub(super) fn name(&self) -> String {
        format!("{}{}", self.letter, self.digits)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Symbol {
    Assign,
    Equal,
    Unequal,
    Greater,
    Less,
    GreaterOrEqual,
    LessOrEqual,
    Join,
    Plus,
    Minus,
    Times,
    Divide,
    Open,
    Close,
    OpenIndex,
    CloseIndex,
    Comma,
    Colon,
}

/// Symbols; the longer ones first.
const SYMBOLS: &[(&str, Symbol)] = &[
    ("==", Symbol::Equal),
    ("<>", Symbol::Unequal),
    (">=", Symbol::GreaterOrEqual),
    ("<=", Symbol::LessOrEqual),
    ("<<", Symbol::Join),
    ("=", Symbol::Assign),
    (">", Symbol::Greater),
    ("<", Symbol::Less),
    ("+", Symbol::Plus),
    ("-", Symbol::Minus),
    ("*", Symbol::Times),
    ("/", Symbol::Divide),
    ("(", Symbol::Open),
    (")", Symbol::Close),
    ("[", Symbol::OpenIndex),
    ("]", Symbol::CloseIndex),
    (",", Symbol::Comma),
    (":", Symbol::Colon),
];

/// The tokens of a line from a column on, without the comment.
pub(super) fn tokens(line: &str, from: usize, dialect: &Dialect, axes: &AxisNames) -> Result<Vec<Token>, Fault> {
    let mut lexer = Lexer { line, at: from.min(line.len()), dialect, axes };
    let mut tokens = Vec::new();
    while let Some(token) = lexer.next()? {
        tokens.push(token);
    }
    Ok(tokens)
}

struct Lexer<'a> {
    line: &'a str,
    at: usize,
    dialect: &'a Dialect,
    axes: &'a AxisNames,
}

impl Lexer<'_> {
    fn next(&mut self) -> Result<Option<Token>, Fault> {
        let line = self.line;
        let rest = line[self.at..].trim_start_matches([' ', '\t', '\r', '\u{feff}']);
        self.at = line.len() - rest.len();
        let Some(first) = rest.chars().next() else { return Ok(None) };
        if first == self.dialect.comment {
            return Ok(None);
        }
        let start = self.at;
        let kind = match first {
            'A'..='Z' | 'a'..='z' | '_' => self.name()?,
            '0'..='9' | '.' => self.number()?,
            '$' => self.system()?,
            '"' => self.text()?,
            '\'' => self.quoted()?,
            _ => match SYMBOLS.iter().find(|(text, _)| rest.starts_with(text)) {
                Some((text, symbol)) => {
                    self.at += text.len();
                    Kind::Symbol(*symbol)
                }
                None => return Err(self.wrong(start, start + first.len_utf8(), "this character has no meaning")),
            },
        };
        Ok(Some(Token { kind, at: self.span(start, self.at) }))
    }

    fn name(&mut self) -> Result<Kind, Fault> {
        let start = self.at;
        let end = self.run(start, |byte| byte.is_ascii_alphanumeric() || byte == b'_');
        let name = &self.line[start..end];
        let digits = self.run(start + 1, |byte| byte.is_ascii_digit());
        let is_numbered = name.starts_with(|c: char| c.is_ascii_alphabetic()) && digits > start + 1;
        let is_longer = digits < end;
        if is_numbered && !(is_longer && (self.line[digits..].starts_with('_') || self.axes.find(name).is_some())) {
            let letter = char::from(self.line.as_bytes()[start]).to_ascii_uppercase();
            self.at = start + 1;
            let (digits, value) = self.decimal()?;
            return Ok(Kind::Numbered(Numbered { letter, digits, value }));
        }
        self.at = end;
        self.limited(start, end)?;
        Ok(Kind::Name(name.to_ascii_uppercase()))
    }

    fn system(&mut self) -> Result<Kind, Fault> {
        let start = self.at;
        let dollars = self.run(start, |byte| byte == b'$');
        self.at = self.run(dollars, |byte| byte.is_ascii_alphanumeric() || byte == b'_');
        if self.at == dollars {
            return Err(self.wrong(start, self.at, "a name must follow `$`"));
        }
        Ok(Kind::System(self.line[start..self.at].to_ascii_uppercase()))
    }

    fn number(&mut self) -> Result<Kind, Fault> {
        let (digits, value) = self.decimal()?;
        let whole = digits.bytes().all(|byte| byte.is_ascii_digit());
        Ok(match digits.parse() {
            Ok(integer) if whole => Kind::Int(integer),
            Ok(_) | Err(_) => Kind::Real(value),
        })
    }

    /// Digits, a point, and an exponent after `EX`.
    fn decimal(&mut self) -> Result<(String, f64), Fault> {
        let start = self.at;
        let digit = |byte: u8| byte.is_ascii_digit();
        let mut end = self.run(start, digit);
        let mut count = end - start;
        if self.line[end..].starts_with('.') {
            let point = end + 1;
            end = self.run(point, digit);
            count += end - point;
        }
        if count == 0 {
            self.at = end;
            return Err(self.wrong(start, end, "a number needs a digit"));
        }
        let bytes = self.line.as_bytes();
        let mut exponent = String::new();
        let is_exponent = bytes.get(end..end + 2).is_some_and(|two| two.eq_ignore_ascii_case(b"EX"));
        if is_exponent {
            let sign = self.run(end + 2, |byte| matches!(byte, b'+' | b'-')).min(end + 3);
            let last = self.run(sign, digit);
            if last > sign {
                exponent = format!("e{}", &self.line[end + 2..last]);
                self.at = last;
            }
        }
        let mantissa = &self.line[start..end];
        if exponent.is_empty() {
            self.at = end;
        }
        let text = self.line[start..self.at].to_owned();
        let value = format!("0{mantissa}{exponent}").parse::<f64>().unwrap_or(f64::INFINITY);
        if value.is_finite() {
            Ok((text, value))
        } else {
            Err(Fault::new(12160, self.span(start, self.at), "the number is outside the range of REAL"))
        }
    }

    fn text(&mut self) -> Result<Kind, Fault> {
        let start = self.at;
        let inside = &self.line[start + 1..];
        let Some(length) = inside.find('"') else {
            return Err(self.wrong(start, self.line.len(), "the string has no end: `\"` is missing"));
        };
        self.at = start + length + 2;
        Ok(Kind::Text(inside[..length].to_owned()))
    }

    /// `'H1F'`, `'B101'`, or the code of a character.
    fn quoted(&mut self) -> Result<Kind, Fault> {
        let start = self.at;
        let inside = &self.line[start + 1..];
        let Some(length) = inside.find('\'') else {
            return Err(self.wrong(start, self.line.len(), "`'` is missing at the end"));
        };
        self.at = start + length + 2;
        let text = &inside[..length];
        let number = match text.as_bytes() {
            [b'H' | b'h', _, ..] => u32::from_str_radix(&text[1..], 16),
            [b'B' | b'b', _, ..] => u32::from_str_radix(&text[1..], 2),
            [one] => return Ok(Kind::Character(*one)),
            _ => return Err(self.wrong(start, self.at, "`'H1F'` and `'B101'` are numbers")),
        };
        match number {
            Ok(number) if !text[1..].starts_with('+') => Ok(Kind::Int(number.cast_signed())),
            Ok(_) | Err(_) => Err(self.wrong(start, self.at, "the digits do not fit the base, or are too many")),
        }
    }

    fn limited(&self, start: usize, end: usize) -> Result<(), Fault> {
        let most = self.dialect.name_length;
        if end - start <= most {
            return Ok(());
        }
        Err(Fault::new(12420, self.span(start, end), format!("{} characters, at most {most} are allowed", end - start)))
    }

    fn run(&self, from: usize, has: impl Fn(u8) -> bool) -> usize {
        let from = from.min(self.line.len());
        from + self.line.as_bytes()[from..].iter().take_while(|byte| has(**byte)).count()
    }

    fn wrong(&self, from: usize, to: usize, reason: &str) -> Fault {
        Fault::new(12080, self.span(from, to), reason)
    }

    #[expect(clippy::unused_self, reason = "columns of the line")]
    fn span(&self, from: usize, to: usize) -> Span {
        let short = |index: usize| u32::try_from(index).unwrap_or(u32::MAX);
        Span { from: short(from), to: short(to) }
    }
}
