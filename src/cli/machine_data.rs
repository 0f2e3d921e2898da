//! `opennck machine-data check`: every finding in the machine data of a machine.

use std::path::Path;

use super::output::Output;
use crate::machine::Machine;
use crate::sinumerik::machine_data::{Archive, Finding, Severity, check as look_through, files_of};
use crate::source::Problem;

pub(super) fn check(path: &Path, output: &mut Output) -> u8 {
    let findings = match findings(path) {
        Ok(findings) => findings,
        Err(problem) => {
            output.error(problem);
            return 2;
        }
    };
    for finding in &findings {
        output.line(finding);
    }
    output.line(match findings.len() {
        0 => "no findings".to_owned(),
        1 => "1 finding".to_owned(),
        count => format!("{count} findings"),
    });
    u8::from(!findings.is_empty())
}

/// The findings in the files of a machine; what refuses it is a finding, too.
fn findings(path: &Path) -> Result<Vec<String>, Problem> {
    if !path.exists() {
        // The name of a built-in machine, or nothing.
        return Machine::open(path).map(|machine| machine.warnings().to_vec());
    }
    let findings = match Archive::load(&files_of(path)?) {
        Ok(archive) => look_through(&archive),
        Err(findings) => findings,
    };
    let unreadable = |finding: &Finding| finding.severity == Severity::Error && finding.number.is_none();
    match findings.iter().find(|finding| unreadable(finding)) {
        // Not a wrong datum but a file that is none.
        Some(Finding { place, what, cure, .. }) if findings.len() == 1 => {
            Err(Problem { place: place.clone(), what: what.clone(), cure: cure.clone() })
        }
        _ => Ok(findings.iter().map(ToString::to_string).collect()),
    }
}
