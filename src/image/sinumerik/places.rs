//! The data blocks as tables of ranges over the memory by writer: the position and writer of each byte of DB31, for example.

use std::mem::offset_of;

use super::parts::{PLAIN_AXIS, PLAIN_CHANNEL, PLAIN_MODE_GROUPS, PLAIN_NCK};
use super::{
    Axis828d, AxisFromNck, AxisToNck, ChannelAuxiliary, ChannelAuxiliary828d, ChannelFromNck, ChannelHmi,
    ChannelJumpToNck, ChannelProgramToNck, ChannelSearchFromNck, ChannelToNck, FromNck, Hmi, ModeGroupFromNck,
    ModeGroupHmi, ModeGroupToNck, NckFromNck, NckHmi, NckToNck, ToNck, UserAlarmsToNck, UserFromNck,
};
use crate::image::{Block, BlockTable, ByteRange, Part};

pub(super) static BLOCKS: [BlockTable; 4] = [
    BlockTable { block: Block::Nck, count: 1, names: &["nck"], called: "the NCK", apart: None, ranges: &NCK },
    // The block of the second mode group begins 20 bytes after that of the first.
    BlockTable {
        block: Block::ModeGroup,
        count: 2,
        names: &["mode_group_1", "mode_group_2"],
        called: "mode group",
        apart: Some(20),
        ranges: &MODE_GROUPS,
    },
    BlockTable { block: Block::Channel, count: 10, names: &[], called: "channel", apart: None, ranges: &CHANNEL },
    BlockTable { block: Block::Axis, count: 31, names: &[], called: "axis", apart: None, ranges: &AXIS },
];

const fn range(first: u16, last: u16, part: Part, base: usize, stride: usize) -> ByteRange {
    ByteRange::signals(first, last, part, base, stride)
}

const fn plain(first: u16, last: u16, base: usize, stride: usize) -> ByteRange {
    ByteRange::plain(first, last, base, stride)
}

const NCK_PLAIN: usize = offset_of!(ToNck, plain.nck);
#[rustfmt::skip]
static NCK: [ByteRange; 10] = [
    plain(0, 55, NCK_PLAIN, 0),
    range(56, 57, Part::ToNck, offset_of!(ToNck, nck), 0),
    plain(58, 67, NCK_PLAIN + 56, 0),
    range(68, 96, Part::FromNck, offset_of!(FromNck, nck), 0),
    range(97, 103, Part::Hmi, offset_of!(Hmi, nck), 0),
    range(104, 109, Part::FromNck, offset_of!(FromNck, nck) + (104 - 68), 0),
    plain(110, 271, NCK_PLAIN + 66, 0),
    range(UserAlarmsToNck::FIRST, UserAlarmsToNck::ACKNOWLEDGEMENT, Part::ToNck, offset_of!(ToNck, user_alarms), 0),
    plain(UserAlarmsToNck::VARIABLES, UserAlarmsToNck::LAST, offset_of!(ToNck, user_alarms.variables), 0),
    range(UserFromNck::FIRST, UserFromNck::LAST, Part::FromNck, offset_of!(FromNck, user), 0),
];

const GROUPS_PLAIN: usize = offset_of!(ToNck, plain.mode_groups);
#[rustfmt::skip]
static MODE_GROUPS: [ByteRange; 10] = [
    range(0, 2, Part::ToNck, offset_of!(ToNck, mode_groups), 0),
    plain(3, 3, GROUPS_PLAIN, 0),
    range(4, 5, Part::Hmi, offset_of!(Hmi, mode_groups), 0),
    range(6, 8, Part::FromNck, offset_of!(FromNck, mode_groups), 0),
    plain(9, 19, GROUPS_PLAIN + 1, 0),
    range(20, 22, Part::ToNck, offset_of!(ToNck, mode_groups) + size_of::<ModeGroupToNck>(), 0),
    plain(23, 23, GROUPS_PLAIN + 12, 0),
    range(24, 25, Part::Hmi, offset_of!(Hmi, mode_groups) + size_of::<ModeGroupHmi>(), 0),
    range(26, 28, Part::FromNck, offset_of!(FromNck, mode_groups) + size_of::<ModeGroupFromNck>(), 0),
    plain(29, 63, GROUPS_PLAIN + 13, 0),
];

const CHANNEL_PLAIN: usize = offset_of!(ToNck, plain.channels);
#[rustfmt::skip]
static CHANNEL: [ByteRange; 14] = [
    range(0, 21, Part::ToNck, offset_of!(ToNck, channels), size_of::<ChannelToNck>()),
    plain(22, 23, CHANNEL_PLAIN, PLAIN_CHANNEL),
    range(24, 25, Part::Hmi, offset_of!(Hmi, channels), size_of::<ChannelHmi>()),
    plain(26, 27, CHANNEL_PLAIN + 2, PLAIN_CHANNEL),
    range(28, 31, Part::ToNck, offset_of!(ToNck, program_control), size_of::<ChannelProgramToNck>()),
    range(32, 53, Part::FromNck, offset_of!(FromNck, channels), size_of::<ChannelFromNck>()),
    plain(54, 57, CHANNEL_PLAIN + 4, PLAIN_CHANNEL),
    range(58, 271, Part::FromNck, offset_of!(FromNck, auxiliary), size_of::<ChannelAuxiliary>()),
    plain(272, 317, CHANNEL_PLAIN + 8, PLAIN_CHANNEL),
    range(318, 319, Part::FromNck, offset_of!(FromNck, searches), size_of::<ChannelSearchFromNck>()),
    plain(320, 383, CHANNEL_PLAIN + 54, PLAIN_CHANNEL),
    range(384, 384, Part::ToNck, offset_of!(ToNck, jumps), size_of::<ChannelJumpToNck>()),
    plain(385, 415, CHANNEL_PLAIN + 118, PLAIN_CHANNEL),
    range(416, 511, Part::FromNck, offset_of!(FromNck, auxiliary_828d), size_of::<ChannelAuxiliary828d>()),
];

const AXIS_PLAIN: usize = offset_of!(ToNck, plain.axes);
#[rustfmt::skip]
static AXIS: [ByteRange; 5] = [
    range(0, 43, Part::ToNck, offset_of!(ToNck, axes), size_of::<AxisToNck>()),
    plain(44, 59, AXIS_PLAIN, PLAIN_AXIS),
    range(60, 107, Part::FromNck, offset_of!(FromNck, axes), size_of::<AxisFromNck>()),
    plain(108, 147, AXIS_PLAIN + 16, PLAIN_AXIS),
    range(148, 163, Part::FromNck, offset_of!(FromNck, axes_828d), size_of::<Axis828d>()),
];

const _: () = {
    // The bytes of the runs, numbered as in the manual.
    assert!(NckToNck::FIRST == 56 && size_of::<NckToNck>() == 2);
    assert!(NckFromNck::FIRST == 68 && size_of::<NckFromNck>() == 42);
    assert!(NckHmi::FIRST == 97 && size_of::<NckHmi>() == 7);
    assert!(ModeGroupToNck::FIRST == 0 && size_of::<ModeGroupToNck>() == 3);
    assert!(ModeGroupHmi::FIRST == 4 && size_of::<ModeGroupHmi>() == 2);
    assert!(ModeGroupFromNck::FIRST == 6 && size_of::<ModeGroupFromNck>() == 3);
    assert!(ChannelToNck::FIRST == 0 && size_of::<ChannelToNck>() == 22);
    assert!(ChannelHmi::FIRST == 24 && size_of::<ChannelHmi>() == 2);
    assert!(ChannelFromNck::FIRST == 32 && size_of::<ChannelFromNck>() == 22);
    assert!(ChannelAuxiliary::FIRST == 58 && size_of::<ChannelAuxiliary>() == 214);
    assert!(ChannelProgramToNck::FIRST == 28 && size_of::<ChannelProgramToNck>() == 4);
    assert!(ChannelJumpToNck::FIRST == 384 && size_of::<ChannelJumpToNck>() == 1);
    assert!(ChannelSearchFromNck::FIRST == 318 && size_of::<ChannelSearchFromNck>() == 2);
    assert!(AxisToNck::FIRST == 0 && size_of::<AxisToNck>() == 44);
    assert!(AxisFromNck::FIRST == 60 && size_of::<AxisFromNck>() == 48);
    assert!(ChannelAuxiliary828d::FIRST == 416 && size_of::<ChannelAuxiliary828d>() == 96);
    assert!(Axis828d::FIRST == 148 && size_of::<Axis828d>() == 16);
    assert!(UserAlarmsToNck::FIRST == 272 && size_of::<UserAlarmsToNck>() == 1024 && size_of::<UserFromNck>() == 377);
    // The parts, without padding and in this order. They have space for each axis number; no block shows the last one.
    assert!(offset_of!(ToNck, mode_groups) == 2 && offset_of!(ToNck, channels) == 8);
    assert!(offset_of!(ToNck, axes) == 228 && offset_of!(ToNck, program_control) == 1636);
    assert!(offset_of!(ToNck, jumps) == 1676 && offset_of!(ToNck, user_alarms) == 1686);
    assert!(size_of::<ToNck>() == 1686 + 1024 + PLAIN_NCK + PLAIN_MODE_GROUPS + 10 * PLAIN_CHANNEL + 32 * PLAIN_AXIS);
    assert!(offset_of!(FromNck, mode_groups) == 42 && offset_of!(FromNck, channels) == 48);
    assert!(offset_of!(FromNck, axes) == 268 && offset_of!(FromNck, auxiliary) == 268 + 32 * 48);
    assert!(offset_of!(FromNck, searches) == 268 + 32 * 48 + 10 * 214);
    assert!(size_of::<FromNck>() == 268 + 32 * 48 + 10 * 214 + 10 * 2 + 377 + 10 * 96 + 32 * 16);
    assert!(offset_of!(Hmi, mode_groups) == 7 && offset_of!(Hmi, channels) == 11 && size_of::<Hmi>() == 31);
};
