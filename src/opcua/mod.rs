//! OPC UA as a SINUMERIK has it: a machine in real time for data collectors and operator panels, `opennck serve --opcua 127.0.0.1:4840`.
//!
//! It is a server beside S7 communication: it reads the copy of the last step, orders through the inbox, and compares every step with the
//! one before for its subscriptions. The node ids are those of Siemens' namespace `SinumerikVarProvider`, which has index 2; the NC
//! variables are those of [`variables::nc`](crate::variables::nc). The machine waits for no client.
//!
//! The formats, sessions and subscriptions are those of the library async-opcua. `node_id.rs` reads ids, `reading.rs` and `writing.rs` have
//! the values and their types, `tree.rs` the nodes that browsing shows, `cnc.rs` the objects of
//! OPC 40502, `attributes.rs` what is asked of a node besides its value,
//! `watching.rs` the subscriptions, `alarms.rs` the events of alarms, `manager.rs` gives all of it to the library. `rights.rs`, `door.rs` and
//! `certificates.rs` decide who may do what. `options.rs` has the options, `server.rs` the limits, the thread and the listener.

mod alarms;
mod attributes;
mod certificates;
mod cnc;
mod door;
mod manager;
mod member;
mod node_id;
mod options;
mod reading;
mod rights;
mod server;
mod spaces;
#[cfg(test)]
mod tests;
mod tree;
mod watching;
mod writing;

pub use options::{OpcUaOptions, Protects, User};
pub use rights::Rights;
pub use server::OpcUaServer;
