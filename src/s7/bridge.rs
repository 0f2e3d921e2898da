//! The station of this simulator: one step's memory to read, commands for the edge of the next step to write.
//!
//! A server makes a bridge over the state after a step, lets sessions work on it, and queues the commands that it collected: all
//! of them at the same edge, so nobody sees half of what a request wrote. A bit of the NCK takes what is written, as on a
//! control, and loses it at the NCK's next publication (SIG-11).

use super::command::Command;
use super::directory::Directory;
use super::nck::{self, ControlValues, MachineData};
use super::protected::Protected;
use super::station::{
    Areas, BlockInfo, Blocks, Cpu, CpuState, Diagnosis, Identity, NcVariables, Protection, Restart, Write, WrittenValue,
};
use super::wire::data::Refusal;
use super::wire::date_and_time::DateAndTime;
use super::wire::items::{DriveItem, NckItem};
use crate::image::{Address, Area, Format, Location, Memory, Names, Width};
use crate::variables::Variables;

/// What a server knows besides memory and variables.
#[derive(Clone, Copy)]
pub struct Machinery<'a> {
    /// RUN or STOP.
    pub state: CpuState,
    /// The clock of the CPU.
    pub clock: DateAndTime,
    /// What it is called.
    pub identity: Identity<'a>,
    /// What is protected.
    pub protection: Protection,
    /// The diagnostic buffer, newest first.
    pub diagnosis: &'a [Diagnosis],
    /// Whether clients may change nothing.
    pub is_read_only: bool,
    /// What clients may not write in any case.
    pub protected: &'a [Protected],
    /// Machine data; none where there is none of them to be seen.
    pub machine_data: Option<&'a dyn MachineData>,
    /// What the control knows beside them: overrides, R parameters, motors, alarms; none where it is not to be seen.
    pub control: Option<&'a dyn ControlValues>,
    /// How many clients may be connected at once.
    pub connections: u16,
}

impl Default for Machinery<'_> {
    fn default() -> Self {
        Self {
            state: CpuState::Run,
            clock: DateAndTime::FIRST,
            identity: Identity::SINUMERIK_840D_SL,
            protection: Protection { level: 1, password: None },
            diagnosis: &[],
            is_read_only: false,
            protected: &[],
            machine_data: None,
            control: None,
            connections: 32,
        }
    }
}

impl std::fmt::Debug for Machinery<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Machinery").field("state", &self.state).finish_non_exhaustive()
    }
}

/// A station over the state after one step.
#[derive(Debug)]
pub struct Bridge<'a> {
    memory: &'a Memory,
    variables: &'a Variables,
    names: &'a Names,
    directory: &'a Directory,
    machinery: Machinery<'a>,
    commands: Vec<Command>,
}

impl<'a> Bridge<'a> {
    /// A station over this state.
    #[must_use]
    pub fn new(memory: &'a Memory, variables: &'a Variables, names: &'a Names, directory: &'a Directory) -> Self {
        Self { memory, variables, names, directory, machinery: Machinery::default(), commands: Vec::new() }
    }

    /// With more of the machine than memory and variables.
    #[must_use]
    pub fn with(self, machinery: Machinery<'a>) -> Self {
        Self { machinery, ..self }
    }

    /// What clients asked for so far, in order.
    #[must_use]
    pub fn commands(&self) -> &[Command] {
        &self.commands
    }

    /// Takes what clients asked for.
    #[must_use]
    pub fn into_commands(self) -> Vec<Command> {
        self.commands
    }

    fn nck(&self) -> nck::View<'_> {
        nck::View {
            memory: self.memory,
            variables: self.variables,
            names: self.names,
            machine_data: self.machinery.machine_data,
            control: self.machinery.control,
            clock: self.machinery.clock,
            serial_number: self.machinery.identity.serial_number,
        }
    }

    fn locate(&self, area: Area, byte: u32, width: Width) -> Option<Location> {
        let byte = match area {
            Area::Timers | Area::Counters => byte / 2,
            Area::DataBlock(_) | Area::Inputs | Area::Outputs | Area::Flags => byte,
        };
        let address = Address { area, byte: u16::try_from(byte).ok()?, width, format: Some(Format::Unsigned) };
        self.memory.locate(&address, self.names.profile).ok()
    }

    /// Queues a number where it lies in one piece.
    fn write_number(&mut self, area: Area, byte: u32, width: Width, bytes: &[u8]) -> bool {
        let Some(location) = self.locate(area, byte, width) else {
            return false;
        };
        let value = bytes.iter().fold(0, |value, byte| value << 8 | u64::from(*byte));
        self.commands.push(Command::Write { location, value });
        true
    }

    /// Queues one element of a type: as one number if it lies in one piece, else byte by byte.
    fn write_element(&mut self, area: Area, byte: u32, bytes: &[u8]) {
        let width = match bytes.len() {
            2 => Some(Width::Word),
            4 => Some(Width::Double),
            _ => None,
        };
        if width.is_some_and(|width| self.write_number(area, byte, width, bytes)) {
            return;
        }
        for (byte, value) in (byte..).zip(bytes) {
            self.write_number(area, byte, Width::Byte, &[*value]);
        }
    }

    fn refusal(&self, area: Area) -> Refusal {
        match area {
            Area::DataBlock(number) if !self.directory.has(number) => Refusal::DoesNotExist,
            _ => Refusal::OutOfRange,
        }
    }
}

impl Areas for Bridge<'_> {
    fn read(&self, area: Area, start: u32, into: &mut [u8]) -> Result<(), Refusal> {
        self.memory.read_bytes(area, start, into, self.names.profile).map_err(|_| self.refusal(area))
    }

    fn may_read(&self, area: Area, start: u32, length: u32) -> Result<(), Refusal> {
        // A window of the 828D ends in the middle of a block, so each byte is looked at; it is what is done on reading, too. The end
        // comes first: nearly always it is there that something is missing, and nobody looks at half a megabyte.
        let mut probe = [0; 1024];
        let mut left = length;
        while left > 0 {
            let taken = left.min(1024);
            left -= taken;
            self.read(area, start.saturating_add(left), &mut probe[..taken as usize])?;
        }
        Ok(())
    }

    fn may_write(&self, area: Area, start: u32, length: u32) -> Result<(), Refusal> {
        self.may_read(area, start, length)?;
        let Machinery { is_read_only, protected, .. } = self.machinery;
        let is_protected = is_read_only || protected.iter().any(|protected| protected.covers(area, start, length));
        if is_protected { Err(Refusal::NotAllowed) } else { Ok(()) }
    }

    fn area_length(&self, area: Area) -> u32 {
        u32::try_from(self.memory.part(area.plain_part()).len()).unwrap_or(u32::MAX)
    }

    fn write(&mut self, writes: &[Write<'_>]) {
        for write in writes {
            match *write {
                Write::Area { area, byte, value: WrittenValue::Bit { bit, value } } => {
                    if let Some(location) = self.locate(area, byte, Width::Bit(bit)) {
                        self.commands.push(Command::Write { location, value: u64::from(value) });
                    }
                }
                Write::Area { area, byte, value: WrittenValue::Bytes { bytes, element } } => {
                    let step = u32::try_from(element.max(1)).unwrap_or(1);
                    for (index, bytes) in (0..).zip(bytes.chunks(element.max(1))) {
                        self.write_element(area, byte + index * step, bytes);
                    }
                }
                Write::Variable { item, bytes } => {
                    let mut commands = std::mem::take(&mut self.commands);
                    // It was judged before.
                    let _ = nck::write(&self.nck(), &item, bytes, &mut commands);
                    self.commands = commands;
                }
            }
        }
    }
}

impl Blocks for Bridge<'_> {
    fn data_blocks(&self) -> &[BlockInfo] {
        self.directory.blocks()
    }

    fn read_block(&self, number: u16, into: &mut [u8]) {
        if self.read(Area::DataBlock(number), 0, into).is_err() {
            // A block of the 828D has gaps, where nothing is looked for: the machine stands meanwhile.
            for (first, end) in self.names.profile.spans(number) {
                if let Some(bytes) = into.get_mut(first.into()..end.into()) {
                    let _ = self.read(Area::DataBlock(number), first.into(), bytes);
                }
            }
        }
    }
}

impl Cpu for Bridge<'_> {
    fn identity(&self) -> Identity<'_> {
        self.machinery.identity
    }

    fn state(&self) -> CpuState {
        self.machinery.state
    }

    fn stop(&mut self) -> bool {
        self.queue(Command::PlcStop)
    }

    fn start(&mut self, restart: Restart) -> bool {
        self.queue(Command::PlcStart(restart))
    }

    fn clock(&self) -> DateAndTime {
        self.machinery.clock
    }

    fn set_clock(&mut self, time: DateAndTime) -> bool {
        self.queue(Command::SetClock(time))
    }

    fn protection(&self) -> Protection {
        self.machinery.protection
    }

    fn diagnosis(&self) -> &[Diagnosis] {
        self.machinery.diagnosis
    }

    fn connections(&self) -> u16 {
        self.machinery.connections
    }
}

impl Bridge<'_> {
    fn queue(&mut self, command: Command) -> bool {
        let may = !self.machinery.is_read_only;
        if may {
            self.commands.push(command);
        }
        may
    }
}

impl NcVariables for Bridge<'_> {
    fn read_variable(&self, item: &NckItem, into: &mut Vec<u8>) -> Result<(), Refusal> {
        nck::read(&self.nck(), item, into)
    }

    fn read_drive(&self, item: &DriveItem, into: &mut Vec<u8>) -> Result<(), Refusal> {
        nck::read_drive(&self.nck(), item, into)
    }

    fn may_write_variable(&self, item: &NckItem, bytes: &[u8]) -> Result<(), Refusal> {
        let judged = nck::write(&self.nck(), item, bytes, &mut Vec::new());
        let Machinery { is_read_only, protected, .. } = self.machinery;
        let is_protected = is_read_only || protected.contains(&Protected::NcVariables);
        match judged {
            // What is not there cannot be protected either.
            Err(Refusal::DoesNotExist | Refusal::OutOfRange) => judged,
            _ if is_protected => Err(Refusal::NotAllowed),
            _ => judged,
        }
    }
}
