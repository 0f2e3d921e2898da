//! The program `opennck`: arguments and wiring. The entry point is public: a user's own binary with its own PLC programs has the same
//! commands.
//!
//! ```no_run
//! fn main() -> std::process::ExitCode {
//!     opennck::cli::main(opennck::plc::Programs::ready())
//! }
//! ```
//!
//! Exit codes: 0 success; 1 an expectation failed, a limit was reached, a trace differs, a golden file is missing, findings in machine data
//! change the behaviour, an NC program has an alarm (`nc check`), two traces differ (`diff`); 2 unusable input, or an output that cannot be
//! written.

mod alarms;
mod campaign;
mod completions;
mod coverage;
mod diff;
mod durations;
mod example;
mod files;
mod flowchart;
#[cfg(feature = "s7")]
mod interrupt;
mod list;
#[cfg(feature = "s7")]
mod log;
mod machine_data;
mod nc;
mod output;
mod plc;
mod rule;
mod run;
#[cfg(feature = "s7")]
mod s7;
#[cfg(feature = "s7")]
mod serve;
mod signals;
mod test;
mod tune_limits;
mod why;
mod why_not;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

use crate::controls;
use crate::live::with_processes;
use crate::plc::{MACHINE_CONTROL_PANEL_LAYOUT, Programs};
use list::Format;
use output::Output;

/// The exit codes, as printed below the help.
const EXIT_CODES: &str = "Exit codes: 0 success; 1 an expectation failed, a limit was reached, a trace differs, a golden \
    file is missing, findings in machine data change the behaviour, an NC program has an alarm; 2 unusable input, or an output that \
    cannot be written.";

/// An open simulator of the NC/PLC interface of SINUMERIK-style controls.
///
/// Without a command it runs the worked example of the gantry manual (G1 2.7: commissioning a gantry) and prints one screen of it.
#[derive(Debug, Parser)]
#[command(name = "opennck", version, after_help = EXIT_CODES, args_conflicts_with_subcommands = true)]
struct Arguments {
    /// Writes the whole worked example as a timing diagram, with all its signals.
    #[arg(long, value_name = "F.svg")]
    svg: Option<PathBuf>,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Runs scenarios as fast as possible and prints their signal sequences with causes.
    #[command(after_long_help = format!(
        "Inputs and outputs of the built-in program machine_control_panel (OpenNCK's own layout):\n\n{MACHINE_CONTROL_PANEL_LAYOUT}"
    ))]
    Run {
        /// Scenario files.
        #[arg(required = true, value_name = "SCENARIO")]
        scenarios: Vec<PathBuf>,
        #[command(flatten)]
        options: run::Options,
    },
    /// Runs every scenario below the paths and compares each trace with its golden file.
    Test(test::Arguments),
    /// Runs many cases of one scenario, and reports the failures in groups, each with the smallest scenario that shows it.
    ///
    /// The file of the campaign names the base scenario, what varies (machine data, values of the plant, PLC programs, faults, inputs), and
    /// what must hold. The same file gives the same cases and the same results, on any number of processors. A run that was interrupted
    /// keeps what is done.
    ///
    /// Exit codes: 0 every case held; 1 a case failed, or no case reached what must be reached; 2 unusable input.
    Campaign(Box<campaign::Arguments>),
    /// Runs a machine in real time and serves it to S7 clients: operator panels, data collectors, test tools.
    ///
    /// Clients read and write DB10, DB11, DB21..., DB31..., the user data blocks, flags, inputs and outputs of the PLC, and read NC
    /// variables. All values read by one request are of the same cycle. All values written by one request take effect together at the start
    /// of the next cycle. Ctrl-C, SIGTERM or SIGHUP ends the command with exit code 0.
    #[cfg(feature = "s7")]
    Serve(Box<serve::Arguments>),
    /// Reads, writes and watches a PLC or an NCK by S7 communication: this simulator, a control, or any other device.
    #[cfg(feature = "s7")]
    S7 {
        #[command(subcommand)]
        command: s7::Command,
    },
    /// Lists the signal catalogue: address, symbol, writer, whether it is modelled, name; also the values of axes.
    ///
    /// Addresses and symbols are those of the first axis (AX1), channel (CHAN1) and mode group; with --machine they are those of a machine.
    /// On 840D sl, axis n has DB 30+n and channel n has DB 20+n. The second mode group starts 20 bytes after the first.
    ///
    /// Modelled: `yes`: the control writes it, or reads it. `written never`: a signal of the NCK that this model does not write; it stays 0.
    /// `memory only`: a signal of the PLC or the HMI that this model does not read; it can be written and read.
    ///
    /// Values (`X.position`) have no address; they are in the table, not in `csv` and `json`.
    Signals {
        /// Shows only signals with this text in their row. Everyday words are found, too: `reference cam`, `Reglerfreigabe`.
        filter: Option<String>,
        /// A machine whose axes, channels and names are listed: a directory, an archive, or the name of a built-in machine.
        #[arg(long, value_name = "MACHINE")]
        machine: Option<PathBuf>,
        /// Profile of the addresses: 840d_sl, 828d, or isg for the ISG kernel and TwinCAT CNC.
        #[arg(long, default_value = controls::default_profile())]
        profile: String,
        /// Output format: a list, or the symbol file of another tool.
        #[arg(long, value_enum, default_value = "table")]
        format: signals::SignalFormat,
        /// Writes to a file instead of standard output. A symbol table or source of STEP 7 that exists is never replaced.
        #[arg(long, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Lists the alarm catalogue: number, whether the model raises it, how it is cancelled, its reactions, its text.
    Alarms {
        /// Shows only alarms with this text in their row.
        filter: Option<String>,
        /// Shows only those of the control with this profile: 840d_sl, 828d, isg.
        #[arg(long, value_name = "PROFILE")]
        profile: Option<String>,
        /// Output format.
        #[arg(long, value_enum, default_value = "table")]
        format: Format,
    },
    /// Explains a rule: what it says, its source in the manuals, decisions that touch it, and scenarios that show it.
    ///
    /// Causes in traces begin with the ID of a rule (`REF-02`), a decision (`E-14`, `O-27`, `C-03`) or an alarm (`25040`). Without an ID,
    /// all rules and decisions are listed.
    Rule {
        /// An ID, or a text: rows that contain it are listed.
        #[arg(value_name = "ID")]
        filter: Option<String>,
        /// Output format.
        #[arg(long, value_enum, default_value = "table")]
        format: Format,
    },
    /// Reports the first difference between two traces; exit code 0 if they are the same, 1 if they differ.
    ///
    /// The report shows the signal, its time, the expected and the found value, and the last changes before it. Traces that differ only in
    /// their causes count as the same; the difference is reported.
    Diff {
        /// The expected trace: JSON lines (from `run --trace`) or a golden file (*.snap).
        expected: PathBuf,
        /// The trace to compare, in the same format.
        found: PathBuf,
    },
    /// Explains why a signal has its value: the chain of causes behind an edge, back to the first write from outside the control.
    ///
    /// Each line shows the time, then a change and its writer, or the event behind it with its rule and the conditions it tested. The
    /// signals that an event tested are traced back to their last edge before it.
    Why {
        /// A trace (JSON lines, from `run --trace`), or a scenario (*.toml) to run.
        trace: PathBuf,
        /// A symbol, an address, `alarm(NUMBER)` or a happening (`power_on`, `fault drive_fault[XF]`, `MD37110[XF]`), and a time in seconds:
        /// the last one at or before this time is explained; without a time, the last one.
        #[arg(value_name = "ADDRESS[@TIME]")]
        edge: String,
        #[command(flatten)]
        run: why::Run,
    },
    /// Explains what the control waits for before a signal changes: a tree of the conditions that do not hold.
    ///
    /// The signal can be 0 (what keeps it at 0?) or 1 (what would reset it?). Each line shows what the control tests, what it finds and what
    /// it wants. A signal that the control writes itself is explained in turn; the others show who wrote them last. Every bit that the
    /// control writes has conditions; `opennck signals` shows which ones are modelled.
    WhyNot {
        /// A scenario (*.toml) to run up to the time.
        scenario: PathBuf,
        /// A symbol or an address of one bit, and a time in seconds; without a time, the end of the scenario.
        #[arg(value_name = "ADDRESS[@TIME]")]
        signal: String,
        /// Also shows the conditions that hold.
        #[arg(long)]
        all: bool,
        #[command(flatten)]
        run: why::Run,
    },
    /// Finds the warning limit and the trip limits of each gantry grouping (MD37110, MD37120, MD37130) from the movements of a scenario.
    ///
    /// The manual's procedure (G1 2.7.4): with a large MD37120, MD37110 is raised until the message 10652 no longer appears while the
    /// axes are under a heavy dynamic load; MD37120 is that value and a safety margin. The scenario references and synchronises the
    /// grouping and moves it as hard as the machine will. Its differences while the grouping is synchronised count. Then it runs again with
    /// the proposed limits.
    ///
    /// Exit codes: 0 limits are proposed; 1 the scenario failed, or no grouping was synchronised or moved; 2 unusable input: no gantry
    /// grouping, a scenario that changes one of the limits itself.
    TuneLimits(tune_limits::Arguments),
    /// Prints the reference point approach and the gantry grouping as a Mermaid flowchart; each transition shows its rule.
    ///
    /// The chart is drawn from the tables that the control runs.
    Flowchart {
        /// Prints only this chart.
        #[arg(value_parser = flowchart::names())]
        chart: Option<String>,
    },
    /// Prints the completion script for a shell.
    ///
    /// For bash: `opennck completions bash > ~/.local/share/bash-completion/completions/opennck`.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Writes the manual pages (man) of the program and of each command into a folder.
    #[command(hide = true)]
    Man {
        /// The folder.
        folder: PathBuf,
    },
    /// Works with NC programs.
    Nc {
        #[command(subcommand)]
        command: nc::Command,
    },
    /// Works with machine data.
    MachineData {
        #[command(subcommand)]
        command: MachineData,
    },
    /// Works with STEP 7 programs.
    Plc {
        #[command(subcommand)]
        command: Plc,
    },
}

#[derive(Debug, Subcommand)]
enum Plc {
    /// Compiles the AWL sources of a folder and lists its blocks, what is missing, and what is not supported, with file and line.
    ///
    /// Exit codes: 0 the program can be loaded; 1 it calls blocks that are nowhere or are not supported; 2 the sources have errors, or
    /// cannot be read.
    Check {
        /// A folder with `*.awl`, a symbol table (`*.asc`, `*.sdf`, `*.seq`) and, if needed, `plc.toml`.
        folder: PathBuf,
    },
}

#[derive(Debug, Subcommand)]
enum MachineData {
    /// Reads machine data and reports every finding: errors, alarms at power on, data that are perhaps mistyped, implausible values, data
    /// that act otherwise than on a control, values that a later file or line replaced, data that are not modelled.
    ///
    /// Exit codes: 0 usable; 1 a finding changes the behaviour (an alarm at power on, an unknown datum in a file that a person wrote, an
    /// implausible value, a datum that acts otherwise than on a control), or a finding that --deny names; 2 unusable.
    Check {
        /// A directory, an archive file, the name of a built-in machine, or a scenario (*.toml): its machine as the scenario changes it.
        machine: PathBuf,
        /// Of a scenario with a matrix: only the cases whose values contain this text, as `plc = a`.
        #[arg(long, value_name = "TEXT")]
        case: Option<String>,
        /// Lists every datum that is not modelled, instead of one line for each function.
        #[arg(long)]
        all: bool,
        /// Ends with 1 if there are findings of this kind.
        #[arg(long, value_enum, value_name = "KIND")]
        deny: Vec<machine_data::Deny>,
    },
    /// Lists the catalogue of machine data: number, name, unit, range, default, the action with which it takes effect, whether it is
    /// modelled, meaning.
    ///
    /// Modelled: `yes`: the datum has an effect. `no`: it is read, checked and kept, without effect. A control has further data; they are
    /// kept as well.
    List {
        /// A number, or a text: only data with this text in their row.
        #[arg(value_name = "TEXT|NUMBER")]
        filter: Option<String>,
        /// Shows only those of the control with this profile: 840d_sl, 828d, isg.
        #[arg(long, value_name = "PROFILE")]
        profile: Option<String>,
        /// Output format.
        #[arg(long, value_enum, default_value = "table")]
        format: Format,
    },
}

/// The stack of the thread that runs a command. The stack of the first thread depends on `ulimit -s`.
const STACK: usize = 16 << 20;

/// Runs the program with these PLC programs, which are found by name.
#[must_use]
#[expect(clippy::needless_pass_by_value, reason = "the process ends after this function")]
pub fn main(programs: Programs) -> ExitCode {
    let of_its_own = std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, || run_command(&programs));
        thread.map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    });
    // Without another thread the stack of this one has to be enough.
    of_its_own.unwrap_or_else(|_| run_command(&programs))
}

fn run_command(programs: &Programs) -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            let code = u8::try_from(error.exit_code()).unwrap_or(2);
            let mut output = Output::default();
            if error.use_stderr() {
                // If the message cannot be printed, there is no other place to report it.
                let _ = error.print();
            } else {
                output.note(error.print()); // --help and --version
            }
            return ExitCode::from(output.code(code));
        }
    };
    let mut output = Output::default();
    let programs = &with_processes(programs.clone());
    let code = match arguments.command {
        None => example::run(arguments.svg, programs, &mut output),
        Some(Command::Run { scenarios, options }) => run::run(&scenarios, &options, programs, &mut output),
        Some(Command::Campaign(arguments)) => campaign::campaign(&arguments, programs, &mut output),
        Some(Command::Test(arguments)) => test::test(&arguments, programs, &mut output),
        #[cfg(feature = "s7")]
        Some(Command::Serve(arguments)) => serve::serve(&arguments, programs, &mut output),
        #[cfg(feature = "s7")]
        Some(Command::S7 { command }) => s7::run(&command, &mut output),
        Some(Command::Signals { filter, machine, profile, format, output: file }) => {
            let listed = signals::Listed { filter: filter.as_deref(), format, file: file.as_deref() };
            signals::signals(machine.as_deref(), &profile, &listed, &mut output)
        }
        Some(Command::Alarms { filter, profile, format }) => {
            alarms::alarms(filter.as_deref(), profile.as_deref(), format, &mut output)
        }
        Some(Command::Rule { filter, format }) => rule::rule(filter.as_deref(), format, &mut output),
        Some(Command::Diff { expected, found }) => diff::diff(&expected, &found, &mut output),
        Some(Command::Why { trace, edge, run }) => why::why(&trace, &edge, &run, programs, &mut output),
        Some(Command::WhyNot { scenario, signal, all, run }) => {
            why_not::why_not(&scenario, &signal, &run, all, programs, &mut output)
        }
        Some(Command::TuneLimits(arguments)) => tune_limits::tune_limits(&arguments, programs, &mut output),
        Some(Command::Flowchart { chart }) => flowchart::flowchart(chart.as_deref(), &mut output),
        Some(Command::Completions { shell }) => completions::completions(shell, &mut Arguments::command(), &mut output),
        Some(Command::Man { folder }) => completions::man(&folder, Arguments::command(), &mut output),
        Some(Command::Nc { command }) => nc::run(&command, &mut output),
        Some(Command::MachineData { command: MachineData::Check { machine, case, all, deny } }) => {
            machine_data::check(&machine, case.as_deref(), all, &deny, &mut output)
        }
        Some(Command::MachineData { command: MachineData::List { filter, profile, format } }) => {
            machine_data::list(filter.as_deref(), profile.as_deref(), format, &mut output)
        }
        Some(Command::Plc { command: Plc::Check { folder } }) => plc::check(&folder, &mut output),
    };
    ExitCode::from(output.code(code))
}
