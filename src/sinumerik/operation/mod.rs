//! OPERATION: mode groups, channels, emergency stop, and the run-up after power on.
//!
//! The first stages of a cycle: what the PLC asks of the control as a whole.

pub(super) mod emergency_stop;
pub(super) mod modes;
pub(super) mod reset;
pub(super) mod run_up;
pub(super) mod state;
