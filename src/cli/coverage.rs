//! Coverage of PLC programs with statements: the file of `--plc-coverage`, and the lines of `opennck test`.

use std::path::Path;

use crate::plc::step7::Coverage;
use crate::source::Problem;

/// The form of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Html,
    Json,
    Lcov,
}

impl Form {
    /// The form by the ending of a file.
    pub(super) fn of(path: &Path) -> Result<Self, Problem> {
        match path.extension().and_then(|ending| ending.to_str()) {
            Some("html") => Ok(Self::Html),
            Some("json") => Ok(Self::Json),
            Some("lcov" | "info") => Ok(Self::Lcov),
            _ => {
                let what = format!("expected a file that ends in .html, .json or .lcov, found {}", path.display());
                Err(Problem::new(what, "the ending of the file selects the form of the coverage"))
            }
        }
    }

    /// The coverage of all programs that ran.
    pub(super) fn text(self, all: &[Coverage]) -> Result<String, Problem> {
        if all.is_empty() {
            let what = "expected a STEP 7 program as the PLC of a scenario, found none: there is no coverage to write";
            return Err(Problem::new(what, "name its folder: plc = \"step7/portal\""));
        }
        Ok(match self {
            Self::Html => Coverage::html(all),
            Self::Lcov => all.iter().map(Coverage::lcov).collect(),
            Self::Json => match all {
                [one] => one.json(),
                all => format!("[{}]\n", all.iter().map(Coverage::json).collect::<Vec<_>>().join(",")),
            },
        })
    }
}

/// Adds the coverage of a run to that of others.
pub(super) fn add(all: &mut Vec<Coverage>, one: Coverage) {
    match all.iter_mut().find(|known| known.is_like(&one)) {
        Some(known) => known.add(&one),
        None => all.push(one),
    }
}
