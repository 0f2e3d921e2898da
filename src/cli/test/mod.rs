//! `opennck test`: runs all scenarios below the given paths in parallel and compares their traces with the golden files. A case is one
//! scenario with one combination of its matrix under one profile.

#![expect(clippy::disallowed_methods, reason = "reports tell how long a case took")]

mod annotations;
mod arguments;
mod junit;
mod page;
mod select;
mod suite;
mod watch;
mod work;

pub(super) use arguments::{Arguments, Shard};

use super::output::Output;
use crate::plc::Programs;
use select::found;
use suite::{list, once, reports};

pub(super) fn test(arguments: &Arguments, programs: &Programs, output: &mut Output) -> u8 {
    let begun = found(arguments).and_then(|found| Ok((reports(arguments, &found.work)?, found)));
    let (reports, found) = match begun {
        Ok(begun) => begun,
        Err(problem) => {
            output.error(problem);
            return 2;
        }
    };
    if arguments.list {
        return list(&found.work, output);
    }
    let code = once(&found, Some(reports), arguments, programs, output);
    if arguments.watch { watch::again(arguments, programs, output) } else { code }
}
