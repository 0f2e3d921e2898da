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

    /// RTM: an hours meter with 32 bits. MODE 0 reads it; 1 starts it, 2 stops it; 4 sets it to PV, 5 and starts it, 6 and stops it.
    pub(in crate::plc::step7) fn long_hours<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let number = self.argument(areas, 0, Width::Byte)? as usize;
        let mode = self.argument(areas, 1, Width::Byte)?;
        let preset = self.argument(areas, 2, Width::Double)?.cast_signed();
        let now = self.work.now;
        let Some(meter) = self.state.hours.get(number).copied() else {
            self.set_argument(areas, 4, Width::Bit, 0)?;
            self.set_argument(areas, 5, Width::Double, 0)?;
            return self.result(areas, 3, 0x8080);
        };
        let counted = i64::from(preset).saturating_mul(HOUR_NANOS);
        let (after, result) = match mode {
            0 => (meter, 0),
            1 => (HoursMeter { since: meter.since.or(Some(now)), ..meter }, 0),
            2 => (meter.stopped(now), 0),
            4..=6 if preset < 0 => (meter, 0x8081),
            4 => (HoursMeter { counted, since: meter.since.map(|_| now) }, 0),
            5 => (HoursMeter { counted, since: Some(now) }, 0),
            6 => (HoursMeter { counted, since: None }, 0),
            // A MODE that does not exist.
            _ => (meter, 0x8082),
        };
        self.state.hours[number] = after;
        let hours = (after.nanos(now) / HOUR_NANOS).clamp(0, i64::from(i32::MAX));
        self.set_argument(areas, 4, Width::Bit, after.since.is_some().into())?;
        self.set_argument(areas, 5, Width::Double, u32::try_from(hours).unwrap_or(0))?;
        self.result(areas, 3, result)
    }

    /// CREAT_DB: the first spare number from LOW_LIMIT to UP_LIMIT gets a data block of COUNT bytes.
    pub(in crate::plc::step7) fn create_block<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let (result, made) = self.make_block(areas, [0, 1, 2])?;
        self.set_argument(areas, 4, Width::Word, made.into())?;
        self.result(areas, 3, result)
    }

    /// The result and the number of a new data block, with the parameters of its limits and its length.
    pub(super) fn make_block<A: Areas>(&mut self, areas: &mut A, parameters: [u16; 3]) -> Result<(u32, u16), Fault> {
        let mut values = [0; 3];
        for (value, parameter) in values.iter_mut().zip(parameters) {
            *value = u16::try_from(self.argument(areas, parameter, Width::Word)?).unwrap_or(0);
        }
        let [low, high, count] = values;
        Ok(if low == 0 || high < low {
            (0x80A1, 0)
        } else if count == 0 || count % 2 == 1 {
            (0x80A2, 0)
        } else {
            match (low..=high).find(|number| areas.block(*number).is_none()) {
                None => (0x80B1, 0),
                Some(spare) if areas.create(spare, count) => (0, spare),
                Some(_) => (0x80B2, 0),
            }
        })
    }
}
