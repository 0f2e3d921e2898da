//! Which combinations of values are cases.

use std::collections::BTreeSet;

use super::dimension::Dimension;
use super::hash::number as drawn;
use crate::source::{Node, Place, Problem, Value};

#[derive(Clone, Debug)]
pub(super) enum Strategy {
    /// Every combination; the last dimension varies fastest.
    All,
    /// Combinations so that any two values of two dimensions occur together.
    Pairwise(Vec<Vec<u64>>),
    /// So many combinations that follow from the seed.
    Drawn(u64),
    /// Every combination of the others; this value is bisected until the interval between good and bad has this length.
    Boundary { key: String, resolution: f64 },
}

/// The largest number of cases of a bisection: 62 halves of any interval are shorter than a number can show.
pub(super) const BISECTIONS: u64 = 64;

const CURE: &str =
    "write strategy = \"all\" or \"pairwise\", { random = 1000 } or { boundary = \"37110[XF]\", to = 0.001 }";

impl Strategy {
    pub(super) fn read(node: Option<Node>) -> Result<Self, Problem> {
        let Some(node) = node else { return Ok(Self::All) };
        match node.value {
            Value::Text(ref text) if text == "all" => Ok(Self::All),
            Value::Text(ref text) if text == "pairwise" => Ok(Self::Pairwise(Vec::new())),
            Value::Table(mut table) => {
                let (count, key, to) = (table.take("random"), table.take("boundary"), table.take("to"));
                table.finish()?;
                match (count, key, to) {
                    (Some(count), None, None) => match u64::try_from(count.integer("a number of cases")?) {
                        Ok(number) if number > 0 => Ok(Self::Drawn(number)),
                        _ => Err(count.expected("a number of cases above 0", CURE)),
                    },
                    (None, Some(key), Some(to)) => {
                        let resolution = to.number("the length of the last interval")?;
                        if resolution <= 0.0 {
                            return Err(to.expected("a length above 0", CURE));
                        }
                        Ok(Self::Boundary { key: key.text("the value to bisect")?.to_owned(), resolution })
                    }
                    _ => Err(node
                        .place
                        .problem("expected `random`, or `boundary` with `to`, found something else", CURE)),
                }
            }
            _ => Err(node.expected("a strategy", CURE)),
        }
    }

    /// Whether this key is bisected.
    pub(super) fn bisects(&self, wanted: &str) -> bool {
        matches!(self, Self::Boundary { key, .. } if key == wanted)
    }

    /// Whether each case has its own numbers of a distribution.
    pub(super) fn draws_anew(&self) -> bool {
        matches!(self, Self::Drawn(_))
    }

    pub(super) fn cases(&self, dimensions: &[Dimension]) -> u128 {
        let product = || dimensions.iter().fold(1_u128, |product, one| product.saturating_mul(u128::from(one.len())));
        match self {
            Self::All => product(),
            Self::Pairwise(rows) => rows.len() as u128,
            Self::Drawn(count) => u128::from(*count),
            Self::Boundary { .. } => product().saturating_mul(u128::from(BISECTIONS)),
        }
    }

    /// The index of the value of each dimension in a case.
    pub(super) fn picks(&self, dimensions: &[Dimension], seed: u64, number: u64) -> Vec<u64> {
        let product = |mut number: u64| {
            let mut picks: Vec<u64> = Vec::with_capacity(dimensions.len());
            for dimension in dimensions.iter().rev() {
                picks.push(number % dimension.len().max(1));
                number /= dimension.len().max(1);
            }
            picks.reverse();
            picks
        };
        match self {
            Self::All => product(number),
            Self::Boundary { .. } => product(number / BISECTIONS),
            Self::Pairwise(rows) => {
                usize::try_from(number).ok().and_then(|row| rows.get(row)).cloned().unwrap_or_default()
            }
            Self::Drawn(_) => {
                let pick = |(index, dimension): (usize, &Dimension)| {
                    drawn(seed, [number, index as u64]) % dimension.len().max(1)
                };
                dimensions.iter().enumerate().map(pick).collect()
            }
        }
    }

    pub(super) fn in_words(&self, seed: u64) -> String {
        match self {
            Self::All => "all combinations".to_owned(),
            Self::Pairwise(_) => "pairwise: any two values occur together".to_owned(),
            Self::Drawn(count) => format!("{count} random combinations, seed {seed}"),
            Self::Boundary { key, resolution } => format!("bisection of {key} to {resolution}"),
        }
    }
}

/// The largest number of pairs of values that are covered.
const PAIRS: usize = 200_000;

/// A pair of values: two dimensions with the index of a value each.
type Pair = ((usize, u64), (usize, u64));

/// Combinations so that any two values of two dimensions occur together. Each one begins with the first pair that is not covered yet; each
/// further dimension takes the value that covers the most pairs, the first of several.
pub(super) fn pairs(dimensions: &[Dimension], whole: &Place) -> Result<Vec<Vec<u64>>, Problem> {
    let mut count: u64 = 0;
    for (index, one) in dimensions.iter().enumerate() {
        for other in &dimensions[index + 1..] {
            count = count.saturating_add(one.len().saturating_mul(other.len()));
        }
    }
    if count > PAIRS as u64 {
        let what = format!("expected at most {PAIRS} pairs of values for \"pairwise\", found {count}");
        return Err(whole.problem(what, "use fewer values, or strategy = { random = 1000 }"));
    }
    if let [only] = dimensions {
        return Ok((0..only.len()).map(|value| vec![value]).collect());
    }
    let mut open: BTreeSet<Pair> = BTreeSet::new();
    for (index, one) in dimensions.iter().enumerate() {
        for (further, other) in dimensions.iter().enumerate().skip(index + 1) {
            open.extend((0..one.len()).flat_map(|a| (0..other.len()).map(move |b| ((index, a), (further, b)))));
        }
    }
    let mut rows = Vec::new();
    while let Some(((first, a), (second, b))) = open.first().copied() {
        let mut row: Vec<Option<u64>> = vec![None; dimensions.len()];
        (row[first], row[second]) = (Some(a), Some(b));
        for (index, dimension) in dimensions.iter().enumerate() {
            if row[index].is_none() {
                let covers = |value: u64| {
                    let others = row.iter().enumerate().filter_map(|(other, chosen)| Some((other, (*chosen)?)));
                    others.filter(|other| open.contains(&ordered((index, value), *other))).count()
                };
                // The last of equal maxima in reverse order is the first.
                row[index] = (0..dimension.len()).rev().max_by_key(|value| covers(*value));
            }
        }
        let row: Vec<u64> = row.into_iter().map(Option::unwrap_or_default).collect();
        for (index, value) in row.iter().enumerate() {
            for (further, other) in row.iter().enumerate().skip(index + 1) {
                open.remove(&((index, *value), (further, *other)));
            }
        }
        rows.push(row);
    }
    Ok(rows)
}

fn ordered(one: (usize, u64), other: (usize, u64)) -> Pair {
    if one.0 < other.0 { (one, other) } else { (other, one) }
}
