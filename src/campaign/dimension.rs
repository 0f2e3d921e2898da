//! What varies: a dimension has values, and each value changes the tables of the base scenario.

use super::hash::share;
use super::written;
use crate::source::{Node, Place, Problem, Table, Value};

/// Something that varies.
#[derive(Clone, Debug)]
pub(super) struct Dimension {
    /// The key, or the name of a fault, a change or an input.
    pub(super) name: String,
    pub(super) place: Place,
    pub(super) values: Values,
    /// Whether it acts at a time only: cases that differ in such dimensions have a common beginning.
    pub(super) is_timed: bool,
}

#[derive(Clone, Debug)]
pub(super) enum Values {
    /// These.
    List(Vec<Choice>),
    /// Numbers of a distribution for a key: as many as cases need, or a fixed number of them.
    Drawn { key: Vec<String>, distribution: Distribution, count: u64, decimals: usize },
    /// A range that is bisected.
    Between { key: Vec<String>, low: f64, high: f64 },
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Distribution {
    Uniform { low: f64, high: f64 },
    Normal { mean: f64, deviation: f64 },
}

/// One value.
#[derive(Clone, Debug)]
pub(super) struct Choice {
    /// For people.
    pub(super) text: String,
    pub(super) edits: Vec<Edit>,
}

/// A change of the tables of the base scenario.
#[derive(Clone, Debug)]
pub(super) enum Edit {
    /// This value at this path of keys.
    Put(Vec<String>, Node),
    /// One more entry of `[[at]]`.
    At(Table),
    /// So many cycles before the step with this index.
    Delay(usize, u64),
}

/// The largest number of values of a range.
const LONGEST: f64 = 1e9;

impl Dimension {
    /// The number of its values.
    pub(super) fn len(&self) -> u64 {
        match &self.values {
            Values::List(list) => list.len() as u64,
            Values::Drawn { count, .. } => *count,
            Values::Between { .. } => 1,
        }
    }

    /// The value with this index; `seed` and `number` select that of a distribution.
    pub(super) fn choice(&self, index: u64, seed: u64, number: u64) -> Choice {
        match &self.values {
            Values::List(list) => {
                let index = usize::try_from(index).unwrap_or(usize::MAX);
                list.get(index).cloned().unwrap_or_else(|| Choice { text: "as written".to_owned(), edits: Vec::new() })
            }
            Values::Drawn { key, distribution, decimals, .. } => {
                let value = rounded(distribution.draw(seed, [number, index]), *decimals);
                self.put(key, value)
            }
            Values::Between { key, low, .. } => self.put(key, *low),
        }
    }

    /// This number as its value.
    pub(super) fn put(&self, key: &[String], value: f64) -> Choice {
        let node = Node { place: self.place.clone(), value: Value::Float(value) };
        Choice { text: written::plain(&node), edits: vec![Edit::Put(key.to_vec(), node)] }
    }
}

impl Distribution {
    fn draw(self, seed: u64, [number, index]: [u64; 2]) -> f64 {
        match self {
            Self::Uniform { low, high } => low + (high - low) * share(seed, [number, index]),
            // The sum of twelve numbers from 0 to 1 has the mean 6 and the deviation 1; it needs no logarithm.
            Self::Normal { mean, deviation } => {
                let sum: f64 = (0..12).map(|part| share(seed, [number, index * 12 + part])).sum();
                mean + deviation * (sum - 6.0)
            }
        }
    }
}

/// The value of a key of `[vary]`: a list, a range, a distribution.
pub(super) fn values(key: Vec<String>, node: Node, bisected: bool) -> Result<Values, Problem> {
    const CURE: &str = "write [0.5, 0.6], { from = 0.5, to = 0.6, step = 0.01 }, { uniform = [0.5, 0.6], count = 20 } or \
        { normal = [0.5, 0.02], count = 20 }";
    let place = node.place.clone();
    match node.value {
        Value::Array(list) if !list.is_empty() && !bisected => {
            let choice = |node: Node| Choice { text: written::plain(&node), edits: vec![Edit::Put(key.clone(), node)] };
            Ok(Values::List(list.into_iter().map(choice).collect()))
        }
        Value::Table(mut table) => {
            let mut number = |key: &'static str| table.take(key).map(|node| node.number("a number")).transpose();
            let (low, high, step) = (number("from")?, number("to")?, number("step")?);
            let decimals = match table.take("decimals") {
                Some(node) => match usize::try_from(node.integer("a number of decimals")?) {
                    Ok(number @ 0..=12) => Some(number),
                    _ => return Err(node.expected("a number of decimals, 0 to 12", "write decimals = 3")),
                },
                None => None,
            };
            let count = table.take("count").map(|node| node.integer("a number of values")).transpose()?;
            let drawn = [pair(table.take("uniform"))?, pair(table.take("normal"))?];
            table.finish()?;
            let refused = |what: &str| Err(place.problem(format!("expected {what}"), CURE));
            match (low, high, drawn) {
                (Some(low), Some(high), [None, None]) if low <= high => {
                    if bisected {
                        return Ok(Values::Between { key, low, high });
                    }
                    let Some(step) = step.filter(|step| *step > 0.0 && (high - low) / step < LONGEST) else {
                        return refused("a range with a `step` above 0 and less than a billion values");
                    };
                    // Half a millionth of a step: the last value is part of the range although its sum is not exact.
                    let count = ((high - low) / step + 0.5e-6).floor();
                    let mut list = Vec::new();
                    let mut index = 0.0;
                    while index <= count {
                        let value = Value::Float(rounded(low + index * step, 12));
                        let node = Node { place: place.clone(), value };
                        list.push(Choice { text: written::plain(&node), edits: vec![Edit::Put(key.clone(), node)] });
                        index += 1.0;
                    }
                    Ok(Values::List(list))
                }
                (None, None, [Some(_), None] | [None, Some(_)]) if !bisected => {
                    let decimals = decimals.unwrap_or(6);
                    let Some(count) = count.and_then(|count| u64::try_from(count).ok()).filter(|count| *count > 0)
                    else {
                        return refused("a `count` above 0 beside a distribution");
                    };
                    let distribution = match drawn {
                        [Some((low, high)), _] if low <= high => Distribution::Uniform { low, high },
                        [None, Some((mean, deviation))] if deviation >= 0.0 => Distribution::Normal { mean, deviation },
                        _ => {
                            return refused("a distribution with its smaller limit first, or a deviation of 0 or more");
                        }
                    };
                    Ok(Values::Drawn { key, distribution, count, decimals })
                }
                (Some(_), Some(_), [None, None]) => refused("a range with `from` below `to`"),
                _ if bisected => refused("a range with `from` and `to` for the value that is bisected"),
                _ => refused("a range or one distribution"),
            }
        }
        _ => Err(place.problem("expected a list of values, a range or a distribution, found none of them", CURE)),
    }
}

fn pair(node: Option<Node>) -> Result<Option<(f64, f64)>, Problem> {
    let Some(node) = node else { return Ok(None) };
    match &node.value {
        Value::Array(list) if list.len() == 2 => Ok(Some((list[0].number("a number")?, list[1].number("a number")?))),
        _ => Err(node.expected("a list of two numbers", "write uniform = [0.5, 0.6] or normal = [0.5, 0.02]")),
    }
}

/// A number with so many decimals: the number that its text reads as.
pub(super) fn rounded(value: f64, decimals: usize) -> f64 {
    format!("{value:.decimals$}").parse().unwrap_or(value)
}
