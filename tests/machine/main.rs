//! Tests of what runs in virtual time: the machine and its files, the command line, what the README shows.
//!
//! One binary for many files, because each binary links the library once more.

mod causes;
mod cli;
mod determinism;
mod dynamics;
mod foreign_readers;
mod own_interface;
mod readme;
mod referencing;
mod robustness;
mod s7;
mod second_control;
