//! THE PARAMETER LISTS of an ISG kernel or TwinCAT CNC: files of axes and channels, the table of their parameters, and the start-up checks
//! that make axes, channels and messages of them.
//!
//! [`Lists::read`] takes the files of a machine. [`Lists::start`] is the start of the controller: the values in effect and the messages at
//! time 0. [`Lists::set`] and [`Lists::set_all`] change entries, [`Lists::update`] gives the values in effect afterwards. [`examine`]
//! reports all that can be said about the files. A file that cannot be read is a [`Problem`]; everything else is a [`Message`], and the
//! control starts.
//!
//! The decisions where the manuals leave a choice stand at the head of the file that takes them: `lines` (comments), `reading` (kinds of
//! lists), `ranges` (values of one axis), `coupling` (masters and slaves), `names`, `channels` and `writing` (changes).
//!
//! [`Problem`]: crate::source::Problem

mod channels;
mod coupling;
mod draft;
mod examine;
mod lines;
mod list;
mod message;
mod name;
mod names;
mod parameter;
mod place;
mod ranges;
mod reading;
mod start;
mod state;
mod table;
#[cfg(test)]
mod tests;
mod value;
mod writing;

pub use examine::{examine, findings};
pub use list::{Lists, Unknown};
pub use message::{Code, ERROR, Message, WARNING};
pub use name::parameter;
pub use parameter::{Effect, Index, Key, Parameter, Scope, Type, id};
pub use state::{Axis, AxisKind, Channel, ChannelAxis, Homing, Limits, OnMode, Pair, Started};
pub use table::{PARAMETERS, by_number};
pub use writing::Change;
