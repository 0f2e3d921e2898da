//! The entries of a diagnostic buffer that a stop of the PLC program makes.

use serde::{Deserialize, Serialize};

/// Why a CPU stopped, as its diagnostic buffer has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlcDiagnosis {
    /// The event that led to STOP, if there is one.
    pub cause: Option<u16>,
    /// The event of the change to STOP.
    pub stop: u16,
    /// Additional information of both.
    pub information: [u8; 10],
}
