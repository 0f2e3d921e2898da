//! FC 10 (AL_MSG) for STEP 7 programs.

use crate::plc::step7::engine::{Areas, Cpu, Fault};

impl Cpu {
    pub(super) fn alarm_messages<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let (to_interface, quit) = (self.is_on(areas, 0)?, self.is_on(areas, 1)?);
        let state = &mut self.state.basic;
        let layout = state.message_layout();
        if let Some(mut link) = areas.link() {
            state.messages.run(&mut link, layout, to_interface, quit);
        }
        Ok(())
    }
}
