//! The S7 server of a live machine: one thread serves all clients. `lender.rs` has their access to the machine.

use std::io;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;

use tokio::runtime::{Builder, Runtime};
use tokio::sync::watch;
use tokio::task::JoinSet;

use super::lender::Lender;
use super::metrics;
use super::terms::Terms;
use crate::live::{Handle, Live};
use crate::s7::Settings;
use crate::s7::server::{Capture, Counters, Faults, Instruments, Limits, Server, listen};
use crate::source::Problem;

/// An S7 server of a live machine; it runs until it is dropped.
#[derive(Debug)]
pub struct LiveServer {
    server: Arc<Server<Lender>>,
    addresses: Vec<SocketAddr>,
    metrics_addresses: Vec<SocketAddr>,
    end: watch::Sender<bool>,
    thread: Option<JoinHandle<()>>,
}

/// Options of the server.
#[derive(Debug, Default)]
pub struct LiveServerOptions {
    /// Clients may not change anything.
    pub is_read_only: bool,
    /// The number of clients, their networks, and time limits.
    pub limits: Limits,
    /// The settings of each connection.
    pub settings: Settings,
    /// Injected faults.
    pub faults: Option<Faults>,
    /// The file for the capture of all network traffic; it must not exist yet.
    pub capture: Option<PathBuf>,
    /// Protected addresses, functions that need a password, and the identification of the CPU.
    pub terms: Terms,
    /// The address for the metrics of Prometheus.
    pub metrics: Option<String>,
}

impl LiveServer {
    /// Opens a server on addresses such as `127.0.0.1:10102`, `[::1]:10102` or `localhost:10102`. Port 0 selects a free
    /// port.
    ///
    /// # Errors
    /// An address is invalid, does not belong to this computer, may not be used, or is in use.
    pub fn open(live: &Live, addresses: &[&str], is_read_only: bool, limits: Limits) -> Result<Self, Problem> {
        Self::open_with(live, addresses, LiveServerOptions { is_read_only, limits, ..LiveServerOptions::default() })
    }

    /// Opens a server with options.
    ///
    /// # Errors
    /// As [`LiveServer::open`].
    pub fn open_with(live: &Live, addresses: &[&str], options: LiveServerOptions) -> Result<Self, Problem> {
        // In a separate thread: a runtime cannot be entered from within another one, and tests of clients have one.
        std::thread::scope(|scope| {
            let opening = scope.spawn(|| Self::open_here(&live.handle(), addresses, options));
            opening.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        })
    }

    fn open_here(live: &Handle, addresses: &[&str], options: LiveServerOptions) -> Result<Self, Problem> {
        let LiveServerOptions { is_read_only, mut limits, settings, faults, capture, terms, metrics } = options;
        // At low speed a step takes long, and so does the acknowledgement of a write.
        limits.step = limits.step.max(2 * live.cycle());
        let connections = u16::try_from(limits.clients).unwrap_or(u16::MAX);
        let runtime = Builder::new_current_thread().enable_all().build().map_err(|error| {
            Problem::new(
                format!("the server cannot start: {error}"),
                "close other programs: the system has no free file handles",
            )
        })?;
        let mut listeners = Vec::new();
        for address in addresses {
            let opened = runtime.block_on(listen(address)).map_err(|error| cannot_listen("--s7", address, &error))?;
            listeners.extend(opened);
        }
        let addresses = listeners.iter().filter_map(|listener| listener.local_addr().ok()).collect();
        let for_metrics = match &metrics {
            Some(address) => {
                runtime.block_on(listen(address)).map_err(|error| cannot_listen("--metrics", address, &error))?
            }
            None => Vec::new(),
        };
        let metrics_addresses = for_metrics.iter().filter_map(|listener| listener.local_addr().ok()).collect();
        // The capture file is created last, when nothing else can fail.
        let capture = capture.as_deref().map(captured).transpose()?;
        let networks = limits.networks.clone();
        let lender = Lender::new(live.clone(), is_read_only, connections, terms);
        let server = Arc::new(Server::new(lender, settings, limits).with(Instruments { faults, capture }));
        for listener in for_metrics {
            let (live, server) = (live.clone(), Arc::clone(&server));
            let text = move || metrics::text(&live, server.clients(), server.counters());
            runtime.spawn(metrics::serve(listener, networks.clone(), text));
        }
        let (end, ended) = watch::channel(false);
        let served = Arc::clone(&server);
        let thread = std::thread::spawn(move || serve(&runtime, &served, listeners, &ended));
        Ok(Self { server, addresses, metrics_addresses, end, thread: Some(thread) })
    }

    /// The addresses of the S7 server.
    #[must_use]
    pub fn addresses(&self) -> &[SocketAddr] {
        &self.addresses
    }

    /// The addresses at which `/metrics` can be scraped.
    #[must_use]
    pub fn metrics_addresses(&self) -> &[SocketAddr] {
        &self.metrics_addresses
    }

    /// The number of connected clients.
    #[must_use]
    pub fn clients(&self) -> usize {
        self.server.clients()
    }

    /// The number of answers so far.
    #[must_use]
    pub fn answers(&self) -> u64 {
        self.server.counters().answers.get()
    }

    /// The counters of the server.
    #[must_use]
    pub fn counters(&self) -> &Counters {
        self.server.counters()
    }
}

impl Drop for LiveServer {
    fn drop(&mut self) {
        self.end.send_replace(true);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Runs a server on all its listeners until the end.
fn serve(
    runtime: &Runtime,
    server: &Arc<Server<Lender>>,
    listeners: Vec<tokio::net::TcpListener>,
    ended: &watch::Receiver<bool>,
) {
    runtime.block_on(async {
        let mut running = JoinSet::new();
        for listener in listeners {
            let mut ended = ended.clone();
            let end = async move {
                let _ = ended.wait_for(|ended| *ended).await;
            };
            running.spawn(Arc::clone(server).run(listener, end));
        }
        while running.join_next().await.is_some() {}
    });
}

fn captured(path: &Path) -> Result<Capture, Problem> {
    Capture::create(path).map_err(|error| {
        Problem::new(
            format!("--pcap {}: cannot create the file: {error}", path.display()),
            "choose a file that does not exist yet, in an existing folder",
        )
    })
}

fn cannot_listen(option: &str, address: &str, error: &io::Error) -> Problem {
    let (what, cure) = match error.kind() {
        io::ErrorKind::AddrInUse => (
            "the port is in use".to_owned(),
            "end the program that uses it, or choose another port, for example 127.0.0.1:10103",
        ),
        io::ErrorKind::PermissionDenied => (
            "the port needs administrator rights".to_owned(),
            "choose a port of 1024 or above, for example 10102, or run as administrator (port 102)",
        ),
        io::ErrorKind::AddrNotAvailable => (
            "the address does not belong to this computer".to_owned(),
            "use 127.0.0.1 for clients on this computer only, or 0.0.0.0 for clients in the network",
        ),
        _ => (
            format!("cannot open this address and port: {error}"),
            "write it as 127.0.0.1:10102, [::1]:10102 or localhost:10102",
        ),
    };
    Problem::new(format!("{option} {address}: {what}"), cure)
}
