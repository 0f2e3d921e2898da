//! `opennck machine-data check`: prints what was read as a machine, and the findings in its machine data by class.
//!
//! The alarms at power on are those that the machine itself raises in its first cycle.

use std::collections::BTreeMap;
use std::path::Path;

use clap::ValueEnum;

use super::output::Output;
use crate::control::{Class, Examined, Finding, summary};
use crate::controls;
use crate::machine::Machine;
use crate::source::{Place, Problem};
use crate::units::AxisNumber;
use crate::variables::Describe;

/// A class of findings that does not change the behaviour, and that a user does not accept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Deny {
    /// Data that the control knows and that have no effect here.
    NotModelled,
    /// Values that a later file replaced.
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

/// A summary of what was read, and the findings.
struct Checked {
    summary: Vec<String>,
    findings: Vec<Finding>,
}

pub(super) fn check(path: &Path, all: bool, deny: &[Deny], output: &mut Output) -> u8 {
    let Checked { summary: read, findings } = match checked(path) {
        Ok(checked) => checked,
        Err(problem) => {
            output.error(problem);
            return 2;
        }
    };
    for line in read {
        output.line(line);
    }
    for class in Class::ALL {
        let of_class: Vec<&Finding> = findings.iter().filter(|finding| finding.class == class).collect();
        if of_class.is_empty() {
            continue;
        }
        output.line(format!("\n{}: {}", class.title(), of_class.len()));
        if class == Class::NotModelled {
            groups(&of_class, all, output);
        } else {
            for finding in of_class {
                item("  ", finding, output);
            }
        }
    }
    output.line(summary(&findings).map_or_else(|| "no findings".to_owned(), |counts| format!("\nfindings: {counts}")));
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
        if all {
            group.into_iter().for_each(|finding| item("    ", finding, output));
        }
    }
    if !all {
        output.line("  (--all lists each datum)");
    }
}

/// The findings in the files of a machine. A reason to reject the machine is a finding as well.
fn checked(path: &Path) -> Result<Checked, Problem> {
    if !path.exists() {
        // The name of a built-in machine, or an unknown name.
        return Ok(opened(Machine::open(path)?, Vec::new()));
    }
    let Examined { is_refused, is_empty, summary, findings } = controls::examine(path)?;
    if is_refused {
        let findings: Vec<_> = findings.into_iter().filter(|finding| finding.class == Class::Unreadable).collect();
        return match findings.as_slice() {
            // Not a wrong datum, but a file that is not an archive.
            [Finding { number: None, place, what, cure, .. }] => {
                Err(Problem { place: place.clone(), what: what.clone(), cure: cure.clone() })
            }
            _ => Ok(Checked { summary, findings }),
        };
    }
    match Machine::open(path) {
        Ok(machine) => Ok(opened(machine, summary)),
        Err(problem) if is_empty => Err(problem),
        // A run rejects this although each machine datum is valid, for example names that clash.
        Err(problem) => {
            let problem = problem.at(&Place::file(&path.display().to_string()));
            Ok(Checked { summary, findings: vec![problem.into()] })
        }
    }
}

fn opened(machine: Machine, mut summary: Vec<String>) -> Checked {
    summary.extend(configuration(&machine));
    let mut findings = machine.findings().to_vec();
    let mut trial = machine;
    trial.step();
    for alarm in trial.variables().alarms.iter() {
        let what = format!("{}: {}", trial.alarm_name(alarm.number), trial.alarm_text(alarm));
        if !findings.iter().any(|finding| finding.what == what) {
            findings.push(Finding::new(Class::AlarmAtPowerOn, what, ""));
        }
    }
    Checked { summary, findings }
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
