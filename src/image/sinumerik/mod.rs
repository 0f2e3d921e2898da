//! The interface of the SINUMERIK 840D sl and 828D: its tables of signals, and how they lie in the parts by writer.

mod db10;
mod db11;
mod db21;
mod db31;
mod machine_functions;
mod parts;

pub use db10::{NckFromNck, NckHmi, NckToNck};
pub use db11::{ModeGroupFromNck, ModeGroupHmi, ModeGroupToNck};
pub use db21::{ChannelFromNck, ChannelHmi, ChannelToNck};
pub use db31::{AxisFromNck, AxisToNck};
pub use parts::{FromNck, Hmi, Plain, ToNck};
