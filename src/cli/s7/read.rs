//! `opennck s7 read`.

use super::arguments::{Host, Names};
use super::cells::{Cell, cells, meant};
use super::failure::Failure;
use super::targets::{Dictionary, Target};
use super::{rows, sources};
use crate::cli::list::{Format, List};
use crate::cli::output::Output;
use crate::s7::client::{Error, Value};

pub(super) async fn read(
    host: &Host,
    addresses: &[String],
    names: &Names,
    format: Format,
    output: &mut Output,
) -> Result<u8, Failure> {
    let targets = Dictionary::open(names)?.targets(host, addresses).await?;
    let sources = sources::open(host, &targets).await?;
    let values = sources::read(&sources, targets.len()).await?;
    let cures = rows::cures(host, &sources, &targets, &values).await;
    Ok(show(&targets, &values, &cures, format, output))
}

/// Prints targets with their values, then the remedy for each refusal; returns the exit code.
pub(super) fn show(
    targets: &[Target],
    values: &[Result<Value, Error>],
    cures: &[Option<String>],
    format: Format,
    output: &mut Output,
) -> u8 {
    let row = |(target, value): (&Target, &Result<Value, Error>)| {
        let [shown, hex] = cells(target, value);
        let text = |text: String| Cell::from(text);
        let (address, kind) = (text(target.address()), text(target.variable.type_name()));
        vec![address, text(target.symbol.clone()), kind, shown, hex, text(meant(target, value))]
    };
    let rows = targets.iter().zip(values).map(row).collect();
    let list = List { heads: &["address", "symbol", "type", "value", "hex", "meaning"], rows };
    let code = list.print(format, output);
    let mut is_refused = false;
    for (target, (value, cure)) in targets.iter().zip(values.iter().zip(cures)) {
        if let Err(error) = value {
            is_refused = true;
            output.error(target.problem(error, cure.clone()));
        }
    }
    if is_refused { code.max(1) } else { code }
}
