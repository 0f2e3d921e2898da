//! The host to connect to, and the source of names.

use std::cell::Cell;
use std::path::PathBuf;
use std::time::Duration;

use clap::ValueEnum;
use tokio::time::{Instant, timeout};

use super::failure::Failure;
use crate::controls;
use crate::s7::client::{Client, ConnectionKind, Options, Tsaps, password};
use crate::source::Problem;
use crate::units::Time;

/// The port of S7 communication.
const PORT: u16 = 102;
/// Timeout for an optional request.
const OPTIONAL_TIMEOUT: Duration = Duration::from_secs(1);
/// Time for all optional requests together.
const OPTIONAL_TOTAL: Duration = Duration::from_secs(2);
/// The longest allowed time: one day.
const LONGEST: Time = Time::from_millis(86_400_000);

/// The host and the connection parameters.
#[derive(Debug, clap::Args)]
pub(in crate::cli) struct Host {
    /// Address and port of the module; default port 102 (`opennck serve` uses 10102).
    #[arg(value_name = "HOST[:PORT]")]
    host: String,
    /// Rack of the PLC.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=7))]
    rack: u8,
    /// Slot of the PLC.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u8).range(0..=31))]
    slot: u8,
    /// Connection type to register with the PLC.
    #[arg(long, value_enum, default_value = "pg")]
    connection: Kind,
    /// Calling and called TSAP of the PLC in hexadecimal, instead of rack, slot and connection type: 0100:0102.
    #[arg(long, value_name = "CALLING:CALLED", value_parser = tsaps)]
    tsap: Option<Tsaps>,
    /// Calling and called TSAP of the NCK.
    #[arg(long, value_name = "CALLING:CALLED", value_parser = tsaps, default_value = "0400:0D04")]
    nck_tsap: Tsaps,
    /// Largest PDU size to request, in bytes.
    #[arg(long, value_name = "BYTES", default_value_t = 960, value_parser = clap::value_parser!(u16).range(64..=4096))]
    pdu: u16,
    /// Maximum number of items per request, for servers that accept fewer than fit in a PDU.
    #[arg(long, value_name = "N", default_value_t = 255, value_parser = clap::value_parser!(u8).range(1..))]
    items: u8,
    /// Timeout for an answer. Requests without an answer count together: a silent host ends the command after this time.
    #[arg(long, value_name = "TIME", default_value = "5s", value_parser = duration)]
    timeout: Duration,
    /// Password of the PLC, one to eight ASCII characters; use the environment variable to hide it from other users.
    #[arg(long, value_name = "TEXT", env = "OPENNCK_S7_PASSWORD", hide_env_values = true)]
    password: Option<String>,
    /// The time in which the host did not answer other requests. It counts for the next ones: a silent host ends the command after `timeout`.
    #[arg(skip)]
    waited: Cell<Duration>,
}

/// The names of axes and channels, and the block numbers of the interface.
#[derive(Debug, clap::Args)]
pub(in crate::cli) struct Names {
    /// A directory, an archive file, or the name of a built-in machine, for the names of axes and channels; by default they are read from
    /// the NCK.
    #[arg(long)]
    pub(super) machine: Option<PathBuf>,
    /// Addresses of the signals: 840d_sl, 828d, or none for a PLC that is not part of a control.
    #[arg(long, default_value = controls::default_profile())]
    pub(super) profile: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// Programming device.
    Pg,
    /// Operator panel.
    Op,
    /// S7 basic communication.
    Basic,
}

impl Host {
    /// Address and port.
    pub(super) fn address(&self) -> Result<String, Problem> {
        with_port(&self.host)
    }

    pub(super) async fn plc(&self) -> Result<Client, Failure> {
        let kind = match self.connection {
            Kind::Pg => ConnectionKind::ProgrammingDevice,
            Kind::Op => ConnectionKind::OperatorPanel,
            Kind::Basic => ConnectionKind::Basic,
        };
        let tsaps = self.tsap.unwrap_or_else(|| Tsaps::of(kind, self.rack, self.slot));
        let given = self.password.as_deref().map(|text| {
            password(text).ok_or_else(|| {
                Problem::new(
                    "expected a password of one to eight ASCII characters, found another text",
                    "modules accept no others: check --password and OPENNCK_S7_PASSWORD",
                )
            })
        });
        self.connect(Options { tsaps, password: given.transpose()?, ..self.options() }).await
    }

    pub(super) async fn nck(&self) -> Result<Client, Failure> {
        self.connect(Options { tsaps: self.nck_tsap, ..self.options() }).await
    }

    /// Connects to the NCK for optional requests, with a short timeout.
    pub(super) async fn nck_soon(&self) -> Result<Client, Failure> {
        let timeout = self.half().min(OPTIONAL_TIMEOUT);
        self.connect(Options { tsaps: self.nck_tsap, timeout, ..self.options() }).await
    }

    /// Work that the command can do without: `None` if it fails or takes too long.
    pub(super) async fn optional<T>(&self, work: impl Future<Output = Option<T>>) -> Option<T> {
        self.within(self.half().min(OPTIONAL_TOTAL), work).await
    }

    /// Work without which the command fails with a better message from another request: it leaves time for that one.
    pub(super) async fn answered<T>(&self, work: impl Future<Output = Option<T>>) -> Option<T> {
        self.within(self.half(), work).await
    }

    /// The rest of the time limit.
    fn left(&self) -> Duration {
        self.timeout.saturating_sub(self.waited.get())
    }

    /// Half of it, so that the other half is left.
    fn half(&self) -> Duration {
        self.left() / 2
    }

    async fn within<T>(&self, limit: Duration, work: impl Future<Output = Option<T>>) -> Option<T> {
        let begin = Instant::now();
        let done = timeout(limit, work).await.ok().flatten();
        if done.is_none() {
            self.waited.set(self.waited.get() + begin.elapsed().min(limit));
        }
        done
    }

    fn options(&self) -> Options {
        let (&Self { pdu, items, .. }, timeout) = (self, self.left());
        // The time limit is that of the whole request, whatever happens to its connections.
        Options { pdu, items, timeout, patience: timeout, ..Options::default() }
    }

    async fn connect(&self, options: Options) -> Result<Client, Failure> {
        Ok(Client::connect_after(self.waited.get(), &self.address()?, options).await?)
    }
}

/// `::1` and `[::1]` are addresses without a port.
fn with_port(host: &str) -> Result<String, Problem> {
    if host.parse::<std::net::Ipv6Addr>().is_ok() {
        return Ok(format!("[{host}]:{PORT}"));
    }
    match host.rsplit_once(':') {
        Some((_, port)) if port.parse::<u16>().is_ok_and(|port| port > 0) => Ok(host.to_owned()),
        Some((_, port)) if !host.ends_with(']') => Err(Problem::new(
            format!("expected a port from 1 to 65535, found {port} in {host}"),
            "write it as 192.168.214.1:102, [::1]:10102 or localhost:10102; the default port is 102",
        )),
        _ => Ok(format!("{host}:{PORT}")),
    }
}

fn tsaps(text: &str) -> Result<Tsaps, String> {
    let tsap = |text: &str| (text.len() == 4).then(|| u16::from_str_radix(text, 16).ok()).flatten();
    let both = text.split_once(':').and_then(|(calling, called)| Some((tsap(calling)?, tsap(called)?)));
    let (calling, called) =
        both.ok_or_else(|| format!("expected two TSAPs of four hexadecimal digits such as 0100:0102, found {text}"))?;
    Ok(Tsaps { calling: calling.to_be_bytes(), called: called.to_be_bytes() })
}

/// Parses `100ms`, `1.5s` or `2min`.
pub(super) fn duration(text: &str) -> Result<Duration, String> {
    let wrong = || format!("expected a time such as 100ms, 1.5s or 2min, found {text}");
    // No spaces and no microseconds: network times need neither.
    let is_plain = !text.contains(char::is_whitespace) && !text.ends_with("us");
    let time = is_plain.then(|| Time::parse(text)).flatten().ok_or_else(wrong)?;
    if time == Time::ZERO || time > LONGEST {
        return Err(wrong());
    }
    Ok(Duration::from_nanos(time.nanos().unsigned_abs()))
}

pub(super) fn hexadecimal(text: &str) -> Result<u16, String> {
    let digits = text.strip_prefix("16#").or_else(|| text.strip_prefix("0x")).unwrap_or(text);
    u16::from_str_radix(digits, 16).map_err(|_| format!("expected up to four hexadecimal digits, found {text}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_port_is_added_where_there_is_none() {
        for (host, address) in [
            ("192.168.214.1", "192.168.214.1:102"),
            ("192.168.214.1:10102", "192.168.214.1:10102"),
            ("nck.local", "nck.local:102"),
            ("::1", "[::1]:102"),
            ("[::1]", "[::1]:102"),
            ("[::1]:10102", "[::1]:10102"),
        ] {
            assert_eq!(with_port(host).unwrap(), address);
        }
        for host in ["127.0.0.1:99999", "127.0.0.1:0", "plc:s7", "[::1]:-1"] {
            assert!(with_port(host).is_err(), "{host}");
        }
    }

    /// A silent host: each request that the command can do without takes at most half of the rest, and the last one has what is left.
    #[tokio::test(start_paused = true)]
    async fn all_requests_in_vain_together_take_no_longer_than_the_time_limit() {
        #[derive(clap::Parser)]
        struct Arguments {
            #[command(flatten)]
            host: Host,
        }
        let limits = [("5s", [2000, 1500, 750]), ("300ms", [150, 75, 37])];
        for (timeout, wanted) in limits {
            let Arguments { host } = clap::Parser::parse_from(["read", "plc", "--timeout", timeout]);
            for (number, wanted) in wanted.into_iter().enumerate() {
                let begin = Instant::now();
                let silent = std::future::pending::<Option<()>>();
                let done = if number == 0 { host.optional(silent).await } else { host.answered(silent).await };
                assert!(done.is_none());
                let took = begin.elapsed().as_millis();
                assert!((wanted..wanted + 3).contains(&took), "{timeout}: {took} ms, wanted {wanted} ms");
            }
            assert!(host.waited.get() + host.options().timeout <= host.timeout);
        }
    }

    #[test]
    fn times_have_a_unit() {
        assert_eq!(duration("100ms"), Ok(Duration::from_millis(100)));
        assert_eq!(duration("1.5s"), Ok(Duration::from_millis(1500)));
        for wrong in ["", "5", "0s", "-1s", "1 s", "s", "1e9h", "2days", "5us", "25h"] {
            assert!(duration(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn tsaps_are_hexadecimal() {
        assert_eq!(tsaps("0400:0D04"), Ok(Tsaps { calling: [4, 0], called: [0x0D, 4] }));
        assert!(tsaps("0400").is_err() && tsaps("400:D04").is_err());
    }
}
