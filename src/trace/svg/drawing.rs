//! A drawing under construction: its lines, texts and rectangles, and the width of texts.

use std::fmt::Write as _;

/// Tenths of a pixel, the unit of all coordinates.
pub(super) type Tenths = i64;

/// Width of the whole drawing.
pub(super) const WIDTH: Tenths = 13_200;
/// The margin at every side.
pub(super) const MARGIN: Tenths = 240;
/// The gap between the names and the waves.
pub(super) const GAP: Tenths = 140;
/// The width of a character in names (11 px) and in small texts (10 px).
pub(super) const LETTER: Tenths = 67;
pub(super) const SMALL_LETTER: Tenths = 61;

/// A number of tenths as pixels with one decimal.
pub(super) fn px(tenths: Tenths) -> String {
    let sign = if tenths < 0 { "-" } else { "" };
    let digits = tenths.unsigned_abs();
    match digits % 10 {
        0 => format!("{sign}{}", digits / 10),
        tenth => format!("{sign}{}.{tenth}", digits / 10),
    }
}

/// A text with XML escapes; characters that XML does not allow, and those that reverse the direction of a text, become the replacement character.
pub(super) fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\n' | '\r' | '\t' => escaped.push(' '),
            '\u{FFFE}' | '\u{FFFF}' => escaped.push('\u{FFFD}'),
            // These reverse the direction of the text after them.
            '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}' => escaped.push('\u{FFFD}'),
            letter if letter.is_control() => escaped.push('\u{FFFD}'),
            letter => escaped.push(letter),
        }
    }
    escaped
}

/// The width of a text.
pub(super) fn width_of(text: &str, letter: Tenths) -> Tenths {
    i64::try_from(text.chars().count()).unwrap_or(i64::MAX / 1000) * letter
}

/// A text in lines with a maximum number of characters, broken between words.
pub(super) fn wrapped(text: &str, letters: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= letters => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// A drawing under construction.
pub(super) struct Drawing {
    pub(super) text: String,
    /// The position of the next element.
    pub(super) y: Tenths,
    /// The left end of the waves.
    pub(super) left: Tenths,
}

impl Drawing {
    pub(super) fn line(&mut self, class: &str, from: (Tenths, Tenths), to: (Tenths, Tenths)) {
        let (x1, y1, x2, y2) = (px(from.0), px(from.1), px(to.0), px(to.1));
        let _ = writeln!(self.text, r#"<path class="{class}" d="M{x1} {y1}L{x2} {y2}"/>"#);
    }

    pub(super) fn text(&mut self, class: &str, (x, y): (Tenths, Tenths), text: &str) {
        let _ = writeln!(self.text, r#"<text class="{class}" x="{}" y="{}">{}</text>"#, px(x), px(y), escaped(text));
    }

    pub(super) fn rect(
        &mut self,
        class: &str,
        (x, y): (Tenths, Tenths),
        (width, height): (Tenths, Tenths),
        title: &str,
    ) {
        let place = format!(r#"x="{}" y="{}" width="{}" height="{}""#, px(x), px(y), px(width), px(height));
        let _ = if title.is_empty() {
            writeln!(self.text, r#"<rect class="{class}" {place}/>"#)
        } else {
            writeln!(self.text, r#"<rect class="{class}" {place}><title>{}</title></rect>"#, escaped(title))
        };
    }
}
