//! The tokens of an expression: numbers, names, operators.

use std::borrow::Cow;

use crate::source::Problem;
use crate::variables::is_r_parameter;

/// One token of an expression.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Token {
    /// `1.5`, `2#1101_0000`.
    Number(f64),
    /// `X.position`, `DB31.DBX101.5`, `DB1000.DBD4:REAL`, `R5[CHAN2]`, `abs`.
    Name(String),
    /// `'gantry-stage-1'`.
    Quoted(String),
    /// `&&`, `<=`, `(`, `,`.
    Sign(&'static str),
    /// The end of the expression.
    End,
}

impl Token {
    /// The token in a message.
    pub(super) fn shown(&self) -> String {
        match self {
            Self::Number(number) => format!("the number {number}"),
            Self::Name(name) => format!("`{name}`"),
            Self::Quoted(name) => format!("'{name}'"),
            Self::Sign(sign) => format!("`{sign}`"),
            Self::End => "the end".to_owned(),
        }
    }
}

/// The operators and punctuation; a longer one precedes its own prefix.
const SIGNS: [&str; 15] = ["==", "!=", "<=", ">=", "&&", "||", "<", ">", "!", "+", "-", "*", "/", "(", ")"];

/// What to do about the name of a machine datum.
pub(super) const MACHINE_DATA: &str =
    "machine data cannot be read in expressions: write the number; `machine_data` and `[machine_data]` store them";

/// The maximum number of tokens. Terms are nested, and a deeper nesting would need more stack than a thread has.
const TOKENS: usize = 2_000;

/// The maximum length of an expression in bytes.
const LENGTH: usize = 50_000;

/// Splits an expression into tokens, each with its column, counted from one.
pub(super) fn tokens(source: &str) -> Result<Vec<(usize, Token)>, Problem> {
    let cure = "split it: several `expect` items, or `capture` for parts";
    if source.len() > LENGTH {
        let what = format!("expected an expression of at most {LENGTH} bytes, found {}", source.len());
        return Err(Problem::new(what, cure));
    }
    let mut found = Vec::new();
    let mut rest = source;
    let (mut column, mut counted) = (1, 0);
    while let Some(first) = rest.chars().next() {
        if found.len() == TOKENS {
            let what = format!("expected an expression of at most {TOKENS} names, numbers and operators, found more");
            return Err(Problem::new(what, cure));
        }
        let at = source.len() - rest.len();
        column += source[counted..at].chars().count();
        counted = at;
        if first.is_whitespace() {
            rest = &rest[first.len_utf8()..];
        } else if first.is_ascii_digit() {
            let length = rest.find(|c: char| !(c.is_ascii_alphanumeric() || "_.#".contains(c)));
            let (word, after) = rest.split_at(length.unwrap_or(rest.len()));
            found.push((column, Token::Number(number(word, source, column)?)));
            rest = after;
        } else if first.is_alphabetic() || first == '_' {
            let length = rest.find(|c: char| !(c.is_alphanumeric() || "_.:".contains(c)));
            let mut length = length.unwrap_or(rest.len());
            if rest[length..].starts_with('[') && is_r_parameter(&rest[..length]) {
                let Some(end) = rest[length..].find(']') else {
                    return Err(mistake(source, column + length, "a channel and `]`, as in R5[CHAN2]", "no `]`"));
                };
                length += end + 1;
            }
            let (word, after) = rest.split_at(length);
            found.push((column, Token::Name(word.to_owned())));
            rest = after;
        } else if first == '\'' {
            let Some(length) = rest[1..].find('\'') else {
                return Err(mistake(source, column, "a closing quote", "the end"));
            };
            found.push((column, Token::Quoted(rest[1..=length].to_owned())));
            rest = &rest[length + 2..];
        } else if first == ',' {
            found.push((column, Token::Sign(",")));
            rest = &rest[1..];
        } else if let Some(sign) = SIGNS.iter().find(|sign| rest.starts_with(**sign)) {
            found.push((column, Token::Sign(sign)));
            rest = &rest[sign.len()..];
        } else {
            let mut problem = mistake(source, column, "a number, a name or an operator", &format!("`{first}`"));
            match first {
                '&' => problem.cure = "write `&&` for `and`".to_owned(),
                '|' => problem.cure = "write `||` for `or`".to_owned(),
                '=' => problem.cure = "write `==` for `equal`".to_owned(),
                '[' => problem.cure = MACHINE_DATA.to_owned(),
                '"' => problem.cure = "the name of an alarm is in single quotes: alarm('name')".to_owned(),
                _ => {}
            }
            return Err(problem);
        }
    }
    found.push((column + source[counted..].chars().count(), Token::End));
    Ok(found)
}

/// The problem "expected this, found that", with the expression and the column.
pub(super) fn mistake(source: &str, column: usize, expected: &str, found: &str) -> Problem {
    Problem::new(
        format!("expected {expected}, found {found} at character {column} of `{}`", excerpt(source, column)),
        "operators are == != < <= > >= && || ! + - * /, with parentheses",
    )
}

/// The longest expression that a message shows as a whole, in characters.
const SHOWN: usize = 200;

/// The expression for a message; only the part around a column if it is long.
pub(super) fn excerpt(source: &str, column: usize) -> Cow<'_, str> {
    let length = source.chars().count();
    if length <= SHOWN {
        return Cow::Borrowed(source);
    }
    let from = column.saturating_sub(SHOWN / 2).min(length - SHOWN);
    let before = if from > 0 { "…" } else { "" };
    let after = if from + SHOWN < length { "…" } else { "" };
    Cow::Owned(format!("{before}{}{after}", source.chars().skip(from).take(SHOWN).collect::<String>()))
}

/// A number in the notation of the PLC: `1.5`, `1_000`, or with its base, `16#D0`.
fn parse_number(word: &str) -> Option<f64> {
    if let Some((base, digits)) = word.split_once('#') {
        let base = base.parse().ok().filter(|base| (2..=16).contains(base))?;
        let digits = without_separators(digits)?;
        return u64::from_str_radix(&digits, base).ok().map(|number| number as f64);
    }
    let digits = without_separators(word)?;
    let well_formed = digits.split('.').count() <= 2
        && digits.split('.').all(|part| !part.is_empty() && part.bytes().all(|c| c.is_ascii_digit()));
    if well_formed { digits.parse().ok() } else { None }
}

/// Digits without underscores. An underscore is valid only between two digits.
fn without_separators(word: &str) -> Option<String> {
    let bytes = word.as_bytes();
    let is_digit = |index: Option<usize>| {
        index.and_then(|index| bytes.get(index)).is_some_and(|byte| byte.is_ascii_alphanumeric())
    };
    let mut separators = bytes.iter().enumerate().filter(|(_, byte)| **byte == b'_');
    let all_between = separators.all(|(index, _)| is_digit(index.checked_sub(1)) && is_digit(Some(index + 1)));
    (all_between && !word.is_empty()).then(|| word.replace('_', ""))
}

fn number(word: &str, source: &str, column: usize) -> Result<f64, Problem> {
    parse_number(word).ok_or_else(|| {
        let mut problem = mistake(source, column, "a number", &format!("`{word}`"));
        problem.cure = "write a number as 12, 1.5, 1_000, 2#1101_0000 or 16#D0".to_owned();
        problem
    })
}
