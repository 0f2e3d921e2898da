//! The parser: from the text of a source to its blocks.

mod blocks;
mod declarations;
mod operands;
mod reader;

pub(in crate::plc::step7) use blocks::{Parsed, is_void, parse};
pub(in crate::plc::step7) use reader::code;
