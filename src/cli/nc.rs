//! `opennck nc check`: every alarm that preparation of NC programs can raise, with line and column, without a machine.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Subcommand;

use super::output::Output;
use crate::isg::language;
use crate::machine::Machine;
use crate::nc_program::{
    AxisKind, AxisName, AxisNames, CheckFinding, Library, Program, SINUMERIK, check as check_program,
};
use crate::source::{INPUT_MIB, Problem, read_bytes, unreadable};

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Checks NC programs: reports every alarm that block preparation can raise, with line and column.
    ///
    /// The ending selects the language: *.nc is that of the ISG kernel and of TwinCAT CNC, all others are that of the SINUMERIK.
    ///
    /// A control raises such an alarm when it reaches the block. The check reads the whole program, also blocks that are jumped over. It also
    /// warns of comparisons beside AND, OR, XOR and NOT without parentheses: comparisons bind weakest. What needs a machine is not checked:
    /// limits, circles, owners of axes, system variables.
    ///
    /// Subprograms (*.spf) are searched beside the file, then in --program-path. Without --machine, the usual letters of axes (X, Y1, AX1)
    /// are axes.
    ///
    /// Exit codes: 0 no alarm (warnings are possible); 1 an alarm; 2 a file cannot be read.
    Check {
        /// Programs (*.mpf, *.spf; *.nc), or ASCII archives with several programs.
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// A folder in which subprograms are searched, too; can be repeated.
        #[arg(long, value_name = "FOLDER")]
        program_path: Vec<PathBuf>,
        /// A machine with more names of axes: a directory, an archive, or the name of a built-in machine.
        #[arg(long, value_name = "MACHINE")]
        machine: Option<PathBuf>,
        /// Of *.nc: reads programs as the manuals print them, as `lenient = true` in plant.toml does.
        #[arg(long)]
        lenient: bool,
    },
}

pub(super) fn run(command: &Command, output: &mut Output) -> u8 {
    let Command::Check { files, program_path, machine, lenient } = command;
    let other = files.iter().filter(|file| is_nc(file)).count();
    let result = match other {
        0 => check(files, program_path, machine.as_deref(), output),
        _ if other == files.len() => check_isg(files, program_path, *lenient, output),
        _ => Err(Problem::new(
            "expected programs of one control, found *.nc and others",
            "check them one after the other",
        )),
    };
    match result {
        Ok(alarms) => u8::from(alarms > 0),
        Err(problem) => {
            output.error(problem);
            2
        }
    }
}

/// The folders in which a control searches subprograms, after that of the caller (MD20108).
const FOLDERS_OF_THE_CONTROL: [&str; 4] = ["/_N_SPF_DIR", "/_N_CUS_DIR", "/_N_CMA_DIR", "/_N_CST_DIR"];

/// Returns the number of alarms. All files are read before the first finding is printed.
fn check(
    files: &[PathBuf],
    program_path: &[PathBuf],
    machine: Option<&Path>,
    output: &mut Output,
) -> Result<usize, Problem> {
    let axes = names(machine)?;
    let mut search_path: Vec<String> = FOLDERS_OF_THE_CONTROL.map(str::to_owned).into();
    search_path.extend(program_path.iter().map(|folder| folder.display().to_string()));
    let mut library = Library::new(search_path);
    for folder in program_path {
        add_folder(folder, &mut library)?;
    }
    let mut programs: Vec<(&Path, Arc<Program>)> = Vec::new();
    for file in files {
        let found = read(file)?;
        add_folder(folder_of(file), &mut library)?;
        programs.extend(found.into_iter().map(|program| (file.as_path(), library.add(program))));
    }
    let (mut alarms, mut warnings) = (0, 0);
    for (file, program) in &programs {
        for finding in check_program(program, &library, &axes, &SINUMERIK) {
            let (line, column) = finding.place();
            let place = format!("{}:{}:{column}", file.display(), program.line_of_file(line));
            match finding {
                CheckFinding::Alarm(alarm) => {
                    alarms += 1;
                    output.line(format!("{place}: {alarm}"));
                }
                CheckFinding::Warning { text, .. } => {
                    warnings += 1;
                    output.line(format!("{place}: warning: {text}"));
                }
            }
        }
    }
    let programs = count(programs.len(), "program");
    output.line(format!("{programs}: {}, {}", count(alarms, "alarm"), count(warnings, "warning")));
    Ok(alarms)
}

fn is_nc(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("nc"))
}

/// Programs of the ISG kernel. Returns the number of errors.
fn check_isg(
    files: &[PathBuf],
    program_path: &[PathBuf],
    lenient: bool,
    output: &mut Output,
) -> Result<usize, Problem> {
    let mut others: Vec<Arc<Program>> = Vec::new();
    for folder in files.iter().map(|file| folder_of(file)).chain(program_path.iter().map(PathBuf::as_path)) {
        let entries = fs::read_dir(folder).map_err(|error| unreadable(folder, &error))?;
        let mut beside: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
        beside.retain(|file| is_nc(file));
        beside.sort();
        // A file beside it that cannot be read is not there.
        others.extend(beside.iter().filter_map(|file| read(file).ok()).flatten().map(Arc::new));
    }
    let mut programs: Vec<(&Path, Program)> = Vec::new();
    for file in files {
        programs.extend(read(file)?.into_iter().map(|program| (file.as_path(), program)));
    }
    let (mut errors, mut warnings) = (0, 0);
    for (file, program) in &programs {
        for finding in language::check(program, &others, lenient) {
            let fault = &finding.fault;
            let place = format!("{}:{}:{}", file.display(), program.line_of_file(fault.line), fault.column);
            let kind = if finding.is_warning { "warning: " } else { "" };
            *(if finding.is_warning { &mut warnings } else { &mut errors }) += 1;
            output.line(format!("{place}: {kind}{fault}"));
        }
    }
    output.line(format!(
        "{}: {}, {}",
        count(programs.len(), "program"),
        count(errors, "error"),
        count(warnings, "warning")
    ));
    Ok(errors)
}

fn count(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// The usual names of axes, and those of the machine.
fn names(machine: Option<&Path>) -> Result<AxisNames, Problem> {
    let mut rows: Vec<AxisName> = AxisNames::usual().iter().cloned().collect();
    if let Some(machine) = machine {
        let machine = Machine::open(machine)?;
        let axes = machine.names().axes.iter().filter_map(|(_, name)| name.clone());
        rows.extend(axes.map(|name| AxisName::new(name, AxisKind::Any)));
    }
    Ok(AxisNames::new(rows))
}

/// Adds the programs of a folder. A file in it that cannot be read is not there: the check reads only what is called.
fn add_folder(folder: &Path, library: &mut Library) -> Result<(), Problem> {
    let entries = fs::read_dir(folder).map_err(|error| unreadable(folder, &error))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.sort();
    for file in files {
        let ending = file.extension().map(|ending| ending.to_ascii_lowercase());
        let is_program = ending.is_some_and(|ending| ending == "spf" || ending == "mpf");
        if is_program && let Ok(programs) = read(&file) {
            for program in programs {
                library.add(program);
            }
        }
    }
    Ok(())
}

fn read(file: &Path) -> Result<Vec<Program>, Problem> {
    let bytes = read_bytes(file, INPUT_MIB)?;
    let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    Ok(Program::read(&name, &folder_of(file).display().to_string(), bytes))
}

fn folder_of(file: &Path) -> &Path {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        Some(_) | None => Path::new("."),
    }
}
