//! A program that a machine runs: its CPU between the memory of the machine and the calls of the machine.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use crate::image::{AsBytes, Block, Bytes, DataBlock, Format, Location, Memory, Names, Part};
use crate::plc::{PlcFault, PlcIo, PlcProgram, ProgramCause, Tested};
use crate::source::{Place, Problem};
use crate::units::Time;

use super::compile::{Settings, Source, compile};
use super::coverage::Coverage;
use super::engine::{Area, Cpu, CpuOptions, CpuState, Named, Read, Seen, Stop, text_of};
use super::folder::Folder;
use super::program::Program;
use super::text::finding::Finding;
use super::view::{Map, View};

/// A STEP 7 program as the PLC program of a machine.
#[derive(Debug)]
pub struct LoadedProgram {
    name: String,
    cpu: Cpu,
    cycle: Option<Time>,
    map: Arc<Map>,
    /// The process image of the inputs, for one scan.
    inputs: Vec<u8>,
    /// The paths of its sources and their texts.
    files: Arc<[(String, String)]>,
    /// The places of statements that causes have named.
    places: Arc<Mutex<BTreeMap<u32, Arc<str>>>>,
    /// The NC cycle of its last part, for causes.
    ran: u64,
}

/// The folder of a program by its name: below the first of these directories that has it, or else below the first.
#[must_use]
pub fn folder(name: &str, directories: &[&Path]) -> PathBuf {
    let mut folders = directories.iter().map(|directory| directory.join(name));
    folders.clone().find(|folder| folder.is_dir()).or_else(|| folders.next()).unwrap_or_else(|| PathBuf::from(name))
}

/// Reads and compiles the program in a folder. `name` is the one by which a machine names it.
///
/// # Errors
/// The folder cannot be read, or the compiler has findings; the problem is the first of them.
pub fn load(folder: &Path, name: &str) -> Result<LoadedProgram, Problem> {
    let Folder { mut sources, toml } = Folder::read(folder)?;
    let paths: Vec<String> = sources.iter().map(|source| plain(&source.name)).collect();
    for source in &mut sources {
        // Messages of a run name the file within the folder, so that they are the same on every computer.
        let file = Path::new(&source.name).file_name();
        source.name = file.map_or_else(|| source.name.clone(), |file| file.to_string_lossy().into_owned());
    }
    let mut program = LoadedProgram::compile(&sources, &toml.settings, name).map_err(|findings| {
        let count = findings.len();
        let Some(Finding { file, line, context, what, cure, .. }) = findings.into_iter().next() else {
            return Place::file(name).problem("this program cannot be loaded", "");
        };
        let what = if context.is_empty() { what } else { format!("{context}: {what}") };
        let further = if count > 1 {
            format!("`opennck plc check {}` lists all {count} findings", folder.display())
        } else {
            String::new()
        };
        let cure = [cure, further].into_iter().filter(|text| !text.is_empty()).collect::<Vec<_>>().join("; ");
        Place::file(&folder.join(file).display().to_string()).at_line(line).problem(what, cure)
    })?;
    program.cycle = toml.cycle;
    program.files = paths.into_iter().zip(program.files.iter().map(|(_, text)| text.clone())).collect();
    let mut options = program.cpu.options();
    for (period, nanos) in toml.cyclic.into_iter().zip(&mut options.cyclic_nanos) {
        *nanos = period.map_or(*nanos, Time::nanos);
    }
    program.cpu = Cpu::new(program.cpu.shared_program(), options);
    Ok(program)
}

impl LoadedProgram {
    /// Compiles sources to a program with this name.
    ///
    /// # Errors
    /// What the compiler found.
    pub fn compile(sources: &[Source], settings: &Settings, name: &str) -> Result<Self, Vec<Finding>> {
        let compiled = compile(sources, settings);
        let program = compiled.program.ok_or(compiled.findings)?;
        Ok(Self {
            name: name.to_owned(),
            cpu: Cpu::new(Arc::new(program), CpuOptions::default()),
            cycle: None,
            map: Arc::new(Map::default()),
            inputs: Vec::new(),
            files: sources.iter().map(|source| (source.name.clone(), source.text.clone())).collect(),
            places: Arc::default(),
            ran: 0,
        })
    }

    /// The program as a trait object.
    #[must_use]
    pub fn boxed(self) -> Box<dyn PlcProgram> {
        Box::new(self)
    }

    /// The program.
    #[must_use]
    pub fn program(&self) -> &Program {
        self.cpu.program()
    }

    fn cause(&self, seen: &Seen) -> Option<ProgramCause> {
        let (part, bit) = self.place(seen.place)?;
        let tested = seen.tested.iter().filter_map(|read| self.tested(read));
        Some(ProgramCause {
            part,
            bit,
            bits: seen.bits,
            value: seen.value,
            statement: self.place_of(seen.pc),
            tested: tested.collect(),
        })
    }

    fn tested(&self, read: &Read) -> Option<Tested> {
        let Read { named, bits, value } = *read;
        let word = u16::try_from(value).unwrap_or(u16::MAX);
        Some(match named {
            Named::Timer(number) if bits == 1 => Tested::Timer(number, value != 0),
            Named::Timer(number) => Tested::TimerValue(number, word),
            Named::Counter(number) if bits == 1 => Tested::Counter(number, value != 0),
            Named::Counter(number) => Tested::CounterValue(number, word),
            Named::Operation(pc) => Tested::Operation(self.operation(pc)?, value != 0),
            Named::Area(..) | Named::Block(..) | Named::ToNck(_) | Named::FromNck(_) => {
                let (part, begin) = self.place(named)?;
                let location = Location {
                    part,
                    offset: begin / 8,
                    bit: u8::try_from(begin % 8).ok()?,
                    width: bits,
                    format: Format::Unsigned,
                };
                if bits == 1 {
                    return Some(Tested::Bit(location, value != 0));
                }
                // A word whose bytes have different writers is no location of the memory.
                let last = u32::from(bits) - 8;
                let end = match named {
                    Named::Block(number, bit) => self.place(Named::Block(number, bit + last))?,
                    _ => (part, begin + last),
                };
                (end == (part, begin + last)).then_some(Tested::Word(location, value))?
            }
        })
    }

    /// The place of a statement, whose text all of its causes share.
    fn place_of(&self, pc: u32) -> Arc<str> {
        let mut known = self.places.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(known.entry(pc).or_insert_with(|| self.cpu.program().place(pc).into()))
    }

    /// An operation whose operand has no name, with its line: "`A <0` (main.awl:12)".
    fn operation(&self, pc: u32) -> Option<Arc<str>> {
        let program = self.cpu.program();
        let text = text_of(*program.code.get(pc as usize)?)?;
        let line = program.lines.get(pc as usize).copied().unwrap_or_default();
        let file = program.files.get(usize::from(line.file)).map_or("", String::as_str);
        Some(format!("`{text}` ({file}:{})", line.line).into())
    }

    /// The part of the memory in which something is, and its address in bits.
    fn place(&self, named: Named) -> Option<(Part, u32)> {
        Some(match named {
            Named::Area(Area::Inputs, bit) => (Part::Inputs, bit),
            Named::Area(Area::Outputs, bit) => (Part::Outputs, bit),
            Named::Area(Area::Flags, bit) => (Part::Flags, bit),
            Named::ToNck(bit) => (Part::ToNck, bit),
            Named::FromNck(bit) => (Part::FromNck, bit),
            Named::Timer(number) => (Part::Timers, u32::from(number) * 16),
            Named::Counter(number) => (Part::Counters, u32::from(number) * 16),
            Named::Operation(_) => return None,
            Named::Block(number, bit) => {
                let (part, byte) = self.map.place(number, bit / 8)?;
                (part, byte * 8 + bit % 8)
            }
        })
    }

    /// Runs a part of a cycle on the memory, and shows its timers and counters there.
    fn run(
        &mut self,
        io: &mut PlcIo<'_, AsBytes>,
        run: impl FnOnce(&mut Cpu, &mut View<'_>, i64) -> Result<(), Box<Stop>>,
    ) -> Result<(), PlcFault> {
        let Self { cpu, map, inputs, ran, .. } = self;
        if std::mem::replace(ran, io.cycle) != io.cycle
            && let Some(observed) = &mut cpu.observed
        {
            observed.begin_cycle();
        }
        let sizes = cpu.program().sizes();
        for number in 0..sizes.counters {
            // A client or a scenario has set the counter.
            let number = u16::try_from(number).unwrap_or(u16::MAX);
            let word = io.counters.word(usize::from(number) * 2);
            if cpu.counter_word(number) != Some(word) {
                cpu.set_counter_word(number, word);
            }
        }
        let now = io.time.nanos();
        let done = run(cpu, &mut View::new(map, io, inputs), now);
        for number in 0..sizes.timers {
            let number = u16::try_from(number).unwrap_or(u16::MAX);
            io.timers.set_word(usize::from(number) * 2, cpu.timer_word(number, now).unwrap_or(0));
        }
        for number in 0..sizes.counters {
            let number = u16::try_from(number).unwrap_or(u16::MAX);
            io.counters.set_word(usize::from(number) * 2, cpu.counter_word(number).unwrap_or(0));
        }
        done.map_err(|stop| PlcFault { reason: stop.to_string(), diagnosis: Some(stop.diagnosis()) })
    }
}

impl PlcProgram for LoadedProgram {
    fn name(&self) -> &str {
        &self.name
    }

    /// Areas become as large as the program needs them. Its data blocks are added, but for those of the interface that the machine uses, whose
    /// bytes are the interface, and those that the machine has already.
    fn install(&mut self, memory: &mut Memory, names: &Names) {
        let program = self.cpu.program();
        let sizes = program.sizes();
        let areas = [
            (&mut memory.inputs, sizes.inputs),
            (&mut memory.outputs, sizes.outputs),
            (&mut memory.flags, sizes.flags),
            (&mut memory.timers, sizes.timers * 2),
            (&mut memory.counters, sizes.counters * 2),
        ];
        for (bytes, size) in areas {
            enlarge(bytes, size as usize);
        }
        for block in program.data_blocks() {
            let is_untouched = |bytes: &Bytes| bytes.iter().all(|byte| *byte == 0) && is_standard(block.number, names);
            if is_used(block.number, names) || memory.blocks.get(block.number).is_some_and(|old| !is_untouched(old)) {
                continue;
            }
            let name = block.symbol.as_deref().map(Into::into);
            memory.blocks.put(DataBlock { number: block.number, name, bytes: Bytes::from(block.bytes.clone()) });
        }
        for (number, length) in self.cpu.program().basic_data_blocks() {
            let old = memory.blocks.get(number);
            let is_untouched = old.is_none_or(|bytes| bytes.iter().all(|byte| *byte == 0));
            if is_untouched && old.is_none_or(|bytes| bytes.len() < length) {
                memory.blocks.put(DataBlock { number, name: None, bytes: Bytes::zeroed(length) });
            }
        }
        self.map = Arc::new(Map::new(memory, names));
        self.inputs = Vec::with_capacity(memory.inputs.len());
    }

    fn cycle(&self) -> Option<Time> {
        self.cycle
    }

    fn startup(&mut self, io: &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault> {
        io.nc.show(&[]);
        self.run(io, |cpu, view, now| cpu.startup(view, now))
    }

    fn scan(&mut self, io: &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault> {
        self.run(io, |cpu, view, now| cpu.scan(view, now))
    }

    fn has_interrupts(&self) -> bool {
        self.cpu.has_interrupts()
    }

    fn interrupt(&mut self, io: &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault> {
        if !self.cpu.interrupt_is_due(io.time.nanos()) {
            return Ok(());
        }
        self.run(io, |cpu, view, now| cpu.interrupt(view, now))
    }

    fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(self.cpu.state()).expect("plain data can be serialized")
    }

    fn restore(&mut self, saved: &[u8]) -> Result<(), Problem> {
        let state = postcard::take_from_bytes::<CpuState>(saved).ok();
        let state = state.and_then(|(state, rest)| rest.is_empty().then_some(state));
        if state.is_some_and(|state| self.cpu.restore(state)) {
            return Ok(());
        }
        Err(Problem::new(
            format!(
                "expected the saved state of the STEP 7 program `{}`, found {} other bytes",
                self.name,
                saved.len()
            ),
            "restore it with the sources with which it was saved",
        ))
    }

    fn fork(&self) -> Option<Box<dyn PlcProgram>> {
        Some(Box::new(Self {
            name: self.name.clone(),
            cpu: self.cpu.clone(),
            cycle: self.cycle,
            map: Arc::clone(&self.map),
            inputs: Vec::with_capacity(self.inputs.capacity()),
            files: Arc::clone(&self.files),
            places: Arc::clone(&self.places),
            ran: self.ran,
        }))
    }

    fn reset(&mut self) {
        let observed = self.cpu.observed.take();
        self.cpu = Cpu::new(self.cpu.shared_program(), self.cpu.options());
        self.cpu.observed = observed;
    }

    fn prepare_cold_restart(&mut self) {
        self.cpu.prepare_cold_restart();
    }

    fn observe(&mut self) {
        self.cpu.observe();
    }

    fn observe_every_write(&mut self) {
        self.cpu.observe();
        if let Some(observed) = &mut self.cpu.observed {
            observed.has_all_writes = true;
        }
    }

    fn causes(&self, cycle: u64) -> Vec<ProgramCause> {
        let Some(observed) = self.cpu.observed.as_ref().filter(|_| self.ran == cycle) else { return Vec::new() };
        observed.seen.iter().filter_map(|seen| self.cause(seen)).collect()
    }

    fn symbols(&self) -> Option<&Arc<BTreeMap<String, String>>> {
        Some(self.cpu.program().symbols())
    }

    fn coverage(&self) -> Option<Coverage> {
        let observed = self.cpu.observed.as_ref()?;
        Some(Coverage::of(&self.name, self.cpu.program(), observed, self.files.to_vec()))
    }
}

/// A path without `.` in it, as other tools write it.
fn plain(path: &str) -> String {
    let parts = Path::new(path).components().filter(|part| *part != Component::CurDir);
    parts.collect::<PathBuf>().display().to_string()
}

/// Whether a data block is one of the interface, and not of an axis or a channel that the machine does not have (P-151).
fn is_used(number: u16, names: &Names) -> bool {
    names.profile.has(number)
        && names.profile.block_of(number).is_none_or(|(block, number)| match block {
            Block::Nck | Block::ModeGroup => true,
            Block::Channel => number == 1 || names.owner(block, number).is_some(),
            Block::Axis => names.owner(block, number).is_some(),
        })
}

fn is_standard(number: u16, names: &Names) -> bool {
    names.interface().tables().standard_blocks.contains(&number)
}

fn enlarge(bytes: &mut Bytes, size: usize) {
    if bytes.len() < size {
        let mut longer = bytes.to_vec();
        longer.resize(size, 0);
        *bytes = Bytes::from(longer);
    }
}
