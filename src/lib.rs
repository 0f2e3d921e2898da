//! OpenNCK: an open simulator of the NC/PLC interface of SINUMERIK-style controls.

#[cfg(feature = "cli")]
pub mod cli;
pub mod golden;
pub mod image;
pub mod machine;
pub mod motion;
pub mod plant;
pub mod plc;
pub mod scenario;
pub mod sinumerik;
pub mod source;
pub mod trace;
pub mod units;
pub mod variables;
