//! The answer of a campaign: failures by what failed first and why, margins, and what no case reached.

use std::collections::{BTreeMap, BTreeSet};

use super::oracles::SOMETIMES;
use super::record::{Record, Verdict};
use super::spec::Spec;
use crate::image::Block;
use crate::plc::Programs;
use crate::source::Problem;
use crate::units::{ChannelNumber, ModeGroupNumber};

/// Cases that fail in the same way.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// What failed.
    pub failure: String,
    /// The rules in the chain of causes behind it.
    pub chain: Vec<String>,
    /// The number of cases.
    pub count: u64,
    /// The first of them.
    pub first: Record,
    /// The values that occur in these cases, for each thing that varies: at most ten.
    pub values: Vec<(String, Vec<String>)>,
}

/// The smallest margin of a rule.
#[derive(Clone, Debug, PartialEq)]
pub struct MarginRow {
    /// The rule.
    pub rule: String,
    /// The margin: cycles, or the unit of the compared value. Below zero the rule is broken.
    pub amount: f64,
    /// Whether it is a number of cycles.
    pub in_cycles: bool,
    /// The case with this margin.
    pub case: u64,
    /// Its values.
    pub values: Vec<(String, String)>,
}

/// The sum of all records.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// The number of records.
    pub cases: u64,
    /// The numbers of cases that held, failed, or could not be used.
    pub verdicts: BTreeMap<&'static str, u64>,
    /// Failures, the most frequent first.
    pub groups: Vec<Group>,
    /// The smallest margin of each rule, the smallest first.
    pub margins: Vec<MarginRow>,
    /// Everything that a case reached.
    pub reached: BTreeSet<String>,
    /// What had to be reached by a case and was not: the campaign fails.
    pub never_reached: Vec<String>,
    /// For a bisection: the other values, and two neighbouring values of which one held and the other did not.
    pub boundaries: Vec<Boundary>,
    /// The index of the value that is bisected, and its results for each combination of the others.
    bisected: Option<usize>,
    intervals: BTreeMap<Values, Vec<(f64, bool)>>,
}

/// What varies, and its values.
type Values = Vec<(String, String)>;

/// Where a result changes.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundary {
    /// The values of everything else.
    pub values: Vec<(String, String)>,
    /// What is bisected.
    pub key: String,
    /// The value that held.
    pub held: f64,
    /// The value that did not.
    pub failed: f64,
}

/// The largest number of values that a group shows for one thing.
const SHOWN: usize = 10;

impl Summary {
    /// A summary without records.
    #[must_use]
    pub fn of(spec: &Spec) -> Self {
        Self { bisected: spec.bisected().map(|(index, ..)| index), ..Self::default() }
    }

    /// Adds a record. The order of the records does not matter, except that the first case of a group is the one with the lowest number.
    pub fn add(&mut self, record: &Record) {
        self.cases += 1;
        *self.verdicts.entry(record.verdict.name()).or_default() += 1;
        for item in &record.reached {
            if !self.reached.contains(item) {
                self.reached.insert(item.clone());
            }
        }
        for (rule, amount, in_cycles) in &record.margins {
            let new = MarginRow {
                rule: rule.clone(),
                amount: *amount,
                in_cycles: *in_cycles,
                case: record.case,
                values: record.values.clone(),
            };
            match self.margins.iter_mut().find(|known| known.rule == *rule) {
                Some(known) if (*amount, record.case) < (known.amount, known.case) => *known = new,
                Some(_) => {}
                None => self.margins.push(new),
            }
        }
        if let Some((_, value)) = self.bisected.and_then(|index| record.values.get(index)) {
            let others = record.values.iter().enumerate().filter(|(index, _)| Some(*index) != self.bisected);
            let others = others.map(|(_, pair)| pair.clone()).collect();
            let value = value.parse().unwrap_or(f64::NAN);
            self.intervals.entry(others).or_default().push((value, record.verdict == Verdict::Held));
        }
        if record.verdict == Verdict::Held {
            return;
        }
        let same = |group: &&mut Group| group.failure == record.failure && group.chain == record.chain;
        let group = match self.groups.iter_mut().find(same) {
            Some(group) => group,
            None => {
                let values = record.values.iter().map(|(key, _)| (key.clone(), Vec::new())).collect();
                let (failure, chain) = (record.failure.clone(), record.chain.clone());
                self.groups.push(Group { failure, chain, count: 0, first: record.clone(), values });
                let last = self.groups.len() - 1;
                &mut self.groups[last]
            }
        };
        group.count += 1;
        if record.case < group.first.case {
            group.first = record.clone();
        }
        for ((_, known), (_, value)) in group.values.iter_mut().zip(&record.values) {
            if known.len() < SHOWN && !known.contains(value) {
                known.push(value.clone());
            }
        }
    }

    /// Sorts, and finds what was not reached.
    ///
    /// # Errors
    /// A transition that must be reached is none of the charts of the control.
    pub fn finish(&mut self, spec: &Spec, programs: &Programs) -> Result<(), Problem> {
        self.groups.sort_by(|one, other| other.count.cmp(&one.count).then(one.first.case.cmp(&other.first.case)));
        self.margins.sort_by(|one, other| one.amount.total_cmp(&other.amount).then_with(|| one.rule.cmp(&other.rule)));
        for (values, results) in &mut self.intervals {
            results.sort_by(|one, other| one.0.total_cmp(&other.0));
            for pair in results.windows(2) {
                let (key, values) = (
                    self.bisected.map_or_else(String::new, |index| spec.dimensions[index].name.clone()),
                    values.clone(),
                );
                match pair {
                    [(held, true), (failed, false)] | [(failed, false), (held, true)] => {
                        self.boundaries.push(Boundary { values, key, held: *held, failed: *failed });
                    }
                    _ => {}
                }
            }
        }
        for text in &spec.oracles.sometimes {
            if !self.reached.contains(&format!("{SOMETIMES}{text}")) {
                self.never_reached.push(text.clone());
            }
        }
        let known = spec.transitions(programs)?;
        for text in &spec.oracles.transitions {
            if !known.contains(text) {
                let cure =
                    "`opennck flowchart` shows the charts; write \"approach: From -> To\" with the names of a report";
                return Err(Problem::new(format!("expected a transition of the control, found `{text}`"), cure));
            }
            if !self.reached.contains(&format!("transition {text}")) {
                self.never_reached.push(text.clone());
            }
        }
        Ok(())
    }

    /// Whether all cases held, and everything was reached that must be.
    #[must_use]
    pub fn is_good(&self) -> bool {
        self.groups.is_empty() && self.never_reached.is_empty()
    }

    /// What no case reached, of what can be listed: transitions of the control, and signals of the machine that the control models.
    ///
    /// # Errors
    /// The base scenario cannot be used.
    pub fn not_reached(&self, spec: &Spec, programs: &Programs) -> Result<Vec<String>, Problem> {
        let mut all: Vec<String> = spec.transitions(programs)?.iter().map(|one| format!("transition {one}")).collect();
        all.extend(spec.watched_signals(programs)?.into_iter().map(|one| format!("signal {one}")));
        all.retain(|one| !self.reached.contains(one));
        Ok(all)
    }
}

impl Spec {
    /// The transitions of the charts of the control: `gantry: From -> To`.
    pub(super) fn transitions(&self, programs: &Programs) -> Result<Vec<String>, Problem> {
        let prepared = self.scenario_of([])?.prepare(self.profile, programs)?;
        let charts = prepared.machine().control().texts().charts();
        let edges = charts
            .iter()
            .flat_map(|chart| chart.edges.iter().map(|edge| format!("{}: {} -> {}", chart.name, edge.from, edge.to)));
        Ok(edges.collect())
    }

    /// The bits of the interface of this machine that the control writes or reads.
    fn watched_signals(&self, programs: &Programs) -> Result<Vec<String>, Problem> {
        let prepared = self.scenario_of([])?.prepare(self.profile, programs)?;
        let machine = prepared.machine();
        let (names, texts, interface) = (machine.names(), machine.control().texts(), machine.names().interface());
        let exists = |block, number| match block {
            Block::Channel => ChannelNumber::new(number).is_some_and(|channel| machine.has_channel(channel)),
            Block::ModeGroup => ModeGroupNumber::new(number).is_some_and(|group| machine.has_mode_group(group)),
            Block::Nck | Block::Axis => true,
        };
        let mut signals = Vec::new();
        for (_, block, number) in names.owners().filter(|(_, block, number)| exists(*block, *number)) {
            for signal in interface.signals().filter(|signal| signal.block == block && texts.is_modelled(signal)) {
                let Some(location) = interface.location(signal, number).filter(|location| location.width == 1) else {
                    continue;
                };
                if machine.memory().locate(&names.address(location), names.profile).is_ok() {
                    signals.extend(names.symbol(location));
                }
            }
        }
        Ok(signals)
    }
}
