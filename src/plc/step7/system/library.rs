//! Functions of the IEC and converting libraries, which sources call by the numbers that their project gave them.
#![expect(clippy::cast_possible_truncation, reason = "values are within their ranges where they are converted")]

use crate::plc::step7::engine::{Areas, Cpu, Fault};
use crate::plc::step7::instruction::Width;
use crate::plc::step7::text::constants::{date_time_of, s5time_of};

use super::dispatch::parts_of;
use super::interface::System;
use super::transfer::Region;

/// The largest analog value of SCALE and UNSCALE.
const FULL_SCALE: f32 = 27_648.0;

impl Cpu {
    pub(in crate::plc::step7) fn library<A: Areas>(&mut self, areas: &mut A, function: System) -> Result<(), Fault> {
        self.state.registers.status.br = true;
        match function {
            System::TimerToTime => {
                let value = self.argument(areas, 0, Width::Word)?;
                let digit = |place: u32| value >> place & 0xF;
                if digit(0) > 9 || digit(4) > 9 || digit(8) > 9 {
                    self.state.registers.status.br = false;
                    return self.set_argument(areas, 1, Width::Double, 0);
                }
                let count = digit(8) * 100 + digit(4) * 10 + digit(0);
                self.set_argument(areas, 1, Width::Double, count * 10 * 10_u32.pow(value >> 12 & 3))
            }
            System::TimeToTimer => {
                let value = self.argument(areas, 0, Width::Double)?.cast_signed();
                let timer = s5time_of(i64::from(value));
                self.state.registers.status.br = timer.is_some();
                self.set_argument(areas, 1, Width::Word, u32::from(timer.unwrap_or(0x3999)))
            }
            System::Limit => self.limit(areas),
            System::Maximum => self.extreme(areas, |new, old| new > old),
            System::Minimum => self.extreme(areas, |new, old| new < old),
            System::Scale => self.scale(areas),
            System::Unscale => self.unscale(areas),
            System::DateOf => {
                let days = self.date_time(areas, 0)?.map_or(0, |(days, ..)| days);
                self.set_argument(areas, 1, Width::Word, days)
            }
            System::TimeOfDayOf => {
                let millis = self.date_time(areas, 0)?.map_or(0, |(_, millis, _)| millis);
                self.set_argument(areas, 1, Width::Double, millis)
            }
            System::WeekdayOf => {
                let weekday = self.date_time(areas, 0)?.map_or(0, |(.., weekday)| weekday);
                self.set_argument(areas, 1, Width::Word, weekday)
            }
            System::DateAndTime => {
                let days = self.argument(areas, 0, Width::Word)?;
                let millis = self.argument(areas, 1, Width::Double)?;
                // Years up to 2089 have two digits of their own.
                let is_possible = days <= 36_523 && millis < 86_400_000;
                self.state.registers.status.br = is_possible;
                let value = if is_possible { date_time_of(days, millis) } else { date_time_of(0, 0) };
                self.write_element(areas, 2, value)
            }
            System::IntToText => {
                let value = self.argument(areas, 0, Width::Word)? as u16;
                self.number_to_text(areas, i64::from(value.cast_signed()))
            }
            System::DoubleToText => {
                let value = self.argument(areas, 0, Width::Double)?;
                self.number_to_text(areas, i64::from(value.cast_signed()))
            }
            System::TextToInt => {
                let value = self.text_to_number(areas, i64::from(i16::MIN), i64::from(i16::MAX))?;
                self.set_argument(areas, 1, Width::Word, (value as i32).cast_unsigned())
            }
            System::TextToDouble => {
                let value = self.text_to_number(areas, i64::from(i32::MIN), i64::from(i32::MAX))?;
                self.set_argument(areas, 1, Width::Double, (value as i32).cast_unsigned())
            }
            System::TextEqual
            | System::TextNotEqual
            | System::TextGreater
            | System::TextGreaterEqual
            | System::TextLess
            | System::TextLessEqual => self.compare_texts(areas, function),
            System::DateEqual
            | System::DateNotEqual
            | System::DateGreater
            | System::DateGreaterEqual
            | System::DateLess
            | System::DateLessEqual => self.compare_dates(areas, function),
            System::DateLater => self.shift_date(areas, true),
            System::DateEarlier => self.shift_date(areas, false),
            System::DateDifference => self.difference_of_dates(areas),
            System::RealToText => self.real_to_text(areas),
            System::TextToReal => self.text_to_real(areas),
            System::Length | System::Find => self.text_number(areas, function),
            System::Left => self.text_end(areas, true),
            System::Right => self.text_end(areas, false),
            System::Middle => self.text_middle(areas),
            System::Concatenate => self.text_join(areas),
            System::Insert => self.text_insert(areas),
            System::Delete => self.text_delete(areas),
            System::Replace => self.text_replace(areas),
            System::Select => self.select(areas),
            System::BitSum => {
                let value = self.argument(areas, 0, Width::Double)?;
                self.set_argument(areas, 1, Width::Word, value.count_ones())
            }
            // The number of the lowest bit that is set; of no bit 0.
            System::Encode => {
                let value = self.argument(areas, 0, Width::Double)?;
                self.set_argument(areas, 1, Width::Word, if value == 0 { 0 } else { value.trailing_zeros() })
            }
            System::Decode => {
                let bit = self.argument(areas, 0, Width::Word)? & 31;
                self.set_argument(areas, 1, Width::Double, 1 << bit)
            }
            _ => Ok(()),
        }
    }

    fn date_time<A: Areas>(&mut self, areas: &A, index: u16) -> Result<Option<(u32, u32, u32)>, Fault> {
        let spot = self.element(areas, index)?;
        let parts = parts_of(self.read_bytes(areas, spot)?);
        self.state.registers.status.br = parts.is_some();
        Ok(parts)
    }

    /// A number by its type: INT, DINT or REAL.
    fn numeric<A: Areas>(&self, areas: &A, region: Region) -> Result<Option<f64>, Fault> {
        Ok(match region.code {
            0x05 => Some(f64::from(i16::from_be_bytes(self.read_bytes(areas, region.spot)?))),
            0x07 => Some(f64::from(i32::from_be_bytes(self.read_bytes(areas, region.spot)?))),
            0x08 => Some(f64::from(f32::from_be_bytes(self.read_bytes(areas, region.spot)?))),
            _ => None,
        })
    }

    pub(in crate::plc::step7) fn copy_region<A: Areas>(
        &mut self,
        areas: &mut A,
        from: Region,
        to: Region,
    ) -> Result<(), Fault> {
        for byte in 0..from.bytes {
            let [value]: [u8; 1] = self.read_bytes(areas, from.spot.after(byte))?;
            self.write_bytes(areas, to.spot.after(byte), [value])?;
        }
        Ok(())
    }

    /// The three inputs and the result, if all are of one numeric type.
    fn three<A: Areas>(&mut self, areas: &A) -> Result<Option<[(Region, f64); 3]>, Fault> {
        let result = self.region(areas, 3)?;
        let mut inputs = [(result, 0.0); 3];
        for (index, input) in (0..).zip(&mut inputs) {
            let region = self.region(areas, index)?;
            match self.numeric(areas, region)? {
                Some(value) if region.code == result.code => *input = (region, value),
                _ => {
                    self.state.registers.status.br = false;
                    return Ok(None);
                }
            }
        }
        Ok(Some(inputs))
    }

    fn limit<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let Some([low, value, high]) = self.three(areas)? else { return Ok(()) };
        if low.1 > high.1 {
            self.state.registers.status.br = false;
            return Ok(());
        }
        let chosen = if value.1 < low.1 {
            low
        } else if value.1 > high.1 {
            high
        } else {
            value
        };
        let to = self.region(areas, 3)?;
        self.copy_region(areas, chosen.0, to)
    }

    fn extreme<A: Areas>(&mut self, areas: &mut A, is_better: fn(f64, f64) -> bool) -> Result<(), Fault> {
        let Some(inputs) = self.three(areas)? else { return Ok(()) };
        let mut chosen = inputs[0];
        for input in inputs {
            if is_better(input.1, chosen.1) {
                chosen = input;
            }
        }
        let to = self.region(areas, 3)?;
        self.copy_region(areas, chosen.0, to)
    }

    fn real<A: Areas>(&self, areas: &A, index: u16) -> Result<f32, Fault> {
        Ok(f32::from_bits(self.argument(areas, index, Width::Double)?))
    }

    /// SCALE: OUT = (IN − K1) / (K2 − K1) × (HI_LIM − LO_LIM) + LO_LIM; 8 and BR 0 outside of K1 to K2, with OUT at its limit.
    fn scale<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let input = f32::from((self.argument(areas, 0, Width::Word)? as u16).cast_signed());
        let (high, low) = (self.real(areas, 1)?, self.real(areas, 2)?);
        let bottom = if self.argument(areas, 3, Width::Bit)? == 1 { -FULL_SCALE } else { 0.0 };
        let within = input.clamp(bottom, FULL_SCALE);
        let output = (within - bottom) / (FULL_SCALE - bottom) * (high - low) + low;
        self.set_argument(areas, 5, Width::Double, output.to_bits())?;
        self.library_result(areas, 4, within.to_bits() != input.to_bits())
    }

    /// UNSCALE: OUT = (IN − LO_LIM) / (HI_LIM − LO_LIM) × (K2 − K1) + K1.
    fn unscale<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let input = self.real(areas, 0)?;
        let (high, low) = (self.real(areas, 1)?, self.real(areas, 2)?);
        let bottom = if self.argument(areas, 3, Width::Bit)? == 1 { -FULL_SCALE } else { 0.0 };
        let output = (input - low) / (high - low) * (FULL_SCALE - bottom) + bottom;
        let within = if output.is_nan() { bottom } else { output.clamp(bottom, FULL_SCALE) };
        let value = within.round_ties_even() as i32;
        self.set_argument(areas, 5, Width::Word, value.cast_unsigned())?;
        self.library_result(areas, 4, within.to_bits() != output.to_bits())
    }

    fn library_result<A: Areas>(&mut self, areas: &mut A, index: u16, is_outside: bool) -> Result<(), Fault> {
        self.state.registers.status.br = !is_outside;
        self.set_argument(areas, index, Width::Word, if is_outside { 8 } else { 0 })
    }

    /// A text with the sign first; BR 0 and an empty text if the result is too short.
    fn number_to_text<A: Areas>(&mut self, areas: &mut A, value: i64) -> Result<(), Fault> {
        let mut digits = [0_u8; 12];
        let mut start = digits.len();
        let mut rest = value.unsigned_abs();
        loop {
            start -= 1;
            digits[start] = b'0' + (rest % 10) as u8;
            rest /= 10;
            if rest == 0 {
                break;
            }
        }
        start -= 1;
        digits[start] = if value < 0 { b'-' } else { b'+' };
        self.put_text(areas, &digits[start..])
    }

    /// A short text into the STRING of parameter 2; BR 0 and an empty text if there is no room for it.
    fn put_text<A: Areas>(&mut self, areas: &mut A, text: &[u8]) -> Result<(), Fault> {
        let at = self.element(areas, 1)?;
        let [maximum]: [u8; 1] = self.read_bytes(areas, at)?;
        let fits = text.len() <= usize::from(maximum);
        self.state.registers.status.br = fits;
        self.write_bytes(areas, at.after(1), [if fits { text.len() as u8 } else { 0 }])?;
        if fits {
            for (index, &letter) in (2..).zip(text) {
                self.write_bytes(areas, at.after(index), [letter])?;
            }
        }
        Ok(())
    }

    /// R_STRNG: sign, a digit, seven decimals and an exponent of two digits: `+1.5000000E+00`. BR 0 and an empty text for what is no number.
    fn real_to_text<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let value = self.real(areas, 0)?;
        if !value.is_finite() {
            self.put_text(areas, b"")?;
            self.state.registers.status.br = false;
            return Ok(());
        }
        // Its seven decimals are those of the exact value.
        let text = format!("{:+.7E}", f64::from(value));
        let (mantissa, exponent) = text.split_once('E').unwrap_or((&text, "0"));
        let exponent: i32 = exponent.parse().unwrap_or(0);
        self.put_text(areas, format!("{mantissa}E{exponent:+03}").as_bytes())
    }

    /// STRNG_R: a number with a point and an exponent, or without; 0 and BR 0 for another text.
    fn text_to_real<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let at = self.element(areas, 0)?;
        let [length]: [u8; 1] = self.read_bytes(areas, at.after(1))?;
        let mut text = String::new();
        for index in 0..u32::from(length) {
            let [letter]: [u8; 1] = self.read_bytes(areas, at.after(2 + index))?;
            text.push(char::from(letter));
        }
        let is_number = |text: &&str| text.chars().all(|letter| letter.is_ascii_digit() || "+-.eE".contains(letter));
        let value = Some(text.trim()).filter(is_number).and_then(|text| text.parse::<f32>().ok());
        let value = value.filter(|value| value.is_finite());
        self.state.registers.status.br = value.is_some();
        self.set_argument(areas, 1, Width::Double, value.unwrap_or(0.0).to_bits())
    }

    /// A number with blanks before it and a sign; 0 and BR 0 for another text, or beyond the limits.
    fn text_to_number<A: Areas>(&mut self, areas: &mut A, least: i64, most: i64) -> Result<i64, Fault> {
        let at = self.element(areas, 0)?;
        let [length]: [u8; 1] = self.read_bytes(areas, at.after(1))?;
        let mut text = [0_u8; 16];
        let mut used = 0;
        let mut is_good = true;
        for index in 0..u32::from(length) {
            let [letter]: [u8; 1] = self.read_bytes(areas, at.after(2 + index))?;
            if letter == b' ' && used == 0 {
                continue;
            }
            match text.get_mut(used) {
                Some(place) => *place = letter,
                None => is_good = false,
            }
            used += 1;
        }
        let number =
            text.get(..used).and_then(|text| std::str::from_utf8(text).ok()).and_then(|text| text.parse().ok());
        let number = number.filter(|number| is_good && (least..=most).contains(number));
        self.state.registers.status.br = number.is_some();
        Ok(number.unwrap_or(0))
    }
}
