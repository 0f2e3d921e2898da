//! The program `opennck`.
fn main() {}
