//! GANTRY: groupings of one leading axis and its synchronous axes: referencing in three sections, synchronisation, monitoring of
//! the synchronism difference, opening and closing.

pub(super) mod closing;
pub(super) mod declarations;
pub(super) mod grouping;
pub(super) mod overload;
pub(super) mod setpoints;
pub(super) mod state;
pub(super) mod synchronisation;
pub(super) mod synchronism;
