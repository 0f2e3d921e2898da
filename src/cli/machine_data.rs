//! `opennck machine-data check`: prints what was read as a machine, and every finding in its machine data.

use std::path::Path;

use super::output::Output;
use crate::control::Examined;
use crate::controls;
use crate::machine::Machine;
use crate::source::{Place, Problem};
use crate::units::AxisNumber;

/// A summary of what was read, and the findings.
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

/// The findings in the files of a machine. A reason to reject the machine is a finding as well.
fn checked(path: &Path) -> Result<Checked, Problem> {
    if !path.exists() {
        // The name of a built-in machine, or an unknown name.
        let machine = Machine::open(path)?;
        return Ok(Checked { summary: configuration(&machine), findings: machine.warnings().to_vec() });
    }
    let Examined { is_refused, is_empty, mut summary, mut findings } = controls::examine(path)?;
    if is_refused {
        return Ok(Checked { summary, findings });
    }
    match Machine::open(path) {
        Ok(machine) => {
            summary.extend(configuration(&machine));
            // Findings about the files are listed already; add those about what the model does not simulate.
            let more = machine.warnings().iter().filter(|&warning| !findings.contains(warning));
            findings.extend(more.cloned().collect::<Vec<_>>());
        }
        Err(problem) if is_empty => return Err(problem),
        // A run rejects this although each machine datum is valid, for example names that clash.
        Err(mut problem) => {
            problem.place.get_or_insert_with(|| Place::file(&path.display().to_string()));
            findings.push(problem.to_string());
        }
    }
    Ok(Checked { summary, findings })
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
