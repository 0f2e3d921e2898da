//! The program `opennck`: arguments and wiring. Public, so that a user's own binary with own PLC programs has the
//! same commands:
//!
//! ```no_run
//! fn main() -> std::process::ExitCode {
//!     opennck::cli::main(opennck::plc::Programs::ready())
//! }
//! ```
//!
//! Exit codes: 0 all held; 1 an expectation failed, a limit was reached, a trace differs, a golden file is missing,
//! machine data have findings, two traces differ (`diff`); 2 unusable input.

mod alarms;
mod completions;
mod diff;
pub mod example;
mod flowchart;
#[cfg(feature = "s7")]
mod interrupt;
mod list;
#[cfg(feature = "s7")]
mod log;
mod machine_data;
mod output;
mod run;
#[cfg(feature = "s7")]
mod s7;
#[cfg(feature = "s7")]
mod serve;
mod signals;
mod test;
mod why;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

use crate::plc::{MACHINE_CONTROL_PANEL_LAYOUT, Programs};
use list::Format;
use output::Output;

/// What scripts ask for.
const EXIT_CODES: &str = "Exit codes: 0 all held; 1 an expectation failed, a limit was reached, a trace differs, a golden \
    file is missing, machine data have findings; 2 unusable input.";

/// An open simulator of the NC/PLC interface of SINUMERIK-style controls.
///
/// Without a command it runs the worked example of the gantry manual and shows its signal sequence.
#[derive(Debug, Parser)]
#[command(name = "opennck", version, after_help = EXIT_CODES)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Runs scenarios as fast as the machine allows and prints their signal sequences with causes.
    #[command(after_long_help = format!("Inputs and outputs of the ready program machine_control_panel, a layout of ours:\n\n{MACHINE_CONTROL_PANEL_LAYOUT}"))]
    Run {
        /// Scenario files.
        #[arg(required = true, value_name = "SCENARIO")]
        scenarios: Vec<PathBuf>,
        #[command(flatten)]
        files: run::Files,
    },
    /// Runs every scenario below the paths and compares each trace with the golden one beside it.
    Test {
        /// Directories or scenario files.
        #[arg(default_value = "golden", value_name = "PATH")]
        paths: Vec<PathBuf>,
        /// Rewrites the golden files whose traces changed.
        #[arg(long)]
        accept: bool,
        /// Writes a report in JUnit's format.
        #[arg(long, value_name = "F.xml")]
        junit: Option<PathBuf>,
        /// How many scenarios run at once; as many as there are processors unless said.
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
        jobs: Option<u16>,
        /// Writes the flowchart of referencing and gantry with the transitions that the scenarios took, as Mermaid.
        #[arg(long, value_name = "F.mmd")]
        flowchart: Option<PathBuf>,
    },
    /// Runs a machine in real time and serves it to S7 clients: operator panels, data collectors, test tools.
    ///
    /// They read and write DB10, DB11, DB21..., DB31..., the own data blocks and flags of the PLC, inputs and outputs, and read NC
    /// variables. What one request reads is of one cycle; what it writes acts at the edge of the next, whole. Ctrl-C and SIGTERM end it
    /// with 0.
    #[cfg(feature = "s7")]
    Serve(Box<serve::Arguments>),
    /// Reads, writes and watches a PLC or an NCK by S7 communication: this simulator, a control, or any other.
    #[cfg(feature = "s7")]
    S7 {
        #[command(subcommand)]
        command: s7::Command,
    },
    /// Lists the signal catalogue: address, symbol, writer, name.
    ///
    /// Addresses and symbols are those of the first axis (AX1), channel (CHAN1) and mode group; a machine has its own
    /// names. On 840D sl axis n has DB 30+n and channel n DB 20+n; the second mode group lies 20 bytes above the first.
    Signals {
        /// Shows only signals in whose address, symbol or name this text occurs.
        filter: Option<String>,
        /// The profile whose addresses are shown: 840d_sl or 828d.
        #[arg(long, default_value = "840d_sl")]
        profile: String,
        /// How the list is printed.
        #[arg(long, value_enum, default_value = "table")]
        format: Format,
    },
    /// Lists the alarm catalogue: number, whether the model raises it, what cancels it, its reactions, its text.
    Alarms {
        /// Shows only alarms in whose row this text occurs.
        filter: Option<String>,
        /// How the list is printed.
        #[arg(long, value_enum, default_value = "table")]
        format: Format,
    },
    /// Tells the first difference of two traces in words; ends with 0 where they are the same, with 1 where they differ.
    ///
    /// It shows the signal, its time, what was expected and found, and the last changes before it. Causes may differ: that is told, and
    /// the traces are still the same.
    Diff {
        /// The trace that was expected: JSON lines (from `run --trace`) or a golden file (*.snap).
        expected: PathBuf,
        /// The trace that was found, in the same form.
        found: PathBuf,
    },
    /// Tells why a signal has its value: the chain of causes behind an edge, back to what was written from outside the control.
    ///
    /// Each line has the time; then a change with who made it, or the event behind it with its rule and what it tested. The signals
    /// that an event tested are followed to their last edge before it.
    Why {
        /// A trace (JSON lines, from `run --trace`), or a scenario (*.toml), which is then run.
        trace: PathBuf,
        /// A symbol, an address or `alarm(NUMBER)`, and a time in seconds: the last edge then or before is meant.
        #[arg(value_name = "ADDRESS@TIME")]
        edge: String,
    },
    /// Prints the reference point approach and the gantry grouping as a Mermaid flowchart, each transition with its rule.
    ///
    /// It is drawn from the tables by which the control runs.
    Flowchart {
        /// Only this one.
        #[arg(value_parser = flowchart::names())]
        chart: Option<String>,
    },
    /// Prints the completions of commands and options for a shell.
    ///
    /// For bash: `opennck completions bash > ~/.local/share/bash-completion/completions/opennck`.
    Completions {
        /// Which shell.
        shell: clap_complete::Shell,
    },
    /// Works with machine data.
    MachineData {
        #[command(subcommand)]
        command: MachineData,
    },
}

#[derive(Debug, Subcommand)]
enum MachineData {
    /// Reads machine data and reports every finding.
    Check {
        /// A directory, an archive file, or the name of a built-in machine.
        machine: PathBuf,
    },
}

/// The program, with these PLC programs by name.
#[must_use]
#[expect(clippy::needless_pass_by_value, reason = "the program ends with its programs")]
pub fn main(programs: Programs) -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // Where nobody reads the message there is nobody to tell.
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    let mut output = Output::default();
    let code = match arguments.command {
        None => example::run(&programs, &mut output),
        Some(Command::Run { scenarios, files }) => run::run(&scenarios, &files, &programs, &mut output),
        Some(Command::Test { paths, accept, junit, jobs, flowchart }) => {
            let options = test::Options { accept, junit, jobs, flowchart };
            test::test(&paths, &options, &programs, &mut output)
        }
        #[cfg(feature = "s7")]
        Some(Command::Serve(arguments)) => serve::serve(&arguments, &programs, &mut output),
        #[cfg(feature = "s7")]
        Some(Command::S7 { command }) => s7::run(&command, &mut output),
        Some(Command::Signals { filter, profile, format }) => {
            signals::signals(filter.as_deref(), &profile, format, &mut output)
        }
        Some(Command::Alarms { filter, format }) => alarms::alarms(filter.as_deref(), format, &mut output),
        Some(Command::Diff { expected, found }) => diff::diff(&expected, &found, &mut output),
        Some(Command::Why { trace, edge }) => why::why(&trace, &edge, &programs, &mut output),
        Some(Command::Flowchart { chart }) => flowchart::flowchart(chart.as_deref(), &mut output),
        Some(Command::Completions { shell }) => completions::completions(shell, &mut Arguments::command(), &mut output),
        Some(Command::MachineData { command: MachineData::Check { machine } }) => {
            machine_data::check(&machine, &mut output)
        }
    };
    ExitCode::from(code)
}
