//! FC 18 (SpinCtrl) for STEP 7 programs: one state for each axis.

use std::mem::offset_of;
use std::ops::Range;

use zerocopy::IntoBytes;

use crate::image::{AxisFromNck, FromNck};
use crate::plc::step7::engine::{Areas, Cpu, Fault, Named};
use crate::plc::step7::instruction::Width;
use crate::plc::{SpinCtrl, SpinCtrlInputs, SpinCtrlOutputs};
use crate::units::AxisNumber;

/// State of a call for an axis that does not exist: a wrong value.
const NO_AXIS: SpinCtrlOutputs = SpinCtrlOutputs { in_position: false, error: true, state: 100 };

impl Cpu {
    pub(super) fn spin_ctrl<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let [function, mode] = [2, 3].map(|index| self.argument(areas, index, Width::Byte));
        let call = SpindleCall {
            start: self.is_on(areas, 0)?,
            stop: self.is_on(areas, 1)?,
            function: u8::try_from(function?).unwrap_or(0),
            mode: u8::try_from(mode?).unwrap_or(0),
            axis: self.argument(areas, 4, Width::Word)?,
            position: f32::from_bits(self.argument(areas, 5, Width::Double)?),
            feedrate: f32::from_bits(self.argument(areas, 6, Width::Double)?),
        };
        let (done, _) = self.run_spindle(areas, &call);
        self.set_output(areas, 7, Width::Bit, done.in_position.into())?;
        self.set_output(areas, 8, Width::Bit, done.error.into())?;
        self.set_output(areas, 9, Width::Byte, done.state.into())
    }

    /// Runs the block of an axis; its outputs, and whether the axis is positioned.
    pub(super) fn run_spindle<A: Areas>(&mut self, areas: &mut A, call: &SpindleCall) -> (SpinCtrlOutputs, bool) {
        let number = u8::try_from(call.axis).unwrap_or(0);
        let spindles = &mut self.state.basic.spindles;
        if let Some(axis) = AxisNumber::new(number)
            && let Some(mut link) = areas.link()
            && link.names.axes[axis].is_some()
        {
            let place = spindles.iter().position(|(known, _)| *known == number).unwrap_or_else(|| {
                spindles.push((number, SpinCtrl::default()));
                spindles.len() - 1
            });
            let &SpindleCall { start, stop, function, mode, position, feedrate, .. } = call;
            let inputs = SpinCtrlInputs { start, stop, function, mode, axis, position, feedrate };
            let done = spindles[place].1.run(&mut link, &inputs);
            if let Some(before) = self.observed.as_mut().map(|observed| std::mem::take(&mut observed.from_nck[0])) {
                let range = block_of(axis);
                let first = u32::try_from(range.start * 8).unwrap_or(0);
                let now = &link.from_nck.as_bytes()[range.clone()];
                self.note_changed(before.get(range).unwrap_or_default(), now, |bit| Some(Named::FromNck(first + bit)));
                if let Some(observed) = &mut self.observed {
                    observed.from_nck[0] = before;
                }
            }
            return (done, link.from_nck.axis(axis).positioning_active());
        }
        (if call.start { NO_AXIS } else { SpinCtrlOutputs::default() }, false)
    }
}

/// The bytes of an axis among the signals of the NCK.
fn block_of(axis: AxisNumber) -> Range<usize> {
    let length = size_of::<AxisFromNck>();
    let first = offset_of!(FromNck, axes) + usize::from(axis.number() - 1) * length;
    first..first + length
}

/// The inputs of a call, with the number of its axis.
pub(super) struct SpindleCall {
    pub(super) start: bool,
    pub(super) stop: bool,
    pub(super) function: u8,
    pub(super) mode: u8,
    pub(super) axis: u32,
    pub(super) position: f32,
    pub(super) feedrate: f32,
}
