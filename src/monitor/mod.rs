//! RULES OVER TIME: conditions that must hold in every cycle, and consequences that must follow an edge in time.
//!
//! A [`Rule`] contains expressions ([`Claim`]). A [`Monitor`] owns the rules of a run and their progress. The caller shows it the state
//! before the first cycle ([`Monitor::begin`]) and after every cycle ([`Monitor::observe`]), and tells it about power on
//! ([`Monitor::power_on`]). A limit is a number of cycles or a time ([`Span`]); power on can change the length of a cycle, so a time is
//! compared with the time of the machine. The monitor steps nothing and stops nothing: it reports each [`Breach`].
//!
//! The semantics of a consequence:
//!
//! * Every rising edge of `when` opens a watch of its own, in the cycle after which `when` is true.
//! * `then` closes a watch in the first cycle in which it is true: not before `not_before` is over after the edge, at the latest in the
//!   cycle that completes `within`. With [`Span::NONE`] it must be true in the cycle of the edge.
//! * A `then` that is true before `not_before` breaks the rule; so does a watch that is still open after `within`.
//! * A condition that is true before the first cycle is no edge, unless `from_start` says so.
//! * Power on closes all watches without a result.
//! * The margin of a closed watch is the number of cycles to the nearer of its two limits.

mod rule;
mod span;
mod watches;

pub use rule::{Claim, Consequence, Rule};
pub use span::{Point, Span};
pub use watches::{Breach, Margin, Monitor, Reason, Summary};

#[cfg(test)]
mod tests;
