//! The basic program of the SINUMERIK 840D sl as built-in blocks: FB1, FC2 and the others that a user program calls. A block of the user with
//! the same number replaces ours.

mod interface;
mod messages;
mod nc_access;
mod panels;
mod run_up;
mod single_axes;
mod spindles;
mod state;
mod tools;

pub(in crate::plc::step7) use interface::{
    BLOCKS, SERVICE_BLOCK, by_name, by_number, iec_name, is_service, service_names,
};
pub(in crate::plc::step7) use state::BasicState;

use crate::plc::PanelKind;
use crate::plc::step7::engine::{Areas, Cpu, Fault, Spot};
use crate::plc::step7::instruction::{Operand, Width};
use crate::plc::step7::text::types::Layout;

use zerocopy::IntoBytes;

use interface::{Basic, BasicBlock};
use nc_access::Access;

impl Cpu {
    /// Runs a block of the basic program in the frame that was made for it.
    pub(in crate::plc::step7) fn basic_program<A: Areas>(&mut self, areas: &mut A, index: usize) -> Result<(), Fault> {
        let Some(block) = BLOCKS.get(index) else { return Ok(()) };
        if self.observed.is_none() || !block.basic.writes_to_the_nck() {
            return self.run_basic(areas, block);
        }
        let mut before =
            self.observed.as_mut().map(|observed| std::mem::take(&mut observed.interface)).unwrap_or_default();
        before.clear();
        if let (Some(link), Some(observed)) = (areas.link(), &mut self.observed) {
            before.extend_from_slice(link.to_nck.as_bytes());
            let now = &mut observed.from_nck[1];
            if now.is_empty() {
                now.extend_from_slice(link.from_nck.as_bytes());
            }
        }
        let pc = self.observed.as_ref().map_or(0, |observed| observed.pc);
        let done = self.run_basic(areas, block);
        if let Some(observed) = &mut self.observed {
            observed.pc = pc;
        }
        if let Some(link) = areas.link() {
            self.note_interface(&before, link.to_nck.as_bytes());
        }
        if let Some(observed) = &mut self.observed {
            observed.interface = before;
        }
        done
    }

    fn run_basic<A: Areas>(&mut self, areas: &mut A, block: &'static BasicBlock) -> Result<(), Fault> {
        match block.basic {
            Basic::RunUp => self.run_up(areas, &block.layout),
            Basic::General => self.general(areas),
            Basic::Interrupt => Ok(()),
            Basic::Diagnosis => self.diagnosis(areas),
            Basic::Messages => self.alarm_messages(areas),
            Basic::SpinCtrl => self.spin_ctrl(areas),
            Basic::Panel => self.panel(areas, PanelKind::Milling),
            Basic::Get => self.nc_access(areas, &block.layout, Access::Get),
            Basic::Put => self.nc_access(areas, &block.layout, Access::Put),
            Basic::Service => self.nc_access(areas, &block.layout, Access::Service),
            Basic::Interrupts => self.interrupt_routine(areas),
            Basic::PositionAxis => self.position_axis(areas),
            Basic::IndexAxis => self.index_axis(areas),
            Basic::Transfer => self.tool_transfer(areas),
            Basic::Revolver => self.tool_revolver(areas),
            Basic::Direction => self.tool_direction(areas),
            Basic::TurningPanel => self.panel(areas, PanelKind::Turning),
        }
    }

    /// The place of a variable of the instance of the block that runs.
    fn variable<A: Areas>(&mut self, areas: &A, layout: &Layout, name: &str) -> Result<Spot, Fault> {
        let bit = layout.field(name).map_or(0, |field| field.bit);
        self.spot(areas, Operand::Own(bit))
    }

    /// The value of a variable of the instance.
    fn value<A: Areas>(&mut self, areas: &A, layout: &Layout, name: &str, width: Width) -> Result<u32, Fault> {
        let spot = self.variable(areas, layout, name)?;
        self.read(areas, spot, width)
    }

    fn set_value<A: Areas>(
        &mut self,
        areas: &mut A,
        layout: &Layout,
        name: &str,
        width: Width,
        value: u32,
    ) -> Result<(), Fault> {
        let spot = self.variable(areas, layout, name)?;
        self.write(areas, spot, width, value)
    }

    /// Writes an output of a function.
    fn set_output<A: Areas>(&mut self, areas: &mut A, index: u16, width: Width, value: u32) -> Result<(), Fault> {
        let spot = self.reference(index)?;
        self.write(areas, spot, width, value)
    }

    /// Whether a parameter of a function is 1.
    fn is_on<A: Areas>(&self, areas: &A, index: u16) -> Result<bool, Fault> {
        Ok(self.argument(areas, index, Width::Bit)? != 0)
    }
}
