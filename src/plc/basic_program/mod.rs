//! Blocks of the basic program of the SINUMERIK 840D sl, for PLC programs in Rust. STEP 7 programs call the same blocks: `step7/basic_program`.

mod alarm_messages;
mod increments;
mod message_block;
mod panel;
mod panel_lamps;

pub(in crate::plc) use increments::select_increment;

pub use alarm_messages::AlarmMessages;
pub use message_block::{Group, MessageLayout, Messages};
pub use panel::{ControlPanel, PanelInputs, PanelKind, PanelOutputs};
