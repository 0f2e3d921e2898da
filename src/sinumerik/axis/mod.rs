//! AXIS: the state of one machine axis, and the stages that run for every axis: enabling, measuring systems, parameter sets,
//! limit switches, axis signals, position control.
//!
//! `state.rs` contains the state; the other files are stages, in the order in which a cycle calls them.

pub(super) mod controllers;
pub(super) mod enabling;
pub(super) mod limits;
pub(super) mod parameter_sets;
pub(super) mod position_control;
pub(super) mod shaping;
pub(super) mod signals;
pub(super) mod state;
pub(super) mod test_travel;
pub(super) mod travel;
pub(super) mod traversing;
