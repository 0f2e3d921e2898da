//! OpenNCK: an open simulator of the NC/PLC interface of SINUMERIK-style controls.

pub mod image;
pub mod motion;
pub mod source;
pub mod units;
