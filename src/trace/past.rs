//! The state one cycle earlier: the output of a machine before its last step, updated from the rows of the record.
//!
//! An expression with `rose` or `fell` compares two cycles. A caller that evaluates it calls [`Past::begin_step`] before each step and
//! [`Past::end_step`] after it. The memory is copied once at the start; later only the changed bytes are copied.

use super::{Change, Recorder};
use crate::image::{Memory, Part};
use crate::variables::Variables;

/// The output of a machine before its last step.
#[derive(Clone, Debug)]
pub struct Past {
    memory: Memory,
    variables: Variables,
    /// The bytes that the last step changed, with their new values; `memory` contains the old values.
    changed: Vec<(Part, u32, u8)>,
    /// The cycle at whose end `changed` is valid.
    cycle: u64,
    /// The number of rows that the recorder had lost at that time.
    lost: u64,
    /// Whether `changed` contains all differences.
    is_complete: bool,
}

impl Past {
    /// Starts with the memory and the variables after a cycle; the state before it counts as equal.
    #[must_use]
    pub fn new(memory: &Memory, variables: &Variables, cycle: u64) -> Self {
        Self {
            memory: memory.clone(),
            variables: variables.clone(),
            changed: Vec::new(),
            cycle,
            lost: 0,
            is_complete: true,
        }
    }

    /// The memory one cycle earlier.
    #[must_use]
    pub fn memory(&self) -> &Memory {
        &self.memory
    }

    /// The variables one cycle earlier.
    #[must_use]
    pub fn variables(&self) -> &Variables {
        &self.variables
    }

    /// Takes over the output of the machine after this cycle; call it before a step. It allocates only if rows of the record were lost, if
    /// a cycle passed without [`Past::end_step`], or if a PLC program created a data block, whose bytes have no rows.
    pub fn begin_step(&mut self, memory: &Memory, variables: &Variables, cycle: u64) {
        let has_same_blocks = self.memory.blocks.iter().count() == memory.blocks.iter().count();
        if self.is_complete && self.cycle == cycle && has_same_blocks {
            for (part, offset, new) in self.changed.drain(..) {
                if let Some(byte) = self.memory.part_mut(part).get_mut(offset as usize) {
                    *byte = new;
                }
            }
        } else {
            self.memory = memory.clone();
            (self.cycle, self.is_complete) = (cycle, true);
            self.changed.clear();
        }
        self.variables.axes = variables.axes;
        self.variables.channels = variables.channels;
        self.variables.r_parameters.take_over(&variables.r_parameters);
        if self.variables.alarms != variables.alarms {
            self.variables.alarms = variables.alarms.clone();
        }
    }

    /// Records the bytes that the step of this cycle changed; call it after the step and before its record is drained.
    pub fn end_step(&mut self, recorder: &Recorder, cycle: u64) {
        self.changed.clear();
        for row in recorder.rows().iter().rev().take_while(|row| row.cycle == cycle) {
            match row.change {
                Change::Byte { part, offset, new, .. } => self.changed.push((part, offset, new)),
                Change::Alarm { .. } | Change::Happened { .. } | Change::Overwritten { .. } | Change::NoEffect(_) => {}
            }
        }
        self.is_complete = cycle == self.cycle + 1 && recorder.lost() == self.lost;
        (self.cycle, self.lost) = (cycle, recorder.lost());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::{By, Row};
    use crate::variables::EventId;

    fn flag(cycle: u64, offset: u32, old: u8, new: u8) -> Row {
        let (part, by, causes) = (Part::Flags, [By::Plc; 8], [EventId::NONE; 8]);
        Row { cycle, change: Change::Byte { part, offset, old, new, by, causes } }
    }

    #[test]
    fn the_memory_follows_one_cycle_later_from_rows_only() {
        let (mut memory, variables, mut recorder) = (Memory::new(), Variables::default(), Recorder::default());
        let mut past = Past::new(&memory, &variables, 7);
        for (cycle, new) in [(8, 1), (9, 3), (10, 3)] {
            past.begin_step(&memory, &variables, cycle - 1);
            let old = memory.flags.byte(20);
            memory.flags.set_byte(20, new);
            if new != old {
                recorder.push(flag(cycle, 20, old, new)); // never drained: rows of earlier cycles are ignored
            }
            past.end_step(&recorder, cycle);
            assert_eq!(past.memory().flags.byte(20), old, "cycle {cycle}");
        }
        past.begin_step(&memory, &variables, 10);
        assert_eq!(past.memory(), &memory);
    }

    #[test]
    fn changes_without_rows_cause_a_full_copy() {
        let (mut memory, variables, recorder) = (Memory::new(), Variables::default(), Recorder::default());
        let mut past = Past::new(&memory, &variables, 0);
        past.begin_step(&memory, &variables, 0);
        memory.flags.set_byte(20, 1);
        past.begin_step(&memory, &variables, 1); // `end_step` was not called
        assert_eq!(past.memory(), &memory);
        let number = 1_000;
        memory.blocks.put(crate::image::DataBlock { number, name: None, bytes: vec![1; 4].into() });
        past.end_step(&recorder, 2);
        past.begin_step(&memory, &variables, 2);
        assert_eq!(past.memory(), &memory);
        let mut full = Recorder::default();
        for _ in 0..=Recorder::ROWS {
            full.push(flag(3, 20, 1, 2));
        }
        memory.flags.set_byte(21, 1); // the row of this change was lost
        past.end_step(&full, 3);
        past.begin_step(&memory, &variables, 3);
        assert_eq!(past.memory(), &memory);
    }
}
