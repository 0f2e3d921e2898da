//! The memory as a PLC program sees it in one scan.

use zerocopy::IntoBytes;

use super::NcServices;
use crate::image::{AsBytes, Blocks, Bytes, Layout, Names, Part, Parts, Sinumerik, View};
use crate::units::{AxisNumber, ChannelNumber, Time};

/// The memory during one scan: the program writes the PLC side and reads all other parts.
///
/// The three parts of the interface are structures of a control (of the SINUMERIK by default) or plain bytes (`PlcIo<'_, AsBytes>`).
/// [`typed`](PlcIo::typed) converts bytes into structures.
#[derive(Debug)]
pub struct PlcIo<'a, L: Layout = Sinumerik> {
    /// The signals that the PLC writes to the NCK.
    pub to_nck: &'a mut L::ToNck,
    /// The signals that the NCK writes.
    pub from_nck: &'a L::FromNck,
    /// The signals that the HMI writes.
    pub hmi: &'a L::Hmi,
    /// Inputs (I): `io.inputs.bit(3, 4)` is I3.4.
    pub inputs: &'a Bytes,
    /// Outputs (Q): `io.outputs.set_bit(4, 0, true)` sets Q4.0.
    pub outputs: &'a mut Bytes,
    /// Flags (M).
    pub flags: &'a mut Bytes,
    /// Timers (T), two bytes each.
    pub timers: &'a mut Bytes,
    /// Counters (C), two bytes each.
    pub counters: &'a mut Bytes,
    /// The data blocks of the program.
    pub blocks: &'a mut Blocks,
    /// The NC cycle of this scan.
    pub cycle: u64,
    /// The time of this scan.
    pub time: Time,
    /// The time since the last scan.
    pub cycle_time: Time,
    /// The names of the axes and channels of the machine.
    pub names: &'a Names,
    /// What the NC offers beside the interface.
    pub nc: &'a mut dyn NcServices,
}

impl<'a, L: Layout> PlcIo<'a, L> {
    /// The number of the machine axis with this name.
    #[must_use]
    pub fn axis(&self, name: &str) -> Option<AxisNumber> {
        self.names.axis(name)
    }

    /// The number of the channel with this name.
    #[must_use]
    pub fn channel(&self, name: &str) -> Option<ChannelNumber> {
        self.names.channel(name)
    }

    /// The numbers of all axes of the machine, ascending. The iterator does not borrow, so the loop body can write.
    pub fn axes(&self) -> impl Iterator<Item = AxisNumber> + use<'a, L> {
        let names = self.names;
        names.axes.iter().filter(|(_, name)| name.is_some()).map(|(number, _)| number)
    }
}

impl PlcIo<'_, AsBytes> {
    /// The same view with the parts as structures of a control; `None` if the machine has the interface of another control.
    #[must_use]
    pub fn typed<L: Layout>(&mut self) -> Option<PlcIo<'_, L>> {
        if !L::is_of(self.names.interface()) {
            return None;
        }
        Some(PlcIo {
            to_nck: L::ToNck::of_bytes_mut(self.to_nck)?,
            from_nck: L::FromNck::of_bytes(self.from_nck)?,
            hmi: L::Hmi::of_bytes(self.hmi)?,
            inputs: self.inputs,
            outputs: self.outputs,
            flags: self.flags,
            timers: self.timers,
            counters: self.counters,
            blocks: self.blocks,
            cycle: self.cycle,
            time: self.time,
            cycle_time: self.cycle_time,
            names: self.names,
            nc: self.nc,
        })
    }
}

/// Reads the complete memory; writes the PLC side only.
impl<L: Layout> Parts for PlcIo<'_, L> {
    fn part(&self, part: Part) -> &[u8] {
        match part {
            Part::ToNck => self.to_nck.as_bytes(),
            Part::FromNck => self.from_nck.as_bytes(),
            Part::Hmi => self.hmi.as_bytes(),
            Part::Inputs => self.inputs,
            Part::Outputs => self.outputs,
            Part::Flags => self.flags,
            Part::Timers => self.timers,
            Part::Counters => self.counters,
            Part::Block(number) => self.blocks.get(number).map_or(&[], |bytes| bytes),
        }
    }

    fn part_mut(&mut self, part: Part) -> &mut [u8] {
        match part {
            Part::ToNck => self.to_nck.as_mut_bytes(),
            Part::FromNck | Part::Hmi | Part::Inputs => &mut [],
            Part::Outputs => self.outputs,
            Part::Flags => self.flags,
            Part::Timers => self.timers,
            Part::Counters => self.counters,
            Part::Block(number) => self.blocks.get_mut(number).map_or(&mut [], |bytes| bytes),
        }
    }
}
