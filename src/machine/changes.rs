//! Finds the changes of a step for the record. Whole parts are compared first, then their bytes.

use super::state::State;
use super::written::{FIXED, Force};
use super::{Machine, Switch};
use crate::control::{Activated, Changes};
use crate::image::{Interface, Location, Memory, Part};
use crate::plant::Input;
use crate::trace::{By, Change, NoEffect, Row};
use crate::units::{AxisNumber, AxisSet, Time};
use crate::variables::{EventId, Happening, Place};

impl Machine {
    /// The differences of the PLC's half from the last cycle, as the control sees it.
    pub(super) fn plc_changes(&mut self, scanned: bool) -> Changes {
        let seen = self.seen_by_the_plc(scanned);
        let is_late = self.definition.delays[1] > Time::ZERO;
        let of = |(axes, shared)| Changes { axes, shared, scanned, seen, is_late };
        let written = self.written_changes();
        let State { to_nck, memory, .. } = &mut self.state;
        to_nck.advance(&memory.to_nck);
        let Some(before) = to_nck.seen_before() else { return of(written) };
        let now: &[u8] = to_nck.seen(&memory.to_nck);
        if now == &**before {
            return of((AxisSet::NONE, false));
        }
        of(self.definition.names.interface().plc_changes(before, now))
    }

    /// The newest cycle that the PLC had seen in the scan of which the control has the bytes now, if there is a new one.
    fn seen_by_the_plc(&mut self, scanned: bool) -> Option<u64> {
        let cycle = self.state.cycle;
        let [to_nck, from_nck] = self.definition.delay_cycles(self.cycle_time());
        let in_scan = |scan: u64| scan.saturating_sub(1 + from_nck);
        if to_nck == 0 {
            return scanned.then(|| in_scan(cycle));
        }
        let scans = &mut self.state.plc.scans;
        if scanned {
            scans.push_back(cycle);
        }
        let mut seen = None;
        while let Some(scan) = scans.front().copied().filter(|scan| scan + to_nck <= cycle) {
            scans.pop_front();
            seen = Some(in_scan(scan));
        }
        seen
    }

    /// The differences of the PLC's half from the end of the last cycle: axes, and whether another block changed.
    fn written_changes(&mut self) -> (AxisSet, bool) {
        let before = self.before.parts.iter().find(|(part, _)| *part == Part::ToNck);
        let now: &[u8] = &self.state.memory.to_nck;
        self.before.plc_wrote = true;
        let Some((_, before)) = before else {
            return (AxisSet::ALL, true);
        };
        if now == before {
            self.before.plc_wrote = false;
            return (AxisSet::NONE, false);
        }
        self.definition.names.interface().plc_changes(before, now)
    }

    /// Records the writes from outside that the PLC program overwrote in this step.
    pub(super) fn note_overwritten(&mut self) {
        for location in self.before.written.settle(&self.state.memory) {
            let bits = if location.width < 8 { location.mask() << location.bit } else { 0xFF };
            let bits = u8::try_from(bits & 0xFF).unwrap_or(0xFF);
            let change = Change::Overwritten { part: location.part, offset: location.offset, bits };
            self.recorder.push(Row { cycle: self.state.cycle, change });
        }
    }

    /// Records a command that had no effect.
    pub(super) fn record_no_effect(&mut self, what: NoEffect) {
        self.recorder.push(Row { cycle: self.state.cycle, change: Change::NoEffect(what) });
    }

    /// Records something that is not a change of the memory.
    pub(super) fn record_happening(&mut self, what: Happening, by: By, cause: EventId) {
        self.recorder.push(Row { cycle: self.state.cycle, change: Change::Happened { what, by, cause } });
    }

    /// Records the machine data that became active; a datum stored in the same cycle has only this row. Returns whether there are any.
    pub(super) fn record_activated(&mut self, by: By) -> bool {
        let activated = self.control.take_activated();
        for Activated { datum, event } in &activated {
            self.recorder.forget_stored(self.state.cycle, *datum);
            self.record_happening(Happening::DatumActive(*datum), by, *event);
        }
        !activated.is_empty()
    }

    /// Writes the record of a step.
    pub(super) fn record(&mut self) {
        let mut parts = std::mem::take(&mut self.before.parts);
        let blocks = &self.state.memory.blocks;
        let known = parts.iter().skip(FIXED.len()).map(|(part, _)| *part);
        if !known.eq(blocks.iter().map(|block| Part::Block(block.number))) {
            // A program has deleted data blocks, or made some: their bytes were 0 before.
            parts.retain(|(part, _)| !matches!(part, Part::Block(number) if blocks.get(*number).is_none()));
            for (place, block) in blocks.iter().enumerate() {
                let part = Part::Block(block.number);
                if parts.get(FIXED.len() + place).is_none_or(|(known, _)| *known != part) {
                    parts.insert(FIXED.len() + place, (part, vec![0; block.bytes.len()]));
                }
            }
        }
        for (index, (part, old)) in parts.iter_mut().enumerate() {
            let memory = &mut self.state.memory;
            let may_differ = match part {
                Part::ToNck => self.before.plc_wrote,
                Part::FromNck | Part::Hmi => true,
                Part::Inputs => memory.inputs.take_written(),
                Part::Outputs => memory.outputs.take_written(),
                Part::Flags => memory.flags.take_written(),
                Part::Timers => memory.timers.take_written(),
                Part::Counters => memory.counters.take_written(),
                Part::Block(_) => memory.blocks.take_written(index - FIXED.len()),
            };
            if may_differ {
                self.record_part(*part, old);
            }
        }
        self.before.parts = parts;
        self.record_alarms();
        let events = self.control.events();
        self.recorder.events(events.since(self.state.recorded));
        self.state.recorded = events.last();
    }

    fn record_part(&mut self, part: Part, old: &mut [u8]) {
        if self.state.memory.part(part) == old {
            return;
        }
        for piece in (0..old.len()).step_by(64) {
            let end = (piece + 64).min(old.len());
            if self.state.memory.part(part)[piece..end] == old[piece..end] {
                continue;
            }
            for (place, old) in old.iter_mut().enumerate().take(end).skip(piece) {
                let new = self.state.memory.part(part)[place];
                if new != *old {
                    let offset = u32::try_from(place).unwrap_or(u32::MAX);
                    let profile = self.definition.names.profile;
                    // The trace has a value once, as the profile shows it.
                    if !profile.shows_elsewhere(part, offset) {
                        self.record_byte(part, offset, *old, new);
                    }
                    *old = new;
                }
            }
        }
    }

    fn record_byte(&mut self, part: Part, offset: u32, old: u8, new: u8) {
        let interface = self.definition.names.interface();
        let owner = (part == Part::FromNck || part == Part::Hmi).then(|| place_of(interface, part, offset)).flatten();
        let (mut by, mut causes) = ([By::Plc; 8], [EventId::NONE; 8]);
        for bit in 0..8_u8 {
            if (old ^ new) >> bit & 1 == 0 {
                continue;
            }
            let who = self.who(part, offset, bit, new >> bit & 1 == 1);
            by[usize::from(bit)] = who;
            if let (By::Nck, Some((place, byte))) = (who, owner) {
                causes[usize::from(bit)] = self.control.cause(place, byte, bit);
            } else if who == By::Plant {
                causes[usize::from(bit)] = self.fault_of_switch(part, offset, bit);
            }
        }
        self.recorder
            .push(Row { cycle: self.state.cycle, change: Change::Byte { part, offset, old, new, by, causes } });
    }

    fn who(&self, part: Part, offset: u32, bit: u8, value: bool) -> By {
        let is_meant = |write: &Force| {
            let first = u64::from(write.location.offset) * 8 + u64::from(write.location.bit);
            let this = u64::from(offset) * 8 + u64::from(bit);
            write.location.part == part && (first..first + u64::from(write.location.width)).contains(&this)
        };
        let written = self.before.written.bit(part, offset, bit);
        if self.state.forces.iter().any(is_meant) {
            return By::Force;
        }
        if part == Part::FromNck {
            let is_outside = written.is_some() && !is_signal(self.definition.names.interface(), part, offset, bit);
            return if is_outside { By::Outside } else { By::Nck };
        }
        if part == Part::ToNck && self.is_switch(offset, bit) {
            return By::Plant;
        }
        if written == Some(value) {
            return By::Outside;
        }
        let preset = |memory: &Memory| {
            memory.part(part).get(offset as usize).is_some_and(|byte| (byte >> bit & 1 == 1) == value)
        };
        if self.before.power_on.as_deref().is_some_and(preset) {
            return By::PowerOn;
        }
        match part {
            Part::FromNck | Part::Hmi => By::Nck,
            Part::Inputs => By::Plant,
            Part::ToNck | Part::Outputs | Part::Flags | Part::Timers | Part::Counters | Part::Block(_) => By::Plc,
        }
    }

    /// The event of a fault that changed the switch behind this bit in this step.
    fn fault_of_switch(&self, part: Part, offset: u32, bit: u8) -> EventId {
        let (unwired, wired) = (&self.definition.unwired, &self.definition.layout.wired);
        let is_behind = |&&(axis, switch, _): &&(AxisNumber, Switch, EventId)| {
            let is_signal = |&(of, which, location): &(AxisNumber, Switch, Location)| {
                (of, which) == (axis, switch) && (location.part, location.offset, location.bit) == (part, offset, bit)
            };
            let is_input = |&(of, which, input): &(AxisNumber, Switch, Input)| {
                let here = (Part::Inputs, u32::from(input.byte), input.bit) == (part, offset, bit);
                here && (of, which) == (axis, switch)
            };
            unwired.iter().any(is_signal) || wired.iter().any(is_input)
        };
        self.before.stuck.iter().rev().find(is_behind).map_or(EventId::NONE, |(.., event)| *event)
    }

    /// Whether the bit is the signal of a switch that is not wired to an input.
    fn is_switch(&self, offset: u32, bit: u8) -> bool {
        let is_here = |location: &Location| (location.offset, location.bit) == (offset, bit);
        self.definition.unwired.iter().any(|(_, _, location)| is_here(location))
    }

    fn record_alarms(&mut self) {
        let cycle = self.state.cycle;
        for &alarm in self.control.raised_again() {
            let cause = self.control.alarm_cause(alarm.number, alarm.place);
            self.recorder.push(Row { cycle, change: Change::Alarm { alarm, raised: true, cause } });
        }
        let same = self.alarms_before.len() == self.state.variables.alarms.count()
            && self.alarms_before.iter().zip(self.state.variables.alarms.iter()).all(|(old, new)| old == new);
        if same {
            return;
        }
        for &alarm in &self.alarms_before {
            if !self.state.variables.alarms.iter().any(|other| *other == alarm) {
                let cause = self.control.cleared_cause(alarm.number, alarm.place);
                self.recorder.push(Row { cycle, change: Change::Alarm { alarm, raised: false, cause } });
            }
        }
        for &alarm in self.state.variables.alarms.iter() {
            if !self.alarms_before.contains(&alarm) {
                let cause = self.control.alarm_cause(alarm.number, alarm.place);
                self.recorder.push(Row { cycle, change: Change::Alarm { alarm, raised: true, cause } });
            }
        }
        self.alarms_before.clear();
        self.alarms_before.extend(self.state.variables.alarms.iter());
    }
}

/// The block of a byte, and the number of the byte in the block.
fn place_of(interface: &'static Interface, part: Part, offset: u32) -> Option<(Place, u16)> {
    let found = interface.signals_at(part, offset)?;
    Some((Place::of_block(found.block, found.number)?, found.byte))
}

fn is_signal(interface: &'static Interface, part: Part, offset: u32, bit: u8) -> bool {
    interface.signals_at(part, offset).is_some_and(|found| {
        found.signals.iter().any(|signal| {
            let width = signal.kind.width();
            width >= 8 || (signal.bit..signal.bit + width).contains(&bit)
        })
    })
}
