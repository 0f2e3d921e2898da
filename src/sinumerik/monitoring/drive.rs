//! Monitoring of a drive: its fault (25201), and a missing ready signal (25202).
//!
//! A fault resets 93.5 and, through the pulses, 93.7; if the axis is in motion, 21612 with cause 4 is raised as well. 25202 is
//! raised for a drive that has not started up within [`START_UP_LIMIT`] after 108.5 (drives in cyclic operation). The manuals give no
//! time.

use crate::image::{axis_from_nck, nck_from_nck};
use crate::sinumerik::alarms;
use crate::sinumerik::inputs::{axis_signal, nck_signal};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, Time};
use crate::variables::{Input, Place};

/// Start-up time of a drive without a message.
const START_UP_LIMIT: Time = Time::from_millis(1_000);

impl State {
    pub(in crate::sinumerik) fn monitor_drive(&mut self, number: AxisNumber, parameters: &Parameters) {
        let (ready, fault) = (self.feedback[number].drive_ready, self.feedback[number].drive_fault);
        let fault_cause = self.axes[number].causes.fault;
        let was_ready = std::mem::replace(&mut self.axes[number].monitor.drive_was_ready, ready);
        if ready {
            let monitor = &mut self.axes[number].monitor;
            monitor.drive_waits = 0;
            if !was_ready {
                let before = monitor.drive_cause;
                let (rule, parent) = if before.is_some() {
                    (Rule::DriveReadyAgain, before.max(fault_cause))
                } else {
                    (Rule::DriveReady, self.power_on_cause)
                };
                monitor.drive_cause = self.log.note_plain(Place::Axis(number), rule, parent);
            }
            return;
        }
        let not_ready = axis_signal(number, axis_from_nck::drive_ready, false);
        let cyclic = nck_signal(nck_from_nck::drives_in_cyclic_operation, true);
        if fault {
            self.raise_monitoring(alarms::DRIVE_FAULT, number, Rule::DriveFault, [Input::None; 3]);
        }
        if was_ready {
            let fault = self.alarms.cause(alarms::DRIVE_FAULT, Place::Axis(number));
            let parent = if fault.is_some() { fault } else { self.axes[number].monitor.drive_cause.max(fault_cause) };
            self.axes[number].monitor.drive_cause = self.log.note_plain(Place::Axis(number), Rule::DriveLost, parent);
        }
        if fault {
            return;
        }
        if self.run_up.are_drives_cyclic() {
            let (monitor, limit) = (&mut self.axes[number].monitor, START_UP_LIMIT.in_cycles(parameters.cycle));
            monitor.drive_waits = (monitor.drive_waits + 1).min(limit + 1);
            if monitor.drive_waits > limit {
                self.raise_monitoring(
                    alarms::WAITING_FOR_DRIVE,
                    number,
                    Rule::DriveNotReady,
                    [not_ready, cyclic, Input::None],
                );
            }
        }
    }
}
