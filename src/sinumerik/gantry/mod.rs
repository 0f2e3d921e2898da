//! GANTRY: groupings of one leading axis and its synchronous axes: referencing in three sections, synchronisation, monitoring of
//! the synchronism difference, opening and closing.
//!
//! A grouping is a policy for the engine in `motion::coupling`. The engine passes on movements, compares, realigns, opens and
//! closes. The grouping defines the times and the limits, and assigns rules, signals and alarms to the events.
//!
//! | file | what |
//! |---|---|
//! | `state.rs` | the state of a grouping, and the table of its transitions |
//! | `view.rs` | the data that it reads, and its requests to the rest of the control |
//! | `grouping.rs` | the stage: runs a grouping in the order of the cycle and executes its requests; sections 1 and 2 |
//! | `synchronisation.rs` | section 3; loss and return of synchronism |
//! | `closing.rs` | whether an open grouping may close (10658) |
//! | `synchronism.rs` | limits and alarms of the difference (10652, 10653) |
//! | `extended.rs` | extended monitoring: MD37150 bit 0 and MD37135 (10657) |
//! | `setpoints.rs`, `overload.rs` | the movement of the axis that leads, and the overload of a synchronous axis (10656) |
//! | `declarations.rs` | data that are reported (4300, unequal data) |
//!
//! The largest number of synchronous axes of a grouping is `SYNCHRONOUS_AXES` in `parameters/groupings.rs`, and nowhere else.

pub(super) mod closing;
pub(super) mod declarations;
pub(super) mod extended;
pub(super) mod grouping;
pub(super) mod overload;
pub(super) mod setpoints;
pub(super) mod state;
pub(super) mod synchronisation;
pub(super) mod synchronism;
pub(super) mod view;
