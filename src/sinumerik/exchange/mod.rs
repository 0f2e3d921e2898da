//! AXIS EXCHANGE: who has an axis (a program of a channel, nobody, the PLC, a synchronised action), in which channel it is, and how that changes.
//!
//! | file | what |
//! |---|---|
//! | `state.rs` | the holder of each axis, and the table of its transitions |
//! | `requests.rs` | requests that wait until an axis is free: those of the PLC (DBB8) and of GETD; refusals (26070, 26072, 10658) |
//! | `programs.rs` | RELEASE, GET, GETD, WAITP, automatic GET, and the return at RESET and at the end of a program |
//! | `status.rs` | what DBB68, 36.3, `$AA_TYP` and `$AA_AXCHANGE_TYP` show |
//!
//! The axes of a closed grouping change together: what happens to the leading axis happens to all of them (MIS-04, MIS-05). The axes of an open
//! grouping are single axes, and closing it compares their states (10658, `gantry/closing.rs`).
//!
//! | by | from | to | when |
//! |---|---|---|---|
//! | RELEASE, WAITP | channel axis | neutral | at the end of the block |
//! | GET, automatic GET | neutral, or command axis at rest | channel axis | at once; it waits for an axis that another channel has |
//! | GETD | channel axis of another channel | channel axis | when no block of that channel uses it |
//! | DBX8.4 rises, 8.7 = 1 | any but PLC axis | PLC axis | when it stands and no block uses it |
//! | DBX8.4 rises, 8.7 = 0 | any | channel axis of the channel in 8.0 to 8.3 | the same |
//! | a synchronised action moves it | channel axis at rest, neutral | command axis | at once |
//! | RESET, end of a program | neutral, command axis | channel axis (MD30450 = 0), or neutral (1) | when the program has ended |
//!
//! # Choices where the manuals leave one
//!
//! * 8.0 to 8.3 = 0 keeps the channel. 68.5 is 0 only while a block of a program uses the axis or it is positioned alone: a movement in
//!   JOG only delays the exchange.
//! * GET waits for a temporary PLC axis, as for one of another channel; 14790 is for a block that moves it.
//! * MD30450 = 1 acts at power on, too.
//! * 10658 with 60XX (a program takes the leading axis of a closed grouping into a channel that does not know all its axes) does not occur: the
//!   definition of such a grouping is refused with 10651 at power on, and a channel that knows none of them has no name for one.

pub(super) mod programs;
pub(super) mod requests;
pub(super) mod state;
pub(super) mod status;
