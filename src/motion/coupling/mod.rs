//! The coupling engine: one leader, its followers, and how far they are apart.
//!
//! It knows no control: no rule, no signal and no alarm of any manual. A control gives it a [`Policy`] and the definition of
//! each [`Follower`], and calls it in every cycle:
//!
//! | stage | call | result |
//! |---|---|---|
//! | setpoints | [`Coupling::lead`] | the movement of each member that does not lead |
//! | stop | [`Coupling::stop`] | which members brake, and how hard |
//! | realignment | [`Coupling::begin_realignment`], [`Coupling::realign`] | where each member moves, decoupled |
//! | after the encoders | [`Coupling::compare`] | an event for each limit that a difference crossed |
//!
//! | file | what |
//! |---|---|
//! | `policy.rs` | what a control decides |
//! | `state.rs` | the members, which one leads, and what is remembered |
//! | `difference.rs` | differences, their base, limits and events |
//! | `realign.rs` | the decoupled motion that removes a difference |
//! | `connection.rs` | closed, realigning, open; opening and closing |
//! | `stop.rs` | the stop of the group |
//!
//! The control translates events into its own messages, and keeps its own phases. Positions are integers, nothing allocates,
//! and the number of followers is bounded by the number of axes only, or by what a control allows.

mod connection;
mod difference;
mod policy;
mod realign;
mod state;
mod stop;
#[cfg(test)]
mod tests;

pub use difference::{CouplingEvent, Events, Limit, What};
pub use policy::{BeforeReference, Follower, GroupStop, Moves, OffsetSource, Policy, Reaction, Realign, Release};
pub use policy::{Sign, Target, TwoStage};
pub use realign::{Progress, Realigning};
pub use state::{Axes, Coupling, Halt, Stage};
