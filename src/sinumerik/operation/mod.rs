//! OPERATION: mode groups, channels, emergency stop, and the start-up after power on.
//!
//! The first stages of a cycle: the requests of the PLC to the control as a whole.

pub(super) mod configuration;
pub(super) mod emergency_stop;
pub(super) mod modes;
pub(super) mod reset;
pub(super) mod run_up;
pub(super) mod state;
