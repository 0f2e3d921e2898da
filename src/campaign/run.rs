//! Runs cases. The cases of a unit differ only in what happens at a time, so their common beginning runs once; each goes on from a copy of it.

use std::collections::BTreeSet;
use std::ops::Range;

use super::apply::append;
use super::dimension::{Choice, Edit, rounded};
use super::oracles::SOMETIMES;
use super::record::{Record, Verdict};
use super::spec::Spec;
use super::strategy::{BISECTIONS, Strategy};
use crate::image::{Format, Location, Part};
use crate::plc::Programs;
use crate::scenario::{Duration, Failure, Finished, Missed, Prepared};
use crate::source::{Node, Place, Problem, Table, Value};
use crate::trace::difference;
use crate::units::Time;
use crate::variables::Describe;

/// The largest number of cases that run one after the other with one beginning.
const UNIT: u64 = 64;

impl Spec {
    /// The number of units of the first cases up to this number.
    #[must_use]
    pub fn units(&self, cases: u64) -> u64 {
        match self.strategy {
            Strategy::All => {
                let (timed, per_group) = self.groups();
                let rest = (cases % timed).div_ceil(UNIT);
                (cases / timed).saturating_mul(per_group).saturating_add(rest)
            }
            Strategy::Boundary { .. } => cases.div_ceil(BISECTIONS),
            Strategy::Pairwise(_) | Strategy::Drawn(_) => cases,
        }
    }

    /// The number of cases with one beginning, and of the units of these.
    fn groups(&self) -> (u64, u64) {
        let timed = self.dimensions.iter().filter(|one| one.is_timed);
        let count = timed.fold(1_u64, |count, one| count.saturating_mul(one.len())).max(1);
        (count, count.div_ceil(UNIT))
    }

    /// The numbers of the cases of a unit.
    #[must_use]
    pub fn unit(&self, index: u64) -> Range<u64> {
        match self.strategy {
            Strategy::All => {
                let (timed, per_group) = self.groups();
                let first = index / per_group * timed;
                let start = first + index % per_group * UNIT;
                start..(start + UNIT).min(first + timed)
            }
            Strategy::Boundary { .. } => index * BISECTIONS..(index + 1) * BISECTIONS,
            Strategy::Pairwise(_) | Strategy::Drawn(_) => index..index + 1,
        }
    }

    /// The unit of a case.
    #[must_use]
    pub fn unit_of(&self, case: u64) -> u64 {
        match self.strategy {
            Strategy::All => {
                let (timed, per_group) = self.groups();
                case / timed * per_group + case % timed / UNIT
            }
            Strategy::Boundary { .. } => case / BISECTIONS,
            Strategy::Pairwise(_) | Strategy::Drawn(_) => case,
        }
    }

    /// Runs the cases of a unit with a number below `cases`; the records are in the order of their numbers.
    #[must_use]
    pub fn run(&self, unit: u64, cases: u64, programs: &Programs) -> Vec<Record> {
        let Range { start, end } = self.unit(unit);
        if let Strategy::Boundary { resolution, .. } = &self.strategy {
            return self.bisect(start, *resolution, programs);
        }
        let mut order: Vec<(Time, u64, Vec<Choice>)> = Vec::new();
        let mut records = Vec::new();
        for number in start..end.min(cases) {
            let choices = self.choices(number);
            match first_time(&choices) {
                Some(time) if end - start > 1 => order.push((time, number, choices)),
                Some(_) | None => records.push(self.alone(number, &choices, programs)),
            }
        }
        order.sort_by_key(|(time, number, _)| (*time, *number));
        records.extend(self.forked(order, programs));
        records.sort_by_key(|record| record.case);
        records
    }

    /// Runs cases that are the same up to the first time of each.
    fn forked(&self, order: Vec<(Time, u64, Vec<Choice>)>, programs: &Programs) -> Vec<Record> {
        let Some((_, _, first)) = order.first() else { return Vec::new() };
        let common = first.iter().zip(&self.dimensions).filter(|(_, dimension)| !dimension.is_timed);
        let beginning = self.scenario_of(common.map(|(choice, _)| choice));
        let beginning = beginning.and_then(|scenario| scenario.prepare(self.profile, programs));
        let Ok(mut beginning) = beginning.map(Prepared::measure_margins) else {
            // The record of each case says what is wrong with it.
            return order.iter().map(|(_, number, choices)| self.alone(*number, choices, programs)).collect();
        };
        let mut records = Vec::new();
        for (time, number, choices) in order {
            beginning.advance(time);
            let own = self.scenario_of(&choices).ok();
            let fork = own.and_then(|own| {
                let mut fork = beginning.fork().ok()?;
                fork.happen(&own).ok()?;
                Some(fork)
            });
            records.push(match fork {
                Some(fork) => self.judged(number, &choices, &fork.run()),
                None => self.alone(number, &choices, programs),
            });
        }
        records
    }

    /// Runs a case from its beginning.
    pub(super) fn alone(&self, number: u64, choices: &[Choice], programs: &Programs) -> Record {
        let prepared = self.scenario_of(choices).and_then(|scenario| scenario.prepare(self.profile, programs));
        match prepared {
            Ok(prepared) => self.judged(number, choices, &prepared.measure_margins().run()),
            Err(problem) => self.unusable(number, choices, &problem),
        }
    }

    /// Runs the ends of an interval; if one is good and the other bad, halves it until it is short enough.
    fn bisect(&self, first: u64, resolution: f64, programs: &Programs) -> Vec<Record> {
        let Some((index, key, low, high)) = self.bisected() else { return Vec::new() };
        let mut records: Vec<Record> = Vec::new();
        let run = |value: f64, records: &mut Vec<Record>| {
            let mut choices = self.choices(first);
            choices[index] = self.dimensions[index].put(key, value);
            let record = self.alone(first + records.len() as u64, &choices, programs);
            let is_good = record.verdict == Verdict::Held;
            records.push(record);
            is_good
        };
        let (mut low, mut high) = (low, high);
        let low_is_good = run(low, &mut records);
        if run(high, &mut records) == low_is_good {
            return records;
        }
        while high - low > resolution && (records.len() as u64) < BISECTIONS {
            let middle = rounded(low + (high - low) / 2.0, 12);
            if middle <= low || middle >= high {
                break;
            }
            if run(middle, &mut records) == low_is_good { low = middle } else { high = middle }
        }
        records
    }

    fn record(&self, number: u64, choices: &[Choice]) -> Record {
        let values = self.dimensions.iter().zip(choices).map(|(one, choice)| (one.name.clone(), choice.text.clone()));
        Record {
            case: number,
            values: values.collect(),
            verdict: Verdict::Held,
            failure: String::new(),
            text: String::new(),
            chain: Vec::new(),
            at: 0.0,
            margins: Vec::new(),
            reached: Vec::new(),
        }
    }

    fn unusable(&self, number: u64, choices: &[Choice], problem: &Problem) -> Record {
        let (failure, text) = (problem.what.clone(), problem.to_string());
        Record { verdict: Verdict::Unusable, failure, text, ..self.record(number, choices) }
    }

    /// The record of a case after its run.
    fn judged(&self, number: u64, choices: &[Choice], finished: &Finished) -> Record {
        let mut record = self.record(number, choices);
        let session = finished.session();
        record.at = session.time().seconds();
        for rule in finished.rules().into_iter().filter(|rule| !rule.name.starts_with(SOMETIMES)) {
            if let Some(margin) = rule.margin {
                record.margins.push((rule.name, margin, rule.in_cycles));
            }
        }
        record.reached = reached(finished);
        let (failure, text) = match &finished.failure {
            Some(Failure::Unusable(problem)) => return Record { ..self.unusable(number, choices, problem) },
            Some(Failure::Missed(missed)) => {
                record.at = missed.time.seconds();
                record.chain = chain(missed, finished);
                (signature(&missed.what), missed.to_string())
            }
            None => match self.broken(finished) {
                Some(broken) => broken,
                None => return record,
            },
        };
        Record { verdict: Verdict::Failed, failure, text, ..record }
    }

    /// What a run broke that its scenario does not know: alarms, the golden trace.
    fn broken(&self, finished: &Finished) -> Option<(String, String)> {
        let machine = finished.session().machine();
        let raised = finished.session().trace().alarms_raised();
        if let Some(may) = &self.oracles.may {
            let allowed = |number: u32| may.contains(&number) || self.oracles.must.contains(&number);
            if let Some(other) = raised.iter().find(|number| !allowed(number.0)) {
                let name = machine.alarm_name(*other);
                let text = format!("alarm {name} came, which `alarms.may` does not list");
                return Some((text.clone(), text));
            }
        }
        if let Some(must) = self.oracles.must.iter().find(|must| raised.iter().all(|number| number.0 != **must)) {
            let text = format!("alarm {must} did not come, which `alarms.must` lists");
            return Some((text.clone(), text));
        }
        let expected = self.golden.as_ref()?;
        let found = difference(expected, &finished.session().sequence())?;
        Some((
            "the trace differs from that of the base scenario".to_owned(),
            format!("the trace differs from that of the base scenario: {found}"),
        ))
    }

    /// The scenario of a case that fails by itself in the same way: with a condition for what only the campaign knows.
    pub(super) fn with_condition(&self, table: &mut Table, failure: &str) {
        let place = Place::file(&self.path.display().to_string());
        let node = |text: String| Node { place: place.clone(), value: Value::Text(text) };
        let number = |text: &str| text.split_whitespace().nth(1).map(str::to_owned);
        if failure.contains("`alarms.may`")
            && let Some(alarm) = number(failure)
        {
            append(table, "never", node(format!("alarm({alarm})")));
        } else if failure.contains("`alarms.must`")
            && let Some(alarm) = number(failure)
        {
            let mut step = Table::empty(place.clone());
            let _ = step.put(&["expect"], &place, node(format!("count(alarm({alarm})) > 0")));
            append(table, "step", Node { place: place.clone(), value: Value::Table(step) });
        }
    }
}

/// The earliest time of the `[[at]]` entries of a case. `None` if it has no entry, or one with a time in cycles: their length is known only
/// in the run.
fn first_time(choices: &[Choice]) -> Option<Time> {
    let mut first: Option<Time> = None;
    for edit in choices.iter().flat_map(|choice| &choice.edits) {
        let Edit::At(entry) = edit else { continue };
        let (_, node) = entry.entries().find(|(key, _)| *key == "time")?;
        let Ok(Duration::Time(time)) = Duration::parse(node.text("a time").ok()?) else { return None };
        first = Some(first.map_or(time, |first| first.min(time)));
    }
    first
}

/// What failed, without times, so that cases that fail in the same way have the same text.
pub(super) fn signature(what: &str) -> String {
    let words: Vec<&str> = what.split(' ').collect();
    let is_time = |index: usize| {
        let unit = words.get(index + 1).is_some_and(|next| next.trim_end_matches([':', ';', ',']) == "s");
        unit && words[index].parse::<f64>().is_ok()
    };
    let word = |index: usize| if is_time(index) { "…" } else { words[index] };
    (0..words.len()).map(word).collect::<Vec<_>>().join(" ")
}

/// The largest number of rules in a chain.
const CHAIN: usize = 12;

/// The rules behind a failure: those of the chain of causes of the first signal or alarm of its expression that has one.
pub(super) fn chain(missed: &Missed, finished: &Finished) -> Vec<String> {
    let session = finished.session();
    let story = session.trace().story(session.machine());
    for operand in &missed.operands {
        let name = operand.trim_start().split(" = ").next().unwrap_or_default();
        let Ok(text) = story.why(name, missed.time + session.machine().cycle_time()) else { continue };
        let mut rules: Vec<String> = Vec::new();
        for line in text.lines() {
            let ids = line.split([' ', ',']).filter_map(|word| word.strip_suffix(':')).filter(|word| is_id(word));
            for id in ids {
                if rules.last().is_none_or(|last| last != id) && rules.len() < CHAIN {
                    rules.push(id.to_owned());
                }
            }
        }
        if !rules.is_empty() {
            return rules;
        }
    }
    Vec::new()
}

/// `REF-02`, `O-27`.
fn is_id(word: &str) -> bool {
    word.split_once('-').is_some_and(|(family, number)| {
        let is_family = !family.is_empty() && family.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit());
        is_family && !number.is_empty() && number.chars().all(|c| c.is_ascii_digit())
    })
}

/// What a run reached, sorted.
fn reached(finished: &Finished) -> Vec<String> {
    let (session, machine) = (finished.session(), finished.session().machine());
    let texts = machine.control().texts();
    let mut reached = BTreeSet::new();
    for rule in finished.rules() {
        let is_sometimes = rule.name.starts_with(SOMETIMES);
        if rule.has_begun && rule.in_cycles {
            reached.insert(if is_sometimes { rule.name } else { format!("rule of the campaign {}", rule.name) });
        }
    }
    for (chart, rows) in texts.charts().iter().zip(machine.control().taken().0) {
        for (_, edge) in chart.edges.iter().enumerate().filter(|(index, _)| rows.has(*index)) {
            reached.insert(format!("transition {}: {} -> {}", chart.name, edge.from, edge.to));
        }
    }
    for rule in session.trace().rules_used() {
        reached.insert(format!("rule {}", texts.rule(rule).id));
    }
    for alarm in session.trace().alarms_raised() {
        reached.insert(format!("alarm {}", machine.alarm_name(alarm)));
    }
    for ((part, offset), bits) in session.trace().bits_changed() {
        if !matches!(part, Part::ToNck | Part::FromNck | Part::Hmi) {
            continue;
        }
        for bit in (0..8_u8).filter(|bit| bits >> bit & 1 == 1) {
            let location = Location { part, offset, bit, width: 1, format: Format::Unsigned };
            let name = machine.names().symbol(location);
            let name = name.unwrap_or_else(|| machine.names().address(location).to_string());
            reached.insert(format!("signal {name}"));
        }
    }
    reached.into_iter().collect()
}
