//! FC 19 (MCP_IFM), FC 24 (MCP_IFM2) and FC 25 (MCP_IFT) for STEP 7 programs: keys and lamps where FB1 says.

use crate::plc::step7::engine::{Area, Areas, Cpu, Fault, Named, Spot};
use crate::plc::step7::instruction::Width;
use crate::plc::{PanelInputs, PanelKind};
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber};

/// DB10.DBB8 and DBB32: the machine axes of the axis keys of both panels.
const AXIS_TABLES: [u32; 2] = [8, 32];

impl Cpu {
    pub(super) fn panel<A: Areas>(&mut self, areas: &mut A, kind: PanelKind) -> Result<(), Fault> {
        let [group, channel, spindle] = [0, 1, 2].map(|index| self.argument(areas, index, Width::Byte));
        let (group, channel, spindle) = (group?, channel?, spindle?);
        let panel = usize::from(group & 0x80 != 0);
        let byte = |value: u32| u8::try_from(value & 0x7F).unwrap_or(0);
        let mut axes = [0; 9];
        if let Some(block) = areas.block(10) {
            for (index, axis) in (AXIS_TABLES[panel]..).zip(&mut axes) {
                *axis = areas.read::<1>(block, index).map_or(0, |[axis]| axis);
            }
        }
        let keys = match self.panel_place(areas, self.state.basic.panel_inputs[panel])? {
            Some(place) => self.read_bytes(areas, place)?,
            // MCP1In of FB1 has no address, so no key of the panel is pressed.
            None => [0, 0, 0b0001_0101, 0, 0, 0, 0, 0],
        };
        let inputs = PanelInputs {
            kind,
            keys,
            mode_group: ModeGroupNumber::new(byte(group)),
            channel: ChannelNumber::new(byte(channel)),
            spindle: AxisNumber::new(byte(spindle)),
            axes,
        };
        self.note_keys(panel, keys);
        let state = &mut self.state.basic.panels[panel];
        let Some(mut link) = areas.link() else { return Ok(()) };
        let outputs = state.run(&mut link, &inputs);
        if let Some(place) = self.panel_place(areas, self.state.basic.panel_outputs[panel])? {
            if self.observed.is_some() {
                self.note_lamps(areas, place, outputs.lamps);
            }
            self.write_bytes(areas, place, outputs.lamps)?;
        }
        self.set_output(areas, 3, Width::Bit, outputs.feed_hold.into())?;
        self.set_output(areas, 4, Width::Bit, outputs.spindle_hold.into())
    }

    /// The keys that were pressed or released are what made the outputs.
    fn note_keys(&mut self, panel: usize, keys: [u8; 8]) {
        let Some(observed) = &mut self.observed else { return };
        let before = std::mem::replace(&mut observed.keys[panel], keys);
        let (number, pointer) = self.state.basic.panel_inputs[panel];
        let first = pointer & 0x0007_FFFF;
        self.note_changed(&before, &keys, |bit| {
            Some(match pointer >> 24 {
                0x80 | 0x81 => Named::Area(Area::Inputs, first + bit),
                0x83 => Named::Area(Area::Flags, first + bit),
                0x84 => Named::Block(number, first + bit),
                _ => return None,
            })
        });
    }

    /// The lamps that change, on account of what the block has read.
    fn note_lamps<A: Areas>(&mut self, areas: &A, place: Spot, lamps: [u8; 8]) {
        for (byte, lamps) in (0..).zip(lamps) {
            let Ok([before]) = self.read_bytes::<1>(areas, place.after(byte)) else { return };
            for bit in (0..8).filter(|bit| (before ^ lamps) >> bit & 1 == 1) {
                let spot = Spot { bit: place.bit + byte * 8 + bit, ..place };
                let value = u32::from(lamps >> bit & 1);
                self.note_called(areas, spot, 1, (1 - value, value));
            }
        }
    }

    /// Where a pointer of FB1 points to; `None` for no pointer.
    fn panel_place<A: Areas>(&mut self, areas: &A, (number, pointer): (u16, u32)) -> Result<Option<Spot>, Fault> {
        if pointer >> 24 == 0 {
            return Ok(None);
        }
        let db = self.state.registers.db;
        if number != 0 {
            self.state.registers.db = areas.block(number).ok_or(Fault::NoDataBlock(number))?;
        }
        let place = self.crossing(pointer);
        self.state.registers.db = db;
        place.map(Some)
    }
}
