//! REFERENCING: the reference point approach of one axis, and the order of referencing, by key or channel-specific.

pub(super) mod approach;
pub(super) mod axes;
pub(super) mod channel;
pub(super) mod encoders;
mod known_position;
pub(super) mod state;
