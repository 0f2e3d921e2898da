//! The arguments of `opennck serve`: what is served, and to whom.

use std::convert::Infallible;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::cli::output::Output;
use crate::live::{Opened, Opening, Speed};
use crate::machine::Machine;
use crate::plc::Programs;
use crate::s7::Settings;
use crate::s7::live::{OwnIdentity, Terms, WindowOptions, protected, protection};
use crate::s7::server::{Faults, Limits, Network};
use crate::source::Problem;
use crate::units::Time;

/// What is served, and to whom.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// A directory, an archive file, or the name of a built-in machine; without one, that of the scenario.
    #[arg(required_unless_present = "scenario")]
    pub(super) machine: Option<PathBuf>,
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
    /// The PLC program is in another process, which maps this file; the file is created where it does not exist.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["plc", "record"])]
    pub(super) image: Option<PathBuf>,
    /// With --image: each scan waits for the answer of the PLC process, and the first step for a process that opens the file.
    ///
    /// So the same PLC program gives the same trace, to the byte, whenever it is started. What clients write until then acts at the
    /// edge of the first step.
    #[arg(long, requires = "image")]
    pub(super) lock_step: bool,
    /// With --image: how long the PLC process may be silent before the PLC counts as stopped, alarm 2000; in lock-step from when it has
    /// opened the file, else from its first answer.
    #[arg(long, value_name = "TIME", requires = "image", default_value = "1s", value_parser = duration)]
    pub(super) plc_timeout: Duration,
    /// Memory of the PLC beside the interface: a file (*.toml), or a name in `plc_images` here or above.
    #[arg(long, value_name = "NAME|FILE")]
    pub(super) plc_image: Option<String>,
    /// From which networks clients may come, for example 192.168.0.0/24; it may be given several times.
    #[arg(long, value_name = "NET")]
    pub(super) allow: Vec<Network>,
    /// Writes down what clients do as a scenario: `opennck run F.toml` does the same again, to the byte.
    ///
    /// Each write stands there with its cycle, in order. The file is a whole scenario at any moment; an end without warning loses
    /// a second at most. A file that exists is refused. Not with --image: what another process does cannot be run again.
    #[arg(long, value_name = "F.toml", conflicts_with = "image")]
    pub(super) record: Option<PathBuf>,
    /// A scenario acts on the machine in real time, while clients are connected.
    ///
    /// Its machine, PLC program and image are served, with its profile and its plant; what the command line names counts instead. A step
    /// that fails is logged and ends the scenario; serving goes on, as it does when the scenario is over. A recording has what the
    /// scenario did, too.
    #[arg(long, value_name = "F.toml")]
    pub(super) scenario: Option<PathBuf>,
    /// Writes the trace as JSON lines when it ends; it is kept in memory until then.
    #[arg(long, value_name = "F.jsonl")]
    pub(super) trace: Option<PathBuf>,
    /// Under which numbers the interface blocks are known: 840d_sl (DB10, DB11, DB21..., DB31...) or 828d (DB1800, DB3800...);
    /// 840d_sl unless a scenario says another.
    #[arg(long, value_name = "PROFILE")]
    pub(super) profile: Option<String>,
    /// What clients may not write; it may be given several times.
    ///
    /// Blocks: DB21, DB21..30. Bytes: DB1000.DBB0..99, DB1000.DBW4, MB0..99, IB0, T0..9. Areas: I, Q, M, T, C. nck: all NC
    /// variables, machine data among them. A write there has return code 03, other items of its request are not affected.
    #[arg(long, value_name = "ADDRESS")]
    pub(super) protect: Vec<String>,
    /// The password of the CPU, up to eight characters; other users see arguments in the list of processes, and not the variable.
    #[arg(long, env = "OPENNCK_S7_PASSWORD", hide_env_values = true)]
    pub(super) password: Option<String>,
    /// What needs the password: 1 nothing; 2 stop, restart, the clock; 3 uploading blocks, too. Values are read and written without it. With
    /// a password 2 unless said.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=3))]
    pub(super) protection_level: Option<u8>,
    /// What the CPU says of itself, as TOML: order_number, version, system_name, module_name, plant, copyright, serial_number,
    /// module_type, location; what is not there stays as it is.
    #[arg(long, value_name = "F.toml")]
    pub(super) identity: Option<PathBuf>,
    /// Accepts connections to rack 0, slot 2 (PLC), 3 and 4 (NCK) only, as a control does; without it to any rack and slot.
    #[arg(long)]
    pub(super) strict_slots: bool,
    /// The longest PDU that is agreed, from 240 to 960 bytes.
    #[arg(long, value_name = "BYTES", default_value_t = 960, value_parser = clap::value_parser!(u16).range(240..=960))]
    pub(super) pdu: u16,
    /// How long a client may ask nothing, for example 30s; who waits for values that change is not meant.
    #[arg(long, value_name = "TIME", default_value = "10min", value_parser = duration)]
    pub(super) idle: Duration,
    /// Counters for Prometheus at http://ADDR:PORT/metrics; a port alone is of this computer only.
    #[arg(long, value_name = "[ADDR:]PORT", value_parser = address)]
    pub(super) metrics: Option<String>,
    /// Logs what clients write, too: who, where, what.
    #[arg(long)]
    pub(super) log_writes: bool,
    /// How many clients may be there at once; one more is sent away.
    #[arg(long, value_name = "N", default_value_t = Limits::default().clients, value_parser = clients)]
    pub(super) clients: usize,
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
    /// What is served.
    pub(super) fn open(&self, programs: &Programs, output: &mut Output) -> Result<Opened, Problem> {
        let plc_image = self.plc_image.as_deref().map(image).transpose()?;
        let opening = Opening {
            machine: self.machine.as_deref(),
            scenario: self.scenario.as_deref(),
            plc: self.plc.as_deref(),
            plc_image: plc_image.as_deref(),
            profile: self.profile.as_deref(),
        };
        opening.open(programs, &mut |warning| output.warning(warning))
    }

    /// On which terms S7 clients are served.
    pub(super) fn window(&self, machine: &Machine) -> Result<WindowOptions, Problem> {
        let protected = self.protect.iter().map(|text| protected(text, machine)).collect::<Result<_, _>>()?;
        let identity = self.identity.as_deref().map(OwnIdentity::read).transpose()?.unwrap_or_default();
        let protection = protection(self.password.as_deref().filter(|text| !text.is_empty()), self.protection_level)?;
        // The kind of connection, and rack and slot.
        let slots = || (0..=u8::MAX).flat_map(|kind| [[kind, 2], [kind, 3], [kind, 4]]).collect();
        Ok(WindowOptions {
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

    /// What to say where everybody may come and write.
    pub(super) fn warning(&self, addresses: &[SocketAddr]) -> Option<String> {
        let open = addresses.iter().find(|address| !address.ip().to_canonical().is_loopback())?;
        (!self.read_only && self.allow.is_empty()).then(|| {
            format!(
                "whoever can reach {open} can write: S7 communication knows no encryption\n  \
                let in whom you know (--allow 192.168.0.0/24), or allow reading only (--read-only)"
            )
        })
    }
}

/// A PLC image: a file, or a name that is looked for in `plc_images` here or above.
fn image(name: &str) -> Result<PathBuf, Problem> {
    if name.ends_with(".toml") {
        return Ok(PathBuf::from(name));
    }
    let file = Path::new("plc_images").join(format!("{name}.toml"));
    let here = std::env::current_dir().unwrap_or_default();
    let found = here.ancestors().map(|directory| directory.join(&file)).find(|file| file.is_file());
    found.ok_or_else(|| {
        Problem::new(
            format!("expected a PLC image, found no plc_images/{name}.toml here or above"),
            "name a file that ends in .toml, or start where plc_images is",
        )
    })
}

/// `30s`, `10min`.
fn duration(text: &str) -> Result<Duration, String> {
    Time::parse(text)
        .map(|time| Duration::from_nanos(time.nanos().unsigned_abs()))
        .filter(|time| !time.is_zero())
        .ok_or_else(|| format!("expected a time such as 500ms, 30s or 10min, found {text}"))
}

/// An address and a port, or a port of this computer.
fn address(text: &str) -> Result<String, Infallible> {
    Ok(if text.parse::<u16>().is_ok() { format!("127.0.0.1:{text}") } else { text.to_owned() })
}

fn clients(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|clients| *clients > 0).ok_or_else(|| "expected a number from 1".to_owned())
}
