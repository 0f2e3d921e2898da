//! The station of this simulator: it reads the memory of one step, and collects commands for the start of the next step.
//!
//! A server creates a bridge over the state after a step, lets sessions work on it, and queues the collected commands. All of them take
//! effect at the start of the same step, so no client sees a partial write. A bit written by the NCK accepts a write, as on a control, and
//! loses it at the next publication of the NCK (SIG-11).

use super::command::Command;
use super::directory::Directory;
use super::nck;
use super::protected::Protected;
use super::station::{
    Areas, BlockInfo, Blocks, Cpu, CpuState, Diagnosis, Identity, NcVariables, Protection, Restart, Write, WrittenValue,
};
use super::wire::data::Refusal;
use super::wire::date_and_time::DateAndTime;
use super::wire::items::{DriveItem, NckItem};
use crate::image::{Address, Area, Format, Location, Memory, Names, Width};
use crate::variables::Variables;
use crate::variables::nc::{ControlValues, MachineData, View};

/// The data of a machine besides its memory and variables.
#[derive(Clone, Copy)]
pub struct Machinery<'a> {
    /// RUN or STOP.
    pub state: CpuState,
    /// The clock of the CPU.
    pub clock: DateAndTime,
    /// The identification of the CPU.
    pub identity: Identity<'a>,
    /// The protection level and password.
    pub protection: Protection,
    /// The diagnostic buffer, newest entry first.
    pub diagnosis: &'a [Diagnosis],
    /// Whether clients may not change anything.
    pub is_read_only: bool,
    /// Addresses that clients may never write.
    pub protected: &'a [Protected],
    /// The machine data; `None` if they are not available.
    pub machine_data: Option<&'a dyn MachineData>,
    /// Further values of the control: overrides, R parameters, motors, alarms; `None` if they are not available.
    pub control: Option<&'a dyn ControlValues>,
    /// Maximum number of connected clients.
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

    /// Adds the data besides memory and variables.
    #[must_use]
    pub fn with(self, machinery: Machinery<'a>) -> Self {
        Self { machinery, ..self }
    }

    /// The commands of the clients so far, in order.
    #[must_use]
    pub fn commands(&self) -> &[Command] {
        &self.commands
    }

    /// The commands of the clients.
    #[must_use]
    pub fn into_commands(self) -> Vec<Command> {
        self.commands
    }

    fn nck(&self) -> View<'_> {
        View {
            memory: self.memory,
            variables: self.variables,
            names: self.names,
            machine_data: self.machinery.machine_data,
            control: self.machinery.control,
            clock: nck::clock_time(self.machinery.clock),
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

    /// Queues a number if it lies in one part of the memory.
    fn write_number(&mut self, area: Area, byte: u32, width: Width, bytes: &[u8]) -> bool {
        let Some(location) = self.locate(area, byte, width) else {
            return false;
        };
        let value = bytes.iter().fold(0, |value, byte| value << 8 | u64::from(*byte));
        self.commands.push(Command::Write { location, value });
        true
    }

    /// Queues one element of a type: as one number if it lies in one part of the memory, otherwise byte by byte.
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
        // A range of the 828D may end in the middle of a block, so each byte is checked, as for a read. The end is checked first: most
        // invalid ranges are too long, and the check must not read half a megabyte.
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
                    // The write was checked before.
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
            // A block of the 828D has gaps. Skipping them keeps the machine waiting for a shorter time.
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
            // An item that does not exist cannot be protected.
            Err(Refusal::DoesNotExist | Refusal::OutOfRange) => judged,
            _ if is_protected => Err(Refusal::NotAllowed),
            _ => judged,
        }
    }
}
