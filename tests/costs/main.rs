//! Tests of what things cost: heap allocations of a step, memory of a client.
//!
//! A binary of its own because its allocator counts, and because it measures its own process.

mod allocation;
#[cfg(all(feature = "cli", feature = "s7"))]
#[path = "../serve/clients.rs"]
mod clients;
mod many_clients;
