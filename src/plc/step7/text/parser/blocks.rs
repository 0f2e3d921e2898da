//! Blocks and statements: the outer part of the parser.

use crate::plc::step7::instruction::{BlockKind, BlockName};
use crate::plc::step7::text::finding::{At, Fault};
use crate::plc::step7::text::lexer::{Token, is_border};
use crate::plc::step7::text::mnemonics::{Language, Operation};
use crate::plc::step7::text::syntax::{Block, Body, Declaration, Declared, Name, Operand, Parameter, Statement};
use crate::plc::step7::text::types::Section;

use super::reader::{Read, Reader};

/// A source: its blocks, its language, and its faults.
pub(in crate::plc::step7) struct Parsed {
    pub(in crate::plc::step7) blocks: Vec<Block>,
    /// Which language its operations are of: more than 0 international, less than 0 German.
    pub(in crate::plc::step7) balance: i64,
    /// An operation that means two things.
    pub(in crate::plc::step7) differs: Option<(At, String)>,
    pub(in crate::plc::step7) faults: Vec<Fault>,
}

/// Reads a source. All faults are collected; a statement with a fault is left out.
pub(in crate::plc::step7) fn parse(text: &str, file: u16) -> Parsed {
    let mut reader = Reader::new(text, file);
    let mut blocks = Vec::new();
    loop {
        let at = reader.at();
        let before = reader.cursor;
        match reader.cursor.next() {
            Token::End => break,
            Token::Symbol(";") => {}
            Token::Word(word) => match head(word) {
                Some((kind, end)) => blocks.extend(reader.block(at, kind, end)),
                None => {
                    reader.cursor = before;
                    reader.no_block();
                }
            },
            _ => {
                reader.cursor = before;
                reader.no_block();
            }
        }
    }
    let words = blocks.iter().flat_map(|block| match &block.body {
        Body::Code { statements, .. } => statements.as_slice(),
        Body::Data { .. } | Body::Type { .. } => &[],
    });
    let balance = Language::balance(words.clone().map(|statement| statement.operation.as_str()));
    let differs = words.clone().find(|statement| Language::differs(&statement.operation));
    let differs = differs.map(|statement| (statement.at, statement.operation.clone()));
    Parsed { blocks, balance, differs, faults: reader.faults }
}

/// The kind of a block by the word that opens it, and the word that ends it.
fn head(word: &str) -> Option<(BlockKind, &'static str)> {
    Some(match word.to_ascii_uppercase().as_str() {
        "ORGANIZATION_BLOCK" => (BlockKind::Ob, "END_ORGANIZATION_BLOCK"),
        "FUNCTION_BLOCK" => (BlockKind::Fb, "END_FUNCTION_BLOCK"),
        "FUNCTION" => (BlockKind::Fc, "END_FUNCTION"),
        "DATA_BLOCK" => (BlockKind::Db, "END_DATA_BLOCK"),
        "TYPE" => (BlockKind::Udt, "END_TYPE"),
        "SYSTEM_FUNCTION" => (BlockKind::Sfc, "END_SYSTEM_FUNCTION"),
        "SYSTEM_FUNCTION_BLOCK" => (BlockKind::Sfb, "END_SYSTEM_FUNCTION_BLOCK"),
        _ => return None,
    })
}

fn is_jump(operation: &str) -> bool {
    [Language::International, Language::German]
        .iter()
        .any(|language| matches!(language.operation(operation), Some(Operation::Jump(_) | Operation::JumpList)))
}

/// What the head of a block says.
#[derive(Default)]
struct Header {
    name: Option<String>,
    is_version_1: bool,
    is_protected: bool,
}

impl Reader<'_> {
    /// Reports text outside of blocks, and skips it.
    fn no_block(&mut self) {
        let fault = self.expected(
            "a block",
            "a source has ORGANIZATION_BLOCK, FUNCTION_BLOCK, FUNCTION, DATA_BLOCK and TYPE, each with its END",
        );
        self.faults.push(fault);
        self.skip_to_block();
    }

    fn skip_to_block(&mut self) {
        loop {
            let before = self.cursor;
            match self.cursor.next() {
                Token::End => return,
                Token::Word(word) if head(word).is_some() => {
                    self.cursor = before;
                    return;
                }
                _ => {}
            }
        }
    }

    /// A block after the word that opens it.
    fn block(&mut self, at: At, kind: BlockKind, end: &str) -> Option<Block> {
        let block = self.block_inside(at, kind);
        let block = match block {
            Ok(block) => Some(block),
            Err(fault) => {
                self.faults.push(fault);
                None
            }
        };
        if self.takes_word(end) {
            return block;
        }
        if block.is_some() {
            let fault = self.expected(&format!("`{end}`"), "end the block");
            self.faults.push(fault);
        }
        loop {
            let before = self.cursor;
            match self.cursor.next() {
                Token::End => return None,
                Token::Word(word) if word.eq_ignore_ascii_case(end) => return None,
                Token::Word(word) if head(word).is_some() => {
                    self.cursor = before;
                    return None;
                }
                _ => {}
            }
        }
    }

    fn block_inside(&mut self, at: At, kind: BlockKind) -> Read<Block> {
        let name_at = self.at();
        let name = self.block_name()?;
        if let Name::Absolute(BlockName { kind: found, .. }) = name
            && found != kind
        {
            let what = format!("expected a block of the kind {kind:?}, found {found:?}");
            return Err(Fault::new(name_at, what, "the keyword and the address must be of one kind"));
        }
        let result = match kind {
            BlockKind::Fc | BlockKind::Sfc => {
                self.expect(":", "write the type of the function, as `FUNCTION FC 10 : VOID`")?;
                Some(self.declared_type(0)?)
            }
            _ => None,
        };
        let header = self.header();
        let body = match kind {
            BlockKind::Db => {
                let ty = self.data_type()?;
                self.takes(";");
                let values = if self.takes_word("BEGIN") { self.actual_values() } else { Vec::new() };
                Body::Data { ty, values }
            }
            BlockKind::Udt => {
                let ty = self.declared_type(0)?;
                self.takes(";");
                Body::Type { ty }
            }
            _ => {
                let declarations = self.sections();
                self.takes_word("BEGIN");
                Body::Code { result, declarations, statements: self.statements() }
            }
        };
        Ok(Block {
            at,
            kind,
            name,
            header_name: header.name,
            body,
            is_version_1: header.is_version_1,
            is_protected: header.is_protected,
        })
    }

    fn header(&mut self) -> Header {
        let mut header = Header::default();
        loop {
            self.skip_attributes();
            let Token::Word(word) = self.cursor.peek() else { return header };
            match word.to_ascii_uppercase().as_str() {
                "TITLE" => {
                    self.cursor.next();
                    self.cursor.rest_of_line();
                }
                "AUTHOR" | "FAMILY" | "VERSION" => {
                    self.cursor.next();
                    self.cursor.rest_of_line();
                }
                "NAME" => {
                    self.cursor.next();
                    let line = self.cursor.rest_of_line();
                    let name = line.split("//").next().unwrap_or_default();
                    let name =
                        name.trim_matches(|letter: char| letter.is_whitespace() || matches!(letter, ':' | ';' | '\''));
                    header.name = (!name.is_empty()).then(|| name.to_owned());
                }
                "KNOW_HOW_PROTECT" => {
                    self.cursor.next();
                    header.is_protected = true;
                }
                "READ_ONLY" | "UNLINKED" | "NON_RETAIN" | "STANDARD" => {
                    self.cursor.next();
                }
                "CODE_VERSION1" => {
                    self.cursor.next();
                    header.is_version_1 = true;
                }
                _ => return header,
            }
        }
    }

    fn sections(&mut self) -> Vec<Declaration> {
        let mut declared = Vec::new();
        loop {
            let Token::Word(word) = self.cursor.peek() else { return declared };
            let section = match word.to_ascii_uppercase().as_str() {
                "VAR_INPUT" => Section::Input,
                "VAR_OUTPUT" => Section::Output,
                "VAR_IN_OUT" => Section::InOut,
                "VAR" => Section::Static,
                "VAR_TEMP" => Section::Temp,
                _ => return declared,
            };
            self.cursor.next();
            declared.extend(self.declarations(section, "END_VAR"));
        }
    }

    fn statements(&mut self) -> Vec<Statement> {
        let mut statements = Vec::new();
        let (mut network, mut number) = (0_u16, 0);
        loop {
            match self.cursor.peek() {
                Token::End => return statements,
                Token::Word(word) if is_border(word) => {
                    if !word.eq_ignore_ascii_case("NETWORK") {
                        return statements;
                    }
                    self.cursor.next();
                    network = network.saturating_add(1);
                    number = 0;
                    continue;
                }
                Token::Word(word) if word.eq_ignore_ascii_case("TITLE") => {
                    self.cursor.next();
                    self.cursor.rest_of_line();
                    continue;
                }
                Token::Symbol(";") => {
                    self.cursor.next();
                    continue;
                }
                Token::Symbol("{") => {
                    self.skip_attributes();
                    continue;
                }
                _ => {}
            }
            number += 1;
            match self.statement(network.max(1), number) {
                Ok(statement) => statements.push(statement),
                Err(fault) => {
                    self.faults.push(fault);
                    self.cursor.skip_statement();
                }
            }
        }
    }

    fn statement(&mut self, network: u16, number: u32) -> Read<Statement> {
        let label_at = self.at();
        let label = self.cursor.label().map(str::to_owned);
        if let Some(label) = &label
            && label.chars().count() > 4
        {
            return Err(Fault::new(
                label_at,
                format!("expected a label of one to four characters, found `{label}`"),
                "shorten the label",
            ));
        }
        let at = self.at();
        let is_end =
            matches!(self.cursor.peek(), Token::Word(word) if is_border(word)) || self.cursor.peek() == Token::End;
        let operation = if is_end || self.takes(";") { String::new() } else { self.cursor.operation() };
        let mut statement = Statement {
            at,
            network,
            number,
            label,
            operation,
            operand: Operand::None,
            instance: Operand::None,
            parameters: Vec::new(),
        };
        if statement.operation.is_empty() {
            return Ok(statement);
        }
        statement.operand = if is_jump(&statement.operation) { self.label_operand()? } else { self.operand()? };
        if statement.operation == "CALL" {
            if self.takes(",") {
                statement.instance = self.operand()?;
            }
            if self.takes("(") {
                statement.parameters = self.parameters()?;
            }
        }
        if !self.takes(";") {
            return Err(self.expected("`;`", "end the statement with `;`"));
        }
        Ok(statement)
    }

    /// A label, which can look like an address: `M001`.
    fn label_operand(&mut self) -> Read<Operand> {
        let Token::Word(word) = self.cursor.peek() else {
            return Err(self.expected("a label", "write the label to which the jump goes"));
        };
        self.cursor.next();
        Ok(Operand::Bare(word.to_owned(), Vec::new()))
    }

    fn parameters(&mut self) -> Read<Vec<Parameter>> {
        let mut parameters = Vec::new();
        loop {
            if self.takes(")") {
                return Ok(parameters);
            }
            let at = self.at();
            let name = self.member()?;
            self.expect(":=", "write `name := value`")?;
            // The editor writes parameters of a function block without a value, too.
            if !matches!(self.cursor.peek(), Token::Symbol("," | ")")) {
                let value = self.operand()?;
                parameters.push(Parameter { at, name, value });
            }
            if !self.takes(",") {
                self.expect(")", "separate parameters by `,`, and close the list")?;
                return Ok(parameters);
            }
        }
    }
}

/// The type of a function that returns nothing.
pub(in crate::plc::step7) fn is_void(result: Option<&Declared>) -> bool {
    matches!(result, None | Some(Declared::Elementary(crate::plc::step7::text::types::Type::Void)))
}
