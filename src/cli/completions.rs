//! What an installation has besides the program, made from its arguments: `opennck completions`, the script with which a shell completes
//! commands, options and their values, and `opennck man`, the manual pages.

use std::path::Path;

use clap::Command;
use clap_complete::{Shell, generate};

use super::output::Output;
use crate::source::Place;

pub(super) fn completions(shell: Shell, program: &mut Command, output: &mut Output) -> u8 {
    let mut script = Vec::new();
    generate(shell, program, "opennck", &mut script);
    output.print(&String::from_utf8_lossy(&script));
    0
}

/// Writes a page for the program and for each command.
pub(super) fn man(folder: &Path, program: Command, output: &mut Output) -> u8 {
    match clap_mangen::generate_to(program, folder) {
        Ok(()) => 0,
        Err(error) => {
            let place = Place::file(&folder.display().to_string());
            output.error(place.problem(format!("cannot be written: {error}"), "name a folder that exists"));
            2
        }
    }
}
