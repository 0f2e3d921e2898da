//! OpenNCK: an open simulator of the NC/PLC interface of SINUMERIK-style controls.

pub mod image;
pub mod motion;
pub mod plant;
pub mod plc;
pub mod sinumerik;
pub mod source;
pub mod trace;
pub mod units;
pub mod variables;
