//! What `opennck serve` opens: a machine with its PLC program and image, and with `--scenario` the operator who acts on it.
//!
//! A scenario brings its own machine, program and image, with its profile (the first one), its `[plant]`, and its `watch` for the
//! trace; what the command line names counts instead. Its `limit` bounds the scenario, not the machine.

use std::path::{Component, Path, PathBuf};

use super::Arguments;
use crate::cli::output::Output;
use crate::image::{Preset, Profile};
use crate::live::Recording;
use crate::machine::{Machine, OpenOptions};
use crate::plc::Programs;
use crate::scenario::{Heading, Named, Operator, Scenario, profile_named};
use crate::source::{Place, Problem, Table, unreadable};
use crate::trace::Watch;

/// A machine that is open.
pub(super) struct Opened {
    pub(super) machine: Machine,
    pub(super) operator: Option<Operator>,
    /// What its trace shows, and the entries that say so.
    pub(super) watch: Watch,
    pub(super) entries: Option<Vec<String>>,
    /// Where it is from.
    pub(super) path: PathBuf,
    /// The name of its PLC program.
    pub(super) plc: Option<String>,
    /// The file of its PLC image.
    pub(super) image: Option<PathBuf>,
    /// What was merged into its plant.
    pub(super) plant: Option<Table>,
}

impl Opened {
    pub(super) fn open(arguments: &Arguments, programs: &Programs, output: &mut Output) -> Result<Self, Problem> {
        let image = arguments.plc_image.as_deref().map(image).transpose()?;
        let profile = arguments.profile.as_deref().map(profile_named).transpose()?;
        let opened = match (&arguments.scenario, &arguments.machine) {
            (Some(file), _) => Self::with_scenario(file, profile, image.as_deref(), arguments, programs, output)?,
            (None, Some(path)) => {
                Self::alone(path, profile.unwrap_or_default(), image, arguments.plc.as_deref(), programs)?
            }
            (None, None) => {
                return Err(Problem::new(
                    "expected a machine or a scenario, found neither",
                    "opennck serve g1_example",
                ));
            }
        };
        for warning in opened.machine.warnings() {
            output.warning(warning);
        }
        Ok(opened)
    }

    fn alone(
        path: &Path,
        profile: Profile,
        image: Option<PathBuf>,
        plc: Option<&str>,
        programs: &Programs,
    ) -> Result<Self, Problem> {
        let preset = image.as_deref().map(Preset::read).transpose()?;
        let mut machine = Machine::open_with(path, OpenOptions { preset, profile, ..OpenOptions::default() })?;
        if let Some(name) = plc {
            machine.load_program(programs.program(name, machine.names())?);
        }
        Ok(Self {
            machine,
            operator: None,
            watch: Watch::default(),
            entries: None,
            path: path.to_owned(),
            plc: plc.map(str::to_owned),
            image,
            plant: None,
        })
    }

    fn with_scenario(
        file: &Path,
        profile: Option<Profile>,
        image: Option<&Path>,
        arguments: &Arguments,
        programs: &Programs,
        output: &mut Output,
    ) -> Result<Self, Problem> {
        let mut scenario = Scenario::read(file)?;
        let mut path = scenario.directory().join(&scenario.machine.text);
        if let Some(machine) = &arguments.machine {
            if !is_same(machine, &path) {
                let (named, served) = (&scenario.machine.text, machine.display());
                output.warning(format!("{}: it names the machine {named}; {served} is served", file.display()));
            }
            scenario.machine = said("MACHINE", &absolute(machine));
            path.clone_from(machine);
        }
        if let Some(plc) = &arguments.plc {
            scenario.plc = Some(said("--plc", plc));
        }
        if let Some(image) = image {
            scenario.plc_image = Some(said("--plc-image", &absolute(image)));
        }
        let image = scenario.image_file()?;
        let prepared = scenario.prepare(profile.unwrap_or(scenario.profiles[0]), programs)?;
        let (machine, operator, watch) = prepared.into_operator();
        Ok(Self {
            machine,
            operator: Some(operator),
            watch,
            entries: scenario.watch.map(|entries| entries.into_iter().map(|entry| entry.text).collect()),
            path,
            plc: scenario.plc.map(|plc| plc.text),
            image,
            plant: scenario.plant,
        })
    }
}

/// What the command line says in place of a scenario.
fn said(place: &str, text: &str) -> Named {
    Named { text: text.to_owned(), place: Place::file(place) }
}

/// The path of something from wherever it is looked for; a machine that is built in has only its name.
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

/// A PLC image: a file, or a name that is looked for in `plc_images` here or above.
fn image(name: &str) -> Result<PathBuf, Problem> {
    if name.ends_with(".toml") {
        return Ok(PathBuf::from(name));
    }
    let file = Path::new("plc_images").join(format!("{name}.toml"));
    let here = std::env::current_dir().unwrap_or_default();
    let found = here.ancestors().map(|directory| directory.join(&file)).find(|file| file.is_file());
    found.ok_or_else(|| {
        Problem::new(
            format!("expected a PLC image, found no plc_images/{name}.toml here or above"),
            "name a file that ends in .toml, or start where plc_images is",
        )
    })
}

/// The recording of a machine that `serve` has opened.
pub(super) fn recording(path: &Path, opened: &Opened) -> Result<Recording, Problem> {
    let machine = &opened.path;
    let machine = if machine.exists() { from(path, machine)? } else { built_in(path, machine)? };
    let image = opened.image.as_deref().map(|image| from(path, image)).transpose()?;
    let title = format!("A session with {}", machine.rsplit('/').next().unwrap_or_default());
    let heading = Heading {
        title: &title,
        machine: &machine,
        profile: opened.machine.names().profile,
        plc: opened.plc.as_deref(),
        plc_image: image.as_deref(),
        watch: opened.entries.as_deref(),
        plant: opened.plant.as_ref(),
    };
    Recording::begin(path, &heading, &opened.machine)
}

/// A machine that is built in has no path, but a folder of its name beside the file would be taken for it.
fn built_in(path: &Path, machine: &Path) -> Result<String, Problem> {
    let name = machine.file_name().unwrap_or_default();
    if path.with_file_name(name).exists() {
        let what = format!("expected no machine {} beside the recording, found one", name.display());
        return Err(Place::file(&path.display().to_string()).problem(what, "write the recording elsewhere"));
    }
    Ok(name.to_string_lossy().into_owned())
}

/// The path of something that exists, from the folder of a file on.
fn from(file: &Path, to: &Path) -> Result<String, Problem> {
    let found = |path: &Path| path.canonicalize().map_err(|error| unreadable(path, &error));
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or_else(|| Path::new("."));
    let (folder, to) = (found(folder)?, found(to)?);
    let common = folder.components().zip(to.components()).take_while(|(one, other)| one == other).count();
    let up = folder.components().skip(common).map(|_| Component::ParentDir);
    // Two disks have nothing in common.
    let relative: PathBuf = if common == 0 { to } else { up.chain(to.components().skip(common)).collect() };
    let text = relative.to_str().ok_or_else(|| {
        let what = format!("expected a path in UTF-8, found {}", relative.display());
        Problem::new(what, "rename it: a scenario is written in UTF-8")
    })?;
    Ok(if cfg!(windows) { text.replace('\\', "/") } else { text.to_owned() })
}
