//! `opennck` without arguments: runs the worked example of the manual (G1 2.7) from data embedded in the program.

use std::path::Path;

use super::output::Output;
use super::run::result;
use crate::plc::Programs;
use crate::scenario::Scenario;
use crate::source::Problem;

/// The scenario, as it is in the repository.
const SCENARIO: &str = include_str!("../../golden/worked_example/gantry_references_and_synchronises.toml");

/// The built-in machine.
const MACHINE: &str = "g1_example";

const NEXT: &str = "
What to try next:
  opennck signals gantry                  the signals of gantry axes, with addresses
  opennck signals --format csv            the whole catalogue
  opennck run SCENARIO                    your own scenario; start from those in golden/worked_example
  opennck run SCENARIO --svg F.svg        a timing diagram; --vcd F.vcd for GTKWave, --trace F.jsonl for programs
  opennck why SCENARIO X.gantry_axis@1    why a signal has its value, back to the first outside write
  opennck diff A.jsonl B.jsonl            the first difference between two traces
  opennck test                            all scenarios below golden, compared with their golden traces
  opennck machine-data check DIRECTORY    checks your own machine data
  opennck --help                          all commands
";

/// The example as a scenario that needs no file.
///
/// # Errors
/// The embedded data cannot be used. The tests exclude this.
pub fn scenario() -> Result<Scenario, Problem> {
    let mut scenario = Scenario::parse(SCENARIO, Path::new("gantry_references_and_synchronises.toml"))?;
    MACHINE.clone_into(&mut scenario.machine.text);
    Ok(scenario)
}

pub(super) fn run(programs: &Programs, output: &mut Output) -> u8 {
    let prepared = scenario().and_then(|scenario| {
        let profile = scenario.profiles.first().copied().unwrap_or_default();
        scenario.prepare(profile, programs)
    });
    match prepared {
        Ok(prepared) => {
            let finished = prepared.run();
            output.print(&finished.text());
            let code = result(&finished, output);
            output.print(NEXT);
            code
        }
        Err(problem) => {
            output.error(problem);
            2
        }
    }
}
