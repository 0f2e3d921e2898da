//! SPINDLES: axes with MD35000 above 0. A spindle turns in speed control until a program positions it.
//!
//! Programs give M3, M4, M5 and S as auxiliary functions; the spindle acts when the PLC has acknowledged them (MD22080 bit 4). In each cycle
//! the stage "referencing and gantry" calls [`State::run_spindle`](crate::sinumerik::state::State::run_spindle) instead of the decisions about
//! an axis. It reads the signals of the spindle (DB31.DBB16 to 19, 1.7, 2.2, 3.6, 4.3 to 4.7) and commands a speed. Position control passes
//! that speed on to the drive, and the setpoint stays with the actual value.
//!
//! | file | what |
//! |---|---|
//! | `state.rs` | the state of a spindle |
//! | `control_loop.rs` | speed control and position control of the axis |
//! | `functions.rs` | auxiliary functions of programs: what is shown in DBW86 and DBD88, and what acts after the acknowledgement |
//! | `turning.rs` | the speed in a cycle: override, limits, what holds it; keys in JOG; the zero mark |
//! | `stops.rs` | what ends the turning: RESET, the end of a program, alarms, spindle reset; NC stop axes plus spindles |
//! | `gear.rs` | M40 to M45: the dialogue of a gear change with the PLC, oscillation |
//! | `oscillation.rs` | oscillation by the PLC |
//! | `positioning.rs`, `target.rs` | SPOS, SPOSA, M19, WAITS, M70; the next position of an angle |
//! | `waiting.rs` | the path waits for the speed (MD35500) |
//!
//! # Choices where the manuals leave one
//!
//! * S-01: the travel commands 64.6 and 64.7 are output while a speed is commanded, so that a PLC program can enable the spindle because of them.
//! * S-02: a spindle in speed control does not count for the states of its channel (35.5, 36.3).
//! * S-03: alarms that only stop the program leave a spindle turning; those that make channel, mode group or NC not ready end its function.
//! * S-05: a missing controller enable brakes the spindle without alarm 21612, and it accelerates again with the enable.

mod control_loop;
pub(super) mod functions;
pub(super) mod gear;
mod oscillation;
pub(super) mod positioning;
pub(super) mod state;
pub(super) mod stops;
mod target;
pub(super) mod turning;
pub(super) mod waiting;
