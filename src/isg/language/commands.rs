//! Commands that begin with `#`: axis coupling, gantry, axis exchange, dwell (isg.md 2.8, 2.9, 3.1).

use super::cursor::Cursor;
use super::expression::expression;
use super::fault::{Error, FaultCode, NO_DENOMINATOR};
use super::link::LinkOff;
use super::syntax::{Axis, Form, GantryTarget, HashCommand, Pair, Put, Request, Switch, Value};
use super::words::{is_axis_name, words};

/// Reads a command to the end of the line; the `#` is next. With `lenient` text behind a closing `]` is ignored.
pub(super) fn command(cursor: &mut Cursor<'_>, lenient: bool) -> Result<HashCommand, Error> {
    let start = *cursor;
    cursor.step();
    if cursor.peek().is_none_or(char::is_whitespace) {
        let text = "`#` before a blank begins a comment only in parameter lists; write `;` or ( … )";
        return Err(Error::syntax(start.at(), text));
    }
    let command = named(start, cursor, lenient)?;
    if cursor.is_end() {
        return Ok(command);
    }
    // What could be a block of its own is no comment.
    let is_text = words(&mut cursor.clone()).is_err() && cursor.peek() != Some('#');
    if is_text && lenient && before(start, cursor).trim_end().ends_with(']') {
        return Ok(command);
    }
    let found = cursor.found();
    Err(match is_text {
        true => Error::syntax(
            cursor.at(),
            format!(
                "expected the end of the line behind the command, found {found}; a comment stands in ( … ) or behind `;`"
            ),
        ),
        false => not_alone(&command, cursor.at(), &found),
    })
}

/// The error of a command that stands behind words.
pub(super) fn behind_words(cursor: &mut Cursor<'_>, lenient: bool) -> Error {
    let at = cursor.at();
    match command(cursor, lenient) {
        Ok(command) => not_alone(&command, at, "words before it"),
        Err(error) => error,
    }
}

fn not_alone(command: &HashCommand, at: usize, found: &str) -> Error {
    let is_link = matches!(command, HashCommand::Link { .. } | HashCommand::LinkOn(_) | HashCommand::LinkOff(_));
    let code = if is_link { FaultCode::LinkNotAlone } else { FaultCode::Syntax };
    Error::new(
        code,
        at,
        format!("the command stands alone in its block, found {found}; write it in a block of its own"),
    )
}

fn before<'a>(start: Cursor<'a>, end: &Cursor<'a>) -> &'a str {
    &start.rest()[..end.at() - start.at()]
}

fn named(start: Cursor<'_>, cursor: &mut Cursor<'_>, lenient: bool) -> Result<HashCommand, Error> {
    let unknown = || {
        if let Some(text) = known_elsewhere(start) {
            return Error::syntax(start.at(), text);
        }
        let text = format!(
            "{} is not a command that OpenNCK has; there are #SET AX LINK, #AX LINK [NBR], #ENABLE and #DISABLE AX LINK, #AX LINK ON, OFF and OFF ALL, \
             #GANTRY ON and OFF, #CALL AX, #PUT AX, #AX REQUEST, #AX RELEASE, #TIME, #COMMENT BEGIN and END, all in capitals",
            start.found()
        );
        Error::syntax(start.at(), text)
    };
    match cursor.name() {
        "SET" => ax_link(cursor, lenient).then(|| link(cursor, false)).ok_or_else(unknown)?,
        "ENABLE" => ax_link(cursor, lenient).then(|| group(cursor).map(HashCommand::LinkOn)).ok_or_else(unknown)?,
        "DISABLE" => ax_link(cursor, lenient).then(|| link_off(cursor)).ok_or_else(unknown)?,
        "AXLINK" if lenient => link_command(cursor),
        "AX" => {
            if cursor.eat_word("LINK") {
                link_command(cursor)
            } else if cursor.eat_word("REQUEST") {
                let is_fast = cursor.eat_word("FAST");
                Ok(HashCommand::Call { is_fast, conflicts: conflicts(cursor)?, requests: requests(cursor)? })
            } else if cursor.eat_word("RELEASE") {
                let is_by_number = cursor.eat_word("NBR");
                put(cursor, is_by_number)
            } else {
                Err(unknown())
            }
        }
        "GANTRY" => gantry(cursor),
        "CALL" => cursor.eat_word("AX").then_some(()).ok_or_else(unknown).and_then(|()| {
            let is_fast = cursor.eat_word("FAST");
            Ok(HashCommand::Call { is_fast, conflicts: [false; 3], requests: requests(cursor)? })
        }),
        "PUT" => cursor.eat_word("AX").then(|| put(cursor, false)).ok_or_else(unknown)?,
        "TIME" => value(cursor).map(HashCommand::Time),
        _ => Err(unknown()),
    }
}

/// Commands that OpenNCK has, but not in this place or form.
fn known_elsewhere(start: Cursor<'_>) -> Option<&'static str> {
    let rest = start.rest();
    if rest.starts_with("#COMMENT") {
        return Some(
            "#COMMENT BEGIN and #COMMENT END stand alone in their line, with one blank before BEGIN or END; a block number may stand before them",
        );
    }
    if rest.starts_with("#VAR") || rest.starts_with("#ENDVAR") {
        return Some(
            "#VAR and #ENDVAR stand alone in their line; between them only assignments are modelled, `V.P.NAME = 2`",
        );
    }
    let is_one_word = ["#AXLINK", "#SET AXLINK", "#ENABLE AXLINK", "#DISABLE AXLINK"];
    is_one_word
        .iter()
        .any(|command| rest.starts_with(command))
        .then_some("AX LINK is written in two words: `#DISABLE AX LINK[1]`")
}

/// G201 and G202 with their axes; `#` is next.
pub(super) fn manual(cursor: &mut Cursor<'_>, is_on: bool) -> Result<HashCommand, Error> {
    let mut axes = Vec::new();
    while cursor.eat("#") {
        if !cursor.eat_word("AXIS") && !cursor.eat_word("ACHSE") {
            return Err(Error::syntax(cursor.at(), format!("expected `#AXIS [X]`, found `#` and {}", cursor.found())));
        }
        cursor.expect("[", "behind #AXIS")?;
        axes.push(axis_name(cursor)?);
        cursor.expect("]", "behind the name of an axis")?;
    }
    cursor.expect_end("#AXIS [ ]")?;
    Ok(HashCommand::Manual { is_on, axes })
}

/// `AX LINK`; with `lenient` also `AXLINK`.
fn ax_link(cursor: &mut Cursor<'_>, lenient: bool) -> bool {
    cursor.eat_word("AX") && cursor.eat_word("LINK") || lenient && cursor.eat_word("AXLINK")
}

/// What stands behind `#AX LINK`.
fn link_command(cursor: &mut Cursor<'_>) -> Result<HashCommand, Error> {
    if cursor.eat_word("ON") {
        return group(cursor).map(HashCommand::LinkOn);
    }
    if cursor.eat_word("OFF") {
        return if cursor.eat_word("ALL") {
            Ok(HashCommand::LinkOff(Switch::Known(LinkOff::All)))
        } else {
            link_off(cursor)
        };
    }
    let is_by_number = cursor.eat_word("NBR");
    link(cursor, is_by_number)
}

fn link_off(cursor: &mut Cursor<'_>) -> Result<HashCommand, Error> {
    let group = group(cursor)?;
    Ok(HashCommand::LinkOff(group.map_or(Switch::Known(LinkOff::Last), Switch::Group)))
}

/// `[1]`, or nothing.
fn group(cursor: &mut Cursor<'_>) -> Result<Option<Value>, Error> {
    if !cursor.eat("[") {
        return Ok(None);
    }
    let group = value(cursor)?;
    cursor.expect("]", "behind the number of a coupling group")?;
    Ok(Some(group))
}

fn value(cursor: &mut Cursor<'_>) -> Result<Value, Error> {
    cursor.skip_blanks();
    let at = cursor.at();
    Ok(Value { expression: expression(cursor)?, at })
}

/// `[group, pair {, pair}]`
fn link(cursor: &mut Cursor<'_>, is_by_number: bool) -> Result<HashCommand, Error> {
    cursor.expect("[", "before the number of a coupling group")?;
    let group = value(cursor)?;
    cursor.expect(",", "behind the number of a coupling group")?;
    let mut pairs = vec![pair(cursor, is_by_number)?];
    while cursor.eat(",") {
        pairs.push(pair(cursor, is_by_number)?);
    }
    cursor.expect("]", "behind the pairs of a coupling group")?;
    Ok(HashCommand::Link { group, pairs })
}

fn pair(cursor: &mut Cursor<'_>, is_by_number: bool) -> Result<Pair, Error> {
    cursor.skip_blanks();
    let at = cursor.at();
    let is_bracketed = cursor.eat("[");
    let slave = axis(cursor, is_by_number)?;
    cursor.expect("=", "behind the slave axis")?;
    let master = axis(cursor, is_by_number)?;
    if !is_bracketed {
        return Ok(Pair { slave, master, form: Form::Bare, at });
    }
    let form = if cursor.eat(",") { qualifier(cursor)? } else { Form::Standard };
    cursor.expect("]", "behind a pair")?;
    Ok(Pair { slave, master, form, at })
}

fn axis(cursor: &mut Cursor<'_>, is_by_number: bool) -> Result<Axis, Error> {
    if is_by_number { value(cursor).map(Axis::Number) } else { axis_name(cursor).map(Axis::Name) }
}

/// `G`, `G,limit,limit` or `numerator,denominator`.
fn qualifier(cursor: &mut Cursor<'_>) -> Result<Form, Error> {
    if cursor.eat_word("G") {
        if !cursor.eat(",") {
            return Ok(Form::Gantry(None));
        }
        let first = value(cursor)?;
        cursor.expect(",", "and the second limit (both limits, or none)")?;
        return Ok(Form::Gantry(Some([first, value(cursor)?])));
    }
    let numerator = value(cursor)?;
    let denominator = if cursor.eat(",") { Some(value(cursor)?) } else { None };
    Ok(Form::Factor(numerator, denominator))
}

/// The error of a factor without a denominator.
pub(super) fn no_denominator(at: usize) -> Error {
    let text = "the denominator of the coupling factor is missing; write two whole numbers, as in `[Y2 = Y1,1,-1]`";
    Error::new(FaultCode::Number(NO_DENOMINATOR), at, text)
}

fn axis_name(cursor: &mut Cursor<'_>) -> Result<String, Error> {
    cursor.skip_blanks();
    let start = *cursor;
    let name = cursor.name();
    if is_axis_name(name) {
        return Ok(name.to_owned());
    }
    let text = format!(
        "expected the name of an axis, which begins with A, B, C, Q, U, V, W, X, Y or Z; found {}",
        start.found()
    );
    Err(Error::syntax(start.at(), text))
}

fn gantry(cursor: &mut Cursor<'_>) -> Result<HashCommand, Error> {
    let is_on = cursor.eat_word("ON");
    if !is_on && !cursor.eat_word("OFF") {
        cursor.skip_blanks();
        return Err(Error::syntax(cursor.at(), format!("expected ON or OFF behind #GANTRY, found {}", cursor.found())));
    }
    if cursor.eat_word("ALL") {
        return Ok(HashCommand::Gantry { is_on, targets: None });
    }
    cursor.expect("[", "or ALL, as in `#GANTRY OFF [AX=X]`")?;
    let mut targets = Vec::new();
    while !cursor.eat("]") {
        if !targets.is_empty() {
            cursor.eat(",");
        }
        cursor.skip_blanks();
        let at = cursor.at();
        let form = "behind AX or AXNR";
        targets.push(if cursor.eat_word("AXNR") {
            cursor.expect("=", form)?;
            GantryTarget::Number(value(cursor)?)
        } else if cursor.eat_word("AX") {
            cursor.expect("=", form)?;
            GantryTarget::Name(axis_name(cursor)?)
        } else {
            return Err(Error::syntax(
                at,
                format!("expected `AX=<name of the master>` or `AXNR=<its logical number>`, found {}", cursor.found()),
            ));
        });
    }
    if targets.is_empty() {
        let text = "the bracket is empty; name a master, as in `[AX=X]` or `[AXNR=1]`, or write ALL";
        return Err(Error::syntax(cursor.at() - 1, text));
    }
    Ok(HashCommand::Gantry { is_on, targets: Some(targets) })
}

/// The switches NAM, NBR, IDX of `#AX REQUEST`, each with a bracket of its own, in a common one, or without.
fn conflicts(cursor: &mut Cursor<'_>) -> Result<[bool; 3], Error> {
    let mut found = [false; 3];
    loop {
        let mut next = *cursor;
        next.eat("[");
        let Some(index) = ["NAM", "NBR", "IDX"].iter().position(|word| next.eat_word(word)) else { return Ok(found) };
        next.eat(",");
        next.eat("]");
        found[index] = true;
        *cursor = next;
    }
}

fn requests(cursor: &mut Cursor<'_>) -> Result<Vec<Request>, Error> {
    let mut requests = Vec::new();
    loop {
        cursor.expect("[", "before an axis, as in `[Axis_X1, 5, 4]`")?;
        let name = axis_name(cursor)?;
        cursor.expect(",", "and the logical number behind the name")?;
        let number = value(cursor)?;
        cursor.expect(",", "and the index in the channel behind the logical number")?;
        let index = value(cursor)?;
        let mut options = Vec::new();
        while cursor.eat(",") {
            cursor.skip_blanks();
            let option = cursor.name();
            if option.is_empty() {
                return Err(Error::syntax(cursor.at(), format!("expected an option, found {}", cursor.found())));
            }
            options.push(option.to_owned());
        }
        cursor.expect("]", "behind an axis")?;
        requests.push(Request { name, number, index, options });
        let mut next = *cursor;
        next.eat(",");
        next.skip_blanks();
        if next.peek() != Some('[') {
            return Ok(requests);
        }
        *cursor = next;
    }
}

fn put(cursor: &mut Cursor<'_>, is_by_number: bool) -> Result<HashCommand, Error> {
    if cursor.eat_word("ALL") {
        return Ok(HashCommand::Put(Put::All));
    }
    cursor.expect("[", "or ALL")?;
    let put = if is_by_number {
        let mut numbers = vec![value(cursor)?];
        while cursor.eat(",") {
            numbers.push(value(cursor)?);
        }
        Put::Numbers(numbers)
    } else {
        let mut names = vec![axis_name(cursor)?];
        while cursor.eat(",") {
            names.push(axis_name(cursor)?);
        }
        Put::Names(names)
    };
    cursor.expect("]", "behind the axes")?;
    Ok(HashCommand::Put(put))
}
