//! GANTRY: groupings of one leading axis and its synchronous axes: referencing in three sections, synchronisation, monitoring of
//! the synchronism difference, opening and closing.
//!
//! A grouping is a policy over the engine in `motion::coupling`. The engine hands movements on, compares, realigns, opens and
//! closes; the grouping says when, with which limits, and gives its events rules, signals and alarms.
//!
//! | file | what |
//! |---|---|
//! | `state.rs` | what a grouping remembers, and the table of its steps |
//! | `view.rs` | what it reads, and what it wants from the rest of the control |
//! | `grouping.rs` | the stage: asks a grouping in the order of the cycle and does what it wants; sections 1 and 2 |
//! | `synchronisation.rs` | section 3; loss and return of synchronism |
//! | `closing.rs` | whether an open grouping may close (10658) |
//! | `synchronism.rs` | limits and alarms of the difference (10652, 10653) |
//! | `setpoints.rs`, `overload.rs` | the movement of the axis that leads, and whether a synchronous axis can follow it (10656) |
//! | `declarations.rs` | data that are reported (4300, unequal data) |
//!
//! How many synchronous axes a grouping can have is `SYNCHRONOUS_AXES` in `parameters/groupings.rs`, and nowhere else.

pub(super) mod closing;
pub(super) mod declarations;
pub(super) mod grouping;
pub(super) mod overload;
pub(super) mod setpoints;
pub(super) mod state;
pub(super) mod synchronisation;
pub(super) mod synchronism;
pub(super) mod view;
