//! The inputs of a live machine: a machine with its PLC program and PLC image, or a scenario that runs on it. Also the reverse: the heading
//! of a recording that repeats the session.
//!
//! A scenario brings its own machine, program and image, its profile (the first one), its `[plant]`, and its `watch` list for the trace;
//! explicit options take precedence. Its `limit` bounds the scenario, not the machine.

use std::path::{Component, Path, PathBuf};

use super::record::Recording;
use crate::image::{Preset, Profile};
use crate::machine::{DatumValue, Machine, OpenOptions};
use crate::plc::{Programs, step7};
use crate::scenario::{Heading, Named, Operator, Scenario, Transcript, profile_named};
use crate::source::{Place, Problem, Table, unreadable};
use crate::trace::Watch;

/// The inputs of a live machine, as in the options of `opennck serve`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Opening<'a> {
    /// A directory, an archive file, or the name of a built-in machine; by default the machine of the scenario.
    pub machine: Option<&'a Path>,
    /// The scenario that runs on it.
    pub scenario: Option<&'a Path>,
    /// The text that selects a case of its matrix.
    pub case: Option<&'a str>,
    /// The name of its PLC program.
    pub plc: Option<&'a str>,
    /// The file of its PLC image.
    pub plc_image: Option<&'a Path>,
    /// The name of its profile.
    pub profile: Option<&'a str>,
}

/// A machine that is open and has not run yet.
#[derive(Debug)]
pub struct Opened {
    /// The machine, with its PLC program.
    pub machine: Machine,
    /// The scenario that runs on it.
    pub operator: Option<Operator>,
    /// The content of its trace.
    pub watch: Watch,
    /// The `watch` entries of the scenario, each with the step of a value.
    pub entries: Option<Vec<(String, Option<f64>)>>,
    /// The path from which it was read.
    pub path: PathBuf,
    /// The name of its PLC program, if the machine does not name it itself.
    pub plc: Option<String>,
    /// The folder of its STEP 7 program, if the machine does not name it itself.
    pub plc_folder: Option<PathBuf>,
    /// The command of its PLC program in another process.
    pub plc_process: Option<String>,
    /// The file of its PLC image.
    pub image: Option<PathBuf>,
    /// The changes merged into its plant.
    pub plant: Option<Table>,
    /// The machine data that were stored before power on.
    pub machine_data: Vec<(String, DatumValue)>,
}

impl Opening<'_> {
    /// Opens the machine; `warn` receives warnings.
    ///
    /// # Errors
    /// Neither a machine nor a scenario is given, or one of the files cannot be used; the error has its line.
    pub fn open(&self, programs: &Programs, warn: &mut dyn FnMut(&str)) -> Result<Opened, Problem> {
        let profile = self.profile.map(profile_named).transpose()?;
        let opened = match (self.scenario, self.machine) {
            (Some(file), _) => self.with_scenario(file, profile, programs, warn)?,
            (None, Some(path)) => self.alone(path, profile.unwrap_or_default(), programs)?,
            (None, None) => {
                return Err(Problem::new(
                    "expected a machine or a scenario, found neither",
                    "for example: opennck serve g1_example",
                ));
            }
        };
        for warning in opened.machine.warnings() {
            warn(warning);
        }
        Ok(opened)
    }

    fn alone(&self, path: &Path, profile: Profile, programs: &Programs) -> Result<Opened, Problem> {
        let preset = self.plc_image.map(Preset::read).transpose()?;
        let mut machine = Machine::open_with(path, OpenOptions { preset, profile, ..OpenOptions::default() })?;
        match self.plc {
            Some(name) => machine.load_named(name, &[Path::new(""), path], programs)?,
            None => machine.load_own_program(programs)?,
        }
        Ok(Opened {
            machine,
            operator: None,
            watch: Watch::default(),
            entries: None,
            path: path.to_owned(),
            plc_folder: self
                .plc
                .filter(|name| Programs::is_folder(name))
                .map(|name| step7::folder(name, &[Path::new(""), path])),
            plc: self.plc.map(str::to_owned),
            plc_process: None,
            image: self.plc_image.map(Path::to_owned),
            plant: None,
            machine_data: Vec::new(),
        })
    }

    fn with_scenario(
        &self,
        file: &Path,
        profile: Option<Profile>,
        programs: &Programs,
        warn: &mut dyn FnMut(&str),
    ) -> Result<Opened, Problem> {
        let mut scenario = Scenario::read_case(file, self.case)?;
        let mut path = scenario.directory().join(&scenario.machine.text);
        if let Some(machine) = self.machine {
            if !is_same(machine, &path) {
                let (named, served) = (&scenario.machine.text, machine.display());
                warn(&format!(
                    "{}: the scenario names the machine {named}; the given machine {served} is used",
                    file.display()
                ));
            }
            scenario.machine = override_named("MACHINE", &absolute(machine));
            path = machine.to_owned();
        }
        if let Some(plc) = self.plc {
            let folder = Programs::is_folder(plc).then(|| absolute(&step7::folder(plc, &[Path::new(""), &path])));
            scenario.plc = Some(override_named("--plc", folder.as_deref().unwrap_or(plc)));
            scenario.plc_process = None;
        }
        if let Some(image) = self.plc_image {
            scenario.plc_image = Some(override_named("--plc-image", &absolute(image)));
        }
        let image = scenario.image_file()?;
        let plc_folder = scenario.plc_folder();
        let prepared = scenario.prepare(profile.unwrap_or(scenario.profiles[0]), programs)?;
        let (mut machine, operator, watch) = prepared.into_operator();
        machine.begin_program()?;
        Ok(Opened {
            machine,
            operator: Some(operator),
            watch,
            entries: scenario.watch.map(|all| all.into_iter().map(|entry| (entry.name.text, entry.step)).collect()),
            path,
            plc: scenario.plc.map(|plc| plc.text),
            plc_folder,
            plc_process: scenario.plc_process.map(|(process, _)| process.command),
            image,
            plant: scenario.plant,
            machine_data: scenario.machine_data.into_iter().map(|datum| (datum.target, datum.value)).collect(),
        })
    }
}

impl Opened {
    /// Begins a recording.
    ///
    /// # Errors
    /// As for [`Recording::begin`], or the recording could not refer to the machine from its folder.
    pub fn record(&self, path: &Path) -> Result<Recording, Problem> {
        self.headed(path, |heading| Recording::begin(path, heading, &self.machine))?
    }

    /// Begins a transcript for a file in this folder, which need not be written.
    ///
    /// # Errors
    /// As for [`Opened::record`].
    pub fn transcript(&self, path: &Path) -> Result<Transcript, Problem> {
        self.headed(path, Transcript::begin)
    }

    /// Makes something with the heading of a scenario in this file.
    fn headed<T>(&self, path: &Path, make: impl FnOnce(&Heading<'_>) -> T) -> Result<T, Problem> {
        if let Some(command) = &self.plc_process {
            let what = format!("expected a PLC program that a recording can repeat, found the process `{command}`");
            return Err(
                Place::file(&path.display().to_string()).problem(what, "record without `plc`, or without --record")
            );
        }
        let machine = if self.path.exists() { from(path, &self.path)? } else { built_in(path, &self.path)? };
        let image = self.image.as_deref().map(|image| from(path, image)).transpose()?;
        let folder = self.plc_folder.as_deref().map(|folder| from(path, folder)).transpose()?;
        // A folder is told from a name by its `/`.
        let folder = folder.map(|folder| if folder.contains('/') { folder } else { format!("./{folder}") });
        let plc = folder.as_deref().or(self.plc.as_deref());
        let title = format!("A session with {}", machine.rsplit('/').next().unwrap_or_default());
        let heading = Heading {
            title: &title,
            machine: &machine,
            profile: self.machine.names().profile,
            plc,
            plc_image: image.as_deref(),
            watch: self.entries.as_deref(),
            plant: self.plant.as_ref(),
            machine_data: &self.machine_data,
        };
        Ok(make(&heading))
    }
}

/// A value that replaces one of the scenario.
fn override_named(place: &str, text: &str) -> Named {
    Named { text: text.to_owned(), place: Place::file(place) }
}

/// The absolute path of a file or folder; a built-in machine has only its name.
fn absolute(path: &Path) -> String {
    path.canonicalize().unwrap_or_else(|_| path.to_owned()).to_string_lossy().into_owned()
}

fn is_same(one: &Path, other: &Path) -> bool {
    match (one.canonicalize(), other.canonicalize()) {
        (Ok(one), Ok(other)) => one == other,
        (Err(_), Err(_)) => one.file_name() == other.file_name(),
        (Ok(_), Err(_)) | (Err(_), Ok(_)) => false,
    }
}

/// The name of a built-in machine. A folder of this name beside the file would be used instead.
fn built_in(path: &Path, machine: &Path) -> Result<String, Problem> {
    let name = machine.file_name().unwrap_or_default();
    if path.with_file_name(name).exists() {
        let what = format!("the folder {} beside the recording has the name of the built-in machine", name.display());
        return Err(Place::file(&path.display().to_string()).problem(what, "write the recording to another folder"));
    }
    Ok(name.to_string_lossy().into_owned())
}

/// The path of an existing file or folder, relative to the folder of a file.
fn from(file: &Path, to: &Path) -> Result<String, Problem> {
    let found = |path: &Path| path.canonicalize().map_err(|error| unreadable(path, &error));
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or_else(|| Path::new("."));
    let (folder, to) = (found(folder)?, found(to)?);
    let common = folder.components().zip(to.components()).take_while(|(one, other)| one == other).count();
    let up = folder.components().skip(common).map(|_| Component::ParentDir);
    // Paths on two disks have no common part.
    let relative: PathBuf = if common == 0 { to } else { up.chain(to.components().skip(common)).collect() };
    let text = relative.to_str().ok_or_else(|| {
        let what = format!("expected a path in UTF-8, found {}", relative.display());
        Problem::new(what, "rename it: a scenario is written in UTF-8")
    })?;
    Ok(if cfg!(windows) { text.replace('\\', "/") } else { text.to_owned() })
}
