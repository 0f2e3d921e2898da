//! `opennck s7 write`.

use super::arguments::{Host, Names};
use super::failure::Failure;
use super::sources::Source;
use super::targets::{Dictionary, Target};
use super::{read, rows, sources};
use crate::cli::list::Format;
use crate::cli::output::Output;
use crate::s7::client::{Error, Value, Variable};
use crate::source::Problem;

pub(super) async fn write(
    host: &Host,
    writes: &[String],
    names: &Names,
    format: Format,
    output: &mut Output,
) -> Result<u8, Failure> {
    let split = writes.iter().map(|text| {
        text.split_once('=').map(|(address, value)| (address.to_owned(), value)).ok_or_else(|| {
            Problem::new(format!("expected ADDRESS=VALUE, found `{text}`"), "write it as DB31.DBX29.4=1")
        })
    });
    let (addresses, texts): (Vec<String>, Vec<&str>) = split.collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
    let mut dictionary = Dictionary::open(names)?;
    let targets = dictionary.targets(host, &addresses).await?;
    let values = targets.iter().zip(&texts).map(|(target, text)| dictionary.value(target, text));
    let values = values.collect::<Result<Vec<Value>, _>>()?;
    // Connect first: an unreachable host is reported before anything is written.
    let sources = sources::open(host, &targets).await?;
    let results = send(&sources, &targets, &values).await;
    let lost = results.iter().find_map(|result| result.as_ref().err().filter(|error| error.is_of_the_connection()));
    if let Some(error) = lost {
        return Err(error.into());
    }
    let shown: Vec<_> = values.into_iter().zip(results).map(|(value, result)| result.map(|()| value)).collect();
    let cures = rows::cures(&sources, &targets, &shown).await;
    Ok(read::show(&targets, &shown, &cures, format, output))
}

async fn send(sources: &[Source], targets: &[Target], values: &[Value]) -> Vec<Result<(), Error>> {
    let mut results = vec![Ok(()); targets.len()];
    for source in sources {
        let of = |at: &usize| (targets[*at].variable.clone(), values[*at].clone());
        let writes: Vec<(Variable, Value)> = source.targets.iter().map(of).collect();
        for (at, result) in source.targets.iter().zip(source.client.write_all(&writes).await) {
            results[*at] = result;
        }
    }
    results
}
