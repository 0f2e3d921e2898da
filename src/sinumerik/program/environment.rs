//! What the programs of a channel read and write: R parameters, system variables, machine and setting data, other programs, skip levels.
//!
//! A machine datum is read as it is stored, and written as by the operator: it takes effect as its class defines.

use std::sync::Arc;

use crate::control;
use crate::control::Owner;
use crate::nc_program::{
    AxisIndex, AxisNames, Dialect, Environment, Library, Modal, Program, Request, SINUMERIK, SystemVariable, Value,
    VariableRefusal,
};
use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::exchange::state::Owners;
use crate::sinumerik::machine_data::{
    Element, MachineData, Scope, TableRefusal, TableValue, TableVariable, Target, by_identifier,
};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::programs::ProgramParameters;
use crate::sinumerik::program::geometry;
use crate::sinumerik::program::main_run::MAIN_RUN_VARIABLES;
use crate::sinumerik::program::state::{ChannelProgram, ProgramState, Run};
use crate::sinumerik::single_axis::state::SingleAxes;
use crate::sinumerik::spindle::state::Spindle;
use crate::units::{AxisNumber, AxisSet, ChannelNumber, PerAxis, Position};
use crate::variables::RParameters;

/// The channel, as the language sees it.
pub(in crate::sinumerik) struct Channel<'a> {
    pub channel: ChannelNumber,
    pub parameters: &'a ProgramParameters,
    pub axes: &'a PerAxis<Axis>,
    pub owners: &'a Owners,
    pub single: &'a SingleAxes,
    /// The synchronous axes of closed groupings.
    pub coupled: AxisSet,
    pub all: &'a Parameters,
    pub spindles: &'a PerAxis<Option<Box<Spindle>>>,
    pub r_parameters: &'a mut RParameters,
    pub library: &'a Library,
    pub stored: &'a MachineData,
    /// Data that the program has written, to be stored after the stage.
    pub written: &'a mut Vec<(Target, control::Value)>,
    /// Elements of compensation tables that the program has written, likewise.
    pub tables: &'a mut Vec<(Element, TableValue)>,
    pub program: &'a mut ChannelProgram,
    /// The skip levels in effect, a bit each.
    pub skips: u16,
    /// DB21.DBX384.0.
    pub restarts: bool,
    /// Seconds since power on, and when the block that runs began.
    pub now: f64,
    pub block_begun: f64,
    /// What holds after the last prepared block: G functions and the path feed.
    pub modal: Modal,
    pub feed: Option<f64>,
    /// The programmable offsets there.
    pub offset: Vec<(AxisIndex, f64)>,
    /// $P_SEARCHL.
    pub search_level: u8,
    /// R parameters that were written, with their values before.
    pub r_written: Vec<(u16, f64)>,
    /// What prepared blocks have given to spindles.
    pub prepared_spindles: Vec<(u16, f64, i32)>,
    pub end: [f64; crate::motion::path::PATH_AXES],
    pub is_executed: bool,
    pub is_at_rest: bool,
    /// Lengths of system variables are in inches.
    pub is_inch: bool,
}

impl<'a> Channel<'a> {
    /// Where the prepared blocks end.
    pub(in crate::sinumerik) fn take_run(&mut self, run: &Run) {
        self.end = run.end;
        self.prepared_spindles.clone_from(&run.prepared_spindles);
        (self.is_executed, self.is_at_rest) = (run.is_executed(), run.is_at_rest());
        (self.modal, self.feed) = (run.interpreter.modal(), run.interpreter.feed());
        self.is_inch = geometry::is_inch(self.modal, self.all.is_inch);
        self.offset.clear();
        self.offset.extend_from_slice(run.interpreter.offset());
    }

    /// The settable and the programmable offset of an axis, with the G functions and the programmable offsets that hold.
    pub(super) fn offset(&self, axis: AxisNumber, modal: Modal, programmable: &[(AxisIndex, f64)]) -> Position {
        let programmable = geometry::offset_of(programmable, &self.parameters.axes, axis);
        self.program.active_offset(modal, axis) + programmable
    }

    pub(super) fn axis(&self, value: Option<&Value>) -> Result<AxisNumber, VariableRefusal> {
        match value {
            Some(Value::Axis(axis)) => {
                self.parameters.axes.machine_axes.get(usize::from(axis.0)).copied().ok_or(VariableRefusal::Axis)
            }
            _ => Err(VariableRefusal::Axis),
        }
    }

    /// `$MA_NAME[0,X]`, `$MC_NAME[1]`, `$MN_NAME`, `$SA_…`, `$SC_…`, `$SN_…`.
    fn datum(&self, variable: &SystemVariable<'_>) -> Option<Result<Target, VariableRefusal>> {
        let datum = by_identifier(variable.name)?;
        let (mut index, mut axis) = (Some(0), None);
        for value in variable.indices {
            match value.number() {
                Some(_) => index = whole_index(Some(value), 255),
                None => axis = Some(self.axis(Some(value))),
            }
        }
        let owner = match datum.scope {
            Scope::General | Scope::Setting => Owner::Nck,
            Scope::Channel | Scope::ChannelSetting => Owner::Channel(self.channel),
            Scope::Axis | Scope::AxisSetting => match axis {
                Some(Ok(axis)) => Owner::Axis(axis),
                Some(Err(refusal)) => return Some(Err(refusal)),
                None => return Some(Err(VariableRefusal::Axis)),
            },
        };
        let target = index.and_then(|index| Target::new(datum.number, owner, index).ok());
        Some(target.ok_or(VariableRefusal::FirstIndex))
    }

    /// `$AA_ENC_COMP[0,5,X]`, `$AN_CEC_STEP[0]`: an element of a compensation table.
    fn table(&self, variable: &SystemVariable<'_>) -> Option<Result<Element, VariableRefusal>> {
        let table = TableVariable::named(variable.name)?;
        let (mut numbers, mut axis) = (Vec::new(), None);
        for value in variable.indices {
            match value.number() {
                Some(number) => numbers.push(number),
                None => match self.axis(Some(value)) {
                    Ok(found) => axis = Some(found),
                    Err(refusal) => return Some(Err(refusal)),
                },
            }
        }
        Some(table.element(&numbers, axis).ok_or(VariableRefusal::FirstIndex))
    }

    /// The number that an element has, or gets after the stage.
    fn table_number(&self, element: Element) -> Result<Value, VariableRefusal> {
        let written = self.tables.iter().rev().find(|(other, _)| *other == element);
        let number = match written {
            Some((_, TableValue::Number(number))) => Some(*number),
            Some((_, TableValue::Axis(_))) => None,
            None => self.stored.table_number(element),
        };
        number.map(Value::Real).ok_or(VariableRefusal::SecondIndex)
    }

    fn write_table(&mut self, element: Element, value: &Value) -> Result<(), VariableRefusal> {
        let value = match (value.number(), value) {
            (Some(number), _) => TableValue::Number(number),
            (None, found) => TableValue::Axis(self.axis(Some(found)).map_err(|_| VariableRefusal::WrongType)?),
        };
        self.stored.may_write_table(element, value).map_err(|refusal| match refusal {
            TableRefusal::Index(_) => VariableRefusal::SecondIndex,
            TableRefusal::Value(_) => VariableRefusal::Invalid,
            TableRefusal::Active(..) => VariableRefusal::WriteProtected,
        })?;
        self.tables.push((element, value));
        Ok(())
    }

    /// The stored value, or the one that the program has just written.
    fn now(&self, target: &Target) -> Option<control::Value> {
        let written = self.written.iter().rev().find(|(other, _)| other == target);
        written.map(|(_, value)| value.clone()).or_else(|| self.stored.get(target))
    }

    /// The variables of the program and of the channel. `None` for any other name.
    fn program_value(&self, variable: &SystemVariable<'_>) -> Option<Result<Value, VariableRefusal>> {
        let program = &*self.program;
        Some(Ok(match variable.name {
            "$P_MSNUM" => Value::Int(self.parameters.master_spindle.into()),
            "$P_NUM_SPINDLES" => Value::Int(i32::try_from(self.parameters.spindles.len()).unwrap_or(0)),
            "$P_GG" => {
                let group = whole_index(variable.indices.first(), 65).filter(|group| *group > 0);
                return Some(
                    group.map(|group| Value::Int(self.modal.index(group).into())).ok_or(VariableRefusal::FirstIndex),
                );
            }
            "$P_F" => Value::Real(self.feed.unwrap_or(0.0)),
            "$AC_PROG" => Value::Int(match program.state {
                ProgramState::Aborted => 0,
                ProgramState::Stopped => 1,
                ProgramState::Running => 2,
                ProgramState::Waiting => 3,
                ProgramState::Interrupted => 4,
            }),
            "$AC_STAT" => Value::Int(match program.state {
                ProgramState::Aborted => 0,
                ProgramState::Stopped | ProgramState::Interrupted => 1,
                ProgramState::Running | ProgramState::Waiting => 2,
            }),
            "$AC_TIME" => Value::Real(self.now - self.block_begun),
            "$AC_TIMER" => {
                return Some(
                    main_run_index(variable).map(|index| Value::Real(program.main_run.timer(index, self.now))),
                );
            }
            "$AC_MARKER" => {
                return Some(main_run_index(variable).map(|index| Value::Int(program.main_run.marker(index))));
            }
            "$P_ISTEST" => Value::Bool(program.test.is_active),
            "$P_SEARCH" => Value::Bool(self.search_level > 0),
            "$P_SEARCHL" => Value::Int(self.search_level.into()),
            _ => return None,
        }))
    }

    /// The value of a machine datum.
    fn stored_value(&self, target: &Target) -> Result<Value, VariableRefusal> {
        match self.now(target) {
            Some(control::Value::Boolean(value)) => Ok(Value::Bool(value)),
            Some(control::Value::Integer(value)) => {
                i32::try_from(value).map(Value::Int).or(Ok(Value::Real(value as f64)))
            }
            Some(control::Value::Real(value)) => Ok(Value::Real(value)),
            Some(control::Value::Text(text)) => Ok(Value::Text(text)),
            None => Err(VariableRefusal::ReadProtected),
        }
    }
}

impl Environment for Channel<'_> {
    fn dialect(&self) -> &'static Dialect {
        &SINUMERIK
    }

    fn axes(&self) -> Arc<AxisNames> {
        Arc::clone(&self.parameters.axes.names)
    }

    fn r_parameters(&self) -> u32 {
        self.parameters.r_parameters
    }

    fn r_parameter(&self, index: u32) -> f64 {
        u16::try_from(index).ok().and_then(|index| self.r_parameters.get(self.channel, index)).unwrap_or(0.0)
    }

    fn set_r_parameter(&mut self, index: u32, value: f64) {
        if let Ok(index) = u16::try_from(index) {
            let before = self.r_parameters.get(self.channel, index).unwrap_or(0.0);
            self.r_written.push((index, before));
            self.r_parameters.set(self.channel, index, value);
        }
    }

    fn system(&self, variable: &SystemVariable<'_>) -> Result<Value, VariableRefusal> {
        if let Some(found) = self.axis_value(variable).or_else(|| self.program_value(variable)) {
            return found;
        }
        if let Some(element) = self.table(variable) {
            return self.table_number(element?);
        }
        match self.datum(variable) {
            Some(target) => self.stored_value(&target?),
            None if is_of_the_control(variable.name) => Err(VariableRefusal::NotModelled),
            None => Err(VariableRefusal::Unknown),
        }
    }

    fn set_system(&mut self, variable: &SystemVariable<'_>, value: &Value) -> Result<(), VariableRefusal> {
        if variable.name == "$P_UIFR" && variable.indices.len() == 1 {
            return self.set_settable_frame(variable, value);
        }
        if variable.name == "$P_UIFR" {
            let (index, axis) = self.settable_offset(variable)?;
            let value = value.number().ok_or(VariableRefusal::WrongType)?;
            self.program.set_settable_offset(index, axis, Position::from_user(value * self.unit(axis)));
            return Ok(());
        }
        if let Some(element) = self.table(variable) {
            return self.write_table(element?, value);
        }
        if matches!(variable.name, "$AC_TIMER" | "$AC_MARKER") {
            let index = main_run_index(variable)?;
            let number = value.number().ok_or(VariableRefusal::WrongType)?;
            if variable.name == "$AC_TIMER" {
                self.program.main_run.set_timer(index, number, self.now);
            } else {
                #[expect(clippy::cast_possible_truncation, reason = "the cast saturates")]
                self.program.main_run.set_marker(index, number.round() as i32);
            }
            return Ok(());
        }
        let Some(target) = self.datum(variable) else {
            let known = is_of_the_control(variable.name);
            let is_readable = self.system(variable).is_ok();
            return Err(match (is_readable, known) {
                (true, _) => VariableRefusal::WriteProtected,
                (false, true) => VariableRefusal::NotModelled,
                (false, false) => VariableRefusal::Unknown,
            });
        };
        let target = target?;
        let value = match value {
            Value::Int(value) => control::Value::Integer((*value).into()),
            Value::Real(value) => control::Value::Real(*value),
            Value::Bool(value) => control::Value::Boolean(*value),
            Value::Char(value) => control::Value::Integer((*value).into()),
            Value::Text(text) => control::Value::Text(text.clone()),
            Value::Axis(_) | Value::Frame(_) => return Err(VariableRefusal::WrongType),
        };
        let (datum, number) = (target.datum(), value.number());
        if datum.read_only {
            return Err(VariableRefusal::WriteProtected);
        }
        match number {
            Some(number) if datum.range.minimum.is_some_and(|minimum| number < minimum) => {
                return Err(VariableRefusal::Below);
            }
            Some(number) if datum.range.maximum.is_some_and(|maximum| number > maximum) => {
                return Err(VariableRefusal::Above);
            }
            Some(_) | None => {}
        }
        if self.stored.check(&target, &value).is_err() {
            return Err(VariableRefusal::Invalid);
        }
        self.written.push((target, value));
        Ok(())
    }

    fn is_executed(&self) -> bool {
        self.is_executed
    }

    fn is_at_rest(&self) -> bool {
        self.is_at_rest
    }

    fn is_skipped(&self, level: u8) -> bool {
        self.skips >> level & 1 == 1
    }

    fn is_restarting(&self) -> bool {
        self.restarts
    }

    fn replacing_program(&self, m: f64) -> Option<String> {
        let rows = &self.parameters.replaced_functions;
        rows.iter().find(|(number, _)| (f64::from(*number) - m).abs() < 0.5).map(|(_, name)| name.clone())
    }

    fn find_program(&self, request: &Request<'_>) -> Option<Arc<Program>> {
        self.library.find(request)
    }

    fn program(&self, path: &str) -> Option<Arc<Program>> {
        self.library.program(path)
    }
}

/// The index of `$AC_TIMER` and `$AC_MARKER`.
fn main_run_index(variable: &SystemVariable<'_>) -> Result<u8, VariableRefusal> {
    whole_index(variable.indices.first(), MAIN_RUN_VARIABLES).ok_or(VariableRefusal::FirstIndex)
}

/// A whole number from 0 to below a limit.
pub(super) fn whole_index(value: Option<&Value>, limit: u8) -> Option<u8> {
    let number = value.and_then(Value::number)?;
    let is_whole = number.fract() == 0.0 && (0.0..f64::from(limit)).contains(&number);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "used only if it fits")]
    let whole = number as u8;
    is_whole.then_some(whole)
}

/// Whether the control has system variables that begin like this. A machine or setting datum that the catalogue does not know has no name
/// here (12550).
fn is_of_the_control(name: &str) -> bool {
    let groups = ["$A", "$V", "$P_", "$T", "$R"];
    groups.iter().any(|group| name.starts_with(group))
}
