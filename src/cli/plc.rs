//! `opennck plc check`: compiles a STEP 7 program and lists its blocks, what is missing, and what is not supported.

use std::path::Path;

use super::output::Output;
use crate::plc::step7::{Compiled, Finding, FindingKind, Folder, Language, Program, compile};

/// Compiles a folder. The exit code is 0 if it can run, 1 if blocks are missing or not supported, 2 if a source has errors.
pub(super) fn check(folder: &Path, output: &mut Output) -> u8 {
    let read = match Folder::read(folder) {
        Ok(read) => read,
        Err(problem) => {
            output.error(problem);
            return 2;
        }
    };
    let compiled = compile(&read.sources, &read.toml.settings);
    sources(&compiled, output);
    blocks(&compiled, output);
    if let Some(program) = &compiled.program {
        sizes(program, output);
    }
    remarks(&compiled.remarks, output);
    findings(&compiled.findings, output)
}

fn sources(compiled: &Compiled, output: &mut Output) {
    for (name, language) in &compiled.languages {
        let language = match language {
            Language::International => "international",
            Language::German => "German",
        };
        output.line(format!("{name}: {language} operations"));
    }
}

fn blocks(compiled: &Compiled, output: &mut Output) {
    output.line(format!("\nblocks: {}", compiled.blocks.len()));
    let lengths = compiled.program.as_ref().map(Program::data_blocks).unwrap_or_default();
    for (name, symbol, statements) in &compiled.blocks {
        let data = lengths.iter().find(|block| name.to_string() == format!("DB{}", block.number));
        let size = match (data, statements) {
            (Some(block), _) => format!("{} bytes", block.bytes.len()),
            (None, 0) => String::new(),
            (None, 1) => "1 statement".to_owned(),
            (None, count) => format!("{count} statements"),
        };
        let name = name.to_string();
        let symbol = symbol.as_ref().map(|symbol| format!("  \"{symbol}\"")).unwrap_or_default();
        output.line(format!("  {name:8} {size:>16}{symbol}").trim_end());
    }
}

fn sizes(program: &Program, output: &mut Output) {
    let sizes = program.sizes();
    output.line(format!(
        "\nareas: I {} bytes, Q {} bytes, M {} bytes, {} timers, {} counters; {} statements",
        sizes.inputs,
        sizes.outputs,
        sizes.flags,
        sizes.timers,
        sizes.counters,
        program.statements()
    ));
    let basic: Vec<_> = program.basic_program().map(|(block, name)| format!("{block} {name}")).collect();
    if !basic.is_empty() {
        output.line(format!("blocks of the basic program that are built in: {}", basic.join(", ")));
    }
    let foreign: Vec<_> = program.foreign_data_blocks().iter().map(|number| format!("DB{number}")).collect();
    if !foreign.is_empty() {
        output.line(format!("data blocks that the machine must have: {}", foreign.join(", ")));
    }
    let left_out: Vec<_> = program.left_out().iter().map(ToString::to_string).collect();
    if !left_out.is_empty() {
        output.line(format!("calls that are left out, because the block is nowhere: {}", left_out.join(", ")));
    }
}

/// Lists what the program has and the engine leaves out. It does not keep the program from running.
fn remarks(remarks: &[Finding], output: &mut Output) {
    if remarks.is_empty() {
        return;
    }
    output.line(format!("\nleft out: {}", remarks.len()));
    for remark in remarks {
        output.line(format!("  {}", remark.to_string().lines().next().unwrap_or_default()));
    }
}

/// Lists the findings by kind, and returns the exit code.
fn findings(findings: &[Finding], output: &mut Output) -> u8 {
    let mut code = 0;
    for (kind, title) in
        [(FindingKind::Error, "errors"), (FindingKind::Unsupported, "not supported"), (FindingKind::Missing, "missing")]
    {
        let of_kind: Vec<_> = findings.iter().filter(|finding| finding.kind == kind).collect();
        if of_kind.is_empty() {
            continue;
        }
        output.line(format!("\n{title}: {}", of_kind.len()));
        for finding in of_kind {
            output.line(format!("  {}", finding.to_string().replace('\n', "\n  ")));
        }
        code = code.max(if kind == FindingKind::Error { 2 } else { 1 });
    }
    if code == 0 {
        output.line("\nno findings");
    }
    code
}
