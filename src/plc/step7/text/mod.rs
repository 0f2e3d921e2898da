//! From the text of sources and symbol tables to blocks in which names mean nothing yet.

pub(in crate::plc::step7) mod address;
pub(in crate::plc::step7) mod constants;
pub(in crate::plc::step7) mod finding;
mod lexer;
pub(in crate::plc::step7) mod mnemonics;
pub(in crate::plc::step7) mod parser;
pub(in crate::plc::step7) mod shown;
pub(in crate::plc::step7) mod symbols;
pub(in crate::plc::step7) mod syntax;
pub(in crate::plc::step7) mod types;
