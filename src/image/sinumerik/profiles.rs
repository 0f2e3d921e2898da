//! The data block numbers of the SINUMERIK: those of the 840D sl, and those of the 828D, which shows the same memory through windows of
//! bytes. The 828D has one mode group, one channel and eight axes; axis *n* has index *n* − 1. docs/profile_828d.md gives the source of each
//! window.

use super::{UserAlarmsToNck, UserFromNck};
use crate::image::{Block, Numbering, Window};

/// The first byte of the user alarms in the block of the NCK.
const ALARMS: u16 = UserAlarmsToNck::FIRST;

pub(super) static NUMBERINGS: [Numbering; 2] = [
    Numbering {
        name: "840d_sl",
        title: "the 840D sl",
        number: 840,
        windows: &D840_SL,
        blocks: "DB10, DB11, DB21 to DB30, DB31 to DB61",
        axes: "DB 30 + axis number",
    },
    Numbering {
        name: "828d",
        title: "the 828D",
        number: 828,
        windows: &D828,
        blocks: "DB1600, DB1700, DB1800, DB1900, DB2500, DB2600, DB2700, DB3000, DB3100, DB3200, DB3300, DB3500, DB3700 to DB3707, \
            DB3800 to DB3807, DB3900 to DB3907, DB4500, DB5700 to DB5707",
        axes: "DB 3800 + axis number - 1",
    },
];

static D840_SL: [Window; 4] = [
    Window::new(10, 0, 271, Block::Nck, 0, 1),
    Window::new(11, 0, 63, Block::ModeGroup, 0, 1),
    Window::new(21, 0, 415, Block::Channel, 0, 10),
    Window::new(31, 0, 147, Block::Axis, 0, 31),
];

static D828: [Window; 50] = [
    Window::new(1600, 0, 30, Block::Nck, ALARMS, 1),
    Window::new(1600, 1000, 1991, Block::Nck, UserAlarmsToNck::VARIABLES, 1),
    Window::new(1600, 2000, 2000, Block::Nck, UserFromNck::FIRST, 1),
    Window::new(1600, 3000, 3000, Block::Nck, UserAlarmsToNck::ACKNOWLEDGEMENT, 1),
    Window::new(1700, 0, 3, Block::Channel, 24, 1),
    Window::new(1800, 0, 1, Block::ModeGroup, 4, 1),
    Window::new(1900, 1003, 1005, Block::Nck, 100, 1),
    Window::new(2500, 4, 4, Block::Channel, 58, 1),
    Window::new(2500, 6, 6, Block::Channel, 60, 1),
    Window::new(2500, 8, 8, Block::Channel, 61, 1),
    Window::new(2500, 10, 10, Block::Channel, 62, 1),
    Window::new(2500, 12, 12, Block::Channel, 64, 1),
    Window::new(2500, 1000, 1012, Block::Channel, 194, 1),
    Window::new(2500, 2000, 2003, Block::Channel, 416, 1),
    Window::new(2500, 3000, 3039, Block::Channel, 424, 1),
    Window::new(2500, 4000, 4023, Block::Channel, 464, 1),
    Window::new(2500, 5000, 5003, Block::Channel, 420, 1),
    Window::new(2500, 6000, 6023, Block::Channel, 488, 1),
    Window::new(2600, 0, 1, Block::Nck, 56, 1),
    Window::new(2700, 0, 3, Block::Nck, 106, 1),
    Window::new(3000, 0, 2, Block::ModeGroup, 0, 1),
    Window::new(3100, 0, 2, Block::ModeGroup, 6, 1),
    Window::new(3200, 0, 7, Block::Channel, 0, 1),
    Window::new(3200, 13, 15, Block::Channel, 29, 1),
    Window::new(3200, 16, 16, Block::Channel, 384, 1),
    Window::new(3200, 1000, 1011, Block::Channel, 12, 1),
    Window::new(3300, 0, 5, Block::Channel, 32, 1),
    Window::new(3300, 1000, 1003, Block::Channel, 40, 1),
    Window::new(3300, 1004, 1007, Block::Channel, 46, 1),
    Window::new(3300, 1008, 1011, Block::Channel, 52, 1),
    Window::new(3300, 4002, 4003, Block::Channel, 318, 1),
    Window::new(3500, 0, 63, Block::Channel, 208, 1),
    Window::new(3700, 0, 7, Block::Axis, 148, 8),
    Window::new(3800, 0, 11, Block::Axis, 0, 8),
    Window::new(3800, 1000, 1003, Block::Axis, 12, 8),
    Window::new(3800, 2000, 2003, Block::Axis, 16, 8),
    Window::new(3800, 3000, 3011, Block::Axis, 32, 8),
    Window::new(3800, 4000, 4003, Block::Axis, 20, 8),
    Window::new(3800, 5000, 5007, Block::Axis, 24, 8),
    Window::new(3900, 0, 11, Block::Axis, 60, 8),
    Window::new(3900, 1000, 1003, Block::Axis, 74, 8),
    Window::new(3900, 2000, 2003, Block::Axis, 82, 8),
    Window::new(3900, 3000, 3003, Block::Axis, 104, 8),
    Window::new(3900, 4000, 4003, Block::Axis, 92, 8),
    Window::new(3900, 5000, 5007, Block::Axis, 96, 8),
    Window::new(4500, 0, 63, Block::Nck, UserFromNck::DATA[0], 1),
    Window::new(4500, 1000, 1031, Block::Nck, UserFromNck::DATA[1], 1),
    Window::new(4500, 2000, 2031, Block::Nck, UserFromNck::DATA[2], 1),
    Window::new(4500, 3000, 3247, Block::Nck, UserFromNck::DATA[3], 1),
    Window::new(5700, 0, 7, Block::Axis, 156, 8),
];
