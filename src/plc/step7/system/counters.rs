//! SFB 0 to 5: IEC counters and timers, with their data in the instance.

use crate::plc::step7::engine::{Areas, Cpu, Fault};
use crate::plc::step7::instruction::Width;

use super::interface::System;

impl Cpu {
    fn own_bit<A: Areas>(&mut self, areas: &A, byte: u32, bit: u32) -> Result<bool, Fault> {
        let spot = self.own(areas, byte, bit)?;
        self.read_bit(areas, spot)
    }

    fn set_own_bit<A: Areas>(&mut self, areas: &mut A, byte: u32, bit: u32, value: bool) -> Result<(), Fault> {
        let spot = self.own(areas, byte, bit)?;
        self.write_bit(areas, spot, value)
    }

    fn own_int<A: Areas>(&mut self, areas: &A, byte: u32) -> Result<i16, Fault> {
        let spot = self.own(areas, byte, 0)?;
        self.read_bytes(areas, spot).map(i16::from_be_bytes)
    }

    fn set_own_int<A: Areas>(&mut self, areas: &mut A, byte: u32, value: i16) -> Result<(), Fault> {
        let spot = self.own(areas, byte, 0)?;
        self.write_bytes(areas, spot, value.to_be_bytes())
    }

    fn own_double<A: Areas>(&mut self, areas: &A, byte: u32) -> Result<i32, Fault> {
        let spot = self.own(areas, byte, 0)?;
        self.read(areas, spot, Width::Double).map(u32::cast_signed)
    }

    fn set_own_double<A: Areas>(&mut self, areas: &mut A, byte: u32, value: i32) -> Result<(), Fault> {
        let spot = self.own(areas, byte, 0)?;
        self.write(areas, spot, Width::Double, value.cast_unsigned())
    }

    /// CTU: CU 0.0, R 0.1, PV 2; Q 4.0, CV 6; the last CU 8.0.
    pub(in crate::plc::step7) fn iec_count_up<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let (up, reset) = (self.own_bit(areas, 0, 0)?, self.own_bit(areas, 0, 1)?);
        let rises = up && !self.own_bit(areas, 8, 0)?;
        let mut value = self.own_int(areas, 6)?;
        if reset {
            value = 0;
        } else if rises {
            value = value.saturating_add(1);
        }
        self.set_own_bit(areas, 8, 0, up)?;
        self.set_own_int(areas, 6, value)?;
        let preset = self.own_int(areas, 2)?;
        self.set_own_bit(areas, 4, 0, value >= preset)
    }

    /// CTD: CD 0.0, LOAD 0.1, PV 2; Q 4.0, CV 6; the last CD 8.0.
    pub(in crate::plc::step7) fn iec_count_down<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let (down, load) = (self.own_bit(areas, 0, 0)?, self.own_bit(areas, 0, 1)?);
        let falls = down && !self.own_bit(areas, 8, 0)?;
        let mut value = self.own_int(areas, 6)?;
        if load {
            value = self.own_int(areas, 2)?;
        } else if falls {
            value = value.saturating_sub(1);
        }
        self.set_own_bit(areas, 8, 0, down)?;
        self.set_own_int(areas, 6, value)?;
        self.set_own_bit(areas, 4, 0, value <= 0)
    }

    /// CTUD: CU 0.0, CD 0.1, R 0.2, LOAD 0.3, PV 2; QU 4.0, QD 4.1, CV 6; the last CU 8.0 and CD 8.1. R wins, then LOAD.
    pub(in crate::plc::step7) fn iec_count_up_down<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let (up, down) = (self.own_bit(areas, 0, 0)?, self.own_bit(areas, 0, 1)?);
        let (reset, load) = (self.own_bit(areas, 0, 2)?, self.own_bit(areas, 0, 3)?);
        let rises = up && !self.own_bit(areas, 8, 0)?;
        let falls = down && !self.own_bit(areas, 8, 1)?;
        let preset = self.own_int(areas, 2)?;
        let mut value = self.own_int(areas, 6)?;
        if reset {
            value = 0;
        } else if load {
            value = preset;
        } else if rises != falls {
            value = if rises { value.saturating_add(1) } else { value.saturating_sub(1) };
        }
        self.set_own_bit(areas, 8, 0, up)?;
        self.set_own_bit(areas, 8, 1, down)?;
        self.set_own_int(areas, 6, value)?;
        self.set_own_bit(areas, 4, 0, value >= preset)?;
        self.set_own_bit(areas, 4, 1, value <= 0)
    }

    /// TP, TON, TOF: IN 0.0, PT 2; Q 6.0, ET 8; then the state: runs 12.0, the last IN 12.1, the start in ms 14.
    pub(in crate::plc::step7) fn iec_timer<A: Areas>(&mut self, areas: &mut A, kind: System) -> Result<(), Fault> {
        let input = self.own_bit(areas, 0, 0)?;
        let preset = self.own_double(areas, 2)?.max(0);
        let mut runs = self.own_bit(areas, 12, 0)?;
        let last = self.own_bit(areas, 12, 1)?;
        let tick = (self.work.now / 1_000_000) & 0x7FFF_FFFF;
        let tick = i32::try_from(tick).unwrap_or(0);
        let mut start = self.own_double(areas, 14)?;
        let begins = match kind {
            System::Pulse => input && !last && !runs,
            System::OnDelay => input && !last,
            _ => !input && last,
        };
        if begins {
            runs = true;
            start = tick;
        }
        // The tick wraps after 24 days.
        let elapsed = (tick.wrapping_sub(start) & 0x7FFF_FFFF).min(preset);
        let (output, time) = match kind {
            System::Pulse => {
                let is_over = runs && elapsed >= preset;
                let time = if runs { elapsed } else { 0 };
                if is_over && !input {
                    runs = false;
                }
                (runs && !is_over, if is_over && !input { 0 } else { time })
            }
            System::OnDelay => {
                runs &= input;
                (runs && elapsed >= preset, if runs { elapsed } else { 0 })
            }
            _ => {
                runs &= !input;
                let time = if runs { elapsed } else { 0 };
                (input || runs && elapsed < preset, time)
            }
        };
        self.set_own_bit(areas, 12, 0, runs)?;
        self.set_own_bit(areas, 12, 1, input)?;
        self.set_own_double(areas, 14, start)?;
        self.set_own_bit(areas, 6, 0, output)?;
        self.set_own_double(areas, 8, time)
    }
}
