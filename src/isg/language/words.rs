//! Words of a block: G, M, addresses with values, axes, assignments, calls, jumps (isg.md 3.1).
//!
//! A value behind an address is an expression, with or without `=`, as published examples have it: `X20`, `X=47`, `X[P1 + 2]`, `X SIN[P1 * 5]`.

use super::block::Sign;
use super::cursor::Cursor;
use super::expression::{expression, is_place, place};
use super::fault::{BEHIND_CALL, Error, FaultCode, JUMP_TARGET};
use super::head::{Target, label, number, program_name};
use super::syntax::{Address, Word, WordKind};

/// Letters that begin the name of an axis.
const AXES: &str = "ABCQUVWXYZ";

/// The largest number of an M or H function.
const LARGEST_FUNCTION: u32 = 65_535;

/// Reads words up to the end of the text or a `#`.
pub(super) fn words(cursor: &mut Cursor<'_>) -> Result<Vec<Word>, Error> {
    let mut words: Vec<Word> = Vec::new();
    while !cursor.is_end() && cursor.peek() != Some('#') {
        let at = cursor.at();
        if words.last().is_some_and(|word| matches!(word.kind, WordKind::Call { .. })) {
            let text = format!(
                "nothing may stand behind a subroutine call, found {}; write it before, or in the next block",
                cursor.found()
            );
            return Err(Error::new(FaultCode::Number(BEHIND_CALL), at, text));
        }
        let is_dwell = words.last().is_some_and(|word| word.kind == WordKind::G(4));
        let kind = match time(cursor, is_dwell)? {
            Some(time) => time,
            None => word(cursor)?,
        };
        words.push(Word { kind, at });
    }
    Ok(words)
}

/// Whether these letters are the name of an axis.
pub(super) fn is_axis_name(name: &str) -> bool {
    name.starts_with(|letter| AXES.contains(letter))
}

/// The time directly behind G04.
fn time(cursor: &mut Cursor<'_>, is_dwell: bool) -> Result<Option<WordKind>, Error> {
    if !is_dwell {
        return Ok(None);
    }
    if matches!(cursor.peek(), Some('S' | 's')) {
        let text = "a dwell time in revolutions (`G04 S…`) is not modelled; write seconds, `G04 2.5`";
        return Err(Error::syntax(cursor.at(), text));
    }
    let begins = cursor.peek().is_some_and(|letter| letter.is_ascii_digit() || matches!(letter, '.' | '[' | '-' | '+'));
    if !begins && !is_place(cursor) {
        return Ok(None);
    }
    Ok(Some(WordKind::Time(expression(cursor)?)))
}

fn word(cursor: &mut Cursor<'_>) -> Result<WordKind, Error> {
    let at = cursor.at();
    if let Some(place) = place(cursor)? {
        if !cursor.eat("=") {
            cursor.skip_blanks();
            let text = match cursor.peek() {
                Some(':') => format!(
                    "the declaration of a type ({}: REAL64) is not modelled; assign a value, `{} = 2`",
                    place.name, place.name
                ),
                Some(_) | None => format!("expected `=` behind {}, found {}", place.name, cursor.found()),
            };
            return Err(Error::syntax(cursor.at(), text));
        }
        return Ok(WordKind::Assign(place, expression(cursor)?));
    }
    if cursor.peek() == Some('$') {
        return jump(cursor);
    }
    let start = *cursor;
    let name = cursor.name();
    let Some(letter) = name.chars().next() else { return Err(unknown(start)) };
    if is_axis_name(name) {
        return axis(name, start, cursor);
    }
    // Words may follow each other without a blank: G01X20.
    let after_letter = start.moved(at + 1);
    match letter.to_ascii_uppercase() {
        'G' | 'M' => {
            let mut end = after_letter;
            let digits = end.digits();
            if digits.is_empty() {
                return Err(unknown(start));
            }
            *cursor = end;
            let function = digits.parse().ok().filter(|number| *number <= LARGEST_FUNCTION).ok_or_else(|| {
                Error::syntax(
                    at,
                    format!("the number of a function is at most {LARGEST_FUNCTION}, found {letter}{digits}"),
                )
            })?;
            Ok(if letter.eq_ignore_ascii_case(&'G') { WordKind::G(function) } else { WordKind::M(function) })
        }
        'L' => call(name, start, cursor),
        'E' => Err(Error::syntax(at, "the feed at the end of a block (E) is not modelled; write F")),
        _ => {
            let address = match letter.to_ascii_uppercase() {
                'F' => Address::F,
                'I' => Address::I,
                'J' => Address::J,
                'K' => Address::K,
                'R' => Address::R,
                'T' => Address::T,
                'D' => Address::D,
                'S' => Address::S,
                'H' => Address::H,
                _ => return Err(unknown(start)),
            };
            *cursor = after_letter;
            cursor.eat("=");
            Ok(WordKind::Value(
                address,
                expression(cursor).map_err(|error| if error.at == at + 1 { unknown(start) } else { error })?,
            ))
        }
    }
}

/// `X20`, `X=47`, `Y_S=20`. Only a name of one letter can do without `=`.
fn axis<'a>(name: &str, start: Cursor<'a>, cursor: &mut Cursor<'a>) -> Result<WordKind, Error> {
    let mut behind = *cursor;
    if behind.eat("=") && behind.peek() != Some('=') {
        let value = expression(&mut behind)?;
        *cursor = behind;
        return Ok(WordKind::Axis(name.to_owned(), None, false, value));
    }
    *cursor = start.moved(start.at() + 1);
    let sign = Sign::of(cursor.peek());
    let mut behind = *cursor;
    behind.step();
    behind.skip_blanks();
    let is_doubled = sign.is_some() && Sign::of(behind.peek()).is_some();
    let value = expression(cursor).map_err(|error| {
        // The value is wrong, or what looks like the name of an axis has none.
        let is_name = name[1..].starts_with(|letter: char| letter.is_ascii_alphabetic() || letter == '_');
        if !is_name || error.at >= start.at() + name.len() {
            return error;
        }
        let text = format!(
            "{} is not a word of an NC block: the name of an axis needs `=` and a value (`{name}=20`), a name of one letter a value (`X20`)",
            start.found()
        );
        Error::syntax(start.at(), text)
    })?;
    Ok(WordKind::Axis(name[..1].to_owned(), sign, is_doubled, value))
}

/// `LL NAME`, `L NAME`, `L "NAME"`, `L4712`.
fn call<'a>(name: &str, start: Cursor<'a>, cursor: &mut Cursor<'a>) -> Result<WordKind, Error> {
    let rest = name.trim_start_matches(['L', 'l']);
    let letters = name.len() - rest.len();
    if letters > 2 || !rest.chars().all(|letter| letter.is_ascii_digit()) {
        return Err(unknown(start));
    }
    *cursor = start.moved(start.at() + letters);
    cursor.skip_blanks();
    let at = cursor.at();
    let name = if cursor.eat("\"") {
        let name = cursor.while_letters(|letter| letter != '"');
        cursor.expect("\"", "behind the name of a program")?;
        name.trim()
    } else {
        program_name(cursor)
    };
    if name.is_empty() {
        return Err(Error::syntax(at, format!("expected the name of a subroutine, found {}", cursor.found())));
    }
    if name == "CYCLE" && (letters == 1 || cursor.eat("[")) {
        let text = "calls of cycles (L CYCLE and LL CYCLE) are not modelled; call the subroutine with L or LL";
        return Err(Error::syntax(start.at(), text));
    }
    Ok(WordKind::Call { name: name.to_owned(), is_local: letters == 2 })
}

/// `$GOTO N20`, `$GOTO [NAME]`.
fn jump(cursor: &mut Cursor<'_>) -> Result<WordKind, Error> {
    let at = cursor.at();
    let mut end = *cursor;
    end.step();
    if end.name() != "GOTO" {
        let text = format!(
            "expected $GOTO behind words, found {}; other control blocks stand alone in their line",
            cursor.found()
        );
        return Err(Error::syntax(at, text));
    }
    *cursor = end;
    Ok(WordKind::Goto(target(cursor)?))
}

/// What stands behind `$GOTO`.
pub(super) fn target(cursor: &mut Cursor<'_>) -> Result<Target, Error> {
    cursor.skip_blanks();
    let at = cursor.at();
    if cursor.peek() == Some('[') {
        return label(cursor).map(Target::Name);
    }
    number(cursor)?.map(Target::Number).ok_or_else(|| {
        let text = format!("behind $GOTO stands `N20` or `[NAME]`, found {}", cursor.found());
        Error::new(FaultCode::Number(JUMP_TARGET), at, text)
    })
}

fn unknown(start: Cursor<'_>) -> Error {
    let text = format!(
        "{} is not a word of an NC block; words are G, M, an address with a value (X20, F300, T10), NAME=value, P10=…, V.…=…, L NAME, LL NAME, \
         names of axes in capitals",
        start.found()
    );
    Error::syntax(start.at(), text)
}
