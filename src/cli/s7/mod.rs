//! `opennck s7`: reads, writes and watches a PLC or an NCK by S7 communication.
//!
//! Exit codes: 0 everything was read or written, or watching was ended by Ctrl-C; 1 a request was refused; 2 unusable input, or the host
//! could not be reached.

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
  DB31.DBB0..10                              bytes 0 to 10; also for words and double words
  X.gantry_synchronization_ready_to_start    a symbol; axis names come from --machine, or from the NCK
  nck:C/MachineAxis/actToolBasePos[2]        an NC variable, row 2; [1..3] for three rows; `opennck s7 nck` lists them
  nck:A1/M/32000:DOUBLE                      an NC variable by area, module and column

Exit codes: 0 everything was read or written; 1 a request was refused; 2 unusable input, or the host could not be reached.";

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Reads addresses, symbols and NC variables once.
    #[command(after_help = ADDRESSES)]
    Read {
        #[command(flatten)]
        host: arguments::Host,
        /// Addresses to read.
        #[arg(required = true, value_name = "ADDRESS")]
        addresses: Vec<String>,
        #[command(flatten)]
        names: arguments::Names,
        /// Output format.
        #[arg(long, value_enum, default_value = "table")]
        format: Format,
    },
    /// Writes values once, in one request if they fit.
    ///
    /// Values: integers (also 16#D0 and 2#1101_0000), true and false for bits, decimal fractions for REAL, 100% for overrides, a
    /// comma-separated list for a range. If one value does not fit its address, nothing is written.
    #[command(after_help = ADDRESSES)]
    Write {
        #[command(flatten)]
        host: arguments::Host,
        /// Addresses and values to write.
        #[arg(required = true, value_name = "ADDRESS=VALUE")]
        writes: Vec<String>,
        #[command(flatten)]
        names: arguments::Names,
        /// Output format.
        #[arg(long, value_enum, default_value = "table")]
        format: Format,
    },
    /// Prints a line for each change of a value, with the time in seconds since the start, until Ctrl-C.
    #[command(after_help = ADDRESSES)]
    Watch {
        #[command(flatten)]
        host: arguments::Host,
        /// Addresses to watch.
        #[arg(required = true, value_name = "ADDRESS")]
        addresses: Vec<String>,
        #[command(flatten)]
        names: arguments::Names,
        /// Polling interval: 100ms, 1s, 1min.
        #[arg(long, value_name = "TIME", default_value = "100ms", value_parser = arguments::duration)]
        every: std::time::Duration,
        /// Subscribes, so that the module sends the values; the interval is in whole tenths of a second.
        #[arg(long)]
        cyclic: bool,
        /// Output format: aligned, JSON lines, or CSV.
        #[arg(long, value_enum, default_value = "table")]
        format: Format,
    },
    /// Shows information about a module: names, state, protection, clock, blocks, and the axes and alarms of its NCK.
    Info {
        #[command(flatten)]
        host: arguments::Host,
        /// Output format.
        #[arg(long, value_enum, default_value = "table")]
        format: Format,
    },
    /// Prints a system state list (SZL), one record per line.
    Szl {
        #[command(flatten)]
        host: arguments::Host,
        /// SZL ID in hexadecimal: 0011, 001C, 0424; 0000 lists all IDs.
        #[arg(value_parser = arguments::hexadecimal)]
        id: u16,
        /// SZL index in hexadecimal.
        #[arg(default_value = "0", value_parser = arguments::hexadecimal)]
        index: u16,
        /// Output format.
        #[arg(long, value_enum, default_value = "table")]
        format: Format,
    },
    /// Lists the NC variables that have a name; exit code 1 if none is found.
    ///
    /// Machine data are addressed by number and type: nck:N/M/10000:TEXT32[1], nck:C/M/20000:TEXT32, nck:A1/M/32000:DOUBLE.
    Nck {
        /// Shows only variables with this text in their row.
        filter: Option<String>,
        /// Output format.
        #[arg(long, value_enum, default_value = "table")]
        format: Format,
    },
}

/// Runs the command and returns its exit code.
pub(super) fn run(command: &Command, output: &mut Output) -> u8 {
    if let Command::Nck { filter, format } = command {
        return catalogue::list(filter.as_deref(), *format, output);
    }
    let runtime = match Builder::new_current_thread().enable_all().build() {
        Ok(runtime) => runtime,
        Err(error) => {
            output.error(Problem::new(format!("cannot open the network: {error}"), "close other programs"));
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
