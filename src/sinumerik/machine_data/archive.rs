//! An archive of machine data as read: values, explicitly given data, unknown data, and findings.
//!
//! If one line cannot be read, nothing is loaded.

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

use crate::control::{Finding, Owner};
use crate::source::{INPUT_MIB, Place, Problem, Wide, read_bytes, unreadable};
use crate::units::AxisNumber;

use super::reading::{Assignment, Member, Reading};
use super::{MachineData, Target, ascii, binary};

/// Summary of reading the files.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// The files and members in their order.
    pub members: Vec<Member>,
    /// Number of known values read.
    pub taken: usize,
    /// Number of unknown values kept.
    pub unknown: usize,
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let read = |member: &&Member| member.assignments.is_some();
        let left = self.ignored().count();
        let members = if left == 1 { "member" } else { "members" };
        write!(f, "{} machine data taken, {} unknown kept", self.taken, self.unknown)?;
        if self.unknown > 0 {
            write!(f, " (not in the catalogue: written back, no effect)")?;
        }
        if left > 0 {
            write!(f, ", {left} {members} without machine data ignored")?;
        }
        writeln!(f)?;
        for member in self.members.iter().filter(read) {
            let count = member.assignments.unwrap_or_default();
            writeln!(f, "  {}: {count} {}", member.name, if count == 1 { "assignment" } else { "assignments" })?;
        }
        Ok(())
    }
}

impl Summary {
    /// The names of the members that contain no machine data.
    pub fn ignored(&self) -> impl Iterator<Item = &str> {
        self.members.iter().filter(|member| member.assignments.is_none()).map(|member| member.name.as_str())
    }
}

/// An archive that was read as a whole.
#[derive(Clone, PartialEq)]
pub struct Archive {
    /// The values, with defaults for data that were not given.
    pub data: MachineData,
    /// The data that were given explicitly, and their places.
    pub given: BTreeMap<Target, Place>,
    /// Assignments that are kept but not modelled, in the order of the files.
    pub unknown: Vec<Assignment>,
    /// Values outside of the ranges of their data; a control accepted them (O-30).
    pub out_of_range: Vec<Target>,
    /// Findings, the heaviest first.
    pub findings: Vec<Finding>,
    /// Summary of reading.
    pub summary: Summary,
}

/// Prints only the summary, because the values of 31 axes fill several screens.
impl fmt::Debug for Archive {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Archive({})", self.summary)
    }
}

impl Archive {
    /// Reads files, in this order, as one import: ASCII archives, or a binary one.
    ///
    /// # Errors
    /// Every finding, if one of them is an error; nothing is loaded then.
    pub fn load(files: &[PathBuf]) -> Result<Self, Vec<Finding>> {
        let mut sources = Vec::new();
        for path in files {
            let bytes = read_bytes(path, INPUT_MIB).map_err(|problem| vec![Finding::from(problem)])?;
            sources.push((path.display().to_string(), bytes));
        }
        Self::read(sources.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice())))
    }

    /// Reads the contents of files, each with the name that messages shall use.
    ///
    /// ```
    /// use opennck::sinumerik::machine_data::Archive;
    ///
    /// let file = ("machine.tea", b"N37100 $MA_GANTRY_AXIS_TYPE[AX3]=11\n".as_slice());
    /// let archive = Archive::read([file]).unwrap();
    /// let target = archive.data.parse_target("37100[AX3]").unwrap();
    /// assert!(archive.is_given(&target));
    /// ```
    ///
    /// # Errors
    /// Every finding, if one of them is an error; nothing is loaded then.
    pub fn read<'a>(files: impl IntoIterator<Item = (&'a str, &'a [u8])>) -> Result<Self, Vec<Finding>> {
        let mut reading = Reading::default();
        for (number, (name, bytes)) in files.into_iter().enumerate() {
            reading.file = number;
            if let Some(wide) = Wide::of(bytes) {
                let expected = "a text in UTF-8 or Latin-1, or a binary archive";
                let [what, cure] = wide.problem(name, expected);
                reading.findings.push(Place::file(name).problem(what, cure).into());
            } else if binary::is_binary(name, bytes) {
                if let Err(problem) = binary::read(name, bytes, &mut reading) {
                    reading.findings.push(problem.into());
                }
            } else {
                ascii::read(name, bytes, &mut reading);
            }
        }
        Self::from_reading(reading)
    }

    /// Whether this value was given explicitly.
    #[must_use]
    pub fn is_given(&self, target: &Target) -> bool {
        self.given.contains_key(target)
    }

    /// Whether any value of this datum was given explicitly for this owner.
    #[must_use]
    pub fn is_given_for(&self, number: u32, owner: Owner) -> bool {
        self.given.keys().any(|target| target.datum().number == number && target.owner() == owner)
    }

    /// Whether any axis-specific datum was given for this machine axis, which means that the machine has it.
    #[must_use]
    pub fn given_axis(&self, axis: AxisNumber) -> bool {
        self.given.keys().any(|target| target.owner() == Owner::Axis(axis))
    }
}

/// The archive files of a machine: the file itself, or, in a directory, one `*.arc`, and then all `*.tea`, `*.ini` and `*.mpf` by name,
/// which are laid over it.
///
/// # Errors
/// The path cannot be read, or a directory contains several `*.arc`. A directory without any archive gives an empty list.
pub fn files_of(machine: &Path) -> Result<Vec<PathBuf>, Problem> {
    if machine.is_file() {
        return Ok(vec![machine.to_owned()]);
    }
    let mut files = Vec::new();
    for entry in std::fs::read_dir(machine).map_err(|error| unreadable(machine, &error))? {
        files.push(entry.map_err(|error| unreadable(machine, &error))?.path());
    }
    files.retain(|path| path.is_file() && is_archive(path));
    files.sort();
    let (mut archives, texts): (Vec<PathBuf>, Vec<PathBuf>) =
        files.into_iter().partition(|path| ends_with(path, &["arc"]));
    if archives.len() > 1 {
        let names: Vec<_> = archives.iter().filter_map(|path| path.file_name()?.to_str()).collect();
        return Err(Place::file(&machine.display().to_string()).problem(
            format!("expected one archive (*.arc), found {}: {}", archives.len(), names.join(", ")),
            "keep one `.arc`; `.tea`, `.ini` and `.mpf` beside it are laid over it",
        ));
    }
    archives.extend(texts);
    Ok(archives)
}

/// Whether the name of a file is that of an archive: `*.tea`, `*.ini`, `*.mpf` or `*.arc`, in upper or lower case.
#[must_use]
pub fn is_archive(file: &Path) -> bool {
    ends_with(file, &["tea", "ini", "mpf", "arc"])
}

fn ends_with(file: &Path, extensions: &[&str]) -> bool {
    let extension = file.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    extensions.iter().any(|known| extension.eq_ignore_ascii_case(known))
}
