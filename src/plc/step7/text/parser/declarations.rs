//! Declarations: variables with types and initial values, actual values of data blocks.

use crate::plc::step7::instruction::{BlockKind, BlockName};
use crate::plc::step7::text::address::split;
use crate::plc::step7::text::constants::Constant;
use crate::plc::step7::text::finding::{At, Fault};
use crate::plc::step7::text::lexer::{Token, is_border};
use crate::plc::step7::text::syntax::{Declaration, Declared, Name, Step};
use crate::plc::step7::text::types::{Section, Type};

use super::reader::{Read, Reader};

/// How deep structures and arrays may be nested.
const DEEPEST: u32 = 12;

impl Reader<'_> {
    /// The variables up to a word such as `END_VAR`, which is taken.
    pub(in crate::plc::step7) fn declarations(&mut self, section: Section, end: &str) -> Vec<Declaration> {
        self.declarations_within(section, end, 0)
    }

    fn declarations_within(&mut self, section: Section, end: &str, depth: u32) -> Vec<Declaration> {
        let mut declared = Vec::new();
        loop {
            if self.takes_word(end) {
                return declared;
            }
            match self.cursor.peek() {
                Token::Word(word) if is_border(word) => {
                    let fault = self.expected(&format!("`{end}`"), "end the declarations");
                    self.faults.push(fault);
                    return declared;
                }
                Token::End => {
                    let fault = self.expected(&format!("`{end}`"), "end the declarations");
                    self.faults.push(fault);
                    return declared;
                }
                Token::Symbol(";") => {
                    self.cursor.next();
                    continue;
                }
                _ => {}
            }
            if let Err(fault) = self.declaration(section, depth, &mut declared) {
                self.faults.push(fault);
                self.skip_declaration(end);
            }
        }
    }

    /// Skips to the next semicolon, or to a word that ends the declarations.
    fn skip_declaration(&mut self, end: &str) {
        loop {
            let before = self.cursor;
            match self.cursor.next() {
                Token::Symbol(";") | Token::End => return,
                Token::Word(word) if is_border(word) || word.eq_ignore_ascii_case(end) => {
                    self.cursor = before;
                    return;
                }
                _ => {}
            }
        }
    }

    fn declaration(&mut self, section: Section, depth: u32, declared: &mut Vec<Declaration>) -> Read<()> {
        let mut names = vec![(self.at(), self.member()?)];
        self.skip_attributes();
        while self.takes(",") {
            names.push((self.at(), self.member()?));
            self.skip_attributes();
        }
        self.expect(":", "write `name : TYPE ;`")?;
        let ty = self.declared_type(depth)?;
        self.skip_attributes();
        let initial = if self.takes(":=") { self.initial_values()? } else { Vec::new() };
        // Nothing separates `END_STRUCT` from the next name in old sources.
        let is_structure = matches!(ty, Declared::Struct(_));
        if !self.takes(";") && !is_structure {
            return Err(self.expected("`;`", "end the declaration with `;`"));
        }
        declared.extend(names.into_iter().map(|(at, name)| Declaration {
            at,
            name,
            section,
            ty: ty.clone(),
            initial: initial.clone(),
        }));
        Ok(())
    }

    /// A type as it is written.
    pub(in crate::plc::step7) fn declared_type(&mut self, depth: u32) -> Read<Declared> {
        let at = self.at();
        if depth > DEEPEST {
            return Err(Fault::new(at, "structures and arrays are nested too deeply", "use at most 8 levels"));
        }
        let cure = "write an elementary type, ARRAY, STRUCT, STRING, a UDT or an FB";
        let Token::Word(word) = self.cursor.peek() else {
            return match self.cursor.peek() {
                Token::Quoted(symbol) => {
                    self.cursor.next();
                    Ok(Declared::Named(at, Name::Symbol(symbol.to_owned())))
                }
                _ => Err(self.expected("a type", cure)),
            };
        };
        match word.to_ascii_uppercase().as_str() {
            "ARRAY" => {
                self.cursor.next();
                self.array(depth)
            }
            "STRUCT" => {
                self.cursor.next();
                Ok(Declared::Struct(self.declarations_within(Section::Static, "END_STRUCT", depth + 1)))
            }
            "STRING" => {
                self.cursor.next();
                let mut length = 254;
                if self.takes("[") {
                    length = self.number::<u8>("a length from 1 to 254")?;
                    self.expect("]", "close the length")?;
                }
                Ok(Declared::Elementary(Type::Text(length.min(254))))
            }
            capitals => {
                let (letters, _) = split(capitals).unwrap_or((capitals, ""));
                if matches!(BlockKind::parse(letters), Some(BlockKind::Udt | BlockKind::Fb | BlockKind::Sfb)) {
                    return Ok(Declared::Named(at, self.block_name()?));
                }
                let Some(ty) = Type::elementary(capitals) else { return Err(self.expected("a type", cure)) };
                self.cursor.next();
                Ok(Declared::Elementary(ty))
            }
        }
    }

    fn array(&mut self, depth: u32) -> Read<Declared> {
        let cure = "write `ARRAY [1 .. 10] OF INT`";
        self.expect("[", cure)?;
        let mut ranges = Vec::new();
        loop {
            let from = self.bound()?;
            self.expect("..", cure)?;
            ranges.push((from, self.bound()?));
            if !self.takes(",") {
                break;
            }
        }
        self.expect("]", cure)?;
        if ranges.len() > 6 {
            return Err(self.expected("at most 6 dimensions", cure));
        }
        if !self.takes_word("OF") {
            return Err(self.expected("`OF`", cure));
        }
        Ok(Declared::Array(ranges, Box::new(self.declared_type(depth + 1)?)))
    }

    fn bound(&mut self) -> Read<i32> {
        let at = self.at();
        let bound = self.integer()?;
        match i32::try_from(bound) {
            Ok(bound) if (-32_768..=32_767).contains(&bound) => Ok(bound),
            _ => {
                let what = format!("expected an index from -32768 to 32767, found {bound}");
                Err(Fault::new(at, what, "correct the range of the array"))
            }
        }
    }

    /// `1, 3 (9), 4`.
    fn initial_values(&mut self) -> Read<Vec<(u32, Constant)>> {
        let mut values = Vec::new();
        loop {
            let before = self.cursor;
            let mut count = 1;
            if let Token::Number(text) = self.cursor.next()
                && self.takes("(")
            {
                count = text.parse().ok().filter(|&count| count <= 65_536).ok_or_else(|| {
                    let what = format!("expected a number of repetitions from 0 to 65536, found {text}");
                    Fault::new(before.clone().at(), what, "write `3 (9)` for three values 9")
                })?;
                values.push((count, self.value()?));
                self.expect(")", "close the repetition")?;
            } else {
                self.cursor = before;
                values.push((count, self.value()?));
            }
            if !self.takes(",") {
                return Ok(values);
            }
        }
    }

    fn value(&mut self) -> Read<Constant> {
        if let Some(constant) = self.constant()? {
            return Ok(constant);
        }
        // The number of a timer, a counter or a block.
        if let Token::Word(word) = self.cursor.peek() {
            let (letters, digits) = split(word).unwrap_or((word, ""));
            if matches!(letters.to_ascii_uppercase().as_str(), "T" | "C" | "Z") || BlockKind::parse(letters).is_some() {
                self.cursor.next();
                let number = match digits.parse::<u16>() {
                    Ok(number) => number,
                    Err(_) => self.number("a number from 0 to 65535")?,
                };
                return Ok(Constant::Integer(i64::from(number)));
            }
        }
        Err(self.expected("a constant", "write a constant of the type of the variable"))
    }

    /// The actual values of a data block, up to its end.
    pub(in crate::plc::step7) fn actual_values(&mut self) -> Vec<(At, Vec<Step>, Constant)> {
        let mut values = Vec::new();
        loop {
            match self.cursor.peek() {
                Token::Word(word) if is_border(word) => return values,
                Token::End => return values,
                Token::Symbol(";") => {
                    self.cursor.next();
                    continue;
                }
                _ => {}
            }
            match self.actual_value() {
                Ok(value) => values.push(value),
                Err(fault) => {
                    self.faults.push(fault);
                    self.cursor.skip_statement();
                }
            }
        }
    }

    fn actual_value(&mut self) -> Read<(At, Vec<Step>, Constant)> {
        let at = self.at();
        let mut path = vec![Step::Member(self.member()?)];
        path.extend(self.path()?);
        self.expect(":=", "write `name := value;`")?;
        let value = self.value()?;
        self.expect(";", "end the value with `;`")?;
        Ok((at, path, value))
    }

    /// The type of a data block: a structure, a UDT, or the block of which it is an instance.
    pub(in crate::plc::step7) fn data_type(&mut self) -> Read<Declared> {
        let at = self.at();
        match self.cursor.peek() {
            Token::Quoted(symbol) => {
                self.cursor.next();
                Ok(Declared::Named(at, Name::Symbol(symbol.to_owned())))
            }
            Token::Word(word) if word.eq_ignore_ascii_case("STRUCT") => self.declared_type(0),
            Token::Word(_) => match self.block_name()? {
                name @ Name::Absolute(BlockName { kind: BlockKind::Udt | BlockKind::Fb | BlockKind::Sfb, .. }) => {
                    Ok(Declared::Named(at, name))
                }
                _ => Err(Fault::new(at, "expected STRUCT, a UDT, an FB or an SFB", "give the type of the data block")),
            },
            _ => Err(self.expected("STRUCT, a UDT, an FB or an SFB", "give the type of the data block")),
        }
    }
}
