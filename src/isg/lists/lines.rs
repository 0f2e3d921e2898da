//! Lines of a list: entries of a name and what follows it, without comment lines (HG-28).
//!
//! A comment line begins with `#`, `;` or `(`; `/* … */` also spans lines. What stands behind a name is read by its data type: a whole or
//! fractional number ends at the first blank, and the rest of the line is a comment with or without a mark; behind a word only `(`
//! begins a comment.
//!
//! Decisions. A line that begins with `#` is a comment also without the blank after it: lines of `#####` are frequent. A block comment
//! that begins behind a value ends where `*/` is, also on a later line. A block comment that begins a line and never ends is an error,
//! because it would remove the rest of the list. A number may also end directly at `;`, `(`, `#` or `/*`.

/// A line with an entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Line<'a> {
    /// Its number, from one.
    pub(super) number: u32,
    /// The name of the entry.
    pub(super) name: &'a str,
    /// What follows the name and the `=`, if there is one; empty without a value.
    pub(super) rest: &'a str,
}

/// The entries of a list.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Lines<'a> {
    /// Each line with an entry.
    pub(super) entries: Vec<Line<'a>>,
    /// The line of a block comment that never ends.
    pub(super) unclosed: Option<u32>,
}

/// A word and what follows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Word<'a> {
    /// The word.
    pub(super) text: &'a str,
    /// A text behind it that is neither a part of it nor a comment; empty without one.
    pub(super) ignored: &'a str,
}

/// The entries of a text.
pub(super) fn lines(text: &str) -> Lines<'_> {
    let mut found = Lines::default();
    // The line where the block comment began whose end is searched.
    let mut block: Option<u32> = None;
    let ends = last_end(text);
    for (number, line) in (1_u32..).zip(text.lines()) {
        let mut rest = blanks_removed(line);
        loop {
            if block.is_some() {
                match rest.split_once("*/") {
                    Some((_, after)) => (block, rest) = (None, blanks_removed(after)),
                    None => break,
                }
            }
            match rest.strip_prefix("/*") {
                Some(inside) => (block, rest) = (Some(number), inside),
                None => break,
            }
        }
        if block.is_some() || rest.is_empty() || rest.starts_with(['#', ';', '(']) {
            continue;
        }
        let (name, value) = split(rest);
        // A block comment between name and value, or behind a value.
        let value = match value.strip_prefix("/*").and_then(|inside| inside.split_once("*/")) {
            Some((_, after)) => blanks_removed(after),
            None => value,
        };
        if opens_block(value) && number < ends {
            block = Some(number);
        }
        found.entries.push(Line { number, name, rest: value });
    }
    found.unclosed = block;
    found
}

/// The name at the beginning of a line, and what follows it without an `=`.
fn split(line: &str) -> (&str, &str) {
    let end = line.find(|letter: char| is_blank(letter) || letter == '=').unwrap_or(line.len());
    let (name, rest) = line.split_at(end);
    let rest = blanks_removed(rest);
    (name, blanks_removed(rest.strip_prefix('=').unwrap_or(rest)))
}

/// Whether a value is followed by a block comment that does not end on its line.
fn opens_block(value: &str) -> bool {
    let Some((before, inside)) = value.split_once("/*") else { return false };
    // Behind `#`, `;` or `(` it is the text of a comment.
    !before.contains(['#', ';', '(', '"']) && before.split_whitespace().count() <= 1 && !inside.contains("*/")
}

/// The last line with the end of a block comment; 0 without one.
fn last_end(text: &str) -> u32 {
    (1_u32..).zip(text.lines()).filter(|(_, line)| line.contains("*/")).map(|(number, _)| number).last().unwrap_or(0)
}

/// The number at the beginning of a value; empty if a comment stands there.
pub(super) fn number(rest: &str) -> &str {
    let end = rest.find(|letter: char| is_blank(letter) || matches!(letter, ';' | '(' | '#')).unwrap_or(rest.len());
    let number = &rest[..end];
    number.split_once("/*").map_or(number, |(number, _)| number)
}

/// The word at the beginning of a value. A word that holds `(` stands in double quotes.
///
/// # Errors
/// The second quote is missing.
pub(super) fn word(rest: &str) -> Result<Word<'_>, String> {
    if let Some(inside) = rest.strip_prefix('"') {
        let Some((text, _)) = inside.split_once('"') else {
            return Err(format!("a second quote, found `{rest}`"));
        };
        return Ok(Word { text, ignored: "" });
    }
    // A comment line has no value before it.
    if rest.starts_with(['#', ';']) {
        return Ok(Word { text: "", ignored: "" });
    }
    let value = rest.split_once('(').map_or(rest, |(value, _)| value);
    let value = blanks_removed(value);
    match value.split_once(is_blank) {
        Some((text, ignored)) => Ok(Word { text, ignored: blanks_removed(ignored) }),
        None => Ok(Word { text: value, ignored: "" }),
    }
}

fn is_blank(letter: char) -> bool {
    letter.is_whitespace() || letter.is_control()
}

fn blanks_removed(text: &str) -> &str {
    text.trim_matches(is_blank)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries(text: &str) -> Vec<(u32, &str, &str)> {
        lines(text).entries.into_iter().map(|line| (line.number, line.name, line.rest)).collect()
    }

    /// HG-28, B54: comment lines of each kind, and `=`.
    #[test]
    fn comment_lines_are_no_entries() {
        let text =
            "# a 1\n; a 1\n( a 1\n\n#\n####\n/* a 1\n a 2 */ b 3\n/* c */\n  d\t4\r\ne = 5\nf=6\n/**/ /**/ g 7\n\u{1a}";
        let expected = [(8, "b", "3"), (10, "d", "4"), (11, "e", "5"), (12, "f", "6"), (13, "g", "7")];
        assert_eq!(entries(text), expected);
    }

    /// HG-28: a block comment behind a value ends on a later line, if it ends at all.
    #[test]
    fn a_block_comment_behind_a_value_may_span_lines() {
        assert_eq!(entries("a 1 /* x\nb 2 */ c 3\n"), [(1, "a", "1 /* x"), (2, "c", "3")]);
        assert_eq!(entries("a 1 /* x\nb 2\n"), [(1, "a", "1 /* x"), (2, "b", "2")]);
        assert_eq!(entries("a 1 # /* x\nb 2\n# */\n").len(), 2);
        assert_eq!(entries("a /* x */ 1"), [(1, "a", "1")]);
        assert_eq!(lines("a 1\n/* x\nb 2").unclosed, Some(2));
        assert_eq!(lines("a 1\n/* x */\nb 2").unclosed, None);
    }

    /// HG-28, B54: behind a number everything is a comment.
    #[test]
    fn a_number_ends_at_the_first_blank() {
        for rest in ["12 text", "12", "12 # x", "12 ( x", "12 ; x", "12 /* x */", "12;", "12(x)", "12/* x */", "12\tx"]
        {
            assert_eq!(number(rest), "12", "{rest}");
        }
        assert_eq!(number("# x"), "");
        assert_eq!(number("1/2"), "1/2");
    }

    /// HG-28, B54: behind a word only `(` begins a comment.
    #[test]
    fn a_word_ends_at_a_bracket() {
        let read = |rest| word(rest).map(|word| (word.text, word.ignored));
        assert_eq!(read("CONFIG"), Ok(("CONFIG", "")));
        assert_eq!(read("CONFIG ( x"), Ok(("CONFIG", "")));
        assert_eq!(read("CONFIG(x)"), Ok(("CONFIG", "")));
        assert_eq!(read("CONFIG # x"), Ok(("CONFIG", "# x")));
        assert_eq!(read("CONFIG /* x */"), Ok(("CONFIG", "/* x */")));
        assert_eq!(read("CONFIG;"), Ok(("CONFIG;", "")));
        assert_eq!(read("\"A(1)\" x"), Ok(("A(1)", "")));
        assert_eq!(read("( x"), Ok(("", "")));
        assert_eq!(read("# x"), Ok(("", "")));
        assert!(read("\"A").is_err());
    }
}
