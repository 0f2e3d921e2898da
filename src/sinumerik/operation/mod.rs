//! OPERATION: mode groups, channels, emergency stop, and the run-up after power on.
//!
//! The first stages of [`Control::decide`](crate::sinumerik::Control::decide): what the PLC asks of the control as a whole.

pub(super) mod channel;
pub(super) mod emergency_stop;
pub(super) mod mode_group;
pub(super) mod run_up;
