//! Operands of statements and of parameters.

use crate::plc::step7::instruction::{BlockKind, BlockName, Register, Space, StatusBit, Width};
use crate::plc::step7::text::address::{area, split};
use crate::plc::step7::text::constants::Constant;
use crate::plc::step7::text::finding::Fault;
use crate::plc::step7::text::lexer::Token;
use crate::plc::step7::text::syntax::Operand;

use super::reader::{Read, Reader};

/// Words that are operands of their own.
const SPECIAL: [&str; 7] = ["STW", "DBLG", "DBNO", "DILG", "DINO", "AR1", "AR2"];

impl Reader<'_> {
    /// An operand; [`Operand::None`] if the statement ends here.
    pub(in crate::plc::step7) fn operand(&mut self) -> Read<Operand> {
        match self.cursor.peek() {
            Token::Symbol(";") | Token::End => Ok(Operand::None),
            Token::Local(name) => {
                self.cursor.next();
                Ok(Operand::Local(name.to_owned(), self.path()?))
            }
            Token::Quoted(symbol) => {
                self.cursor.next();
                self.after_symbol(symbol)
            }
            Token::Typed("P#", name) => {
                self.cursor.next();
                Ok(Operand::AddressOf(name.to_owned(), self.path()?))
            }
            Token::Symbol("[") => {
                self.cursor.next();
                self.register(None, Width::Bit)
            }
            Token::Symbol("==" | "<>" | ">" | "<" | ">=" | "<=") => self.status(),
            Token::Word(word) if !word.eq_ignore_ascii_case("TRUE") && !word.eq_ignore_ascii_case("FALSE") => {
                self.cursor.next();
                self.after_word(word)
            }
            _ => match self.constant()? {
                Some(constant) => Ok(Operand::Constant(constant)),
                None => Err(self.expected("an operand", "write an address, a name or a constant")),
            },
        }
    }

    fn status(&mut self) -> Read<Operand> {
        let fault = self.expected("a status bit", "write `==0`, `<>0`, `>0`, `<0`, `>=0` or `<=0`");
        let Token::Symbol(sign) = self.cursor.next() else { return Err(fault) };
        let bit = match sign {
            "==" => StatusBit::Zero,
            "<>" => StatusBit::NotZero,
            ">" => StatusBit::Positive,
            "<" => StatusBit::Negative,
            ">=" => StatusBit::NotNegative,
            _ => StatusBit::NotPositive,
        };
        if self.cursor.next() == Token::Number("0") { Ok(Operand::Status(bit)) } else { Err(fault) }
    }

    /// What follows `"Data"`.
    fn after_symbol(&mut self, symbol: &str) -> Read<Operand> {
        let before = self.cursor;
        if self.takes(".")
            && let Token::Word(word) = self.cursor.peek()
        {
            let (letters, digits) = split(word).unwrap_or((word, ""));
            if let Some((Space::Data, width)) = area(letters) {
                self.cursor.next();
                if !digits.is_empty() || matches!(self.cursor.peek(), Token::Number(_)) {
                    return Ok(Operand::SymbolData(symbol.to_owned(), width, self.place(width, digits)?));
                }
            }
        }
        self.cursor = before;
        Ok(Operand::Symbol(symbol.to_owned(), self.path()?))
    }

    fn after_word(&mut self, word: &str) -> Read<Operand> {
        let capitals = word.to_ascii_uppercase();
        if let Some(special) = SPECIAL.iter().find(|special| **special == capitals) {
            return Ok(Operand::Special(special));
        }
        let status = match capitals.as_str() {
            "UO" => Some(StatusBit::Unordered),
            "OV" => Some(StatusBit::Overflow),
            "OS" => Some(StatusBit::StoredOverflow),
            "BR" | "BIE" => Some(StatusBit::BinaryResult),
            _ => None,
        };
        if let Some(bit) = status {
            return Ok(Operand::Status(bit));
        }
        let (letters, digits) = split(&capitals).unwrap_or((&capitals, ""));
        let has_number = !digits.is_empty() || matches!(self.cursor.peek(), Token::Number(_));
        let has_bracket = digits.is_empty() && self.cursor.peek() == Token::Symbol("[");
        if has_number || has_bracket {
            match letters {
                "T" | "C" | "Z" if has_bracket => {
                    self.cursor.next();
                    let pointer = Box::new(self.indirection()?);
                    return Ok(if letters == "T" { Operand::TimerAt(pointer) } else { Operand::CounterAt(pointer) });
                }
                "T" | "C" | "Z" => {
                    let number = self.attached(digits)?;
                    return Ok(if letters == "T" { Operand::Timer(number) } else { Operand::Counter(number) });
                }
                "B" | "W" | "D" if has_bracket => {
                    self.cursor.next();
                    let width = match letters {
                        "B" => Width::Byte,
                        "W" => Width::Word,
                        _ => Width::Double,
                    };
                    return self.register(None, width);
                }
                _ => {}
            }
            if let Some(operand) = self.block_operand(letters, digits, has_bracket)? {
                return Ok(operand);
            }
            if let Some((space, width)) = area(letters) {
                if !has_bracket {
                    return Ok(Operand::Memory(space, width, self.place(width, digits)?));
                }
                self.cursor.next();
                if matches!(self.cursor.peek(), Token::Word(word) if word.to_ascii_uppercase().starts_with("AR")) {
                    return self.register(Some(space), width);
                }
                return Ok(Operand::Indirect(space, width, Box::new(self.indirection()?)));
            }
        }
        Ok(Operand::Bare(word.to_owned(), self.path()?))
    }

    /// `DB 10`, `DB10.DBW 2`, `DB10.name`, `DB [MW 2]`, `FC 5`.
    fn block_operand(&mut self, letters: &str, digits: &str, has_bracket: bool) -> Read<Option<Operand>> {
        let is_instance = letters == "DI";
        let Some(kind) = BlockKind::parse(if is_instance { "DB" } else { letters }) else { return Ok(None) };
        if has_bracket {
            self.cursor.next();
            return Ok(Some(Operand::BlockAt(kind, is_instance, Box::new(self.indirection()?))));
        }
        let number = self.attached(digits)?;
        if is_instance {
            return Ok(Some(Operand::InstanceBlock(number)));
        }
        let before = self.cursor;
        if kind == BlockKind::Db && self.takes(".") {
            if let Token::Word(word) = self.cursor.peek() {
                let (letters, digits) = split(word).unwrap_or((word, ""));
                if let Some((Space::Data, width)) = area(letters) {
                    self.cursor.next();
                    return Ok(Some(Operand::BlockData(number, width, self.place(width, digits)?)));
                }
            }
            self.cursor = before;
            return Ok(Some(Operand::BlockMember(number, self.path()?)));
        }
        Ok(Some(Operand::Block(BlockName { kind, number })))
    }

    fn attached(&mut self, digits: &str) -> Read<u16> {
        match digits.parse() {
            Ok(number) => Ok(number),
            Err(_) if digits.is_empty() => self.number("a number from 0 to 65535"),
            Err(_) => Err(self.expected("a number from 0 to 65535", "")),
        }
    }

    /// The pointer in brackets, after the opening one.
    fn indirection(&mut self) -> Read<Operand> {
        let at = self.at();
        let pointer = match self.cursor.peek() {
            Token::Local(_) | Token::Quoted(_) | Token::Word(_) => {
                // One level only: the operand itself must not be indirect.
                match self.cursor.next() {
                    Token::Local(name) => Operand::Local(name.to_owned(), self.path()?),
                    Token::Quoted(symbol) => self.after_symbol(symbol)?,
                    Token::Word(word) => {
                        let (letters, digits) = split(word).unwrap_or((word, ""));
                        match area(letters) {
                            Some((space, width))
                                if !digits.is_empty() || matches!(self.cursor.peek(), Token::Number(_)) =>
                            {
                                Operand::Memory(space, width, self.place(width, digits)?)
                            }
                            _ => Operand::Bare(word.to_owned(), self.path()?),
                        }
                    }
                    _ => Operand::None,
                }
            }
            _ => Operand::None,
        };
        if pointer == Operand::None {
            return Err(Fault::new(at, "expected a pointer in brackets", "write `[MD 10]`, `[LW 2]` or `[AR1,P#0.0]`"));
        }
        self.expect("]", "close the bracket")?;
        Ok(pointer)
    }

    /// `AR1,P#2.0]`.
    fn register(&mut self, space: Option<Space>, width: Width) -> Read<Operand> {
        let cure = "write `[AR1,P#2.0]`";
        let register = if self.takes_word("AR1") {
            Register::Ar1
        } else if self.takes_word("AR2") {
            Register::Ar2
        } else {
            return Err(self.expected("AR1 or AR2", cure));
        };
        self.expect(",", cure)?;
        let Some(Constant::Bit(offset)) = self.constant()? else {
            return Err(self.expected("an offset", cure));
        };
        self.expect("]", cure)?;
        Ok(Operand::Register(space, width, register, offset))
    }
}
