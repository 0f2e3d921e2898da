//! What all parts of the parser need: tokens with expectations, names of blocks, constants.

use crate::plc::step7::instruction::{BlockKind, BlockName, Space, Width};
use crate::plc::step7::text::address::{area, place, split};
use crate::plc::step7::text::constants::{Constant, typed};
use crate::plc::step7::text::finding::{At, Fault};
use crate::plc::step7::text::lexer::{Cursor, Token};
use crate::plc::step7::text::syntax::{Name, Step};

/// Reads a source and collects its faults.
pub(in crate::plc::step7) struct Reader<'a> {
    pub(in crate::plc::step7) cursor: Cursor<'a>,
    pub(in crate::plc::step7) faults: Vec<Fault>,
}

pub(in crate::plc::step7) type Read<T> = Result<T, Fault>;

impl<'a> Reader<'a> {
    pub(in crate::plc::step7) fn new(text: &'a str, file: u16) -> Self {
        Self { cursor: Cursor::new(text, file), faults: Vec::new() }
    }

    pub(in crate::plc::step7) fn at(&mut self) -> At {
        self.cursor.at()
    }

    /// The fault "expected this, found the next token".
    pub(in crate::plc::step7) fn expected(&mut self, what: &str, cure: &str) -> Fault {
        let at = self.at();
        Fault::new(at, format!("expected {what}, found {}", self.cursor.peek().found()), cure)
    }

    /// Takes a symbol if it is next.
    pub(in crate::plc::step7) fn takes(&mut self, symbol: &str) -> bool {
        let is_next = self.cursor.peek() == Token::Symbol(symbol);
        if is_next {
            self.cursor.next();
        }
        is_next
    }

    pub(in crate::plc::step7) fn expect(&mut self, symbol: &str, cure: &str) -> Read<()> {
        if self.takes(symbol) { Ok(()) } else { Err(self.expected(&format!("`{symbol}`"), cure)) }
    }

    /// Takes a word if it is next, in any case of letters.
    pub(in crate::plc::step7) fn takes_word(&mut self, word: &str) -> bool {
        let is_next = matches!(self.cursor.peek(), Token::Word(found) if found.eq_ignore_ascii_case(word));
        if is_next {
            self.cursor.next();
        }
        is_next
    }

    /// Skips attributes in braces.
    pub(in crate::plc::step7) fn skip_attributes(&mut self) {
        while self.takes("{") {
            while !matches!(self.cursor.next(), Token::Symbol("}") | Token::End) {}
        }
    }

    pub(in crate::plc::step7) fn number<T: std::str::FromStr>(&mut self, what: &str) -> Read<T> {
        if let Token::Number(text) = self.cursor.peek()
            && let Ok(number) = text.parse()
        {
            self.cursor.next();
            return Ok(number);
        }
        Err(self.expected(what, ""))
    }

    /// A whole number with a sign.
    pub(in crate::plc::step7) fn integer(&mut self) -> Read<i64> {
        let sign = if self.takes("-") { -1 } else { 1 };
        if sign == 1 {
            self.takes("+");
        }
        // The tokenizer takes any number of digits.
        Ok(sign * i64::from(self.number::<i32>("a whole number")?))
    }

    /// `FC 10`, `FC10`, `"Motor"`.
    pub(in crate::plc::step7) fn block_name(&mut self) -> Read<Name> {
        let cure = "write the address, as `FC 10`, or a symbol in quotes";
        match self.cursor.peek() {
            Token::Quoted(symbol) => {
                self.cursor.next();
                Ok(Name::Symbol(symbol.to_owned()))
            }
            Token::Word(word) => {
                let (letters, digits) = split(word).unwrap_or((word, ""));
                let Some(kind) = BlockKind::parse(letters) else { return Err(self.expected("a block", cure)) };
                self.cursor.next();
                let number = match digits.parse() {
                    Ok(number) => number,
                    Err(_) if digits.is_empty() => self.number("the number of the block, at most 65535")?,
                    Err(_) => return Err(self.expected("a block number of at most 65535", cure)),
                };
                Ok(Name::Absolute(BlockName { kind, number }))
            }
            _ => Err(self.expected("a block", cure)),
        }
    }

    /// The members and indices after a name.
    pub(in crate::plc::step7) fn path(&mut self) -> Read<Vec<Step>> {
        let mut steps = Vec::new();
        loop {
            if self.takes("[") {
                let mut indices = vec![self.integer()?];
                while self.takes(",") {
                    indices.push(self.integer()?);
                }
                self.expect("]", "close the index")?;
                steps.push(Step::Index(indices));
            } else if self.takes(".") {
                steps.push(Step::Member(self.member()?));
            } else {
                return Ok(steps);
            }
        }
    }

    pub(in crate::plc::step7) fn member(&mut self) -> Read<String> {
        match self.cursor.peek() {
            Token::Word(name) | Token::Quoted(name) | Token::Local(name) => {
                self.cursor.next();
                Ok(name.to_owned())
            }
            _ => Err(self.expected("the name of a variable", "")),
        }
    }

    /// A byte and a bit, of which the byte can be attached to the letters before it.
    pub(in crate::plc::step7) fn place(&mut self, width: Width, attached: &str) -> Read<u32> {
        let at = self.at();
        let placed = if attached.is_empty() {
            let Token::Number(text) = self.cursor.peek() else {
                return Err(self.expected("an address", "write a number, as `20` or `20.0`"));
            };
            self.cursor.next();
            let (byte, bit) = text.split_once('.').map_or((text, None), |(byte, bit)| (byte, Some(bit)));
            place(width, byte, bit).map_err(|expected| format!("expected {expected}, found `{text}`"))
        } else {
            let mut bit = None;
            if self.takes(".") {
                let Token::Number(digits) = self.cursor.peek() else {
                    return Err(self.expected("a bit from 0 to 7 after the dot", "write it as `20.0`"));
                };
                self.cursor.next();
                bit = Some(digits);
            }
            let found = bit.map_or_else(|| attached.to_owned(), |bit| format!("{attached}.{bit}"));
            place(width, attached, bit).map_err(|expected| format!("expected {expected}, found `{found}`"))
        };
        placed.map_err(|what| Fault::new(at, what, "check the address"))
    }

    /// A constant; `None` if the next token is none.
    pub(in crate::plc::step7) fn constant(&mut self) -> Read<Option<Constant>> {
        let at = self.at();
        let before = self.cursor;
        let constant = match self.cursor.next() {
            Token::Number(text) => number(text, false),
            Token::Symbol(sign @ ("+" | "-")) => match self.cursor.next() {
                Token::Number(text) => number(text, sign == "-"),
                _ => Err("a number after the sign"),
            },
            Token::Text(text) => {
                Ok(Constant::Text(text.chars().map(|letter| u8::try_from(letter).unwrap_or(b'?')).collect()))
            }
            Token::Word(word) if word.eq_ignore_ascii_case("TRUE") => Ok(Constant::Boolean(true)),
            Token::Word(word) if word.eq_ignore_ascii_case("FALSE") => Ok(Constant::Boolean(false)),
            Token::Typed(kind, "") if kind.eq_ignore_ascii_case("P") => return self.pointer().map(Some),
            Token::Typed(kind, "") if kind.eq_ignore_ascii_case("B") => return self.byte_list().map(Some),
            Token::Typed("P#", _) => {
                self.cursor = before;
                return Ok(None);
            }
            Token::Typed(kind, rest) => typed(kind, rest),
            _ => {
                self.cursor = before;
                return Ok(None);
            }
        };
        constant.map(Some).map_err(|expected| {
            Fault::new(at, format!("expected {expected}, found {}", before.peek().found()), "correct the constant")
        })
    }

    /// `B#(1, 2)`, high byte first.
    fn byte_list(&mut self) -> Read<Constant> {
        self.expect("(", "write `B#16#7F`, or `B#(1, 2)`")?;
        let at = self.at();
        let mut value = 0_u32;
        let mut bytes = 0_u8;
        loop {
            value = value << 8 | u32::from(self.number::<u8>("a byte from 0 to 255")?);
            bytes = bytes.saturating_add(1);
            if !self.takes(",") {
                break;
            }
        }
        self.expect(")", "close the list of bytes")?;
        if bytes != 2 && bytes != 4 {
            let what = format!("expected 2 or 4 bytes, found {bytes}");
            return Err(Fault::new(at, what, "write `B#(1, 2)` for a word, `B#(1, 2, 3, 4)` for a double word"));
        }
        Ok(Constant::Bits(value, bytes * 8))
    }

    /// What follows `P#`: `10.3`, `M 12.5`, `DB10.DBX 2.0 BYTE 6`.
    fn pointer(&mut self) -> Read<Constant> {
        if let Token::Number(_) = self.cursor.peek() {
            return Ok(Constant::Bit(self.place(Width::Bit, "")?));
        }
        let unknown = "write `P#10.3`, `P#M 12.5` or `P#DB10.DBX 2.0 BYTE 6`";
        let Token::Word(word) = self.cursor.peek() else { return Err(self.expected("an address", unknown)) };
        let (letters, digits) = split(word).unwrap_or((word, ""));
        let mut block = 0;
        let mut space = pointer_space(letters);
        let mut attached = digits;
        if letters.eq_ignore_ascii_case("DB") || letters.eq_ignore_ascii_case("DI") {
            self.cursor.next();
            block = match digits.parse() {
                Ok(number) => number,
                Err(_) => self.number("the number of the data block")?,
            };
            self.expect(".", unknown)?;
            let Token::Word(word) = self.cursor.peek() else { return Err(self.expected("`DBX`", unknown)) };
            let (letters, digits) = split(word).unwrap_or((word, ""));
            space = pointer_space(letters).filter(|space| matches!(space, Space::Data | Space::Instance));
            attached = digits;
        }
        let Some(space) = space else { return Err(self.expected("an area", unknown)) };
        self.cursor.next();
        let bit = self.place(Width::Bit, attached)?;
        let any = self.any_suffix()?;
        Ok(Constant::Pointer { block, pointer: code(space) << 24 | bit, any })
    }

    /// `BYTE 6` after a pointer.
    fn any_suffix(&mut self) -> Read<Option<(u8, u16)>> {
        let Token::Word(word) = self.cursor.peek() else { return Ok(None) };
        let code = match word.to_ascii_uppercase().as_str() {
            "COUNTER" => 0x1C,
            "TIMER" => 0x1D,
            "STRING" => 0x13,
            word => match crate::plc::step7::text::types::Type::elementary(word) {
                Some(ty) => ty.any().0,
                None => return Ok(None),
            },
        };
        self.cursor.next();
        Ok(Some((code, self.number("the number of elements, at most 65535")?)))
    }
}

fn number(text: &str, is_negative: bool) -> Result<Constant, &'static str> {
    let text = text.replace('_', "");
    if text.contains(['.', 'e', 'E']) {
        let value: f32 = text.parse().map_err(|_| "a number")?;
        return Ok(Constant::Real(if is_negative { -value } else { value }));
    }
    let value: i64 = text.parse().map_err(|_| "a number of at most 18 digits")?;
    Ok(Constant::Integer(if is_negative { -value } else { value }))
}

/// The area of a pointer: `M`, `DBX`, `P`, `PE`.
fn pointer_space(letters: &str) -> Option<Space> {
    if matches!(letters.to_ascii_uppercase().as_str(), "P" | "PI" | "PE" | "PQ" | "PA") {
        return Some(Space::Peripheral);
    }
    area(letters).filter(|&(_, width)| width == Width::Bit).map(|(space, _)| space)
}

/// The code of an area in a pointer.
pub(in crate::plc::step7) fn code(space: Space) -> u32 {
    match space {
        Space::Peripheral => 0x80,
        Space::Inputs => 0x81,
        Space::Outputs => 0x82,
        Space::Flags => 0x83,
        Space::Data => 0x84,
        Space::Instance => 0x85,
        Space::Local => 0x86,
        Space::Caller => 0x87,
    }
}
