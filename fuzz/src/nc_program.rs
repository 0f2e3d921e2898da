//! Any bytes as NC programs: prepared block by block and checked statically.
//!
//! Checks: no panic; every call returns; a copy of the interpreter continues the same; an alarm leaves the interpreter where it was; alarms
//! have a text, and a place inside the program.

use std::sync::Arc;

use opennck::nc_program::{
    AxisNames, CheckFinding, Dialect, Environment, Interpreter, Library, Modal, Prepared, Program, ProgramAlarm,
    Request, SINUMERIK, SystemVariable, Value, VariableRefusal, check,
};

/// A channel that executes everything at once.
#[derive(Clone)]
struct Channel {
    axes: Arc<AxisNames>,
    library: Library,
    r: Vec<f64>,
}

impl Environment for Channel {
    fn dialect(&self) -> &'static Dialect {
        &SINUMERIK
    }

    fn axes(&self) -> Arc<AxisNames> {
        Arc::clone(&self.axes)
    }

    fn r_parameters(&self) -> u32 {
        100
    }

    fn r_parameter(&self, index: u32) -> f64 {
        self.r[index as usize]
    }

    fn set_r_parameter(&mut self, index: u32, value: f64) {
        assert!(value.is_finite(), "an R parameter is a number");
        self.r[index as usize] = value;
    }

    fn system(&self, variable: &SystemVariable<'_>) -> Result<Value, VariableRefusal> {
        match variable.name {
            "$AA_IM" => Ok(Value::Real(1.5)),
            "$P_PROG" => Ok(Value::Text("PART".to_owned())),
            _ => Err(VariableRefusal::Unknown),
        }
    }

    fn set_system(&mut self, _: &SystemVariable<'_>, _: &Value) -> Result<(), VariableRefusal> {
        Err(VariableRefusal::WriteProtected)
    }

    fn is_executed(&self) -> bool {
        true
    }

    fn is_skipped(&self, level: u8) -> bool {
        level == 1
    }

    fn is_restarting(&self) -> bool {
        false
    }

    fn find_program(&self, request: &Request<'_>) -> Option<Arc<Program>> {
        self.library.find(request)
    }

    fn program(&self, path: &str) -> Option<Arc<Program>> {
        self.library.program(path)
    }
}

/// Calls of the interpreter for one input.
const CALLS: usize = 100;

/// Prepares and checks the programs in these bytes. Returns the number of prepared blocks.
pub fn judge(input: &[u8]) -> usize {
    let mut library = Library::default();
    let programs: Vec<_> =
        Program::read("PART.MPF", "", input).into_iter().map(|program| library.add(program)).collect();
    let axes = Arc::new(AxisNames::usual());
    let mut blocks = 0;
    for program in &programs {
        let channel = Channel { axes: Arc::clone(&axes), library: library.clone(), r: vec![0.0; 100] };
        blocks += run(program, channel);
        for finding in check(program, &library, &axes, &SINUMERIK) {
            let (line, column) = finding.place();
            assert!(column >= 1 && line <= program.count().max(1), "{finding:?}");
            if let CheckFinding::Alarm(alarm) = finding {
                plausible(&alarm);
            }
        }
    }
    blocks
}

fn run(program: &Program, mut channel: Channel) -> usize {
    let mut interpreter = Interpreter::new(&program.path(), Modal::default(), None, false);
    let mut blocks = 0;
    for _ in 0..CALLS {
        let (mut copy, mut its_channel) = (interpreter.clone(), channel.clone());
        let before = interpreter.clone();
        let result = interpreter.step(&mut channel);
        assert_eq!(format!("{:?}", copy.step(&mut its_channel)), format!("{result:?}"), "a copy continues the same");
        match result {
            Ok(Prepared::Block(_)) => blocks += 1,
            Ok(Prepared::Calculated(_)) => {}
            Ok(Prepared::Before(_)) => panic!("no search runs"),
            Ok(Prepared::Waits(_)) => panic!("everything has been executed"),
            Ok(Prepared::Ended) => break,
            Err(alarm) => {
                plausible(&alarm);
                assert_eq!(interpreter.stack().collect::<Vec<_>>().len(), before.stack().count());
                let again = interpreter.step(&mut channel).expect_err("the block is read again");
                assert_eq!(again, alarm);
                break;
            }
        }
    }
    blocks
}

fn plausible(alarm: &ProgramAlarm) {
    assert!(!alarm.title().is_empty() && !alarm.block.is_empty() && alarm.column >= 1, "{alarm:?}");
}
