//! The S7 server of a live machine: a thread with all its clients. `lender.rs` is what they see.

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

/// An S7 server that shows a live machine until it is dropped.
#[derive(Debug)]
pub struct Window {
    server: Arc<Server<Lender>>,
    addresses: Vec<SocketAddr>,
    metrics_addresses: Vec<SocketAddr>,
    end: watch::Sender<bool>,
    thread: Option<JoinHandle<()>>,
}

/// How a window is opened other than as usual.
#[derive(Debug, Default)]
pub struct WindowOptions {
    /// Clients may change nothing.
    pub is_read_only: bool,
    /// How many clients, from where, and how long anybody may take.
    pub limits: Limits,
    /// What each client is offered.
    pub settings: Settings,
    /// Faults on purpose.
    pub faults: Option<Faults>,
    /// The file in which all that goes over the wire is written; it must not be there yet.
    pub capture: Option<PathBuf>,
    /// What clients may not write, what needs a password, and whom they meet.
    pub terms: Terms,
    /// Where Prometheus finds its metrics.
    pub metrics: Option<String>,
}

impl Window {
    /// Opens a server on addresses such as `127.0.0.1:10102`, `[::1]:10102`, `localhost:10102`; port 0 is any free one.
    ///
    /// # Errors
    /// An address is none, is not of this computer, may not be used, or is in use.
    pub fn open(live: &Live, addresses: &[&str], is_read_only: bool, limits: Limits) -> Result<Self, Problem> {
        Self::open_with(live, addresses, WindowOptions { is_read_only, limits, ..WindowOptions::default() })
    }

    /// The same with more to say.
    ///
    /// # Errors
    /// As [`Window::open`].
    pub fn open_with(live: &Live, addresses: &[&str], options: WindowOptions) -> Result<Self, Problem> {
        // In a thread of its own: a runtime cannot be entered from within another, and tests of clients have one.
        std::thread::scope(|scope| {
            let opening = scope.spawn(|| Self::open_here(&live.handle(), addresses, options));
            opening.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        })
    }

    fn open_here(live: &Handle, addresses: &[&str], options: WindowOptions) -> Result<Self, Problem> {
        let WindowOptions { is_read_only, mut limits, settings, faults, capture, terms, metrics } = options;
        // A slow machine takes up what was written later.
        limits.step = limits.step.max(2 * live.cycle());
        let connections = u16::try_from(limits.clients).unwrap_or(u16::MAX);
        let runtime = Builder::new_current_thread().enable_all().build().map_err(|error| {
            Problem::new(
                format!("the server cannot start: {error}"),
                "close other programs: the system has no handles left",
            )
        })?;
        let mut listeners = Vec::new();
        for address in addresses {
            let opened = runtime.block_on(listen(address)).map_err(|error| closed_door("--s7", address, &error))?;
            listeners.extend(opened);
        }
        let addresses = listeners.iter().filter_map(|listener| listener.local_addr().ok()).collect();
        let for_metrics = match &metrics {
            Some(address) => {
                runtime.block_on(listen(address)).map_err(|error| closed_door("--metrics", address, &error))?
            }
            None => Vec::new(),
        };
        let metrics_addresses = for_metrics.iter().filter_map(|listener| listener.local_addr().ok()).collect();
        // A file is begun when nothing else can stop it.
        let capture = capture.as_deref().map(captured).transpose()?;
        let lender = Lender::new(live.clone(), is_read_only, connections, terms);
        let server = Arc::new(Server::new(lender, settings, limits).with(Instruments { faults, capture }));
        for listener in for_metrics {
            let (live, server) = (live.clone(), Arc::clone(&server));
            let text = move || metrics::text(&live, server.clients(), server.counters());
            runtime.spawn(metrics::serve(listener, text));
        }
        let (end, ended) = watch::channel(false);
        let served = Arc::clone(&server);
        let thread = std::thread::spawn(move || serve(&runtime, &served, listeners, &ended));
        Ok(Self { server, addresses, metrics_addresses, end, thread: Some(thread) })
    }

    /// Where it can be reached.
    #[must_use]
    pub fn addresses(&self) -> &[SocketAddr] {
        &self.addresses
    }

    /// Where Prometheus finds its metrics: at `/metrics` of these.
    #[must_use]
    pub fn metrics_addresses(&self) -> &[SocketAddr] {
        &self.metrics_addresses
    }

    /// How many clients there are now.
    #[must_use]
    pub fn clients(&self) -> usize {
        self.server.clients()
    }

    /// How many answers were given so far.
    #[must_use]
    pub fn answers(&self) -> u64 {
        self.server.counters().answers.get()
    }

    /// What the server counted so far.
    #[must_use]
    pub fn counters(&self) -> &Counters {
        self.server.counters()
    }
}

impl Drop for Window {
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
            format!("--pcap {}: expected a file that can be made anew: {error}", path.display()),
            "name a file that is not there yet, in a folder that is there",
        )
    })
}

fn closed_door(option: &str, address: &str, error: &io::Error) -> Problem {
    let (what, cure) = match error.kind() {
        io::ErrorKind::AddrInUse => (
            "expected a free port, found one in use".to_owned(),
            "end the program that has it, or choose another port, for example 127.0.0.1:10103",
        ),
        io::ErrorKind::PermissionDenied => (
            "expected a port that may be opened, found a protected one".to_owned(),
            "choose a port from 1024 on, as 10102 is; the usual 102 needs the rights of an administrator",
        ),
        io::ErrorKind::AddrNotAvailable => (
            "expected an address of this computer, found another one".to_owned(),
            "127.0.0.1 is this computer only, 0.0.0.0 everybody who can reach it",
        ),
        _ => (
            format!("expected an address and a port, found what cannot be opened: {error}"),
            "write it as 127.0.0.1:10102, [::1]:10102 or localhost:10102",
        ),
    };
    Problem::new(format!("{option} {address}: {what}"), cure)
}
