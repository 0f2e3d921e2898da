//! FUNCTION GENERATOR: a start-up function that adds a signal to the setpoints of an axis (MIS-09).
//!
//! The operator gives a signal for an axis; the control keeps it until power on. NC start in JOG (DB21.DBX7.1) starts all signals of the
//! channel. Each axis asks for travel (DB31.DBX61.0), and when the PLC has answered on all of them (DB31.DBX1.0) the signal begins: with the
//! first amplitude on the leading axis, with the second one on the synchronous axes of its grouping. A signal for a synchronous axis is refused
//! with `function-generator-synchronous-axis`, and one for an axis that moves or is not in position control with
//! `function-generator-not-possible`; the other signals start all the same.
//!
//! Choices where the manuals leave one (K-30). The signal is added to the position setpoint, at most at MD32000 of the slowest axis of the
//! unit; the override does not act. It ends by its time, RESET, another mode, an alarm that stops, a limit switch, 1.3, 20.1, a lost enable or
//! 1.0 = 0, and then returns to 0 in the same way. Without position control it is dropped where it is. On a software limit of the leading axis
//! the signal stands still, for the coupled axes in the same proportion. Signals of measuring functions are those of the function generator.
//!
//! `state.rs` contains the signals (what an axis has of them is in `axis/test_travel.rs`), `start.rs` is the command and NC start, `signal.rs` the stage.

mod signal;
mod start;
pub(super) mod state;
