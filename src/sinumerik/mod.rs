//! THE CONTROL of the gantry manual (G1): machine data, mode group, channel, enabling, JOG, reference point approach,
//! gantry groupings, alarms.
//!
//! The machine calls [`Nck`] in this order, once per interpolation cycle, and that order is the specification:
//! [`Nck::decide`] takes what the PLC wrote and commands setpoints (run-up, modes, emergency stop, RESET, handwheels,
//! measuring systems, parameter sets, enabling, referencing and gantry or JOG, setpoints, coupling);
//! [`Nck::velocity_command`] is position control, while drives and mechanics move; [`Nck::observe`] takes what encoders
//! and drives tell and monitors it; [`Nck::publish`] writes the NCK's half of the interface and the variables. The control
//! reads [`ToNck`], the HMI's selection of handwheels, and nothing else. Axes that rest are left out, and nothing is decided for those that only move (`resting.rs`).
//!
//! | I want to add | I do |
//! |---|---|
//! | a machine datum | a row in `machine_data/`, a field in `parameters/axis.rs` where the model needs it |
//! | an alarm | a row in `alarms/mod.rs`, a `raise` where it happens |
//! | a rule that causes an edge | a row in `rules.rs`, a `note` where it is decided |
//! | a step of referencing or of the gantry | a row in `TRANSITIONS` of `referencing/state.rs` or `gantry/state.rs` |
//! | something that all axes depend on | a field of `Shared` in `resting.rs`, or nobody wakes for it |
//! | something that an axis remembers | a field of `Axis` in `axis/state.rs`, in `has_decisions_of` or in `has_movement_of`, too |
//! | a decision that depends on where an axis is | an arm of `decisions_follow_movement` there |
//! | something to watch | a file in `monitoring/`, a row in its table |
//! | a signal that the control shows, and its cause | a row in `publish/` |

mod alarms;
mod awake;
mod axis;
mod boundary;
mod commissioning;
mod gantry;
mod inputs;
mod jog;
pub mod machine_data;
mod monitoring;
mod nck;
mod operation;
mod parameters;
mod publish;
mod referencing;
mod resting;
mod rules;
mod shown;
mod state;
mod strobe;
mod texts;

pub use alarms::not_raised::NOT_RAISED as ALARMS_NOT_RAISED;
pub use alarms::{Alarm, CATALOGUE as ALARMS, Cancel, Reaction};
pub use commissioning::{Commissioning, examine};
pub use gantry::state::{Phase as GroupingPhase, TRANSITIONS as GROUPING_TRANSITIONS};
pub use nck::Nck;
pub use parameters::axis::AxisPresence;
pub use parameters::dynamics::{Dynamics, FeedForward, Jerk, ParameterSet};
pub use parameters::mechanics::{Mechanics, Misfit, PARAMETER_SETS};
pub use parameters::{KeyModes, Parameters};
pub use referencing::state::{Phase as ApproachPhase, TRANSITIONS as APPROACH_TRANSITIONS};
pub use rules::Rule;
pub use texts::TEXTS;
