//! STEP 7 programs: AWL sources, compiled to a flat list of instructions and run as the PLC program.
//!
//! [`compile()`] reads sources and symbol tables and gives a [`Program`], or the findings that prevent it. A [`Cpu`] runs a program on a memory
//! behind [`Areas`]; [`OwnMemory`] is one for programs without a machine.
//!
//! ```
//! use std::sync::Arc;
//!
//! use opennck::plc::step7::{Cpu, CpuOptions, OwnMemory, Settings, Source, compile};
//!
//! let source = Source::statements("ob1.awl", "ORGANIZATION_BLOCK OB 1\nBEGIN\nL MW 0; L 2; *I; T MW 2;\nEND_ORGANIZATION_BLOCK\n");
//! let program = Arc::new(compile(&[source], &Settings::default()).program.expect("it has no faults"));
//! let mut memory = OwnMemory::new(&program);
//! let mut cpu = Cpu::new(program, CpuOptions::default());
//! memory.flags[1] = 21;
//! cpu.startup(&mut memory, 0)?;
//! cpu.scan(&mut memory, 0)?;
//! assert_eq!(memory.flags[3], 42);
//! # Ok::<(), Box<opennck::plc::step7::Stop>>(())
//! ```

mod basic_program;
mod compile;
mod coverage;
mod engine;
mod folder;
mod instruction;
mod loaded;
mod program;
mod system;
#[cfg(test)]
mod tests;
mod text;
mod view;

pub use compile::{Compiled, Settings, Source, SourceKind, compile};
pub use coverage::{Counts, Coverage, StatementCoverage};
pub use engine::{Area, Areas, Cpu, CpuOptions, CpuState, Fault, OpenBlock, OwnMemory, Registers, Status, Stop};
pub use folder::{Folder, PlcToml};
pub use instruction::{BlockKind, BlockName};
pub use loaded::{LoadedProgram, folder, load};
pub use program::{Program, ProgramBlock, Sizes};
pub use text::finding::{Finding, FindingKind};
pub use text::mnemonics::Language;
pub use text::symbols::SymbolForm;
