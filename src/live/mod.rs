//! A machine in real time, and the boundary for servers.
//!
//! [`Live`] steps a machine when its cycle is due. A server holds a [`Handle`] and has no other access to the stepping thread:
//!
//! * It reads a copy. [`Handle::look`] shows the machine after its last step ([`Seen`]); everything read in one call is of one step number.
//!   A look never waits for the current step, however long that takes.
//! * It orders. [`Handle::order`] puts an [`Order`] into the inbox. All of it takes effect in order at the start of one step and is
//!   recorded there, so a session with clients can be repeated as a scenario. The call returns the number of that step. The order is
//!   acknowledged when [`Handle::taken_up`] completes: a look then shows its effect.
//! * It follows. [`Handle::over`] waits for a step by its number. A server that does not wait can look at any time.
//! * It drives. [`Handle::pause`], [`Handle::step`] and [`Handle::set_speed`] act from the next step on; [`Handle::go_back`] returns to a
//!   moment of the last minutes.
//! * One server can receive everything that happens: [`Handle::follow`]. Any number of servers can see the machine after every step:
//!   [`Handle::steps`].
//! * It ends before the machine. Its owner ends the server, the server drops its handle, then the machine ends ([`Live::end`] returns the
//!   machine only when no handle is left). If the machine ends first, [`Handle::over`] and [`Handle::taken_up`] return false at once, and
//!   [`Handle::has_ended`] is true.
//!
//! `s7::live` is such a server. A minimal one:
//!
//! ```
//! use opennck::live::{Live, Order, Speed};
//! use opennck::machine::{Command, Machine};
//!
//! let machine = Machine::open("g1_example")?;
//! let flag = machine.memory().locate(&"MB100".parse()?, machine.names().profile)?;
//! let live = Live::start(machine, Speed::default());
//! let server = live.handle();
//! let step = server.order(Order { commands: vec![Command::Write { location: flag, value: 7 }], ..Order::default() });
//! // A server with an executor awaits `server.taken_up(step)` here.
//! while server.look(|seen| seen.step()) < step {
//!     std::thread::yield_now();
//! }
//! assert_eq!(server.look(|seen| seen.machine().memory().read(flag)), 7);
//! drop(server);
//! assert!(live.end().is_some());
//! # Ok::<(), opennck::source::Problem>(())
//! ```
//!
//! `stepping.rs` has the thread and its schedule, `shared.rs` the data shared between threads, `clocked.rs` the machine with its clock and
//! recording, `driving.rs` its speed and pauses, `following.rs` the record for a server that follows, `steps.rs` every step, `history.rs` the last minutes,
//! `seen.rs` the copy of the last step, `inbox.rs` the orders, `handle.rs` the boundary, `opening.rs` the inputs from which a
//! machine is opened, `record.rs` the recording. `MappedPlc` (feature `mapped`) is a PLC program in another
//! process, `plc_process.rs` starts and ends this process for a scenario.

#![expect(clippy::disallowed_methods, reason = "this module runs machines in real time")]

mod causes;
mod clocked;
mod diagnosis;
mod driving;
mod follower;
mod following;
mod handle;
mod history;
mod inbox;
#[cfg(feature = "mapped")]
mod mapped_plc;
mod opening;
#[cfg(feature = "mapped")]
mod plc_process;
mod record;
mod seen;
mod shared;
mod speed;
mod stepping;
mod steps;
mod urgency;

pub use diagnosis::{Entry, Event};
pub use follower::Follower;
pub use following::Batch;
pub use handle::Handle;
pub use history::Reach;
pub use inbox::Order;
#[cfg(feature = "mapped")]
pub use mapped_plc::{Exchange, Keeper, MappedPlc};
pub use opening::{Opened, Opening};
#[cfg(feature = "mapped")]
pub use plc_process::with_processes;
pub use record::Recording;
pub use seen::Seen;
pub use shared::Pace;
pub use speed::Speed;
pub use stepping::{Ended, GIVE_UP, Live, LiveOptions};
pub use steps::{Step, Steps};
