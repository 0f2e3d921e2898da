//! STEP 7 programs: AWL sources, compiled to a flat list of instructions and run as the PLC program.
//!
//! [`compile()`] reads sources and symbol tables and gives a [`Program`], or the findings that prevent it. A [`Cpu`] runs a program on a memory
//! behind [`Areas`]; [`OwnMemory`] is one for programs without a machine.
//!
//! The parts, from front to back:
//!
//! | module | is | knows of AWL |
//! |---|---|---|
//! | `text` | lexer and parser of AWL, symbol tables, types, constants | its grammar and mnemonics |
//! | `compile` | statements to instructions: `declare` interfaces and data blocks, `statements` and `calls` code | its statements |
//! | `instruction`, `program` | the instructions and the tables of a program: the boundary | nothing |
//! | `engine`, `system`, `coverage` | run, built-in blocks, causes, what ran | nothing: they read instructions, and lines as places |
//!
//! A second language, such as SCL, plugs in at two places. Its parser gives blocks with the declarations of `text::syntax::Block`, so that
//! blocks of both languages call each other; its own statements are another `Body`. Its compiler is a second user of `compile::unit::Unit`:
//! `Unit::emit` appends an instruction with the present line, `Unit::label` and jumps close loops, local data hold intermediate
//! results. Engine, causes, coverage and faults then need no change, because they know files, networks and lines only.
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
