//! The interface by writer: three contiguous pieces of bytes, without padding.

use zerocopy::{FromBytes, FromZeros, Immutable, IntoBytes, KnownLayout, Unaligned};

use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber, PerAxis, PerChannel, PerModeGroup};

use super::{
    Axis828d, AxisFromNck, AxisToNck, ChannelAuxiliary, ChannelAuxiliary828d, ChannelFromNck, ChannelHmi,
    ChannelJumpToNck, ChannelProgramToNck, ChannelSearchFromNck, ChannelToNck, ModeGroupFromNck, ModeGroupHmi,
    ModeGroupToNck, NckFromNck, NckHmi, NckToNck, UserAlarmsToNck, UserFromNck,
};

/// Plain bytes of DB10: 0 to 55, 58 to 67, 110 to 271.
pub(super) const PLAIN_NCK: usize = 56 + 10 + 162;
/// Plain bytes of DB11: 3, 9 to 19, 23, 29 to 63.
pub(super) const PLAIN_MODE_GROUPS: usize = 1 + 11 + 1 + 35;
/// Plain bytes of DB21: 22 and 23, 26 and 27, 54 to 57, 272 to 317, 320 to 383, 385 to 415.
pub(super) const PLAIN_CHANNEL: usize = 2 + 2 + 4 + 46 + 64 + 31;
/// Plain bytes of DB31: 44 to 59, 108 to 147.
pub(super) const PLAIN_AXIS: usize = 16 + 40;

/// The signals that the PLC writes to the NCK. The plain bytes of the interface blocks, which have no entry in the catalogue, follow them.
#[derive(Clone, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct ToNck {
    /// DB10.
    pub nck: NckToNck,
    /// DB11.
    pub mode_groups: PerModeGroup<ModeGroupToNck>,
    /// DB21 to DB30.
    pub channels: PerChannel<ChannelToNck>,
    /// DB31 to DB61; the last axis number has no data block.
    pub axes: PerAxis<AxisToNck>,
    /// DB21 to DB30, program control.
    pub program_control: PerChannel<ChannelProgramToNck>,
    /// DB21 to DB30, jumps to the start of the program.
    pub jumps: PerChannel<ChannelJumpToNck>,
    /// DB1600 of the 828D.
    pub user_alarms: UserAlarmsToNck,
    /// Bytes without a name.
    pub plain: Plain,
}

/// The signals that the NCK writes.
#[derive(Clone, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct FromNck {
    /// DB10.
    pub nck: NckFromNck,
    /// DB11.
    pub mode_groups: PerModeGroup<ModeGroupFromNck>,
    /// DB21 to DB30.
    pub channels: PerChannel<ChannelFromNck>,
    /// DB31 to DB61.
    pub axes: PerAxis<AxisFromNck>,
    /// DB21 to DB30, auxiliary functions and G functions.
    pub auxiliary: PerChannel<ChannelAuxiliary>,
    /// DB21 to DB30, block search and associated stops.
    pub searches: PerChannel<ChannelSearchFromNck>,
    /// DB1600 and DB4500 of the 828D.
    pub user: UserFromNck,
    /// DB2500 of the 828D.
    pub auxiliary_828d: PerChannel<ChannelAuxiliary828d>,
    /// DB370x and DB570x of the 828D.
    pub axes_828d: PerAxis<Axis828d>,
}

/// The signals that the HMI writes: strobes and selections.
#[derive(Clone, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct Hmi {
    /// DB10.
    pub nck: NckHmi,
    /// DB11.
    pub mode_groups: PerModeGroup<ModeGroupHmi>,
    /// DB21 to DB30.
    pub channels: PerChannel<ChannelHmi>,
}

/// The bytes of the interface blocks outside the runs of the catalogue: plain memory, accessed by address.
#[derive(Clone, Copy, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct Plain {
    pub(super) nck: [u8; PLAIN_NCK],
    pub(super) mode_groups: [u8; PLAIN_MODE_GROUPS],
    pub(super) channels: PerChannel<[u8; PLAIN_CHANNEL]>,
    pub(super) axes: PerAxis<[u8; PLAIN_AXIS]>,
}

impl ToNck {
    /// DB10.
    pub fn nck(&mut self) -> &mut NckToNck {
        &mut self.nck
    }

    /// DB11 of a mode group.
    pub fn mode_group(&mut self, number: ModeGroupNumber) -> &mut ModeGroupToNck {
        &mut self.mode_groups[number]
    }

    /// DB 20 + number.
    pub fn channel(&mut self, number: ChannelNumber) -> &mut ChannelToNck {
        &mut self.channels[number]
    }

    /// Program control in DB 20 + number.
    pub fn program_control(&mut self, number: ChannelNumber) -> &mut ChannelProgramToNck {
        &mut self.program_control[number]
    }

    /// Jumps to the start of the program in DB 20 + number.
    pub fn jumps(&mut self, number: ChannelNumber) -> &mut ChannelJumpToNck {
        &mut self.jumps[number]
    }

    /// DB 30 + number.
    pub fn axis(&mut self, number: AxisNumber) -> &mut AxisToNck {
        &mut self.axes[number]
    }
}

impl FromNck {
    /// DB10.
    #[must_use]
    pub fn nck(&self) -> &NckFromNck {
        &self.nck
    }

    /// DB11 of a mode group.
    #[must_use]
    pub fn mode_group(&self, number: ModeGroupNumber) -> &ModeGroupFromNck {
        &self.mode_groups[number]
    }

    /// DB 20 + number.
    #[must_use]
    pub fn channel(&self, number: ChannelNumber) -> &ChannelFromNck {
        &self.channels[number]
    }

    /// Auxiliary functions and G functions in DB 20 + number.
    #[must_use]
    pub fn auxiliary(&self, number: ChannelNumber) -> &ChannelAuxiliary {
        &self.auxiliary[number]
    }

    /// Block search and associated stops in DB 20 + number.
    #[must_use]
    pub fn searches(&self, number: ChannelNumber) -> &ChannelSearchFromNck {
        &self.searches[number]
    }

    /// DB 30 + number.
    #[must_use]
    pub fn axis(&self, number: AxisNumber) -> &AxisFromNck {
        &self.axes[number]
    }
}

impl Hmi {
    /// DB10.
    #[must_use]
    pub fn nck(&self) -> &NckHmi {
        &self.nck
    }

    /// DB11 of a mode group.
    #[must_use]
    pub fn mode_group(&self, number: ModeGroupNumber) -> &ModeGroupHmi {
        &self.mode_groups[number]
    }

    /// DB 20 + number.
    #[must_use]
    pub fn channel(&self, number: ChannelNumber) -> &ChannelHmi {
        &self.channels[number]
    }
}

impl Default for ToNck {
    fn default() -> Self {
        Self::new_zeroed()
    }
}

impl Default for FromNck {
    fn default() -> Self {
        Self::new_zeroed()
    }
}

impl Default for Hmi {
    fn default() -> Self {
        Self::new_zeroed()
    }
}

impl PartialEq for ToNck {
    fn eq(&self, other: &Self) -> bool {
        self.as_bytes() == other.as_bytes()
    }
}

impl PartialEq for FromNck {
    fn eq(&self, other: &Self) -> bool {
        self.as_bytes() == other.as_bytes()
    }
}

impl PartialEq for Hmi {
    fn eq(&self, other: &Self) -> bool {
        self.as_bytes() == other.as_bytes()
    }
}

/// Defines views on the bytes of a part.
macro_rules! views {
    ($($part:ident),+) => {$(
        impl $part {
            /// The bytes as the structure.
            ///
            /// # Panics
            /// The bytes belong to another control.
            #[must_use]
            #[inline]
            pub fn of(bytes: &[u8]) -> &Self {
                Self::ref_from_bytes(bytes).expect(FOREIGN)
            }

            /// The bytes as the mutable structure.
            ///
            /// # Panics
            /// The bytes belong to another control.
            #[inline]
            pub fn of_mut(bytes: &mut [u8]) -> &mut Self {
                Self::mut_from_bytes(bytes).expect(FOREIGN)
            }
        }
    )+};
}
views!(ToNck, FromNck, Hmi);

const FOREIGN: &str = "the memory must belong to a SINUMERIK";
