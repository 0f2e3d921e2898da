//! The blocks that time starts, between two scans: which are due, and their runs.

use super::cpu::Cpu;
use super::fault::Stop;
use super::interrupts::{CYCLIC, MILLI_NANOS, TIME_DELAY, TIME_OF_DAY};
use super::memory::Areas;
/// The interrupts whose bits are set, the highest block number first, as index and number of the organization block.
fn of_bits(bits: u64, first: u16, count: u16) -> impl Iterator<Item = (usize, u16)> {
    (0..count).rev().map(move |index| (usize::from(index), first + index)).filter(move |(_, ob)| bits >> ob & 1 == 1)
}

impl Cpu {
    /// Whether the program has a block that runs between two scans.
    #[must_use]
    pub fn has_interrupts(&self) -> bool {
        self.interrupts != 0
    }

    /// Whether [`Cpu::interrupt`] would run a block at a time in ns.
    #[must_use]
    pub fn interrupt_is_due(&self, now: i64) -> bool {
        let (bits, state) = (self.interrupts, &self.state.interrupts);
        of_bits(bits, CYCLIC, 9).any(|(index, _)| now >= state.next[index])
            || of_bits(bits, TIME_DELAY, 4).any(|(index, _)| state.delays[index].is_some_and(|delay| now >= delay.due))
            || of_bits(bits, TIME_OF_DAY, 8).any(|(index, _)| self.time_of_day_is_due(index, now))
    }

    fn time_of_day_is_due(&self, index: usize, now: i64) -> bool {
        let next = self.state.interrupts.times[index].and_then(|set| set.next);
        next.is_some_and(|next| self.clock_at(now) >= next)
    }

    /// Runs the blocks that are due.
    pub(super) fn interrupts<A: Areas>(&mut self, areas: &mut A, now: i64) -> Result<(), Box<Stop>> {
        let bits = self.interrupts;
        if bits == 0 {
            return Ok(());
        }
        for (index, number) in of_bits(bits, CYCLIC, 9) {
            if now >= self.state.interrupts.next[index] {
                let period = self.options.cyclic_nanos[index].max(1);
                let next = &mut self.state.interrupts.next[index];
                let late = (now - *next) / period;
                *next = next.saturating_add((late + 1).saturating_mul(period));
                let millis = i16::try_from(period / MILLI_NANOS).unwrap_or(i16::MAX);
                self.run_interrupt(areas, number, |information| {
                    information[10..12].copy_from_slice(&millis.to_be_bytes());
                })?;
            }
        }
        for (index, number) in of_bits(bits, TIME_DELAY, 4) {
            if let Some(delay) = self.state.interrupts.delays[index].take_if(|delay| now >= delay.due) {
                self.run_interrupt(areas, number, |information| {
                    information[6..8].copy_from_slice(&delay.sign.to_be_bytes());
                    information[8..12].copy_from_slice(&delay.millis.to_be_bytes());
                })?;
            }
        }
        for (index, number) in of_bits(bits, TIME_OF_DAY, 8) {
            if self.time_of_day_is_due(index, now) {
                let clock = self.clock_at(now);
                let Some(set) = &mut self.state.interrupts.times[index] else { continue };
                set.next = set.period.after(set.start, clock);
                let code = set.period.code();
                self.run_interrupt(areas, number, |information| {
                    information[6..8].copy_from_slice(&code.to_be_bytes());
                })?;
            }
        }
        Ok(())
    }

    fn run_interrupt<A: Areas>(
        &mut self,
        areas: &mut A,
        number: u16,
        describe: impl FnOnce(&mut [u8; 20]),
    ) -> Result<(), Box<Stop>> {
        if self.state.interrupts.disabled >> number & 1 == 1 {
            return Ok(());
        }
        // The event and the priority: 11h and 2 for OB10, 21h and 3 for OB20, 31h and 7 for OB30.
        let (event, priority) = match number {
            CYCLIC.. => (0x31 + number - CYCLIC, 7 + number - CYCLIC),
            TIME_DELAY.. => (0x21 + number - TIME_DELAY, 3 + number - TIME_DELAY),
            _ => (0x11 + number - TIME_OF_DAY, 2),
        };
        let byte = |value: u16| u8::try_from(value).unwrap_or(u8::MAX);
        let mut information = self.information(0x11, byte(event), byte(priority), byte(number));
        describe(&mut information);
        let done = self.organization_block(areas, number, &information);
        self.ended(done)
    }
}
