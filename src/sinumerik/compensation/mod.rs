//! COMPENSATIONS: backlash, leadscrew error, sag and temperature of an axis (function manual K3).
//!
//! | compensation | machine data | active | acts on |
//! |---|---|---|---|
//! | backlash | MD32450, MD32452, MD32454 | the encoder is referenced | actual value |
//! | leadscrew error | MD32700, `$AA_ENC_COMP` | the encoder is referenced | actual value |
//! | sag | MD32710, MD32720, MD32730, SD41300, SD41310, `$AN_CEC` | the axis is referenced; a gantry axis: 101.5 = 1 | setpoint |
//! | temperature | MD32750, MD32760, SD43900, SD43910, SD43920 | as sag | setpoint |
//!
//! The stage is called once per interpolation cycle, after all setpoints. It reads setpoints, encoders and references; it writes the
//! compensation values of each axis. `state.rs` contains the values, `targets.rs` calculates what they should be, `stage.rs` leads them there.
//!
//! Coordinates: the actual value that the control displays, monitors and compares in a gantry grouping is the measured value plus the
//! compensation of the encoder minus the compensation of the setpoint. Position control therefore moves the axis by the compensation of
//! the setpoint, while display, software limits and synchronism difference stay those of the programmed position (K-02).

pub(super) mod stage;
pub(super) mod state;
pub(super) mod targets;
