//! A place in the text of a block. Comments are blanks already.

use super::fault::Error;

/// How much of the text an error message quotes.
const QUOTED: usize = 24;

#[derive(Clone, Copy, Debug)]
pub(super) struct Cursor<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Cursor<'a> {
    /// A place in a text: a byte at which a letter begins, else the end.
    pub(super) fn new(text: &'a str, at: usize) -> Self {
        Self { text, at: if text.is_char_boundary(at) { at } else { text.len() } }
    }

    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// The same text at another place.
    pub(super) fn moved(self, at: usize) -> Self {
        Self::new(self.text, at)
    }

    pub(super) fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    pub(super) fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    pub(super) fn skip_blanks(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }

    /// Whether only blanks follow; skips them.
    pub(super) fn is_end(&mut self) -> bool {
        self.skip_blanks();
        self.rest().is_empty()
    }

    /// Skips blanks, then this text if it follows.
    pub(super) fn eat(&mut self, text: &str) -> bool {
        let mut next = *self;
        next.skip_blanks();
        let follows = next.rest().starts_with(text);
        if follows {
            self.at = next.at + text.len();
        }
        follows
    }

    /// Skips blanks, then this word if it follows and ends there.
    pub(super) fn eat_word(&mut self, word: &str) -> bool {
        let mut next = *self;
        next.skip_blanks();
        let is_it = next.name() == word;
        if is_it {
            *self = next;
        }
        is_it
    }

    /// Letters, digits and underscores; empty if something else follows.
    pub(super) fn name(&mut self) -> &'a str {
        self.while_letters(|letter| letter.is_ascii_alphanumeric() || letter == '_')
    }

    pub(super) fn digits(&mut self) -> &'a str {
        self.while_letters(|letter| letter.is_ascii_digit())
    }

    pub(super) fn while_letters(&mut self, is_part: impl Fn(char) -> bool) -> &'a str {
        let rest = self.rest();
        let end = rest.find(|letter| !is_part(letter)).unwrap_or(rest.len());
        self.at += end;
        &rest[..end]
    }

    /// Steps over one letter.
    pub(super) fn step(&mut self) {
        self.at += self.peek().map_or(0, char::len_utf8);
    }

    /// What follows, for a message.
    pub(super) fn found(&self) -> String {
        let rest = self.rest().trim();
        if rest.is_empty() {
            return "the end of the line".to_owned();
        }
        let word = rest.split_whitespace().next().unwrap_or(rest);
        format!("`{}`", word.chars().take(QUOTED).collect::<String>())
    }

    /// Skips blanks, then this text, which must follow.
    pub(super) fn expect(&mut self, text: &str, place: &str) -> Result<(), Error> {
        if self.eat(text) {
            return Ok(());
        }
        self.skip_blanks();
        Err(Error::syntax(self.at, format!("expected `{text}` {place}, found {}", self.found())))
    }

    /// Only blanks may follow.
    pub(super) fn expect_end(&mut self, behind: &str) -> Result<(), Error> {
        if self.is_end() {
            return Ok(());
        }
        Err(Error::syntax(self.at, format!("expected the end of the line behind {behind}, found {}", self.found())))
    }
}
