//! Shared by the fuzz targets and `tests/hostile/corpus.rs`: a conversation with a session of S7 communication, an oracle that judges its
//! answers, a grammar of requests, and NC programs.

pub mod client;
pub mod conversation;
pub mod grammar;
pub mod nc_program;
pub mod oracle;
