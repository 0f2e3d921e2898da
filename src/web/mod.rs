//! The live page: a machine in real time in a browser, `opennck serve --web 127.0.0.1:8080`.
//!
//! It is a server beside S7 communication: it reads the copy of the last step, orders through the inbox, and follows the record of all
//! steps. Its files are inside the program, and nothing on the page comes from another server.
//!
//! | path | answer |
//! |---|---|
//! | `/`, `/page/…` | the page |
//! | `/api/openapi.json` | the description of these paths: `docs/openapi.json` |
//! | `/api/catalogue` | what does not change: signals, axes, flowcharts, panel, steps of the scenario, as JSON |
//! | `/api/state` | the machine after its last step, as JSON |
//! | `/api/why?signal=X.…&value=1` | the conditions for this value of a signal, as JSON |
//! | `/api/recording` | everything since power on as a scenario |
//! | `/events` | server-sent events: `snapshot` at the start and after a loss, then `step` with all edges of the steps since the last one |
//! | `POST /api/command` | a verb of a scenario that acts at once, or `pause`, `step`, `speed`, `go_back`; the answer has the cycle in which it acts |
//!
//! A slow client gets a snapshot instead of the events that it missed. The machine waits for no client.
//!
//! `options.rs` and `server.rs` have the options, the thread and the listeners, `connections.rs` the limits of connections, `guard.rs` what
//! a browser must prove, `routes.rs` the paths, `orders.rs` the commands, `hub.rs` the clients of `/events`, `picture.rs` the machine as
//! JSON, `catalogue.rs` what does not change, `why_not.rs` the conditions, `page/` the files of the page.

mod catalogue;
mod connections;
mod guard;
mod hub;
mod options;
mod orders;
mod picture;
mod routes;
mod server;
mod why_not;

pub use options::WebOptions;
pub use server::WebServer;
