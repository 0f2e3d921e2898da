//! The trace as a waveform file (Value Change Dump) for GTKWave and similar viewers.
//!
//! The file contains no date and no version, so that the same trace always gives the same bytes.

use std::io;

use ::vcd::{IdCode, ReferenceIndex, ScopeType, SimulationCommand, TimescaleUnit, Value, VarType, Writer};

use super::Shown;
use super::waves::{Level, Wave, WaveKind, Waves};

/// The complete file.
pub(super) fn text(waves: &Waves) -> String {
    let mut bytes = Vec::new();
    // A vector accepts every byte, and the output is text.
    let written = write(waves, &mut bytes);
    debug_assert!(written.is_ok(), "a vector accepts every byte");
    String::from_utf8(bytes).unwrap_or_default()
}

fn write(waves: &Waves, bytes: &mut Vec<u8>) -> io::Result<()> {
    let mut writer = Writer::new(bytes);
    let (unit_nanos, number, unit) = timescale(waves.calendar.tick());
    writer.comment("OpenNCK: signals of the NC/PLC interface by owner")?;
    writer.timescale(number, unit)?;
    let mut codes = Vec::new();
    for of_owner in waves.rows.chunk_by(|one, next| one.owner == next.owner) {
        writer.scope_def(ScopeType::Module, &plain(&of_owner[0].owner))?;
        for wave in of_owner {
            codes.push(define(&mut writer, wave)?);
        }
        writer.upscope()?;
    }
    let note = if waves.notes.is_empty() {
        None
    } else {
        writer.scope_def(ScopeType::Module, "scenario")?;
        let code = writer.add_var(VarType::String, 1, "note", None)?;
        writer.upscope()?;
        Some(code)
    };
    writer.enddefinitions()?;
    let ticks = |cycle: u64| waves.time(cycle).nanos().unsigned_abs() / unit_nanos;
    writer.timestamp(ticks(waves.first))?;
    writer.begin(SimulationCommand::Dumpvars)?;
    for (wave, code) in waves.rows.iter().zip(&codes) {
        change(&mut writer, *code, wave.kind, wave.start)?;
    }
    if let Some(code) = note {
        writer.change_string(code, "-")?;
    }
    writer.end()?;
    let mut changes: Vec<(u64, usize, usize)> = Vec::new();
    for (row, wave) in waves.rows.iter().enumerate() {
        changes.extend(wave.changes.iter().enumerate().map(|(index, step)| (step.cycle, row, index)));
    }
    // Notes follow all other changes of their time.
    changes.extend(waves.notes.iter().enumerate().map(|(index, (cycle, _))| (*cycle, usize::MAX, index)));
    changes.sort_unstable();
    for of_cycle in changes.chunk_by(|one, next| one.0 == next.0) {
        let cycle = of_cycle[0].0;
        if cycle > waves.first {
            writer.timestamp(ticks(cycle))?;
        }
        let mut noted = Vec::new();
        for &(_, row, index) in of_cycle {
            match waves.rows.get(row) {
                Some(wave) => change(&mut writer, codes[row], wave.kind, wave.changes[index].level)?,
                None => noted.push(waves.notes[index].1.as_str()),
            }
        }
        if let Some(code) = note.filter(|_| !noted.is_empty()) {
            writer.change_string(code, &one_word(&noted.join(" / ")))?;
        }
    }
    if changes.last().is_none_or(|(last, ..)| *last < waves.last) && waves.last > waves.first {
        writer.timestamp(ticks(waves.last))?;
    }
    writer.flush()
}

/// The largest decimal unit of which the cycles are multiples, in nanoseconds and in the notation of VCD.
fn timescale(cycle_nanos: u64) -> (u64, u32, TimescaleUnit) {
    let units = [(1_000_000_000, TimescaleUnit::S), (1_000_000, TimescaleUnit::MS), (1_000, TimescaleUnit::US)];
    for (nanos, unit) in units {
        for number in [100, 10, 1] {
            if cycle_nanos > 0 && cycle_nanos.is_multiple_of(nanos * u64::from(number)) {
                return (nanos * u64::from(number), number, unit);
            }
        }
    }
    (1, 1, TimescaleUnit::NS)
}

fn define(writer: &mut Writer<&mut Vec<u8>>, wave: &Wave) -> io::Result<IdCode> {
    let name = plain(&wave.name);
    if !wave.beside.is_empty() {
        writer.comment(&format!("{name}: {}", wave.beside.replace('$', "_")))?;
    }
    match wave.kind {
        WaveKind::Bit | WaveKind::Alarm => writer.add_wire(1, &name),
        WaveKind::Number(width) => {
            let index = ReferenceIndex::Range(i32::from(width) - 1, 0);
            writer.add_var(VarType::Wire, u32::from(width), &name, Some(index))
        }
        WaveKind::Real | WaveKind::Value => writer.add_var(VarType::Real, 64, &name, None),
    }
}

fn change(writer: &mut Writer<&mut Vec<u8>>, code: IdCode, kind: WaveKind, level: Level) -> io::Result<()> {
    match level {
        Level::Signal(Shown::Bit(bit)) => writer.change_scalar(code, bit),
        Level::Signal(Shown::Unsigned(number)) => {
            let width = if let WaveKind::Number(width) = kind { width } else { 32 };
            let bit = |place: u8| Value::from(number >> place & 1 == 1);
            writer.change_vector(code, (0..width).rev().map(bit))
        }
        Level::Signal(Shown::Number(number)) => writer.change_real(code, number),
        Level::Value(millionths) => writer.change_real(code, millionths as f64 / 1e6),
    }
}

/// A name without characters that have a meaning in the file or in its viewers: `DB31.DBX4.7` is `DB31_DBX4_7`.
fn plain(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '_' { c } else { '_' }).collect()
}

/// A text without white space and non-ASCII characters, because a string value ends at the first of them.
fn one_word(text: &str) -> String {
    text.chars().map(|c| if c.is_ascii_graphic() { c } else { '_' }).collect()
}
