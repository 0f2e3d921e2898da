//! The verbs of a session that queue one command for the next cycle: data, power, the PLC, the operator, faults.

use std::path::Path;

use super::duration::Duration;
use super::failure::Failure;
use super::generators::{time_of, waveform, waveforms};
use super::naming::axis_named;
use super::programs::NcPrograms;
use super::searches::{search_kind, search_kinds};
use super::session::Session;
use super::values::Setting;
use crate::machine::{Command, DatumValue, Fault, FaultKind, FunctionGenerator};
use crate::source::{Place, Problem};
use crate::units::ChannelNumber;
use crate::variables::r_parameter;

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
        let Some((channel, number)) = r_parameter(name, self.machine.names())? else {
            let cure = "write `R5` for the first channel, `R5[CHAN2]` for channel 2";
            return Err(Problem::new(format!("expected an R parameter, found {name:?}"), cure).into());
        };
        // No channel has a parameter with a larger number.
        let number = u16::try_from(number).unwrap_or(u16::MAX);
        self.queue(Command::RParameter { channel, number, value })
    }

    /// Loads an NC program with those beside it, and selects it in a channel.
    ///
    /// # Errors
    /// The file cannot be read, or the channel does not exist.
    pub fn program(&mut self, file: &str, channel: u8) -> Result<(), Failure> {
        let mut programs = NcPrograms::of(&self.machine);
        let path = programs.file(file, Path::new(""), &Place::file(file))?;
        self.select(programs, path, channel)
    }

    /// Selects an NC program by its text.
    ///
    /// # Errors
    /// The channel does not exist.
    pub fn nc(&mut self, text: &str, channel: u8) -> Result<(), Failure> {
        let mut programs = NcPrograms::after(self.texts.clone(), &self.machine);
        let path = programs.text(text);
        self.texts = programs.texts().to_vec();
        self.select(programs, path, channel)
    }

    fn select(&mut self, programs: NcPrograms, path: String, channel: u8) -> Result<(), Failure> {
        let channel = channel_numbered(channel)?;
        programs.load(&mut self.machine);
        self.queue(Command::SelectProgram { channel, path })
    }

    /// Gives blocks to manual data input (MDA).
    ///
    /// # Errors
    /// The channel does not exist.
    pub fn mdi(&mut self, blocks: &str, channel: u8) -> Result<(), Failure> {
        let channel = channel_numbered(channel)?;
        self.queue(Command::EnterBlocks { channel, text: blocks.to_owned() })
    }

    /// Gives an axis another actual value at the place where it stands (PRESET), in millimetres or degrees.
    ///
    /// # Errors
    /// The axis does not exist, or it is a synchronous axis of a gantry grouping.
    pub fn preset(&mut self, axis: &str, value: f64) -> Result<(), Failure> {
        let axis = axis_named(&self.machine, axis)?;
        self.queue(Command::Preset { axis, value })
    }

    /// Gives the function generator a signal (`sine`, `square` or `triangle`) for an axis; NC start in JOG begins it. The amplitudes are those of
    /// the axis and of the axes coupled with it, in millimetres or degrees like the offset; the frequency is in hertz.
    ///
    /// # Errors
    /// The axis or the signal does not exist, the text is not a duration, or a value is out of range.
    pub fn function_generator(
        &mut self,
        axis: &str,
        signal: &str,
        amplitude: [f64; 2],
        offset: f64,
        frequency: f64,
        duration: &str,
    ) -> Result<(), Failure> {
        let axis = axis_named(&self.machine, axis)?;
        let Some(signal) = waveform(signal) else {
            let found = format!("expected a signal of the function generator, found {signal:?}");
            return Err(Problem::new(found, waveforms()).into());
        };
        let duration = time_of(Duration::parse(duration)?, &self.machine);
        self.queue(Command::FunctionGenerator(FunctionGenerator {
            axis,
            signal,
            amplitude,
            offset,
            frequency,
            duration,
        }))
    }

    /// Searches a block of the selected program: `N50`, `:50` or a label. The kind is `contour`, `end_point`, `serupro` or `without_calculation`.
    ///
    /// # Errors
    /// There is no such kind, or the channel does not exist.
    pub fn search(&mut self, block: &str, kind: &str, channel: u8) -> Result<(), Failure> {
        let channel = channel_numbered(channel)?;
        let Some(kind) = search_kind(kind) else {
            let found = format!("expected the kind of a block search, found {kind:?}");
            return Err(Problem::new(found, search_kinds()).into());
        };
        self.queue(Command::Search { channel, block: block.to_owned(), kind })
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

fn channel_numbered(number: u8) -> Result<ChannelNumber, Problem> {
    let found = || Problem::new(format!("expected a channel from 1 to 10, found {number}"), "count channels from 1");
    ChannelNumber::new(number).ok_or_else(found)
}
