//! The steps of a scenario: names are looked up and values are checked for one machine before anything runs.

use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};

use super::duration::Duration;
use super::faults::fault;
use super::fields::{Named, duration, texts};
use super::naming::{Known, check_captured_name, enable_of, missing_owner, place_named, written_by_others};
use super::programs::NcPrograms;
use super::searches::search;
use super::written::WrittenSteps;
use crate::expression::{Expression, Followed};
use crate::image::{Location, raw_value, signal_value};
use crate::machine::{Command, Machine};
use crate::source::{Node, Place, Problem, Table, Value, did_you_mean};
use crate::units::{ChannelNumber, Time};

/// A step that is ready to run. A generated scenario can have 100,000 of them.
#[derive(Debug)]
pub(super) struct Step {
    pub(super) place: Place,
    pub(super) note: Option<Box<str>>,
    pub(super) action: Action,
}

/// All steps of a scenario, with those that it includes.
#[derive(Debug, Default)]
pub(super) struct Steps {
    pub(super) steps: Vec<Step>,
    /// The included steps, the inner ones before the outer ones.
    pub(super) included: Vec<Included>,
}

/// The steps of one `include`.
#[derive(Debug)]
pub(super) struct Included {
    /// The place of the `include`.
    pub(super) place: Place,
    /// Their indices; the last one is the repetition if they run more than once.
    pub(super) range: Range<usize>,
    /// How often they run.
    pub(super) times: u64,
}

/// The action of a step. What is large is boxed, because a step takes the memory of its largest variant. Lists have exactly their length:
/// what a vector keeps in reserve, or returns of it, is lost between steps.
#[derive(Debug)]
pub(super) enum Action {
    /// Queues commands for the next cycle.
    Queue(Box<[Command]>),
    /// Turns a handwheel from the next cycle on.
    Handwheel(Turn),
    /// Sets bits, lets time pass, resets the bits.
    Pulse(Box<[Location]>, Duration),
    /// Lets time pass.
    Run(Duration),
    /// Lets time pass until the expression is true, at most this long.
    Wait(Box<Expression>, Option<Duration>),
    /// Lets time pass; the expression must be true in each cycle.
    Hold(Box<Expression>, Duration),
    /// All expressions must be true now.
    Expect(Box<[(Place, Expression)]>),
    /// Stores values.
    Capture(Box<[(usize, Expression)]>),
    /// The locations must have these bits now.
    Image(Box<[Bits]>),
    /// Nothing: the note of an included file.
    Nothing,
    /// Continues at an earlier step until the steps from there have run this number of times.
    Repeat {
        /// The index of the step.
        from: usize,
        /// The number of times.
        times: u64,
    },
}

impl Action {
    /// The commands of a verb that acts at once; `None` for one that takes time or judges.
    pub(super) fn commands(&self, cycle: Time) -> Option<Vec<Command>> {
        match self {
            Self::Queue(commands) => Some(commands.to_vec()),
            Self::Handwheel(turn) => Some(vec![turn.command(cycle)]),
            Self::Pulse(..)
            | Self::Run(_)
            | Self::Wait(..)
            | Self::Hold(..)
            | Self::Expect(_)
            | Self::Capture(_)
            | Self::Image(_)
            | Self::Nothing
            | Self::Repeat { .. } => None,
        }
    }
}

/// A rotation of a handwheel. Its time becomes cycles when it begins, because power on can change their length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    number: u8,
    pulses: i32,
    over: Duration,
}

impl Turn {
    pub(super) fn command(self, cycle: Time) -> Command {
        let Self { number, pulses, over } = self;
        Command::Handwheel { number, pulses, cycles: over.cycles(cycle) }
    }
}

/// The verbs of a step; `include` is another one.
const VERBS: [&str; 27] = [
    "set",
    "write",
    "force",
    "release",
    "pulse",
    "run",
    "wait",
    "hold",
    "expect",
    "capture",
    "machine_data",
    "list",
    "r_parameters",
    "program",
    "nc",
    "mdi",
    "preset",
    "search",
    "function_generator",
    "new_conf",
    "power_on",
    "plc",
    "cancel",
    "handwheel",
    "fault",
    "clear_fault",
    "image",
];

/// The largest number of steps, with those of included files; files that include each other twice have many in a few lines.
const STEPS: usize = 1_000_000;

/// The length of a pulse if `for` is absent.
const PULSE: Duration = Duration::Time(Time::from_millis(100));

/// Reads the steps for one machine in order, because a captured name is known only after its step.
pub(super) struct Reader<'a> {
    pub(super) machine: &'a Machine,
    /// The names captured so far.
    pub(super) captured: Vec<String>,
    /// The conditions of `since` and `count` and the signals of `cause` in all expressions.
    pub(super) followed: Followed,
    /// Data of the machine were stored, and have taken effect: the machine can have other channels than it has now.
    reconfigured: [bool; 2],
    /// The files that include each other down to the present one; paths in a step are relative to the last one.
    pub(super) files: Vec<PathBuf>,
    /// How often the present steps run.
    pub(super) times: u64,
    /// The NC programs that the steps select.
    pub(super) programs: NcPrograms,
}

/// The bits of an address: place, location, value.
pub(super) type Bits = (Place, Location, u64);

impl<'a> Reader<'a> {
    /// A reader of the steps in this file.
    pub(super) fn new(machine: &'a Machine, file: &Path) -> Self {
        let files = vec![file.to_owned()];
        let (captured, followed) = (Vec::new(), Followed::default());
        let programs = NcPrograms::of(machine);
        Self { machine, captured, followed, reconfigured: [false; 2], files, times: 1, programs }
    }

    /// An expression with all names known so far.
    pub(super) fn expression(&mut self, source: &str, place: &Place) -> Result<Expression, Problem> {
        let [is_reconfigured, _] = self.reconfigured;
        let known = Known { machine: self.machine, captured: &self.captured, is_reconfigured };
        let mut expression = Expression::parse(source, &known).map_err(|problem| problem.at(place))?;
        expression.follow(&mut self.followed);
        Ok(expression)
    }

    pub(super) fn step(&mut self, mut table: Table, place: Place, note: Option<Box<str>>) -> Result<Step, Problem> {
        let mut verbs = Vec::new();
        for verb in VERBS {
            if let Some(node) = table.take(verb) {
                verbs.push((verb, node));
            }
        }
        let mut verbs = verbs.into_iter();
        let Some((verb, node)) = verbs.next() else {
            // A misspelt verb is the most likely reason that no verb is found. Modifiers are not verbs.
            for modifier in ["within", "for", "during", "times"] {
                if let Some(node) = table.take(modifier) {
                    return Err(node.place.problem(
                        format!("expected a verb together with `{modifier}`, found none"),
                        "`within` belongs to `wait`, `for` to `pulse`, `during` to `hold`, `times` to `include`",
                    ));
                }
            }
            table.finish()?;
            return Err(place.problem("expected a step with one verb, found none", verbs_in_words()));
        };
        if let Some((second, node)) = verbs.next() {
            return Err(node.place.problem(
                format!("expected one verb in a step, found `{verb}` and `{second}`"),
                "write one [[step]] for each; no time passes between steps",
            ));
        }
        let action = self.action(verb, node, &mut table)?;
        for command in action.commands(self.machine.cycle_time()).unwrap_or_default() {
            self.judge(&command, &place)?;
        }
        self.refuse_foreign_modifiers(verb, &mut table)?;
        table.finish()?;
        Ok(Step { place, note, action })
    }

    /// Reads all steps, and those of the files that they include, into one list.
    pub(super) fn steps(&mut self, written: &WrittenSteps, list: &mut Steps) -> Result<(), Problem> {
        written.each(|mut table| {
            let place = table.place.clone();
            if list.steps.len() >= STEPS {
                let what = format!("expected at most {STEPS} steps, with those of included files, found more");
                return Err(place.problem(what, "repeat steps with `times`, which stores them once"));
            }
            let note = table.take("note").map(|node| node.text("a note").map(Box::from)).transpose()?;
            match table.take("include") {
                Some(node) => self.include(&node, &mut table, note, list)?,
                None => list.steps.push(self.step(table, place, note)?),
            }
            Ok(())
        })
    }

    /// Checks a command against the machine, so that it is rejected before anything runs.
    pub(super) fn judge(&self, command: &Command, place: &Place) -> Result<(), Problem> {
        if matches!(command, Command::SelectProgram { .. }) {
            // Its program is loaded when all steps are read.
            return Ok(());
        }
        self.machine.check(command).map_err(|problem| problem.at(place))
    }

    fn refuse_foreign_modifiers(&self, verb: &str, table: &mut Table) -> Result<(), Problem> {
        for (modifier, owner) in
            [("within", "wait"), ("for", "pulse"), ("during", "hold"), ("times", "include"), ("channel", "program")]
        {
            if let Some(node) = table.take(modifier) {
                return Err(node.place.problem(
                    format!("`{modifier}` cannot be combined with `{verb}`"),
                    format!("`{modifier}` belongs to `{owner}`"),
                ));
            }
        }
        Ok(())
    }

    fn action(&mut self, verb: &str, node: Node, table: &mut Table) -> Result<Action, Problem> {
        let place = node.place.clone();
        let command = |command: Command| Action::Queue([command].into());
        let action = match verb {
            "set" => Action::Queue(self.writes(node, false, |location, value| Command::Write { location, value })?),
            "write" => Action::Queue(self.writes(node, true, |location, value| Command::Write { location, value })?),
            "force" => Action::Queue(self.writes(node, false, |location, value| Command::Force { location, value })?),
            "release" => {
                let places = self.locations(node)?;
                Action::Queue(places.into_iter().map(|(_, location)| Command::Release { location }).collect())
            }
            "pulse" => {
                let time = table.take("for").map(|node| duration(&node, "the length of the pulse")).transpose()?;
                let mut locations = Vec::new();
                for (named, location) in self.locations(node)? {
                    if location.width != 1 {
                        return Err(named.place.problem(
                            format!("expected a single bit to pulse, found `{}`", named.text),
                            "use `set` for numbers",
                        ));
                    }
                    locations.push(location);
                }
                Action::Pulse(locations.into(), time.unwrap_or(PULSE))
            }
            "run" => Action::Run(duration(&node, "the time to run")?),
            "wait" => {
                let within =
                    table.take("within").map(|node| duration(&node, "the longest time to wait")).transpose()?;
                Action::Wait(Box::new(self.one_expression(&node)?), within)
            }
            "hold" => {
                let during = table.take("during").ok_or_else(|| {
                    place.problem("expected `during` together with `hold`, found none", "write during = \"2s\"")
                })?;
                let during = duration(&during, "the time to hold")?;
                Action::Hold(Box::new(self.one_expression(&node)?), during)
            }
            "expect" => {
                let texts = texts(Some(node), "an expression or a list of them")?;
                let mut expressions = Vec::with_capacity(texts.len());
                for Named { text, place } in texts {
                    let expression = self.expression(&text, &place)?;
                    expressions.push((place, expression));
                }
                Action::Expect(expressions.into())
            }
            "capture" => Action::Capture(self.captures(node)?),
            "machine_data" | "list" => {
                self.reconfigured[0] = true;
                Action::Queue(self.machine_data(node)?)
            }
            "r_parameters" => Action::Queue(self.r_parameters(node)?),
            "program" => {
                let directory = self.files.last().and_then(|file| file.parent()).unwrap_or_else(|| Path::new(""));
                let path = self.programs.file(node.text("the file of an NC program")?, directory, &place)?;
                command(Command::SelectProgram { channel: channel(table)?, path })
            }
            "nc" => {
                let path = self.programs.text(node.text("the text of an NC program")?);
                command(Command::SelectProgram { channel: channel(table)?, path })
            }
            "mdi" => {
                let text = node.text("blocks of an NC program")?.to_owned();
                command(Command::EnterBlocks { channel: channel(table)?, text })
            }
            "preset" => Action::Queue(self.presets(node)?),
            "function_generator" => command(self.generator(node)?),
            "search" => {
                let (block, kind) = search(node)?;
                command(Command::Search { channel: channel(table)?, block, kind })
            }
            "new_conf" => self.flag(&node, verb).map(|()| command(Command::NewConf))?,
            "power_on" => {
                self.flag(&node, verb)?;
                self.reconfigured[1] = self.reconfigured[0];
                command(Command::PowerOn)
            }
            "cancel" => self.flag(&node, verb).map(|()| command(Command::Cancel))?,
            "plc" => match node.text("\"stop\", \"run\" or \"cold\"")? {
                "stop" => command(Command::PlcStop),
                "run" => command(Command::PlcRun),
                "cold" => command(Command::PlcColdRestart),
                other => {
                    return Err(node.expected(
                        "\"stop\", \"run\" or \"cold\"",
                        &did_you_mean(
                            other,
                            ["stop", "run", "cold"],
                            "the PLC program is selected by the key `plc` at the head of the file",
                        ),
                    ));
                }
            },
            "handwheel" => Action::Handwheel(handwheel(node)?),
            "fault" => command(Command::Fault(fault(node, true, self.machine)?)),
            "clear_fault" => command(Command::ClearFault(fault(node, false, self.machine)?)),
            "image" => Action::Image(self.image(node)?),
            _ => {
                return Err(place.problem(format!("expected a verb, found `{verb}`"), verbs_in_words()));
            }
        };
        Ok(action)
    }

    fn one_expression(&mut self, node: &Node) -> Result<Expression, Problem> {
        self.expression(node.text("an expression")?, &node.place)
    }

    fn flag(&self, node: &Node, verb: &str) -> Result<(), Problem> {
        if node.boolean("true")? {
            Ok(())
        } else {
            Err(node.expected("true", &format!("write {verb} = true, or remove the step")))
        }
    }

    /// The locations in a list; the PLC or the operator panel must be able to write them.
    fn locations(&self, node: Node) -> Result<Vec<(Named, Location)>, Problem> {
        let texts = texts(Some(node), "an address or a list of them")?;
        texts
            .into_iter()
            .map(|named| {
                let location = self.writable(&named.text).map_err(|problem| problem.at(&named.place))?;
                let enable = enable_of(self.machine, &named.text).map(|enable| (named.clone(), enable));
                Ok(enable.into_iter().chain([(named, location)]))
            })
            .collect::<Result<Vec<_>, Problem>>()
            .map(|all| all.into_iter().flatten().collect())
    }

    /// The location of a signal that the NCK does not write, of an axis or channel that exists.
    fn writable(&self, name: &str) -> Result<Location, Problem> {
        let location = written_by_others(self.machine, name)?;
        match missing_owner(self.machine, location) {
            Some(problem) if self.reconfigured != [true, true] => Err(problem),
            Some(_) | None => Ok(location),
        }
    }

    /// Writes to signals; `of_the_nck` permits those of the NCK, too.
    fn writes(
        &self,
        node: Node,
        of_the_nck: bool,
        command: impl Fn(Location, u64) -> Command,
    ) -> Result<Box<[Command]>, Problem> {
        let mut table = node.into_table("signals with their values, as { \"X.controller_enable\" = 1 }")?;
        let entries = table.take_rest();
        let mut commands = Vec::with_capacity(entries.len());
        for (name, place, node) in entries {
            node.refuse_unquoted_key(&name)?;
            let found = if of_the_nck { place_named(self.machine, &name) } else { self.writable(&name) };
            let location = found.map_err(|problem| problem.at(&place))?;
            let coding = self.machine.override_coding();
            // Stored machine data may change the code of the switches.
            let is_plain = of_the_nck || self.reconfigured[0];
            let value = if is_plain {
                raw_value(&node, location, coding)
            } else {
                signal_value(&name, &node, location, coding)
            };
            if let Some(enable) = enable_of(self.machine, &name).filter(|_| !of_the_nck) {
                commands.push(command(enable, 1));
            }
            commands.push(command(location, value?));
        }
        Ok(commands.into())
    }

    fn captures(&mut self, node: Node) -> Result<Box<[(usize, Expression)]>, Problem> {
        let mut table = node.into_table("names with their expressions")?;
        let entries = table.take_rest();
        let mut captures = Vec::with_capacity(entries.len());
        let mut names = Vec::new();
        for (name, place, node) in entries {
            let expression = self.one_expression(&node)?;
            check_captured_name(&name).map_err(|problem| problem.at(&place))?;
            let known = self.captured.iter().chain(&names).position(|known| *known == name);
            let index = known.unwrap_or(self.captured.len() + names.len());
            if known.is_none() {
                names.push(name);
            }
            captures.push((index, expression));
        }
        self.captured.extend(names);
        Ok(captures.into())
    }
}

/// The channel of a program: `channel = 2`, else the first one.
fn channel(table: &mut Table) -> Result<ChannelNumber, Problem> {
    let Some(node) = table.take("channel") else { return Ok(ChannelNumber::FIRST) };
    let number: u8 = whole(&node, "a channel, 1 to 10", 1..=10)?;
    ChannelNumber::new(number).ok_or_else(|| node.expected("a channel, 1 to 10", "write channel = 2"))
}

fn verbs_in_words() -> String {
    format!("verbs are {}, include", VERBS.join(", "))
}

/// A rotation of a handwheel.
fn handwheel(node: Node) -> Result<Turn, Problem> {
    let place = node.place.clone();
    let mut table = node.into_table("a turn, as { number = 1, pulses = 50, over = \"1s\" }")?;
    let mut required = |key: &'static str| {
        table.take(key).ok_or_else(|| {
            place.problem(
                format!("expected the key `{key}`, found none"),
                "write { number = 1, pulses = 50, over = \"1s\" }",
            )
        })
    };
    let (number, pulses, over) = (required("number")?, required("pulses")?, required("over")?);
    let turn = Turn {
        number: whole(&number, "the number of a handwheel, 1 to 3", 1..=3)?,
        pulses: whole(&pulses, "a number of pulses between -1000000 and 1000000", -1_000_000..=1_000_000)?,
        over: duration(&over, "the time of the turn")?,
    };
    table.finish()?;
    Ok(turn)
}

/// A whole number within a range.
pub(super) fn whole<T: TryFrom<i64> + PartialOrd>(
    node: &Node,
    what: &str,
    range: RangeInclusive<T>,
) -> Result<T, Problem> {
    let number = if let Value::Integer(number) = node.value { T::try_from(number).ok() } else { None };
    number.filter(|number| range.contains(number)).ok_or_else(|| node.expected(what, "write a whole number"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_takes_less_than_a_hundred_bytes() {
        assert!(size_of::<Step>() <= 72, "{}", size_of::<Step>());
    }
}
