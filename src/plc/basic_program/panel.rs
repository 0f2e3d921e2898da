//! FC 19 (MCP_IFM), FC 24 (MCP_IFM2) and FC 25 (MCP_IFT): a machine control panel of 8 bytes of keys and 8 bytes of lamps (P-135).
//!
//! | byte | 7 | 6 | 5 | 4 | 3 | 2 | 1 | 0 |
//! |---|---|---|---|---|---|---|---|---|
//! | 0 | spindle override D | C | B | A | JOG | TEACH IN | MDA | AUTO |
//! | 1 | REPOS | REF | INC var | INC 10000 | 1000 | 100 | 10 | 1 |
//! | 2 | key position 0 | key position 2 | spindle start | *spindle stop | feed start | *feed stop | NC start | *NC stop |
//! | 3 | RESET | key position 1 | single block | feed override E | D | C | B | A |
//! | 4 | + (R15) | − (R13) | rapid (R14) | key position 3 | X (R1) | 4 (R4) | 7 (R7) | R10 |
//! | 5 | Y (R2) | Z (R3) | 5 (R5) | MCS/WCS (R12) | R11 | 9 (R9) | 8 (R8) | 6 (R6) |
//!
//! `*`: 0 is pressed. A turning panel has keys of directions: R2 and R8 are +X and −X, R6 and R4 are +Z and −Z, R3 and R7 are +Y and −Y, R5 is
//! rapid traverse. Lamps: byte 0 INC 1000, 100, 10, 1, JOG, TEACH IN, MDA, AUTO; byte 1 feed start, *feed stop, NC start, *NC stop, REPOS, REF,
//! INC var, INC 10000; byte 2 −, R1, R4, R7, R10, single block, spindle start, *spindle stop; byte 3 R3, R5, R12, R11, R9, R8, R6, R2.

use serde::{Deserialize, Serialize};

use super::increments::select_increment;
use crate::image::ModeGroupToNck;
use crate::plc::{Link, PlcIo};
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber};

/// The data block with the bit "actual values in WCS", DB19.DBX0.7.
const HMI_BLOCK: u16 = 19;

/// The kind of a panel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PanelKind {
    /// Keys select an axis, + and − move it.
    #[default]
    Milling,
    /// Each direction of an axis has its key.
    Turning,
}

/// The inputs of a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PanelInputs {
    /// The kind.
    pub kind: PanelKind,
    /// The keys.
    pub keys: [u8; 8],
    /// The mode group; `None`: its signals are not written.
    pub mode_group: Option<ModeGroupNumber>,
    /// The channel; `None`: its signals are not written.
    pub channel: Option<ChannelNumber>,
    /// The spindle; `None`: its signals are not written.
    pub spindle: Option<AxisNumber>,
    /// The machine axes of the axis keys 1 to 9; 0: the axis with the number of the key.
    pub axes: [u8; 9],
}

/// The outputs of a call.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PanelOutputs {
    /// The lamps.
    pub lamps: [u8; 8],
    /// Feed stop was pressed.
    pub feed_hold: bool,
    /// Spindle stop was pressed.
    pub spindle_hold: bool,
}

/// What the panel requests of its mode group.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
enum Mode {
    /// Nothing was pressed yet.
    #[default]
    None,
    Automatic,
    Mdi,
    TeachIn,
    Jog,
    Repos,
    Reference,
}

/// A panel: called once per scan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ControlPanel {
    before: [u8; 8],
    /// The strobes of the HMI in the last call: automatic, MDA, JOG, TEACH IN, REPOS, REF.
    strobes: [bool; 6],
    mode: Mode,
    /// The selected increment, 0 to 5; continuous without one.
    increment: Option<u8>,
    /// The selected axis key, from 1.
    selected: Option<u8>,
    is_single_block: bool,
    pub(super) feed_hold: bool,
    pub(super) spindle_hold: bool,
    is_workpiece: bool,
}

/// A key: its byte and its bit.
type Key = (usize, u8);

/// The axis keys 1 to 9.
const AXIS_KEYS: [Key; 9] = [(4, 3), (5, 7), (5, 6), (4, 2), (5, 5), (5, 0), (4, 1), (5, 1), (5, 2)];

/// The keys of the directions of a turning panel: the axis key, and byte and bit of plus and minus.
const DIRECTIONS: [(u8, Key, Key); 3] = [(1, (5, 7), (5, 1)), (3, (5, 0), (4, 2)), (2, (5, 6), (4, 1))];

/// How an axis is to move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Way {
    key: u8,
    plus: bool,
    minus: bool,
    rapid: bool,
}

impl ControlPanel {
    /// One call.
    pub fn scan(&mut self, io: &mut PlcIo<'_>, inputs: &PanelInputs) -> PanelOutputs {
        self.run(&mut io.link(), inputs)
    }

    /// One call, for a block that has only a part of the memory.
    pub fn run(&mut self, link: &mut Link<'_>, inputs: &PanelInputs) -> PanelOutputs {
        let keys = inputs.keys;
        let rose = |(byte, bit): Key| (keys[byte] & !self.before[byte]) >> bit & 1 == 1;
        let on = |byte: usize, bit: u8| keys[byte] >> bit & 1 == 1;
        let pressed = [(0, 0), (0, 1), (0, 2), (0, 3), (1, 7), (1, 6)].map(rose);
        let increment = (0..6).find(|&bit| rose((1, bit)));
        let axis_key = (1..).zip(AXIS_KEYS).find(|(_, key)| rose(*key)).map(|(number, _)| number);
        let toggles = [(3, 5), (5, 4)].map(rose);
        self.before = keys;
        self.select_mode(link, inputs.mode_group, pressed);
        if let Some(increment) = increment {
            self.increment = Some(increment);
        }
        self.is_single_block ^= toggles[0];
        if inputs.kind == PanelKind::Milling {
            self.is_workpiece ^= toggles[1];
            self.selected = axis_key.or(self.selected);
        }
        self.feed_hold = !on(2, 2) || self.feed_hold && !on(2, 3);
        self.spindle_hold = !on(2, 4) || self.spindle_hold && !on(2, 5);
        if let Some(group) = inputs.mode_group {
            self.write_mode(link.to_nck.mode_group(group));
        }
        let nck = link.to_nck.nck();
        nck.set_increment_inputs_active_in_mode_group_area(true);
        nck.set_key_operated_switch_position_0(on(2, 7));
        nck.set_key_operated_switch_position_1(on(3, 6));
        nck.set_key_operated_switch_position_2(on(2, 6));
        nck.set_key_operated_switch_position_3(on(4, 4));
        let feed_override = keys[3] & 0x1F;
        if let Some(channel) = inputs.channel {
            let signals = link.to_nck.channel(channel);
            signals.set_nc_start(on(2, 1));
            signals.set_nc_stop(!on(2, 0));
            signals.set_channel_reset(on(3, 7));
            signals.set_activate_single_block(self.is_single_block);
            signals.set_feed_override(feed_override);
            signals.set_feed_disable(self.feed_hold);
        }
        self.traverse(link, inputs, feed_override);
        if let Some(spindle) = inputs.spindle {
            let signals = link.to_nck.axis(spindle);
            signals.set_spindle_override(keys[0] >> 4);
            signals.set_feed_stop(self.spindle_hold);
        }
        if let Some(byte) = link.blocks.get_mut(HMI_BLOCK).and_then(|block| block.get_mut(0)) {
            *byte = *byte & 0x7F | u8::from(self.is_workpiece) << 7;
        }
        PanelOutputs { lamps: self.lamps(link, inputs), feed_hold: self.feed_hold, spindle_hold: self.spindle_hold }
    }

    /// The last key or strobe of the HMI wins.
    fn select_mode(&mut self, link: &Link<'_>, group: Option<ModeGroupNumber>, pressed: [bool; 6]) {
        const MODES: [Mode; 6] = [Mode::Automatic, Mode::Mdi, Mode::TeachIn, Mode::Jog, Mode::Repos, Mode::Reference];
        let strobes = group.map_or([false; 6], |group| {
            let hmi = link.hmi.mode_group(group);
            [
                hmi.automatic_selected(),
                hmi.mdi_selected(),
                hmi.teach_in_selected(),
                hmi.jog_selected(),
                hmi.repos_selected(),
                hmi.ref_selected(),
            ]
        });
        let before = std::mem::replace(&mut self.strobes, strobes);
        for (index, mode) in MODES.into_iter().enumerate() {
            if pressed[index] || strobes[index] && !before[index] {
                self.mode = mode;
                if matches!(mode, Mode::Jog | Mode::Reference) {
                    self.increment = None;
                }
            }
        }
    }

    fn write_mode(&self, group: &mut ModeGroupToNck) {
        let mode = self.mode;
        group.set_mode_automatic(mode == Mode::Automatic);
        group.set_mode_mdi(matches!(mode, Mode::Mdi | Mode::TeachIn));
        group.set_mode_jog(matches!(mode, Mode::Jog | Mode::Repos | Mode::Reference));
        group.set_machine_function_teach_in(mode == Mode::TeachIn);
        group.set_machine_function_repos(mode == Mode::Repos);
        group.set_machine_function_ref(mode == Mode::Reference);
        select_increment(group, self.increment);
    }

    /// The directions that are pressed, by their axis keys.
    fn ways(&self, inputs: &PanelInputs) -> [Way; 3] {
        let on = |(byte, bit): Key| inputs.keys[byte] >> bit & 1 == 1;
        match inputs.kind {
            PanelKind::Milling => {
                let key = self.selected.unwrap_or(0);
                let way = Way { key, plus: on((4, 7)), minus: on((4, 6)), rapid: on((4, 5)) };
                [way, Way::default(), Way::default()]
            }
            PanelKind::Turning => DIRECTIONS.map(|(key, plus, minus)| {
                let (plus, minus) = (on(plus), on(minus));
                Way { key, plus, minus, rapid: on((5, 5)) && (plus || minus) }
            }),
        }
    }

    /// Feed override and directions of all axes; in the workpiece coordinate system the first three keys are of the geometry axes.
    fn traverse(&self, link: &mut Link<'_>, inputs: &PanelInputs, feed_override: u8) {
        let ways = self.ways(inputs);
        let machine_axis = |key: u8| match inputs.axes.get(usize::from(key).wrapping_sub(1)) {
            Some(0) => AxisNumber::new(key),
            Some(number) => AxisNumber::new(*number),
            None => None,
        };
        for axis in link.axes() {
            let is_meant = |way: &&Way| machine_axis(way.key) == Some(axis) && !(self.is_workpiece && way.key <= 3);
            let way = ways.iter().find(is_meant).copied().unwrap_or_default();
            let signals = link.to_nck.axis(axis);
            signals.set_feed_override(feed_override);
            signals.set_traversing_key_plus(way.plus);
            signals.set_traversing_key_minus(way.minus);
            signals.set_rapid_traverse_override(way.rapid);
        }
        let Some(channel) = inputs.channel else { return };
        let of = |key| ways.iter().find(|way| self.is_workpiece && way.key == key).copied().unwrap_or_default();
        let signals = link.to_nck.channel(channel);
        let [first, second, third] = [of(1), of(2), of(3)];
        signals.set_geometry_axis_1_traversing_key_plus(first.plus);
        signals.set_geometry_axis_1_traversing_key_minus(first.minus);
        signals.set_geometry_axis_1_rapid_traverse_override(first.rapid);
        signals.set_geometry_axis_2_traversing_key_plus(second.plus);
        signals.set_geometry_axis_2_traversing_key_minus(second.minus);
        signals.set_geometry_axis_2_rapid_traverse_override(second.rapid);
        signals.set_geometry_axis_3_traversing_key_plus(third.plus);
        signals.set_geometry_axis_3_traversing_key_minus(third.minus);
        signals.set_geometry_axis_3_rapid_traverse_override(third.rapid);
    }

    /// The lamp of an axis key.
    pub(super) fn is_selected(&self, key: u8) -> bool {
        self.selected == Some(key)
    }

    pub(super) fn is_in_workpiece_coordinates(&self) -> bool {
        self.is_workpiece
    }

    pub(super) fn stops_after_each_block(&self) -> bool {
        self.is_single_block
    }
}
