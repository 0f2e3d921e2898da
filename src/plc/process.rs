//! The description of a PLC program in another process; `live` runs it.

use std::path::PathBuf;

use crate::units::Time;

/// A PLC program in another process, which maps the interface as a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlcProcess {
    /// The program and its arguments, separated by spaces; quotes keep a word together. `{image}` stands for the mapped file.
    pub command: String,
    /// The folder in which it runs.
    pub directory: PathBuf,
    /// How long it may take until it opens the file, and for an answer, by the clock of the computer.
    pub time_out: Time,
    /// Whether its output is printed on standard error; otherwise its last lines are part of a failure.
    pub is_shown: bool,
}

impl PlcProcess {
    /// The time-out unless a scenario says otherwise: a computer that runs many tests is slow.
    pub const TIME_OUT: Time = Time::from_millis(10_000);

    /// The existing files that the command names, such as a script; seen from its folder.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        let words = self.command.split_whitespace().map(|word| word.trim_matches(['"', '\'']));
        words.map(|word| self.directory.join(word)).filter(|path| path.is_file()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_names_the_files_that_exist_in_its_folder() {
        let folder = std::env::temp_dir().join(format!("opennck-process-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("plc.py"), "").unwrap();
        let command = "python3 'plc.py' {image} other.py".to_owned();
        let process =
            PlcProcess { command, directory: folder.clone(), time_out: PlcProcess::TIME_OUT, is_shown: false };
        assert_eq!(process.files(), [folder.join("plc.py")]);
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
