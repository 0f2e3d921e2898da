//! Which cases run, and in which order: `--filter`, then `--shard`, then `--shuffle`.

use std::path::PathBuf;

use super::arguments::{Arguments, Shard};
use super::work::{Item, Work};
use crate::golden::{cases, orphans, scenario_files};
use crate::source::Problem;

/// The selected cases, and the golden files that belong to no case.
pub(super) struct Found {
    /// In the order in which they run.
    pub(super) work: Vec<Work>,
    pub(super) orphans: Vec<PathBuf>,
}

/// What is below the paths.
pub(super) fn found(arguments: &Arguments) -> Result<Found, Problem> {
    let (mut work, mut files) = (Vec::new(), Vec::new());
    for file in scenario_files(&arguments.paths)? {
        let cases = cases(&file);
        let snaps = cases.as_ref().ok().map(|cases| cases.iter().map(|case| case.snap.clone()).collect());
        files.push((file.clone(), snaps));
        match cases {
            Err(problem) => {
                work.push(Work { name: file.display().to_string(), file, item: Item::Unusable(problem) });
            }
            Ok(cases) => work.extend(cases.into_iter().map(|mut case| {
                case.check_causes = arguments.check_causes;
                Work { name: case.name(), file: file.clone(), item: Item::Case(Box::new(case)) }
            })),
        }
    }
    let orphans = orphans(&arguments.paths, &files)?;
    Ok(Found { work: select(work, arguments)?, orphans })
}

/// The selected cases. A file that cannot be used stays: it may hold the case that is looked for.
fn select(mut work: Vec<Work>, arguments: &Arguments) -> Result<Vec<Work>, Problem> {
    let Arguments { filter, shard, shuffle, .. } = arguments;
    if !filter.is_empty() {
        let all = work.len();
        work.retain(|work| work.case().is_none() || filter.iter().any(|text| is_meant(work, text)));
        if work.is_empty() {
            return Err(Problem::new(
                format!("expected a case with `{}` in its name or rules, found none of {all}", filter.join("` or `")),
                "`opennck test --list` prints the names of all cases",
            ));
        }
    }
    if let Some(Shard { part, of }) = *shard {
        // Neighbours are of one area and take about the same time, so each part gets some of each area.
        work = work.into_iter().skip(part - 1).step_by(of).collect();
    }
    if let Some(seed) = *shuffle {
        shuffled(&mut work, seed);
    }
    Ok(work)
}

/// Whether a case has this text in its name, or cites this rule.
fn is_meant(work: &Work, text: &str) -> bool {
    let cites = |rule: &String| rule.eq_ignore_ascii_case(text);
    work.name.contains(text) || work.case().is_some_and(|case| case.scenario.covers.iter().any(cites))
}

/// An order that follows from the seed alone, on every computer (Fisher and Yates, with the generator splitmix64).
fn shuffled<T>(items: &mut [T], seed: u64) {
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    };
    for last in (1..items.len()).rev() {
        let at = usize::try_from(random() % (last as u64 + 1)).unwrap_or(0);
        items.swap(last, at);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_gives_one_order_of_the_same_items() {
        let order = |seed| {
            let mut items: Vec<u32> = (0..50).collect();
            shuffled(&mut items, seed);
            items
        };
        assert_eq!(order(1), order(1));
        assert_ne!(order(1), order(2));
        let mut sorted = order(1);
        sorted.sort_unstable();
        assert_eq!(sorted, (0..50).collect::<Vec<_>>());
    }

    #[test]
    fn a_part_is_between_one_and_the_number_of_parts() {
        assert_eq!("3/16".parse(), Ok(Shard { part: 3, of: 16 }));
        for text in ["0/4", "5/4", "1/0", "1", "a/b", "1/2/3", "-1/2"] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
    }
}
