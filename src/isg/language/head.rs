//! What stands before the words of a block: `/`, N number, label; and the header lines of programs, `%NAME` and `%L NAME`.

use super::cursor::Cursor;
use super::fault::{Error, FaultCode, NUMBER_TWICE};

/// The beginning of a block.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Head {
    /// `/` is level 1.
    pub(super) skip: Option<u8>,
    pub(super) number: Option<u32>,
    /// `N20:` or `[NAME]`.
    pub(super) label: Option<Target>,
    /// The byte at which the content begins.
    pub(super) rest: usize,
}

/// A jump label.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Target {
    /// `N20:`
    Number(u32),
    /// `[NAME]`
    Name(String),
}

impl std::fmt::Display for Target {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(number) => write!(f, "N{number}:"),
            Self::Name(name) => write!(f, "[{name}]"),
        }
    }
}

/// The highest skip level.
const SKIP_LEVELS: u8 = 10;

/// Reads the beginning of a block.
pub(super) fn head(text: &str) -> Result<Head, Error> {
    let mut head = Head::default();
    let mut cursor = Cursor::new(text, 0);
    cursor.skip_blanks();
    if cursor.eat("/") {
        let at = cursor.at();
        let digits = cursor.digits();
        let level = if digits.is_empty() { Some(1) } else { digits.parse().ok() };
        let level = level.filter(|level| (1..=SKIP_LEVELS).contains(level));
        head.skip = Some(level.ok_or_else(|| {
            Error::syntax(at, format!("a skip level is `/1` to `/{SKIP_LEVELS}`, or `/` alone; found `/{digits}`"))
        })?);
        cursor.skip_blanks();
    }
    if let Some(number) = number(&mut cursor)? {
        head.number = Some(number);
        if cursor.eat(":") {
            head.label = Some(Target::Number(number));
        }
        cursor.skip_blanks();
    }
    let again = cursor.at();
    if let (Some(first), Some(second)) = (head.number, number(&mut cursor)?) {
        let text = format!("the block has the numbers N{first} and N{second}; write one, for a jump label `N{first}:`");
        return Err(Error::new(FaultCode::Number(NUMBER_TWICE), again, text));
    }
    if cursor.peek() == Some('[') {
        head.label = Some(Target::Name(label(&mut cursor)?));
        cursor.skip_blanks();
    }
    head.rest = cursor.at();
    Ok(head)
}

/// `N20`; nothing if no N with digits follows.
pub(super) fn number(cursor: &mut Cursor<'_>) -> Result<Option<u32>, Error> {
    let mut next = *cursor;
    let at = next.at();
    if !next.eat("N") && !next.eat("n") {
        return Ok(None);
    }
    let digits = next.digits();
    if digits.is_empty() {
        return Ok(None);
    }
    *cursor = next;
    let number = digits.parse().map_err(|_| Error::syntax(at, format!("the block number N{digits} is too large")))?;
    Ok(Some(number))
}

/// `[NAME]`; case does not matter.
pub(super) fn label(cursor: &mut Cursor<'_>) -> Result<String, Error> {
    cursor.expect("[", "before a label")?;
    let at = cursor.at();
    let name = cursor.while_letters(|letter| letter != ']').trim();
    cursor.expect("]", "behind a label")?;
    if name.is_empty() {
        return Err(Error::syntax(at, "the brackets of a label are empty; write a name, as in `[END]`"));
    }
    Ok(name.to_uppercase())
}

/// The header line of a program. That of a main program may lack the name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Header<'a> {
    /// `%NAME`
    Main,
    /// `%L NAME`
    Subroutine(&'a str),
}

/// Reads a header line; nothing for another line.
pub(super) fn header(text: &str) -> Result<Option<Header<'_>>, Error> {
    let mut cursor = Cursor::new(text, 0);
    if !cursor.eat("%") {
        return Ok(None);
    }
    let is_subroutine =
        cursor.rest().strip_prefix('L').is_some_and(|rest| rest.is_empty() || rest.starts_with(char::is_whitespace));
    if is_subroutine {
        cursor.step();
    }
    cursor.skip_blanks();
    let at = cursor.at();
    let name = program_name(&mut cursor);
    if name.is_empty() && is_subroutine {
        return Err(Error::syntax(
            at,
            format!("expected the name of a subroutine, as in `%L NAME`; found {}", cursor.found()),
        ));
    }
    cursor.expect_end("the name of a program")?;
    Ok(Some(if is_subroutine { Header::Subroutine(name) } else { Header::Main }))
}

/// Whether a line begins with `%`, readable or not.
pub(super) fn is_header(text: &str) -> bool {
    text.trim_start().starts_with('%')
}

/// The name of a program: no blank, bracket, quote, comma, `#`, `;`, `$`.
pub(super) fn program_name<'a>(cursor: &mut Cursor<'a>) -> &'a str {
    cursor.while_letters(|letter| {
        !letter.is_whitespace() && !matches!(letter, '[' | ']' | '(' | ')' | '{' | '}' | '"' | ',' | '#' | ';' | '$')
    })
}
