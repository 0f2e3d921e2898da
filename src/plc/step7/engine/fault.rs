//! Faults of a running program: those for which OB121 or OB122 is called, and those that always stop the PLC.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::registers::Registers;
use crate::plc::PlcDiagnosis;

/// What a statement did wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Fault {
    /// A digit above 9 where BCD is expected.
    BcdDigit,
    /// A read beyond the end of an area or a data block, at this byte.
    ReadLength(u32),
    /// A write beyond the end of an area or a data block, at this byte.
    WriteLength(u32),
    /// An unknown code of an area in a pointer or an address register.
    AreaCode(u8),
    /// An address with a bit where only bytes are allowed.
    Alignment,
    /// No timer with this number.
    TimerNumber(u16),
    /// No counter with this number.
    CounterNumber(u16),
    /// A data block that does not exist, or 0: none is open.
    NoDataBlock(u16),
    /// An instance data block that does not exist, or 0: none is open.
    NoInstance(u16),
    /// A function that does not exist.
    NoFunction(u16),
    /// A function block that does not exist.
    NoFunctionBlock(u16),
    /// A system function that does not exist.
    NoSystemFunction(u16),
    /// A parameter of a block that was called without parameters.
    NoParameter(u16),
    /// A peripheral address that does not exist, at this byte.
    Peripheral(u32),
    /// More calls within each other than the CPU allows.
    CallDepth,
    /// More local data than the CPU has.
    LocalData,
    /// More than seven brackets within each other, or a bracket that closes none.
    Nesting,
    /// More than eight MCR zones within each other, or one that ends and never began.
    McrNesting,
    /// A scan does not end.
    CycleTime,
    /// The program called SFC 46.
    StopCalled,
}

impl Fault {
    /// The code of the event for OB121 and OB122; `None` for faults that stop the PLC in any case.
    #[must_use]
    pub const fn code(self) -> Option<u8> {
        Some(match self {
            Self::BcdDigit => 0x21,
            Self::ReadLength(_) => 0x22,
            Self::WriteLength(_) => 0x23,
            Self::AreaCode(_) | Self::NoParameter(_) => 0x24,
            Self::TimerNumber(_) => 0x26,
            Self::CounterNumber(_) => 0x27,
            Self::Alignment => 0x28,
            Self::NoDataBlock(_) => 0x3A,
            Self::NoInstance(_) => 0x33,
            Self::NoFunction(_) => 0x3C,
            Self::NoSystemFunction(_) => 0x3D,
            Self::NoFunctionBlock(_) => 0x3E,
            Self::Peripheral(_) => 0x42,
            Self::CallDepth
            | Self::LocalData
            | Self::Nesting
            | Self::McrNesting
            | Self::CycleTime
            | Self::StopCalled => return None,
        })
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BcdDigit => write!(f, "a digit above 9 where BCD is expected"),
            Self::ReadLength(byte) => write!(f, "area length error when reading byte {byte}"),
            Self::WriteLength(byte) => write!(f, "area length error when writing byte {byte}"),
            Self::AreaCode(code) => write!(f, "no area has the code 16#{code:02X}"),
            Self::Alignment => write!(f, "an address with a bit part where a byte is expected"),
            Self::TimerNumber(number) => write!(f, "there is no timer T{number}"),
            Self::CounterNumber(number) => write!(f, "there is no counter C{number}"),
            Self::NoDataBlock(0) => write!(f, "no data block is open"),
            Self::NoDataBlock(number) => write!(f, "DB{number} is not loaded"),
            Self::NoInstance(0) => write!(f, "no instance data block is open"),
            Self::NoInstance(number) => write!(f, "the instance data block DB{number} is not loaded"),
            Self::NoFunction(number) => write!(f, "FC{number} is not loaded"),
            Self::NoFunctionBlock(number) => write!(f, "FB{number} is not loaded"),
            Self::NoSystemFunction(number) => write!(f, "SFC{number} is not there, or has parameters"),
            Self::NoParameter(index) => write!(f, "parameter {index} was not passed"),
            Self::Peripheral(byte) => write!(f, "there is no peripheral byte {byte}"),
            Self::CallDepth => write!(f, "too many calls within each other"),
            Self::LocalData => write!(f, "too much local data"),
            Self::Nesting => write!(f, "error of the nesting stack: at most 7 open brackets"),
            Self::McrNesting => write!(f, "error of the MCR stack: at most 8 zones"),
            Self::CycleTime => write!(f, "the scan does not end: cycle monitoring time exceeded"),
            Self::StopCalled => write!(f, "the program called SFC46 STP"),
        }
    }
}

/// Why the PLC stopped, with the place in the program and the registers at this moment.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stop {
    /// What happened.
    pub fault: Fault,
    /// The block, as `FC10`.
    pub block: String,
    /// The network, counted from one.
    pub network: u16,
    /// The statement in the network, counted from one.
    pub statement: u32,
    /// The source file.
    pub file: String,
    /// The line in it.
    pub line: u32,
    /// The registers before the statement.
    pub registers: Registers,
}

impl Stop {
    /// The entries of the diagnostic buffer: the fault with the numbers that OB121 or OB122 would have got, if it has such an event, and
    /// why the CPU is in STOP.
    #[must_use]
    pub fn diagnosis(&self) -> PlcDiagnosis {
        let priority = 1;
        let information = [priority, 0, 0, 0, 0, 0, 0, 0, 0, 0];
        let (cause, stop) = match self.fault {
            Fault::Peripheral(_) => (Some(0x2900), 0x4563),
            Fault::CycleTime => (Some(0x3501), 0x4568),
            Fault::StopCalled => (None, 0x4304),
            _ => (Some(0x2500), 0x4562),
        };
        let cause = match (cause, self.fault.code()) {
            (Some(class), Some(code)) => Some(class | u16::from(code)),
            (Some(event), None) if self.fault == Fault::CycleTime => Some(event),
            _ => None,
        };
        PlcDiagnosis { cause, stop, information }
    }
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}, network {}, statement {} ({}:{}): {}\n  {}",
            self.block, self.network, self.statement, self.file, self.line, self.fault, self.registers
        )
    }
}
