//! The values of a channel in addition to signals.

use arrayvec::ArrayString;
use serde::{Deserialize, Serialize};

/// The name of an NC program with its ending, `PART.MPF`, at most 28 bytes.
pub type ProgramName = ArrayString<28>;

/// The name of a program from its path among the programs of a control, as much as fits.
#[must_use]
pub fn program_name(path: &str) -> ProgramName {
    let mut name = ProgramName::new();
    for letter in path.rsplit('/').next().unwrap_or_default().chars() {
        if name.try_push(letter).is_err() {
            break;
        }
    }
    name
}

/// The values of one channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ChannelValues {
    /// The block that runs or was the last to run: its N number, else its line; 0 without a program.
    pub block: u32,
    /// The program of this block; without one, the program that is selected.
    pub program: ProgramName,
    /// The active coupling groups: bit *n* for group *n*.
    pub coupling_groups: u8,
}

/// What operator panels show of the program of a channel in addition to its values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShownProgram<'a> {
    /// The path of the selected program among the programs of the control, without those of MDA.
    pub selected: Option<&'a str>,
    /// The path of the program whose block runs; without one, the selected program.
    pub active: Option<&'a str>,
    /// The line of this block, counted from one; 0 without a block.
    pub line: u32,
    /// The text of this block.
    pub block: &'a str,
    /// The text of MSG.
    pub message: &'a str,
    /// The velocity along the path in mm/min.
    pub velocity: f64,
}

/// The name of a program as a file of the NC: `/_N_MPF_DIR/_N_PART_MPF` for `_N_MPF_DIR/PART.MPF`.
#[must_use]
pub fn nc_file(path: &str) -> String {
    let (folder, name) = path.rsplit_once('/').unwrap_or(("_N_MPF_DIR", path));
    format!("/{folder}/_N_{}", name.replace('.', "_"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_of_a_program_is_the_end_of_its_path() {
        assert_eq!(&program_name("_N_MPF_DIR/PART.MPF"), "PART.MPF");
        assert_eq!(&program_name("PART.SPF"), "PART.SPF");
        assert_eq!(program_name(&"A".repeat(40)).len(), 28);
        assert_eq!(nc_file("_N_MPF_DIR/PART.MPF"), "/_N_MPF_DIR/_N_PART_MPF");
        assert_eq!(nc_file("_N_WKS_DIR/SHAFT.WPD/PART.MPF"), "/_N_WKS_DIR/SHAFT.WPD/_N_PART_MPF");
    }
}
