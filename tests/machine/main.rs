//! Tests in virtual time: the machine and its files, the command line, the examples of the README.
//!
//! All files form one binary, because each test binary links the library again.

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
