//! Scenario files: their cases, and the outcome of a case with its trace.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Mutex;

use opennck::golden::{self, Outcome as Compared, Update};
use opennck::scenario::{Failure, Finished};
use pyo3::prelude::*;

use crate::error::unusable;
use crate::plc::{Raised, locked, programs};

/// The scenario files below the paths.
#[pyfunction]
pub(crate) fn scenario_files(paths: Vec<PathBuf>) -> PyResult<Vec<PathBuf>> {
    golden::scenario_files(&paths).map_err(unusable)
}

/// The cases of a scenario file: one for each combination of its matrix and each of its profiles.
#[pyfunction]
pub(crate) fn cases(file: PathBuf) -> PyResult<Vec<Case>> {
    let cases = golden::cases(&file).map_err(unusable)?;
    Ok(cases.into_iter().map(Case).collect())
}

/// One scenario under one profile.
#[pyclass(frozen, module = "opennck._opennck")]
pub(crate) struct Case(golden::Case);

type Functions = Option<BTreeMap<String, Py<PyAny>>>;

#[pymethods]
impl Case {
    /// Its file, the values of its matrix, and its profile if there are several.
    #[getter]
    fn name(&self) -> String {
        self.0.name()
    }

    /// The values of its matrix and its profile; empty if the file has one case.
    #[getter]
    fn variant(&self) -> String {
        let scenario = &self.0.scenario;
        let profile = (scenario.profiles.len() > 1).then(|| self.0.profile.name().to_owned());
        let parts = scenario.variant.as_ref().map(ToString::to_string).into_iter().chain(profile);
        parts.collect::<Vec<_>>().join(", ")
    }

    #[getter]
    fn title(&self) -> &str {
        &self.0.scenario.title
    }

    /// The IDs of the rules that it shows.
    #[getter]
    fn covers(&self) -> Vec<String> {
        self.0.scenario.covers.clone()
    }

    /// Its golden file.
    #[getter]
    fn snap(&self) -> PathBuf {
        self.0.snap.clone()
    }

    /// Runs it without its golden file.
    fn run(&self, py: Python<'_>, functions: Functions) -> PyResult<Outcome> {
        let raised = Raised::default();
        let programs = programs(functions.unwrap_or_default(), &raised);
        let finished = py.detach(|| Ok(self.0.scenario.prepare(self.0.profile, &programs)?.run()));
        if let Some(error) = locked(&raised).take() {
            return Err(error);
        }
        let finished = finished.map_err(unusable)?;
        let (verdict, message) = match &finished.failure {
            Some(Failure::Unusable(problem)) => return Err(unusable(problem.clone())),
            Some(failure @ Failure::Missed(_)) => ("failed", failure.to_string()),
            None => ("passed", String::new()),
        };
        Ok(Outcome::of(verdict, message, Some(finished)))
    }

    /// Runs it and compares its trace with its golden file.
    fn test(&self, py: Python<'_>, accept: bool, check_causes: bool, functions: Functions) -> PyResult<Outcome> {
        let raised = Raised::default();
        let programs = programs(functions.unwrap_or_default(), &raised);
        let update = if accept { Update::Accept } else { Update::No };
        let (compared, finished) = py.detach(|| {
            let case = golden::Case { check_causes, ..self.0.clone() };
            case.run_finished(&programs, update)
        });
        if let Some(error) = locked(&raised).take() {
            return Err(error);
        }
        let verdict = match &compared {
            Compared::Held => "passed",
            Compared::Accepted => "accepted",
            Compared::Failed(_) => "failed",
            Compared::Untrue(_) => "untrue",
            Compared::Differs(_) => "differs",
            Compared::Missing(_) => "missing",
            Compared::Unusable(_) => "unusable",
        };
        let message = if compared.is_good() { String::new() } else { compared.to_string() };
        Ok(Outcome::of(verdict, message, finished.map(|finished| *finished)))
    }
}

/// A step with its file, line, note and state.
type Step = (String, u32, Option<String>, &'static str);

/// The outcome of a case, with its trace.
#[pyclass(frozen, module = "opennck._opennck")]
pub(crate) struct Outcome {
    #[pyo3(get)]
    verdict: &'static str,
    #[pyo3(get)]
    message: String,
    /// `None` if it could not run.
    finished: Option<Mutex<Finished>>,
}

impl Outcome {
    fn of(verdict: &'static str, message: String, finished: Option<Finished>) -> Self {
        Self { verdict, message, finished: finished.map(Mutex::new) }
    }

    fn show<T: Send + Default>(&self, py: Python<'_>, show: impl FnOnce(&Finished) -> T + Send) -> T {
        let finished = self.finished.as_ref();
        py.detach(|| finished.map(|finished| show(&locked(finished))).unwrap_or_default())
    }
}

#[pymethods]
impl Outcome {
    fn steps(&self, py: Python<'_>) -> Vec<Step> {
        self.show(py, |finished| {
            let (reached, failed) = (finished.reached(), finished.failure.is_some());
            let state = |index: usize| match index.cmp(&reached) {
                std::cmp::Ordering::Less => "done",
                std::cmp::Ordering::Equal if failed => "failed",
                std::cmp::Ordering::Equal | std::cmp::Ordering::Greater => "not reached",
            };
            let stages = finished.stages().into_iter().enumerate();
            stages
                .map(|(index, stage)| (stage.place.file.to_string(), stage.place.line, stage.note, state(index)))
                .collect()
        })
    }

    /// What its rules have to say although they are not broken, and the findings about its machine.
    fn remarks(&self, py: Python<'_>) -> Vec<String> {
        self.show(py, |finished| {
            let warnings = finished.session().machine().warnings();
            warnings.iter().cloned().chain(finished.remarks()).collect()
        })
    }

    fn time(&self, py: Python<'_>) -> f64 {
        self.show(py, |finished| finished.session().time().seconds())
    }

    fn value(&self, py: Python<'_>, expression: &str) -> PyResult<f64> {
        let value = self.show(py, |finished| Some(finished.session().value(expression)));
        value.transpose().map_err(crate::error::failed).map(Option::unwrap_or_default)
    }

    fn json_lines(&self, py: Python<'_>) -> String {
        self.show(py, Finished::json_lines)
    }

    fn text(&self, py: Python<'_>, causes: bool) -> String {
        self.show(py, |finished| if causes { finished.text() } else { finished.golden() })
    }

    fn vcd(&self, py: Python<'_>) -> String {
        self.show(py, Finished::vcd)
    }

    fn svg(&self, py: Python<'_>) -> String {
        self.show(py, Finished::svg)
    }
}
