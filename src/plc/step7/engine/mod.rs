//! The engine: the registers of a CPU as plain state, and the interpreter that runs the instructions of a program on them.

mod access;
mod arithmetic;
mod bit_operations;
mod calls;
mod contacts;
mod cpu;
mod fault;
mod flow;
mod hours_meter;
mod interrupts;
mod memory;
mod observe;
mod observed;
mod operations;
mod organization;
mod origin;
mod read;
mod real;
mod reasons;
mod registers;
mod run;
mod timed;
mod timer;

pub use cpu::{Cpu, CpuOptions, CpuState};
pub use fault::{Fault, Stop};
pub use memory::{Area, Areas, OpenBlock, OwnMemory};
pub use registers::{Registers, Status};

pub(in crate::plc::step7) use access::{Spot, Where};
pub(in crate::plc::step7) use bit_operations::text_of;
pub(in crate::plc::step7) use hours_meter::HoursMeter;
pub(in crate::plc::step7) use interrupts::{Delay, Period, TimeOfDay};
pub(in crate::plc::step7) use observe::{Kind, kind};
pub(in crate::plc::step7) use observed::{NO, Observed, RAN, Seen, YES};
pub(in crate::plc::step7) use read::{Named, Read, TESTED};
