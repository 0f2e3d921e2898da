//! A machine in real time, and the boundary at which servers plug into it.
//!
//! [`Live`] steps a machine when its cycle is due. A server holds a [`Handle`] of it and knows nothing else of the thread behind:
//!
//! * It sees a copy. [`Handle::look`] shows the machine as its last step left it ([`Seen`]), with one step number for all that is read in
//!   one call. A look never waits for the step that goes on, however long that lasts.
//! * It orders. [`Handle::order`] puts an [`Order`] into the inbox; all of it acts at the edge of one step, in order, and is recorded
//!   there, so that a session with clients becomes a scenario again. The number of that step comes back, and the order is acknowledged when
//!   [`Handle::taken_up`] is done: then a look shows what the order did.
//! * It learns of new steps. [`Handle::over`] waits for a step by its number. A server that does not wait looks when it likes.
//! * It ends before the machine: its owner ends it, it drops its handle, then the machine ends ([`Live::end`] gives the machine only when
//!   no handle is left). Where the machine ends first, [`Handle::over`] and [`Handle::taken_up`] return false at once, and
//!   [`Handle::has_ended`] is true.
//!
//! `s7::live` is such a server. A small one:
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
//! `stepping.rs` is the thread and its schedule, `shared.rs` what it shares with others, `clocked.rs` the machine with what goes with it,
//! `seen.rs` the copy of the last step, `inbox.rs` the orders, `handle.rs` the boundary, `opening.rs` what a machine is opened from, `record.rs` the
//! recording. `MappedPlc` (feature `mapped`) is a PLC program in
//! another process.

#![expect(clippy::disallowed_methods, reason = "real time is what it is for")]

mod clocked;
mod diagnosis;
mod handle;
mod inbox;
#[cfg(feature = "mapped")]
mod mapped_plc;
mod opening;
mod record;
mod seen;
mod shared;
mod speed;
mod stepping;
mod urgency;

pub use diagnosis::{Entry, Event};
pub use handle::Handle;
pub use inbox::Order;
#[cfg(feature = "mapped")]
pub use mapped_plc::{Exchange, Keeper, MappedPlc};
pub use opening::{Opened, Opening};
pub use record::Recording;
pub use seen::Seen;
pub use shared::Pace;
pub use speed::Speed;
pub use stepping::{Ended, GIVE_UP, Live, LiveOptions};
