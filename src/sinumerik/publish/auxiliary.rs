//! DB21 to DB30, bytes 58 to 271: auxiliary functions, and the active G functions of the groups in MD22510; bytes 318 and 319: searches and
//! associated stops.

use crate::image::{ChannelAuxiliary, channel_auxiliary, channel_search_from_nck};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::program::auxiliary::BYTES;
use crate::sinumerik::program::search_state::Search;
use crate::sinumerik::publish::rows::{Rows, Why};
use crate::sinumerik::state::State;
use crate::units::ChannelNumber;

impl State {
    pub(super) fn show_auxiliary(&self, channel: ChannelNumber, parameters: &Parameters, rows: &mut impl Rows) {
        let program = &self.programs[channel];
        let output = program.output.bytes().unwrap_or(&[0; BYTES]);
        rows.bytes(ChannelAuxiliary::FIRST, output, || Why::Event(program.output.cause));
        let Some(own) = parameters.programs[channel].as_deref() else { return };
        let mut shown = [0; 64];
        for (place, &group) in own.shown_groups.iter().enumerate() {
            let Some(index) = usize::from(group).checked_sub(1) else { continue };
            let at = if own.shows_groups_in_order { place } else { index };
            if let Some(byte) = shown.get_mut(at) {
                *byte = program.modal.index(group);
            }
        }
        let first = channel_auxiliary::active_g_function_of_group_1.byte;
        rows.bytes(first, &shown, || Why::Event(program.modal_cause));
    }

    /// DB21.DBX318.x.
    pub(super) fn show_search(&self, channel: ChannelNumber, rows: &mut impl Rows) {
        let program = &self.programs[channel];
        let by_test = program.search().is_some_and(Search::is_by_program_test);
        rows.bit(channel_search_from_nck::search_by_program_test_active, by_test, || Why::Event(program.search_cause));
        rows.bit(channel_search_from_nck::associated_m0_m1_active, program.associated_stop, || {
            Why::Event(program.cause)
        });
    }
}
