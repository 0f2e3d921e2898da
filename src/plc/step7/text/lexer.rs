//! The words of a source. The parser asks for one token at a time, because the same letters mean different things at the beginning of a
//! statement (`A`, `=`, `+I`), in an operand (`A 4.0`) and in a title.

use super::finding::At;

/// A position in the text of a file, from which tokens are read. A copy is a place to return to.
#[derive(Clone, Copy, Debug)]
pub(in crate::plc::step7) struct Cursor<'a> {
    text: &'a str,
    offset: usize,
    at: At,
}

/// A token of an operand or of a declaration.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::plc::step7) enum Token<'a> {
    /// A name, a keyword, an area: `VAR_INPUT`, `MW`, `DB10`.
    Word(&'a str),
    /// Digits, with a fraction and an exponent: `10`, `10.3`, `1.5e+3`.
    Number(&'a str),
    /// A symbol: `"Motor on"`.
    Quoted(&'a str),
    /// A text: `'ABC'`, with `$` already resolved.
    Text(String),
    /// A local name: `#start`.
    Local(&'a str),
    /// A constant with its type: `W#16#1F`, `2#1010`; of `P#…` and `B#(…)` only the type.
    Typed(&'a str, &'a str),
    /// One of `:= : = ( ) [ ] { } , ; .. . + - * / < > == <> >= <=`, or any other character.
    Symbol(&'a str),
    /// A quotation that its line does not end.
    Open(&'a str),
    /// The end of the file.
    End,
}

impl Token<'_> {
    /// The token as text for a message.
    pub(in crate::plc::step7) fn found(&self) -> String {
        match self {
            Self::Word(text) | Self::Number(text) | Self::Symbol(text) => format!("`{text}`"),
            Self::Quoted(text) => format!("the symbol \"{text}\""),
            Self::Text(text) => format!("the text '{text}'"),
            Self::Local(text) => format!("`#{text}`"),
            Self::Typed(kind, rest) => format!("`{kind}#{rest}`"),
            Self::Open(quote) => format!("a quotation without its closing {quote}"),
            Self::End => "the end of the file".to_owned(),
        }
    }
}

/// Symbols of two characters.
const PAIRS: [&str; 6] = [":=", "..", "==", "<>", ">=", "<="];

impl<'a> Cursor<'a> {
    pub(in crate::plc::step7) fn new(text: &'a str, file: u16) -> Self {
        Self { text, offset: 0, at: At { file, line: 1, column: 1 } }
    }

    fn rest(&self) -> &'a str {
        &self.text[self.offset..]
    }

    fn first(&self) -> Option<char> {
        self.rest().chars().next()
    }

    /// Skips bytes of the rest, which end at a character.
    fn skip(&mut self, bytes: usize) {
        for letter in self.rest()[..bytes].chars() {
            if letter == '\n' {
                self.at.line += 1;
                self.at.column = 1;
            } else {
                self.at.column += 1;
            }
        }
        self.offset += bytes;
    }

    /// Takes characters as long as they fit.
    fn take(&mut self, mut fits: impl FnMut(char) -> bool) -> &'a str {
        let rest = self.rest();
        let end = rest.find(|letter| !fits(letter)).unwrap_or(rest.len());
        self.skip(end);
        &rest[..end]
    }

    /// Skips blanks, line ends and comments.
    pub(in crate::plc::step7) fn skip_blanks(&mut self) {
        loop {
            self.take(|letter| letter.is_whitespace() || letter == '\u{1a}');
            if !self.rest().starts_with("//") {
                return;
            }
            self.take(|letter| letter != '\n');
        }
    }

    /// The place of the next token.
    pub(in crate::plc::step7) fn at(&mut self) -> At {
        self.skip_blanks();
        self.at
    }

    /// The rest of this line, as titles have it.
    pub(in crate::plc::step7) fn rest_of_line(&mut self) -> &'a str {
        self.take(|letter| letter != '\n').trim()
    }

    /// The next token, which stays.
    pub(in crate::plc::step7) fn peek(&self) -> Token<'a> {
        let mut copy = *self;
        copy.next()
    }

    /// The next token.
    pub(in crate::plc::step7) fn next(&mut self) -> Token<'a> {
        self.skip_blanks();
        let Some(first) = self.first() else { return Token::End };
        match first {
            '"' => self.quoted(),
            '\'' => self.characters(),
            '#' => {
                self.skip(1);
                match self.first() {
                    Some(letter) if is_name(letter) => Token::Local(self.take(is_name)),
                    Some('"') => match self.quoted() {
                        Token::Quoted(name) => Token::Local(name),
                        other => other,
                    },
                    _ => Token::Symbol("#"),
                }
            }
            '0'..='9' => self.number(),
            letter if letter.is_alphabetic() || letter == '_' => {
                let word = self.take(is_name);
                if self.rest().starts_with('#') { self.typed(word) } else { Token::Word(word) }
            }
            _ => self.symbol(first),
        }
    }

    fn symbol(&mut self, first: char) -> Token<'a> {
        let rest = self.rest();
        let length = if PAIRS.iter().any(|pair| rest.starts_with(pair)) { 2 } else { first.len_utf8() };
        self.skip(length);
        Token::Symbol(&rest[..length])
    }

    fn quoted(&mut self) -> Token<'a> {
        self.skip(1);
        let name = self.take(|letter| letter != '"' && letter != '\n');
        if !self.rest().starts_with('"') {
            return Token::Open("\"");
        }
        self.skip(1);
        Token::Quoted(name.trim_end())
    }

    /// A text in single quotes: `$$`, `$'`, `$L`, `$N`, `$P`, `$R`, `$T` and `$41` stand for one character.
    fn characters(&mut self) -> Token<'a> {
        self.skip(1);
        let mut text = String::new();
        loop {
            let Some(letter) = self.first().filter(|&letter| letter != '\n') else { return Token::Open("'") };
            self.skip(letter.len_utf8());
            match letter {
                '\'' => return Token::Text(text),
                '$' => text.push(self.escaped()),
                letter => text.push(letter),
            }
        }
    }

    fn escaped(&mut self) -> char {
        let rest = self.rest();
        if let Some(code) = rest.get(..2).and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
            self.skip(2);
            return char::from(code);
        }
        let Some(letter) = self.first().filter(|&letter| letter != '\n') else { return '$' };
        self.skip(letter.len_utf8());
        match letter {
            'L' | 'l' | 'N' | 'n' => '\n',
            'P' | 'p' => '\u{c}',
            'R' | 'r' => '\r',
            'T' | 't' => '\t',
            letter => letter,
        }
    }

    fn number(&mut self) -> Token<'a> {
        let rest = self.rest();
        let digits = |from: usize| {
            rest[from..]
                .find(|letter: char| !letter.is_ascii_digit() && letter != '_')
                .map_or(rest.len(), |end| from + end)
        };
        let is_digit = |at: usize| rest.as_bytes().get(at).is_some_and(u8::is_ascii_digit);
        let mut end = digits(0);
        if rest[end..].starts_with('#') {
            self.skip(end);
            return self.typed(&rest[..end]);
        }
        if rest[end..].starts_with('.') && is_digit(end + 1) {
            end = digits(end + 1);
        }
        if rest[end..].starts_with(['e', 'E']) {
            let sign = usize::from(rest[end + 1..].starts_with(['+', '-']));
            if is_digit(end + 1 + sign) {
                end = digits(end + 1 + sign);
            }
        }
        self.skip(end);
        Token::Number(&rest[..end])
    }

    /// What follows a type and its `#`.
    fn typed(&mut self, kind: &'a str) -> Token<'a> {
        self.skip(1);
        if kind.eq_ignore_ascii_case("P") {
            if !self.rest().starts_with('#') {
                return Token::Typed(kind, "");
            }
            self.skip(1);
            return Token::Typed("P#", self.take(is_name));
        }
        Token::Typed(kind, self.take(|letter| is_name(letter) || matches!(letter, '#' | '.' | ':' | '+' | '-')))
    }

    /// A label at the beginning of a statement, with its colon.
    pub(in crate::plc::step7) fn label(&mut self) -> Option<&'a str> {
        self.skip_blanks();
        let mut ahead = *self;
        if !ahead.first().is_some_and(|letter| letter.is_alphabetic() || letter == '_') {
            return None;
        }
        let name = ahead.take(is_name);
        ahead.take(|letter| letter == ' ' || letter == '\t');
        if !ahead.rest().starts_with(':') || ahead.rest().starts_with(":=") {
            return None;
        }
        ahead.skip(1);
        *self = ahead;
        Some(name)
    }

    /// The operation at the beginning of a statement, in capitals: `A`, `U(`, `==I`, `+AR1`, `RND+`, `)MCR`.
    pub(in crate::plc::step7) fn operation(&mut self) -> String {
        self.skip_blanks();
        match self.first() {
            Some(letter) if letter.is_alphabetic() || letter == '_' => self.word_operation(),
            Some(')') => {
                self.skip(1);
                let mut ahead = *self;
                if ahead.take(is_name).eq_ignore_ascii_case("MCR") {
                    *self = ahead;
                    return ")MCR".to_owned();
                }
                ")".to_owned()
            }
            Some(first) => self.sign_operation(first),
            None => String::new(),
        }
    }

    fn word_operation(&mut self) -> String {
        let mut operation = self.take(is_name).to_uppercase();
        match operation.as_str() {
            "RND" if self.rest().starts_with(['+', '-']) => operation.push_str(self.take_one()),
            "A" | "AN" | "U" | "UN" | "O" | "ON" | "X" | "XN" | "MCR" => {
                let mut ahead = *self;
                ahead.take(|letter| letter == ' ' || letter == '\t');
                if ahead.rest().starts_with('(') {
                    ahead.skip(1);
                    *self = ahead;
                    operation.push('(');
                }
            }
            _ => {}
        }
        operation
    }

    fn take_one(&mut self) -> &'a str {
        let mut left = 1;
        self.take(|_| {
            left -= 1;
            left >= 0
        })
    }

    fn sign_operation(&mut self, first: char) -> String {
        let signs = self.take(|letter| matches!(letter, '=' | '<' | '>'));
        let signs = if signs.is_empty() { self.take_one() } else { signs };
        let mut operation = signs.to_owned();
        if operation == "=" {
            return operation;
        }
        let mut ahead = *self;
        let word = ahead.take(is_name).to_uppercase();
        let belongs = match first {
            '=' | '<' | '>' | '*' | '/' | '-' => matches!(word.as_str(), "I" | "D" | "R"),
            '+' => matches!(word.as_str(), "I" | "D" | "R" | "AR1" | "AR2"),
            _ => false,
        };
        if belongs {
            *self = ahead;
            operation.push_str(&word);
        }
        operation
    }

    /// Skips to the end of the statement, after its semicolon, or to a word that ends or begins a part of a block.
    pub(in crate::plc::step7) fn skip_statement(&mut self) {
        loop {
            let before = *self;
            match self.next() {
                Token::Symbol(";") | Token::End => return,
                Token::Word(word) if is_border(word) => {
                    *self = before;
                    return;
                }
                _ => {}
            }
        }
    }
}

/// Whether a word cannot be part of a statement.
pub(in crate::plc::step7) fn is_border(word: &str) -> bool {
    let word = word.to_ascii_uppercase();
    matches!(
        word.as_str(),
        "NETWORK"
            | "BEGIN"
            | "END_ORGANIZATION_BLOCK"
            | "END_FUNCTION_BLOCK"
            | "END_FUNCTION"
            | "END_DATA_BLOCK"
            | "END_TYPE"
            | "END_SYSTEM_FUNCTION"
            | "END_SYSTEM_FUNCTION_BLOCK"
            | "ORGANIZATION_BLOCK"
            | "FUNCTION_BLOCK"
            | "FUNCTION"
            | "DATA_BLOCK"
    )
}

fn is_name(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tokens(text: &str) -> Vec<Token<'_>> {
        let mut cursor = Cursor::new(text, 0);
        std::iter::from_fn(|| Some(cursor.next()).filter(|token| *token != Token::End)).collect()
    }

    #[test]
    fn addresses_constants_and_comments_are_told_apart() {
        use Token::{Number, Symbol, Typed, Word};
        assert_eq!(tokens("M      20.0 // a; b\r\n;"), [Word("M"), Number("20.0"), Symbol(";")]);
        assert_eq!(tokens("DB100.DBX3.0"), [Word("DB100"), Symbol("."), Word("DBX3"), Symbol("."), Number("0")]);
        assert_eq!(tokens("2#1010_0101"), [Typed("2", "1010_0101")]);
        assert_eq!(tokens("P#DB10.DBX 2.0"), [Typed("P", ""), Word("DB10"), Symbol("."), Word("DBX"), Number("2.0")]);
        assert_eq!(tokens("P##a,1..2"), [Typed("P#", "a"), Symbol(","), Number("1"), Symbol(".."), Number("2")]);
        assert_eq!(tokens("DT#95-12-31-23:59:59.123;"), [Typed("DT", "95-12-31-23:59:59.123"), Symbol(";")]);
        assert_eq!(tokens("1.000000e+000"), [Number("1.000000e+000")]);
        assert_eq!(tokens("'a$'b$41'"), [Token::Text("a'bA".to_owned())]);
        assert_eq!(tokens("\"a\n"), [Token::Open("\"")]);
    }

    #[test]
    fn operations_of_signs_take_their_letters() {
        for (text, wanted) in [
            ("==I ;", "==I"),
            ("= M 1.0", "="),
            ("<>R", "<>R"),
            ("+ 5", "+"),
            ("+I", "+I"),
            ("+AR1 P#2.0", "+AR1"),
            (") ;", ")"),
            (")MCR", ")MCR"),
            ("u(", "U("),
            ("RND+", "RND+"),
            ("JU x", "JU"),
        ] {
            assert_eq!(Cursor::new(text, 0).operation(), wanted);
        }
    }
}
