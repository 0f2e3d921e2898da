//! `opennck s7`: a PLC or an NCK from the command line, by S7 communication.
//!
//! Exit codes: 0 all was read or written, or watching was ended by Ctrl-C; 1 something was refused; 2 unusable input, or nobody
//! could be reached.

mod arguments;
mod catalogue;
mod cells;
mod failure;
mod info;
mod read;
mod rows;
mod sources;
mod szl;
mod targets;
mod watch;
mod write;

use clap::Subcommand;
use tokio::runtime::Builder;

use crate::cli::list::Format;
use crate::cli::output::Output;
use crate::source::Problem;

const ADDRESSES: &str = "Addresses:
  DB31.DBX101.4  DB31.DBB101  DB21.DBW4  DB31.DBD78:REAL  M10.3  IB0  QW4  T5  C3
  DB31.DBB0..10                              bytes 0 to 10; words and double words likewise
  X.gantry_synchronization_ready_to_start    a symbol; names of axes come from --machine, or from the NCK
  nck:C/MachineAxis/actToolBasePos[2]        an NC variable, row 2; [1..3] for three rows; `opennck s7 nck` lists them
  nck:A1/M/32000:DOUBLE                      an NC variable by area, module and column

Exit codes: 0 all was read or written; 1 something was refused; 2 unusable input, or nobody could be reached.";

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Reads addresses, symbols and NC variables once.
    #[command(after_help = ADDRESSES)]
    Read {
        #[command(flatten)]
        host: arguments::Host,
        /// What to read.
        #[arg(required = true, value_name = "ADDRESS")]
        addresses: Vec<String>,
        #[command(flatten)]
        names: arguments::Names,
        /// How the list is printed.
        #[arg(long, value_enum, default_value = "table")]
        format: Format,
    },
    /// Writes values once, all of them in one request where they fit.
    ///
    /// Values: whole numbers (also 16#D0 and 2#1101_0000), true and false for bits, fractions for REAL, 100% for overrides, several
    /// with commas for a range. Nothing is written if one of them does not fit.
    #[command(after_help = ADDRESSES)]
    Write {
        #[command(flatten)]
        host: arguments::Host,
        /// What to write.
        #[arg(required = true, value_name = "ADDRESS=VALUE")]
        writes: Vec<String>,
        #[command(flatten)]
        names: arguments::Names,
        /// How the list is printed.
        #[arg(long, value_enum, default_value = "table")]
        format: Format,
    },
    /// Prints a line for each change of a value, with the time in seconds since the start, until Ctrl-C.
    #[command(after_help = ADDRESSES)]
    Watch {
        #[command(flatten)]
        host: arguments::Host,
        /// What to watch.
        #[arg(required = true, value_name = "ADDRESS")]
        addresses: Vec<String>,
        #[command(flatten)]
        names: arguments::Names,
        /// How often the values are read: 100ms, 1s, 1min.
        #[arg(long, value_name = "TIME", default_value = "100ms", value_parser = arguments::duration)]
        every: std::time::Duration,
        /// Lets the module send the values by itself, in whole tenths of a second.
        #[arg(long)]
        cyclic: bool,
        /// How lines are printed: aligned, as JSON lines, or as CSV.
        #[arg(long, value_enum, default_value = "table")]
        format: Format,
    },
    /// Tells what a module is: its names, state, protection, clock and blocks, and the axes and alarms of its NCK.
    Info {
        #[command(flatten)]
        host: arguments::Host,
        /// How the list is printed.
        #[arg(long, value_enum, default_value = "table")]
        format: Format,
    },
    /// Prints a system state list (SZL), a record in a line.
    Szl {
        #[command(flatten)]
        host: arguments::Host,
        /// Which, in hexadecimal: 0011, 001C, 0424; 0000 lists all.
        #[arg(value_parser = arguments::hexadecimal)]
        id: u16,
        /// Of what, in hexadecimal.
        #[arg(default_value = "0", value_parser = arguments::hexadecimal)]
        index: u16,
        /// How the list is printed.
        #[arg(long, value_enum, default_value = "table")]
        format: Format,
    },
    /// Lists the NC variables that have a name; 1 at the end says that none was found.
    ///
    /// Machine data go by their number, with their type: nck:N/M/10000:TEXT32[1], nck:C/M/20000:TEXT32, nck:A1/M/32000:DOUBLE.
    Nck {
        /// Shows only variables in whose row this text occurs.
        filter: Option<String>,
        /// How the list is printed.
        #[arg(long, value_enum, default_value = "table")]
        format: Format,
    },
}

/// The exit code.
pub(super) fn run(command: &Command, output: &mut Output) -> u8 {
    if let Command::Nck { filter, format } = command {
        return catalogue::list(filter.as_deref(), *format, output);
    }
    let runtime = match Builder::new_current_thread().enable_all().build() {
        Ok(runtime) => runtime,
        Err(error) => {
            output.error(Problem::new(format!("no network: {error}"), "close other programs"));
            return 2;
        }
    };
    let done = runtime.block_on(async {
        match command {
            Command::Read { host, addresses, names, format } => {
                read::read(host, addresses, names, *format, output).await
            }
            Command::Write { host, writes, names, format } => write::write(host, writes, names, *format, output).await,
            Command::Watch { host, addresses, names, every, cyclic, format } => {
                let how = watch::How { every: *every, cyclic: *cyclic, format: *format };
                watch::watch(host, addresses, names, how, output).await
            }
            Command::Info { host, format } => info::info(host, *format, output).await,
            Command::Szl { host, id, index, format } => szl::szl(host, *id, *index, *format, output).await,
            Command::Nck { .. } => Ok(0),
        }
    });
    done.unwrap_or_else(|failure| {
        output.error(failure.problem);
        failure.code
    })
}
