//! SFC 28 to 34: time-of-day and time-delay interrupts; SFC 36 to 38: masked faults; SFC 39 and 40: disabled interrupts.

use crate::plc::step7::engine::{Areas, Cpu, Delay, Fault, Period, TimeOfDay};
use crate::plc::step7::instruction::{BlockKind, Width};

use super::dispatch::millis_of;
use super::interface::System;

/// The number of an organization block is wrong.
const NUMBER: u32 = 0x8090;
/// The interrupt was not set, or not started.
const NOT_SET: u32 = 0x80A0;
/// The time is over.
const OVER: u32 = 0x80A1;
/// The longest time of SFC 32, in ms.
const LONGEST: i32 = 60_000;
const MILLI_NANOS: i64 = 1_000_000;

impl Cpu {
    /// The index of the block in the parameter OB_NR within its class.
    fn block_of_class<A: Areas>(&self, areas: &A, first: u32, count: u32) -> Result<Option<usize>, Fault> {
        let number = self.argument(areas, 0, Width::Word)?;
        Ok(number.checked_sub(first).filter(|index| *index < count).map(|index| index as usize))
    }

    pub(in crate::plc::step7) fn time_of_day<A: Areas>(&mut self, areas: &mut A, what: System) -> Result<(), Fault> {
        let index = self.block_of_class(areas, 10, 8)?;
        let place = if what == System::SetTimeOfDay { 3 } else { 1 };
        let clock = self.clock_millis();
        let Some(index) = index else {
            if what == System::QueryTimeOfDay {
                self.set_argument(areas, 2, Width::Word, 0)?;
            }
            return self.result(areas, place, NUMBER);
        };
        let result = match what {
            System::SetTimeOfDay => {
                let spot = self.element(areas, 1)?;
                let start = millis_of(self.read_bytes(areas, spot)?);
                let period = Period::of(self.argument(areas, 2, Width::Word)?);
                match (start, period) {
                    (None, _) => 0x8091,
                    (_, None) => 0x8092,
                    (Some(start), Some(period)) => {
                        // Seconds and milliseconds do not count.
                        let start = start - start % 60_000;
                        if period == Period::Once && start <= clock {
                            OVER
                        } else {
                            self.state.interrupts.times[index] = Some(TimeOfDay { start, period, next: None });
                            0
                        }
                    }
                }
            }
            System::CancelTimeOfDay => {
                let was_set = self.state.interrupts.times[index].take().is_some();
                if was_set { 0 } else { NOT_SET }
            }
            System::ActivateTimeOfDay => match &mut self.state.interrupts.times[index] {
                None => NOT_SET,
                Some(set) => {
                    set.next = set.period.after(set.start, clock - 1);
                    if set.next.is_some() { 0 } else { OVER }
                }
            },
            _ => {
                let is_active = self.state.interrupts.times[index].is_some_and(|set| set.next.is_some());
                let status = self.status_of(10 + index, is_active);
                self.set_argument(areas, 2, Width::Word, status)?;
                0
            }
        };
        self.result(areas, place, result)
    }

    pub(in crate::plc::step7) fn time_delay<A: Areas>(&mut self, areas: &mut A, what: System) -> Result<(), Fault> {
        let index = self.block_of_class(areas, 20, 4)?;
        let place = if what == System::StartDelay { 3 } else { 1 };
        let Some(index) = index else {
            if what == System::QueryDelay {
                self.set_argument(areas, 2, Width::Word, 0)?;
            }
            return self.result(areas, place, NUMBER);
        };
        let result = match what {
            System::StartDelay => {
                let millis = self.argument(areas, 1, Width::Double)?.cast_signed();
                let sign = u16::try_from(self.argument(areas, 2, Width::Word)?).unwrap_or(0);
                if (1..=LONGEST).contains(&millis) {
                    let due = self.work.now.saturating_add(i64::from(millis) * MILLI_NANOS);
                    let millis = millis.cast_unsigned();
                    self.state.interrupts.delays[index] = Some(Delay { due, millis, sign });
                    0
                } else {
                    0x8091
                }
            }
            System::CancelDelay => {
                let was_started = self.state.interrupts.delays[index].take().is_some();
                if was_started { 0 } else { NOT_SET }
            }
            _ => {
                let status = self.status_of(20 + index, self.state.interrupts.delays[index].is_some());
                self.set_argument(areas, 2, Width::Word, status)?;
                0
            }
        };
        self.result(areas, place, result)
    }

    /// STATUS of SFC 31 and 34: bit 1 new ones are rejected, bit 2 activated, bit 4 the block is loaded.
    fn status_of(&self, number: usize, is_active: bool) -> u32 {
        let is_disabled = self.state.interrupts.disabled >> number & 1 == 1;
        let is_loaded = u16::try_from(number).is_ok_and(|number| self.program.find(BlockKind::Ob, number).is_some());
        u32::from(is_disabled) << 1 | u32::from(is_active) << 2 | u32::from(is_loaded) << 4
    }

    /// SFC 39 and 40, with MODE 0 (all), 1 (a class) and 2 (one block); 80h to 82h are the same without an entry in the diagnostic buffer.
    pub(in crate::plc::step7) fn disable<A: Areas>(&mut self, areas: &mut A, is_disabled: bool) -> Result<(), Fault> {
        let mode = self.argument(areas, 0, Width::Byte)? & 0x7F;
        let number = self.argument(areas, 1, Width::Word)?;
        let class = |first: u32| match first {
            10 => 0xFF << 10,
            20 => 0xF << 20,
            30 => 0x1FF << 30,
            40 => 0xFF << 40,
            _ => 0_u64,
        };
        let all = class(10) | class(20) | class(30) | class(40);
        let blocks = match mode {
            0 => Ok(all),
            1 => Some(class(number)).filter(|blocks| *blocks != 0).ok_or(NUMBER),
            2 => Some(1_u64.checked_shl(number).unwrap_or(0) & all).filter(|blocks| *blocks != 0).ok_or(NUMBER),
            // A wrong MODE.
            _ => Err(0x8091),
        };
        let disabled = &mut self.state.interrupts.disabled;
        let result = match blocks {
            Ok(blocks) if is_disabled => {
                *disabled |= blocks;
                0
            }
            Ok(blocks) => {
                *disabled &= !blocks;
                0
            }
            Err(error) => error,
        };
        self.result(areas, 2, result)
    }

    /// SFC 36 to 38. They act until the end of the organization block.
    pub(in crate::plc::step7) fn masks<A: Areas>(&mut self, areas: &mut A, what: System) -> Result<(), Fault> {
        let asked = [self.argument(areas, 0, Width::Double)?, self.argument(areas, 1, Width::Double)?];
        let masks = &mut self.work.masks;
        let mut is_other = false;
        let mut shown = [0; 2];
        for ((asked, shown), filter) in asked.into_iter().zip(&mut shown).zip(masks) {
            match what {
                System::MaskFaults => {
                    is_other |= filter.masked & asked != 0;
                    filter.masked |= asked;
                    *shown = filter.masked;
                }
                System::UnmaskFaults => {
                    is_other |= asked & !filter.masked != 0;
                    filter.masked &= !asked;
                    *shown = filter.masked;
                }
                _ => {
                    is_other |= asked & !filter.masked != 0;
                    *shown = filter.seen & asked;
                    filter.seen &= !asked;
                }
            }
        }
        self.set_argument(areas, 3, Width::Double, shown[0])?;
        self.set_argument(areas, 4, Width::Double, shown[1])?;
        self.result(areas, 2, u32::from(is_other))
    }
}
