//! The NC programs of a scenario: files and texts that its head and its steps select, and the subprograms beside them.
//!
//! A file is read with all programs beside it (`*.mpf`, `*.spf`) and those of `program_path`, in the order of their names. Folders have their names
//! as the scenario writes them, so that nothing depends on where it lies.

use std::fs;
use std::path::{Path, PathBuf};

use crate::machine::Machine;
use crate::nc_program::{Program, ProgramKind};
use crate::source::{Place, Problem};

/// The largest file of a program.
const LARGEST: u64 = 256 << 20;

/// The folder of programs whose text is in the scenario.
const IN_PLACE: &str = "_N_SCENARIO_DIR";

/// The text of a program, and its path.
pub(super) type Text = (Box<str>, String);

/// Programs that are read, to be loaded before the first step.
#[derive(Debug, Default)]
pub(super) struct NcPrograms {
    loaded: Vec<Program>,
    folders: Vec<PathBuf>,
    /// Files that are read already.
    files: Vec<PathBuf>,
    search_path: Vec<String>,
    /// Programs with their text in the scenario, and their paths.
    texts: Vec<Text>,
    /// The ending in the names of programs on this control.
    ending: &'static str,
}

impl NcPrograms {
    /// No programs yet, for this machine.
    pub(super) fn of(machine: &Machine) -> Self {
        Self { ending: machine.program_ending(), ..Self::default() }
    }

    /// Programs of a session that has selected these texts before: another text gets another name.
    pub(super) fn after(texts: Vec<Text>, machine: &Machine) -> Self {
        Self { texts, ..Self::of(machine) }
    }

    /// The texts so far.
    pub(super) fn texts(&self) -> &[Text] {
        &self.texts
    }

    /// The folders of `program_path`, relative to the folder of the scenario.
    pub(super) fn search(&mut self, folder: &str, directory: &Path, place: &Place) -> Result<(), Problem> {
        self.read_folder(&directory.join(folder), folder).map_err(|problem| problem.at(place))?;
        self.search_path.push(folder.to_owned());
        Ok(())
    }

    /// The program in a file, relative to the folder of the scenario: its path among the loaded programs.
    pub(super) fn file(&mut self, name: &str, directory: &Path, place: &Place) -> Result<String, Problem> {
        let file = directory.join(name);
        let folder = Path::new(name).parent().map(|folder| folder.display().to_string()).unwrap_or_default();
        let own = read(&file, &folder).map_err(|problem| problem.at(place))?;
        let Some(first) = own.first().map(Program::path) else {
            return Err(place.problem(format!("expected an NC program in {name}, found nothing"), "write its blocks"));
        };
        self.loaded.extend(own);
        self.files.push(file.clone());
        let parent = file.parent().unwrap_or_else(|| Path::new(""));
        self.read_folder(parent, &folder).map_err(|problem| problem.at(place))?;
        Ok(first)
    }

    /// A program whose text is in the scenario: its path. The same text is the same program. An archive (`%_N_PART_MPF`) has several programs
    /// with their names; the first one is meant.
    pub(super) fn text(&mut self, text: &str) -> String {
        if text.trim_start().starts_with("%_N_") {
            let programs = Program::read("NC", IN_PLACE, text.as_bytes());
            if let Some(path) = programs.first().map(Program::path) {
                self.loaded.extend(programs);
                return path;
            }
        }
        if let Some((_, path)) = self.texts.iter().find(|(known, _)| **known == *text) {
            return path.clone();
        }
        let number = self.texts.len() + 1;
        let program = Program::new(&format!("NC{number}{}", self.ending), ProgramKind::Main, IN_PLACE, text.as_bytes());
        let path = program.path();
        self.texts.push((text.into(), path.clone()));
        self.loaded.push(program);
        path
    }

    /// Loads them into a machine.
    pub(super) fn load(self, machine: &mut Machine) {
        if !self.loaded.is_empty() {
            machine.load_programs(self.loaded, self.search_path);
        }
    }

    fn read_folder(&mut self, folder: &Path, name: &str) -> Result<(), Problem> {
        if self.folders.iter().any(|known| known == folder) {
            return Ok(());
        }
        self.folders.push(folder.to_owned());
        let shown = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let cure = "write a folder with NC programs, relative to the scenario";
        let problem = |error: std::io::Error| {
            Problem::new(format!("expected a folder with NC programs, found {}: {error}", shown.display()), cure)
        };
        let mut files: Vec<PathBuf> = Vec::new();
        for entry in fs::read_dir(shown).map_err(problem)? {
            let path = entry.map_err(problem)?.path();
            let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
            if ending.is_some_and(|ending| ending == "spf" || ending == "mpf" || ending == "nc") && path.is_file() {
                files.push(path);
            }
        }
        files.sort();
        for file in files {
            if self.files.contains(&file) {
                continue;
            }
            self.loaded.extend(read(&file, name)?);
        }
        Ok(())
    }
}

/// The programs of a file.
fn read(file: &Path, folder: &str) -> Result<Vec<Program>, Problem> {
    let cure = "write the path of an NC program, `part.mpf` (of a machine of the ISG kernel `part.nc`), relative to the scenario";
    let problem = |error: &dyn std::fmt::Display| {
        Problem::new(format!("expected an NC program, found {}: {error}", file.display()), cure)
    };
    let data = fs::metadata(file).map_err(|error| problem(&error))?;
    if !data.is_file() || data.len() > LARGEST {
        return Err(problem(&format_args!("no file of at most {} MB", LARGEST >> 20)));
    }
    let bytes = fs::read(file).map_err(|error| problem(&error))?;
    let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    Ok(Program::read(&name, folder, bytes))
}
