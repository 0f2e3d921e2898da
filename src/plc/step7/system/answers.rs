//! System functions for what the simulator does not have (modules, stations, messages): their answers; hours meters (SFC 2 to 4), the
//! substitute value of a failed read (SFC 44), data blocks that the program makes (SFC 22).

use crate::plc::step7::engine::{Areas, Cpu, Fault, HoursMeter};
use crate::plc::step7::instruction::Width;
use crate::plc::step7::text::types::Section;

use super::interface::{Kind, SYSTEM, System};

const HOUR_NANOS: i64 = 3_600_000_000_000;

impl Cpu {
    /// A call that does nothing: RET_VAL, and 0 in the other outputs.
    pub(in crate::plc::step7) fn answer<A: Areas>(
        &mut self,
        areas: &mut A,
        index: u16,
        code: u16,
    ) -> Result<(), Fault> {
        let parameters = SYSTEM[usize::from(index)].parameters;
        for (place, &(name, section, kind)) in (0..).zip(parameters) {
            let width = match kind {
                Kind::Bool => Width::Bit,
                Kind::Byte => Width::Byte,
                Kind::Word | Kind::Int => Width::Word,
                Kind::DWord | Kind::DInt => Width::Double,
                _ => continue,
            };
            if name == "RET_VAL" {
                self.result(areas, place, code.into())?;
            } else if section == Section::Output {
                self.set_argument(areas, place, width, 0)?;
            }
        }
        Ok(())
    }

    pub(in crate::plc::step7) fn hours<A: Areas>(&mut self, areas: &mut A, what: System) -> Result<(), Fault> {
        let number = self.argument(areas, 0, Width::Byte)? as usize;
        let place = if what == System::ReadHours { 1 } else { 2 };
        let now = self.work.now;
        let Some(meter) = self.state.hours.get(number).copied() else {
            if what == System::ReadHours {
                self.set_argument(areas, 2, Width::Bit, 0)?;
                self.set_argument(areas, 3, Width::Word, 0)?;
            }
            // There is no meter with this number.
            return self.result(areas, place, 0x8080);
        };
        let mut result = 0;
        match what {
            System::SetHours => {
                let value = self.argument(areas, 1, Width::Word)?;
                if value > 0x7FFF {
                    // A negative value.
                    result = 0x8081;
                } else {
                    let since = meter.since.map(|_| now);
                    self.state.hours[number] = HoursMeter { counted: i64::from(value) * HOUR_NANOS, since };
                }
            }
            System::ControlHours => {
                let runs = self.argument(areas, 1, Width::Bit)? == 1;
                let stopped = meter.stopped(now);
                let since = meter.since.or(Some(now));
                self.state.hours[number] = if runs { HoursMeter { since, ..meter } } else { stopped };
            }
            _ => {
                let hours = meter.nanos(now) / HOUR_NANOS;
                if hours > 0x7FFF {
                    // It is beyond its end.
                    result = 0x8081;
                }
                self.set_argument(areas, 2, Width::Bit, meter.since.is_some().into())?;
                self.set_argument(areas, 3, Width::Word, u32::try_from(hours.min(0x7FFF)).unwrap_or(0))?;
            }
        }
        self.result(areas, place, result)
    }

    /// REPL_VAL: what ACCU1 has after OB121 or OB122.
    pub(in crate::plc::step7) fn replace_value<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let value = self.argument(areas, 0, Width::Double)?;
        if !self.work.in_error {
            // It was not called within an error block.
            return self.result(areas, 1, 0x8080);
        }
        self.work.replacement = Some(value);
        self.result(areas, 1, 0)
    }

    /// CREAT_DB: the first spare number from LOW_LIMIT to UP_LIMIT gets a data block of COUNT bytes.
    pub(in crate::plc::step7) fn create_block<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let number = |value: u32| u16::try_from(value).unwrap_or(0);
        let low = number(self.argument(areas, 0, Width::Word)?);
        let high = number(self.argument(areas, 1, Width::Word)?);
        let count = number(self.argument(areas, 2, Width::Word)?);
        let (result, made) = if low == 0 || high < low {
            (0x80A1, 0)
        } else if count == 0 || count % 2 == 1 {
            (0x80A2, 0)
        } else {
            match (low..=high).find(|number| areas.block(*number).is_none()) {
                None => (0x80B1, 0),
                Some(spare) if areas.create(spare, count) => (0, spare),
                Some(_) => (0x80B2, 0),
            }
        };
        self.set_argument(areas, 4, Width::Word, made.into())?;
        self.result(areas, 3, result)
    }
}
