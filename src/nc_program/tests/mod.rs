//! Tests of the language, over a channel that executes everything at once.
#![expect(clippy::float_cmp, reason = "the values are exact")]

mod alarms;
mod any_text;
mod blocks;
mod checks;
mod expressions;
mod flow;
mod frames;
mod saved;
mod words;

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::nc_program::{
    AxisKind, AxisName, AxisNames, Block, Dialect, Environment, Interpreter, Library, Modal, Prepared, Program,
    ProgramAlarm, Request, SINUMERIK, SystemVariable, Value, VariableRefusal,
};

/// A channel for tests.
pub(super) struct Channel {
    axes: Arc<AxisNames>,
    r: Vec<f64>,
    system: BTreeMap<String, Value>,
    pub(super) library: Library,
    is_executed: bool,
    skipped: Vec<u8>,
    is_restarting: bool,
}

impl Channel {
    pub(super) fn new() -> Self {
        let row = |name: &str, kind| AxisName::new(name, kind);
        let axes = AxisNames::new([
            row("X", AxisKind::Linear),
            row("Y", AxisKind::Linear),
            row("Z", AxisKind::Linear),
            row("A", AxisKind::Rotary),
            row("C", AxisKind::Modulo),
            row("X1", AxisKind::Linear),
            row("XF", AxisKind::Linear),
        ]);
        let system = [
            ("$AA_IM", Value::Real(12.5)),
            ("$P_PROG", Value::Text("PART".to_owned())),
            ("$MC_LIMIT", Value::Int(5)),
            ("$MN_FIXED", Value::Int(1)),
        ];
        Self {
            axes: Arc::new(axes),
            r: vec![0.0; 100],
            system: system.map(|(name, value)| (name.to_owned(), value)).into(),
            library: Library::new(Vec::new()),
            is_executed: true,
            skipped: Vec::new(),
            is_restarting: false,
        }
    }

    /// A program of the channel.
    pub(super) fn with(mut self, name: &str, text: &str) -> Self {
        for program in Program::read(name, "", text.as_bytes()) {
            self.library.add(program);
        }
        self
    }
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
        self.r[index as usize] = value;
    }

    fn system(&self, variable: &SystemVariable<'_>) -> Result<Value, VariableRefusal> {
        match variable.indices {
            [Value::Int(99)] => return Err(VariableRefusal::FirstIndex),
            [_, Value::Int(99)] => return Err(VariableRefusal::SecondIndex),
            [Value::Axis(axis)] if self.axes.name(*axis) == "XF" => return Err(VariableRefusal::Axis),
            _ => {}
        }
        match variable.name {
            "$MN_SECRET" => Err(VariableRefusal::ReadProtected),
            "$AC_PATHN" => Err(VariableRefusal::NotModelled),
            name => self.system.get(name).cloned().ok_or(VariableRefusal::Unknown),
        }
    }

    fn set_system(&mut self, variable: &SystemVariable<'_>, value: &Value) -> Result<(), VariableRefusal> {
        match (variable.name, value.number()) {
            ("$MN_FIXED", _) => Err(VariableRefusal::WriteProtected),
            ("$MC_LIMIT", None) => Err(VariableRefusal::WrongType),
            ("$MC_LIMIT", Some(number)) if number < 0.0 => Err(VariableRefusal::Below),
            ("$MC_LIMIT", Some(number)) if number > 10.0 => Err(VariableRefusal::Above),
            ("$MC_LIMIT", Some(number)) if number.fract() != 0.0 => Err(VariableRefusal::Invalid),
            (name, _) if self.system.contains_key(name) => {
                self.system.insert(name.to_owned(), value.clone());
                Ok(())
            }
            _ => Err(VariableRefusal::Unknown),
        }
    }

    fn is_executed(&self) -> bool {
        self.is_executed
    }

    fn is_skipped(&self, level: u8) -> bool {
        self.skipped.contains(&level)
    }

    fn is_restarting(&self) -> bool {
        self.is_restarting
    }

    fn replacing_program(&self, m: f64) -> Option<String> {
        [60.0, 61.0].contains(&m).then(|| "SUB".to_owned())
    }

    fn find_program(&self, request: &Request<'_>) -> Option<Arc<Program>> {
        self.library.find(request)
    }

    fn program(&self, path: &str) -> Option<Arc<Program>> {
        self.library.program(path)
    }
}

/// The interpreter of the program `PART.MPF`.
pub(super) fn interpreter() -> Interpreter {
    Interpreter::new("PART.MPF", Modal::default(), None, false)
}

/// The blocks of a program up to its end or its alarm.
pub(super) fn run_in(channel: &mut Channel) -> (Vec<Block>, Option<ProgramAlarm>) {
    let (mut interpreter, mut blocks) = (interpreter(), Vec::new());
    for _ in 0..10_000 {
        match interpreter.next(channel) {
            Ok(Prepared::Block(block)) => blocks.push(*block),
            Ok(Prepared::Calculated(_) | Prepared::Before(_) | Prepared::Waits(_)) => {}
            Ok(Prepared::Ended) => return (blocks, None),
            Err(alarm) => return (blocks, Some(alarm)),
        }
    }
    panic!("the program does not end: {blocks:?}");
}

/// The blocks of a main program, which has no alarm.
#[track_caller]
pub(super) fn run(text: &str) -> Vec<Block> {
    let (blocks, alarm) = run_in(&mut Channel::new().with("PART.MPF", text));
    assert_eq!(alarm, None, "{text}");
    blocks
}

/// The alarm of a main program.
#[track_caller]
pub(super) fn alarm(text: &str) -> ProgramAlarm {
    let (blocks, alarm) = run_in(&mut Channel::new().with("PART.MPF", text));
    alarm.unwrap_or_else(|| panic!("no alarm: {text}: {blocks:?}"))
}

/// The values of axes in the order of the blocks, as `X10 Y-5`.
pub(super) fn path(blocks: &[Block]) -> String {
    let axes = Channel::new().axes;
    let words = blocks.iter().flat_map(|block| &block.axes);
    let words = words.map(|word| format!("{}{}", axes.name(word.axis), word.value));
    words.collect::<Vec<_>>().join(" ")
}

/// R parameters 1 to n after a program without alarm.
#[track_caller]
pub(super) fn r(text: &str, count: usize) -> Vec<f64> {
    let mut channel = Channel::new().with("PART.MPF", text);
    let (_, alarm) = run_in(&mut channel);
    assert_eq!(alarm, None, "{text}");
    channel.r[1..=count].to_vec()
}

/// Checks a main program statically: numbers of alarms and lines of warnings.
pub(super) fn checked(channel: &Channel, name: &str) -> (Vec<u32>, Vec<u32>) {
    let program = channel.library.program(name).unwrap();
    let (mut alarms, mut warnings) = (Vec::new(), Vec::new());
    for finding in crate::nc_program::check(&program, &channel.library, &channel.axes, &SINUMERIK) {
        match finding {
            crate::nc_program::CheckFinding::Alarm(alarm) => alarms.push(alarm.number),
            crate::nc_program::CheckFinding::Warning { line, .. } => warnings.push(line),
        }
    }
    (alarms, warnings)
}
