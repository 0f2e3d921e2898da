//! FC 10 (AL_MSG): the bits of DB2 become messages of the PLC, 510000 to 799999, and group signals.
//!
//! An error message begins with the edge of its bit and stays until it is acknowledged while the bit is 0; an operating message comes and goes
//! with its bit. Within a group of messages the first half of the bytes has error messages, the second half operating messages. The group
//! signals follow the bits alone, acknowledged or not.

use serde::{Deserialize, Serialize};

use super::message_block::{Group, MessageLayout, Messages};
use crate::image::ChannelToNck;
use crate::plc::{Link, PlcIo};
use crate::units::{AxisNumber, ChannelNumber};

/// DB2.
const BLOCK: u16 = 2;

/// FC 10: called once per scan.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct AlarmMessages {
    /// DB2 in the last call.
    before: Vec<u8>,
    /// The messages that are shown, as bits of DB2.
    shown: Vec<u8>,
    /// The groups whose group signals this block has set, each by the first byte of its messages in DB2.
    groups: Vec<u16>,
    numbers: Vec<u32>,
}

impl AlarmMessages {
    /// One call. `to_interface` is `ToUserIF`: the group signals are set in the interface; they are reset only where this block has set them.
    pub fn scan(&mut self, io: &mut PlcIo<'_>, layout: MessageLayout, to_interface: bool, quit: bool) {
        self.run(&mut io.link(), layout, to_interface, quit);
    }

    /// One call, for a block that has only a part of the memory.
    pub fn run(&mut self, io: &mut Link<'_>, layout: MessageLayout, to_interface: bool, quit: bool) {
        let length = layout.length();
        self.before.resize(length, 0);
        self.shown.resize(length, 0);
        for area in layout.areas() {
            let is_active = self.messages(io, area, quit);
            let position = self.groups.iter().position(|byte| *byte == area.byte);
            match (is_active && to_interface, position) {
                (true, position) => {
                    set(io, area.group, true);
                    if position.is_none() {
                        self.groups.push(area.byte);
                    }
                }
                (false, Some(_)) => set(io, area.group, false),
                (false, None) => {}
            }
        }
        // A signal that one group gave up may be that of another one.
        let groups = std::mem::take(&mut self.groups);
        for area in layout.areas().filter(|area| groups.contains(&area.byte)) {
            if to_interface && is_any(io, area) {
                set(io, area.group, true);
                self.groups.push(area.byte);
            }
        }
        self.report(io, layout);
    }

    /// Follows the bits of a group; whether one of them is 1.
    fn messages(&mut self, io: &Link<'_>, area: Messages, quit: bool) -> bool {
        let block = io.blocks.get(BLOCK);
        let first = usize::from(area.byte);
        let mut is_active = false;
        for index in first..first + usize::from(area.bytes) {
            let now = block.and_then(|block| block.get(index)).copied().unwrap_or(0);
            is_active |= now != 0;
            let is_error = index < first + usize::from(area.bytes) / 2;
            let kept = if is_error && !quit { self.shown[index] } else { 0 };
            let begins = if is_error { now & (!self.before[index] | self.shown[index]) } else { now };
            self.shown[index] = kept | begins;
            self.before[index] = now;
        }
        is_active
    }

    fn report(&mut self, io: &mut Link<'_>, layout: MessageLayout) {
        self.numbers.clear();
        for area in layout.areas() {
            let first = usize::from(area.byte);
            for (offset, byte) in (0..).zip(&self.shown[first..first + usize::from(area.bytes)]) {
                let bits = (0..8).filter(|bit| byte >> bit & 1 == 1);
                self.numbers.extend(bits.map(|bit| area.number + 8 * offset + bit));
            }
        }
        self.numbers.sort_unstable();
        io.nc.show(&self.numbers);
    }
}

fn is_any(io: &Link<'_>, area: Messages) -> bool {
    let first = usize::from(area.byte);
    let bytes = io.blocks.get(BLOCK).and_then(|block| block.get(first..first + usize::from(area.bytes)));
    bytes.is_some_and(|bytes| bytes.iter().any(|byte| *byte != 0))
}

fn set(io: &mut Link<'_>, group: Group, value: bool) {
    let mut channel = |number: u8, set: &dyn Fn(&mut ChannelToNck)| {
        if let Some(number) = ChannelNumber::new(number) {
            set(io.to_nck.channel(number));
        }
    };
    match group {
        Group::Feed(number) => channel(number, &|signals| signals.set_feed_disable(value)),
        Group::FeedAndReadIn(number) => channel(number, &|signals| {
            signals.set_feed_disable(value);
            signals.set_read_in_disable(value);
        }),
        Group::ReadIn(number) => channel(number, &|signals| signals.set_read_in_disable(value)),
        Group::NcStart(number) => channel(number, &|signals| signals.set_nc_start_disable(value)),
        Group::GeometryAxis(number, axis) => channel(number, &|signals| match axis {
            1 => signals.set_geometry_axis_1_feed_stop(value),
            2 => signals.set_geometry_axis_2_feed_stop(value),
            _ => signals.set_geometry_axis_3_feed_stop(value),
        }),
        Group::Axis(number) => {
            if let Some(axis) = AxisNumber::new(number) {
                io.to_nck.axis(axis).set_feed_stop(value);
            }
        }
        Group::Nothing => {}
    }
}
