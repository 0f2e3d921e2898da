//! The arguments of `opennck serve`: what is served, and to whom.

use std::path::{Path, PathBuf};

use super::{Network, Speed, WindowOptions};
use crate::s7::server::{Capture, Faults, Instruments, Limits};
use crate::source::Problem;

/// What is served, and to whom.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// A directory, an archive file, or the name of a built-in machine.
    pub(super) machine: PathBuf,
    /// Where S7 clients connect; it may be given several times.
    #[arg(long, value_name = "ADDR:PORT", default_value = "127.0.0.1:10102")]
    pub(super) s7: Vec<String>,
    /// How many times real time, from 0.001 to 1000.
    #[arg(long, value_name = "N", default_value_t = Speed::default())]
    pub(super) speed: Speed,
    /// Clients may change nothing.
    #[arg(long)]
    pub(super) read_only: bool,
    /// The PLC program; without one, clients write the PLC's side.
    #[arg(long, value_name = "NAME")]
    pub(super) plc: Option<String>,
    /// Memory of the PLC beside the interface: a file (*.toml), or a name in `plc_images` here or above.
    #[arg(long, value_name = "NAME|FILE")]
    pub(super) plc_image: Option<String>,
    /// From which networks clients may come, for example 192.168.0.0/24; it may be given several times.
    #[arg(long, value_name = "NET")]
    pub(super) allow: Vec<Network>,
    /// Writes down what clients do as a scenario: `opennck run F.toml` does the same again, to the byte.
    ///
    /// Each write stands there with its cycle, in order. The file is a whole scenario at any moment; an end without warning loses
    /// a second at most. A file that exists is refused.
    #[arg(long, value_name = "F.toml")]
    pub(super) record: Option<PathBuf>,
    /// Writes the trace as JSON lines when it ends; it is kept in memory until then.
    #[arg(long, value_name = "F.jsonl")]
    pub(super) trace: Option<PathBuf>,
    /// Writes what goes over the wire as a capture (pcap) that Wireshark opens; a file that exists is refused.
    ///
    /// The server's port is written as 102, where Wireshark shows S7 communication without being told. The file ends at 1 GiB, or
    /// where the disk is full; serving goes on.
    #[arg(long, value_name = "F.pcap")]
    pub(super) pcap: Option<PathBuf>,
    /// Faults for tests of panels, for example delay=10ms..80ms,drop=1%,error=1/200.
    ///
    /// delay=TIME or TIME..TIME: answers leave later; those to requests that came together wait together, and all stay in order.
    /// drop=CHANCE: an answer is swallowed; what was asked for is done.
    /// close=CHANCE: the connection is closed in place of an answer.
    /// error=CHANCE: a request to read or write is refused and not done, each item with return code 0A.
    /// code=05: another return code for error; code=8104 (four digits): an error of the whole request instead.
    /// seed=N: other chances, 1 without it. The same clients that ask the same in the same order meet the same faults.
    #[arg(long, value_name = "FAULTS", verbatim_doc_comment)]
    pub(super) s7_fault: Option<Faults>,
}

impl Arguments {
    /// What they say of the window for S7 clients.
    pub(super) fn window(&self) -> Result<WindowOptions, Problem> {
        Ok(WindowOptions {
            is_read_only: self.read_only,
            limits: Limits { networks: self.allow.clone(), ..Limits::default() },
            instruments: Instruments {
                faults: self.s7_fault.clone(),
                capture: self.pcap.as_deref().map(capture).transpose()?,
            },
            ..WindowOptions::default()
        })
    }
}

fn capture(path: &Path) -> Result<Capture, Problem> {
    Capture::create(path).map_err(|error| {
        Problem::new(
            format!("--pcap {}: expected a file that can be made anew: {error}", path.display()),
            "name a file that is not there yet, in a folder that is there",
        )
    })
}
