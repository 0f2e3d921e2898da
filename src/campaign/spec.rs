//! The file of a campaign: what runs, what varies, what must hold.

use std::path::{Path, PathBuf};

use super::apply::{applied, path as key_path};
use super::dimension::{Choice, Dimension, Values, values};
use super::hash::hash;
use super::oracles::Oracles;
use super::strategy::{Strategy, pairs};
use super::timed::{self, Base};
use crate::image::Profile;
use crate::plc::Programs;
use crate::scenario::Scenario;
use crate::source::{INPUT_MIB, Node, Place, Problem, Table, Value, read_bytes, read_text, unreadable};

/// A campaign: its cases are numbered, and what a case runs follows from its number.
#[derive(Clone, Debug)]
pub struct Spec {
    /// The file.
    pub path: PathBuf,
    /// What it shows, in one sentence.
    pub title: String,
    /// The file of the base scenario.
    pub scenario: PathBuf,
    /// The seed of everything that is drawn.
    pub seed: u64,
    /// Identifies the spec with everything that it reads.
    pub hash: String,
    pub(super) base: Table,
    pub(super) profile: Profile,
    pub(super) dimensions: Vec<Dimension>,
    pub(super) strategy: Strategy,
    pub(super) oracles: Oracles,
    /// The trace that every case must have, if it must.
    pub(super) golden: Option<String>,
}

impl Spec {
    /// Reads a campaign and its base scenario, and runs the base scenario if cases depend on its events.
    ///
    /// # Errors
    /// The file or the base scenario cannot be used; the problem names file and line.
    pub fn read(path: &Path, programs: &Programs) -> Result<Self, Problem> {
        let text = read_text(path)?;
        let file = path.display().to_string();
        let mut table = Table::parse(&text, &file)?;
        let whole = Place::file(&file);
        let title = table.take("title").map(|node| node.text("a title").map(str::to_owned)).transpose()?;
        let scenario = table.take("scenario").ok_or_else(|| {
            whole.problem("expected the key `scenario`, found none", "write scenario = \"golden/jog/keys.toml\"")
        })?;
        let directory = path.parent().unwrap_or_else(|| Path::new(""));
        let scenario = directory.join(scenario.text("the file of the base scenario")?);
        let base_text = read_text(&scenario)?;
        let mut base = Table::parse(&base_text, &scenario.display().to_string())?;
        if let Some((_, node)) = base.entries().find(|(key, _)| *key == "matrix") {
            let what = "expected a base scenario with one case, found one with a matrix";
            return Err(node.place.problem(what, "vary its keys in [vary] of the campaign instead"));
        }
        let seed = table.take("seed").map_or(Ok(1), |node| node.integer("a seed"))?.unsigned_abs();
        let strategy = Strategy::read(table.take("strategy"))?;
        let golden = table.take("golden").map_or(Ok(false), |node| node.boolean("true or false"))?;
        let oracles = Oracles::read(&mut table, &mut base)?;
        let vary = table.take("vary");
        let timed = [table.take("fault"), table.take("change"), table.take("jitter")];
        table.finish()?;
        let first = Scenario::of_table(base.clone(), &scenario)?;
        let profile = first.profiles.first().copied().unwrap_or_default();
        let mut base_run = Base::new(&first, profile, programs);
        let mut dimensions = Vec::new();
        if let Some(vary) = vary {
            for (key, place, node) in vary.into_table("keys with their values")?.take_rest() {
                node_is_quoted(&key, &node)?;
                let bisected = strategy.bisects(&key);
                let values = values(key_path(&key), node, bisected)?;
                dimensions.push(Dimension { name: key, place, values, is_timed: false });
            }
        }
        let [fault, change, jitter] = timed;
        timed::jitters(jitter, &base, &mut base_run, &mut dimensions)?;
        timed::faults(fault, &mut base_run, &mut dimensions)?;
        timed::changes(change, &mut base_run, &mut dimensions)?;
        // Cases with the same beginning follow each other: what acts only at a time varies fastest.
        dimensions.sort_by_key(|dimension| dimension.is_timed);
        if dimensions.is_empty() {
            let cure = "write [vary] with a key, [[fault]], [[change]] or [[jitter]]";
            return Err(whole.problem("expected something that varies, found nothing", cure));
        }
        if let Some(empty) = dimensions.iter().find(|dimension| dimension.len() == 0) {
            let what = format!("expected at least one value for {}, found none", empty.name);
            return Err(empty.place.problem(what, "without a value there is no case; write one, or remove it"));
        }
        let strategy = match strategy {
            Strategy::Pairwise(_) => Strategy::Pairwise(pairs(&dimensions, &whole)?),
            Strategy::Boundary { ref key, .. } if !dimensions.iter().any(|dimension| dimension.name == *key) => {
                let what = format!("expected the value to bisect, `{key}`, in [vary], found none");
                return Err(whole.problem(what, format!("write \"{key}\" = {{ from = 0.1, to = 1.0 }} in [vary]")));
            }
            other => other,
        };
        let golden = golden.then(|| base_run.golden()).transpose()?;
        let inputs = inputs_of(&first)?;
        let hash = hash([text.as_bytes(), base_text.as_bytes()].into_iter().chain(inputs.iter().map(Vec::as_slice)));
        let title = title.unwrap_or_else(|| first.title.clone());
        let path = path.to_owned();
        let spec = Self { path, title, scenario, seed, hash, base, profile, dimensions, strategy, oracles, golden };
        spec.check(programs)?;
        Ok(spec)
    }

    /// The values of a dimension are those of a machine: the first case must be usable, and each value by itself.
    fn check(&self, programs: &Programs) -> Result<(), Problem> {
        /// The number of values of a dimension that are tried before anything runs.
        const TRIED: u64 = 8;
        for dimension in &self.dimensions {
            for index in 0..dimension.len().min(TRIED) {
                let choice = dimension.choice(index, self.seed, 0);
                let table = applied(&self.base, [&choice])?;
                let scenario = Scenario::of_table(table, &self.scenario)?;
                scenario.prepare(self.profile, programs)?;
            }
        }
        Ok(())
    }

    /// The number of cases. With bisection it is the number of intervals times the largest number of cases in one.
    #[must_use]
    pub fn cases(&self) -> u128 {
        self.strategy.cases(&self.dimensions)
    }

    /// The seed and the strategy in words, for a report.
    #[must_use]
    pub fn strategy(&self) -> String {
        self.strategy.in_words(self.seed)
    }

    /// What varies, with the number of its values.
    #[must_use]
    pub fn varied(&self) -> Vec<(String, u64)> {
        self.dimensions.iter().map(|dimension| (dimension.name.clone(), dimension.len())).collect()
    }

    /// The values of a case: what varies, and its value.
    #[must_use]
    pub fn values(&self, number: u64) -> Vec<(String, String)> {
        let choices = self.choices(number);
        self.dimensions.iter().zip(choices).map(|(dimension, choice)| (dimension.name.clone(), choice.text)).collect()
    }

    /// The choices of a case, one for each dimension.
    pub(super) fn choices(&self, number: u64) -> Vec<Choice> {
        let picks = self.strategy.picks(&self.dimensions, self.seed, number);
        let draws = if self.strategy.draws_anew() { number } else { 0 };
        let choice = |(index, (dimension, pick)): (usize, (&Dimension, u64))| {
            // Each dimension has its own sequence of numbers.
            dimension.choice(pick, self.seed.wrapping_add(index as u64), draws)
        };
        self.dimensions.iter().zip(picks).enumerate().map(choice).collect()
    }

    /// The scenario of a case.
    ///
    /// # Errors
    /// The values do not fit the scenario.
    pub(super) fn scenario_of<'a>(&self, choices: impl IntoIterator<Item = &'a Choice>) -> Result<Scenario, Problem> {
        Scenario::of_table(applied(&self.base, choices)?, &self.scenario)
    }

    /// Whether a value is bisected.
    #[must_use]
    pub fn is_bisected(&self) -> bool {
        self.bisected().is_some()
    }

    /// The place of a dimension that is bisected, and its limits.
    pub(super) fn bisected(&self) -> Option<(usize, &[String], f64, f64)> {
        self.dimensions.iter().enumerate().find_map(|(index, dimension)| match &dimension.values {
            Values::Between { key, low, high } => Some((index, key.as_slice(), *low, *high)),
            Values::List(_) | Values::Drawn { .. } => None,
        })
    }
}

/// A key of `[vary]` with a dot needs quotes. (A range is a table, too, so only names of axes are recognised.)
fn node_is_quoted(key: &str, node: &Node) -> Result<(), Problem> {
    if key == "plant" && matches!(node.value, Value::Table(_)) {
        return node.refuse_unquoted_key(key);
    }
    Ok(())
}

/// The contents of all files that a scenario reads.
fn inputs_of(scenario: &Scenario) -> Result<Vec<Vec<u8>>, Problem> {
    let mut contents = Vec::new();
    for input in scenario.inputs() {
        let mut files = Vec::new();
        if input.is_dir() {
            let entries = std::fs::read_dir(&input).map_err(|error| unreadable(&input, &error))?;
            files.extend(entries.flatten().map(|entry| entry.path()).filter(|path| path.is_file()));
            files.sort();
        } else if input.is_file() {
            files.push(input);
        }
        for file in files {
            contents.push(read_bytes(&file, INPUT_MIB)?);
        }
    }
    Ok(contents)
}
