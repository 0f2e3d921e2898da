//! SINGLE AXES: an axis that is positioned alone, by the PLC (FC 18, SpinCtrl) or by a synchronised action, beside the path of its channel.
//!
//! | file | what |
//! |---|---|
//! | `state.rs` | an order, how it ends, and the control of the PLC over the axis (28.x) |
//! | `orders.rs` | the start of the PLC (DB31.DBB32 to 43), and what refuses it: error numbers, 20070, 20071 |
//! | `spindles.rs` | position, rotate and oscillate a spindle by the PLC; 22297 |
//! | `independence.rs` | 28.7, 28.6, 28.2, 28.1 and 63.x: the axis is taken out of the stop and the reset of its channel |
//! | `motion.rs` | the stage: holds, stops, the way to the target, the end |
//!
//! Called once per cycle after the programs. An order commands the setpoint of the leading axis of its unit, as a program does, and the
//! synchronous axes follow (MIS-04). Nothing here changes the mode: an order runs in every mode.
//!
//! # Choices where the manuals leave one
//!
//! * FC 18 needs bytes of its own in DB31, which the list manual does not name: DBB32 to 43 to the NCK, DBB104 to 107 back, in the form that the
//!   828D has at DB380x.DBB3000 and DB390x.DBB3000.
//! * Start = 0 before the target is reached stops the axis on its ramp and drops the rest.
//! * An order is over, with error 115, when RESET, emergency stop, an alarm that stops, a lost enable, a hardware limit switch or the fast stop 20.1
//!   stops the axis. Feed stop, feed disable, an override of 0 %, NC stop axes plus spindles (7.4) and an enable that is not there yet only hold
//!   it.
//! * 28.7 acts on any axis that leads a unit, when no block of a program uses it.
//! * Functions 7 and 8 move as 5 and 6: without handwheel override.

pub(super) mod independence;
pub(super) mod motion;
pub(super) mod orders;
pub(super) mod spindles;
pub(super) mod state;
