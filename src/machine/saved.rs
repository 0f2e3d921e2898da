//! Save, restore and fork: a machine goes on from where it was, byte for byte.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::before::Before;
use super::plc::Plc;
use super::written::Force;
use super::{Command, Machine};
use crate::image::{Memory, Names};
use crate::motion::Feedback;
use crate::plant::Plant;
use crate::plc::PlcProgram;
use crate::sinumerik::SavedControl;
use crate::source::Problem;
use crate::trace::Recorder;
use crate::units::{PerAxis, PerChannel, Time};
use crate::variables::{Alarms, EventId, RParameters, Variables};

/// Which form of saved machine this is.
const VERSION: u32 = 6;

#[derive(Serialize, Deserialize)]
struct SavedV6 {
    names: SavedNames,
    control: SavedControl,
    plant: Plant,
    memory: Memory,
    variables: Variables,
    r_parameters: RParameters,
    feedback: PerAxis<Feedback>,
    forces: Vec<Force>,
    queue: Vec<Command>,
    cycle: u64,
    time: Time,
    /// The last event that the record has; those before the first step are recorded with it.
    recorded: EventId,
    plc: SavedPlc,
}

/// Of which machine it is.
#[derive(PartialEq, Serialize, Deserialize)]
struct SavedNames {
    interface: String,
    profile: String,
    axes: PerAxis<Option<String>>,
    channels: PerChannel<Option<String>>,
}

impl SavedNames {
    fn of(names: &Names) -> Self {
        Self {
            interface: names.interface().tables().name.to_owned(),
            profile: names.profile.name().to_owned(),
            axes: names.axes.clone(),
            channels: names.channels.clone(),
        }
    }
}

#[derive(Serialize, Deserialize)]
struct SavedPlc {
    program: Option<(String, Vec<u8>)>,
    stopped: bool,
    started: bool,
    wait: u64,
    last_scan: Time,
    fault: Option<String>,
}

impl Machine {
    /// Everything that a machine remembers, as bytes; what its files said is not among it.
    #[must_use]
    #[expect(clippy::missing_panics_doc, reason = "plain data is always written")]
    pub fn save(&self) -> Vec<u8> {
        let saved = SavedV6 {
            names: SavedNames::of(&self.definition.names),
            control: self.control.save(),
            plant: self.plant.clone(),
            memory: self.memory.clone(),
            variables: self.variables.clone(),
            r_parameters: self.r_parameters.clone(),
            feedback: self.feedback,
            forces: self.forces.clone(),
            queue: self.queue.clone(),
            cycle: self.cycle,
            time: self.time,
            recorded: self.before.last_event,
            plc: SavedPlc {
                program: self.plc.program.as_ref().map(|program| (program.name().to_owned(), program.save())),
                stopped: self.plc.stopped,
                started: self.plc.started,
                wait: self.plc.wait,
                last_scan: self.plc.last_scan,
                fault: self.plc.fault.clone(),
            },
        };
        let content = postcard::to_stdvec(&saved).expect("plain data can always be written");
        [&VERSION.to_le_bytes()[..], &checksum(&content).to_le_bytes(), &content].concat()
    }

    /// Goes on from where [`Machine::save`] was called, on a machine of the same files with the same PLC program.
    ///
    /// # Errors
    /// The bytes are no saved machine, or one of other axes or another PLC program; nothing has changed then.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), Problem> {
        let damaged =
            |what: String| Problem::new(what, "restore what `save` of this version gave, on the same machine");
        let content = content(bytes).map_err(damaged)?;
        let saved: SavedV6 = postcard::from_bytes(content)
            .map_err(|error| damaged(format!("expected a saved machine, found damaged bytes: {error}")))?;
        if saved.names != SavedNames::of(&self.definition.names) {
            return Err(damaged("expected a saved machine with the same axes and channels, found others".to_owned()));
        }
        if !saved.memory.fits(self.definition.names.interface()) {
            return Err(damaged("expected a saved machine with the same interface, found another".to_owned()));
        }
        match (&mut self.plc.program, &saved.plc.program) {
            (None, None) => {}
            (Some(program), Some((name, state))) if program.name() == name => {
                program.restore(state)?;
            }
            (mine, theirs) => {
                let name =
                    |program: Option<&str>| program.map_or_else(|| "none".to_owned(), |name| format!("`{name}`"));
                let mine = name(mine.as_ref().map(|program| program.name()));
                let theirs = name(theirs.as_ref().map(|(name, _)| name.as_str()));
                return Err(damaged(format!("expected the PLC program {mine}, found {theirs}")));
            }
        }
        self.control.restore(saved.control);
        self.plant = saved.plant;
        self.plant.press_switches(&self.definition.layout, crate::units::AxisSet::ALL);
        self.memory = saved.memory;
        self.variables = saved.variables;
        self.r_parameters = saved.r_parameters;
        self.feedback = saved.feedback;
        self.forces = saved.forces;
        self.queue = saved.queue;
        (self.cycle, self.time) = (saved.cycle, saved.time);
        self.plc.stopped = saved.plc.stopped;
        self.plc.started = saved.plc.started;
        self.plc.wait = saved.plc.wait;
        self.plc.last_scan = saved.plc.last_scan;
        self.plc.fault = saved.plc.fault;
        self.before = Before::new(&self.memory, saved.recorded);
        self.alarms_before.clear();
        self.alarms_before.extend(self.variables.alarms.iter());
        self.recorder.clear();
        Ok(())
    }

    /// A second machine that goes on from here by itself, with a record that begins here.
    ///
    /// # Errors
    /// The PLC program cannot be forked.
    pub fn fork(&self) -> Result<Self, Problem> {
        let program = match &self.plc.program {
            None => None,
            Some(program) => Some(program.fork().ok_or_else(|| {
                Problem::new(
                    format!("expected a PLC program that can be forked, found `{}`", program.name()),
                    "write it as a closure over its own state: opennck::plc::program",
                )
            })?),
        };
        Ok(self.copy(program, Recorder::default(), Before::new(&self.memory, self.before.last_event)))
    }

    /// The machine as it is now, to be looked at while this one goes on.
    #[cfg(feature = "live")]
    pub(crate) fn snapshot(&self) -> Snapshot {
        Snapshot(self.copy(None, Recorder::without_room(), Before::without_room()))
    }

    fn copy(&self, program: Option<Box<dyn PlcProgram>>, recorder: Recorder, before: Before) -> Self {
        let mut plc = Plc::default();
        plc.program = program;
        plc.stopped = self.plc.stopped;
        plc.started = self.plc.started;
        plc.wait = self.plc.wait;
        plc.last_scan = self.plc.last_scan;
        plc.fault.clone_from(&self.plc.fault);
        let mut alarms_before = Vec::with_capacity(Alarms::CAPACITY);
        alarms_before.extend_from_slice(&self.alarms_before);
        Self {
            definition: Arc::clone(&self.definition),
            control: self.control.clone(),
            plant: self.plant.clone(),
            memory: self.memory.clone(),
            variables: self.variables.clone(),
            r_parameters: self.r_parameters.clone(),
            plc,
            forces: self.forces.clone(),
            queue: self.queue.clone(),
            displaced: Vec::new(),
            cycle: self.cycle,
            time: self.time,
            feedback: self.feedback,
            before,
            alarms_before,
            recorder,
        }
    }
}

/// A machine that stands still: what another one was after some step, without its program and its record. It is for who looks only:
/// it can be neither saved nor forked as that machine.
#[cfg(feature = "live")]
#[derive(Debug)]
pub(crate) struct Snapshot(Machine);

#[cfg(feature = "live")]
impl std::ops::Deref for Snapshot {
    type Target = Machine;

    fn deref(&self) -> &Machine {
        &self.0
    }
}

/// What stands behind version and checksum: whole and of this version, so that every index and length in it is one
/// that a machine has written.
fn content(bytes: &[u8]) -> Result<&[u8], String> {
    let too_short = || "expected a saved machine, found too few bytes".to_owned();
    let (version, rest) = bytes.split_first_chunk().ok_or_else(too_short)?;
    let version = u32::from_le_bytes(*version);
    if version != VERSION {
        return Err(format!("expected a saved machine of version {VERSION}, found version {version}"));
    }
    let (written, content) = rest.split_first_chunk().ok_or_else(too_short)?;
    if u64::from_le_bytes(*written) != checksum(content) {
        return Err("expected a saved machine, found damaged bytes: their checksum differs".to_owned());
    }
    Ok(content)
}

/// FNV-1a, 64 bits.
fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xCBF2_9CE4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3))
}
