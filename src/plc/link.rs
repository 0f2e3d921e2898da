//! The interface and the NC as a block of the basic program sees them.

use crate::image::{Blocks, FromNck, Hmi, Names, Sinumerik, ToNck, View};
use crate::units::{AxisNumber, Time};

use super::{NcServices, PlcIo};

/// What the blocks of the basic program work on: a part of [`PlcIo`].
#[derive(Debug)]
pub struct Link<'a> {
    /// The signals that the PLC writes to the NCK.
    pub to_nck: &'a mut ToNck,
    /// The signals that the NCK writes.
    pub from_nck: &'a FromNck,
    /// The signals that the HMI writes.
    pub hmi: &'a Hmi,
    /// The data blocks of the program.
    pub blocks: &'a mut Blocks,
    /// The time of this scan.
    pub time: Time,
    /// The names of the axes and channels of the machine.
    pub names: &'a Names,
    /// What the NC offers beside the interface.
    pub nc: &'a mut dyn NcServices,
}

impl PlcIo<'_, Sinumerik> {
    /// The part on which the blocks of the basic program work.
    #[must_use]
    pub fn link(&mut self) -> Link<'_> {
        Link {
            to_nck: self.to_nck,
            from_nck: self.from_nck,
            hmi: self.hmi,
            blocks: self.blocks,
            time: self.time,
            names: self.names,
            nc: self.nc,
        }
    }
}

impl<'a> Link<'a> {
    /// The same of bytes; `None` if they are of the interface of another control.
    pub(in crate::plc) fn of_bytes(
        (to_nck, from_nck, hmi): (&'a mut [u8], &'a [u8], &'a [u8]),
        blocks: &'a mut Blocks,
        (time, names): (Time, &'a Names),
        nc: &'a mut dyn NcServices,
    ) -> Option<Self> {
        if !<Sinumerik as crate::image::Layout>::is_of(names.interface()) {
            return None;
        }
        Some(Self {
            to_nck: ToNck::of_bytes_mut(to_nck)?,
            from_nck: FromNck::of_bytes(from_nck)?,
            hmi: Hmi::of_bytes(hmi)?,
            blocks,
            time,
            names,
            nc,
        })
    }

    /// The numbers of all axes of the machine, ascending.
    pub(super) fn axes(&self) -> impl Iterator<Item = AxisNumber> + use<'a> {
        let names = self.names;
        names.axes.iter().filter(|(_, name)| name.is_some()).map(|(number, _)| number)
    }
}
