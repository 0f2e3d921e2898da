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
    let read_back = host.optional(async { sources::read(&sources, targets.len()).await.ok() }).await;
    for (at, target) in targets.iter().enumerate().filter(|(at, _)| results[*at].is_ok()) {
        if dictionary.is_overwritten(target) {
            output.warning(format!("{} was written, but the NCK overwrites it in the same cycle", target.name()));
        } else if let Some(Ok(found)) = read_back.as_ref().and_then(|found| found.get(at))
            && differ(target, &values[at], found)
        {
            let name = target.name();
            output.warning(format!(
                "{name} was written and reads back as {found}: the PLC program, or another client, writes it"
            ));
        }
    }
    let shown: Vec<_> = values.into_iter().zip(results).map(|(value, result)| result.map(|()| value)).collect();
    let cures = rows::cures(host, &sources, &targets, &shown).await;
    Ok(read::show(&targets, &shown, &cures, format, output))
}

/// Whether two values of a target differ, as bytes. Types may differ: a number without a type is sent as the module's type.
fn differ(target: &Target, one: &Value, other: &Value) -> bool {
    match (one.encode(&target.variable), other.encode(&target.variable)) {
        (Ok(one), Ok(other)) => one.len() == other.len() && one != other,
        (Err(_), _) | (_, Err(_)) => false,
    }
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
