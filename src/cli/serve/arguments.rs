//! The arguments of `opennck serve`: the machine, the server and its limits.

use std::convert::Infallible;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::cli::durations::duration;
use crate::cli::output::Output;
use crate::live::{Opened, Opening, Speed};
use crate::machine::Machine;
use crate::plc::Programs;
use crate::s7::Settings;
use crate::s7::live::{LiveServerOptions, OwnIdentity, Terms, protected, protection};
use crate::s7::server::{Faults, Limits, Network};
use crate::source::Problem;

/// The machine, the server and its limits.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// A directory, an archive file, or the name of a built-in machine [default: the machine of the scenario].
    #[arg(required_unless_present = "scenario")]
    pub(super) machine: Option<PathBuf>,
    /// Address and port for S7 clients; may be given several times.
    #[arg(long, value_name = "ADDR:PORT", default_value = "127.0.0.1:10102")]
    pub(super) s7: Vec<String>,
    /// Speed relative to real time, from 0.001 to 1000.
    #[arg(long, value_name = "N", default_value_t = Speed::default())]
    pub(super) speed: Speed,
    /// Clients may read but not write.
    #[arg(long)]
    pub(super) read_only: bool,
    /// The PLC program; without one, clients write the PLC signals.
    #[arg(long, value_name = "NAME")]
    pub(super) plc: Option<String>,
    /// Runs the PLC program in another process, which maps this file; the file is created if it does not exist.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["plc", "record"])]
    pub(super) image: Option<PathBuf>,
    /// With --image: each scan waits for the answer of the PLC process, and the first step waits until a process opens the file.
    ///
    /// The same PLC program then gives the same trace, byte for byte, whenever it is started. Client writes before the first step take
    /// effect at its start.
    #[arg(long, requires = "image")]
    pub(super) lock_step: bool,
    /// With --image: how long the PLC process may be silent before the PLC stops with alarm 2000. Monitoring starts with the first answer
    /// of the process; in lock-step when the process opens the file.
    #[arg(long, value_name = "TIME", requires = "image", default_value = "1s", value_parser = duration)]
    pub(super) plc_timeout: Duration,
    /// PLC memory outside the interface: a file (*.toml), or a name in `plc_images` of this folder or a parent folder.
    #[arg(long, value_name = "NAME|FILE")]
    pub(super) plc_image: Option<String>,
    /// Networks from which clients may connect and metrics may be read, for example 192.168.0.0/24; may be given several times.
    #[arg(long, value_name = "NET")]
    pub(super) allow: Vec<Network>,
    /// Records what clients do as a scenario: `opennck run F.toml` repeats it, byte for byte.
    ///
    /// Each write is recorded with its cycle, in order. The file is a complete scenario at any time; a crash loses at most one second. An
    /// existing file is refused. Cannot be combined with --image: the actions of another process cannot be repeated.
    #[arg(long, value_name = "F.toml", conflicts_with = "image")]
    pub(super) record: Option<PathBuf>,
    /// Runs a scenario on the machine in real time, while clients are connected.
    ///
    /// The machine, PLC program and image of the scenario are served, with its profile and plant; options on the command line take
    /// precedence. A step that fails is logged and ends the scenario. The server keeps running then, and also after the scenario has
    /// passed, unless --exit is given. A recording contains the actions of the scenario as well.
    #[arg(long, value_name = "F.toml")]
    pub(super) scenario: Option<PathBuf>,
    /// With --scenario: the case of its matrix whose values contain this text, as `plc = a`.
    #[arg(long, value_name = "TEXT", requires = "scenario")]
    pub(super) case: Option<String>,
    /// With --scenario: ends when the scenario is over, with exit code 0 if it passed and 1 if it failed.
    #[arg(long, requires = "scenario")]
    pub(super) exit: bool,
    /// Writes the trace as JSON lines at the end: after Ctrl-C, SIGTERM or SIGHUP. It is kept in memory until then, and the file keeps its
    /// old content; so a kill or a crash leaves no trace. What --record writes survives them.
    #[arg(long, value_name = "F.jsonl")]
    pub(super) trace: Option<PathBuf>,
    /// With --trace: the memory for the trace, in MiB. The trace ends there with a note; the machine keeps running.
    #[arg(long, value_name = "MIB", requires = "trace", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) trace_limit: u32,
    /// Addresses of the interface blocks: 840d_sl (DB10, DB11, DB21..., DB31...) or 828d (DB1800, DB3800...) [default: 840d_sl, or the
    /// profile of the scenario].
    #[arg(long, value_name = "PROFILE")]
    pub(super) profile: Option<String>,
    /// Addresses that clients may not write; may be given several times.
    ///
    /// Blocks: DB21, DB21..30. Bytes: DB1000.DBB0..99, DB1000.DBW4, MB0..99, IB0, T0..9. Areas: I, Q, M, T, C. nck: all NC variables,
    /// including machine data. A write to a protected address gets return code 03; the other items of the request are not affected.
    #[arg(long, value_name = "ADDRESS")]
    pub(super) protect: Vec<String>,
    /// Password of the CPU, up to eight characters.
    ///
    /// Each wrong password doubles the waiting time for this client address, from 0.25 s to 1 min. Other users see the option in the process
    /// list, but not the environment variable.
    #[arg(long, env = "OPENNCK_S7_PASSWORD", hide_env_values = true)]
    pub(super) password: Option<String>,
    /// What needs the password: 1 nothing; 2 stop, restart and setting the clock; 3 also uploading blocks. Reading and writing values never
    /// needs it [default with a password: 2].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=3))]
    pub(super) protection_level: Option<u8>,
    /// Identification of the CPU, as TOML: order_number, version, system_name, module_name, plant, copyright, serial_number, module_type,
    /// location. Missing keys keep their defaults.
    #[arg(long, value_name = "F.toml")]
    pub(super) identity: Option<PathBuf>,
    /// Accepts only connections to rack 0, slot 2 (PLC), 3 or 4 (NCK), as a control does; by default any rack and slot.
    #[arg(long)]
    pub(super) strict_slots: bool,
    /// Largest PDU size to negotiate, from 240 to 960 bytes.
    #[arg(long, value_name = "BYTES", default_value_t = 960, value_parser = clap::value_parser!(u16).range(240..=960))]
    pub(super) pdu: u16,
    /// Idle timeout of a client, for example 30s; clients with subscriptions never time out.
    #[arg(long, value_name = "TIME", default_value = "10min", value_parser = duration)]
    pub(super) idle: Duration,
    /// Serves metrics for Prometheus at http://ADDR:PORT/metrics; a port alone binds to this computer only.
    #[arg(long, value_name = "[ADDR:]PORT", value_parser = address)]
    pub(super) metrics: Option<String>,
    /// Serves the live page at http://ADDR:PORT/: the machine in a browser. A port alone binds to this computer only; from another computer,
    /// writes need the token in the address that is printed at the start.
    #[cfg(feature = "web")]
    #[arg(long, value_name = "[ADDR:]PORT", value_parser = address)]
    pub(super) web: Option<String>,
    /// With --web: a further name of this computer in the address of the page; may be given several times.
    #[cfg(feature = "web")]
    #[arg(long, value_name = "NAME", requires = "web")]
    pub(super) web_host: Vec<String>,
    /// Serves OPC UA at opc.tcp://ADDR:PORT, with the node ids of a SINUMERIK: for example 127.0.0.1:4840. A port alone binds to this computer
    /// only.
    #[cfg(feature = "opcua")]
    #[arg(long, value_name = "[ADDR:]PORT", value_parser = address)]
    pub(super) opcua: Option<String>,
    /// With --opcua: the folder with the certificate of the server, its private key, and the certificates of the clients that it trusts; it
    /// is filled at the first start. Clients can then connect with encryption, also from other computers.
    #[cfg(feature = "opcua")]
    #[arg(long, value_name = "DIR", requires = "opcua")]
    pub(super) opcua_pki: Option<PathBuf>,
    /// With --opcua: clients on other computers may connect without encryption.
    #[cfg(feature = "opcua")]
    #[arg(long, requires = "opcua")]
    pub(super) opcua_insecure: bool,
    /// With --opcua: a user and its rights, as panel:StateRead;PlcRead;PlcWrite or admin:SinuReadAll;SinuWriteAll; may be given several times.
    ///
    /// The password of the user `panel` is the environment variable OPENNCK_OPCUA_PASSWORD_panel. Without users, every client has all rights.
    #[cfg(feature = "opcua")]
    #[arg(long, value_name = "NAME:RIGHTS", requires = "opcua")]
    pub(super) opcua_user: Vec<String>,
    /// Also logs the writes of clients: client, address, value.
    #[arg(long)]
    pub(super) log_writes: bool,
    /// Maximum number of clients at the same time; further clients are rejected.
    #[arg(long, value_name = "N", default_value_t = Limits::default().clients, value_parser = clients)]
    pub(super) clients: usize,
    /// Writes the network traffic as a capture (pcap) for Wireshark; an existing file is refused.
    ///
    /// The server's port is written as 102, which Wireshark recognises as S7 communication. The capture ends at 1 GiB or when the disk is
    /// full; the server keeps running.
    #[arg(long, value_name = "F.pcap")]
    pub(super) pcap: Option<PathBuf>,
    /// Injects faults for tests of operator panels, for example delay=10ms..80ms,drop=1%,error=1/200.
    ///
    /// delay=TIME or TIME..TIME: delays answers. Requests that arrive together are delayed together; the order is kept.
    /// drop=CHANCE: drops an answer; the request is executed.
    /// close=CHANCE: closes the connection instead of answering; the request is executed.
    /// error=CHANCE: refuses a read or write request without executing it; each item gets return code 0A.
    /// code=05: another return code for error; code=8104 (four digits): an error of the whole request instead.
    /// seed=N: seed of the random numbers, default 1. The same clients with the same requests in the same order get the same faults.
    #[arg(long, value_name = "FAULTS", verbatim_doc_comment)]
    pub(super) s7_fault: Option<Faults>,
}

impl Arguments {
    /// Opens the machine.
    pub(super) fn open(&self, programs: &Programs, output: &mut Output) -> Result<Opened, Problem> {
        let plc_image = self.plc_image.as_deref().map(image).transpose()?;
        let opening = Opening {
            machine: self.machine.as_deref(),
            scenario: self.scenario.as_deref(),
            case: self.case.as_deref(),
            plc: self.plc.as_deref(),
            plc_image: plc_image.as_deref(),
            profile: self.profile.as_deref(),
        };
        opening.open(programs, &mut |warning| output.warning(warning))
    }

    /// The options of the S7 server.
    pub(super) fn server_options(&self, machine: &Machine) -> Result<LiveServerOptions, Problem> {
        let protected = self.protect.iter().map(|text| protected(text, machine)).collect::<Result<_, _>>()?;
        let identity = self.identity.as_deref().map(OwnIdentity::read).transpose()?.unwrap_or_default();
        let protection = protection(self.password.as_deref().filter(|text| !text.is_empty()), self.protection_level)?;
        // The connection type, then rack and slot.
        let slots = || (0..=u8::MAX).flat_map(|kind| [[kind, 2], [kind, 3], [kind, 4]]).collect();
        Ok(LiveServerOptions {
            is_read_only: self.read_only,
            limits: Limits {
                clients: self.clients,
                networks: self.allow.clone(),
                idle: self.idle,
                ..Limits::default()
            },
            settings: Settings { longest_pdu: self.pdu, called: self.strict_slots.then(slots), ..Settings::default() },
            faults: self.s7_fault.clone(),
            capture: self.pcap.clone(),
            terms: Terms { protected, protection, identity },
            metrics: self.metrics.clone(),
        })
    }

    /// The warning for a server that any computer in the network can reach and write.
    pub(super) fn warning(&self, addresses: &[SocketAddr]) -> Option<String> {
        let open = addresses.iter().find(|address| !address.ip().to_canonical().is_loopback())?;
        (!self.read_only && self.allow.is_empty()).then(|| {
            format!(
                "anyone who can reach {open} can write: S7 communication is not encrypted\n  \
                restrict the networks (--allow 192.168.0.0/24), or allow reading only (--read-only)"
            )
        })
    }
}

/// A PLC image: a file, or a name in `plc_images` of this folder or a parent folder.
fn image(name: &str) -> Result<PathBuf, Problem> {
    if name.ends_with(".toml") {
        return Ok(PathBuf::from(name));
    }
    let file = Path::new("plc_images").join(format!("{name}.toml"));
    let here = std::env::current_dir().unwrap_or_default();
    let found = here.ancestors().map(|directory| directory.join(&file)).find(|file| file.is_file());
    found.ok_or_else(|| {
        Problem::new(
            format!("PLC image not found: plc_images/{name}.toml in this folder or a parent folder"),
            "give a file that ends in .toml, or start in the folder with plc_images",
        )
    })
}

/// An address and a port, or a port of this computer.
fn address(text: &str) -> Result<String, Infallible> {
    Ok(if text.parse::<u16>().is_ok() { format!("127.0.0.1:{text}") } else { text.to_owned() })
}

fn clients(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|clients| *clients > 0).ok_or_else(|| "expected a number of at least 1".to_owned())
}
