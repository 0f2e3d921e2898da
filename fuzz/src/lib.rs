//! Shared by the fuzz targets and `tests/hostile/corpus.rs`: a conversation with a session of S7 communication, an oracle that judges its
//! answers, a grammar of requests, NC programs of both controls, and parameter lists.

pub mod client;
pub mod conversation;
pub mod grammar;
pub mod isg_lists;
pub mod isg_program;
pub mod nc_program;
pub mod oracle;
