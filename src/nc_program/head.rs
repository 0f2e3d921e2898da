//! The beginning of a block: skip level, block number, label. Jumps, searches and the parser all read it here.
//!
//! `[/n] [N<number> | :<number>] [label:] words [;comment]`

use super::alarm::{Fault, Span};

/// The beginning of a block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Head<'a> {
    /// The digits after `/`; `/` alone is `/0`.
    pub(super) skip: Option<&'a str>,
    pub(super) number: Option<Number<'a>>,
    pub(super) label: Option<&'a str>,
    /// Where the words begin.
    pub(super) rest: usize,
    pub(super) skip_at: Span,
    pub(super) label_at: Span,
}

/// `N10`, or `:10` of a main block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Number<'a> {
    pub(super) is_main: bool,
    /// Without leading zeros.
    pub(super) digits: &'a str,
}

impl Number<'_> {
    pub(super) fn text(&self) -> String {
        format!("{}{}", if self.is_main { ':' } else { 'N' }, self.digits)
    }
}

/// Reads the beginning of a block.
pub(super) fn head(line: &str) -> Head<'_> {
    let mut head = Head::default();
    let mut at = blank(line, 0);
    if line[at..].starts_with('/') {
        let end = run(line, at + 1, |byte| byte.is_ascii_digit());
        let digits = &line[at + 1..end];
        head.skip = Some(if digits.is_empty() { "0" } else { digits });
        head.skip_at = span(at, end);
        at = blank(line, end);
    }
    let first = line.as_bytes().get(at).copied().unwrap_or(0);
    if matches!(first, b'N' | b'n' | b':') {
        let digits = if first == b':' { blank(line, at + 1) } else { at + 1 };
        let end = run(line, digits, |byte| byte.is_ascii_digit());
        // A machine axis or a variable could begin with `N1`; a block number is not assigned.
        let is_number = end > digits && !line[blank(line, end)..].starts_with('=');
        if is_number {
            head.number = Some(Number { is_main: first == b':', digits: significant(&line[digits..end]) });
            at = blank(line, end);
        }
    }
    let end = run(line, at, |byte| byte.is_ascii_alphanumeric() || byte == b'_');
    if line[end..].starts_with(':') && is_label(&line[at..end]) {
        head.label = Some(&line[at..end]);
        head.label_at = span(at, end);
        at = blank(line, end + 1);
    }
    head.rest = at;
    head
}

impl Head<'_> {
    /// The name of the block in alarms: its number, else its label, else its line.
    pub(super) fn name(&self, line: u32) -> String {
        match (self.number, self.label) {
            (Some(number), _) => number.text(),
            (None, Some(label)) => label.to_ascii_uppercase(),
            (None, None) => line.to_string(),
        }
    }

    /// The skip level.
    pub(super) fn skip_level(&self, highest: u8) -> Result<Option<u8>, Fault> {
        let Some(digits) = self.skip else { return Ok(None) };
        match digits.parse::<u8>() {
            Ok(level) if level <= highest => Ok(Some(level)),
            Ok(_) | Err(_) => {
                Err(Fault::new(14060, self.skip_at, format!("`/{digits}`: the levels are 0 to {highest}")))
            }
        }
    }
}

/// Whether a text may be a label: the first two characters are letters or `_`. Its length is tested by the parser.
fn is_label(text: &str) -> bool {
    let letters = text.bytes().take(2).filter(|byte| byte.is_ascii_alphabetic() || *byte == b'_').count();
    text.len() >= 2 && letters == 2
}

/// The first word of the words: letters, digits and `_`.
pub(super) fn word(line: &str, from: usize) -> &str {
    let from = from.min(line.len());
    &line[from..run(line, from, |byte| byte.is_ascii_alphanumeric() || byte == b'_')]
}

/// Digits without leading zeros.
pub(super) fn significant(digits: &str) -> &str {
    let significant = digits.trim_start_matches('0');
    if significant.is_empty() { "0" } else { significant }
}

fn blank(line: &str, from: usize) -> usize {
    run(line, from, |byte| matches!(byte, b' ' | b'\t' | b'\r'))
}

/// The end of the bytes with a property. They are ASCII, so the end is the start of a character.
fn run(line: &str, from: usize, has: impl Fn(u8) -> bool) -> usize {
    from + line.as_bytes()[from.min(line.len())..].iter().take_while(|byte| has(**byte)).count()
}

fn span(from: usize, to: usize) -> Span {
    let short = |index: usize| u32::try_from(index).unwrap_or(u32::MAX);
    Span { from: short(from), to: short(to) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(line: &str) -> (Option<&str>, Option<String>, Option<&str>, &str) {
        let head = head(line);
        (head.skip, head.number.map(|number| number.text()), head.label, &line[head.rest..])
    }

    #[test]
    fn skip_number_and_label_are_read_in_this_order() {
        let n = |text: &str| Some(text.to_owned());
        for (line, expected) in [
            ("N10 G1 X5", (None, n("N10"), None, "G1 X5")),
            ("  /3 N010 START: X5", (Some("3"), n("N10"), Some("START"), "X5")),
            ("/N10 X5", (Some("0"), n("N10"), None, "X5")),
            (":20 M30", (None, n(":20"), None, "M30")),
            ("_A:", (None, None, Some("_A"), "")),
            ("NAME(1)", (None, None, None, "NAME(1)")),
            ("N1=5", (None, None, None, "N1=5")),
            ("A1: X5", (None, None, None, "A1: X5")),
            ("", (None, None, None, "")),
        ] {
            assert_eq!(read(line), expected, "{line}");
        }
        assert_eq!(head("N10 AB: X").name(7), "N10");
        assert_eq!(head("ab: X").name(7), "AB");
        assert_eq!(head("X").name(7), "7");
    }
}
