//! Whether the PLC of a machine runs, and the time of its next scan.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use super::Machine;
use crate::image::{Memory, Part};
use crate::plc::{PlcDiagnosis, ProgramCause};
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

/// What a STOP resets, and the words of its causes.
const RESET: [(Part, &str); 2] =
    [(Part::Outputs, "PLC in STOP: its outputs are 0"), (Part::ToNck, "PLC in STOP: the signals to the NC are 0")];

impl Machine {
    /// The PLC goes to STOP: its outputs are 0, and the signals of its half of the interface what the control makes of them (P-150).
    /// Returns whether it ran before.
    pub(super) fn enter_stop(&mut self) -> bool {
        if std::mem::replace(&mut self.state.plc.stopped, true) {
            return false;
        }
        self.state.plc.stopped_in = self.state.cycle;
        let Memory { outputs, to_nck, .. } = &mut self.state.memory;
        outputs.fill(0);
        self.state.plc.neutralised = self.control.neutralise(to_nck);
        true
    }

    /// Why a STOP of the last cycle changed bits.
    pub(super) fn causes_of_stop(&self) -> impl Iterator<Item = ProgramCause> {
        let is_new = self.state.plc.stopped && self.state.plc.stopped_in == self.state.cycle;
        let neutralises = self.state.plc.neutralised;
        let rows = RESET.into_iter().filter(move |(part, _)| is_new && (neutralises || *part != Part::ToNck));
        rows.map(|(part, statement)| ProgramCause {
            part,
            bit: 0,
            bits: u32::try_from(self.state.memory.part(part).len()).unwrap_or(0) * 8,
            value: 0,
            statement: statement.into(),
            tested: Vec::new(),
        })
    }
}
