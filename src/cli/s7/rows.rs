//! The number of rows, for a request beyond the last one. The NCK reports it for axes and alarms.

use super::arguments::Host;
use super::sources::Source;
use super::targets::Target;
use crate::s7::client::{Error, NcVariable, Value, Variable};

/// Modules whose number of rows is in another variable: area, modules, that variable, kind of row.
const COUNTED: &[(u8, &[u8], &str, &str)] = &[
    (2, &[0x71, 0x74], "Y/numMachAxes", "machine axes"),
    (0, &[0x54, 0x75, 0x76, 0x77], "Y/maxnumAlarms", "alarm rows"),
];

/// The remedy for each target that was out of range, if it is more specific than the general one.
pub(super) async fn cures(
    host: &Host,
    sources: &[Source],
    targets: &[Target],
    values: &[Result<Value, Error>],
) -> Vec<Option<String>> {
    let mut all = Vec::new();
    for (target, value) in targets.iter().zip(values) {
        all.push(match (&target.variable, value, sources.iter().find(|source| source.is_nck())) {
            (Variable::Nc(variable), Err(Error::Refused { code: 5, .. }), Some(nck)) => {
                host.optional(count(nck, variable)).await
            }
            _ => None,
        });
    }
    all
}

async fn count(nck: &Source, variable: &NcVariable) -> Option<String> {
    let item = variable.item;
    let (.., counter, what) =
        COUNTED.iter().find(|(area, modules, ..)| *area == item.area && modules.contains(&item.module))?;
    let (area, unit) = if item.area == 0 { ('N', String::new()) } else { ('C', item.unit.to_string()) };
    let counter: NcVariable = format!("{area}{unit}/{counter}").parse().ok()?;
    let Value::Word(count) = nck.client.read(&counter.into()).await.ok()? else { return None };
    let last = u32::from(item.line) + u32::from(item.count) - 1;
    let count = u32::from(count);
    (count < last).then(|| format!("there are {count} {what}: rows 1 to {count}"))
}
