//! `opennck completions`: prints the script with which a shell completes commands, options and their values.

use clap::Command;
use clap_complete::{Shell, generate};

use super::output::Output;

pub(super) fn completions(shell: Shell, program: &mut Command, output: &mut Output) -> u8 {
    let mut script = Vec::new();
    generate(shell, program, "opennck", &mut script);
    output.print(&String::from_utf8_lossy(&script));
    0
}
