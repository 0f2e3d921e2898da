//! The results of cases as lines of JSON: a head, then for each case one line, in the order of the cases. What a case reached is a line of its
//! own, before the first case that reached exactly this, so that a million cases that reach the same do not repeat it.

use std::collections::BTreeMap;

use serde_json::{Map, Value as Json, json};

use crate::source::{Place, Problem};

/// The format of the file; a change of it is another version.
const FORMAT: u64 = 1;

/// The first line of a file of results.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Header {
    /// The version of the program.
    pub version: String,
    /// The hash of the spec.
    pub spec: String,
    /// The number of cases of the campaign, with a limit.
    pub cases: u64,
    /// The part of the cases that this file has, and the number of parts.
    pub shard: (u64, u64),
}

/// How a case ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// Everything held.
    Held,
    /// An expectation, a rule or another condition did not hold.
    Failed,
    /// The values cannot be used together.
    Unusable,
}

/// The result of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// The number of the case, from 0.
    pub case: u64,
    /// What varies, and its value.
    pub values: Vec<(String, String)>,
    /// How it ended.
    pub verdict: Verdict,
    /// What failed, the same text for cases that fail in the same way; empty if it held.
    pub failure: String,
    /// The first failure as a report shows it.
    pub text: String,
    /// The rules in the chain of causes behind the failure, the last one first.
    pub chain: Vec<String>,
    /// The simulated time of the failure in seconds; of the end, if it held.
    pub at: f64,
    /// The smallest margin of each rule that has one, and whether it is a number of cycles.
    pub margins: Vec<(String, f64, bool)>,
    /// What it reached: conditions, transitions, rules, alarms, signals. Sorted.
    pub reached: Vec<String>,
}

impl Header {
    /// The line.
    #[must_use]
    pub fn line(&self) -> String {
        let Self { version, spec, cases, shard } = self;
        let mut line = json!({ "campaign": FORMAT, "opennck": version, "spec": spec, "cases": cases });
        if shard.1 > 1 {
            line["shard"] = json!([shard.0, shard.1]);
        }
        format!("{line}\n")
    }

    /// Reads the line.
    ///
    /// # Errors
    /// It is no such line, or one of another version of the format.
    pub fn read(line: &str, file: &str) -> Result<Self, Problem> {
        let place = Place::file(file).at_line(1);
        let broken = || {
            place.problem(
                "expected the results of a campaign, found another file",
                "name a results.jsonl of `opennck campaign`",
            )
        };
        let json: Json = serde_json::from_str(line).map_err(|_| broken())?;
        let format = json.get("campaign").and_then(Json::as_u64).ok_or_else(broken)?;
        if format != FORMAT {
            let what = format!("expected results of format {FORMAT}, found those of format {format}");
            return Err(place.problem(what, "run the campaign again with this version of the program"));
        }
        let text = |key: &str| json.get(key).and_then(Json::as_str).map(str::to_owned).ok_or_else(broken);
        let shard =
            json.get("shard").map_or(Some((1, 1)), |pair| Some((pair.get(0)?.as_u64()?, pair.get(1)?.as_u64()?)));
        Ok(Self {
            version: text("opennck")?,
            spec: text("spec")?,
            cases: json.get("cases").and_then(Json::as_u64).ok_or_else(broken)?,
            shard: shard.filter(|(part, of)| (1..=*of).contains(part)).ok_or_else(broken)?,
        })
    }
}

/// Writes the lines of records in the order of the cases.
#[derive(Debug, Default)]
pub struct Lines {
    known: BTreeMap<Vec<String>, usize>,
}

impl Lines {
    /// The lines of the next case.
    pub fn of(&mut self, record: &Record) -> String {
        let mut text = String::new();
        let next = self.known.len();
        let set = *self.known.entry(record.reached.clone()).or_insert(next);
        if set == next {
            text += &format!("{}\n", json!({ "reached": set, "items": record.reached }));
        }
        let Record { case, values, verdict, failure, text: shown, chain, at, margins, reached: _ } = record;
        let values: Map<String, Json> = values.iter().map(|(key, value)| (key.clone(), json!(value))).collect();
        let mut line = json!({ "case": case, "values": values, "verdict": verdict.name(), "at": at, "reached": set });
        if *verdict != Verdict::Held {
            line["failure"] = json!(failure);
            line["text"] = json!(shown);
            line["chain"] = json!(chain);
        }
        if !margins.is_empty() {
            line["margins"] = json!(margins);
        }
        text + &format!("{line}\n")
    }
}

/// Reads the lines of a file after its head.
#[derive(Debug, Default)]
pub struct Reading {
    sets: BTreeMap<u64, Vec<String>>,
}

impl Reading {
    /// The record of a line; `None` for a line that says what cases reached, or if the line is no such line.
    ///
    /// # Errors
    /// The line is not one of a file of results.
    pub fn line(&mut self, line: &str, place: &Place) -> Result<Option<Record>, Problem> {
        let mut read = |line: &str| -> Option<Option<Record>> {
            let json: Json = serde_json::from_str(line).ok()?;
            let texts = |key: &str| -> Option<Vec<String>> {
                json.get(key)?.as_array()?.iter().map(|one| one.as_str().map(str::to_owned)).collect()
            };
            if json.get("items").is_some() {
                self.sets.insert(json.get("reached")?.as_u64()?, texts("items")?);
                return Some(None);
            }
            let text = |key: &str| json.get(key).and_then(Json::as_str).unwrap_or_default().to_owned();
            let values = json.get("values")?.as_object()?;
            let margins = json.get("margins").and_then(Json::as_array).map(Vec::as_slice).unwrap_or_default();
            let margin =
                |one: &Json| Some((one.get(0)?.as_str()?.to_owned(), one.get(1)?.as_f64()?, one.get(2)?.as_bool()?));
            Some(Some(Record {
                case: json.get("case")?.as_u64()?,
                values: values
                    .iter()
                    .map(|(key, value)| (key.clone(), value.as_str().unwrap_or_default().to_owned()))
                    .collect(),
                verdict: Verdict::named(json.get("verdict")?.as_str()?)?,
                failure: text("failure"),
                text: text("text"),
                chain: texts("chain").unwrap_or_default(),
                at: json.get("at")?.as_f64()?,
                margins: margins.iter().map(margin).collect::<Option<_>>()?,
                reached: self.sets.get(&json.get("reached")?.as_u64()?)?.clone(),
            }))
        };
        read(line).ok_or_else(|| {
            place.problem(
                "expected the result of a case, found another line",
                "the file is damaged: run its part of the campaign again",
            )
        })
    }
}

impl Verdict {
    /// Its name in files and reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Held => "held",
            Self::Failed => "failed",
            Self::Unusable => "unusable",
        }
    }

    fn named(name: &str) -> Option<Self> {
        [Self::Held, Self::Failed, Self::Unusable].into_iter().find(|verdict| verdict.name() == name)
    }
}
