//! THE AVAILABLE CONTROLS: the only module that names them, one row of `CONTROLS` for each. It reads the files of a machine and selects the
//! matching control. All other modules use [`Control`](crate::control::Control).

pub mod documented;

use std::fs;
use std::path::{Path, PathBuf};

use crate::control::{Configuration, Examined, Texts};
use crate::image::Profile;
use crate::isg::{self, ParameterLists};
use crate::sinumerik::machine_data::{files_of, is_archive};
use crate::sinumerik::{Commissioning, TEXTS, examine as examine_archive};
use crate::source::{Place, Problem, Table, did_you_mean, read_text, unreadable};

/// The configuration of a control, if its files are usable.
type Loaded = Result<Box<dyn Configuration>, Problem>;

/// A file in the program: its name and its contents.
type Contents<'a> = (&'a str, &'a [u8]);

/// A control that can be opened.
struct Entry {
    texts: &'static dyn Texts,
    /// Its files, for messages: `*.tea or one *.arc`.
    files: &'static str,
    /// Whether a file is one of its files, by the name.
    recognises: fn(&Path) -> bool,
    /// The configuration from a directory or a file. A directory may contain only a plant.
    read: fn(&Path) -> Loaded,
    /// The contents of a directory or a file, whether or not they define a usable machine.
    examine: fn(&Path) -> Result<Examined, Problem>,
    /// The configuration from names and contents of files.
    read_contents: fn(&[Contents<'_>]) -> Loaded,
    built_in: &'static [BuiltIn],
}

/// A built-in machine: file names and contents.
struct BuiltIn {
    name: &'static str,
    files: &'static [Contents<'static>],
    plant: (&'static str, &'static str),
}

/// All controls; the first is the default, for a directory with only a plant and for a file that no control recognises.
static CONTROLS: &[Entry] = &[
    Entry {
        texts: &TEXTS,
        files: "*.tea, *.ini, *.mpf or one *.arc",
        recognises: is_archive,
        read: |path| Ok(Box::new(Commissioning::load(&files_of(path)?)?)),
        examine: examine_archive,
        read_contents: |archives| Ok(Box::new(Commissioning::read(archives)?)),
        built_in: &[
            BuiltIn {
                name: "g1_example",
                files: &[("g1_example.tea", include_bytes!("../../machine_data/g1_example/g1_example.tea"))],
                plant: ("plant.toml", include_str!("../../machine_data/g1_example/plant.toml")),
            },
            BuiltIn {
                name: "portal",
                files: &[("portal.tea", include_bytes!("../../machine_data/portal/portal.tea"))],
                plant: ("plant.toml", include_str!("../../machine_data/portal/plant.toml")),
            },
            BuiltIn {
                name: "portal_two_channels",
                files: &[(
                    "portal_two_channels.tea",
                    include_bytes!("../../machine_data/portal_two_channels/portal_two_channels.tea"),
                )],
                plant: ("plant.toml", include_str!("../../machine_data/portal_two_channels/plant.toml")),
            },
        ],
    },
    Entry {
        texts: &isg::TEXTS,
        files: "*.lis",
        recognises: isg::is_list,
        read: |path| Ok(Box::new(ParameterLists::load(path)?)),
        examine: isg::examine,
        read_contents: |lists| Ok(Box::new(ParameterLists::read(lists)?)),
        built_in: &[
            BuiltIn {
                name: "isg_hard_gantry",
                files: &[
                    ("axis_1.lis", include_bytes!("../../machine_data/isg_hard_gantry/axis_1.lis")),
                    ("axis_2.lis", include_bytes!("../../machine_data/isg_hard_gantry/axis_2.lis")),
                    ("axis_5.lis", include_bytes!("../../machine_data/isg_hard_gantry/axis_5.lis")),
                    ("axis_6.lis", include_bytes!("../../machine_data/isg_hard_gantry/axis_6.lis")),
                    ("channel_1.lis", include_bytes!("../../machine_data/isg_hard_gantry/channel_1.lis")),
                ],
                plant: ("plant.toml", include_str!("../../machine_data/isg_hard_gantry/plant.toml")),
            },
            BuiltIn {
                name: "isg_soft_gantry",
                files: &[
                    ("axis_1.lis", include_bytes!("../../machine_data/isg_soft_gantry/axis_1.lis")),
                    ("axis_2.lis", include_bytes!("../../machine_data/isg_soft_gantry/axis_2.lis")),
                    ("axis_3.lis", include_bytes!("../../machine_data/isg_soft_gantry/axis_3.lis")),
                    ("axis_8.lis", include_bytes!("../../machine_data/isg_soft_gantry/axis_8.lis")),
                    ("axis_9.lis", include_bytes!("../../machine_data/isg_soft_gantry/axis_9.lis")),
                    ("channel_1.lis", include_bytes!("../../machine_data/isg_soft_gantry/channel_1.lis")),
                ],
                plant: ("plant.toml", include_str!("../../machine_data/isg_soft_gantry/plant.toml")),
            },
            BuiltIn {
                name: "twincat_gantry",
                files: &[
                    ("axis_1.lis", include_bytes!("../../machine_data/twincat_gantry/axis_1.lis")),
                    ("axis_2.lis", include_bytes!("../../machine_data/twincat_gantry/axis_2.lis")),
                    ("axis_3.lis", include_bytes!("../../machine_data/twincat_gantry/axis_3.lis")),
                    ("axis_4.lis", include_bytes!("../../machine_data/twincat_gantry/axis_4.lis")),
                    ("axis_5.lis", include_bytes!("../../machine_data/twincat_gantry/axis_5.lis")),
                    ("axis_6.lis", include_bytes!("../../machine_data/twincat_gantry/axis_6.lis")),
                    ("axis_7.lis", include_bytes!("../../machine_data/twincat_gantry/axis_7.lis")),
                    ("channel_1.lis", include_bytes!("../../machine_data/twincat_gantry/channel_1.lis")),
                ],
                plant: ("plant.toml", include_str!("../../machine_data/twincat_gantry/plant.toml")),
            },
        ],
    },
];

/// The texts of all controls; the first is the default.
pub fn texts() -> impl Iterator<Item = &'static dyn Texts> {
    CONTROLS.iter().map(|control| control.texts)
}

/// The profile of this name, of any control.
#[must_use]
pub fn profile(name: &str) -> Option<Profile> {
    texts().find_map(|texts| Profile::named(texts.interface(), name))
}

/// The name of the default profile.
#[must_use]
pub fn default_profile() -> &'static str {
    CONTROLS[0].texts.interface().tables().numberings[0].name
}

/// The names of all profiles, the default first.
pub fn profiles() -> impl Iterator<Item = &'static str> {
    texts().flat_map(|texts| texts.interface().tables().numberings).map(|numbering| numbering.name)
}

/// The configuration of a control and the contents of `plant.toml`, from the files of a machine: a directory, a single archive file, or a
/// built-in machine.
///
/// # Errors
/// A file contains something unusable; the error gives file and line. A directory contains no files of a machine, or those of two controls.
pub fn read(path: &Path) -> Result<(Box<dyn Configuration>, Table), Problem> {
    if !path.exists() {
        return read_built_in(path);
    }
    let control = recognised(path, &files_at(path)?, CONTROLS)?;
    let place = Place::file(&path.display().to_string());
    let plant = Some(path.join("plant.toml")).filter(|plant| path.is_dir() && plant.exists());
    if control.is_none() && path.is_dir() && plant.is_none() {
        let files: Vec<&str> = CONTROLS.iter().map(|control| control.files).collect();
        return Err(place.problem(
            format!("expected machine data ({}) or plant.toml, found neither", files.join("; ")),
            "export the machine data of your control into this directory",
        ));
    }
    let configuration = (control.unwrap_or(&CONTROLS[0]).read)(path)?;
    let plant = match plant {
        Some(plant) => Table::parse(&read_text(&plant)?, &plant.display().to_string())?,
        None => Table::empty(place),
    };
    Ok((configuration, plant))
}

/// The contents of the files of a machine, whether or not it can be opened.
///
/// # Errors
/// A file cannot be read, or is not a machine data file.
pub fn examine(path: &Path) -> Result<Examined, Problem> {
    (recognised(path, &files_at(path)?, CONTROLS)?.unwrap_or(&CONTROLS[0]).examine)(path)
}

/// The file itself, or the files of a directory.
fn files_at(path: &Path) -> Result<Vec<PathBuf>, Problem> {
    if path.exists() && !path.is_dir() && !path.is_file() {
        return Err(Place::file(&path.display().to_string()).problem(
            "expected a directory or an archive file, found a device, a pipe or a socket",
            "name a directory with machine data, an archive file, or a built-in machine",
        ));
    }
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let entries = fs::read_dir(path).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let entries = entries.map_err(|error| unreadable(path, &error))?;
    Ok(entries.iter().map(fs::DirEntry::path).filter(|path| path.is_file()).collect())
}

/// The control that recognises some of the files at a path, if any does.
fn recognised<'a>(path: &Path, files: &[PathBuf], controls: &'a [Entry]) -> Result<Option<&'a Entry>, Problem> {
    let mut found: Vec<&Entry> =
        controls.iter().filter(|control| files.iter().any(|file| (control.recognises)(file))).collect();
    if found.len() > 1 {
        let files: Vec<&str> = found.iter().map(|control| control.files).collect();
        return Err(Place::file(&path.display().to_string()).problem(
            format!("expected the files of one control, found those of {}: {}", found.len(), files.join("; ")),
            "keep the files of one control in this directory",
        ));
    }
    Ok(found.pop())
}

fn read_built_in(path: &Path) -> Result<(Box<dyn Configuration>, Table), Problem> {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let machines =
        || CONTROLS.iter().flat_map(|control| control.built_in.iter().map(move |machine| (control, machine)));
    let Some((control, machine)) = machines().find(|(_, machine)| machine.name == name) else {
        let names: Vec<&str> = machines().map(|(_, machine)| machine.name).collect();
        let built_in = format!("name a directory, an archive file, or a built-in machine: {}", names.join(", "));
        return Err(Problem::new(
            format!("expected a machine, found nothing at {}", path.display()),
            did_you_mean(name, names.iter().copied(), &built_in),
        ));
    };
    let configuration = (control.read_contents)(machine.files)?;
    let (file, text) = machine.plant;
    Ok((configuration, Table::parse(text, file)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row of a second control with files `*.lis`, otherwise as the first.
    fn with_a_second() -> [Entry; 2] {
        let row = |files, recognises| {
            let &Entry { texts, read, examine, read_contents, built_in, .. } = &CONTROLS[0];
            Entry { texts, files, recognises, read, examine, read_contents, built_in }
        };
        [row(CONTROLS[0].files, is_archive), row("*.lis", |path| path.extension().is_some_and(|end| end == "lis"))]
    }

    #[test]
    fn a_second_control_is_one_row_and_its_files_select_it() {
        let controls = with_a_second();
        let files = |files: &[&str]| {
            let files: Vec<_> = files.iter().map(PathBuf::from).collect();
            let control = recognised(Path::new("machine"), &files, &controls);
            control.map(|control| control.map(|control| control.files)).map_err(|problem| problem.to_string())
        };
        assert_eq!(files(&["plant.toml", "axes.lis"]), Ok(Some("*.lis")));
        assert_eq!(files(&["G1.TEA"]), Ok(Some("*.tea, *.ini, *.mpf or one *.arc")));
        assert_eq!(files(&["plant.toml"]), Ok(None));
        let both = files(&["axes.lis", "g1.tea"]).unwrap_err();
        assert!(both.contains("expected the files of one control, found those of 2"), "{both}");
    }
}
