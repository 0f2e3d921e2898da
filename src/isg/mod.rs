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
//! | `homing/` | homing of axes and combinations |
//! | `channel.rs`, `operation.rs`, `program.rs`, `exchange.rs` | a channel: start, reset, path, blocks, axis exchange |
//! | `geometry.rs` | the pieces of a path |
//! | `motion.rs` | setpoints and position control |
//! | `messages.rs`, `pending.rs`, `rules.rs`, `texts.rs`, `data.rs` | messages and causes |
//! | `phases.rs`, `charts.rs` | the state machines as tables |
//! | `inputs.rs` | signals and blocks as inputs of causes |
//! | `publish/` | the CNC's half of the interface, variables, the causes of its signals, and their conditions |
//!
//! Both kinds of gantry are policies over [`motion::coupling`](crate::motion::coupling), as the grouping of the SINUMERIK is. This module knows
//! nothing of `sinumerik`.
//!
//! # Choices where the manuals are silent
//!
//! Each is a row of `docs/decisions.md`: P-80 to P-101, P-107 to P-110, P-113 to P-115, and those that the rules HG and SG name.

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
mod inputs;
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
mod refused;
mod rules;
mod state;
mod texts;

pub use cnc::Cnc;
pub use configuration::{ParameterLists, examine, is_list};
pub use texts::TEXTS;
