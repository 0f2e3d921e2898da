//! The lamps of a machine control panel, from the signals of the NCK.

use super::panel::{ControlPanel, PanelInputs};
use crate::plc::Link;

/// A byte of these bits, bit 7 first.
fn byte(bits: [bool; 8]) -> u8 {
    bits.into_iter().fold(0, |byte, bit| byte << 1 | u8::from(bit))
}

impl ControlPanel {
    pub(super) fn lamps(&self, link: &Link<'_>, inputs: &PanelInputs) -> [u8; 8] {
        let mut lamps = [0; 8];
        if let Some(group) = inputs.mode_group {
            let group = link.from_nck.mode_group(group);
            lamps[0] = byte([
                group.active_machine_function_increment_1000(),
                group.active_machine_function_increment_100(),
                group.active_machine_function_increment_10(),
                group.active_machine_function_increment_1(),
                group.active_mode_jog(),
                group.active_machine_function_teach_in(),
                group.active_mode_mdi(),
                group.active_mode_automatic(),
            ]);
            lamps[1] = byte([
                false,
                false,
                false,
                false,
                group.active_machine_function_repos(),
                group.active_machine_function_ref(),
                group.active_machine_function_increment_variable(),
                group.active_machine_function_increment_10000(),
            ]);
        }
        let (runs, stopped) = inputs.channel.map_or((false, false), |channel| {
            let channel = link.from_nck.channel(channel);
            (channel.program_state_running(), channel.program_state_stopped())
        });
        lamps[1] |= byte([!self.feed_hold, self.feed_hold, runs, stopped, false, false, false, false]);
        let axis = |key| self.is_selected(key);
        lamps[2] = byte([
            inputs.keys[4] >> 6 & 1 == 1,
            axis(1),
            axis(4),
            axis(7),
            false,
            self.stops_after_each_block(),
            inputs.spindle.is_some() && !self.spindle_hold,
            inputs.spindle.is_some() && self.spindle_hold,
        ]);
        lamps[3] =
            byte([axis(3), axis(5), self.is_in_workpiece_coordinates(), false, axis(9), axis(8), axis(6), axis(2)]);
        lamps
    }
}
