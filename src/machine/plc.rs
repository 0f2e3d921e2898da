//! The PLC of a machine: its program, and whether it runs.

use crate::plc::PlcProgram;
use crate::units::Time;

/// The PLC: its program, and whether it runs.
#[derive(Default)]
pub(super) struct Plc {
    pub(super) program: Option<Box<dyn PlcProgram>>,
    pub(super) stopped: bool,
    /// OB100 has run since the last start.
    pub(super) started: bool,
    /// NC cycles until the next scan.
    pub(super) wait: u64,
    pub(super) last_scan: Time,
    pub(super) fault: Option<String>,
}

impl Plc {
    pub(super) fn load(&mut self, program: Box<dyn PlcProgram>) {
        self.program = Some(program);
        self.restart();
    }

    pub(super) fn stop(&mut self) {
        self.stopped = true;
    }

    pub(super) fn restart(&mut self) {
        self.stopped = false;
        self.started = false;
        self.wait = 0;
        self.fault = None;
    }

    pub(super) fn power_on(&mut self) {
        if let Some(program) = &mut self.program {
            program.reset();
        }
        self.restart();
    }

    pub(super) fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }
}
