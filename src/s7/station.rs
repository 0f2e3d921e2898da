//! What a session serves, as small traits: memory, blocks, the CPU, NC variables. A session calls them in the middle of a
//! request; an implementation answers from one step's state and keeps what is to be changed for the next one.

use super::wire::data::Refusal;
use super::wire::date_and_time::DateAndTime;
use super::wire::items::{DriveItem, NckItem};
use crate::image::Area;

/// Everything that a session needs.
pub trait Station: Areas + Blocks + Cpu + NcVariables {}

impl<T: Areas + Blocks + Cpu + NcVariables> Station for T {}

/// The memory of the PLC.
pub trait Areas {
    /// Copies bytes from `start` of an area; timers and counters have two bytes each.
    ///
    /// # Errors
    /// No such block, or it ends before the last byte.
    fn read(&self, area: Area, start: u32, into: &mut [u8]) -> Result<(), Refusal>;

    /// Whether bytes could be read, however many they are.
    ///
    /// # Errors
    /// As [`Areas::read`].
    fn may_read(&self, area: Area, start: u32, length: u32) -> Result<(), Refusal>;

    /// Whether bytes may be written.
    ///
    /// # Errors
    /// As [`Areas::read`], or the memory is read-only.
    fn may_write(&self, area: Area, start: u32, length: u32) -> Result<(), Refusal>;

    /// How many bytes an area has: for inputs, outputs, flags, timers and counters.
    fn area_length(&self, area: Area) -> u32;

    /// Takes over everything that one request writes, all of which was checked. It becomes visible at once and whole.
    fn write(&mut self, writes: &[Write<'_>]);
}

/// One item of a request to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Write<'a> {
    /// Into the memory of the PLC.
    Area {
        /// Where.
        area: Area,
        /// The first byte.
        byte: u32,
        /// What.
        value: WrittenValue<'a>,
    },
    /// An NC variable.
    Variable {
        /// Which.
        item: NckItem,
        /// Its bytes as the item has them.
        bytes: &'a [u8],
    },
}

/// What is written into the memory of the PLC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WrittenValue<'a> {
    /// One bit.
    Bit {
        /// Which bit of the byte.
        bit: u8,
        /// 1 or 0.
        value: bool,
    },
    /// Bytes, and how many make one element of the type.
    Bytes {
        /// The bytes.
        bytes: &'a [u8],
        /// Bytes of one element: 1, 2, 4 or 8.
        element: usize,
    },
}

/// The blocks of the PLC; only data blocks exist here.
pub trait Blocks {
    /// The numbers of all data blocks, ascending.
    fn data_blocks(&self) -> &[BlockInfo];

    /// Copies a data block; bytes that it does not have stay as they are.
    fn read_block(&self, number: u16, into: &mut [u8]);
}

/// A data block in a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockInfo {
    /// Its number.
    pub number: u16,
    /// Its bytes, the end of the last one that exists.
    pub length: u16,
}

/// The CPU of the PLC.
pub trait Cpu {
    /// What it is called.
    fn identity(&self) -> Identity<'_>;

    /// RUN or STOP.
    fn state(&self) -> CpuState;

    /// Asks for STOP; whether that is possible at all.
    fn stop(&mut self) -> bool;

    /// Asks for a restart; whether that is possible at all.
    fn start(&mut self, restart: Restart) -> bool;

    /// The clock of the CPU.
    fn clock(&self) -> DateAndTime;

    /// Asks to set the clock; whether that is possible at all.
    fn set_clock(&mut self, time: DateAndTime) -> bool;

    /// What is protected, and by which password.
    fn protection(&self) -> Protection;

    /// The diagnostic buffer, newest entry first.
    fn diagnosis(&self) -> &[Diagnosis];

    /// How many clients may be connected at once.
    fn connections(&self) -> u16;
}

/// Operating state of a CPU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CpuState {
    /// The program runs.
    Run,
    /// It does not.
    Stop,
}

/// How a CPU restarts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Restart {
    /// What is retentive stays: OB100.
    Warm,
    /// Everything starts anew: OB102.
    Cold,
}

/// What a module says of itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Identity<'a> {
    /// Order number, 20 characters.
    pub order_number: &'a str,
    /// Version of the firmware.
    pub version: [u8; 3],
    /// Name of the automation system.
    pub system_name: &'a str,
    /// Name of the module.
    pub module_name: &'a str,
    /// Plant identification.
    pub plant: &'a str,
    /// Whose it is.
    pub copyright: &'a str,
    /// Serial number.
    pub serial_number: &'a str,
    /// Type of the module.
    pub module_type: &'a str,
    /// Where it stands.
    pub location: &'a str,
}

impl Identity<'static> {
    /// The PLC of an 840D sl: a CPU 317-2 PN/DP in the NCU.
    pub const SINUMERIK_840D_SL: Self = Self {
        order_number: "6ES7 317-2EK14-0AB0 ",
        version: [3, 2, 6],
        system_name: "OpenNCK",
        module_name: "PLC 317-2 PN/DP",
        plant: "",
        copyright: "OpenNCK simulator",
        serial_number: "SIMULATED",
        module_type: "CPU 317-2 PN/DP",
        location: "",
    };

    /// The PLC of an 828D: part of the control, whose operator unit (PPU) has the order number. Choice: a PPU 28x.
    pub const SINUMERIK_828D: Self = Self {
        order_number: "6FC5370-5AA40-0AA0  ",
        version: [4, 0, 0],
        module_name: "PLC 828D",
        module_type: "PLC 828D",
        ..Self::SINUMERIK_840D_SL
    };
}

/// What is protected.
///
/// | level | what needs the password |
/// |---|---|
/// | 1 | nothing |
/// | 2 | stop, restart, setting the clock |
/// | 3 | reading blocks, too |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Protection {
    /// 1 to 3.
    pub level: u8,
    /// Eight characters; none where there is nothing to give.
    pub password: Option<[u8; 8]>,
}

/// An entry of the diagnostic buffer: 20 bytes of a system state list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Diagnosis {
    /// Number of the event, such as [`Diagnosis::STOP`].
    pub event: u16,
    /// Its information.
    pub information: [u8; 10],
    /// When it happened.
    pub time: DateAndTime,
}

impl Diagnosis {
    /// Power came; what is retentive is still there.
    pub const POWER_ON: u16 = 0x4300;
    /// STOP became START-UP.
    pub const START_UP: u16 = 0x4301;
    /// START-UP became RUN.
    pub const RUN: u16 = 0x4302;
    /// STOP by a programming device.
    pub const STOP: u16 = 0x4304;
    /// STOP by a fault of the program.
    pub const FAULT: u16 = 0x4562;
    /// A warm restart was asked for by hand.
    pub const WARM_RESTART: u16 = 0x1381;
    /// A cold restart was asked for by hand.
    pub const COLD_RESTART: u16 = 0x1385;

    /// An event of the operating state, with no program behind it.
    #[must_use]
    pub const fn of_state(event: u16, time: DateAndTime) -> Self {
        // Priority class FF: none.
        Self { event, information: [0xFF, 0, 0, 0, 0, 0, 0, 0, 0, 0], time }
    }
}

/// The variables of the NCK.
pub trait NcVariables {
    /// Appends the rows that an item asks for.
    ///
    /// # Errors
    /// There is no such variable, or no such row.
    fn read_variable(&self, item: &NckItem, into: &mut Vec<u8>) -> Result<(), Refusal>;

    /// Appends a parameter of a drive object.
    ///
    /// # Errors
    /// There is no such object or parameter, or it is of another type.
    fn read_drive(&self, item: &DriveItem, into: &mut Vec<u8>) -> Result<(), Refusal>;

    /// Whether a variable takes these bytes.
    ///
    /// # Errors
    /// There is no such variable or row, it cannot be written, or a value or the length does not fit.
    fn may_write_variable(&self, item: &NckItem, bytes: &[u8]) -> Result<(), Refusal>;
}
