//! The scenario file: the head is read and checked, the steps are kept as written.
//!
//! This module does not know the machine. Names and values in the steps are looked up when the scenario is prepared for a machine, before
//! anything runs.

use std::path::{Path, PathBuf};

use super::duration::Duration;
use super::fields::{Named, duration, in_the_case, named, texts};
use super::matrix::{FIXED, HEAD, Variant, heads};
use super::rules;
use super::timed;
use super::written::WrittenSteps;
use crate::control::{StoredDatum, Value as DatumValue};
use crate::controls;
use crate::controls::documented::check_id;
use crate::image::Profile;
use crate::plc::PlcProcess;
use crate::source::{Node, Place, Problem, Table, Value, did_you_mean, read_text};
use crate::units::Time;

/// A scenario as read from its file.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// The file.
    pub path: PathBuf,
    /// What the scenario shows, in one sentence.
    pub title: String,
    /// The machine, as named in the file.
    pub machine: Named,
    /// IDs of the requirements that the scenario shows.
    pub covers: Vec<String>,
    /// The interface profiles under which the scenario runs.
    pub profiles: Vec<Profile>,
    /// The PLC program, by name.
    pub plc: Option<Named>,
    /// The PLC program in another process, and its place in the file; it excludes `plc`.
    pub plc_process: Option<(PlcProcess, Place)>,
    /// The PLC memory image, by name or file.
    pub plc_image: Option<Named>,
    /// The NC program that is selected at the beginning: its file, or its text.
    pub program: Option<(Named, bool)>,
    /// Folders in which subprograms are found.
    pub program_path: Vec<Named>,
    /// The limit of simulated time.
    pub limit: Duration,
    /// What the trace shows; `None` selects the default.
    pub watch: Option<Vec<Watched>>,
    /// Whether golden rows show causes.
    pub causes: bool,
    /// Expressions that must be false in every cycle.
    pub never: Vec<Named>,
    /// Expressions that must be true in every cycle.
    pub always: Vec<Named>,
    /// How the trace is compared with the golden trace.
    pub compare: Compare,
    pub(super) rules: Vec<rules::Written>,
    /// What happens at a time, whatever the steps do.
    pub(super) at: Vec<Table>,
    /// Data that are merged into `plant.toml`.
    pub plant: Option<Table>,
    /// Machine data that are stored before the first power on.
    pub machine_data: Vec<StoredDatum>,
    /// The combination of the matrix, if the file has one.
    pub variant: Option<Variant>,
    pub(super) steps: WrittenSteps,
}

/// An entry of `watch`.
#[derive(Clone, Debug, PartialEq)]
pub struct Watched {
    /// The signal, value or pattern.
    pub name: Named,
    /// How far a value must have moved since its last row, in its own unit.
    pub step: Option<f64>,
}

/// How a trace is compared with the golden trace.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compare {
    /// Every character.
    #[default]
    Exact,
    /// The order of the rows; times are ignored.
    Sequence,
    /// The order of the rows, and their times within this tolerance.
    Within(Time),
}

/// The limit of simulated time if a scenario does not set one.
const DEFAULT_LIMIT: Time = Time::from_millis(300_000);

impl Scenario {
    /// Reads a scenario file that has one case.
    ///
    /// # Errors
    /// The file cannot be read or is not a scenario, or it has a matrix; the problem names file and line.
    pub fn read(path: &Path) -> Result<Self, Problem> {
        only_one(Self::read_cases(path)?, path)
    }

    /// Reads one case of a scenario file: the only one, or the only one of its matrix whose values contain `wanted`, as `plc = a`.
    ///
    /// # Errors
    /// As [`Scenario::read`], or the text selects none or several cases; the problem names them.
    pub fn read_case(path: &Path, wanted: Option<&str>) -> Result<Self, Problem> {
        let cases = Self::read_cases(path)?;
        let Some(wanted) = wanted else {
            return only_one(cases, path);
        };
        let place = Place::file(&path.display().to_string());
        let (mut chosen, others): (Vec<_>, Vec<_>) = cases.into_iter().partition(|case| case.fits(wanted));
        let exact = chosen.iter().position(|case| case.variant.as_ref().is_some_and(|variant| variant.is(wanted)));
        if let Some(index) = exact {
            return Ok(chosen.swap_remove(index));
        }
        match (chosen.pop(), chosen.len()) {
            (Some(case), 0) => Ok(case),
            (Some(case), further) => {
                chosen.push(case);
                let what =
                    format!("expected a text that selects one case, found `{wanted}`, which selects {}", further + 1);
                Err(place.problem(what, in_words(&chosen)))
            }
            (None, _) => Err(place.problem(format!("expected a case with `{wanted}`, found none"), in_words(&others))),
        }
    }

    /// Whether the values of its case contain this text.
    fn fits(&self, wanted: &str) -> bool {
        self.variant.as_ref().is_some_and(|variant| variant.fits(wanted))
    }

    /// Reads a scenario file: one scenario for each combination of its matrix, or one without a matrix.
    ///
    /// # Errors
    /// The file cannot be read or is not a scenario; the problem names file and line.
    pub fn read_cases(path: &Path) -> Result<Vec<Self>, Problem> {
        if path.is_dir() {
            let place = Place::file(&path.display().to_string());
            let cure = "name one of its scenarios; `opennck test` runs all scenarios below a folder";
            return Err(place.problem("expected a scenario, found a folder", cure));
        }
        Self::parse_cases(&read_text(path)?, path)
    }

    /// Reads a scenario with one case from its text. `path` names it in messages and is the base of its relative paths.
    ///
    /// # Errors
    /// As [`Scenario::read`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, Problem> {
        only_one(Self::parse_cases(text, path)?, path)
    }

    /// Reads all cases of a scenario from its text.
    ///
    /// # Errors
    /// The text is not a scenario; the problem names file and line.
    pub fn parse_cases(text: &str, path: &Path) -> Result<Vec<Self>, Problem> {
        let file = path.display().to_string();
        let (table, steps) = WrittenSteps::read(text, &file)?;
        let whole = Place::file(&file);
        let mut cases = Vec::new();
        let heads = heads(table, path)?;
        for (variant, head) in heads {
            let case = variant.as_ref().map(ToString::to_string);
            let scenario = Self::from_head(head, path, &whole, variant, steps.clone());
            cases.push(scenario.map_err(|problem| in_the_case(problem, case.as_deref()))?);
        }
        Ok(cases)
    }

    /// A scenario with one case from its tables, for callers that change them. `path` is as for [`Scenario::parse`].
    ///
    /// # Errors
    /// As [`Scenario::read`].
    pub fn of_table(mut table: Table, path: &Path) -> Result<Self, Problem> {
        let steps = WrittenSteps::of(table.take("step"), &path.display().to_string())?;
        let whole = Place::file(&path.display().to_string());
        let mut heads = heads(table, path)?;
        match (heads.pop(), heads.len()) {
            (Some((variant, head)), 0) => Self::from_head(head, path, &whole, variant, steps),
            (_, others) => {
                let what = format!("expected a scenario with one case, found a matrix of {}", others + 1);
                Err(whole.problem(what, "write the values of one case into its head"))
            }
        }
    }

    fn from_head(
        mut table: Table,
        path: &Path,
        whole: &Place,
        variant: Option<Variant>,
        steps: WrittenSteps,
    ) -> Result<Self, Problem> {
        let required = |node: Option<Node>, key: &str, example: &str| {
            node.ok_or_else(|| {
                whole.problem(format!("expected the key `{key}`, found none"), format!("write {key} = {example}"))
            })
        };
        let title = match table.take("title") {
            Some(title) => title.text("a title")?.to_owned(),
            // A scenario without a title has the name of its file.
            None => path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned()),
        };
        let machine = required(table.take("machine"), "machine", "\"g1_example\"")?;
        let machine = named(&machine, "the name or directory of a machine")?;
        let (plc, plc_process) = match table.take("plc") {
            Some(node) if matches!(node.value, Value::Table(_)) => (None, Some(process(node, path)?)),
            node => (node.map(|node| named(&node, "the name of a PLC program")).transpose()?, None),
        };
        let scenario = Self {
            path: path.to_owned(),
            title,
            machine,
            covers: covers(table.take("covers"))?,
            profiles: profiles(table.take("profile"))?,
            plc,
            plc_process,
            plc_image: table
                .take("plc_image")
                .map(|node| named(&node, "the name or file of a PLC image"))
                .transpose()?,
            program: program(&mut table)?,
            program_path: texts(table.take("program_path"), "folders with NC programs")?,
            limit: table
                .take("limit")
                .map_or(Ok(Duration::Time(DEFAULT_LIMIT)), |node| duration(&node, "the limit of simulated time"))?,
            watch: table.take("watch").map(watched).transpose()?,
            causes: table.take("causes").map_or(Ok(false), |node| node.boolean("true or false"))?,
            never: texts(table.take("never"), "expressions")?,
            always: texts(table.take("always"), "expressions")?,
            rules: rules::written(table.take("rule"))?,
            at: timed::written(table.take("at"))?,
            compare: table.take("compare").map_or(Ok(Compare::Exact), compare)?,
            plant: table.take("plant").map(|node| node.into_table("a table of plant data")).transpose()?,
            machine_data: table.take("machine_data").map_or(Ok(Vec::new()), machine_data)?,
            variant,
            steps,
        };
        table.finish()?;
        Ok(scenario)
    }

    /// The directory that is the base of relative paths in the file.
    #[must_use]
    pub fn directory(&self) -> &Path {
        self.path.parent().unwrap_or_else(|| Path::new(""))
    }
}

/// The steps of a file that another one includes. If it is a scenario, its head has no effect; its keys are checked.
pub(super) fn steps_of(file: &Path) -> Result<WrittenSteps, Problem> {
    let (mut table, steps) = WrittenSteps::read(&read_text(file)?, &file.display().to_string())?;
    for key in FIXED.into_iter().chain(HEAD) {
        table.take(key);
    }
    table.finish()?;
    Ok(steps)
}

/// Signals, values and patterns, each as a text or as `{ value = "X.position", step = 0.1 }`.
fn watched(node: Node) -> Result<Vec<Watched>, Problem> {
    let one = |node: Node| {
        if !matches!(node.value, Value::Table(_)) {
            return Ok(Watched { name: named(&node, "a signal or value to watch")?, step: None });
        }
        let place = node.place.clone();
        let mut table = node.into_table("a value to watch")?;
        let (value, step) = (table.take("value"), table.take("step"));
        table.finish()?;
        let (Some(value), Some(step)) = (value, step) else {
            let what = "expected the keys `value` and `step`, found only one of them";
            return Err(place.problem(what, "write { value = \"X.position\", step = 0.1 }"));
        };
        let size = step.number("a step in the unit of the value")?;
        if size <= 0.0 || size > 1e9 {
            return Err(step.expected("a step above 0", "omit it for a row at every change"));
        }
        Ok(Watched { name: named(&value, "the value of an axis")?, step: Some(size) })
    };
    node.into_list().into_iter().map(one).collect()
}

/// The first cases, for a message.
fn in_words(cases: &[Scenario]) -> String {
    let known: Vec<_> = cases.iter().filter_map(|case| Some(case.variant.as_ref()?.to_string())).take(10).collect();
    if known.is_empty() { "the scenario has no matrix".to_owned() } else { format!("cases are {}", known.join("; ")) }
}

/// The only case of a file, for a caller that takes one.
fn only_one(mut cases: Vec<Scenario>, path: &Path) -> Result<Scenario, Problem> {
    match (cases.pop(), cases.len()) {
        (Some(case), 0) => Ok(case),
        (_, others) => Err(Place::file(&path.display().to_string()).problem(
            format!("expected a scenario with one case, found a matrix of {}", others + 1),
            "choose a case by its values, with `--case TEXT`; `opennck run` and `opennck test` run all",
        )),
    }
}

/// `plc = { process = "python3 plc.py {image}", timeout = "10s" }`. The process runs in the folder of the scenario.
fn process(node: Node, path: &Path) -> Result<(PlcProcess, Place), Problem> {
    let place = node.place.clone();
    let mut table = node.into_table("a PLC program in another process")?;
    let (command, limit) = (table.take("process"), table.take("timeout"));
    table.finish()?;
    let cure = "write { process = \"python3 plc.py {image}\" }";
    let command = command.ok_or_else(|| place.problem("expected the key `process`, found none", cure))?;
    let time_out = match limit {
        Some(limit) => match duration(&limit, "a time-out")? {
            Duration::Time(time) => time,
            Duration::Cycles(_) => return Err(limit.expected("a time of the computer", "write timeout = \"10s\"")),
        },
        None => PlcProcess::TIME_OUT,
    };
    let directory = path.parent().unwrap_or_else(|| Path::new("")).to_owned();
    let command = command.text("a command")?.to_owned();
    Ok((PlcProcess { command, directory, time_out, is_shown: false }, place))
}

/// The IDs of rules. IDs of the project exist; those of other families are free, as the numbers of a user's own requirements.
fn covers(node: Option<Node>) -> Result<Vec<String>, Problem> {
    let ids = texts(node, "requirement IDs")?.into_iter();
    ids.map(|id| check_id(&id.text).map(|()| id.text).map_err(|problem| problem.at(&id.place))).collect()
}

fn machine_data(node: Node) -> Result<Vec<StoredDatum>, Problem> {
    let mut data = Vec::new();
    for (target, place, node) in node.into_table("machine data with their values")?.take_rest() {
        node.refuse_unquoted_key(&target)?;
        data.push(StoredDatum { target, place, value: DatumValue::from_node(&node)? });
    }
    Ok(data)
}

/// The profile of this name, in files and on the command line.
///
/// # Errors
/// No profile has this name.
pub fn profile_named(name: &str) -> Result<Profile, Problem> {
    controls::profile(name).ok_or_else(|| {
        // The edit distance misleads for a shortened name, so the profiles are listed.
        let known: Vec<&str> = controls::profiles().collect();
        let all = match known.split_last() {
            Some((last, others)) if !others.is_empty() => format!("profiles are {} and {last}", others.join(", ")),
            _ => format!("the profile is {}", known.concat()),
        };
        let shortened = |known: &&&str| known.starts_with(name);
        let cure = match known.iter().find(shortened) {
            Some(_) => all,
            None => did_you_mean(name, known.iter().copied(), &all),
        };
        Problem::new(format!("expected a profile, found `{name}`"), cure)
    })
}

fn profiles(node: Option<Node>) -> Result<Vec<Profile>, Problem> {
    let Some(node) = node else {
        return Ok(vec![Profile::default()]);
    };
    let place = node.place.clone();
    let mut profiles = Vec::new();
    for name in texts(Some(node), "a profile")? {
        let profile = profile_named(&name.text).map_err(|problem| problem.at(&name.place))?;
        if profiles.contains(&profile) {
            return Err(name.place.problem(format!("the profile `{}` is listed twice", name.text), "remove one"));
        }
        profiles.push(profile);
    }
    if profiles.is_empty() {
        return Err(place.problem("expected at least one profile, found none", "write profile = \"840d_sl\""));
    }
    Ok(profiles)
}

fn compare(node: Node) -> Result<Compare, Problem> {
    let cure = "write \"exact\", \"sequence\" or { time = \"50ms\" }";
    match &node.value {
        Value::Text(text) if text == "exact" => Ok(Compare::Exact),
        Value::Text(text) if text == "sequence" => Ok(Compare::Sequence),
        Value::Table(_) => {
            let place = node.place.clone();
            let mut table = node.into_table("a comparison")?;
            let time = table.take("time");
            table.finish()?;
            let time = time.ok_or_else(|| place.problem("expected the key `time`, found none", cure))?;
            match duration(&time, "a duration")? {
                Duration::Time(time) => Ok(Compare::Within(time)),
                Duration::Cycles(_) => Err(time.expected("a time with a unit", "write { time = \"50ms\" }")),
            }
        }
        _ => Err(node.expected("a way to compare traces", cure)),
    }
}

/// `program`, the file of an NC program, or `nc`, its text.
fn program(table: &mut Table) -> Result<Option<(Named, bool)>, Problem> {
    match (table.take("program"), table.take("nc")) {
        (Some(_), Some(text)) => {
            Err(text.place.problem("expected `program` or `nc`, found both", "keep the one that is to be selected"))
        }
        (Some(file), None) => Ok(Some((named(&file, "the file of an NC program")?, false))),
        (None, Some(text)) => Ok(Some((named(&text, "the text of an NC program")?, true))),
        (None, None) => Ok(None),
    }
}
