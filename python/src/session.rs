//! A session: a machine with its growing trace. Its verbs come as JSON, in the notation of scenarios.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Mutex, TryLockError};

use opennck::image::Preset;
use opennck::machine::{Machine, OpenOptions};
use opennck::scenario::{self, Failure, profile_named};
use opennck::source::{Node, Place, Problem, Value};
use opennck::trace::Head;
use opennck::variables::Describe;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::error::{STEP, failed, unusable};
use crate::plc::{PythonProgram, Raised, locked, programs};

/// A machine with its growing trace.
#[pyclass(frozen, module = "opennck._opennck")]
pub(crate) struct Session {
    session: Mutex<scenario::Session>,
    /// What its PLC program raised.
    raised: Raised,
    /// The machine as it was named.
    title: String,
    profile: Option<String>,
}

impl Session {
    /// Calls the session while other threads of Python run.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        act: impl FnOnce(&mut scenario::Session) -> Result<T, Failure> + Send,
    ) -> PyResult<T> {
        let done = py.detach(|| match self.session.try_lock() {
            Ok(mut session) => Some(act(&mut session)),
            Err(TryLockError::Poisoned(session)) => Some(act(&mut session.into_inner())),
            Err(TryLockError::WouldBlock) => None,
        });
        let Some(done) = done else {
            let what = "the session is in use, by another thread or by the call in which its PLC program runs";
            return Err(unusable(Problem::new(
                what,
                "wait for the other call; a PLC program uses the `io` it is given",
            )));
        };
        // What the PLC program raised is the reason for everything else.
        if let Some(error) = locked(&self.raised).take() {
            return Err(error);
        }
        done.map_err(failed)
    }

    fn show<T: Send>(&self, py: Python<'_>, show: impl FnOnce(&scenario::Session) -> T + Send) -> PyResult<T> {
        self.with(py, |session| Ok(show(session)))
    }
}

#[pymethods]
impl Session {
    #[new]
    #[pyo3(signature = (machine, plc=None, profile=None, plc_image=None))]
    fn new(
        machine: PathBuf,
        plc: Option<Bound<'_, PyAny>>,
        profile: Option<String>,
        plc_image: Option<PathBuf>,
    ) -> PyResult<Self> {
        let raised = Raised::default();
        let preset = plc_image.map(|file| Preset::read(&file)).transpose().map_err(unusable)?;
        let selected = profile.as_deref().map(profile_named).transpose().map_err(unusable)?.unwrap_or_default();
        let options = OpenOptions { profile: selected, preset, ..OpenOptions::default() };
        let mut opened = Machine::open_with(&machine, options).map_err(unusable)?;
        let ready = programs(BTreeMap::new(), &raised);
        match plc {
            None => opened.load_own_program(&ready).map_err(unusable)?,
            Some(plc) => match plc.extract::<PathBuf>() {
                Ok(name) => {
                    let directories = [std::path::Path::new(""), &machine];
                    opened.load_named(&name.to_string_lossy(), &directories, &ready).map_err(unusable)?;
                }
                Err(_) => opened.load_program(Box::new(PythonProgram::new(plc.py(), &plc, &raised)?)),
            },
        }
        let session = Mutex::new(scenario::Session::new(opened));
        Ok(Self { session, raised, title: machine.display().to_string(), profile })
    }

    /// Executes a step, which is a JSON object.
    fn step(&self, py: Python<'_>, step: &str) -> PyResult<()> {
        let place = Place::file(STEP);
        let problem = |what: String| unusable(Problem::new(what, "write {\"set\": {\"X.traversing_key_plus\": 1}}"));
        let json = serde_json::from_str(step).map_err(|error| problem(format!("expected a step: {error}")))?;
        let node = Node::from_json(&json, &place).map_err(unusable)?;
        let Value::Table(table) = node.value else {
            return Err(problem("expected a step with one verb, found something else".to_owned()));
        };
        self.with(py, |session| session.step(table))
    }

    fn note(&self, py: Python<'_>, text: &str) -> PyResult<()> {
        self.with(py, |session| {
            session.note(text);
            Ok(())
        })
    }

    fn always(&self, py: Python<'_>, expression: &str) -> PyResult<()> {
        self.with(py, |session| session.always(expression))
    }

    fn never(&self, py: Python<'_>, expression: &str) -> PyResult<()> {
        self.with(py, |session| session.never(expression))
    }

    fn follows(&self, py: Python<'_>, name: &str, when: &str, then: &str, within: &str) -> PyResult<()> {
        self.with(py, |session| session.follows(name, when, then, within))
    }

    fn watch(&self, py: Python<'_>, entries: Vec<String>) -> PyResult<()> {
        let entries: Vec<&str> = entries.iter().map(String::as_str).collect();
        self.with(py, |session| session.watch(&entries))
    }

    fn value(&self, py: Python<'_>, expression: &str) -> PyResult<f64> {
        self.with(py, |session| session.value(expression))
    }

    fn time(&self, py: Python<'_>) -> PyResult<f64> {
        self.show(py, |session| session.time().seconds())
    }

    fn cycle(&self, py: Python<'_>) -> PyResult<u64> {
        self.show(py, |session| session.machine().cycle())
    }

    fn axes(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.show(py, |session| session.machine().names().axes.iter().filter_map(|(_, name)| name.clone()).collect())
    }

    fn channels(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.show(py, |session| {
            let machine = session.machine();
            let channels = machine.names().channels.iter().filter(|(channel, _)| machine.has_channel(*channel));
            channels.filter_map(|(_, name)| name.clone()).collect()
        })
    }

    /// The number or name of each pending alarm, with its text.
    fn alarms(&self, py: Python<'_>) -> PyResult<Vec<(String, String)>> {
        self.show(py, |session| {
            let machine = session.machine();
            let alarms = machine.variables().alarms.iter();
            alarms.map(|alarm| (machine.alarm_name(alarm.number), machine.alarm_text(alarm))).collect()
        })
    }

    fn warnings(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.show(py, |session| session.machine().warnings().to_vec())
    }

    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &self.show(py, scenario::Session::save)?))
    }

    fn restore(&self, py: Python<'_>, saved: &[u8]) -> PyResult<()> {
        self.with(py, |session| session.restore(saved))
    }

    fn fork(&self, py: Python<'_>) -> PyResult<Self> {
        let forked = self.with(py, |session| session.fork())?;
        let (raised, title, profile) = (Raised::clone(&self.raised), self.title.clone(), self.profile.clone());
        Ok(Self { session: Mutex::new(forked), raised, title, profile })
    }

    fn json_lines(&self, py: Python<'_>) -> PyResult<String> {
        self.show(py, scenario::Session::json_lines)
    }

    fn text(&self, py: Python<'_>, causes: bool) -> PyResult<String> {
        self.show(py, |session| if causes { session.text() } else { session.sequence() })
    }

    fn vcd(&self, py: Python<'_>) -> PyResult<String> {
        self.show(py, scenario::Session::vcd)
    }

    fn svg(&self, py: Python<'_>) -> PyResult<String> {
        let (title, profile) = (self.title.clone(), self.profile.clone());
        self.show(py, |session| {
            let cycle_time = session.machine().cycle_time();
            session.svg(&Head { machine: title.clone(), title, profile, case: None, cycle_time })
        })
    }
}
