//! A test bench: runs a program on a memory, scan by scan.

use crate::image::{AsBytes, Location, Memory, Names, Profile};
use crate::plc::{NcOrder, NcServices, NcVariable, PlcFault, PlcIo, PlcProgram};
use crate::units::{AxisNumber, Time};

/// A memory, the names of a machine, and the time.
pub(super) struct Bench {
    pub(super) memory: Memory,
    pub(super) names: Names,
    pub(super) time: Time,
    /// The NC beside the interface.
    pub(super) nc: BenchNc,
}

/// Variables with values, and what programs ordered and show.
#[derive(Debug, Default)]
pub(super) struct BenchNc {
    pub(super) values: Vec<(NcVariable, f64)>,
    pub(super) orders: Vec<NcOrder>,
    pub(super) shown: Vec<u32>,
    pub(super) refuses: bool,
}

impl NcServices for BenchNc {
    fn read(&self, variable: NcVariable) -> Option<f64> {
        self.values.iter().find(|(known, _)| *known == variable).map(|(_, value)| *value)
    }

    fn order(&mut self, order: NcOrder) -> bool {
        if !self.refuses {
            self.orders.push(order);
        }
        !self.refuses
    }

    fn show(&mut self, messages: &[u32]) {
        messages.clone_into(&mut self.shown);
    }
}

impl Bench {
    /// A machine with these axes, from axis 1.
    pub(super) fn with_axes(axes: &[&str]) -> Self {
        let mut names = Names::default();
        for (number, name) in AxisNumber::all().zip(axes) {
            names.axes[number] = Some((*name).to_owned());
        }
        Self { memory: Memory::new(), names, time: Time::ZERO, nc: BenchNc::default() }
    }

    /// The value at an address.
    pub(super) fn get(&self, address: &str) -> u64 {
        self.memory.read(self.at(address))
    }

    /// Writes to an address.
    pub(super) fn set(&mut self, address: &str, value: u64) {
        self.memory.write(self.at(address), value);
    }

    fn at(&self, address: &str) -> Location {
        self.memory.locate(&address.parse().unwrap(), Profile::SINUMERIK_840D_SL).unwrap()
    }

    /// One scan, 10 ms after the last one.
    pub(super) fn scan(&mut self, program: &mut dyn PlcProgram) -> Result<(), PlcFault> {
        self.time += Time::from_millis(10);
        program.scan(&mut self.io())
    }

    pub(super) fn io(&mut self) -> PlcIo<'_, AsBytes> {
        let Memory { to_nck, from_nck, hmi, inputs, outputs, flags, timers, counters, blocks } = &mut self.memory;
        PlcIo {
            to_nck,
            from_nck,
            hmi,
            inputs,
            outputs,
            flags,
            timers,
            counters,
            blocks,
            cycle: 0,
            time: self.time,
            cycle_time: Time::from_millis(10),
            names: &self.names,
            nc: &mut self.nc,
        }
    }
}
