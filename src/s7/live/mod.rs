//! The S7 server of a live machine. It connects through a [`live::Handle`](crate::live::Handle) and uses nothing else of
//! [`live`](crate::live).
//!
//! A test of an operator panel can run a machine and its server in its own process:
//!
//! ```
//! use opennck::live::{Live, Speed};
//! use opennck::machine::Machine;
//! use opennck::s7::live::LiveServer;
//! use opennck::s7::server::Limits;
//!
//! let live = Live::start(Machine::open("g1_example")?, Speed::default());
//! let server = LiveServer::open(&live, &["127.0.0.1:0"], false, Limits::default())?;
//! let port = server.addresses()[0].port(); // for the client
//! assert!(port > 0 && live.with(|machine| machine.axis("X").is_some()));
//! # Ok::<(), opennck::source::Problem>(())
//! ```

mod clock;
mod identity;
mod lender;
mod live_server;
mod metrics;
mod protect;
mod terms;

pub use identity::OwnIdentity;
pub use live_server::{LiveServer, LiveServerOptions};
pub use protect::{protected, protection};
pub use terms::Terms;
