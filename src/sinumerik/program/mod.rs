//! PROGRAMS: a channel runs an NC program. [`nc_program`](crate::nc_program) reads its blocks, [`motion::path`](crate::motion::path)
//! interpolates them, and this module brings both together with the interface: start, stop, single block, auxiliary functions, alarms.
//!
//! Called once per cycle for each channel in the stage "programs", between enabling and "referencing and gantry". It decides where the axes of
//! the path are in this cycle ([`Led`](state::Led)); the units take that over. Synchronous axes go along, as in every movement of their leading axis.
//!
//! | file | what |
//! |---|---|
//! | `state.rs` | the state of a channel's program, and of the block that runs |
//! | `selection.rs` | the programs in memory, and the selected ones |
//! | `coordination.rs` | INIT, START, WAITE, marks of channels |
//! | `control.rs` | program test, dry run, skip levels, delete passes, program level abort |
//! | `start.rs` | NC start and its refusals, stop, RESET, end, change of the mode: the program states 35.0 to 35.4 |
//! | `main_run.rs` | timers and markers of the main run |
//! | `environment.rs` | what the language reads and writes: R parameters, system variables, machine data, programs |
//! | `axis_variables.rs` | system variables of axes and spindles, settable offsets |
//! | `preparation.rs` | blocks ahead of the movement: targets in machine coordinates, limits, who may move an axis |
//! | `prepared_actions.rs` | the actions of a block while it is prepared: their axes, spindles, channels; FGROUP, G25 |
//! | `targets.rs` | targets of axis words: offsets, incremental dimensions, limits |
//! | `outputs.rs` | when the auxiliary functions of a block are output, and which stop the program |
//! | `geometry.rs` | units, offsets, circles |
//! | `executable.rs` | a block that is ready to be executed |
//! | `execution.rs` | the block that runs: before, during and at the end of its motion; the change to the next one |
//! | `ending.rs` | the end of a block: when its motion is over, programmed stops, single block |
//! | `search.rs` | block search: without calculation, to the contour, to the end point, by program test |
//! | `search_state.rs` | how far a search is, and what it has collected |
//! | `synchronised.rs` | synchronised actions |
//! | `actions.rs` | messages, PRESETON, NEWCONF, SETAL |
//! | `path.rs` | the path in a cycle: overrides, holds, where the axes are |
//! | `interruption.rs` | the interruption point, and the return to it |
//! | `limits_ahead.rs` | limits that the path would pass, by what came after the preparation of its blocks |
//! | `deletion.rs` | delete distance-to-go of the path and of axes on their own ways |
//! | `positioning.rs`, `own_ways.rs` | axes on their own ways: POS and POSA, rapid traverse with MD20730 = 0 |
//! | `referencing.rs` | G74 |
//! | `refused.rs` | couplings and spindles that the channel does not have |
//! | `preset.rs` | PRESETON, and PRESET of the operator |
//! | `auxiliary.rs` | output of auxiliary functions: DB21.DBB58 to 206 |
//!
//! # Choices where the manuals leave one
//!
//! * The channel shows "stopped" and "interrupted" (35.2, 35.6) when its axes have come to rest, not when the stop begins.
//! * An error of preparation appears when everything before its block has been executed.
//! * A block is read again after a correctable alarm with the values that it had: the text of a program does not change while it runs.
//! * Auxiliary functions without motion in their block are output together.
//! * M2 and M30 end the program when axes that POSA has started have arrived.
//! * A change of the mode to JOG while a program runs stops it.
//! * A program stays selected over RESET and power off, and so do R parameters.

pub(super) mod actions;
pub(super) mod auxiliary;
mod axis_variables;
pub(super) mod control;
pub(super) mod coordination;
mod deletion;
pub(super) mod ending;
pub(super) mod environment;
pub(super) mod executable;
pub(super) mod execution;
pub(super) mod geometry;
mod interruption;
pub(super) mod limits_ahead;
pub(super) mod main_run;
pub(super) mod outputs;
pub(super) mod own_ways;
pub(super) mod path;
pub(super) mod positioning;
pub(super) mod preparation;
mod prepared_actions;
pub(super) mod preset;
pub(super) mod referencing;
pub(super) mod refused;
pub(super) mod search;
pub(super) mod search_state;
pub(super) mod selection;
pub(super) mod start;
pub(super) mod state;
pub(super) mod synchronised;
pub(super) mod targets;
