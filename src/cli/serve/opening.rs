//! What `opennck serve` opens: a machine with its PLC program and image, and with `--scenario` the operator who acts on it.
//!
//! A scenario brings its own machine, program and image, with its profile (the first one), its `[plant]`, and its `watch` for the
//! trace; what the command line names counts instead. Its `limit` bounds the scenario, not the machine.

use std::path::{Path, PathBuf};

use super::Arguments;
use crate::cli::output::Output;
use crate::image::{Preset, Profile};
use crate::machine::{Machine, OpenOptions};
use crate::plc::Programs;
use crate::scenario::{Named, Operator, Scenario, profile_named};
use crate::source::{Place, Problem, Table};
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
