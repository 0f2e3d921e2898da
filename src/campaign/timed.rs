//! What happens at a time: faults, changes, and inputs that come some cycles late.

use super::dimension::{Choice, Dimension, Edit, Values};
use super::written;
use crate::image::Profile;
use crate::plc::Programs;
use crate::scenario::{Duration, Failure, Finished, Scenario};
use crate::source::{Node, Place, Problem, Table, Value};
use crate::units::Time;

/// The base scenario, which runs once if cases need its events.
pub(super) struct Base<'a> {
    scenario: &'a Scenario,
    profile: Profile,
    programs: &'a Programs,
    ran: Option<Finished>,
}

impl<'a> Base<'a> {
    pub(super) fn new(scenario: &'a Scenario, profile: Profile, programs: &'a Programs) -> Self {
        Self { scenario, profile, programs, ran: None }
    }

    fn run(&mut self) -> Result<&Finished, Problem> {
        if self.ran.is_none() {
            let finished = self.scenario.prepare(self.profile, self.programs)?.run();
            match &finished.failure {
                None => {}
                Some(Failure::Unusable(problem)) => return Err(problem.clone()),
                Some(Failure::Missed(missed)) => {
                    let what = format!("expected a base scenario that succeeds, found: {}", missed.what);
                    let place = Place::file(&self.scenario.path.display().to_string());
                    return Err(place.problem(what, "mend the base scenario first: `opennck run` shows its trace"));
                }
            }
            self.ran = Some(finished);
        }
        self.ran.as_ref().ok_or_else(|| Problem::new("the base scenario did not run", "report this as a bug"))
    }

    /// The trace of the base run, without its head.
    pub(super) fn golden(&mut self) -> Result<String, Problem> {
        Ok(self.run()?.session().sequence())
    }

    /// The times of all rows in the trace of the base run, each once.
    fn events(&mut self) -> Result<Vec<String>, Problem> {
        let rows = self.run()?.session().sequence();
        let mut times: Vec<String> = Vec::new();
        for time in rows.lines().filter_map(|row| row.split_whitespace().next()) {
            if time.parse::<f64>().is_ok() && times.last().is_none_or(|last| last != time) {
                times.push(time.to_owned());
            }
        }
        Ok(times.into_iter().map(|time| format!("{time}s")).collect())
    }

    /// The time at which each step of the base run began.
    fn step_times(&self) -> Result<Vec<Time>, Problem> {
        let mut prepared = self.scenario.prepare(self.profile, self.programs)?;
        let cycle = prepared.machine().cycle_time();
        let mut times = vec![Time::ZERO];
        let mut end = Time::ZERO;
        loop {
            end += cycle;
            prepared.advance(end);
            let (time, is_over) = prepared.progress();
            // The steps that were done before this cycle began when it began.
            times.resize(times.len().max(prepared.reached() + 1), time - cycle);
            if is_over {
                return Ok(times);
            }
        }
    }
}

fn tables(node: Option<Node>, what: &str) -> Result<Vec<Table>, Problem> {
    let Some(node) = node else { return Ok(Vec::new()) };
    if !matches!(node.value, Value::Array(_)) {
        return Err(node.expected(&format!("a list, [[{what}]]"), &format!("write [[{what}]] with two brackets")));
    }
    node.into_list().into_iter().map(|one| one.into_table("a table")).collect()
}

/// The times in the key `time`: one, a list, a range, or those of the events of the base run.
fn times(table: &mut Table, base: &mut Base<'_>) -> Result<Vec<String>, Problem> {
    const CURE: &str =
        "write time = \"3.2s\", a list, { from = \"1s\", to = \"5s\", step = \"100ms\" } or \"every event\"";
    let place = table.place.clone();
    let node = table.take("time").ok_or_else(|| place.problem("expected the key `time`, found none", CURE))?;
    let one = |node: &Node| {
        let text = node.text("a time")?;
        Duration::parse(text).map(|_| text.to_owned()).map_err(|problem| problem.at(&node.place))
    };
    match node.value {
        Value::Text(ref text) if text == "every event" => base.events(),
        Value::Text(_) => Ok(vec![one(&node)?]),
        Value::Array(ref list) => list.iter().map(one).collect(),
        Value::Table(mut table) => {
            let mut time = |key: &'static str| {
                let node =
                    table.take(key).ok_or_else(|| node.place.problem(format!("expected `{key}`, found none"), CURE))?;
                match Duration::parse(node.text("a time")?).map_err(|problem| problem.at(&node.place))? {
                    Duration::Time(time) => Ok(time),
                    Duration::Cycles(_) => Err(node.expected("a time with a unit", CURE)),
                }
            };
            let (from, to, step) = (time("from")?, time("to")?, time("step")?);
            table.finish()?;
            if step <= Time::ZERO || from > to {
                return Err(node.place.problem("expected `from` before `to`, and a `step` above 0", CURE));
            }
            let count = (to - from).nanos() / step.nanos();
            if count > 10_000_000 {
                return Err(node.place.problem("expected at most ten million times, found more", "use a longer step"));
            }
            Ok((0..=count).map(|index| format!("{}s", from + Time::from_nanos(step.nanos() * index))).collect())
        }
        _ => Err(node.expected("a time", CURE)),
    }
}

fn texts(node: Node, what: &str) -> Result<Vec<Node>, Problem> {
    node.into_list().into_iter().map(|one| one.text(what).map(|_| ()).map(|()| one)).collect()
}

/// `[[fault]]`: each kind on each axis at each time is a value.
pub(super) fn faults(node: Option<Node>, base: &mut Base<'_>, into: &mut Vec<Dimension>) -> Result<(), Problem> {
    const EXAMPLE: &str = "write kind = \"drive_fault\", axis = [\"X\", \"XF\"], time = \"every event\"";
    let all = tables(node, "fault")?;
    let count = all.len();
    for (index, mut table) in all.into_iter().enumerate() {
        let place = table.place.clone();
        let missing = |key: &str| place.problem(format!("expected the key `{key}` in [[fault]], found none"), EXAMPLE);
        let name = match table.take("name") {
            Some(node) => node.text("a name")?.to_owned(),
            None if count == 1 => "fault".to_owned(),
            None => format!("fault {}", index + 1),
        };
        let kinds = texts(table.take("kind").ok_or_else(|| missing("kind"))?, "a kind of fault")?;
        let axes = texts(table.take("axis").ok_or_else(|| missing("axis"))?, "an axis")?;
        let times = times(&mut table, base)?;
        let lasts = match table.take("for") {
            Some(node) => match Duration::parse(node.text("how long the fault lasts")?)
                .map_err(|problem| problem.at(&node.place))?
            {
                Duration::Time(time) => Some(time),
                Duration::Cycles(_) => return Err(node.expected("a time with a unit", "write for = \"500ms\"")),
            },
            None => None,
        };
        let rest = table.take_rest();
        let mut list = Vec::new();
        for kind in &kinds {
            for axis in &axes {
                let mut fault = Table::empty(place.clone());
                // A path of one key in an empty table is always free.
                let _ = fault.put(&["axis"], &place, axis.clone());
                let _ = fault.put(&["kind"], &place, kind.clone());
                for (key, place, node) in &rest {
                    let _ = fault.put(&[key], place, node.clone());
                }
                for time in &times {
                    let mut edits = vec![at(&place, time, "fault", &fault)];
                    if let Some(lasts) = lasts {
                        edits.push(at(&place, &later(time, lasts, &place)?, "clear_fault", &fault));
                    }
                    let text = format!("{} {} at {time}", written::plain(kind), written::plain(axis));
                    list.push(Choice { text, edits });
                }
            }
        }
        into.push(Dimension { name, place, values: Values::List(list), is_timed: true });
    }
    Ok(())
}

fn later(time: &str, by: Time, place: &Place) -> Result<String, Problem> {
    match Duration::parse(time)? {
        Duration::Time(time) => Ok(format!("{}s", time + by)),
        Duration::Cycles(_) => {
            Err(place.problem("expected times with a unit beside `for`, found cycles", "write time = \"3.2s\""))
        }
    }
}

/// An entry of `[[at]]`.
fn at(place: &Place, time: &str, verb: &'static str, table: &Table) -> Edit {
    let node = |value| Node { place: place.clone(), value };
    let mut entry = Table::empty(place.clone());
    let _ = entry.put(&["time"], place, node(Value::Text(time.to_owned())));
    let _ = entry.put(&[verb], place, node(Value::Table(table.clone())));
    Edit::At(entry)
}

/// `[[change]]`: each table of its verb at each time is a value.
pub(super) fn changes(node: Option<Node>, base: &mut Base<'_>, into: &mut Vec<Dimension>) -> Result<(), Problem> {
    const VERBS: [&str; 4] = ["machine_data", "set", "force", "write"];
    let all = tables(node, "change")?;
    let count = all.len();
    for (index, mut table) in all.into_iter().enumerate() {
        let place = table.place.clone();
        let name = match table.take("name") {
            Some(node) => node.text("a name")?.to_owned(),
            None if count == 1 => "change".to_owned(),
            None => format!("change {}", index + 1),
        };
        let times = times(&mut table, base)?;
        let new_conf = table.take("new_conf").map_or(Ok(false), |node| node.boolean("true or false"))?;
        let mut list = Vec::new();
        for verb in VERBS {
            let Some(node) = table.take(verb) else { continue };
            for values in node.into_list() {
                let words = written::value(&values);
                let values = values.into_table("names with their values")?;
                for time in &times {
                    let mut edits = vec![at(&place, time, verb, &values)];
                    if new_conf {
                        let mut entry = Table::empty(place.clone());
                        let node = |value| Node { place: place.clone(), value };
                        let _ = entry.put(&["time"], &place, node(Value::Text(time.clone())));
                        let _ = entry.put(&["new_conf"], &place, node(Value::Boolean(true)));
                        edits.push(Edit::At(entry));
                    }
                    list.push(Choice { text: format!("{verb} {words} at {time}"), edits });
                }
            }
        }
        table.finish()?;
        if list.is_empty() {
            let cure = "write time = \"9s\" and machine_data = [{ \"37110[X]\" = 0.5 }, { \"37110[X]\" = 0.6 }]";
            return Err(place.problem(format!("expected one of {} in [[change]], found none", VERBS.join(", ")), cure));
        }
        into.push(Dimension { name, place, values: Values::List(list), is_timed: true });
    }
    Ok(())
}

/// The verbs of steps that are inputs.
const INPUTS: [&str; 7] = ["set", "write", "force", "release", "pulse", "handwheel", "fault"];

/// `[[jitter]]`: each input of the base scenario within a window comes 0 to n cycles late.
pub(super) fn jitters(
    node: Option<Node>,
    scenario: &Table,
    base: &mut Base<'_>,
    into: &mut Vec<Dimension>,
) -> Result<(), Problem> {
    for mut table in tables(node, "jitter")? {
        let place = table.place.clone();
        let cycles = table
            .take("cycles")
            .ok_or_else(|| place.problem("expected the key `cycles` in [[jitter]], found none", "write cycles = 3"))?;
        let number = u64::try_from(cycles.integer("a number of cycles")?);
        let Ok(cycles @ 1..=10_000) = number else {
            return Err(cycles.expected("a number of cycles, 1 to 10000", "write cycles = 3"));
        };
        let mut time = |key: &'static str, usual: Time| {
            let Some(node) = table.take(key) else { return Ok(usual) };
            match Duration::parse(node.text("a time")?).map_err(|problem| problem.at(&node.place))? {
                Duration::Time(time) => Ok(time),
                Duration::Cycles(_) => Err(node.expected("a time with a unit", "write from = \"1s\"")),
            }
        };
        let (from, to) = (time("from", Time::ZERO)?, time("to", Time::from_nanos(i64::MAX))?);
        table.finish()?;
        let steps = scenario.entries().find(|(key, _)| *key == "step").map(|(_, node)| node.clone().into_list());
        let steps = steps.unwrap_or_default();
        let has = |node: &Node, keys: &[&str]| matches!(&node.value, Value::Table(step) if step.keys().any(|key| keys.contains(&key)));
        if let Some(included) = steps.iter().find(|step| has(step, &["include"])) {
            let what = "expected a base scenario without `include` for [[jitter]], found one";
            return Err(included.place.problem(what, "write the steps of the file in its place"));
        }
        let began = base.step_times()?;
        let before = into.len();
        for (index, step) in steps.iter().enumerate().filter(|(_, step)| has(step, &INPUTS)) {
            if began.get(index).is_some_and(|time| (from..=to).contains(time)) {
                let choice = |late: u64| {
                    let noun = if late == 1 { "cycle" } else { "cycles" };
                    let text = if late == 0 { "in time".to_owned() } else { format!("{late} {noun} late") };
                    Choice { text, edits: vec![Edit::Delay(index, late)] }
                };
                let name = format!("input in line {}", step.place.line);
                let values = Values::List((0..=cycles).map(choice).collect());
                into.push(Dimension { name, place: place.clone(), values, is_timed: false });
            }
        }
        if into.len() == before {
            let what = "expected inputs in the window of [[jitter]], found none";
            return Err(
                place.problem(what, "the steps set, write, force, release, pulse, handwheel and fault are inputs")
            );
        }
    }
    Ok(())
}
