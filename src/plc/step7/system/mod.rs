//! Built-in blocks: system functions, and functions of the IEC and converting libraries.

mod answers;
mod counters;
mod dispatch;
mod further;
mod iec;
mod interface;
mod interrupts;
mod library;
mod loaded_blocks;
mod observed;
mod rare;
mod rows;
mod transfer;

pub(in crate::plc::step7) use interface::{BASIC, SYSTEM, System, SystemBlock, by_name, by_number, layout_of};
pub(in crate::plc::step7) use transfer::Region;
