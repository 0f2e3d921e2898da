//! Start-up of the control: 104.7, then 108.5, 108.6 and 108.7, a few cycles apart (O-20).

use crate::sinumerik::alarms::Reaction;
use crate::sinumerik::operation::state::RunUp;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::variables::{EventId, Place};

/// Duration of each step in cycles.
const STEP: u8 = 2;

impl State {
    /// One cycle of the start-up.
    pub(in crate::sinumerik) fn run_up(&mut self, parameters: &Parameters) {
        let ready = self.summary.drive_ready.has_all_of(parameters.existing);
        let run_up = &mut self.run_up;
        let before = *run_up;
        run_up.drives_ready = ready;
        // The last step waits for the drives.
        if run_up.cycles < 2 * STEP || run_up.cycles < 3 * STEP && ready {
            run_up.cycles += 1;
        }
        let steps = |r: &RunUp| (r.is_cpu_ready(), r.are_drives_cyclic(), r.are_drives_ready(), r.is_nc_ready());
        if steps(&before) != steps(run_up) {
            // After the start-up, a later change comes from a drive.
            let drives = parameters.existing.iter().map(|axis| self.axes[axis].monitor.drive_cause);
            let parent = drives.max().unwrap_or(EventId::NONE);
            run_up.cause = self.log.note_plain(Place::Nck, Rule::RunUp, parent);
        }
    }

    /// 108.7.
    pub(in crate::sinumerik) fn is_nc_ready(&self) -> bool {
        self.run_up.is_nc_ready() && self.alarms.with_reaction(Reaction::NC_NOT_READY, None).is_none()
    }
}
