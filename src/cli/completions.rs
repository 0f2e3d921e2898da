//! `opennck completions`: what a shell needs to complete commands, options and their values.

use clap::CommandFactory;
use clap_complete::{Shell, generate};

use super::Arguments;
use super::output::Output;

pub(super) fn completions(shell: Shell, output: &mut Output) -> u8 {
    let mut script = Vec::new();
    generate(shell, &mut Arguments::command(), "opennck", &mut script);
    output.print(&String::from_utf8_lossy(&script));
    0
}
