//! FILES THAT ACT: scenarios with their steps and expressions, and the session in which they and a user's tests run.
//!
//! A scenario is read ([`Scenario::read`]), prepared for a profile ([`Scenario::prepare`]: here the machine is opened,
//! every name looked up and every value checked), and run ([`Prepared::run`]). What can be wrong with a
//! file is a [`Problem`](crate::source::Problem) with its line; what the machine did other than expected is a
//! [`Failure`] that shows every signal of the expression. The other way round, [`Transcript`] writes down what is done to a machine as
//! a scenario.

mod duration;
mod failure;
mod faults;
mod file;
mod naming;
mod operator;
mod passing;
mod run;
mod session;
mod steps;
mod transcript;
mod values;

pub use duration::Duration;
pub use failure::{Failure, Missed};
pub use file::{Compare, Named, Scenario, profile_named};
pub use operator::{Operator, State};
pub use run::{Finished, Prepared};
pub use session::Session;
pub use transcript::{Heading, Remark, Transcript};
pub use values::Setting;

#[cfg(test)]
mod tests;
