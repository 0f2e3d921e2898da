//! The server: one thread serves all clients.

use std::io;
use std::net::{SocketAddr, TcpListener, ToSocketAddrs};
use std::path::Path;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use opcua::crypto::SecurityPolicy;
use opcua::server::diagnostics::DiagnosticsNodeManagerBuilder;
use opcua::server::node_manager::memory::{CoreNodeManagerBuilder, InMemoryNodeManagerBuilder};
use opcua::server::node_manager::{NodeManagerBuilder, ServerContext};
use opcua::server::{
    ANONYMOUS_USER_TOKEN_ID, Limits, OperationalLimits, Server, ServerBuilder, ServerEndpoint, ServerHandle,
    SubscriptionLimits,
};
use opcua::types::{BuildInfo, MessageSecurityMode};
use tokio::runtime::{Builder, Runtime};
use tokio::time::MissedTickBehavior;

use super::certificates;
use super::door::Door;
use super::manager::Manager;
use super::options::OpcUaOptions;
use super::spaces::{CNC_URI, URI};
use crate::live::Live;
use crate::source::Problem;

/// How often the steps of the machine are compared.
const PERIOD: Duration = Duration::from_millis(5);
/// How often refused certificates are reported.
const LOOK: Duration = Duration::from_secs(1);
/// The time that clients get to say goodbye.
const GOODBYE: Duration = Duration::from_millis(200);
/// The identification of this application, namespace 1.
const APPLICATION: &str = "urn:opennck";

/// The OPC UA server of a live machine; it runs until it is dropped.
#[derive(Debug)]
pub struct OpcUaServer {
    addresses: Vec<SocketAddr>,
    is_plain: bool,
    is_encrypted: bool,
    end: ServerEnd,
    thread: Option<JoinHandle<()>>,
}

/// Ends the server.
struct ServerEnd(ServerHandle);

impl std::fmt::Debug for ServerEnd {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("ServerEnd")
    }
}

impl OpcUaServer {
    /// Opens the server.
    ///
    /// # Errors
    /// The address is invalid, does not belong to this computer, is not on loopback, may not be used, or is in use.
    pub fn open(live: &Live, options: OpcUaOptions) -> Result<Self, Problem> {
        let address = options.address.clone();
        let cannot = |error: io::Error| cannot_listen(&address, &error);
        let resolved = address.to_socket_addrs().map_err(cannot)?.next();
        let resolved = resolved.ok_or_else(|| cannot(io::ErrorKind::AddrNotAvailable.into()))?;
        let is_loopback = resolved.ip().to_canonical().is_loopback();
        if !is_loopback && options.pki.is_none() && !options.is_insecure {
            return Err(Problem::new(
                format!("--opcua {address}: OPC UA without encryption is for clients on this computer only"),
                "use 127.0.0.1, give a folder for certificates (--opcua-pki DIR), or accept the risk (--opcua-insecure)",
            ));
        }
        let listener = TcpListener::bind(resolved).map_err(cannot)?;
        listener.set_nonblocking(true).map_err(cannot)?;
        let own = listener.local_addr().map_err(cannot)?;
        let runtime = Builder::new_current_thread().enable_all().build().map_err(cannot)?;
        if let Some(folder) = &options.pki {
            certificates::prepare(folder, APPLICATION, &own.ip().to_string())?;
        }
        let is_plain = options.is_insecure || is_loopback;
        let is_encrypted = options.pki.is_some();
        let options = Arc::new(options);
        let manager = Arc::new(Manager::new(live.handle(), Arc::clone(&options)));
        // The library starts tasks while it is built.
        let entered = runtime.enter();
        let (server, handle) = build(own, &manager, &options, is_plain)
            .map_err(|error| Problem::new(format!("--opcua {address}: {error}"), "please report it"))?;
        drop(entered);
        let ending = handle.clone();
        let thread = std::thread::spawn(move || serve(&runtime, listener, server, &handle, &manager, &options));
        Ok(Self { addresses: vec![own], is_plain, is_encrypted, end: ServerEnd(ending), thread: Some(thread) })
    }

    /// The addresses at which clients can connect.
    #[must_use]
    pub fn addresses(&self) -> &[SocketAddr] {
        &self.addresses
    }

    /// Whether clients can connect without encryption, and with it.
    #[must_use]
    pub fn security(&self) -> (bool, bool) {
        (self.is_plain, self.is_encrypted)
    }
}

impl Drop for OpcUaServer {
    fn drop(&mut self) {
        self.end.0.cancel();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Registers our namespaces first, so that they have the numbers that clients expect, and gives the library our manager.
struct Ours(Arc<Manager>);

impl NodeManagerBuilder for Ours {
    fn build(self: Box<Self>, context: ServerContext) -> Arc<opcua::server::node_manager::DynNodeManager> {
        let mut type_tree = context.type_tree.write();
        for uri in [APPLICATION, URI, CNC_URI] {
            type_tree.namespaces_mut().add_namespace(uri);
        }
        drop(type_tree);
        self.0
    }
}

fn build(
    own: SocketAddr,
    manager: &Arc<Manager>,
    options: &Arc<OpcUaOptions>,
    is_plain: bool,
) -> Result<(Server, ServerHandle), String> {
    let door = Door::new(Arc::clone(manager), Arc::clone(options));
    // The library makes folders for certificates where none are needed. It cannot make them below a file.
    let nowhere = || std::env::current_exe().unwrap_or_default();
    let folder = options.pki.clone().unwrap_or_else(nowhere);
    let mut endpoints = Vec::new();
    if is_plain {
        endpoints.push(("none", SecurityPolicy::None, MessageSecurityMode::None));
    }
    if options.pki.is_some() {
        let encrypted = MessageSecurityMode::SignAndEncrypt;
        endpoints.push(("basic256sha256", SecurityPolicy::Basic256Sha256, encrypted));
        endpoints.push(("aes256", SecurityPolicy::Aes256Sha256RsaPss, encrypted));
    }
    // The library asks for users of its own in each endpoint; the door decides.
    let anonymous = [ANONYMOUS_USER_TOKEN_ID.to_owned()];
    let first = endpoints.first().map_or("none", |(name, ..)| name);
    let mut builder = ServerBuilder::new().default_endpoint(first);
    for (name, policy, mode) in endpoints {
        builder = builder.add_endpoint(name, ServerEndpoint::new("/", policy, mode, &anonymous));
    }
    builder
        .without_node_managers()
        .with_authenticator(Arc::new(door))
        .with_node_manager(Ours(Arc::clone(manager)))
        .with_node_manager(InMemoryNodeManagerBuilder::new(CoreNodeManagerBuilder))
        .with_node_manager(DiagnosticsNodeManagerBuilder)
        .application_name("OpenNCK")
        .application_uri(APPLICATION)
        .product_uri(APPLICATION)
        .build_info(BuildInfo {
            product_uri: APPLICATION.into(),
            manufacturer_name: "OpenNCK".into(),
            product_name: "OpenNCK".into(),
            software_version: env!("CARGO_PKG_VERSION").into(),
            ..BuildInfo::default()
        })
        .host(own.ip().to_string())
        .port(own.port())
        .discovery_urls(vec!["/".to_owned()])
        .create_sample_keypair(false)
        .pki_dir(&folder)
        .certificate_path(certificates::own(&folder))
        .private_key_path(certificates::key(&folder))
        .trust_client_certs(false)
        .subscription_poll_interval_ms(10)
        .limits(limits())
        .build()
}

/// The library's own limits lose edges: see the comments.
fn limits() -> Limits {
    Limits {
        // As many as nodes of a request: the library refuses longer arrays than 1,000.
        max_array_length: 10_000,
        max_sessions: 50,
        subscriptions: SubscriptionLimits {
            // 0 is every edge; the library would raise it.
            min_sampling_interval_ms: 0.0,
            min_publishing_interval_ms: 10.0,
            max_monitored_item_queue_size: 100_000,
            max_monitored_items_per_sub: 10_000,
            // The library drops the oldest ones beyond 20.
            max_queued_notifications: 0,
            max_publish_requests_per_subscription: 10,
            max_pending_publish_requests: 100,
            ..SubscriptionLimits::default()
        },
        operational: OperationalLimits { max_references_per_browse_node: 10_000, ..OperationalLimits::default() },
        ..Limits::default()
    }
}

fn serve(
    runtime: &Runtime,
    listener: TcpListener,
    server: Server,
    handle: &ServerHandle,
    manager: &Manager,
    options: &OpcUaOptions,
) {
    runtime.block_on(async {
        let listener = match tokio::net::TcpListener::from_std(listener) {
            Ok(listener) => listener,
            Err(error) => {
                tracing::error!("OPC UA cannot be served: {error}");
                return;
            }
        };
        let running = server.run_with(listener);
        let mut running = std::pin::pin!(running);
        let mut period = tokio::time::interval(PERIOD);
        period.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let mut looks = tokio::time::interval(LOOK);
        let mut known = options.pki.as_deref().map(certificates::rejected).unwrap_or_default();
        loop {
            tokio::select! {
                ended = &mut running => {
                    if let Err(error) = ended {
                        tracing::error!("the OPC UA server has ended: {error}");
                    }
                    return;
                }
                _ = period.tick() => manager.advance(handle.subscriptions()),
                _ = looks.tick(), if options.pki.is_some() => {
                    let all = options.pki.as_deref().map(certificates::rejected).unwrap_or_default();
                    for file in all.iter().filter(|file| !known.contains(file)) {
                        let trusted = options.pki.as_deref().unwrap_or_else(|| Path::new("")).join("trusted");
                        let (file, trusted) = (file.display(), trusted.display());
                        tracing::info!("OPC UA: refused a client whose certificate is not trusted; to admit it, move {file} to {trusted}");
                    }
                    known = all;
                }
                () = handle.token().cancelled() => break,
            }
        }
        let _ = tokio::time::timeout(GOODBYE, running).await;
    });
}

fn cannot_listen(address: &str, error: &io::Error) -> Problem {
    let (what, cure) = match error.kind() {
        io::ErrorKind::AddrInUse => ("the port is in use", "end the program that uses it, or choose another port"),
        io::ErrorKind::PermissionDenied => {
            ("the port needs administrator rights", "choose a port of 1024 or above, for example 4840")
        }
        io::ErrorKind::AddrNotAvailable => {
            ("the address does not belong to this computer", "use 127.0.0.1 for clients on this computer only")
        }
        _ => ("cannot open this address and port", "write it as 127.0.0.1:4840, [::1]:4840 or localhost:4840"),
    };
    Problem::new(format!("--opcua {address}: {what}"), cure)
}
