//! Built-in blocks: system functions, and functions of the IEC and converting libraries.

mod counters;
mod dispatch;
mod iec;
mod interface;
mod library;
mod transfer;

pub(in crate::plc::step7) use interface::{BASIC, SYSTEM, System, by_name, by_number, layout_of};
pub(in crate::plc::step7) use transfer::Region;
