//! Start-up of the control: 104.7, then 108.5, 108.6 and 108.7, a few cycles apart (O-20). Also whether the PLC program runs.

use crate::image::axis_from_nck::drive_ready;
use crate::image::nck_from_nck::{drives_in_cyclic_operation, drives_ready};
use crate::sinumerik::alarms::Reaction;
use crate::sinumerik::inputs::{axis_signal, nck_signal};
use crate::sinumerik::nck::Nck;
use crate::sinumerik::operation::state::RunUp;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::variables::{EventId, Input, Place};

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
        if before.cycles == 0 {
            self.report_cycle(parameters);
        }
        let run_up = &mut self.run_up;
        let steps = |r: &RunUp| (r.is_cpu_ready(), r.are_drives_cyclic(), r.is_nc_ready());
        let (stepped, changed) =
            (steps(&before) != steps(run_up), before.are_drives_ready() != run_up.are_drives_ready());
        if stepped {
            // Each step follows the one before; the last one also waits for the drives.
            let input = if run_up.is_nc_ready() { nck_signal(drives_ready, true) } else { Input::None };
            let parent = if before.cause.is_some() { before.cause } else { self.power_on_cause };
            run_up.cause = self.log.note_one(Place::Nck, Rule::RunUp, input, parent);
        }
        if changed {
            let shown = run_up.are_drives_ready();
            self.run_up.drives_cause = self.note_drives(shown, stepped, parameters);
        }
    }

    /// 108.6 has changed: the drive that became ready last, or one that is not ready.
    fn note_drives(&mut self, ready: bool, stepped: bool, parameters: &Parameters) -> EventId {
        let (cause, without) = (|axis| self.axes[axis].monitor.drive_cause, self.summary.drive_ready);
        let axis = if ready {
            parameters.existing.iter().max_by_key(|&axis| cause(axis))
        } else {
            parameters.existing.without(without).iter().next()
        };
        let silent = axis.is_none_or(|axis| parameters.axes[axis].silent);
        let shown = |axis| axis_signal(axis, drive_ready, ready);
        let drive = if silent { Input::None } else { axis.map_or(Input::None, shown) };
        let cyclic = if ready { nck_signal(drives_in_cyclic_operation, true) } else { Input::None };
        let parent = if stepped { self.run_up.cause } else { axis.map_or(EventId::NONE, cause) };
        let rule = if ready { Rule::DrivesReady } else { Rule::DrivesNotReady };
        self.log.note(Place::Nck, rule, [drive, cyclic, Input::None], parent)
    }

    /// 108.7.
    pub(in crate::sinumerik) fn is_nc_ready(&self) -> bool {
        self.run_up.is_nc_ready() && self.alarms.with_reaction(Reaction::NC_NOT_READY, None).is_none()
    }
}

impl Nck {
    /// The PLC program does not run, or runs again after power on.
    pub fn plc_missing(&mut self) -> EventId {
        if !self.state.plc_missing {
            self.state.plc_missing = true;
            self.state.plc_cause = self.state.log.note_plain(Place::Nck, Rule::PlcStopped, EventId::NONE);
        }
        self.state.plc_cause
    }

    /// The PLC program runs again; alarm 2000 stays until power off.
    pub fn plc_restarted(&mut self) {
        self.state.plc_missing = false;
    }
}
