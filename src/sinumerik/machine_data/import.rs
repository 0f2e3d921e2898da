//! From the lines of all files to the values of an archive.
//!
//! Two passes, because a file may use the name of an axis before MD10000 defines it. The first pass sets names of axes and channels and the
//! types of axes (MD30300), the second everything else in the order of the files; a later assignment replaces an earlier one. A text file
//! that replaces a value of an earlier file is reported, value by value; in a file that a person wrote, also one that replaces a value of
//! its own. The system of units (MD10240) and the types of axes are known before any length is taken.
//!
//! A value outside of its range that has the type of its datum is kept, with a finding: a control accepted it (O-30). In a binary archive,
//! which only a control writes, a line that does not fit the catalogue at all (another index, another type) is kept like unknown data. A
//! datum outside of the catalogue is perhaps mistyped in a file that a person wrote, and known to the control in one that it exported.

use std::collections::{BTreeMap, BTreeSet};

use super::archive::{Archive, Summary};
use super::catalogue::{by_identifier, by_number, meant};
use super::export;
use super::groups::{group, is_of_another_list};
use super::named::{resolve, split_indices};
use super::reading::{Assignment, Author, Line, Reading};
use super::table::{Datum, datum_name};
use super::{MachineData, TableVariable, Target};
use crate::control::{Class, Finding, Value};
use crate::source::{Place, Problem};
use crate::units::ChannelNumber;

/// Below this number `N…` is only a block number; there are no machine data with smaller numbers.
const FIRST_DATUM: u32 = 9_000;

/// A name of unknown data, and its channel if it depends on one.
type UnknownKey = (Option<ChannelNumber>, String);

/// The values while lines are taken.
#[derive(Default)]
struct Import {
    data: MachineData,
    /// Place and file of each given value.
    given: BTreeMap<Target, (Place, usize)>,
    /// Unknown data with their order.
    unknown: BTreeMap<UnknownKey, (usize, Line)>,
    /// The names among them that a control exported.
    of_control: BTreeSet<String>,
    /// Values that are kept although they are implausible; the last assignment of a target counts.
    implausible: BTreeMap<Target, Finding>,
    findings: Vec<Finding>,
}

impl Archive {
    /// Stores the value of a scenario over those of the files, with the findings that it ends and makes.
    ///
    /// # Errors
    /// As [`MachineData::set`].
    pub(in crate::sinumerik) fn lay_over(
        &mut self,
        target: Target,
        value: &Value,
        place: &Place,
    ) -> Result<(), Problem> {
        self.data.set(&target, value)?;
        self.given.insert(target, place.clone());
        let datum = target.datum();
        let name = with_number(Some(datum.number), &target.to_string());
        self.findings.retain(|finding| finding.class != Class::Implausible || finding.datum != name);
        if let Some(number) = value.number()
            && !datum.range.is_plausible(number)
        {
            let owner = self.data.owner_in_words(target.owner());
            let finding = implausible(&target, number, &value.export(datum.kind), place);
            self.findings.push(Finding { owner, ..finding });
        }
        Ok(())
    }

    /// The archive from all lines.
    pub(super) fn from_reading(reading: Reading) -> Result<Self, Vec<Finding>> {
        let Reading { mut lines, findings, members, file: _ } = reading;
        export::mark(&mut lines);
        let mut import = Import { findings, ..Import::default() };
        let (mut known, mut tables) = (Vec::new(), Vec::new());
        for (order, line) in lines.into_iter().enumerate() {
            if let Some(variable) = TableVariable::named(identifier(&line.name)) {
                tables.push((variable, order, line));
                continue;
            }
            match known_datum(&line) {
                Ok(Some(datum)) => known.push((datum, order, line)),
                Ok(None) => import.keep(order, line),
                Err(finding) => import.unfit(*finding, order, line),
            }
        }
        known.sort_by_key(|(datum, ..)| match datum.number {
            10000 | 20000 => 0,
            10240 | 10250 => 1,
            30300 => 2,
            _ => 3,
        });
        import.system_of(&known);
        let mut named = false;
        for (datum, order, line) in known {
            if !named && !matches!(datum.number, 10000 | 20000) {
                named = true;
                import.keep_default_names_apart();
            }
            import.take(datum, order, line);
        }
        if !named {
            import.keep_default_names_apart();
        }
        for (variable, order, line) in tables {
            import.take_table(variable, order, line);
        }
        import.finish(members)
    }
}

impl Author {
    /// Whether a value that replaces another one is reported: in a text file one of an earlier file, in one that a person wrote also one of
    /// the same file.
    fn replaces(self, of_another_file: bool) -> bool {
        match self {
            Self::Person => true,
            Self::Export => of_another_file,
            Self::Control => false,
        }
    }
}

impl Import {
    /// Makes the defaults those of the system that the last MD10240 gives, and reports lines that declare the other one.
    fn system_of(&mut self, known: &[(&'static Datum, usize, Line)]) {
        let last = known.iter().rev().find(|(datum, ..)| datum.number == 10240);
        let is_inch = last.and_then(|(_, _, line)| Value::parse(&line.value)?.whole()) == Some(0);
        if is_inch {
            let metric = self.data.clone();
            self.data.general.scaling_system_is_metric = false;
            self.data.change_system(&metric);
        }
        let own = self.data.system();
        let mut reported = Vec::new();
        for (_, _, line) in known {
            if let Some(declared) = line.system.filter(|declared| *declared != own)
                && !reported.contains(&line.place.file)
            {
                reported.push(line.place.file.clone());
                let what =
                    format!("{}, but MD10240 = {}: the lengths are converted", declared.word(), u8::from(!is_inch));
                let cure = format!("export the archive with {}, or correct MD10240", own.word());
                let place = Some(Place::file(&line.place.file));
                self.findings.push(Finding { place, ..Finding::new(Class::Implausible, what, cure) });
            }
        }
    }

    /// Keeps a line whose datum is not in the catalogue.
    fn keep(&mut self, order: usize, line: Line) {
        // Only channel data depend on the section in which they are.
        let per_channel = line.name.starts_with("$MC") || line.name.starts_with("$SC");
        let key = (per_channel.then_some(line.channel), line.name.to_ascii_uppercase());
        let value = line.value.clone();
        if line.author != Author::Person {
            self.of_control.insert(identifier(&line.name).to_ascii_uppercase());
        }
        let (place, file, author) = (line.place.clone(), line.file, line.author);
        let subject = with_number(line.number, &line.name);
        let before = self.unknown.insert(key, (order, line));
        if let Some((_, before)) = before
            && author.replaces(before.file != file)
            && before.value != value
        {
            let finding =
                Finding { place: Some(place), datum: subject, value, ..overlaid(&before.value, &before.place) };
            self.findings.push(finding);
        }
    }

    /// A line that does not fit the catalogue: an error of a person, or kept as it is if a control wrote it.
    fn unfit(&mut self, finding: Finding, order: usize, line: Line) {
        match line.author {
            Author::Person | Author::Export => self.findings.push(finding),
            Author::Control => {
                let cure = "kept, no effect: a control exported it, and its default acts here".to_owned();
                self.findings.push(Finding { class: Class::Implausible, cure, ..finding });
                self.keep(order, line);
            }
        }
    }

    /// Stores the value of a known datum.
    fn take(&mut self, datum: &'static Datum, order: usize, line: Line) {
        let target = match self.target(datum, &line) {
            Ok(target) => target,
            Err(problem) => return self.unfit(about(datum, &line, problem), order, line),
        };
        let before = self.data.get(&target);
        let parsed = parsed(datum, &line).map(|value| match line.system {
            Some(declared) => self.data.converted(&target, value, declared),
            None => value,
        });
        let stored = parsed.and_then(|value| self.data.import(&target, &value).map(|()| value));
        let value = match stored {
            Ok(value) => value,
            Err(problem) => return self.unfit(about(datum, &line, problem), order, line),
        };
        self.implausible.remove(&target);
        if let Some(number) = value.number()
            && !datum.range.is_plausible(number)
        {
            self.implausible.insert(target, implausible(&target, number, &line.value, &line.place));
        }
        let place = line.place.clone();
        let earlier = self.given.insert(target, (line.place, line.file));
        if let (Some(before), Some((from, file))) = (before, earlier)
            && line.author.replaces(file != line.file)
            && self.data.get(&target).is_some_and(|now| now != before)
        {
            let finding = Finding {
                place: Some(place),
                number: Some(datum.number),
                datum: with_number(Some(datum.number), &target.to_string()),
                value: line.value,
                owner: self.data.owner_in_words(target.owner()),
                ..overlaid(&before.export(datum.kind), &from)
            };
            self.findings.push(finding);
        }
    }

    /// Stores an element of a compensation table.
    fn take_table(&mut self, variable: TableVariable, order: usize, line: Line) {
        if let Err(problem) = self.data.read_table_line(variable, &line.name, &line.value) {
            let Problem { what, cure, .. } = problem;
            let finding = Finding {
                place: Some(line.place.clone()),
                datum: line.name.clone(),
                ..Finding::new(Class::Unreadable, what, cure)
            };
            self.unfit(finding, order, line);
        }
    }

    fn target(&self, datum: &'static Datum, line: &Line) -> Result<Target, Problem> {
        let (_, indices) = split_indices(&line.name).ok_or_else(|| {
            Problem::new(
                format!("expected at most an index and an axis in brackets, found `{}`", line.name),
                "write `[AX1]`, `[0,AX1]` or `[0]`",
            )
        })?;
        resolve(datum, &indices, line.channel, &self.data)
    }

    /// Renames an axis to `AXn` if its default name was given to another axis: a given name always refers to the axis that has it.
    fn keep_default_names_apart(&mut self) {
        let names = &mut self.data.general.axconf_machax_name_tab;
        let is_given = |index: usize| {
            let name = |target: &Target| target.datum().number == 10000 && usize::from(target.index()) == index;
            self.given.keys().any(name)
        };
        let taken: Vec<String> =
            (0..names.len()).filter(|&index| is_given(index)).map(|index| names[index].clone()).collect();
        for (index, name) in names.iter_mut().enumerate() {
            if !is_given(index) && taken.contains(name) {
                *name = format!("AX{}", index + 1);
            }
        }
    }

    fn finish(self, members: Vec<super::Member>) -> Result<Archive, Vec<Finding>> {
        let Self { data, given, unknown, of_control, implausible, mut findings } = self;
        let out_of_range = implausible.keys().copied().filter(|target| {
            let number = data.get(target).and_then(|value| value.number());
            number.is_some_and(|number| !target.datum().range.contains(number))
        });
        let out_of_range = out_of_range.collect();
        let named = |(target, finding)| Finding { owner: data.owner_in_words(Target::owner(&target)), ..finding };
        findings.extend(implausible.into_iter().map(named));
        let mut unknown: Vec<_> = unknown.into_values().collect();
        unknown.sort_by_key(|(order, _)| *order);
        findings.extend(unknown_findings(unknown.iter().map(|(_, line)| line), &of_control));
        let unknown: Vec<Assignment> = unknown.into_iter().map(|(_, line)| line.into()).collect();
        findings.sort_by(|a, b| a.class.cmp(&b.class).then_with(|| a.place.cmp(&b.place)));
        if findings.iter().any(|finding| finding.class == Class::Unreadable) {
            return Err(findings);
        }
        let summary = Summary { members, taken: given.len(), unknown: unknown.len() };
        let given = given.into_iter().map(|(target, (place, _))| (target, place)).collect();
        Ok(Archive { data, given, unknown, out_of_range, findings, summary })
    }
}

/// A name without its index.
fn identifier(name: &str) -> &str {
    name.split('[').next().unwrap_or_default().trim()
}

/// The datum of a line; `None` if it is not in the catalogue.
fn known_datum(line: &Line) -> Result<Option<&'static Datum>, Box<Finding>> {
    let identifier = identifier(&line.name);
    let number = line.number.filter(|number| *number >= FIRST_DATUM);
    let error = |what: String, cure: String| {
        Box::new(Finding {
            place: Some(line.place.clone()),
            number,
            datum: with_number(number, identifier),
            ..Finding::new(Class::Unreadable, what, cure)
        })
    };
    if line.author == Author::Person {
        number_alone(identifier, &error)?;
    }
    // A name without a prefix is a user variable, not a machine datum.
    let by_name = identifier.starts_with('$').then(|| by_identifier(identifier)).flatten();
    match (by_name, number.and_then(by_number)) {
        (Some(datum), _) if number.is_none_or(|number| number == datum.number) && !misses_a_digit(datum, line) => {
            Ok(Some(datum))
        }
        (Some(datum), _) => Err(error(
            format!("expected N{} before {identifier}, found N{}", datum.number, line.number.unwrap_or_default()),
            "number and identifier must belong to the same datum; correct one, or omit the number".to_owned(),
        )),
        (None, Some(datum)) => Err(error(
            format!("expected {datum} by its number, found {identifier}"),
            meant(identifier).unwrap_or_else(|| "correct the number or the identifier".to_owned()),
        )),
        (None, None) => Ok(None),
    }
}

/// A number without a name, `N32000=5`, which is no assignment on a control.
fn number_alone(identifier: &str, error: &impl Fn(String, String) -> Box<Finding>) -> Result<(), Box<Finding>> {
    let digits = identifier.strip_prefix(['N', 'n']).filter(|digits| digits.bytes().all(|byte| byte.is_ascii_digit()));
    let Some(digits) = digits.filter(|digits| !digits.is_empty()) else { return Ok(()) };
    let known = digits.parse().ok().and_then(by_number);
    let name = known.map_or_else(|| "$MA_GANTRY_AXIS_TYPE".to_owned(), Datum::full_identifier);
    let number = known.map_or(37100, |datum| datum.number);
    let index = if name.starts_with("$MA") { "[AX1]" } else { "" };
    Err(error(
        format!("expected the name of a machine datum after N{digits}, found none"),
        format!("write number and name such as `N{number} {name}{index}=…`, or only the name"),
    ))
}

/// Whether the block number before a datum is its own number without one digit: `N3200 $MA_MAX_AX_VELO`. Other numbers below 9000 are those
/// of blocks.
fn misses_a_digit(datum: &Datum, line: &Line) -> bool {
    let Some(block) = line.number.filter(|number| *number < FIRST_DATUM && line.author == Author::Person) else {
        return false;
    };
    let (own, block) = (datum.number.to_string(), block.to_string());
    (0..own.len()).any(|at| own[..at] == block[..at.min(block.len())] && own[at + 1..] == block[at.min(block.len())..])
}

fn parsed(datum: &Datum, line: &Line) -> Result<Value, Problem> {
    Value::parse(&line.value).ok_or_else(|| {
        Problem::new(
            format!("expected a {} for {datum}, found `{}`", datum.kind, line.value),
            "values are written as 12, 1.5, 1EX-05, 'H1c', TRUE or \"text\"",
        )
    })
}

/// The number and the name of a datum: `MD37100 $MA_GANTRY_AXIS_TYPE[AX1]`.
pub(super) fn with_number(number: Option<u32>, name: &str) -> String {
    number.map_or_else(|| name.to_owned(), |number| format!("{} {name}", datum_name(number)))
}

/// The finding of a problem with a line.
fn about(datum: &Datum, line: &Line, problem: Problem) -> Finding {
    Finding {
        place: Some(line.place.clone()),
        number: Some(datum.number),
        datum: with_number(Some(datum.number), &line.name),
        ..Finding::new(Class::Unreadable, problem.what, problem.cure)
    }
}

fn overlaid(before: &str, from: &Place) -> Finding {
    Finding::new(Class::Overlaid, format!("replaces {before} of {from}"), "")
}

fn implausible(target: &Target, number: f64, value: &str, place: &Place) -> Finding {
    let datum = target.datum();
    let cure = if datum.range.contains(number) {
        "kept, as on a control; a function that needs it raises its alarm when it starts".to_owned()
    } else {
        format!("kept, as on a control; {} acts", datum.range.nearest(number))
    };
    Finding {
        place: Some(place.clone()),
        number: Some(datum.number),
        datum: with_number(Some(datum.number), &target.to_string()),
        value: value.to_owned(),
        ..Finding::new(Class::Implausible, format!("expected {}", datum.range), cure)
    }
}

/// One finding for each unknown identifier that a control knows, at its first place, and one for each line that is perhaps mistyped.
/// `of_control` are the names in files that a control exported: it knows them also in a file that a person wrote beside them.
fn unknown_findings<'a>(unknown: impl Iterator<Item = &'a Line>, of_control: &BTreeSet<String>) -> Vec<Finding> {
    let mut found = BTreeMap::<&str, usize>::new();
    let mut findings = Vec::new();
    for line in unknown {
        let identifier = identifier(&line.name);
        let is_known = || of_control.contains(&identifier.to_ascii_uppercase()) || is_of_another_list(identifier);
        if line.author == Author::Person && !is_known() {
            findings.push(mistyped(line, identifier));
            continue;
        }
        if let Some(&at) = found.get(identifier) {
            let finding: &mut Finding = &mut findings[at];
            finding.values += 1;
            continue;
        }
        found.insert(identifier, findings.len());
        findings.push(Finding {
            place: Some(line.place.clone()),
            number: line.number,
            datum: with_number(line.number, identifier),
            group: group(line.number, identifier),
            ..Finding::new(Class::NotModelled, "kept, no effect", "")
        });
    }
    findings
}

fn mistyped(line: &Line, identifier: &str) -> Finding {
    let all = || {
        "`opennck machine-data list` shows the known ones; a datum of a control that is not among them has no effect"
            .to_owned()
    };
    Finding {
        place: Some(line.place.clone()),
        number: line.number,
        datum: with_number(line.number, &line.name),
        value: line.value.clone(),
        group: group(line.number, identifier),
        ..Finding::new(
            Class::Mistyped,
            "expected a known machine datum; this one is kept, without effect",
            meant(identifier).unwrap_or_else(all),
        )
    }
}
