//! Scenarios: files with steps and expressions, and the session that runs them and the tests of users.
//!
//! A scenario is read ([`Scenario::read`]), prepared for a profile ([`Scenario::prepare`]) and run ([`Prepared::run`]). Preparing opens
//! the machine, looks up every name and checks every value. A mistake in a file is a [`Problem`](crate::source::Problem) with its line.
//! Unexpected behaviour of the machine is a [`Failure`] that shows every signal of the expression. [`Transcript`] does the reverse: it
//! records the commands to a machine as a scenario.

mod commands;
mod conditions;
mod duration;
mod failure;
mod faults;
mod fields;
mod file;
mod generators;
mod going;
mod include;
mod matrix;
mod naming;
mod one_by_one;
mod one_step;
mod operator;
mod passing;
mod program_rows;
mod programs;
mod rules;
mod run;
mod searches;
mod session;
mod step7;
mod step_values;
mod steps;
mod timed;
mod transcript;
mod values;
mod watching;
mod why_not;
mod written;

pub use duration::Duration;
pub use failure::{Failure, Missed};
pub use fields::Named;
pub use file::{Compare, Scenario, Watched, profile_named};
pub use include::{included_by, names_machine};
pub use matrix::Variant;
pub use one_step::commands;
pub use operator::{Operator, Stage, State};
#[cfg(feature = "live")]
pub(crate) use program_rows::program_rows;
pub use run::{Finished, Prepared};
pub use session::Session;
pub use transcript::{Heading, Remark, Transcript};
pub use values::Setting;
pub use watching::RuleResult;

#[cfg(test)]
mod tests;
