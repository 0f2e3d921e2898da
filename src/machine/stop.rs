//! STOP of the PLC: what it resets, and the causes of these changes.

use super::Machine;
use crate::image::{Memory, Part};
use crate::plc::ProgramCause;

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
