//! The interface between a session and its data, as small traits: memory, blocks, the CPU, NC variables. A session calls them while it
//! handles a request. An implementation reads the state of one step and collects changes for the next one.

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
    /// The block does not exist, or it ends before the last byte.
    fn read(&self, area: Area, start: u32, into: &mut [u8]) -> Result<(), Refusal>;

    /// Whether bytes can be read, for any length.
    ///
    /// # Errors
    /// As [`Areas::read`].
    fn may_read(&self, area: Area, start: u32, length: u32) -> Result<(), Refusal>;

    /// Whether bytes may be written.
    ///
    /// # Errors
    /// As for [`Areas::read`], or the memory is read-only.
    fn may_write(&self, area: Area, start: u32, length: u32) -> Result<(), Refusal>;

    /// The number of bytes of an area: inputs, outputs, flags, timers or counters.
    fn area_length(&self, area: Area) -> u32;

    /// Executes all writes of one request, which were checked before. They become visible together.
    fn write(&mut self, writes: &[Write<'_>]);
}

/// One item of a write request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Write<'a> {
    /// Writes into the memory of the PLC.
    Area {
        /// The area.
        area: Area,
        /// The first byte.
        byte: u32,
        /// The value.
        value: WrittenValue<'a>,
    },
    /// Writes an NC variable.
    Variable {
        /// The variable.
        item: NckItem,
        /// Its bytes in the form of the item.
        bytes: &'a [u8],
    },
}

/// A value written into the memory of the PLC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WrittenValue<'a> {
    /// One bit.
    Bit {
        /// Number of the bit in the byte.
        bit: u8,
        /// 1 or 0.
        value: bool,
    },
    /// Bytes and the size of one element.
    Bytes {
        /// The bytes.
        bytes: &'a [u8],
        /// Bytes of one element: 1, 2, 4 or 8.
        element: usize,
    },
}

/// The blocks of the PLC; only data blocks exist here.
pub trait Blocks {
    /// The numbers of all data blocks, in ascending order.
    fn data_blocks(&self) -> &[BlockInfo];

    /// Copies a data block; bytes in gaps of the block stay unchanged.
    fn read_block(&self, number: u16, into: &mut [u8]);
}

/// A data block in a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockInfo {
    /// Its number.
    pub number: u16,
    /// Its length in bytes, up to the end of the last existing byte.
    pub length: u16,
}

/// The CPU of the PLC.
pub trait Cpu {
    /// The identification of the CPU.
    fn identity(&self) -> Identity<'_>;

    /// RUN or STOP.
    fn state(&self) -> CpuState;

    /// Requests STOP; returns whether that is possible at all.
    fn stop(&mut self) -> bool;

    /// Requests a restart; returns whether that is possible at all.
    fn start(&mut self, restart: Restart) -> bool;

    /// The clock of the CPU.
    fn clock(&self) -> DateAndTime;

    /// Requests to set the clock; returns whether that is possible at all.
    fn set_clock(&mut self, time: DateAndTime) -> bool;

    /// The protection level and its password.
    fn protection(&self) -> Protection;

    /// The diagnostic buffer, newest entry first.
    fn diagnosis(&self) -> &[Diagnosis];

    /// Maximum number of connected clients.
    fn connections(&self) -> u16;
}

/// Operating state of a CPU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CpuState {
    /// The program runs.
    Run,
    /// The program does not run.
    Stop,
}

/// How a CPU restarts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Restart {
    /// Retentive data are kept: OB100.
    Warm,
    /// All data are initialised: OB102.
    Cold,
}

/// The identification of a module.
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
    /// Copyright entry.
    pub copyright: &'a str,
    /// Serial number.
    pub serial_number: &'a str,
    /// Type of the module.
    pub module_type: &'a str,
    /// Location identification.
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

    /// The PLC of an 828D: part of the control; the order number is that of its operator unit (PPU). Choice: a PPU 28x.
    pub const SINUMERIK_828D: Self = Self {
        order_number: "6FC5370-5AA40-0AA0  ",
        version: [4, 0, 0],
        module_name: "PLC 828D",
        module_type: "PLC 828D",
        ..Self::SINUMERIK_840D_SL
    };

    /// The PLC of another control: it claims no product of a manufacturer.
    pub const SIMULATOR: Self = Self {
        order_number: "OPENNCK SIMULATOR   ",
        version: [1, 0, 0],
        module_name: "PLC",
        module_type: "PLC",
        ..Self::SINUMERIK_840D_SL
    };
}

/// The protection of a CPU.
///
/// | level | functions that need the password |
/// |---|---|
/// | 1 | nothing |
/// | 2 | stop, restart, setting the clock |
/// | 3 | also reading blocks |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Protection {
    /// 1 to 3.
    pub level: u8,
    /// Eight characters; `None` if there is no password.
    pub password: Option<[u8; 8]>,
}

/// An entry of the diagnostic buffer: 20 bytes of a system state list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Diagnosis {
    /// Number of the event, such as [`Diagnosis::STOP`].
    pub event: u16,
    /// Additional information.
    pub information: [u8; 10],
    /// Time of the event.
    pub time: DateAndTime,
}

impl Diagnosis {
    /// Power on; retentive data are kept.
    pub const POWER_ON: u16 = 0x4300;
    /// STOP to START-UP.
    pub const START_UP: u16 = 0x4301;
    /// START-UP to RUN.
    pub const RUN: u16 = 0x4302;
    /// STOP by a programming device.
    pub const STOP: u16 = 0x4304;
    /// STOP because of an error in the program.
    pub const FAULT: u16 = 0x4562;
    /// Manual request for a warm restart.
    pub const WARM_RESTART: u16 = 0x1381;
    /// Manual request for a cold restart.
    pub const COLD_RESTART: u16 = 0x1385;

    /// A change of the operating state that no program caused.
    #[must_use]
    pub const fn of_state(event: u16, time: DateAndTime) -> Self {
        // Priority class FF: none.
        Self { event, information: [0xFF, 0, 0, 0, 0, 0, 0, 0, 0, 0], time }
    }
}

/// The variables of the NCK.
pub trait NcVariables {
    /// Appends the requested rows.
    ///
    /// # Errors
    /// There is no such variable, or no such row.
    fn read_variable(&self, item: &NckItem, into: &mut Vec<u8>) -> Result<(), Refusal>;

    /// Appends a parameter of a drive object.
    ///
    /// # Errors
    /// There is no such object or parameter, or it has another type.
    fn read_drive(&self, item: &DriveItem, into: &mut Vec<u8>) -> Result<(), Refusal>;

    /// Whether a variable accepts these bytes.
    ///
    /// # Errors
    /// There is no such variable or row, it cannot be written, or the value or its length does not fit.
    fn may_write_variable(&self, item: &NckItem, bytes: &[u8]) -> Result<(), Refusal>;
}
