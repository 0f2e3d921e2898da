//! THE CONTROL OF THE ISG KERNEL, which TwinCAT CNC has, too: hard gantry by parameter list, soft gantry by NC command.
//!
//! | part | what |
//! |---|---|
//! | `lists/` | parameter lists as the control stores them, and the start-up checks |
//! | `language/` | NC programs as text: blocks, expressions, commands; knows no axis |
//! | `configuration.rs`, `parameters.rs` | from lists to axes and channels, in the units of the model |
//! | `hli.rs` | the interface to the PLC, as bytes |
//! | `cnc.rs` | the control behind the interface, and the order of a cycle |
//! | `gantry.rs`, `combination.rs` | hard gantry: combinations, monitoring, clearing of differences |
//! | `links.rs`, `groups.rs` | soft gantry: coupling groups |
//! | `homing.rs` | homing of axes and combinations |
//! | `channel.rs`, `operation.rs`, `program.rs`, `exchange.rs` | a channel: start, reset, path, blocks, axis exchange |
//! | `geometry.rs` | the pieces of a path |
//! | `motion.rs` | setpoints and position control |
//! | `messages.rs`, `pending.rs`, `rules.rs`, `texts.rs`, `data.rs` | messages and causes |
//! | `phases.rs`, `charts.rs` | the state machines as tables |
//! | `publish.rs` | the CNC's half of the interface, and variables |
//!
//! Both kinds of gantry are policies over [`motion::coupling`](crate::motion::coupling), as the grouping of the SINUMERIK is. This module knows
//! nothing of `sinumerik`.
//!
//! # Choices where the manuals are silent
//!
//! - After homing an axis goes back to the place of its reference, so that it stands on its reference position.
//! - "In position" is a window of 0.1 µm; a program ends when its axes stand, also if somebody holds a slide away from its setpoint.
//! - Position control has a gain of 16.67/s and no feedforward.
//! - A movement waits for drives that start up after power on; later it needs their releases at once.
//! - G02 and G03 with a centre and no end point are full circles. M00 holds the program, M01 does nothing: the interface cannot ask for it.
//! - Single block that comes during a movement holds the program at the end of the block that runs.
//! - A program that starts while a reset still clears differences waits for that; its groups are restored then (SG-18).
//! - A slave whose list has no correction velocity (P-AXIS-00075) keeps its difference at RESET.

mod channel;
mod charts;
mod cnc;
mod combination;
mod configuration;
mod data;
mod exchange;
mod gantry;
mod geometry;
mod groups;
pub mod hli;
mod homing;
pub mod language;
mod links;
pub mod lists;
mod messages;
mod motion;
mod operation;
mod parameters;
mod pending;
mod phases;
mod program;
mod publish;
mod rules;
mod state;
mod texts;

pub use cnc::Cnc;
pub use configuration::{ParameterLists, examine, is_list};
pub use texts::TEXTS;
