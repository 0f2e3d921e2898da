//! The verbs of a session that queue one command for the next cycle: data, power, the PLC, the operator, faults.

use super::duration::Duration;
use super::failure::Failure;
use super::naming::axis_named;
use super::session::Session;
use super::steps::r_parameter;
use super::values::Setting;
use crate::machine::{Command, DatumValue, Fault, FaultKind};
use crate::source::Problem;

impl Session {
    /// Stores a machine datum, as `34090[XF]`. It takes effect as its activation class defines.
    ///
    /// # Errors
    /// The machine datum does not exist, or it rejects the value.
    pub fn machine_data(&mut self, target: &str, value: impl Into<Setting>) -> Result<(), Failure> {
        let value = match value.into() {
            Setting::Integer(number) => DatumValue::Integer(number),
            Setting::Float(number) => DatumValue::Real(number),
            Setting::Boolean(value) => DatumValue::Boolean(value),
            Setting::Text(text) => DatumValue::Text(text),
        };
        self.queue(Command::MachineDatum { target: target.to_owned(), value })
    }

    /// Writes an R parameter: `R5` of the first channel, `R5[CHAN2]` of channel 2.
    ///
    /// # Errors
    /// The parameter does not exist.
    pub fn r_parameter(&mut self, name: &str, value: f64) -> Result<(), Failure> {
        let Some((channel, number)) = r_parameter(name) else {
            let cure = "write `R5` for the first channel, `R5[CHAN2]` for channel 2";
            return Err(Problem::new(format!("expected an R parameter, found {name:?}"), cure).into());
        };
        self.queue(Command::RParameter { channel, number, value })
    }

    /// Turns a handwheel by a number of pulses, evenly spread over a time.
    ///
    /// # Errors
    /// The handwheel does not exist, or the text is not a duration.
    pub fn handwheel(&mut self, number: u8, pulses: i32, over: &str) -> Result<(), Failure> {
        let cycles = Duration::parse(over)?.cycles(self.machine.cycle_time());
        self.queue(Command::Handwheel { number, pulses, cycles })
    }

    /// "Set machine data active" (NEWCONF).
    ///
    /// # Errors
    /// The machine rejects the command.
    pub fn new_conf(&mut self) -> Result<(), Failure> {
        self.queue(Command::NewConf)
    }

    /// Switches the control off and on again.
    ///
    /// # Errors
    /// The machine rejects the command.
    pub fn power_on(&mut self) -> Result<(), Failure> {
        self.queue(Command::PowerOn)
    }

    /// Stops the PLC.
    ///
    /// # Errors
    /// The machine rejects the command.
    pub fn plc_stop(&mut self) -> Result<(), Failure> {
        self.queue(Command::PlcStop)
    }

    /// Restarts the PLC.
    ///
    /// # Errors
    /// The machine rejects the command.
    pub fn plc_run(&mut self) -> Result<(), Failure> {
        self.queue(Command::PlcRun)
    }

    /// Restarts the PLC from the beginning: its memory returns to its initial values.
    ///
    /// # Errors
    /// The machine rejects the command.
    pub fn plc_cold(&mut self) -> Result<(), Failure> {
        self.queue(Command::PlcColdRestart)
    }

    /// The operator's alarm-cancel key.
    ///
    /// # Errors
    /// The machine rejects the command.
    pub fn cancel(&mut self) -> Result<(), Failure> {
        self.queue(Command::Cancel)
    }

    /// Begins a fault on an axis.
    ///
    /// # Errors
    /// The axis does not exist.
    pub fn fault(&mut self, axis: &str, kind: FaultKind) -> Result<(), Failure> {
        let axis = axis_named(&self.machine, axis)?;
        self.queue(Command::Fault(Fault { axis, kind }))
    }

    /// Ends a fault on an axis.
    ///
    /// # Errors
    /// The axis does not exist.
    pub fn clear_fault(&mut self, axis: &str, kind: FaultKind) -> Result<(), Failure> {
        let axis = axis_named(&self.machine, axis)?;
        self.queue(Command::ClearFault(Fault { axis, kind }))
    }
}
