//! The interface of the SINUMERIK, built from its tables, and its memory as structures.

use zerocopy::IntoBytes;

use super::{
    Axis828d, AxisFromNck, AxisToNck, ChannelAuxiliary, ChannelAuxiliary828d, ChannelFromNck, ChannelHmi,
    ChannelJumpToNck, ChannelProgramToNck, ChannelSearchFromNck, ChannelToNck, FromNck, Hmi, ModeGroupFromNck,
    ModeGroupHmi, ModeGroupToNck, NckFromNck, NckHmi, NckToNck, ToNck, UserAlarmsToNck, UserFromNck, axis_to_nck,
    channel_to_nck, places, profiles,
};
use crate::image::{Interface, Layout, Memory, Override, Profile, SwitchSignals, Tables, ValueTerms};

/// The interface of the SINUMERIK: one NCK, two mode groups, ten channels, 31 axes.
pub static SINUMERIK: Interface = Interface::new(Tables {
    name: "sinumerik",
    blocks: &places::BLOCKS,
    signals: &[
        NckToNck::SIGNALS,
        NckFromNck::SIGNALS,
        NckHmi::SIGNALS,
        ModeGroupToNck::SIGNALS,
        ModeGroupHmi::SIGNALS,
        ModeGroupFromNck::SIGNALS,
        ChannelToNck::SIGNALS,
        ChannelHmi::SIGNALS,
        ChannelProgramToNck::SIGNALS,
        ChannelFromNck::SIGNALS,
        ChannelAuxiliary::SIGNALS,
        ChannelSearchFromNck::SIGNALS,
        ChannelJumpToNck::SIGNALS,
        AxisToNck::SIGNALS,
        AxisFromNck::SIGNALS,
        UserAlarmsToNck::SIGNALS,
        UserFromNck::SIGNALS,
        ChannelAuxiliary828d::SIGNALS,
        Axis828d::SIGNALS,
    ],
    to_nck: size_of::<ToNck>(),
    from_nck: size_of::<FromNck>(),
    hmi: size_of::<Hmi>(),
    numberings: &profiles::NUMBERINGS,
    // The data blocks of the basic program (O-24).
    standard_blocks: &[2, 4, 5, 7, 18, 19, 20, 71, 72, 73],
    overrides: &[
        (axis_to_nck::feed_override, Override::Axis),
        (channel_to_nck::feed_override, Override::Feed),
        (channel_to_nck::rapid_traverse_override, Override::RapidTraverse),
        (axis_to_nck::spindle_override, Override::Spindle),
    ],
    switches: Some(SwitchSignals {
        cam: axis_to_nck::deceleration_reference_point_approach,
        limit_plus: axis_to_nck::hardware_limit_switch_plus,
        limit_minus: axis_to_nck::hardware_limit_switch_minus,
    }),
    units: None,
    named_in: "MD10000, MD20000",
    example: "X.controller_enable",
    values: ValueTerms::SINUMERIK,
});

/// The parts as the structures of the SINUMERIK.
#[derive(Clone, Copy, Debug)]
pub struct Sinumerik;

impl Layout for Sinumerik {
    type ToNck = ToNck;
    type FromNck = FromNck;
    type Hmi = Hmi;

    fn is_of(interface: &Interface) -> bool {
        *interface == SINUMERIK
    }
}

impl Profile {
    /// SINUMERIK 840D sl: DB10, DB11, DB21 to DB30, DB31 to DB61.
    pub const SINUMERIK_840D_SL: Self = Self::new(&SINUMERIK, 0);
    /// SINUMERIK 828D: DB1600 to DB1900, DB2500 to DB2700, DB3000 to DB3500, DB3700 to DB3907, DB4500, DB5700 to DB5707.
    pub const SINUMERIK_828D: Self = Self::new(&SINUMERIK, 1);
}

/// The default profile.
impl Default for Profile {
    fn default() -> Self {
        Self::SINUMERIK_840D_SL
    }
}

impl FromNck {
    /// Sets every signal to 0 and keeps plain memory unchanged. The control then publishes all signals again.
    pub fn clear_signals(&mut self) {
        SINUMERIK.clear_signals(self.as_mut_bytes());
    }
}

/// The memory of a SINUMERIK.
impl Default for Memory {
    fn default() -> Self {
        Self::new()
    }
}

impl Memory {
    /// The memory of a SINUMERIK, all bytes 0.
    #[must_use]
    pub fn new() -> Self {
        Self::of(&SINUMERIK)
    }

    /// The signals that the PLC writes to the NCK of a SINUMERIK.
    ///
    /// # Panics
    /// The memory belongs to another control. This also applies to the next five methods.
    #[must_use]
    #[inline]
    pub fn to_nck(&self) -> &ToNck {
        ToNck::of(&self.to_nck)
    }

    /// The signals that the PLC writes to the NCK of a SINUMERIK, mutable.
    #[inline]
    pub fn to_nck_mut(&mut self) -> &mut ToNck {
        ToNck::of_mut(&mut self.to_nck)
    }

    /// The signals that the NCK of a SINUMERIK writes.
    #[must_use]
    #[inline]
    pub fn from_nck(&self) -> &FromNck {
        FromNck::of(&self.from_nck)
    }

    /// The signals that the NCK of a SINUMERIK writes, mutable.
    #[inline]
    pub fn from_nck_mut(&mut self) -> &mut FromNck {
        FromNck::of_mut(&mut self.from_nck)
    }

    /// The signals that the HMI of a SINUMERIK writes.
    #[must_use]
    #[inline]
    pub fn hmi(&self) -> &Hmi {
        Hmi::of(&self.hmi)
    }

    /// The signals that the HMI of a SINUMERIK writes, mutable.
    #[inline]
    pub fn hmi_mut(&mut self) -> &mut Hmi {
        Hmi::of_mut(&mut self.hmi)
    }
}
