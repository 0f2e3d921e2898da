//! A source as the parser reads it: blocks with declarations and statements, before names mean anything.

use crate::plc::step7::instruction::{BlockKind, BlockName, Register, Space, StatusBit, Width};

use super::constants::Constant;
use super::finding::At;
use super::types::Section;

/// The name of a block: absolute, or a symbol.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::plc::step7) enum Name {
    Absolute(BlockName),
    Symbol(String),
}

/// A block of a source.
#[derive(Clone, Debug)]
pub(in crate::plc::step7) struct Block {
    pub(in crate::plc::step7) at: At,
    pub(in crate::plc::step7) kind: BlockKind,
    pub(in crate::plc::step7) name: Name,
    /// `NAME :` of the header.
    pub(in crate::plc::step7) header_name: Option<String>,
    pub(in crate::plc::step7) body: Body,
    /// `KNOW_HOW_PROTECT`: its statements are not in the source.
    pub(in crate::plc::step7) is_protected: bool,
    /// `CODE_VERSION1`: its variables are reached without AR2.
    pub(in crate::plc::step7) is_version_1: bool,
}

#[derive(Clone, Debug)]
pub(in crate::plc::step7) enum Body {
    /// A block with statements; the type of a function.
    Code { result: Option<Declared>, declarations: Vec<Declaration>, statements: Vec<Statement> },
    /// A data block: its type, and its actual values.
    Data { ty: Declared, values: Vec<(At, Vec<Step>, Constant)> },
    /// A data type of the user.
    Type { ty: Declared },
}

/// A type as it is written.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::plc::step7) enum Declared {
    Elementary(super::types::Type),
    Array(Vec<(i32, i32)>, Box<Self>),
    Struct(Vec<Declaration>),
    /// A UDT, an FB or an SFB.
    Named(At, Name),
}

/// A declared variable.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::plc::step7) struct Declaration {
    pub(in crate::plc::step7) at: At,
    pub(in crate::plc::step7) name: String,
    pub(in crate::plc::step7) section: Section,
    pub(in crate::plc::step7) ty: Declared,
    /// Each with the number of its repetitions.
    pub(in crate::plc::step7) initial: Vec<(u32, Constant)>,
}

/// A step into a variable.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::plc::step7) enum Step {
    Member(String),
    Index(Vec<i64>),
}

/// A statement. A label at the end of a block has an empty operation.
#[derive(Clone, Debug)]
pub(in crate::plc::step7) struct Statement {
    pub(in crate::plc::step7) at: At,
    pub(in crate::plc::step7) network: u16,
    pub(in crate::plc::step7) number: u32,
    pub(in crate::plc::step7) label: Option<String>,
    /// In capitals.
    pub(in crate::plc::step7) operation: String,
    pub(in crate::plc::step7) operand: Operand,
    /// Of a call: the instance, and the parameters.
    pub(in crate::plc::step7) instance: Operand,
    pub(in crate::plc::step7) parameters: Vec<Parameter>,
}

/// A parameter of a call.
#[derive(Clone, Debug)]
pub(in crate::plc::step7) struct Parameter {
    pub(in crate::plc::step7) at: At,
    pub(in crate::plc::step7) name: String,
    pub(in crate::plc::step7) value: Operand,
}

/// An operand as it is written.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::plc::step7) enum Operand {
    None,
    Constant(Constant),
    /// `#name.member[1]`.
    Local(String, Vec<Step>),
    /// A name without `#`: a label, or a local name.
    Bare(String, Vec<Step>),
    /// `"symbol"`, `"Data".member`.
    Symbol(String, Vec<Step>),
    /// `"Data".DBW 2`.
    SymbolData(String, Width, u32),
    /// `M 10.0`.
    Memory(Space, Width, u32),
    /// `DB10.DBW 2`.
    BlockData(u16, Width, u32),
    /// `DB10.name`.
    BlockMember(u16, Vec<Step>),
    /// `M [MD 10]`, and the place of the pointer.
    Indirect(Space, Width, Box<Self>),
    /// `M [AR1,P#2.0]`, `W [AR1,P#0.0]`.
    Register(Option<Space>, Width, Register, u32),
    Timer(u16),
    Counter(u16),
    /// `T [MW 2]`.
    TimerAt(Box<Self>),
    CounterAt(Box<Self>),
    Block(BlockName),
    /// `DB [MW 2]`, `FC [MW 2]`; of DI the kind is DB, and the flag is set.
    BlockAt(BlockKind, bool, Box<Self>),
    /// `DI 5`.
    InstanceBlock(u16),
    Status(StatusBit),
    /// `STW`, `DBLG`, `DBNO`, `DILG`, `DINO`, `AR1`, `AR2`.
    Special(&'static str),
    /// `P##name`.
    AddressOf(String, Vec<Step>),
}
