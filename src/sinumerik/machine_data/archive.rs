//! An archive of machine data as read: values, explicitly given data, unknown data, and findings.
//!
//! Reading takes two passes, because a file may use the name of an axis before MD10000 defines it. The first pass collects all assignments.
//! The second pass sets names of axes and channels and the types of axes (MD30300), then everything else in the order of the files; a later
//! assignment replaces an earlier one. If there is one error, nothing is loaded.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::{Path, PathBuf};

use crate::control::{Owner, Value};
use crate::source::{Place, Problem, unreadable};
use crate::units::AxisNumber;

use super::catalogue::{by_identifier, by_number, nearest_identifier};
use super::finding::{Assignment, Finding, Line, Member, Reading, Severity};
use super::named::{resolve, split_indices};
use super::table::Datum;
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
        let left = self.members.iter().filter(|member| !read(member)).count();
        write!(f, "{} machine data taken, {} unknown kept", self.taken, self.unknown)?;
        if left > 0 {
            write!(f, ", {left} members without machine data ignored")?;
        }
        writeln!(f)?;
        for member in self.members.iter().filter(read) {
            writeln!(f, "  {}: {} assignments", member.name, member.assignments.unwrap_or_default())?;
        }
        for member in self.members.iter().filter(|member| !read(member)) {
            writeln!(f, "  ignored: {}", member.name)?;
        }
        Ok(())
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
    /// Warnings.
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
            let bytes = std::fs::read(path).map_err(|error| vec![Finding::from(unreadable(path, &error))])?;
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
        for (name, bytes) in files {
            if binary::is_binary(name, bytes) {
                if let Err(problem) = binary::read(name, bytes, &mut reading) {
                    reading.findings.push(problem.into());
                }
            } else {
                ascii::read(name, bytes, &mut reading);
            }
        }
        Self::from_reading(reading)
    }

    fn from_reading(reading: Reading) -> Result<Self, Vec<Finding>> {
        let Reading { lines, mut findings, members } = reading;
        let mut data = MachineData::default();
        let mut known = Vec::new();
        let mut unknown = BTreeMap::new();
        for (order, line) in lines.into_iter().enumerate() {
            match known_datum(&line) {
                Ok(Some(datum)) => known.push((datum, line)),
                Ok(None) => {
                    // Only channel data depend on the section in which they are.
                    let per_channel = line.name.starts_with("$MC") || line.name.starts_with("$SC");
                    let key = (per_channel.then_some(line.channel), line.name.to_ascii_uppercase());
                    unknown.insert(key, (order, line));
                }
                Err(finding) => findings.push(finding),
            }
        }
        // Names first, then the types of axes, which determine the defaults, then the rest.
        known.sort_by_key(|(datum, _)| match datum.number {
            10000 | 20000 => 0,
            30300 => 1,
            _ => 2,
        });
        let mut given = BTreeMap::new();
        let mut named = false;
        for (datum, line) in known {
            if !named && !matches!(datum.number, 10000 | 20000) {
                named = true;
                keep_default_names_apart(&mut data, &given);
            }
            let target = match take(datum, &line, &mut data) {
                Ok(target) => target,
                Err(problem) => {
                    findings.push(Finding {
                        severity: Severity::Error,
                        place: Some(line.place),
                        number: Some(datum.number),
                        identifier: datum.full_identifier(),
                        what: problem.what,
                        cure: problem.cure,
                    });
                    continue;
                }
            };
            given.insert(target, line.place);
        }
        if !named {
            keep_default_names_apart(&mut data, &given);
        }
        let mut unknown: Vec<_> = unknown.into_values().collect();
        unknown.sort_by_key(|(order, _)| *order);
        let unknown: Vec<_> = unknown.into_iter().map(|(_, line)| line.into()).collect();
        findings.extend(unknown_findings(&unknown));
        if findings.iter().any(|finding| finding.severity == Severity::Error) {
            findings.sort_by(|a, b| b.severity.cmp(&a.severity).then_with(|| a.place.cmp(&b.place)));
            return Err(findings);
        }
        let summary = Summary { members, taken: given.len(), unknown: unknown.len() };
        Ok(Self { data, given, unknown, findings, summary })
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

/// Below this number `N…` is only a block number; there are no machine data with smaller numbers.
const FIRST_DATUM: u32 = 9_000;

/// The datum of a line; `None` if it is not in the catalogue.
fn known_datum(line: &Line) -> Result<Option<&'static Datum>, Finding> {
    let identifier = line.name.split('[').next().unwrap_or_default().trim();
    let number = line.number.filter(|number| *number >= FIRST_DATUM);
    let error = |what: String, cure: String| Finding {
        severity: Severity::Error,
        place: Some(line.place.clone()),
        number,
        identifier: identifier.to_owned(),
        what,
        cure,
    };
    // A name without a prefix is a user variable, not a machine datum.
    let by_name = identifier.starts_with('$').then(|| by_identifier(identifier)).flatten();
    match (by_name, number.and_then(by_number)) {
        (Some(datum), _) if number.is_none_or(|number| number == datum.number) => Ok(Some(datum)),
        (Some(datum), _) => Err(error(
            format!("expected N{} before {identifier}, found N{}", datum.number, number.unwrap_or_default()),
            "number and identifier must belong to the same datum; correct one, or omit the number".to_owned(),
        )),
        (None, Some(datum)) => Err(error(
            format!("expected {datum} by its number, found {identifier}"),
            nearest_identifier(identifier).map_or_else(
                || "correct the number or the identifier".to_owned(),
                |near| format!("did you mean `{near}`?"),
            ),
        )),
        (None, None) => Ok(None),
    }
}

/// Stores the value of a known datum.
fn take(datum: &'static Datum, line: &Line, data: &mut MachineData) -> Result<Target, Problem> {
    let (_, indices) = split_indices(&line.name).ok_or_else(|| {
        Problem::new(
            format!("expected at most an index and an axis in brackets, found `{}`", line.name),
            "write `[AX1]`, `[0,AX1]` or `[0]`",
        )
    })?;
    let target = resolve(datum, &indices, line.channel, data)?;
    let value = Value::parse(&line.value).ok_or_else(|| {
        Problem::new(
            format!("expected a {} for {datum}, found `{}`", datum.kind, line.value),
            "values are written as 12, 1.5, 1EX-05, 'H1c', TRUE or \"text\"",
        )
    })?;
    data.store(&target, &value)?;
    Ok(target)
}

/// One warning for each unknown identifier, at its first place.
fn unknown_findings(unknown: &[Assignment]) -> Vec<Finding> {
    let mut seen = BTreeSet::new();
    let mut findings = Vec::new();
    for assignment in unknown {
        let identifier = assignment.name.split('[').next().unwrap_or_default();
        if seen.insert(identifier) {
            findings.push(Finding {
                severity: Severity::Warning,
                place: Some(assignment.place.clone()),
                number: assignment.number,
                identifier: identifier.to_owned(),
                what: "not modelled (kept, no effect)".to_owned(),
                cure: String::new(),
            });
        }
    }
    findings
}

/// Renames an axis to `AXn` if its default name was given to another axis: a given name always refers to the axis that has it.
fn keep_default_names_apart(data: &mut MachineData, given: &BTreeMap<Target, Place>) {
    let names = &mut data.general.axconf_machax_name_tab;
    let is_given = |index: usize| {
        given.keys().any(|target| target.datum().number == 10000 && usize::from(target.index()) == index)
    };
    let taken: Vec<String> =
        (0..names.len()).filter(|&index| is_given(index)).map(|index| names[index].clone()).collect();
    for (index, name) in names.iter_mut().enumerate() {
        if !is_given(index) && taken.contains(name) {
            *name = format!("AX{}", index + 1);
        }
    }
}

/// The archive files of a machine: the file itself, or, in a directory, all `*.tea`, `*.ini` and `*.mpf` by name, or one `*.arc`.
///
/// # Errors
/// The path cannot be read, or a directory contains a binary archive beside other archives. A directory without any archive gives an empty
/// list.
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
    if files.len() > 1 && files.iter().any(|path| ends_with(path, &["arc"])) {
        return Err(Place::file(&machine.display().to_string()).problem(
            format!("expected one binary archive or only ASCII archives, found {} archives", files.len()),
            "keep one `.arc`, or only `.tea`, `.ini` and `.mpf`",
        ));
    }
    Ok(files)
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
