//! `opennck s7 read`.

use super::arguments::{Host, Names};
use super::targets::{Dictionary, Target, cells};
use super::{problem, sources};
use crate::cli::Format;
use crate::cli::list::List;
use crate::cli::output::Output;
use crate::s7::client::{Error, Value};
use crate::source::Problem;

pub(super) async fn read(
    host: &Host,
    addresses: &[String],
    names: &Names,
    format: Format,
    output: &mut Output,
) -> Result<u8, Problem> {
    let targets = Dictionary::open(names)?.targets(host, addresses).await?;
    let sources = sources::open(host, &targets).await?;
    let values = sources::read(&sources, targets.len()).await.map_err(|error| problem(&error))?;
    Ok(show(&targets, &values, format, output))
}

/// Prints targets with their values; the exit code. What to do about a refusal is told once each.
pub(super) fn show(targets: &[Target], values: &[Result<Value, Error>], format: Format, output: &mut Output) -> u8 {
    let row = |(target, value): (&Target, &Result<Value, Error>)| {
        let [value, hex] = cells(&target.variable, value);
        vec![target.address(), target.symbol.clone(), target.variable.type_name(), value, hex]
    };
    let rows = targets.iter().zip(values).map(row).collect();
    let list = List { heads: &["address", "symbol", "type", "value", "hex"], rows };
    let code = list.print(format, output);
    let refused: Vec<&Error> = values.iter().filter_map(|value| value.as_ref().err()).collect();
    for error in &refused {
        output.error(problem(error));
    }
    if refused.is_empty() { code } else { code.max(1) }
}
