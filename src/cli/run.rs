//! `opennck run`: runs scenarios and prints their signal sequences with causes.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use super::output::Output;
use crate::plc::Programs;
use crate::scenario::{Failure, Finished, Prepared, Scenario};
use crate::source::{Problem, unreadable};

/// Reads all files before anything runs: one unusable file and nothing runs.
pub(super) fn run(files: &[PathBuf], trace: Option<&Path>, programs: &Programs, output: &mut Output) -> u8 {
    let mut ready = Vec::new();
    let mut usable = true;
    for file in files {
        match prepare(file, programs) {
            Ok(prepared) => ready.extend(prepared),
            Err(problem) => {
                output.error(problem);
                usable = false;
            }
        }
    }
    if !usable {
        return 2;
    }
    let trace = match trace.map(|path| open(path, ready.len())).transpose() {
        Ok(trace) => trace,
        Err(problem) => {
            output.error(problem);
            return 2;
        }
    };
    let mut code = 0;
    for (index, prepared) in ready.into_iter().enumerate() {
        if index > 0 {
            output.line("");
        }
        for warning in prepared.warnings() {
            output.warning(warning);
        }
        let finished = prepared.run();
        output.print(&finished.text());
        code = code.max(result(&finished, output));
        if let Some((path, file)) = &trace
            && let Err(error) = (&*file).write_all(finished.json_lines().as_bytes())
        {
            output.error(Problem::new(format!("{} cannot be written: {error}", path.display()), "check the disk"));
            code = 2;
        }
    }
    code
}

/// One scenario under each of its profiles.
fn prepare(file: &Path, programs: &Programs) -> Result<Vec<Prepared>, Problem> {
    let scenario = Scenario::read(file)?;
    scenario.profiles.iter().map(|profile| scenario.prepare(*profile, programs)).collect()
}

/// The file of the trace, opened before anything runs.
fn open(path: &Path, runs: usize) -> Result<(PathBuf, File), Problem> {
    if runs != 1 {
        return Err(Problem::new(
            format!("expected one scenario under one profile with --trace, found {runs} runs"),
            "run them one by one, each with its own file",
        ));
    }
    let file = File::create(path).map_err(|error| unreadable(path, &error))?;
    Ok((path.to_owned(), file))
}

/// Prints how a scenario ended, and gives the exit code for it.
pub(super) fn result(finished: &Finished, output: &mut Output) -> u8 {
    let session = finished.session();
    if session.trace().lost() > 0 {
        output.warning(format!("{} rows of the trace were lost", session.trace().lost()));
    }
    match &finished.failure {
        None => {
            output.line(format!("\nheld, after {} s", session.time()));
            0
        }
        Some(failure) => {
            output.line(format!("\nfailed, after {} s", session.time()));
            output.error(failure);
            match failure {
                Failure::Missed(_) => 1,
                Failure::Unusable(_) => 2,
            }
        }
    }
}
