//! The tests of this crate are the example: `tests/gantry.rs`.
