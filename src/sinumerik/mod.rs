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
//! "Where to add something" in the documentation of the crate names the files for a signal, a machine datum, an alarm, a rule, a state of an
//! axis and a step of referencing.

mod activation;
mod alarms;
mod awake;
mod axis;
mod boundary;
mod chart_positions;
mod commissioning;
mod compensation;
mod exchange;
mod function_generator;
mod gantry;
mod inputs;
mod jog;
pub mod machine_data;
mod modelled;
mod monitoring;
mod nck;
mod opening;
mod operation;
mod overlay;
mod parameters;
mod program;
mod publish;
mod referencing;
mod resting;
mod rules;
mod shown;
mod single_axis;
mod spindle;
mod state;
mod strobe;
mod texts;
mod user;

pub use alarms::axis_exchange::AXIS_EXCHANGE as AXIS_EXCHANGE_ALARMS;
pub use alarms::not_raised::NOT_RAISED as ALARMS_NOT_RAISED;
pub use alarms::programs::PROGRAMS as PROGRAM_ALARMS;
pub use alarms::{Alarm, CATALOGUE as ALARMS, Cancel, Reaction};
pub use commissioning::{Commissioning, examine};
pub use exchange::state::{Holder, TRANSITIONS as EXCHANGE_TRANSITIONS};
pub use gantry::state::{Phase as GroupingPhase, TRANSITIONS as GROUPING_TRANSITIONS};
pub use nck::Nck;
pub use parameters::axis::AxisPresence;
pub use parameters::dynamics::{Dynamics, FeedForward, Jerk, ParameterSet};
pub use parameters::mechanics::{Mechanics, Misfit, PARAMETER_SETS};
pub use parameters::{KeyModes, Parameters};
pub use referencing::state::{Phase as ApproachPhase, TRANSITIONS as APPROACH_TRANSITIONS};
pub use rules::Rule;
pub use texts::TEXTS;
