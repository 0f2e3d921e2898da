//! FC 15 (POS_AX) and FC 16 (PART_AX) of the powerline, on the function of FC 18; FC 9 (ASUP).

use crate::plc::step7::engine::{Areas, Cpu, Fault, Spot, Where};
use crate::plc::step7::instruction::Width;

use super::spindles::SpindleCall;

/// State 20 and 40 of FC 18: the movement could not be started.
const NOT_STARTED: [u8; 2] = [20, 40];

impl Cpu {
    /// FC 15: Start, AxisNo, IC, Inch, HWheelOv, Pos, FRate; InPos, Activ, StartErr, Error.
    pub(super) fn position_axis<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let function = match (self.is_on(areas, 3)?, self.is_on(areas, 4)?) {
            (false, false) => 5,
            (true, false) => 6,
            (false, true) => 7,
            (true, true) => 8,
        };
        let call = SpindleCall {
            start: self.is_on(areas, 0)?,
            stop: false,
            function,
            mode: self.is_on(areas, 2)?.into(),
            axis: self.argument(areas, 1, Width::Byte)?,
            position: f32::from_bits(self.argument(areas, 5, Width::Double)?),
            feedrate: f32::from_bits(self.argument(areas, 6, Width::Double)?),
        };
        self.single_axis(areas, &call, 7)
    }

    /// FC 16: Start, AxisNo, IC, DC, Minus, Plus, Pos, FRate; InPos, Activ, StartErr, Error.
    pub(super) fn index_axis<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let mut mode = 0;
        // Of several ways the first one counts.
        for (index, way) in [(5, 3), (4, 4), (3, 2), (2, 1)] {
            if self.is_on(areas, index)? {
                mode = way;
            }
        }
        let position = self.argument(areas, 6, Width::Word)?;
        let call = SpindleCall {
            start: self.is_on(areas, 0)?,
            stop: false,
            function: 4,
            mode,
            axis: self.argument(areas, 1, Width::Byte)?,
            position: f32::from(u16::try_from(position).unwrap_or(0).cast_signed()),
            feedrate: f32::from_bits(self.argument(areas, 7, Width::Double)?),
        };
        self.single_axis(areas, &call, 8)
    }

    /// Runs a call and writes its four outputs.
    fn single_axis<A: Areas>(&mut self, areas: &mut A, call: &SpindleCall, first: u16) -> Result<(), Fault> {
        let (done, is_active) = self.run_spindle(areas, call);
        let start_error = NOT_STARTED.contains(&done.state);
        for (index, value) in (first..).zip([done.in_position, is_active, start_error, done.error]) {
            self.set_output(areas, index, Width::Bit, value.into())?;
        }
        Ok(())
    }

    /// FC 9: Start, ChanNo, IntNo; Active, Done, Error, StartErr, and Ref. The simulated NC has no interrupt routines, so a start is refused: StartErr,
    /// also in DB19.DBX45.3 (P-139).
    pub(super) fn interrupt_routine<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let start = self.is_on(areas, 0)?;
        for (index, value) in (3..).zip([false, false, false, start]) {
            self.set_output(areas, index, Width::Bit, value.into())?;
        }
        let Some(block) = areas.block(19) else { return Ok(()) };
        for (bit, value) in [(0, false), (1, false), (2, false), (3, start)] {
            let spot = Spot { at: Where::Block(block), bit: 45 * 8 + bit };
            let before = self.read_bit(areas, spot)?;
            if before != value {
                self.note_called(areas, spot, 1, (before.into(), value.into()));
                self.write_bit(areas, spot, value)?;
            }
        }
        Ok(())
    }
}
