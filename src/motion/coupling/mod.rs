//! The coupling engine: one leader, its followers, and their differences.
//!
//! It is independent of the kind of control: it contains no rule, signal or alarm of a manual. A control gives it a
//! [`Policy`] and the definition of each [`Follower`], and calls it in every cycle:
//!
//! | stage | call | result |
//! |---|---|---|
//! | setpoints | [`Coupling::lead`] | the movement of each member that does not lead |
//! | stop | [`Coupling::stop`] | which members brake, and how hard |
//! | realignment | [`Coupling::begin_realignment`], [`Coupling::realign`] | where each member moves, decoupled |
//! | after the encoders | [`Coupling::compare`] | an event for each limit that a difference has crossed |
//!
//! | file | what |
//! |---|---|
//! | `policy.rs` | the decisions of a control |
//! | `state.rs` | the members, which one leads, and the stored state |
//! | `difference.rs` | differences, their base, limits and events |
//! | `realign.rs` | the decoupled motion that removes a difference |
//! | `connection.rs` | closed, realigning, open; opening and closing |
//! | `stop.rs` | the stop of the group |
//!
//! The control translates events into its own messages and keeps its own phases. Positions are integers. Nothing allocates. The number of
//! followers is limited by the number of axes and by the control.

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
