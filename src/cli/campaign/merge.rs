//! `opennck campaign merge`: one result of the results of all parts.

use std::path::{Path, PathBuf};

use super::report;
use super::results::{Part, Results};
use crate::campaign::{Header, Record, Spec, Summary};
use crate::cli::output::Output;
use crate::plc::Programs;
use crate::source::Problem;

pub(super) fn merge(
    spec: &Path,
    folders: &[PathBuf],
    out: &Path,
    programs: &Programs,
    output: &mut Output,
) -> Result<u8, Problem> {
    let spec = Spec::read(spec, programs)?;
    let mut parts = folders.iter().map(|folder| Part::open(folder)).collect::<Result<Vec<_>, _>>()?;
    let Some(first) = parts.first() else {
        return Err(Problem::new("expected the folders of all parts, found none", "name the --out of each part"));
    };
    let (cases, of) = (first.header.cases, first.header.shard.1);
    if parts.iter().any(|part| out == part.folder()) {
        return Err(Problem::new("expected another folder for --out, found that of a part", "choose a new folder"));
    }
    let header =
        |shard| Header { version: env!("CARGO_PKG_VERSION").to_owned(), spec: spec.hash.clone(), cases, shard };
    parts.sort_by_key(|part| part.header.shard);
    for part in &parts {
        part.check(&header((part.header.shard.0, of)))?;
    }
    for (index, number) in (1..=of).enumerate() {
        match parts.get(index) {
            Some(part) if part.header.shard.0 == number => {}
            Some(part) if part.header.shard.0 < number => {
                let what = format!("expected each part once, found part {}/{of} twice", part.header.shard.0);
                return Err(part.place().problem(what, "name each folder once"));
            }
            _ => {
                let what = format!("expected the results of all {of} parts, found none of part {number}/{of}");
                return Err(Problem::new(what, format!("run it with --shard {number}/{of}, and name its folder")));
            }
        }
    }
    if let Some(extra) = parts.get(usize::try_from(of).unwrap_or(usize::MAX)) {
        let what = format!("expected {of} parts, found {}", parts.len());
        return Err(extra.place().problem(what, "name each folder once"));
    }
    let mut results = Results::begin(out, &header((1, 1)))?;
    let mut summary = Summary::of(&spec);
    let mut waiting: Vec<Option<Record>> = parts.iter_mut().map(|part| part.next(false)).collect::<Result<_, _>>()?;
    loop {
        let next = waiting.iter().enumerate().filter_map(|(index, record)| Some((record.as_ref()?.case, index))).min();
        let Some((_, index)) = next else { break };
        if let Some(record) = waiting[index].take() {
            summary.add(&record);
            results.write(std::slice::from_ref(&record))?;
        }
        waiting[index] = parts[index].next(false)?;
    }
    if let Some(part) = parts.iter().find(|part| !part.is_complete) {
        let what = "expected the results of a whole part, found a run that was interrupted";
        return Err(part.place().problem(what, "run it again with the same arguments and --resume"));
    }
    results.finish()?;
    report::report(&spec, summary, out, programs, output)
}
