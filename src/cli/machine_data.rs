//! `opennck machine-data check`: what was read as a machine, and every finding in its machine data.

use std::path::Path;

use super::output::Output;
use crate::machine::Machine;
use crate::sinumerik::machine_data::{Archive, Finding, MachineData, Severity, check as look_through, files_of};
use crate::source::{Place, Problem};
use crate::units::AxisNumber;

/// What was read, in words, and what is wrong with it.
struct Checked {
    summary: Vec<String>,
    findings: Vec<String>,
}

pub(super) fn check(path: &Path, output: &mut Output) -> u8 {
    let Checked { summary, findings } = match checked(path) {
        Ok(checked) => checked,
        Err(problem) => {
            output.error(problem);
            return 2;
        }
    };
    for line in summary.iter().chain(&findings) {
        output.line(line);
    }
    output.line(match findings.len() {
        0 => "no findings".to_owned(),
        1 => "1 finding".to_owned(),
        count => format!("{count} findings"),
    });
    u8::from(!findings.is_empty())
}

/// The findings in the files of a machine; what refuses it is a finding, too.
fn checked(path: &Path) -> Result<Checked, Problem> {
    if !path.exists() {
        // The name of a built-in machine, or nothing.
        let machine = Machine::open(path)?;
        return Ok(Checked { summary: configuration(&machine), findings: machine.warnings().to_vec() });
    }
    let files = files_of(path)?;
    let archive = match Archive::load(&files) {
        Ok(archive) => archive,
        Err(findings) => return refused(&findings),
    };
    let mut summary: Vec<String> = archive.summary.to_string().lines().map(str::to_owned).collect();
    let mut findings: Vec<String> = look_through(&archive).iter().map(Finding::to_string).collect();
    match Machine::open(path) {
        Ok(machine) => {
            summary.extend(configuration(&machine));
            // Those about the files are there already; those about what the model leaves out are not.
            let more = machine.warnings().iter().filter(|&warning| !findings.contains(warning));
            findings.extend(more.cloned().collect::<Vec<_>>());
        }
        Err(problem) if files.is_empty() => return Err(problem),
        // What a run refuses although every datum is right, as names that clash.
        Err(mut problem) => {
            problem.place.get_or_insert_with(|| Place::file(&path.display().to_string()));
            findings.push(problem.to_string());
        }
    }
    Ok(Checked { summary, findings })
}

/// What is said of an archive that nothing was taken from.
fn refused(findings: &[Finding]) -> Result<Checked, Problem> {
    match findings {
        // Not a wrong datum but a file that is none.
        [Finding { severity: Severity::Error, number: None, place, what, cure, .. }] => {
            Err(Problem { place: place.clone(), what: what.clone(), cure: cure.clone() })
        }
        _ => Ok(Checked { summary: Vec::new(), findings: findings.iter().map(ToString::to_string).collect() }),
    }
}

/// The axes of the machine with their numbers, and its gantry groupings.
fn configuration(machine: &Machine) -> Vec<String> {
    let axes: Vec<(AxisNumber, &str)> =
        machine.names().axes.iter().filter_map(|(axis, name)| Some((axis, name.as_deref()?))).collect();
    let listed: Vec<String> = axes.iter().map(|(axis, name)| format!("{axis} {name}")).collect();
    let mut lines = vec![format!("machine axes: {}", listed.join(", "))];
    lines.extend((1..=8).filter_map(|grouping| gantry(machine.machine_data(), &axes, grouping)));
    lines
}

/// Who leads whom in a gantry grouping; nothing where no axis belongs to it.
fn gantry(data: &MachineData, axes: &[(AxisNumber, &str)], grouping: u8) -> Option<String> {
    let with = |code: u8| {
        let of_code = |(axis, _): &&(AxisNumber, &str)| data.axes[*axis].gantry_axis_type == code;
        let names: Vec<&str> = axes.iter().filter(of_code).map(|(_, name)| *name).collect();
        names.join(" and ")
    };
    let (leading, synchronous) = (with(grouping), with(10 + grouping));
    let or = |names: String, none: &str| if names.is_empty() { none.to_owned() } else { names };
    let any = !leading.is_empty() || !synchronous.is_empty();
    any.then(|| {
        let leading = or(leading, "no axis of this machine");
        format!("gantry grouping {grouping}: {leading} leads {}", or(synchronous, "no axis of this machine"))
    })
}
