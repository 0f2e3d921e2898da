//! Lines of a program as the language reads them: comments are blanks, `\` at the end continues a line.
//!
//! `( … )` and `;` begin comments; each further `(` in a comment needs a `)` of its own, and an unclosed comment ends with its line. A block
//! number at the beginning of a continued line means nothing. With `lenient` the text is read as the manuals print it: an unclosed
//! `(` reaches over further lines if one of them closes it, `#` before a blank begins a comment, and `)` alone means nothing.

use std::borrow::Cow;

use crate::nc_program::Program;

use super::cursor::Cursor;

/// A block of a program, perhaps on several lines.
#[derive(Clone, Debug)]
pub(super) struct Line<'a> {
    program: &'a Program,
    /// Without comments; the bytes have the places of the text.
    pub(super) text: Cow<'a, str>,
    /// The byte of the first `\` that continues the block.
    pub(super) broken: Option<usize>,
    /// Where the parts of the text begin, and the lines that they are.
    parts: Vec<(usize, u32)>,
    /// The first line.
    pub(super) line: u32,
    /// The line behind it.
    pub(super) next: u32,
}

impl<'a> Line<'a> {
    /// The block that begins in a line.
    pub(super) fn read(program: &'a Program, line: u32, lenient: bool) -> Option<Self> {
        let raw = program.line(line)?;
        let mut block = Self {
            program,
            text: Cow::Borrowed(""),
            broken: None,
            parts: vec![(0, line)],
            line,
            next: line.saturating_add(1),
        };
        let (mut text, mut depth) = without_comments(raw, 0, lenient);
        loop {
            let before = block.text.len();
            block.text = if before == 0 { text } else { Cow::Owned(block.text.into_owned() + &text) };
            let last = block.next - 1;
            let (next, from) = if lenient
                && depth > 0
                && let Some(end) = comment_end(program, block.next, depth)
            {
                end
            } else if block.text.trim_end().ends_with('\\') {
                let end = block.text.trim_end().len() - 1;
                block.broken = block.broken.or(Some(end));
                let mut without = block.text.into_owned();
                without.replace_range(end..=end, " ");
                block.text = Cow::Owned(without);
                (last.saturating_add(1), 0)
            } else {
                return Some(block);
            };
            let Some(raw) = program.line(next) else { return Some(block) };
            let is_continued = from == 0;
            // One blank between the lines, so that words of two lines stay two words.
            let mut joined = block.text.into_owned();
            joined.push(' ');
            block.parts.push((joined.len(), next));
            block.text = Cow::Owned(joined);
            block.next = next.saturating_add(1);
            (text, depth) = without_comments(raw, from, lenient);
            if is_continued {
                text = without_number(text);
            }
        }
    }

    /// The line and the column of a byte of the text, counted from one.
    pub(super) fn place(&self, at: usize) -> (u32, u32) {
        let index = self.parts.partition_point(|(start, _)| *start <= at).saturating_sub(1);
        let (start, line) = self.parts.get(index).copied().unwrap_or((0, self.line));
        let raw = self.program.line(line).unwrap_or_default();
        let column = raw.char_indices().take_while(|(byte, _)| *byte < at - start.min(at)).count() + 1;
        (line, u32::try_from(column).unwrap_or(u32::MAX))
    }

    /// The byte at which something stands.
    pub(super) fn indent(&self) -> usize {
        self.text.len() - self.text.trim_start().len()
    }

    /// The text of the first line as it was written.
    pub(super) fn source(&self) -> &'a str {
        self.program.line(self.line).unwrap_or_default()
    }

    /// The line is `#COMMENT BEGIN`, perhaps with something behind it.
    pub(super) fn begins_comment(&self) -> Option<Cursor<'_>> {
        comment_mark(&self.text, "BEGIN")
    }

    /// The line is `#COMMENT END`, perhaps with something behind it.
    pub(super) fn ends_comment(&self) -> Option<Cursor<'_>> {
        comment_mark(&self.text, "END")
    }

    /// The line is `#COMMENT BEGIN` or `#COMMENT END`.
    pub(super) fn is_comment(&self) -> bool {
        self.begins_comment().is_some() || self.ends_comment().is_some()
    }

    /// The line of the `#COMMENT END` that belongs to this `#COMMENT BEGIN`, and whether something stands behind it.
    pub(super) fn comment_end(&self) -> Option<(u32, bool)> {
        (self.next..=self.program.count()).find_map(|number| {
            let (text, _) = without_comments(self.program.line(number)?, 0, false);
            comment_mark(&text, "END").map(|mut behind| (number, !behind.is_end()))
        })
    }
}

/// The blocks of a program from a line on, without those between `#COMMENT BEGIN` and `#COMMENT END`.
pub(super) struct Lines<'a> {
    program: &'a Program,
    line: u32,
    lenient: bool,
}

impl<'a> Lines<'a> {
    pub(super) fn new(program: &'a Program, line: u32, lenient: bool) -> Self {
        Self { program, line, lenient }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        let line = Line::read(self.program, self.line, self.lenient)?;
        self.line = line.next;
        if line.begins_comment().is_some() {
            (self.line, _) = line.comment_end()?;
        }
        Some(line)
    }
}

/// What stands behind `#COMMENT BEGIN` or `#COMMENT END`.
fn comment_mark<'a>(text: &'a str, word: &str) -> Option<Cursor<'a>> {
    let mut cursor = Cursor::new(text, 0);
    cursor.skip_blanks();
    if cursor.rest().strip_prefix('N').is_some_and(|rest| rest.starts_with(|next: char| next.is_ascii_digit())) {
        cursor.step();
        cursor.digits();
    }
    let is_comment = cursor.eat("#COMMENT") && cursor.peek().is_some_and(char::is_whitespace);
    (is_comment && cursor.eat_word(word)).then_some(cursor)
}

/// The text of a continued line with blanks for its block number.
fn without_number(text: Cow<'_, str>) -> Cow<'_, str> {
    let start = text.len() - text.trim_start().len();
    let digits = |rest: &str| rest.bytes().take_while(u8::is_ascii_digit).count();
    let count = text[start..].strip_prefix(['N', 'n']).map_or(0, digits);
    if count == 0 {
        return text;
    }
    let mut text = text.into_owned();
    text.replace_range(start..=start + count, &" ".repeat(count + 1));
    Cow::Owned(text)
}

/// The byte behind the `)` that closes comments of this depth, else how many are open at the end of the text.
fn closed(text: &str, mut depth: usize) -> Result<usize, usize> {
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'(' => depth += 1,
            b')' if depth == 1 => return Ok(at + 1),
            b')' => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    Err(depth)
}

/// The text with blanks for comments, and how many comments in each other are not closed. Everything before `from` is a comment.
fn without_comments(raw: &str, from: usize, lenient: bool) -> (Cow<'_, str>, usize) {
    if from == 0 && !raw.contains(['(', ';', '#', ')']) {
        return (Cow::Borrowed(raw), 0);
    }
    let mut text = String::with_capacity(raw.len());
    let (mut hidden_to, mut open, mut is_quoted) = (from, 0, false);
    for (at, letter) in raw.char_indices() {
        if at >= hidden_to {
            let rest = &raw[at..];
            match letter {
                '"' => is_quoted = !is_quoted,
                _ if is_quoted => {}
                '(' => {
                    (hidden_to, open) = match closed(rest, 0) {
                        Ok(end) => (at + end, 0),
                        Err(depth) => (raw.len(), depth),
                    };
                }
                ';' => hidden_to = raw.len(),
                ')' if lenient => hidden_to = at + 1,
                '#' if lenient && !rest[1..].starts_with(|next: char| !next.is_whitespace()) => hidden_to = raw.len(),
                _ => {}
            }
        }
        if at < hidden_to {
            text.extend(std::iter::repeat_n(' ', letter.len_utf8()));
        } else {
            text.push(letter);
        }
    }
    (Cow::Owned(text), open)
}

/// Where comments of a depth end that were not closed in the line before: the line, and the byte behind the last `)`. As in one line, each `(`
/// needs a `)` of its own. A line that looks like a block ends the search.
fn comment_end(program: &Program, from: u32, mut depth: usize) -> Option<(u32, usize)> {
    for number in from..=program.count() {
        let raw = program.line(number)?;
        let text = raw.trim_start();
        let is_numbered =
            text.strip_prefix('N').is_some_and(|rest| rest.starts_with(|next: char| next.is_ascii_digit()));
        if text.is_empty() || is_numbered || text.starts_with(['%', '#', '(', ';', ':']) {
            return None;
        }
        match closed(raw, depth) {
            Ok(end) => return Some((number, end)),
            Err(open) => depth = open,
        }
    }
    None
}
