//! REFERENCING: the reference point approach of one axis, and which axes are referenced when: by key or channel-specific.

pub(super) mod approach;
pub(super) mod axes;
pub(super) mod state;
