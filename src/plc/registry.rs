//! PLC programs by name, for `plc = "…"` in a scenario and `--plc` on the command line.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::image::Names;
use crate::source::{Problem, did_you_mean};

use super::{PlcProgram, enable_all, gantry_start, limit_edge_marker, machine_control_panel, shared_reference_cam};

type Constructor = Arc<dyn Fn(&Names) -> Result<Box<dyn PlcProgram>, Problem> + Send + Sync>;

/// PLC programs by name: the built-in programs, and those that a user adds with [`Programs::with`].
#[derive(Clone)]
pub struct Programs(BTreeMap<String, Constructor>);

impl Default for Programs {
    fn default() -> Self {
        Self::ready()
    }
}

impl Programs {
    /// The built-in programs: `enable_all`, `gantry_start`, `limit_edge_marker`, `machine_control_panel`, `shared_reference_cam`.
    #[must_use]
    pub fn ready() -> Self {
        Self(BTreeMap::new())
            .with("enable_all", |_| Ok(enable_all().boxed()))
            .with("gantry_start", |_| Ok(gantry_start().boxed()))
            .with("limit_edge_marker", |_| Ok(limit_edge_marker().boxed()))
            .with("machine_control_panel", |_| Ok(machine_control_panel().boxed()))
            .with("shared_reference_cam", |_| Ok(shared_reference_cam().boxed()))
    }

    /// Adds a program under a name and replaces an existing one. The constructor can reject a machine by its names.
    #[must_use]
    pub fn with(
        mut self,
        name: impl Into<String>,
        constructor: impl Fn(&Names) -> Result<Box<dyn PlcProgram>, Problem> + Send + Sync + 'static,
    ) -> Self {
        self.0.insert(name.into(), Arc::new(constructor));
        self
    }

    /// The names, in alphabetical order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }

    /// A new program with this name for a machine.
    ///
    /// # Errors
    /// The program does not exist, or it cannot run on this machine.
    pub fn program(&self, name: &str, machine: &Names) -> Result<Box<dyn PlcProgram>, Problem> {
        let Some(constructor) = self.0.get(name) else {
            let known = self.names().collect::<Vec<_>>().join("`, `");
            let cure = did_you_mean(name, self.names(), "register your own program under this name");
            return Err(Problem::new(format!("expected one of the PLC programs `{known}`, found `{name}`"), cure));
        };
        constructor(machine)
    }
}
