//! Save, restore and fork. A restored machine continues with identical bytes.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::Machine;
use super::before::Before;
use super::state::State;
use crate::image::Names;
use crate::plc::PlcProgram;
use crate::source::Problem;
use crate::trace::Recorder;
use crate::units::{AxisSet, PerAxis, PerChannel};
use crate::variables::Alarms;

/// Version of the format of a saved machine.
const VERSION: u32 = 9;

#[derive(Serialize, Deserialize)]
struct Saved {
    names: SavedNames,
    /// The name of the control and its state.
    control: (String, Vec<u8>),
    program: Option<(String, Vec<u8>)>,
    state: State,
}

/// The names of the saved machine.
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

impl Machine {
    /// The complete state of a machine, as bytes. The contents of its files are not included.
    #[must_use]
    #[expect(clippy::missing_panics_doc, reason = "plain data is always written")]
    pub fn save(&self) -> Vec<u8> {
        let saved = Saved {
            names: SavedNames::of(&self.definition.names),
            control: (self.control.texts().name().to_owned(), self.control.save()),
            program: self.program.as_ref().map(|program| (program.name().to_owned(), program.save())),
            state: self.state.clone(),
        };
        let content = postcard::to_stdvec(&saved).expect("plain data can always be written");
        [&VERSION.to_le_bytes()[..], &checksum(&content).to_le_bytes(), &content].concat()
    }

    /// Continues from the state at [`Machine::save`], on a machine with the same files and the same PLC program.
    ///
    /// # Errors
    /// The bytes are not a saved machine, or they belong to a machine with other axes, another control or another PLC program. In this case
    /// nothing has changed.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), Problem> {
        let damaged =
            |what: String| Problem::new(what, "restore bytes from `save` of this version, on the same machine");
        let content = content(bytes).map_err(damaged)?;
        let saved: Saved = postcard::from_bytes(content)
            .map_err(|error| damaged(format!("expected a saved machine, found damaged bytes: {error}")))?;
        if saved.names != SavedNames::of(&self.definition.names) {
            return Err(damaged(
                "expected a saved machine with the same axes and channels, found other axes or channels".to_owned(),
            ));
        }
        let (control, remembered) = &saved.control;
        if control != self.control.texts().name() || !saved.state.memory.fits(self.definition.names.interface()) {
            return Err(damaged(
                "expected a saved machine with the same interface, found another interface".to_owned(),
            ));
        }
        // Program and control keep their state when they refuse. The program is restored last, so an error changes nothing.
        let mut restored = self.control.clone_box();
        restored.restore(remembered)?;
        match (&mut self.program, &saved.program) {
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
        self.control = restored;
        self.state = saved.state;
        self.state.plant.press_switches(&self.definition.layout, AxisSet::ALL);
        self.before = Before::new(&self.state.memory);
        self.alarms_before.clear();
        self.alarms_before.extend(self.state.variables.alarms.iter());
        self.recorder.clear();
        Ok(())
    }

    /// A second, independent machine that continues from the present state. Its record begins here.
    ///
    /// # Errors
    /// The PLC program cannot be forked.
    pub fn fork(&self) -> Result<Self, Problem> {
        let program = match &self.program {
            None => None,
            Some(program) => Some(program.fork().ok_or_else(|| {
                Problem::new(
                    format!("expected a PLC program that can be forked, found `{}`", program.name()),
                    "write it as a closure over its own state: opennck::plc::program",
                )
            })?),
        };
        Ok(self.copy(program, Recorder::default(), Before::new(&self.state.memory)))
    }

    /// The present state of the machine, for reading while this machine continues.
    #[must_use]
    pub fn snapshot(&self) -> Snapshot {
        Snapshot(self.copy(None, Recorder::without_capacity(), Before::without_capacity()))
    }

    fn copy(&self, program: Option<Box<dyn PlcProgram>>, recorder: Recorder, before: Before) -> Self {
        let mut alarms_before = Vec::with_capacity(Alarms::CAPACITY);
        alarms_before.extend_from_slice(&self.alarms_before);
        Self {
            definition: Arc::clone(&self.definition),
            control: self.control.clone_box(),
            program,
            state: self.state.clone(),
            before,
            alarms_before,
            recorder,
        }
    }
}

/// A copy of a machine after a step, without its program and its record. It does not run. It is for reading only and cannot be saved or
/// forked.
#[derive(Debug)]
pub struct Snapshot(Machine);

impl std::ops::Deref for Snapshot {
    type Target = Machine;

    fn deref(&self) -> &Machine {
        &self.0
    }
}

/// The content after version and checksum. It is complete and of this version, so a machine has written every index and length in it.
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
