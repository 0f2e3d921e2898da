//! Tests of costs: heap allocations of a step, memory of a client and of a long scenario.
//!
//! These tests are a separate binary because its allocator counts, and because the tests measure their own process.

mod allocation;
#[cfg(all(feature = "cli", feature = "s7"))]
#[path = "../serve/clients.rs"]
mod clients;
mod long_scenario;
mod many_clients;
