//! THE CONTROL of the gantry manual (G1): machine data, mode group, channel, enabling, JOG, reference point approach,
//! gantry groupings, alarms.
//!
//! The machine calls [`Nck`] in this order, once per interpolation cycle. This order is the specification:
//! [`Nck::decide`] reads what the PLC wrote and commands setpoints (start-up, modes, emergency stop, RESET, handwheels,
//! measuring systems, parameter sets, enabling, referencing and gantry or JOG, setpoints, coupling).
//! [`Nck::velocity_command`] is position control, while drives and mechanics move. [`Nck::observe`] takes the signals of encoders
//! and drives and monitors them. [`Nck::publish`] writes the NCK's half of the interface and the variables. The control
//! reads only `ToNck` and the HMI's selection of handwheels. Axes at rest are skipped, and axes that only move need no
//! decisions (`resting.rs`).
//!
//! | to add | do this |
//! |---|---|
//! | a machine datum | add a row in `machine_data/`, and a field in `parameters/axis.rs` if the model needs it |
//! | an alarm | add a row in `alarms/mod.rs`, and call `raise` at the place of its cause |
//! | a rule that causes an edge | add a row in `rules.rs`, and call `note` at the place of the decision |
//! | a step of referencing or of the gantry | add a row in `TRANSITIONS` of `referencing/state.rs` or `gantry/state.rs` |
//! | a dependency of all axes | add a field of `Shared` in `resting.rs`; otherwise no axis wakes when it changes |
//! | a state of an axis | add a field of `Axis` in `axis/state.rs`, and compare it in `has_decisions_of` or `has_movement_of` |
//! | a decision that depends on the position of an axis | add an arm of `decisions_follow_movement` there |
//! | a monitoring function | add a file in `monitoring/`, and a row in its table |
//! | a signal of the control, and its cause | add a row in `publish/` |

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
