//! The definition of a machine from its files, and its fingerprints, by which a saved state recognises it.

use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

use super::delay::Delay;
use crate::control::{Control, Finding};
use crate::image::{Location, Memory, Names};
use crate::plant::{Layout, Switch};
use crate::source::Place;
use crate::units::{AxisNumber, Time};

/// The definition of a machine from its files. It does not change after opening, and all forks share it.
#[derive(Debug)]
pub(super) struct Definition {
    pub(super) names: Names,
    pub(super) layout: Layout,
    /// Signals of switches that are not wired.
    pub(super) unwired: Vec<(AxisNumber, Switch, Location)>,
    /// The memory after power on: presets.
    pub(super) memory: Memory,
    /// The PLC program that `plant.toml` names, and where.
    pub(super) plc: Option<(String, Place)>,
    /// The cycle of the PLC program; the NC cycle if not defined.
    pub(super) plc_cycle: Option<Time>,
    /// How late the PLC's half reaches the control, and the NCK's half the PLC program.
    pub(super) delays: [Time; 2],
    /// The control as it was opened.
    pub(super) control: Box<dyn Control>,
    /// Computed when they are first needed.
    pub(super) fingerprints: OnceLock<Fingerprints>,
    /// Findings about its files, the heaviest first.
    pub(super) findings: Vec<Finding>,
    /// The findings in one line, if there are any.
    pub(super) warnings: Vec<String>,
}

/// Hashes of what the files of a machine define.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Fingerprints {
    /// The areas of the PLC with their initial values.
    pub(super) plc_image: u64,
    pub(super) plant: u64,
    /// The machine data and the settings of the control at opening, without later changes.
    pub(super) machine_data: u64,
}

impl Definition {
    /// The same with the memory after power on and the cycle of a PLC program.
    pub(super) fn with_program(&self, memory: Memory, plc_cycle: Option<Time>) -> Self {
        Self {
            names: self.names.clone(),
            layout: self.layout.clone(),
            unwired: self.unwired.clone(),
            memory,
            plc: self.plc.clone(),
            plc_cycle,
            delays: self.delays,
            control: self.control.clone_box(),
            fingerprints: OnceLock::new(),
            findings: self.findings.clone(),
            warnings: self.warnings.clone(),
        }
    }

    pub(super) fn fingerprints(&self) -> Fingerprints {
        *self.fingerprints.get_or_init(|| Fingerprints {
            plc_image: hash(&postcard::to_stdvec(&self.memory).expect("plain data can always be written")),
            // Numbers in this text are exact.
            plant: hash(format!("{:?}", (&self.layout, self.plc_cycle, self.delays)).as_bytes()),
            machine_data: hash(format!("{:?}", self.control).as_bytes()),
        })
    }
}

/// FNV-1a, 64 bits.
pub(super) fn hash(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xCBF2_9CE4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3))
}

impl Definition {
    /// The numbers of cycles of the two delays.
    pub(super) fn delay_cycles(&self, cycle: Time) -> [u64; 2] {
        self.delays.map(|delay| if delay == Time::ZERO { 0 } else { delay.in_cycles(cycle) })
    }

    /// The two delays with this memory at both ends.
    pub(super) fn delays(&self, cycle: Time, memory: &Memory) -> (Delay, Delay) {
        let [to_nck, from_nck] = self.delay_cycles(cycle);
        (Delay::new(to_nck, &memory.to_nck), Delay::new(from_nck, &memory.from_nck))
    }
}
