//! Whether the PLC of a machine runs, and the time of its next scan.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::plc::PlcDiagnosis;
use crate::units::Time;

/// The state of the PLC without its program.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct PlcState {
    /// It was stopped by a command, or its program failed.
    pub(super) stopped: bool,
    /// The cycle in which it stopped.
    pub(super) stopped_in: u64,
    /// Its signals to the control were reset then.
    pub(super) neutralised: bool,
    /// OB100 has run since the last start.
    pub(super) started: bool,
    /// NC cycles until the next scan.
    pub(super) wait: u64,
    pub(super) last_scan: Time,
    /// The scans whose writes have not reached the control (`to_nck_delay`), by their cycles.
    pub(super) scans: VecDeque<u64>,
    /// The fault of its program.
    pub(super) fault: Option<String>,
    /// The messages that it shows.
    pub(super) messages: Vec<u32>,
    /// Its entries for the diagnostic buffer.
    pub(super) diagnosis: Option<PlcDiagnosis>,
}

impl PlcState {
    /// OB100 runs in the next scan.
    pub(super) fn restart(&mut self) {
        self.stopped = false;
        self.started = false;
        self.wait = 0;
        self.fault = None;
        self.diagnosis = None;
    }
}
