//! The output files of a command. None of them is one of its inputs, a file of a kind that is always an input, or another output.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use crate::source::{Place, Problem, Replacement, target};

/// Kinds of files that this program reads and that no option here writes.
const INPUTS: [&str; 15] =
    ["toml", "snap", "tea", "ini", "mpf", "spf", "nc", "arc", "lis", "awl", "asc", "sdf", "seq", "py", "rs"];

/// The inputs of a command, and the outputs that are open so far.
#[derive(Debug, Default)]
pub(super) struct Files {
    inputs: Vec<PathBuf>,
    outputs: Vec<(&'static str, PathBuf)>,
}

impl Files {
    /// The files and folders that a command reads; in a folder, all files in it.
    pub(super) fn of(inputs: impl IntoIterator<Item = PathBuf>) -> Self {
        Self { inputs: inputs.into_iter().map(|input| target(&input)).collect(), outputs: Vec::new() }
    }

    /// Opens the output file of an option. The file keeps its old content until [`Replacement::finish`].
    pub(super) fn open(&mut self, option: &'static str, path: &Path) -> Result<Replacement, Problem> {
        self.check(option, path)?;
        Replacement::begin(path)
            .map_err(|problem| Problem { what: format!("{}, for {option}", problem.what), ..problem })
    }

    /// Opens an output file of a kind that is an input elsewhere: it must not exist, for it could be the work of a person.
    pub(super) fn open_new(option: &'static str, path: &Path) -> Result<Replacement, Problem> {
        if path.exists() {
            let what = format!("expected a new file for {option}, found one that exists");
            return Err(
                Place::file(&path.display().to_string()).problem(what, "delete it first, or choose another name")
            );
        }
        Replacement::begin(path)
            .map_err(|problem| Problem { what: format!("{}, for {option}", problem.what), ..problem })
    }

    /// Refuses to write an output over an input, which would destroy the input, and two outputs to one file.
    pub(super) fn check(&mut self, option: &'static str, path: &Path) -> Result<(), Problem> {
        let real = target(path);
        let refused =
            |what: String| Err(Place::file(&path.display().to_string()).problem(what, "choose another file name"));
        if let Some((other, _)) = self.outputs.iter().find(|(_, output)| *output == real) {
            return refused(format!("expected a separate file for {option}, found the file of {other}"));
        }
        let is_device = real.exists() && !real.is_file() && !real.is_dir();
        if !is_device {
            let is_in =
                |input: &&PathBuf| **input == real || (real.is_file() && real.parent() == Some(input.as_path()));
            if let Some(input) = self.inputs.iter().find(is_in) {
                let what = format!(
                    "expected a separate file for {option}, found a file that this command also reads or writes"
                );
                return refused(if *input == real { what } else { format!("{what}, in {}", input.display()) });
            }
            let kind = path.extension().and_then(OsStr::to_str).unwrap_or_default().to_ascii_lowercase();
            if INPUTS.contains(&kind.as_str()) {
                return refused(format!("expected an output file for {option}, found the name of an input: .{kind}"));
            }
        }
        self.outputs.push((option, real));
        Ok(())
    }
}
