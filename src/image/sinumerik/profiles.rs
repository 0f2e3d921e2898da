//! The data block numbers of the SINUMERIK: those of the 840D sl, and those of the 828D, which shows the same memory through windows of
//! bytes. The 828D has one mode group, one channel and eight axes; axis *n* has index *n* − 1.

use crate::image::{Block, Numbering, Window};

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
        blocks: "DB1800, DB2600, DB2700, DB3000, DB3100, DB3200, DB3300, DB3800 to DB3807, DB3900 to DB3907",
        axes: "DB 3800 + axis number - 1",
    },
];

static D840_SL: [Window; 4] = [
    Window::new(10, 0, 271, Block::Nck, 0, 1),
    Window::new(11, 0, 63, Block::ModeGroup, 0, 1),
    Window::new(21, 0, 415, Block::Channel, 0, 10),
    Window::new(31, 0, 147, Block::Axis, 0, 31),
];

static D828: [Window; 23] = [
    Window::new(1800, 0, 1, Block::ModeGroup, 4, 1),
    Window::new(2600, 0, 1, Block::Nck, 56, 1),
    Window::new(2700, 0, 3, Block::Nck, 106, 1),
    Window::new(3000, 0, 2, Block::ModeGroup, 0, 1),
    Window::new(3100, 0, 2, Block::ModeGroup, 6, 1),
    Window::new(3200, 0, 7, Block::Channel, 0, 1),
    Window::new(3200, 1000, 1011, Block::Channel, 12, 1),
    Window::new(3300, 0, 5, Block::Channel, 32, 1),
    Window::new(3300, 1000, 1003, Block::Channel, 40, 1),
    Window::new(3300, 1004, 1007, Block::Channel, 46, 1),
    Window::new(3300, 1008, 1011, Block::Channel, 52, 1),
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
];
