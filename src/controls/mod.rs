//! THE AVAILABLE CONTROLS: the only module that names them. It reads the files of a machine and selects the matching control. All other
//! modules use [`Control`](crate::control::Control).

use std::path::Path;

use crate::control::{Configuration, Examined, Texts};
use crate::image::Profile;
use crate::sinumerik::machine_data::files_of;
use crate::sinumerik::{Commissioning, TEXTS, examine as examine_archive};
use crate::source::{Place, Problem, Table, did_you_mean, read_text};

/// A built-in machine: file names and contents.
struct BuiltIn {
    name: &'static str,
    archives: &'static [(&'static str, &'static [u8])],
    plant: (&'static str, &'static str),
}

static BUILT_IN: &[BuiltIn] = &[BuiltIn {
    name: "g1_example",
    archives: &[("g1_example.tea", include_bytes!("../../machine_data/g1_example/g1_example.tea"))],
    plant: ("plant.toml", include_str!("../../machine_data/g1_example/plant.toml")),
}];

/// The texts of all controls; the first is the default.
static ALL: &[&dyn Texts] = &[&TEXTS];

/// The texts of all controls.
pub fn texts() -> impl Iterator<Item = &'static dyn Texts> {
    ALL.iter().copied()
}

/// The profile of this name, of any control.
#[must_use]
pub fn profile(name: &str) -> Option<Profile> {
    texts().find_map(|texts| Profile::named(texts.interface(), name))
}

/// The names of all profiles, the default first.
pub fn profiles() -> impl Iterator<Item = &'static str> {
    texts().flat_map(|texts| texts.interface().tables().numberings).map(|numbering| numbering.name)
}

/// The configuration of a control and the contents of `plant.toml`, from the files of a machine: a directory, a single archive file, or a
/// built-in machine.
///
/// # Errors
/// A file contains something unusable; the error gives file and line.
pub fn read(path: &Path) -> Result<(Box<dyn Configuration>, Table), Problem> {
    if !path.exists() {
        return read_built_in(path);
    }
    let files = files_of(path)?;
    let plant = if path.is_dir() { path.join("plant.toml") } else { path.with_file_name("plant.toml") };
    let plant = Some(plant).filter(|plant| path.is_dir() && plant.exists());
    if files.is_empty() && plant.is_none() {
        return Err(Place::file(&path.display().to_string()).problem(
            "expected machine data (*.tea, *.ini, *.mpf or one *.arc) or plant.toml, found neither",
            "export the machine data of your control into this directory",
        ));
    }
    let configuration = Commissioning::load(&files)?;
    let plant = match plant {
        Some(plant) => Table::parse(&read_text(&plant)?, &plant.display().to_string())?,
        None => Table::empty(Place::file(&path.display().to_string())),
    };
    Ok((Box::new(configuration), plant))
}

/// The contents of the files of a machine, whether or not it can be opened.
///
/// # Errors
/// A file cannot be read, or is not a machine data file.
pub fn examine(path: &Path) -> Result<Examined, Problem> {
    examine_archive(path)
}

fn read_built_in(path: &Path) -> Result<(Box<dyn Configuration>, Table), Problem> {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let names: Vec<&str> = BUILT_IN.iter().map(|machine| machine.name).collect();
    let Some(machine) = BUILT_IN.iter().find(|machine| machine.name == name) else {
        let built_in = format!("name a directory, an archive file, or a built-in machine: {}", names.join(", "));
        return Err(Problem::new(
            format!("expected a machine, found nothing at {}", path.display()),
            did_you_mean(name, names.iter().copied(), &built_in),
        ));
    };
    let configuration = Commissioning::read(machine.archives)?;
    let (file, text) = machine.plant;
    Ok((Box::new(configuration), Table::parse(text, file)?))
}
