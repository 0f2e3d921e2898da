//! The content of a block: words, a command, or a control block.

use super::commands::{behind_words, command, manual};
use super::cursor::Cursor;
use super::fault::Error;
use super::flow::flow;
use super::syntax::{Content, Word, WordKind};
use super::words::words;

/// Reads the content of a block from a byte of its line on.
pub(super) fn content(text: &str, from: usize, lenient: bool) -> Result<Content, Error> {
    let mut cursor = Cursor::new(text, from);
    if cursor.is_end() || lenient && cursor.rest().trim() == ":" {
        return Ok(Content::Empty);
    }
    // The variables between these lines are written like everywhere else.
    if matches!(cursor.rest().trim(), "#VAR" | "#ENDVAR") {
        return Ok(Content::Empty);
    }
    match cursor.peek() {
        Some('#') => return command(&mut cursor, lenient).map(Content::Command),
        Some('$') => {
            if let Some(flow) = flow(&mut cursor)? {
                return Ok(Content::Flow(flow));
            }
        }
        Some(':') => {
            let text = "`:` alone is no block; a manual writes it for blocks that it leaves out";
            return Err(Error::syntax(cursor.at(), text));
        }
        Some(_) | None => {}
    }
    let words = words(&mut cursor)?;
    if cursor.peek() != Some('#') {
        return Ok(Content::Words(words));
    }
    match words.as_slice() {
        [Word { kind: WordKind::G(number @ (201 | 202)), .. }] => {
            manual(&mut cursor, *number == 201).map(Content::Command)
        }
        _ => Err(behind_words(&mut cursor, lenient)),
    }
}
