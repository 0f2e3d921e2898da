//! A Python function as PLC program. It runs once in each PLC cycle with a view of the memory, in which it reads and writes signals by their
//! names. Its state is a dictionary of what JSON can hold, so that sessions with it can be saved and forked.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use opennck::image::{AsBytes, Format, Location, Memory, Names, OverrideCoding, Part, Parts, raw_value};
use opennck::plc::{PlcFault, PlcProgram, Programs};
use opennck::source::{Node, Place, Problem, Value};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{STEP, unusable};

/// What a function raised in its last scan: the calls of a session raise it again.
pub(crate) type Raised = Arc<Mutex<Option<PyErr>>>;

/// The parts that a program writes, without the data blocks.
const WRITTEN: [Part; 5] = [Part::ToNck, Part::Outputs, Part::Flags, Part::Timers, Part::Counters];
/// Those that it only reads.
const READ: [Part; 3] = [Part::FromNck, Part::Hmi, Part::Inputs];

pub(crate) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The memory as a PLC program sees it in one scan.
#[pyclass(frozen, module = "opennck")]
pub(crate) struct PlcIo {
    seen: Mutex<Seen>,
    /// The memory of the program.
    #[pyo3(get)]
    state: Py<PyDict>,
}

struct Seen {
    memory: Memory,
    names: Names,
    read: BTreeMap<String, Location>,
    written: BTreeMap<String, (Location, Option<Location>)>,
    time: f64,
    cycle_time: f64,
    cycle: u64,
    is_first: bool,
}

impl Seen {
    fn of(memory: Memory, names: Names) -> Self {
        let (read, written) = (BTreeMap::new(), BTreeMap::new());
        Self { memory, names, read, written, time: 0.0, cycle_time: 0.0, cycle: 0, is_first: true }
    }

    fn read(&mut self, name: &str) -> Result<Location, Problem> {
        if let Some(location) = self.read.get(name) {
            return Ok(*location);
        }
        let location = self.names.resolve(&self.memory, name)?;
        self.read.insert(name.to_owned(), location);
        Ok(location)
    }

    fn write(&mut self, name: &str, value: Value) -> Result<(), Problem> {
        let (location, enable) = match self.written.get(name) {
            Some(places) => *places,
            None => {
                let places = self.names.resolve_written(&self.memory, name)?;
                self.names.check_writer(places.0)?;
                if READ.contains(&places.0.part) {
                    let what = format!("expected a signal that the PLC writes, found {name}");
                    return Err(Problem::new(what, "inputs and signals of the HMI are written by a session: `set`"));
                }
                self.written.insert(name.to_owned(), places);
                places
            }
        };
        let node = Node { place: Place::file(STEP), value };
        let raw = raw_value(&node, location, OverrideCoding::of(self.names.interface()))
            .map_err(|problem| Problem { what: format!("{name}: {}", problem.what), ..problem })?;
        if let Some(enable) = enable {
            self.memory.write(enable, 1);
        }
        self.memory.write(location, raw);
        Ok(())
    }
}

/// A number, a truth value or a text with a base.
#[derive(FromPyObject)]
enum Written {
    Boolean(bool),
    Integer(i64),
    Float(f64),
    Text(String),
}

#[pymethods]
impl PlcIo {
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let mut seen = locked(&self.seen);
        let location = seen.read(name).map_err(unusable)?;
        let value = seen.memory.value(location);
        if location.format == Format::Real {
            return Ok(value.into_pyobject(py)?.into_any());
        }
        // Every whole number of 32 bits is exact in a float.
        #[expect(clippy::cast_possible_truncation, reason = "a whole number of at most 32 bits")]
        Ok((value as i64).into_pyobject(py)?.into_any())
    }

    fn __setitem__(&self, name: &str, value: Written) -> PyResult<()> {
        let value = match value {
            Written::Boolean(value) => Value::Boolean(value),
            Written::Integer(value) => Value::Integer(value),
            Written::Float(value) => Value::Float(value),
            Written::Text(value) => Value::Text(value),
        };
        locked(&self.seen).write(name, value).map_err(unusable)
    }

    /// The time of this scan in seconds.
    #[getter]
    fn time(&self) -> f64 {
        locked(&self.seen).time
    }

    /// The time since the last scan in seconds.
    #[getter]
    fn cycle_time(&self) -> f64 {
        locked(&self.seen).cycle_time
    }

    /// The NC cycle of this scan.
    #[getter]
    fn cycle(&self) -> u64 {
        locked(&self.seen).cycle
    }

    /// Whether this is the first scan after power on or a restart of the PLC.
    #[getter]
    fn first_scan(&self) -> bool {
        locked(&self.seen).is_first
    }

    /// The names of the machine axes.
    #[getter]
    fn axes(&self) -> Vec<String> {
        locked(&self.seen).names.axes.iter().filter_map(|(_, name)| name.clone()).collect()
    }
}

impl PlcIo {
    /// A view of a memory, with a state as JSON.
    fn new(py: Python<'_>, seen: Seen, state: &str) -> PyResult<Py<Self>> {
        let state = py.import("json")?.call_method1("loads", (state,))?.cast_into::<PyDict>()?.unbind();
        Py::new(py, Self { seen: Mutex::new(seen), state })
    }

    /// The state as JSON.
    fn state_text(&self, py: Python<'_>) -> PyResult<String> {
        let text = py.import("json").and_then(|json| json.call_method1("dumps", (&self.state,)));
        let text = text.map_err(|error| {
            let what = format!("the state of the PLC program cannot be saved: {error}");
            let other = unusable(Problem::new(what, "keep numbers, texts, lists and dictionaries in `io.state`"));
            other.set_cause(py, Some(error));
            other
        })?;
        text.extract()
    }

    /// Takes the memory before a scan.
    fn take(&self, io: &opennck::plc::PlcIo<'_, AsBytes>) {
        let mut seen = locked(&self.seen);
        for part in WRITTEN.into_iter().chain(READ) {
            copy(io.part(part), seen.memory.part_mut(part));
        }
        seen.memory.blocks.clone_from(io.blocks);
        seen.time = io.time.seconds();
        seen.cycle_time = io.cycle_time.seconds();
        seen.cycle = io.cycle;
    }

    /// Gives back what the function wrote.
    fn give(&self, io: &mut opennck::plc::PlcIo<'_, AsBytes>) {
        let mut seen = locked(&self.seen);
        let blocks = seen.memory.blocks.iter().map(|block| Part::Block(block.number));
        for part in WRITTEN.into_iter().chain(blocks) {
            // What is not changed must not count as written.
            let written = seen.memory.part(part);
            if io.part(part) != written {
                copy(written, io.part_mut(part));
            }
        }
        seen.is_first = false;
    }
}

/// The parts of one machine always have the same lengths.
fn copy(from: &[u8], to: &mut [u8]) {
    if from.len() == to.len() {
        to.copy_from_slice(from);
    }
}

/// A function that is the program of a machine.
pub(crate) struct PythonProgram {
    name: String,
    function: Py<PyAny>,
    io: Py<PlcIo>,
    raised: Raised,
}

impl PythonProgram {
    pub(crate) fn new(py: Python<'_>, function: &Bound<'_, PyAny>, raised: &Raised) -> PyResult<Self> {
        if !function.is_callable() {
            let what = format!("expected a PLC program, found {}", function.repr()?);
            return Err(unusable(Problem::new(what, "write its name, the folder of a STEP 7 program, or a function")));
        }
        let name = function.getattr("__name__").and_then(|name| name.extract());
        let names = Names::default();
        let io = PlcIo::new(py, Seen::of(Memory::of(names.interface()), names), "{}")?;
        Ok(Self {
            name: name.unwrap_or_else(|_| "python".to_owned()),
            function: function.clone().unbind(),
            io,
            raised: Arc::clone(raised),
        })
    }

    /// Keeps what was raised for the caller of the session.
    fn keep(&self, error: PyErr) {
        locked(&self.raised).get_or_insert(error);
    }
}

impl PlcProgram for PythonProgram {
    fn name(&self) -> &str {
        &self.name
    }

    fn install(&mut self, memory: &mut Memory, names: &Names) {
        *locked(&self.io.get().seen) = Seen::of(memory.clone(), names.clone());
    }

    fn startup(&mut self, _io: &mut opennck::plc::PlcIo<'_, AsBytes>) -> Result<(), PlcFault> {
        locked(&self.io.get().seen).is_first = true;
        Ok(())
    }

    fn scan(&mut self, io: &mut opennck::plc::PlcIo<'_, AsBytes>) -> Result<(), PlcFault> {
        let own = self.io.get();
        own.take(io);
        match Python::attach(|py| self.function.call1(py, (&self.io,)).map(drop)) {
            Ok(()) => {
                own.give(io);
                Ok(())
            }
            Err(error) => {
                let fault = PlcFault::new(error.to_string());
                self.keep(error);
                Err(fault)
            }
        }
    }

    fn save(&self) -> Vec<u8> {
        match Python::attach(|py| self.io.get().state_text(py)) {
            Ok(text) => text.into_bytes(),
            Err(error) => {
                self.keep(error);
                Vec::new()
            }
        }
    }

    fn restore(&mut self, saved: &[u8]) -> Result<(), Problem> {
        let restored = Python::attach(|py| {
            let state = py.import("json")?.call_method1("loads", (saved,))?.cast_into::<PyDict>()?;
            let own = self.io.get().state.bind(py);
            own.clear();
            own.update(state.as_mapping())
        });
        restored.map_err(|_| {
            let what = format!("expected the saved state of the PLC program `{}`, found other bytes", self.name);
            Problem::new(what, "restore it with the program that saved it")
        })
    }

    fn fork(&self) -> Option<Box<dyn PlcProgram>> {
        let copied = Python::attach(|py| {
            let state = self.io.get().state_text(py)?;
            let seen = locked(&self.io.get().seen);
            let copy = Seen { is_first: seen.is_first, ..Seen::of(seen.memory.clone(), seen.names.clone()) };
            let io = PlcIo::new(py, copy, &state)?;
            let (name, raised) = (self.name.clone(), Arc::clone(&self.raised));
            Ok(Self { name, function: self.function.clone_ref(py), io, raised })
        });
        match copied {
            Ok(program) => Some(Box::new(program)),
            Err(error) => {
                self.keep(error);
                None
            }
        }
    }

    fn reset(&mut self) {
        Python::attach(|py| self.io.get().state.bind(py).clear());
        locked(&self.io.get().seen).is_first = true;
    }
}

/// The ready programs, those in other processes, and functions under their names.
pub(crate) fn programs(functions: BTreeMap<String, Py<PyAny>>, raised: &Raised) -> Programs {
    let ready = opennck::live::with_processes(Programs::ready());
    functions.into_iter().fold(ready, |programs, (name, function)| {
        let raised = Arc::clone(raised);
        programs.with(name, move |_| {
            let program = Python::attach(|py| PythonProgram::new(py, function.bind(py), &raised));
            match program {
                Ok(program) => Ok(Box::new(program)),
                Err(error) => Err(Problem::new(error.to_string(), "")),
            }
        })
    })
}
