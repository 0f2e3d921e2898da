//! OpenNCK: an open simulator of the NC/PLC interface of SINUMERIK-style controls.

pub mod plant;
pub mod sinumerik;
pub mod source;
pub mod units;
