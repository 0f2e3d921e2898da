//! The arguments of `opennck serve`: what is served, and to whom.

use std::path::PathBuf;

use super::{Network, Speed};

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
}
