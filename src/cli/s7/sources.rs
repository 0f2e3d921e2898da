//! The modules that hold the values: the PLC, the NCK, or both. A control has them at two TSAPs, so each has its own connection.

use super::arguments::Host;
use super::failure::Failure;
use super::targets::Target;
use crate::s7::client::{Client, Error, Value, Variable};

/// One module, and which of the targets it holds.
#[derive(Debug)]
pub(super) struct Source {
    pub(super) name: &'static str,
    pub(super) client: Client,
    pub(super) targets: Vec<usize>,
    pub(super) variables: Vec<Variable>,
}

impl Source {
    pub(super) fn is_nck(&self) -> bool {
        self.name == NCK
    }
}

const NCK: &str = "NCK";

/// Connects to each module that holds one of the targets.
pub(super) async fn open(host: &Host, targets: &[Target]) -> Result<Vec<Source>, Failure> {
    let mut sources = Vec::new();
    for (name, is_nck) in [("PLC", false), (NCK, true)] {
        let of: Vec<usize> = (0..targets.len()).filter(|at| targets[*at].is_of_the_nck() == is_nck).collect();
        if of.is_empty() {
            continue;
        }
        let client = if is_nck { host.nck().await? } else { host.plc().await? };
        let variables = of.iter().map(|at| targets[*at].variable.clone()).collect();
        sources.push(Source { name, client, targets: of, variables });
    }
    Ok(sources)
}

/// Reads all targets, in their order. A connection error ends the read.
pub(super) async fn read(sources: &[Source], count: usize) -> Result<Vec<Result<Value, Error>>, Error> {
    let mut values: Vec<Option<Result<Value, Error>>> = vec![None; count];
    for source in sources {
        for (at, value) in source.targets.iter().zip(source.client.read_all(&source.variables).await) {
            match value {
                Err(error) if error.is_of_the_connection() => return Err(error),
                value => values[*at] = Some(value),
            }
        }
    }
    Ok(values.into_iter().flatten().collect())
}
