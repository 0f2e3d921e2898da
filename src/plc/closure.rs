//! PLC programs written as Rust closures.

use std::sync::Arc;

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::image::{AsBytes, Layout, Sinumerik};
use crate::source::Problem;

use super::{PlcFault, PlcIo, PlcProgram};

type Code<S, L> = Arc<dyn Fn(&mut S, &mut PlcIo<'_, L>) -> Result<(), PlcFault> + Send + Sync>;

/// A closure and its state. Forks share the code; each fork has its own state.
pub struct ClosureProgram<S, L: Layout = Sinumerik> {
    name: String,
    initial: S,
    state: S,
    startup: Option<Code<S, L>>,
    scan: Code<S, L>,
}

/// Makes a program from a closure that runs once in each PLC cycle; `state` is its complete memory.
///
/// The state is a block of this module, a tuple of blocks, or a structure that derives `Clone` and the `Serialize` and `Deserialize` of
/// serde. Forks and saved machines include it.
pub fn program<S>(
    name: impl Into<String>,
    state: S,
    scan: impl Fn(&mut S, &mut PlcIo<'_>) + Send + Sync + 'static,
) -> ClosureProgram<S>
where
    S: Clone + Serialize + DeserializeOwned + Send + 'static,
{
    program_with_fault(name, state, move |state, io| {
        scan(state, io);
        Ok(())
    })
}

/// Like [`program`], for a closure that can stop the PLC.
pub fn program_with_fault<S>(
    name: impl Into<String>,
    state: S,
    scan: impl Fn(&mut S, &mut PlcIo<'_>) -> Result<(), PlcFault> + Send + Sync + 'static,
) -> ClosureProgram<S>
where
    S: Clone + Serialize + DeserializeOwned + Send + 'static,
{
    program_for(name, state, scan)
}

/// Like [`program_with_fault`], for a control with another layout: `program_for::<_, Own>("name", (), |(), io| …)`.
pub fn program_for<S, L: Layout>(
    name: impl Into<String>,
    state: S,
    scan: impl Fn(&mut S, &mut PlcIo<'_, L>) -> Result<(), PlcFault> + Send + Sync + 'static,
) -> ClosureProgram<S, L>
where
    S: Clone + Serialize + DeserializeOwned + Send + 'static,
{
    ClosureProgram { name: name.into(), initial: state.clone(), state, startup: None, scan: Arc::new(scan) }
}

impl<S, L: Layout> ClosureProgram<S, L>
where
    S: Clone + Serialize + DeserializeOwned + Send + 'static,
{
    /// The parts as structures of the control for which the program is written.
    fn io<'a>(name: &str, io: &'a mut PlcIo<'_, AsBytes>) -> Result<PlcIo<'a, L>, PlcFault> {
        let found = io.names.interface();
        io.typed().ok_or_else(|| {
            PlcFault::new(format!(
                "`{name}` is written for another interface than {found:?}, the interface of this machine"
            ))
        })
    }

    /// Sets a closure that runs after power on, before the first scan (OB100).
    #[must_use]
    pub fn on_startup(mut self, startup: impl Fn(&mut S, &mut PlcIo<'_, L>) + Send + Sync + 'static) -> Self {
        self.startup = Some(Arc::new(move |state, io| {
            startup(state, io);
            Ok(())
        }));
        self
    }

    /// The program as a trait object.
    #[must_use]
    pub fn boxed(self) -> Box<dyn PlcProgram> {
        Box::new(self)
    }
}

impl<S, L: Layout> PlcProgram for ClosureProgram<S, L>
where
    S: Clone + Serialize + DeserializeOwned + Send + 'static,
{
    fn name(&self) -> &str {
        &self.name
    }

    fn startup(&mut self, io: &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault> {
        match &self.startup {
            Some(startup) => startup(&mut self.state, &mut Self::io(&self.name, io)?),
            None => Ok(()),
        }
    }

    fn scan(&mut self, io: &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault> {
        (self.scan)(&mut self.state, &mut Self::io(&self.name, io)?)
    }

    fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(&self.state).expect("plain data can be serialized")
    }

    fn restore(&mut self, saved: &[u8]) -> Result<(), Problem> {
        let foreign = || {
            Problem::new(
                format!(
                    "expected the saved state of the PLC program `{}`, found {} bytes of another program",
                    self.name,
                    saved.len()
                ),
                "restore it with the program that saved it",
            )
        };
        let (state, rest) = postcard::take_from_bytes(saved).map_err(|_| foreign())?;
        if !rest.is_empty() {
            return Err(foreign());
        }
        self.state = state;
        Ok(())
    }

    fn fork(&self) -> Option<Box<dyn PlcProgram>> {
        Some(Box::new(Self {
            name: self.name.clone(),
            initial: self.initial.clone(),
            state: self.state.clone(),
            startup: self.startup.clone(),
            scan: Arc::clone(&self.scan),
        }))
    }

    fn reset(&mut self) {
        self.state = self.initial.clone();
    }
}
