//! Tests in virtual time: the machine and its files, the command line, the README and the pages of `docs/`.
//!
//! All files form one binary, because each test binary links the library again.

mod archives;
mod campaign;
mod causes;
mod cited_rules;
mod cli;
mod determinism;
mod documents;
mod dynamics;
mod fault_table;
mod first_test;
mod foreign_readers;
mod isg_messages;
mod isg_plc;
mod machine_data_command;
mod own_interface;
mod plc_process;
#[cfg(feature = "cli")]
#[path = "../processes/mod.rs"]
mod processes;
mod programs;
mod referencing;
mod robustness;
mod rules;
mod runner;
mod s7;
mod scenario_language;
mod second_control;
mod step7;
mod tune_limits;
mod two_controls;
mod why_not;
mod why_not_command;
