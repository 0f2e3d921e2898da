//! PLC programs by name, for `plc = "…"` in a scenario and `--plc` on the command line.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::image::{Memory, Names};
use crate::source::{Problem, did_you_mean};
use crate::units::Time;

use super::process::PlcProcess;
use super::{
    PlcProgram, enable_all, gantry_start, gear_change, limit_edge_marker, machine_control_panel, position_axis,
    shared_reference_cam, tool_change,
};

type Constructor = Arc<dyn Fn(&Names) -> Result<Box<dyn PlcProgram>, Problem> + Send + Sync>;

type Starter = Arc<dyn Fn(&PlcProcess, &Memory, &Names, Time) -> Result<Box<dyn PlcProgram>, Problem> + Send + Sync>;

/// PLC programs by name: the built-in programs, and those that a user adds with [`Programs::with`]. Also the way to run a program in
/// another process, if there is one.
#[derive(Clone)]
pub struct Programs {
    named: BTreeMap<String, Constructor>,
    processes: Option<Starter>,
}

impl Default for Programs {
    fn default() -> Self {
        Self::ready()
    }
}

impl Programs {
    /// The built-in programs: `enable_all`, `gantry_start`, `gear_change`, `limit_edge_marker`, `machine_control_panel`, `position_axis`,
    /// `shared_reference_cam`, `tool_change`.
    #[must_use]
    pub fn ready() -> Self {
        Self { named: BTreeMap::new(), processes: None }
            .with("enable_all", |_| Ok(enable_all().boxed()))
            .with("gantry_start", |_| Ok(gantry_start().boxed()))
            .with("gear_change", |_| Ok(gear_change().boxed()))
            .with("limit_edge_marker", |_| Ok(limit_edge_marker().boxed()))
            .with("machine_control_panel", |_| Ok(machine_control_panel().boxed()))
            .with("position_axis", |_| Ok(position_axis().boxed()))
            .with("shared_reference_cam", |_| Ok(shared_reference_cam().boxed()))
            .with("tool_change", |_| Ok(tool_change().boxed()))
    }

    /// Adds a program under a name and replaces an existing one. The constructor can reject a machine by its names.
    #[must_use]
    pub fn with(
        mut self,
        name: impl Into<String>,
        constructor: impl Fn(&Names) -> Result<Box<dyn PlcProgram>, Problem> + Send + Sync + 'static,
    ) -> Self {
        self.named.insert(name.into(), Arc::new(constructor));
        self
    }

    /// Sets how a program in another process is run: from its command, the memory and the names of the machine, and its cycle time. See
    /// `live::with_processes`.
    #[must_use]
    pub fn with_processes(
        mut self,
        starter: impl Fn(&PlcProcess, &Memory, &Names, Time) -> Result<Box<dyn PlcProgram>, Problem> + Send + Sync + 'static,
    ) -> Self {
        self.processes = Some(Arc::new(starter));
        self
    }

    /// A program in another process, for a machine. The process starts before the first step: [`PlcProgram::begin`].
    ///
    /// # Errors
    /// The command cannot be used, or these programs cannot run processes.
    pub fn process(
        &self,
        process: &PlcProcess,
        memory: &Memory,
        names: &Names,
        cycle: Time,
    ) -> Result<Box<dyn PlcProgram>, Problem> {
        let Some(starter) = &self.processes else {
            return Err(Problem::new(
                "expected a PLC program by name, found one in another process, which cannot be run here",
                "in Rust, pass `opennck::live::with_processes(programs)` (feature `mapped`); the program `opennck` does so",
            ));
        };
        starter(process, memory, names, cycle)
    }

    /// Whether a name is the folder of a STEP 7 program: it has a `/`.
    #[must_use]
    pub fn is_folder(name: &str) -> bool {
        name.contains('/')
    }

    /// The names, in alphabetical order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.named.keys().map(String::as_str)
    }

    /// A new program with this name for a machine.
    ///
    /// # Errors
    /// The program does not exist, or it cannot run on this machine.
    pub fn program(&self, name: &str, machine: &Names) -> Result<Box<dyn PlcProgram>, Problem> {
        let Some(constructor) = self.named.get(name) else {
            let known = self.names().collect::<Vec<_>>().join("`, `");
            let cure = did_you_mean(
                name,
                self.names(),
                "register your own program under this name; the folder of a STEP 7 program has a `/`",
            );
            return Err(Problem::new(format!("expected one of the PLC programs `{known}`, found `{name}`"), cure));
        };
        constructor(machine)
    }
}
