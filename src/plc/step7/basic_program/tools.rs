//! FC 6 and FC 8 (TM_TRANS), FC 7 (TM_REV), FC 22 (TM_DIR): the PLC's side of a tool change, with a magazine and a load point (P-138).
//!
//! The simulated NC has no tool management: the jobs in DB71 to DB73 are set by a test, as the NC would set them. A report that a job is done or
//! cancelled ends it: the active bit of its interface goes.

use crate::plc::step7::engine::{Areas, Cpu, Fault, Spot, Where};
use crate::plc::step7::instruction::Width;

/// Status of FC 8: the job is done, or cancelled.
const DONE: u32 = 1;
const CANCELLED: u32 = 3;

/// The last intermediate step.
const LAST_STEP: u32 = 105;

/// Error numbers: the task does not exist, its interface is not active, the status is none.
const NO_TASK: u32 = 1;
const NOT_ACTIVE: u32 = 2;
const NO_STATUS: u32 = 3;

impl Cpu {
    /// FC 6, FC 8: Start, TaskIdent, TaskIdentNo, four positions, Status; Ready, Error.
    pub(super) fn tool_transfer<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let start = self.is_on(areas, 0)?;
        let task = self.argument(areas, 1, Width::Byte)?;
        let number = self.argument(areas, 2, Width::Byte)?;
        let status = self.argument(areas, 7, Width::Word)?;
        let error = if start { self.end_task(areas, task, number, status) } else { Ok(()) };
        self.set_output(areas, 8, Width::Bit, (start && error.is_ok()).into())?;
        self.set_output(areas, 9, Width::Word, error.err().unwrap_or(0))
    }

    /// FC 7: Start, ChgdRevNo; Ready, Error.
    pub(super) fn tool_revolver<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let start = self.is_on(areas, 0)?;
        let number = self.argument(areas, 1, Width::Byte)?;
        let error = if start { self.end_task(areas, 3, number, DONE) } else { Ok(()) };
        self.set_output(areas, 2, Width::Bit, (start && error.is_ok()).into())?;
        self.set_output(areas, 3, Width::Word, error.err().unwrap_or(0))
    }

    /// Reports the status of a task: load point (1, DB71), spindle (2, DB72), turret (3, DB73); asynchronous transfers (4, 5) have no interface.
    fn end_task<A: Areas>(&mut self, areas: &mut A, task: u32, number: u32, status: u32) -> Result<(), u32> {
        let ends = match status {
            DONE | CANCELLED => true,
            2 | 4..=LAST_STEP => false,
            _ => return Err(NO_STATUS),
        };
        let block = match task {
            1 => 71,
            2 => 72,
            3 => 73,
            4 | 5 => return Ok(()),
            _ => return Err(NO_TASK),
        };
        let index = number.checked_sub(1).filter(|index| *index < 16).ok_or(NO_TASK)?;
        let tasks = areas.block(block).ok_or(NO_TASK)?;
        let spot = Spot { at: Where::Block(tasks), bit: index };
        let is_active = self.read_bit(areas, spot).map_err(|_| NO_TASK)?;
        if is_active && ends {
            self.note_called(areas, spot, 1, (1, 0));
            self.write_bit(areas, spot, false).map_err(|_| NO_TASK)?;
            self.state.basic.ended_tasks[block as usize - 71] |= 1 << index;
        }
        // The call repeats its report while Start is 1.
        let was_ended = self.state.basic.ended_tasks[block as usize - 71] >> index & 1 == 1;
        if !ends {
            self.state.basic.ended_tasks[block as usize - 71] &= !(1 << index);
        }
        if is_active || was_ended { Ok(()) } else { Err(NOT_ACTIVE) }
    }

    /// FC 22: MagNo, ReqPos, ActPos, Offset, Start; Cw, Ccw, InPos, Diff, Error. The number of locations of magazine n is the integer at
    /// DB74.DBW(2 × n).
    pub(super) fn tool_direction<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let [magazine, wanted, actual] = [0, 1, 2].map(|index| self.argument(areas, index, Width::Word));
        let (magazine, wanted, actual) = (magazine?, wanted?, actual?);
        let offset = self.argument(areas, 3, Width::Byte)?;
        let start = self.is_on(areas, 4)?;
        let count = areas.block(74).and_then(|block| areas.read::<2>(block, magazine.min(0x7FFF) * 2));
        let count = count.map_or(0, |bytes| u32::from(u16::from_be_bytes(bytes)));
        let is_there = |position: u32| (1..=count).contains(&position);
        let is_good = magazine > 0 && is_there(wanted) && is_there(actual);
        let (mut forwards, mut backwards, mut in_position, mut distance) = (false, false, false, 0);
        if start && is_good {
            let target = (wanted - 1 + offset) % count + 1;
            let ahead = (target + count - actual) % count;
            distance = ahead.min(count - ahead);
            in_position = ahead == 0;
            forwards = !in_position && ahead <= count - ahead;
            backwards = !in_position && !forwards;
        }
        for (index, value) in [(5, forwards), (6, backwards), (7, in_position), (9, start && !is_good)] {
            self.set_output(areas, index, Width::Bit, value.into())?;
        }
        self.set_output(areas, 8, Width::Word, distance)
    }
}
