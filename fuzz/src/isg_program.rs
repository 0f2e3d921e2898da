//! Any bytes as NC programs of the ISG kernel: prepared block by block and checked statically, strictly and leniently.
//!
//! Checks: no panic; every call returns; a copy of the interpreter continues the same; after an error the program has ended; the check finds
//! what stops a run, except for values and endless calls; messages have a text, and a place inside the program.

use std::collections::BTreeMap;
use std::sync::Arc;

use opennck::isg::language::{
    Environment, Fault, FaultCode, Interpreter, Prepared, Refusal, Variables, check, is_called,
};
use opennck::nc_program::Program;

/// A channel that executes everything at once.
#[derive(Clone)]
struct Channel {
    programs: Vec<Arc<Program>>,
    values: BTreeMap<String, f64>,
}

impl Variables for Channel {
    fn read(&self, name: &str) -> Option<f64> {
        match name {
            "V.G.AX_LINK.NR" | "V.G.AX_LINK.ACTIVE" => Some(1.0),
            _ => self.values.get(name).copied(),
        }
    }

    fn may_write(&self, name: &str, _: f64) -> Result<(), Refusal> {
        if name.starts_with("V.E.") { Ok(()) } else { Err(Refusal::Unknown) }
    }

    fn write(&mut self, name: &str, value: f64) {
        assert!(name.starts_with("V.E.") && value.is_finite(), "{name} may not be written");
        self.values.insert(name.to_owned(), value);
    }

    fn waits(&self, name: &str) -> bool {
        name.starts_with("V.G.")
    }
}

impl Environment for Channel {
    fn is_executed(&self) -> bool {
        true
    }

    fn is_skipped(&self, level: u8) -> bool {
        level == 2
    }

    fn program(&self, path: &str) -> Option<Arc<Program>> {
        self.programs.iter().find(|program| program.path() == path).cloned()
    }

    fn find_program(&self, name: &str) -> Option<Arc<Program>> {
        self.programs.iter().find(|program| is_called(name, program)).cloned()
    }
}

/// Calls of the interpreter for one input.
const CALLS: usize = 100;

/// Prepares and checks the programs in these bytes. Returns the number of prepared blocks.
pub fn judge(input: &[u8]) -> usize {
    let programs: Vec<_> = Program::read("part.nc", "", input).into_iter().map(Arc::new).collect();
    let channel = Channel { programs, values: BTreeMap::new() };
    let both = [false, true]
        .map(|lenient| channel.programs.iter().map(|program| run(program, channel.clone(), lenient)).sum::<usize>());
    both[0] + both[1]
}

fn run(program: &Program, mut channel: Channel, lenient: bool) -> usize {
    let found = check(program, &channel.programs, lenient);
    for finding in &found {
        plausible(&finding.fault);
        assert!(finding.fault.line <= program.count().max(1), "{finding:?}");
    }
    let mut interpreter = Interpreter::new(&program.path(), lenient);
    let (mut blocks, mut calculated) = (0, 0);
    for _ in 0..CALLS {
        let (mut copy, mut its_channel) = (interpreter.clone(), channel.clone());
        let result = interpreter.next(&mut channel);
        assert_eq!(format!("{:?}", copy.next(&mut its_channel)), format!("{result:?}"), "a copy continues the same");
        match result {
            Ok(Prepared::Block(block)) => {
                block.warnings.iter().for_each(plausible);
                blocks += 1;
            }
            // An endless loop goes on like this.
            Ok(Prepared::Calculated(_)) if calculated == 2 => break,
            Ok(Prepared::Calculated(_)) => calculated += 1,
            Ok(Prepared::Waits(_)) => panic!("everything has been executed"),
            Ok(Prepared::Ended) => break,
            Err(fault) => {
                plausible(&fault);
                assert!(interpreter.has_ended(), "{fault}");
                let only_at_run_time =
                    fault.code == FaultCode::Value || fault.text.starts_with("subroutines are nested");
                let is_found = found.iter().any(|finding| !finding.is_warning);
                // Another program may have the error.
                assert!(only_at_run_time || is_found || fault.program != program.path(), "{fault}");
                break;
            }
        }
    }
    blocks
}

fn plausible(fault: &Fault) {
    assert!(!fault.text.is_empty() && fault.line >= 1 && fault.column >= 1, "{fault:?}");
}
