//! What a program sees in one scan.

use zerocopy::IntoBytes;

use crate::image::{Blocks, Bytes, FromNck, Hmi, Names, Part, Parts, ToNck};
use crate::units::{AxisNumber, ChannelNumber, Time};

/// The PLC's view of the memory during one scan: its own side to write, the others' to read.
#[derive(Debug)]
pub struct PlcIo<'a> {
    /// What the PLC writes to the NCK.
    pub to_nck: &'a mut ToNck,
    /// What the NCK writes.
    pub from_nck: &'a FromNck,
    /// What the HMI writes.
    pub hmi: &'a Hmi,
    /// I: `io.inputs.bit(3, 4)` is I3.4.
    pub inputs: &'a Bytes,
    /// Q: `io.outputs.set_bit(4, 0, true)` sets Q4.0.
    pub outputs: &'a mut Bytes,
    /// M.
    pub flags: &'a mut Bytes,
    /// T, two bytes each.
    pub timers: &'a mut Bytes,
    /// C, two bytes each.
    pub counters: &'a mut Bytes,
    /// The program's own data blocks.
    pub blocks: &'a mut Blocks,
    /// The cycle of the NC in which this scan is.
    pub cycle: u64,
    /// The time of this scan.
    pub time: Time,
    /// The time since the last scan.
    pub cycle_time: Time,
    /// What the machine calls its axes and channels.
    pub names: &'a Names,
}

impl<'a> PlcIo<'a> {
    /// The number of the machine axis of this name.
    #[must_use]
    pub fn axis(&self, name: &str) -> Option<AxisNumber> {
        self.names.axis(name)
    }

    /// The number of the channel of this name.
    #[must_use]
    pub fn channel(&self, name: &str) -> Option<ChannelNumber> {
        self.names.channel(name)
    }

    /// The numbers of all axes that the machine has, ascending; a loop over them may write.
    pub fn axes(&self) -> impl Iterator<Item = AxisNumber> + use<'a> {
        let names = self.names;
        names.axes.iter().filter(|(_, name)| name.is_some()).map(|(number, _)| number)
    }
}

/// All of the memory to read, the PLC's own to write.
impl Parts for PlcIo<'_> {
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
