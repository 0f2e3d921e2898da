//! What the blocks of the basic program remember: plain data, a part of the state of the CPU.

use serde::{Deserialize, Serialize};

use crate::plc::{AlarmMessages, ControlPanel, MessageLayout, SpinCtrl};

/// The memory of the basic program; FB1 sets what the other blocks ask.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::plc::step7) struct BasicState {
    /// The inputs and outputs of the panels: the data block, and the area-crossing pointer; 0 if none is given.
    pub(super) panel_inputs: [(u16, u32); 2],
    pub(super) panel_outputs: [(u16, u32); 2],
    /// `ExtendAlMsg` and `MsgUser`.
    pub(super) extended_messages: bool,
    pub(super) user_areas: u8,
    /// How often FC2 has run, without carry: jobs are answered after the next one.
    pub(super) general_calls: u16,
    /// `NCKomm`.
    pub(super) has_nc_communication: bool,
    /// `MMCToIF`.
    pub(super) takes_hmi_selections: bool,
    /// The selections of the HMI by channel, in the last call of FC2.
    pub(super) selections: [u8; 10],
    /// `UserIR`.
    pub(super) has_interrupt: bool,
    pub(super) messages: AlarmMessages,
    pub(super) panels: [ControlPanel; 2],
    /// The tasks of DB71 to DB73 that FC 8 or FC 7 have ended, one bit for each number.
    pub(super) ended_tasks: [u16; 3],
    /// FC 18 by axis.
    pub(super) spindles: Vec<(u8, SpinCtrl)>,
}

impl Default for BasicState {
    /// Without FB1: its defaults.
    fn default() -> Self {
        Self {
            panel_inputs: [(0, 0); 2],
            panel_outputs: [(0, 0); 2],
            extended_messages: false,
            user_areas: 10,
            general_calls: 0,
            has_nc_communication: false,
            takes_hmi_selections: true,
            selections: [0; 10],
            has_interrupt: false,
            messages: AlarmMessages::default(),
            panels: [ControlPanel::default(); 2],
            ended_tasks: [0; 3],
            spindles: Vec::new(),
        }
    }
}

impl BasicState {
    /// How DB2 is laid out.
    pub(super) fn message_layout(&self) -> MessageLayout {
        MessageLayout { is_extended: self.extended_messages, user_areas: self.user_areas }
    }
}
