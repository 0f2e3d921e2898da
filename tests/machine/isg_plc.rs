//! The PLC programs of `docs/isg_plc.md`: the example in Rust runs, and the page shows the programs that are in `examples`.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;

#[path = "../../examples/isg_gantry.rs"]
#[expect(dead_code, reason = "its `main` is that of the example")]
mod example;

#[test]
fn the_plc_clears_the_difference_and_starts_the_program_again() {
    let trace = example::run().unwrap().sequence();
    let rises = trace.lines().filter(|line| line.contains("channel_1.start ") && line.contains("0 -> 1")).count();
    assert_eq!(rises, 2, "{trace}");
}

#[test]
fn the_page_shows_the_program_in_python_that_is_in_the_examples() {
    let read = |path: &str| fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap();
    let program = read("examples/python_plc/isg_gantry.py");
    assert!(read("docs/isg_plc.md").contains(&format!("```python\n{program}```\n")), "copy the program into the page");
}
