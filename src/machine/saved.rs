//! Save, restore and fork. A restored machine continues with identical bytes.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::Machine;
use super::before::Before;
use super::definition::{Definition, Fingerprints, hash};
use super::state::State;
use super::written::FIXED;
use crate::image::{Memory, Part};
use crate::plc::PlcProgram;
use crate::source::Problem;
use crate::trace::Recorder;
use crate::units::{AxisSet, PerAxis, PerChannel};
use crate::variables::Alarms;

/// Version of the format of a saved machine.
const VERSION: u32 = 16;

#[derive(Serialize, Deserialize)]
struct Saved {
    definition: SavedDefinition,
    /// The name of the control and its state.
    control: (String, Vec<u8>),
    program: Option<(String, Vec<u8>)>,
    state: State,
}

/// What the files of the saved machine defined.
#[derive(Serialize, Deserialize)]
struct SavedDefinition {
    interface: String,
    profile: String,
    axes: PerAxis<Option<String>>,
    channels: PerChannel<Option<String>>,
    fingerprints: Fingerprints,
}

impl SavedDefinition {
    fn of(definition: &Definition) -> Self {
        let names = &definition.names;
        Self {
            interface: names.interface().tables().name.to_owned(),
            profile: names.profile.name().to_owned(),
            axes: names.axes.clone(),
            channels: names.channels.clone(),
            fingerprints: definition.fingerprints(),
        }
    }

    /// How a saved machine differs in its names: what was expected and what was found.
    fn other_names(&self, saved: &Self) -> Option<(String, String)> {
        let said = |what: &str, name: Option<&str>| match name {
            Some(name) => format!("{what} `{name}`"),
            None => format!("no {what}"),
        };
        let differ = |what: &str, mine: Option<&str>, other: Option<&str>| {
            (mine != other).then(|| (said(what, mine), said(what, other)))
        };
        let axes = || {
            self.axes.iter().find_map(|(number, mine)| {
                differ(&format!("axis {number}"), mine.as_deref(), saved.axes[number].as_deref())
            })
        };
        let channels = || {
            self.channels.iter().find_map(|(number, mine)| {
                differ(&format!("channel {number}"), mine.as_deref(), saved.channels[number].as_deref())
            })
        };
        differ("interface", Some(&self.interface), Some(&saved.interface))
            .or_else(|| differ("profile", Some(&self.profile), Some(&saved.profile)))
            .or_else(axes)
            .or_else(channels)
    }

    /// How a saved machine differs in the contents of its files.
    fn other_files(&self, saved: &Self) -> Option<(String, String)> {
        let (mine, other) = (self.fingerprints, saved.fingerprints);
        let all = [
            ("PLC image", mine.plc_image, other.plc_image),
            ("plant (plant.toml and changes to it)", mine.plant, other.plant),
            ("machine data and settings of the control at opening", mine.machine_data, other.machine_data),
        ];
        let (what, ..) = all.into_iter().find(|(_, mine, other)| mine != other)?;
        Some((format!("the same {what}"), "others".to_owned()))
    }
}

/// How a saved memory differs in the lengths of its areas.
fn other_areas(mine: &Memory, saved: &Memory) -> Option<(String, String)> {
    // A block that only the saved memory has was made by the program.
    let blocks = mine.blocks.iter().map(|block| Part::Block(block.number));
    let part = FIXED.into_iter().chain(blocks).find(|part| mine.part(*part).len() != saved.part(*part).len())?;
    let said = |memory: &Memory| match (part, memory.part(part).len()) {
        (Part::Block(number), 0) => format!("no DB{number}"),
        (Part::Block(number), length) => format!("{length} bytes of DB{number}"),
        (part, length) => format!("{length} bytes of {part:?}"),
    };
    Some((said(mine), said(saved)))
}

impl Machine {
    /// The complete state of a machine, as bytes. The contents of its files are not included.
    #[must_use]
    #[expect(clippy::missing_panics_doc, reason = "plain data is always written")]
    pub fn save(&self) -> Vec<u8> {
        let saved = Saved {
            definition: SavedDefinition::of(&self.definition),
            control: (self.control.texts().name().to_owned(), self.control.save()),
            program: self.program.as_ref().map(|program| (program.name().to_owned(), program.save())),
            state: self.state.clone(),
        };
        let content = postcard::to_stdvec(&saved).expect("plain data can always be written");
        [&VERSION.to_le_bytes()[..], &hash(&content).to_le_bytes(), &content].concat()
    }

    /// Continues from the state at [`Machine::save`], on a machine with the same files and the same PLC program.
    ///
    /// # Errors
    /// The bytes are not a saved machine, or they belong to a machine with another definition or another PLC program; the problem names what
    /// differs. In this case nothing has changed. Machine data that were changed at run time are part of the state and may differ.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), Problem> {
        let damaged =
            |what: String| Problem::new(what, "restore bytes from `save` of this version, on the same machine");
        let content = content(bytes).map_err(damaged)?;
        let (saved, rest) = postcard::take_from_bytes::<Saved>(content)
            .map_err(|error| damaged(format!("expected a saved machine, found damaged bytes: {error}")))?;
        if !rest.is_empty() {
            return Err(damaged(format!("expected a saved machine, found {} bytes after it", rest.len())));
        }
        let mine = SavedDefinition::of(&self.definition);
        let (control, remembered) = &saved.control;
        let name = self.control.texts().name();
        let other_control = || (control != name).then(|| (format!("control `{name}`"), format!("control `{control}`")));
        let different = mine
            .other_names(&saved.definition)
            .or_else(other_control)
            .or_else(|| other_areas(&self.definition.memory, &saved.state.memory))
            .or_else(|| mine.other_files(&saved.definition));
        if let Some((expected, found)) = different {
            return Err(damaged(format!("expected a saved machine with {expected}, found {found}")));
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
    if u64::from_le_bytes(*written) != hash(content) {
        return Err("expected a saved machine, found damaged bytes: their checksum differs".to_owned());
    }
    Ok(content)
}
