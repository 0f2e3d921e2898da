//! OVERLAY: the DRF offset, a movement by a handwheel beside that of a program.
//!
//! Called once per cycle after all setpoints. Reads DB21.DBX0.3 (activate DRF), the handwheels of the axis (DBX4.0 to 4.2, or the selection of
//! the HMI) and its machine function (DBX5.0 to 5.5). Writes the offset of each axis, and with it DBX64.0 to 64.2, 64.6 and 64.7.
//!
//! The offset is no part of the coordinates in which a program moves: machine coordinates are those of the program plus the offset. So a
//! program goes on unchanged while an operator moves its axis aside, and everything that compares positions of one coordinate system
//! (position control, gantry differences, exact stop) does not see it.
//!
//! `state.rs` contains the offset of an axis, `drf.rs` is the stage.

pub(super) mod by_handwheel;
pub(super) mod drf;
pub(super) mod state;
