//! The built-in blocks by their index; the functions for clock, interrupts and the CPU itself.

use crate::plc::step7::engine::{Areas, Cpu, Fault, Spot};
use crate::plc::step7::instruction::{Operand, Width};
use crate::plc::step7::text::constants::days;

use super::interface::{BASIC, SYSTEM, System};

const DAY_MILLIS: i64 = 86_400_000;

impl Cpu {
    /// Runs a built-in block, observed or not.
    pub(super) fn run_built_in<A: Areas>(&mut self, areas: &mut A, index: u16) -> Result<(), Fault> {
        if let Some(basic) = usize::from(index).checked_sub(BASIC) {
            return self.basic_program(areas, basic);
        }
        match SYSTEM[usize::from(index)].system {
            System::SetClock => self.set_clock(areas),
            System::ReadClock => {
                let now = self.date_and_time();
                self.write_element(areas, 1, now)?;
                self.result(areas, 0, 0)
            }
            System::StartInformation => self.start_information(areas),
            System::ReadConsistent => self.read_consistent(areas),
            System::WriteConsistent => self.write_consistent(areas),
            System::BlockMove => self.move_block(areas, [0, 1, 2]),
            System::Fill => self.fill(areas),
            System::UpdateImage => {
                self.set_argument(areas, 2, Width::Word, 0)?;
                self.result(areas, 1, 0)
            }
            // No time passes within a scan.
            System::Retrigger | System::Wait => Ok(()),
            System::DisableInterrupts => self.disable(areas, true),
            System::EnableInterrupts => self.disable(areas, false),
            System::DelayInterrupts => {
                self.state.delayed = self.state.delayed.saturating_add(1);
                let depth = u32::from(self.state.delayed);
                self.result(areas, 0, depth)
            }
            System::AllowInterrupts => {
                // 8080h: SFC 42 without SFC 41.
                let result = match self.state.delayed.checked_sub(1) {
                    Some(left) => {
                        self.state.delayed = left;
                        u32::from(left)
                    }
                    None => 0x8080,
                };
                self.result(areas, 0, result)
            }
            System::Stop => Err(Fault::StopCalled),
            System::TimeTick => {
                let millis = (self.work.now / 1_000_000) & 0x7FFF_FFFF;
                self.set_argument(areas, 0, Width::Double, u32::try_from(millis).unwrap_or(0))
            }
            System::CountUp => self.iec_count_up(areas),
            System::CountDown => self.iec_count_down(areas),
            System::CountUpDown => self.iec_count_up_down(areas),
            System::Pulse | System::OnDelay | System::OffDelay => {
                self.iec_timer(areas, SYSTEM[usize::from(index)].system)
            }
            System::TestBlock => {
                let number = u16::try_from(self.argument(areas, 0, Width::Word)?).unwrap_or(0);
                let block = areas.block(number).filter(|_| number != 0);
                self.set_argument(areas, 2, Width::Word, block.map_or(0, |block| block.length))?;
                self.set_argument(areas, 3, Width::Bit, 0)?;
                // 80B1h: the data block does not exist.
                self.result(areas, 1, if block.is_some() { 0 } else { 0x80B1 })
            }
            System::Answer(code) => self.answer(areas, index, code),
            System::CreateBlock => self.create_block(areas),
            what @ (System::SetHours | System::ControlHours | System::ReadHours) => self.hours(areas, what),
            what @ (System::SetTimeOfDay
            | System::CancelTimeOfDay
            | System::ActivateTimeOfDay
            | System::QueryTimeOfDay) => self.time_of_day(areas, what),
            what @ (System::StartDelay | System::CancelDelay | System::QueryDelay) => self.time_delay(areas, what),
            what @ (System::MaskFaults | System::UnmaskFaults | System::ReadFaults) => self.masks(areas, what),
            System::ReplaceValue => self.replace_value(areas),
            System::DeleteBlock => self.delete_block(areas),
            System::CreateLoaded => self.create_loaded(areas),
            System::MoveLoaded => self.move_loaded(areas),
            System::SetBits(value) => self.set_bits(areas, value),
            System::StateList => self.state_list(areas),
            System::Multicomputing => self.multicomputing(areas),
            System::LongHours => self.long_hours(areas),
            System::Refuse(status) => self.refuse(areas, index, status),
            library => self.library(areas, library),
        }
    }

    /// The value of an elementary parameter.
    pub(in crate::plc::step7) fn argument<A: Areas>(&self, areas: &A, index: u16, width: Width) -> Result<u32, Fault> {
        let spot = self.reference(index)?;
        self.read(areas, spot, width)
    }

    pub(in crate::plc::step7) fn set_argument<A: Areas>(
        &mut self,
        areas: &mut A,
        index: u16,
        width: Width,
        value: u32,
    ) -> Result<(), Fault> {
        let spot = self.reference(index)?;
        self.write(areas, spot, width, value)
    }

    /// `RET_VAL`; BR shows whether it is good.
    pub(in crate::plc::step7) fn result<A: Areas>(
        &mut self,
        areas: &mut A,
        index: u16,
        value: u32,
    ) -> Result<(), Fault> {
        self.state.registers.status.br = value & 0x8000 == 0;
        self.set_argument(areas, index, Width::Word, value)
    }

    /// The place of a parameter that is passed by pointer.
    pub(in crate::plc::step7) fn element<A: Areas>(&mut self, areas: &A, index: u16) -> Result<Spot, Fault> {
        let db = self.state.registers.db;
        let pointer = self.reference(index)?;
        let (number, pointer) = self.read_pointer(areas, pointer)?;
        if number != 0 {
            self.state.registers.db = areas.block(number).ok_or(Fault::NoDataBlock(number))?;
        }
        let spot = self.crossing(own_local_is_the_callers(pointer));
        self.state.registers.db = db;
        spot
    }

    pub(in crate::plc::step7) fn write_element<const N: usize, A: Areas>(
        &mut self,
        areas: &mut A,
        index: u16,
        value: [u8; N],
    ) -> Result<(), Fault> {
        let spot = self.element(areas, index)?;
        self.write_bytes(areas, spot, value)
    }

    /// A variable of the instance of a built-in function block.
    pub(in crate::plc::step7) fn own<A: Areas>(&mut self, areas: &A, byte: u32, bit: u32) -> Result<Spot, Fault> {
        self.spot(areas, Operand::Own(byte * 8 + bit))
    }

    fn set_clock<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let spot = self.element(areas, 0)?;
        let bytes: [u8; 8] = self.read_bytes(areas, spot)?;
        let result = match millis_of(bytes) {
            Some(millis) => {
                self.state.clock_shift += millis - self.clock_millis();
                0
            }
            // 8080h: the date is wrong.
            None => 0x8080,
        };
        self.result(areas, 1, result)
    }

    fn start_information<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let (from, to) = self.work.frames.first().map_or((0, 0), |frame| frame.local);
        let mut running = [0; 20];
        let length = 20.min((to - from) as usize);
        let from = from as usize;
        running[..length].copy_from_slice(&self.state.local[from..from + length]);
        let started = self.state.start_information;
        self.write_element(areas, 1, running)?;
        self.write_element(areas, 2, started)?;
        self.result(areas, 0, 0)
    }
}

/// A built-in block has no local data of its own: pointers to L are to those of its caller, as V.
pub(in crate::plc::step7) fn own_local_is_the_callers(pointer: u32) -> u32 {
    if pointer >> 24 == 0x86 { 0x87 << 24 | pointer & 0x00FF_FFFF } else { pointer }
}

/// Days since 1990-1-1, ms of the day and weekday of a DATE_AND_TIME; `None` if it is none.
pub(in crate::plc::step7) fn parts_of(bytes: [u8; 8]) -> Option<(u32, u32, u32)> {
    let two = |byte: u8| {
        let (high, low) = (u32::from(byte >> 4), u32::from(byte & 0xF));
        (high <= 9 && low <= 9).then_some(high * 10 + low)
    };
    let [year, month, day, hour, minute, second, millis, last] = bytes;
    let year = two(year)?;
    let year = if year < 90 { 2000 + year } else { 1900 + year };
    let (hour, minute, second) = (two(hour)?, two(minute)?, two(second)?);
    let millis = two(millis)? * 10 + u32::from(last >> 4);
    if hour > 23 || minute > 59 || second > 59 || last >> 4 > 9 {
        return None;
    }
    let day = days(year, two(month)?, two(day)?)?;
    Some((day, ((hour * 60 + minute) * 60 + second) * 1000 + millis, (day + 1) % 7 + 1))
}

pub(in crate::plc::step7) fn millis_of(bytes: [u8; 8]) -> Option<i64> {
    let (days, millis, _) = parts_of(bytes)?;
    Some(i64::from(days) * DAY_MILLIS + i64::from(millis))
}
