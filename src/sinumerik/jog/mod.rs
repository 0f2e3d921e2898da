//! JOG: traversing keys, increments and handwheels.

pub(super) mod handwheels;
pub(super) mod increments;
pub(super) mod keys;
pub(super) mod state;
