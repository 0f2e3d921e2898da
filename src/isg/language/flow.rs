//! Control blocks: `$IF`, `$SWITCH`, `$FOR`, `$WHILE`, `$DO`, `$REPEAT` and what belongs to them.

use super::cursor::Cursor;
use super::expression::{expression, place};
use super::fault::Error;
use super::syntax::Flow;
use super::words::target;

/// Reads a control block; the `$` is next. Nothing for `$GOTO`, which is a word.
pub(super) fn flow(cursor: &mut Cursor<'_>) -> Result<Option<Flow>, Error> {
    let at = cursor.at();
    let mut start = *cursor;
    start.step();
    let name = start.name();
    if name == "GOTO" {
        return Ok(None);
    }
    *cursor = start;
    let flow = match name {
        "IF" => {
            let condition = expression(cursor)?;
            let target = if cursor.eat("$GOTO") { Some(target(cursor)?) } else { None };
            Flow::If(condition, target)
        }
        "ELSEIF" => Flow::ElseIf(expression(cursor)?),
        "ELSE" => Flow::Else,
        "ENDIF" => Flow::EndIf,
        "SWITCH" => {
            let mut assigned = *cursor;
            let variable = match place(&mut assigned)? {
                Some(place) if assigned.eat("=") && assigned.peek() != Some('=') => {
                    *cursor = assigned;
                    Some(place)
                }
                Some(_) | None => None,
            };
            Flow::Switch(variable, expression(cursor)?)
        }
        "CASE" => Flow::Case(expression(cursor)?),
        "DEFAULT" => Flow::Default,
        "ENDSWITCH" => Flow::EndSwitch,
        "FOR" => {
            cursor.skip_blanks();
            let variable = place(cursor)?.ok_or_else(|| {
                let text = format!(
                    "$FOR needs a P parameter or a V. variable, as in `$FOR P1 = 1, 10, 1`; found {}",
                    cursor.found()
                );
                Error::syntax(cursor.at(), text)
            })?;
            cursor.expect("=", "behind the variable of $FOR")?;
            let from = expression(cursor)?;
            cursor.expect(",", "behind the start value of $FOR")?;
            let to = expression(cursor)?;
            cursor.expect(",", "behind the end value of $FOR")?;
            Flow::For { variable, from, to, step: expression(cursor)? }
        }
        "ENDFOR" => Flow::EndFor,
        "WHILE" => Flow::While(expression(cursor)?),
        "ENDWHILE" => Flow::EndWhile,
        "DO" => Flow::Do,
        "ENDDO" => Flow::EndDo(if cursor.is_end() { None } else { Some(expression(cursor)?) }),
        "REPEAT" => Flow::Repeat,
        "UNTIL" => Flow::Until(expression(cursor)?),
        "BREAK" => Flow::Break,
        "CONTINUE" => Flow::Continue,
        _ => {
            let text = format!(
                "${name} is no control block; there are $IF, $ELSEIF, $ELSE, $ENDIF, $SWITCH, $CASE, $DEFAULT, $ENDSWITCH, $FOR, $ENDFOR, $WHILE, \
                 $ENDWHILE, $DO, $ENDDO, $REPEAT, $UNTIL, $BREAK, $CONTINUE, $GOTO"
            );
            return Err(Error::syntax(at, text));
        }
    };
    cursor.expect_end(&format!("${name}"))?;
    Ok(Some(flow))
}
