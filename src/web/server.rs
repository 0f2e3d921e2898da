//! The server of the page: one thread serves all clients.

use std::io;
use std::net::{SocketAddr, ToSocketAddrs};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use tokio::net::TcpListener;
use tokio::runtime::{Builder, Runtime};
use tokio::sync::oneshot;

use super::connections::{Admits, Doors, Places};
use super::guard::Guard;
use super::hub::Hub;
use super::options::WebOptions;
use super::routes::{Site, router};
use crate::live::Live;
use crate::source::Problem;

/// The server of the page of a live machine; it runs until it is dropped.
#[derive(Debug)]
pub struct WebServer {
    addresses: Vec<SocketAddr>,
    token: Option<String>,
    end: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl WebServer {
    /// Opens the server.
    ///
    /// # Errors
    /// The address is invalid, does not belong to this computer, may not be used, or is in use.
    pub fn open(live: &Live, options: WebOptions) -> Result<Self, Problem> {
        let address = options.address.clone();
        let cannot = |error: io::Error| cannot_listen(&address, &error);
        let mut listeners = Vec::new();
        for address in address.to_socket_addrs().map_err(cannot)? {
            match std::net::TcpListener::bind(address) {
                Ok(listener) => listeners.push(listener),
                // A name can have an address of a protocol that this computer does not have.
                Err(error) if error.kind() == io::ErrorKind::AddrNotAvailable && !listeners.is_empty() => {}
                Err(error) => return Err(cannot(error)),
            }
        }
        let addresses: Vec<_> = listeners.iter().filter_map(|listener| listener.local_addr().ok()).collect();
        let guard = Arc::new(Guard::new(&addresses, &options.hosts));
        let token = guard.token().map(str::to_owned);
        let runtime = Builder::new_current_thread().enable_all().build().map_err(cannot)?;
        let live = live.handle();
        let (end, ended) = oneshot::channel();
        let thread = std::thread::spawn(move || {
            let hub = Arc::new(Hub::new(live, &options));
            let admits = Arc::clone(&options.admits);
            let site =
                Site { hub: Arc::clone(&hub), guard, is_read_only: options.is_read_only, protects: options.protects };
            serve(&runtime, listeners, &admits, hub, site, ended);
        });
        Ok(Self { addresses, token, end: Some(end), thread: Some(thread) })
    }

    /// The addresses at which the page can be opened.
    #[must_use]
    pub fn addresses(&self) -> &[SocketAddr] {
        &self.addresses
    }

    /// The token that writers need; `None` on loopback.
    #[must_use]
    pub fn token(&self) -> Option<&str> {
        self.token.as_deref()
    }
}

impl Drop for WebServer {
    fn drop(&mut self) {
        drop(self.end.take());
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Serves until the end. Open streams are closed: they would never end by themselves.
fn serve(
    runtime: &Runtime,
    listeners: Vec<std::net::TcpListener>,
    admits: &Admits,
    hub: Arc<Hub>,
    site: Site,
    ended: oneshot::Receiver<()>,
) {
    runtime.block_on(async {
        let (places, router) = (Places::default(), router(site));
        for listener in listeners {
            let opened = listener.set_nonblocking(true).and_then(|()| TcpListener::from_std(listener));
            match opened {
                Ok(listener) => {
                    let doors = Doors::new(listener, &places, admits);
                    let router = router.clone();
                    tokio::spawn(async move { axum::serve(doors, router).await });
                }
                Err(error) => tracing::error!("the page cannot be served: {error}"),
            }
        }
        tokio::spawn(hub.follow());
        let _ = ended.await;
        // Clients that are being answered get their answer.
        tokio::time::sleep(Duration::from_millis(20)).await;
    });
}

fn cannot_listen(address: &str, error: &io::Error) -> Problem {
    let (what, cure) = match error.kind() {
        io::ErrorKind::AddrInUse => ("the port is in use", "end the program that uses it, or choose another port"),
        io::ErrorKind::PermissionDenied => {
            ("the port needs administrator rights", "choose a port of 1024 or above, for example 8080")
        }
        io::ErrorKind::AddrNotAvailable => (
            "the address does not belong to this computer",
            "use 127.0.0.1 for browsers on this computer only, or 0.0.0.0 for those in the network",
        ),
        _ => ("cannot open this address and port", "write it as 127.0.0.1:8080, [::1]:8080 or localhost:8080"),
    };
    Problem::new(format!("--web {address}: {what}"), cure)
}
