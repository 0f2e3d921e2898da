//! FC 19 (MCP_IFM), FC 24 (MCP_IFM2) and FC 25 (MCP_IFT) for STEP 7 programs: keys and lamps where FB1 says.

use crate::plc::step7::engine::{Areas, Cpu, Fault, Spot};
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
        let state = &mut self.state.basic.panels[panel];
        let Some(mut link) = areas.link() else { return Ok(()) };
        let outputs = state.run(&mut link, &inputs);
        if let Some(place) = self.panel_place(areas, self.state.basic.panel_outputs[panel])? {
            self.write_bytes(areas, place, outputs.lamps)?;
        }
        self.set_output(areas, 3, Width::Bit, outputs.feed_hold.into())?;
        self.set_output(areas, 4, Width::Bit, outputs.spindle_hold.into())
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
