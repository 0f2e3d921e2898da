//! `opennck machine-data`: the catalogue of machine data (`list`); what was read as a machine, and the findings in its machine data by class
//! (`check`), also of a machine as a scenario changes it.
//!
//! The alarms at power on are those that the machine itself raises in its first cycle.

use std::collections::BTreeMap;
use std::path::Path;

use clap::ValueEnum;

use super::alarms::texts_of;
use super::list::{Format, List};
use super::output::Output;
use crate::control::{Class, DatumRow, Examined, Finding, Texts, summary};
use crate::controls;
use crate::machine::Machine;
use crate::scenario::Scenario;
use crate::source::{Place, Problem};
use crate::units::AxisNumber;
use crate::variables::Describe;

/// A class of findings that does not change the behaviour, and that a user does not accept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Deny {
    /// Data that the control knows and that have no effect here.
    NotModelled,
    /// Values that a later file or line replaced.
    Overlaid,
}

impl Deny {
    const fn class(self) -> Class {
        match self {
            Self::NotModelled => Class::NotModelled,
            Self::Overlaid => Class::Overlaid,
        }
    }
}

/// A summary of what was read, the members that were ignored, and the findings.
#[derive(PartialEq)]
struct Checked {
    summary: Vec<String>,
    ignored: Vec<String>,
    findings: Vec<Finding>,
}

/// Prints the catalogue.
pub(super) fn list(filter: Option<&str>, profile: Option<&str>, format: Format, output: &mut Output) -> u8 {
    let texts = match texts_of(profile) {
        Ok(texts) => texts,
        Err(problem) => {
            output.error(problem);
            return 2;
        }
    };
    let heads = &["number", "name", "unit", "range", "default", "takes effect", "modelled", "meaning"];
    let rows = texts.into_iter().flat_map(Texts::machine_data).map(row).collect();
    let mut list = List { heads, rows };
    let found = match filter {
        // A number is that of a datum, not a part of a range or of a default.
        Some(name) if list.rows.iter().any(|row| row[0] == number_of(name)) => {
            list.rows.retain(|row| row[0] == number_of(name));
            0
        }
        filter => list.retain_with(filter, output),
    };
    list.print(format, output).max(found)
}

/// The number in `32000`, `MD32000`, `SD41110` and `34080[0,XF]`.
fn number_of(name: &str) -> &str {
    let datum = name.split('[').next().unwrap_or_default().trim();
    datum.strip_prefix("MD").or_else(|| datum.strip_prefix("SD")).unwrap_or(datum)
}

fn row(datum: DatumRow) -> Vec<String> {
    let DatumRow { number, name, unit, range, default, effect, modelled, text } = datum;
    let modelled = if modelled { "yes" } else { "no" };
    vec![number.to_string(), name, unit.to_owned(), range, default, effect, modelled.to_owned(), text.to_owned()]
}

pub(super) fn check(path: &Path, case: Option<&str>, all: bool, deny: &[Deny], output: &mut Output) -> u8 {
    let result = if is_scenario(path) { of_scenario(path, case) } else { of_machine(path, case) };
    let reports = match result {
        Ok(reports) => reports,
        Err(problem) => {
            output.error(problem);
            return 2;
        }
    };
    let mut highest = 0;
    for (index, (cases, checked)) in reports.into_iter().enumerate() {
        if index > 0 {
            output.line("");
        }
        for case in cases {
            output.line(format!("case {case}"));
        }
        highest = highest.max(report(checked, all, deny, output));
    }
    highest
}

/// What was checked, and the cases of a matrix for which it is the same.
type Reports = Vec<(Vec<String>, Checked)>;

fn is_scenario(path: &Path) -> bool {
    path.is_file() && path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
}

fn of_machine(path: &Path, case: Option<&str>) -> Result<Reports, Problem> {
    if case.is_some() {
        let place = Place::file(&path.display().to_string());
        return Err(place.problem("expected a scenario (*.toml) with --case, found a machine", "omit --case"));
    }
    Ok(vec![(Vec::new(), checked(path, || Machine::open(path))?)])
}

/// The machine of each case of a scenario; cases with the same findings are one.
fn of_scenario(path: &Path, case: Option<&str>) -> Result<Reports, Problem> {
    let scenarios = match case {
        Some(_) => vec![Scenario::read_case(path, case)?],
        None => Scenario::read_cases(path)?,
    };
    let mut reports = Reports::new();
    for scenario in scenarios {
        let machine = scenario.directory().join(&scenario.machine.text);
        let profile = scenario.profiles.first().copied().unwrap_or_default();
        let mut checked = checked(&machine, || scenario.machine(profile))?;
        // A machine that is refused has no steps.
        if !checked.findings.iter().any(|finding| finding.class == Class::Unreadable)
            && let Err(problem) = scenario.check_steps(profile)
        {
            checked.findings.push(problem.into());
        }
        let name = scenario.variant.as_ref().map(ToString::to_string);
        match reports.iter_mut().find(|(_, known)| *known == checked) {
            Some((names, _)) => names.extend(name),
            None => reports.push((name.into_iter().collect(), checked)),
        }
    }
    Ok(reports)
}

/// Prints how many findings there are, what was read, and the findings, and returns the exit code.
fn report(checked: Checked, all: bool, deny: &[Deny], output: &mut Output) -> u8 {
    let Checked { summary: read, ignored, findings } = checked;
    output.line(summary(&findings).map_or_else(|| "no findings".to_owned(), |counts| format!("findings: {counts}")));
    for line in read {
        output.line(line);
    }
    if all {
        ignored.iter().for_each(|member| output.line(format!("  ignored: {member}")));
    }
    for class in Class::ALL {
        let of_class: Vec<&Finding> = findings.iter().filter(|finding| finding.class == class).collect();
        if of_class.is_empty() {
            continue;
        }
        output.line(format!("\n{}: {}", class.title(), of_class.len()));
        if class == Class::NotModelled {
            groups(&of_class, all, output);
        } else if class == Class::ActsOtherwise && !all {
            by_datum(&of_class, output);
        } else {
            for finding in of_class {
                item("  ", finding, output);
            }
        }
    }
    if !all && (!ignored.is_empty() || findings.iter().any(|finding| finding.class == Class::NotModelled)) {
        output.line(
            "\n--all lists each datum of each axis, each one that is not modelled, and each member that is ignored",
        );
    }
    code(&findings, deny)
}

/// The exit code: 2 if something cannot be read, 1 if a finding changes the behaviour or is denied.
fn code(findings: &[Finding], deny: &[Deny]) -> u8 {
    let any = |test: &dyn Fn(Class) -> bool| findings.iter().any(|finding| test(finding.class));
    if any(&|class| class == Class::Unreadable) {
        return 2;
    }
    u8::from(any(&|class| class.changes_behaviour() || deny.iter().any(|denied| denied.class() == class)))
}

fn item(indent: &str, finding: &Finding, output: &mut Output) {
    output.line(format!("{indent}{}", finding.to_string().replace('\n', &format!("\n{indent}"))));
}

/// Findings about one datum of several axes are one entry: with the line of the first one, its value if all have the same, and the axes.
fn by_datum(findings: &[&Finding], output: &mut Output) {
    // The remedy may name the axis.
    let is_same = |one: &Finding, other: &Finding| {
        one.number.is_some() && one.number == other.number && one.what == other.what && !one.owner.is_empty()
    };
    let mut groups: Vec<Vec<&Finding>> = Vec::new();
    for &finding in findings {
        match groups.iter_mut().find(|group| is_same(group[0], finding)) {
            Some(group) => group.push(finding),
            None => groups.push(vec![finding]),
        }
    }
    for group in groups {
        let first = group[0];
        let [_, _, ..] = &group[..] else {
            item("  ", first, output);
            continue;
        };
        let mut owners: Vec<&str> = group.iter().map(|finding| finding.owner.as_str()).collect();
        owners.dedup();
        let datum = first.datum.split('[').next().unwrap_or_default().to_owned();
        let is_one_value = group.iter().all(|finding| finding.value == first.value);
        let value = if is_one_value { first.value.clone() } else { String::new() };
        item("  ", &Finding { datum, value, owner: listed(&owners), ..first.clone() }, output);
    }
}

/// `axes X1, Y1` for `axis X1` and `axis Y1`; others as they are.
fn listed(owners: &[&str]) -> String {
    let axes: Option<Vec<&str>> = owners.iter().map(|owner| owner.strip_prefix("axis ")).collect();
    match axes {
        Some(axes) if axes.len() > 1 => format!("axes {}", axes.join(", ")),
        Some(_) | None => owners.join(", "),
    }
}

/// Data that are not modelled, by function: the largest group first.
fn groups(findings: &[&Finding], all: bool, output: &mut Output) {
    let mut groups = BTreeMap::<&str, Vec<&Finding>>::new();
    for finding in findings {
        groups.entry(finding.group).or_default().push(finding);
    }
    let mut groups: Vec<_> = groups.into_iter().collect();
    groups.sort_by_key(|(_, group)| std::cmp::Reverse(group.len()));
    for (name, group) in groups {
        let values: usize = group.iter().map(|finding| finding.values).sum();
        output.line(format!("  {name}: {} data, {values} values", group.len()));
        // What is perhaps mistyped is shown in any case.
        group
            .into_iter()
            .filter(|finding| all || !finding.cure.is_empty())
            .for_each(|finding| item("    ", finding, output));
    }
}

/// The findings in the files of a machine. A reason to reject the machine is a finding as well. `open` opens the machine.
fn checked(path: &Path, open: impl FnOnce() -> Result<Machine, Problem>) -> Result<Checked, Problem> {
    if !path.exists() {
        // The name of a built-in machine, or an unknown name.
        return Ok(opened(open()?, Vec::new(), Vec::new()));
    }
    let Examined { is_refused, is_empty, summary, ignored, findings } = controls::examine(path)?;
    if is_refused {
        let findings: Vec<_> = findings.into_iter().filter(|finding| finding.class == Class::Unreadable).collect();
        return match findings.as_slice() {
            // Not a wrong datum, but a file that is not an archive.
            [Finding { number: None, place, what, cure, .. }] => {
                Err(Problem { place: place.clone(), what: what.clone(), cure: cure.clone() })
            }
            _ => Ok(Checked { summary, ignored, findings }),
        };
    }
    match open() {
        Ok(machine) => Ok(opened(machine, summary, ignored)),
        Err(problem) if is_empty => Err(problem),
        // A run rejects this although each machine datum is valid, for example names that clash.
        Err(problem) => {
            let problem = problem.at(&Place::file(&path.display().to_string()));
            Ok(Checked { summary, ignored, findings: vec![problem.into()] })
        }
    }
}

fn opened(machine: Machine, mut summary: Vec<String>, ignored: Vec<String>) -> Checked {
    summary.extend(configuration(&machine));
    let mut findings = machine.findings().to_vec();
    let mut trial = machine;
    trial.step();
    for alarm in trial.variables().alarms.iter() {
        let name = trial.alarm_name(alarm.number);
        let what = format!("{name}: {}", trial.alarm_text(alarm));
        // A control may have found the same in its files, with more words: `70124 …`, `warning 70124: …`.
        let is_same = |finding: &Finding| {
            let mut words = finding.what.split(' ').take(2).map(|word| word.trim_end_matches(':'));
            finding.class == Class::AlarmAtPowerOn && words.any(|word| word == name)
        };
        if !findings.iter().any(|finding| finding.what == what || is_same(finding)) {
            findings.push(Finding::new(Class::AlarmAtPowerOn, what, ""));
        }
    }
    Checked { summary, ignored, findings }
}

/// The axes of the machine with their numbers, and its gantry groupings.
fn configuration(machine: &Machine) -> Vec<String> {
    let axes: Vec<(AxisNumber, &str)> =
        machine.names().axes.iter().filter_map(|(axis, name)| Some((axis, name.as_deref()?))).collect();
    let listed: Vec<String> = axes.iter().map(|(axis, name)| format!("{axis} {name}")).collect();
    let mut lines = vec![format!("machine axes: {}", listed.join(", "))];
    lines.extend(machine.control().configuration(machine.names()));
    lines
}
