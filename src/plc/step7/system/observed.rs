//! Causes through built-in blocks: what a call read, and which of its outputs changed. Only an observed CPU pays for it.

use std::sync::LazyLock;

use arrayvec::ArrayVec;

use crate::plc::step7::basic_program::BLOCKS;
use crate::plc::step7::engine::{Areas, Cpu, Fault, Read, Spot, TESTED};
use crate::plc::step7::instruction::{BlockKind, Width};
use crate::plc::step7::text::types::{Field, Layout, Section};

use super::interface::{BASIC, SYSTEM, System, SystemBlock};

/// The outputs of a call that are compared.
const OUTPUTS: usize = 24;

/// The layouts of the system blocks.
static LAYOUTS: LazyLock<Vec<Layout>> = LazyLock::new(|| SYSTEM.iter().map(SystemBlock::layout).collect());

/// How the parameters of a built-in block are reached, if its calls are followed. FB1 to FB4 work over many scans, and the IEC timers have
/// causes of their own.
fn followed(index: usize) -> Option<(&'static Layout, bool)> {
    if let Some(basic) = index.checked_sub(BASIC) {
        let block = BLOCKS.get(basic)?;
        return (block.block.kind == BlockKind::Fc).then_some((&block.layout, false));
    }
    let row = SYSTEM.get(index)?;
    let is_timer = matches!(row.system, System::Pulse | System::OnDelay | System::OffDelay);
    let is_instance = row.block.is_some_and(|block| block.kind == BlockKind::Sfb);
    (!is_timer).then(|| (&LAYOUTS[index], is_instance))
}

impl Cpu {
    /// Runs a built-in block in the frame that was made for it.
    pub(in crate::plc::step7) fn built_in<A: Areas>(&mut self, areas: &mut A, index: u16) -> Result<(), Fault> {
        if self.observed.is_none() {
            return self.run_built_in(areas, index);
        }
        let inputs: ArrayVec<Read, TESTED>;
        let mut outputs: ArrayVec<(Spot, Width, u32), OUTPUTS> = ArrayVec::new();
        if let Some((layout, is_instance)) = followed(usize::from(index)) {
            inputs = self.inputs_of(areas, layout, is_instance);
            for (number, field) in (0..).zip(&layout.fields) {
                if matches!(field.section, Section::Output | Section::InOut)
                    && let Some((spot, width, value)) = self.parameter_value(areas, field, number, is_instance)
                {
                    let _ = outputs.try_push((spot, width, value));
                }
            }
        } else {
            inputs = ArrayVec::new();
        }
        let pc = self.observed.as_ref().map_or(0, |observed| observed.pc);
        if let Some(observed) = &mut self.observed {
            observed.inputs = inputs;
        }
        let done = self.run_built_in(areas, index);
        if let Some(observed) = &mut self.observed {
            observed.pc = pc;
        }
        for (spot, width, before) in outputs {
            let Ok(now) = self.read(areas, spot, width) else { continue };
            self.note_called(areas, spot, width.bits(), (before, now));
        }
        done
    }

    /// The elementary inputs of a call, as far as they have names.
    fn inputs_of<A: Areas>(&mut self, areas: &A, layout: &'static Layout, is_instance: bool) -> ArrayVec<Read, TESTED> {
        let mut inputs = ArrayVec::new();
        for (number, field) in (0..).zip(&layout.fields) {
            if field.section == Section::Input
                && let Some((spot, width, value)) = self.parameter_value(areas, field, number, is_instance)
            {
                self.note_read(spot, width, value, &mut inputs);
            }
        }
        inputs
    }

    /// The place, the width and the value of an elementary parameter.
    fn parameter_value<A: Areas>(
        &mut self,
        areas: &A,
        field: &Field,
        number: u16,
        is_instance: bool,
    ) -> Option<(Spot, Width, u32)> {
        let width = field.ty.width()?;
        let spot = if is_instance {
            self.own(areas, field.bit / 8, field.bit % 8).ok()?
        } else {
            self.reference(number).ok()?
        };
        let value = self.read(areas, spot, width).ok()?;
        Some((spot, width, value))
    }
}
