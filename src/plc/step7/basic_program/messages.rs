//! FC 10 (AL_MSG) for STEP 7 programs.

use arrayvec::ArrayVec;

use crate::plc::step7::engine::{Areas, Cpu, Fault, Named};
use crate::plc::step7::instruction::Width;

/// DB2.
const BLOCK: u16 = 2;

impl Cpu {
    pub(super) fn alarm_messages<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let (to_interface, quit) = (self.is_on(areas, 0)?, self.is_on(areas, 1)?);
        self.note_messages(areas);
        let state = &mut self.state.basic;
        let layout = state.message_layout();
        if let Some(mut link) = areas.link() {
            state.messages.run(&mut link, layout, to_interface, quit);
        }
        Ok(())
    }

    /// The messages that came or went, and ToUserIF, are what made the group signals.
    fn note_messages<A: Areas>(&mut self, areas: &mut A) {
        let Some(mut before) = self.observed.as_mut().map(|observed| std::mem::take(&mut observed.messages)) else {
            return;
        };
        let mut inputs = ArrayVec::new();
        if let Ok(spot) = self.reference(0)
            && let Ok(value) = self.read(areas, spot, Width::Bit)
        {
            self.note_read(spot, Width::Bit, value, &mut inputs);
        }
        if let Some(observed) = &mut self.observed {
            observed.inputs = inputs;
        }
        if let Some(now) = areas.link().and_then(|link| link.blocks.get(BLOCK)) {
            before.resize(now.len(), 0);
            self.note_changed(&before, now, |bit| Some(Named::Block(BLOCK, bit)));
            before.copy_from_slice(now);
        }
        if let Some(observed) = &mut self.observed {
            observed.messages = before;
        }
    }
}
