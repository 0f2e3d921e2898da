//! `opennck s7 nck`: the NC variables that have a name.

use crate::cli::list::{Format, List};
use crate::cli::output::Output;
use crate::s7::client::{NcVariable, Variable};
use crate::source::Problem;
use crate::variables::nc::CATALOGUE;

/// How many similar names are suggested.
const NEAREST: usize = 3;

pub(super) fn list(filter: Option<&str>, format: Format, output: &mut Output) -> u8 {
    let wanted = filter.unwrap_or_default().to_lowercase();
    let rows = CATALOGUE.iter().map(|row| {
        let variable = NcVariable::of(row);
        let (column, module) = (variable.item.column, variable.item.module);
        let kind = Variable::Nc(variable).type_name();
        vec![format!("nck:{}", row.name), kind, format!("{module:02X}"), column.to_string()]
    });
    let rows: Vec<_> = rows.filter(|row| row.iter().any(|text| text.to_lowercase().contains(&wanted))).collect();
    let is_empty = rows.is_empty();
    let code = List { heads: &["variable", "type", "module", "column"], rows }.print(format, output);
    if !is_empty {
        return code;
    }
    output.error(Problem::new(
        format!("no NC variable contains `{}`", filter.unwrap_or_default()),
        format!("similar names: {}; omit the text to list all", nearest(&wanted).join(", ")),
    ));
    code.max(1)
}

/// The most similar names; only the part after the last slash is compared.
fn nearest(wanted: &str) -> Vec<&'static str> {
    let wanted = wanted.rsplit('/').next().unwrap_or_default();
    let last = |name: &str| name.rsplit('/').next().unwrap_or_default().to_lowercase();
    let mut names: Vec<_> = CATALOGUE.iter().map(|row| row.name).collect();
    names.sort_by(|one, other| {
        let alike = |name: &str| strsim::jaro_winkler(&last(name), wanted);
        alike(other).total_cmp(&alike(one))
    });
    names.truncate(NEAREST);
    names
}
