//! Tests of a machine in real time, `opennck serve`: its clients over TCP, a PLC in another process, recordings.
//!
//! Separate from `tests/machine`, which keeps all processors busy: the tests here wait for real time.
#![cfg(all(feature = "cli", feature = "s7"))]

mod another_server;
mod clients;
mod lying_proxy;
mod mapped_image;
#[cfg(feature = "web")]
mod openapi;
#[path = "../processes/mod.rs"]
mod processes;
mod program;
mod record;
mod s7_client;
mod s7_command;
mod s7_safety;
mod s7_server;
mod step7;
#[cfg(feature = "web")]
mod web;
