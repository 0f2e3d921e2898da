//! A machine in real time: the thread that steps it, the inbox for what clients ask for, and the copy of the last step that they see.

#![expect(clippy::disallowed_methods, reason = "real time is what it is for")]

mod diagnosis;
pub(crate) mod inbox;
#[cfg(feature = "mapped")]
mod mapped_plc;
mod record;
pub(crate) mod seen;
mod speed;
pub(crate) mod stepping;
mod urgency;

#[cfg(feature = "mapped")]
pub use mapped_plc::{Exchange, Keeper, MappedPlc};
pub use record::Recording;
pub use speed::Speed;
pub use stepping::{Ended, GIVE_UP, Live, LiveOptions, Pace};
