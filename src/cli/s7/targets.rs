//! Resolves the addresses and symbols of the command line.
//!
//! An address of the interface has the type given in the catalogue of its profile; any other address has its plain type. The names in
//! symbols come from a machine, from the NCK, or are AX1, AX2…, CHAN1… as `opennck signals` lists them.

use super::arguments::{Host, Names as Arguments};
use super::failure::{Failure, problem};
use crate::image::{Address, Block, Location, Memory, Names, OverrideCoding, Part, Width, Writer};
use crate::machine::Machine;
use crate::s7::client::{Client, Error, Memory as Place, NcVariable, Value, Variable};
use crate::scenario::profile_named;
use crate::source::{Node, Problem, Table};
use crate::trace::nearest_signal;
use crate::units::{AxisNumber, ChannelNumber};
use crate::variables::AxisValue;

/// An address or symbol of the command line.
#[derive(Clone, Debug)]
pub(super) struct Target {
    pub(super) variable: Variable,
    /// The address as shown in the list: addresses in normal form, NC variables as typed.
    shown: String,
    /// Empty if there is none.
    pub(super) symbol: String,
    /// Its location in the interface, if it has one.
    pub(super) location: Option<Location>,
    /// The coding of overrides at this location.
    pub(super) coding: OverrideCoding,
}

impl Target {
    /// The address as shown in the list.
    pub(super) fn address(&self) -> String {
        self.shown.clone()
    }

    /// The symbol with its address, or the address alone.
    pub(super) fn name(&self) -> String {
        if self.symbol.is_empty() { self.shown.clone() } else { format!("{} ({})", self.symbol, self.shown) }
    }

    /// The reason why it has no value, without its name.
    pub(super) fn reason(&self, error: &Error) -> String {
        let text = error.to_string();
        let name = format!("{}: ", self.variable);
        text.strip_prefix(&name).unwrap_or(&text).to_owned()
    }

    /// The error of this target in the form that the program prints, with its remedy.
    pub(super) fn problem(&self, error: &Error, cure: Option<String>) -> Problem {
        Problem::new(format!("{}: {}", self.shown, self.reason(error)), cure.unwrap_or_else(|| error.cure()))
    }

    /// Whether its symbol begins with an axis or a channel, which may have another name on the NCK.
    fn has_an_owner(&self) -> bool {
        ["AX", "CHAN"].iter().any(|owner| self.symbol.starts_with(owner))
    }

    pub(super) fn is_of_the_nck(&self) -> bool {
        matches!(self.variable, Variable::Nc(_))
    }
}

/// The meaning of names.
pub(super) struct Dictionary {
    names: Names,
    /// `None` if the host is not a control.
    memory: Option<Memory>,
    coding: OverrideCoding,
    /// Whether the names are those of a machine.
    is_known: bool,
}

impl Dictionary {
    pub(super) fn open(arguments: &Arguments) -> Result<Self, Problem> {
        if arguments.profile == "none" {
            let names = Names::default();
            let coding = OverrideCoding::of(names.interface());
            return Ok(Self { names, memory: None, coding, is_known: true });
        }
        let profile = profile_named(&arguments.profile)?;
        let memory = Some(Memory::new());
        if let Some(machine) = &arguments.machine {
            let machine = Machine::open(machine)?;
            let names = Names { profile, ..machine.names().clone() };
            return Ok(Self { names, memory, coding: machine.override_coding(), is_known: true });
        }
        let mut names = Names { profile, ..Names::default() };
        for axis in AxisNumber::up_to(profile.interface().count(Block::Axis)) {
            names.axes[axis] = Some(format!("AX{}", axis.number()));
        }
        for channel in ChannelNumber::all() {
            names.channels[channel] = Some(format!("CHAN{}", channel.number()));
        }
        Ok(Self { names, memory, coding: OverrideCoding::of(profile.interface()), is_known: false })
    }

    /// Resolves all texts. If a symbol has an unknown name, the names are read from the NCK.
    pub(super) async fn targets(&mut self, host: &Host, texts: &[String]) -> Result<Vec<Target>, Failure> {
        let all = |dictionary: &Self| texts.iter().map(|text| dictionary.target(text)).collect::<Result<Vec<_>, _>>();
        match all(self) {
            Err(first) if !self.is_known && texts.iter().any(|text| is_symbol(text)) => {
                let Some(names) = self.names_of_the_nck(host).await? else {
                    let cure = format!("{}\n  the NCK does not report its names: give --machine", first.cure);
                    return Err(Problem { cure, ..first }.into());
                };
                self.names = names;
                self.is_known = true;
                Ok(all(self)?)
            }
            Ok(targets) if !self.is_known && targets.iter().any(Target::has_an_owner) => {
                let names = async { self.ask_names(&host.nck_soon().await.ok()?).await };
                let Some(names) = host.optional(names).await else { return Ok(targets) };
                let before = std::mem::replace(&mut self.names, names);
                Ok(all(self).unwrap_or_else(|_| {
                    self.names = before; // AX1 on the command line means AX1
                    targets
                }))
            }
            targets => Ok(targets?),
        }
    }

    fn target(&self, text: &str) -> Result<Target, Problem> {
        let place = self.memory.as_ref().filter(|_| !text.contains('/') && !text.starts_with("nck:"));
        let resolved =
            place.map(|memory| self.names.resolve(memory, text).map_err(|problem| self.of_a_value(problem, text)));
        match resolved {
            Some(Ok(location)) => self.of_location(text, location),
            // The host may have a block or a byte that a control does not have.
            other => match (text.parse::<Variable>(), other) {
                (Ok(variable), _) => {
                    let shown = match &variable {
                        Variable::Nc(_) => format!("nck:{}", text.trim_start_matches("nck:")),
                        Variable::Memory(_) => variable.to_string(),
                    };
                    Ok(Target { variable, shown, symbol: String::new(), location: None, coding: self.coding })
                }
                (Err(_), Some(Err(problem))) if is_symbol(text) => Err(problem),
                (Err(error), _) => Err(problem(&error)),
            },
        }
    }

    /// The problem of a value of an axis: clients read it from the NCK.
    fn of_a_value(&self, problem: Problem, text: &str) -> Problem {
        let is_value =
            |(axis, value): &(&str, &str)| self.names.axis(axis).is_some() && AxisValue::named(value).is_some();
        let Some((_, value)) = text.split_once('.').filter(is_value) else {
            return problem;
        };
        let what =
            format!("expected a signal, found `{text}`, which is a value of the simulator and not in the interface");
        let cure = match value {
            "position" | "setpoint" | "velocity" | "following_error" | "distance_to_go" => {
                "a client reads such values from the NCK: `opennck s7 nck` lists its variables"
            }
            _ => "values stand in the expressions and in `watch` of a scenario",
        };
        Problem { what, cure: format!("{cure}{}", nearest_signal(&problem)), ..problem }
    }

    fn of_location(&self, text: &str, location: Location) -> Result<Target, Problem> {
        let address = self.names.address(location);
        if let Some(memory) = &self.memory {
            memory.locate(&address, self.names.profile).map_err(|problem| {
                Problem::new(
                    format!("expected an address of this profile, found {text}: {}", problem.what),
                    problem.cure,
                )
            })?;
        }
        let address = Address { format: Some(location.format), ..address };
        let symbol = self.names.symbol(location).unwrap_or_default();
        let variable: Variable = Place::of(&address).into();
        Ok(Target { shown: variable.to_string(), variable, symbol, location: Some(location), coding: self.coding })
    }

    /// The names of axes (MD10000) and channels (MD20000) on the control; `None` if no NCK reports them.
    async fn names_of_the_nck(&self, host: &Host) -> Result<Option<Names>, Failure> {
        let Some(nck) = host.answered(async { host.nck().await.ok() }).await else {
            // An unreachable host is an error; a PLC without an NCK is not.
            return host.plc().await.map(|_| None);
        };
        Ok(host.answered(self.ask_names(&nck)).await)
    }

    async fn ask_names(&self, nck: &Client) -> Option<Names> {
        let mut names = Names { profile: self.names.profile, ..Names::default() };
        // First read which channels exist (MD10010). Reading the name of a channel that does not exist would be refused and logged by the
        // control.
        let all = || AxisNumber::up_to(names.interface().count(Block::Axis));
        let axes = all().map(|axis| format!("N/$MN_AXCONF_MACHAX_NAME_TAB[{}]", axis.number()));
        let mut values = read(nck, axes.chain([format!("N/M/10010[1..{}]", ChannelNumber::all().count())])).await;
        let mode_groups = values.pop().flatten();
        for (axis, value) in all().zip(values) {
            names.axes[axis] = value.and_then(name);
        }
        let channels: Vec<_> =
            ChannelNumber::all().filter(|channel| may_exist(*channel, mode_groups.as_ref())).collect();
        let values = read(nck, channels.iter().map(|channel| format!("C{}/$MC_CHAN_NAME", channel.number()))).await;
        for (channel, value) in channels.into_iter().zip(values) {
            names.channels[channel] = value.and_then(name);
        }
        let has_names = names.axes.iter().any(|(_, name)| name.is_some());
        has_names.then_some(names)
    }

    /// Whether the NCK writes the signal, so that it overwrites what a client has written.
    pub(super) fn is_overwritten(&self, target: &Target) -> bool {
        target.location.is_some_and(|location| self.names.writer(location) == Some(Writer::Nck))
    }

    /// Parses a value as scenarios do.
    pub(super) fn value(&self, target: &Target, text: &str) -> Result<Value, Problem> {
        let texts: Vec<&str> = match count(&target.variable) {
            1 => vec![text],
            _ => text.split(',').map(str::trim).collect(),
        };
        let each = texts.iter().map(|text| self.one_value(target, text)).collect::<Result<Vec<_>, _>>()?;
        let value = if let ([_], 1) = (each.as_slice(), count(&target.variable)) {
            each.into_iter().next().unwrap_or(Value::List(Vec::new()))
        } else {
            Value::List(each)
        };
        value.encode(&target.variable).map_err(|error| problem(&error))?;
        Ok(value)
    }

    fn one_value(&self, target: &Target, text: &str) -> Result<Value, Problem> {
        let node = node(text)?;
        match &target.variable {
            Variable::Memory(place) => {
                let location = target.location.unwrap_or_else(|| anywhere(place));
                let bits = crate::image::raw_value(&node, location, self.coding).map_err(|problem| {
                    Problem::new(format!("{}={text}: {}", target.address(), problem.what), problem.cure)
                })?;
                Ok(of_bits(place, bits))
            }
            Variable::Nc(_) => Ok(match node.value {
                crate::source::Value::Integer(number) => match i32::try_from(number) {
                    Ok(number) => Value::DoubleInt(number),
                    Err(_) => Value::Double(number as f64),
                },
                crate::source::Value::Float(number) => Value::Double(number),
                crate::source::Value::Boolean(value) => Value::Bit(value),
                _ => Value::Text(text.trim_matches('"').to_owned()),
            }),
        }
    }
}

/// NC variables by name; `None` for one that the NCK does not have.
async fn read(nck: &Client, names: impl Iterator<Item = String>) -> Vec<Option<Value>> {
    let variables: Vec<Variable> =
        names.filter_map(|name| name.parse().ok().map(|variable: NcVariable| variable.into())).collect();
    nck.read_all(&variables).await.into_iter().map(Result::ok).collect()
}

fn name(value: Value) -> Option<String> {
    match value {
        Value::Text(name) if !name.is_empty() => Some(name),
        _ => None,
    }
}

/// Whether a channel may exist: it belongs to a mode group, or the NCK does not report the mode groups.
fn may_exist(channel: ChannelNumber, mode_groups: Option<&Value>) -> bool {
    // The length of a row follows from the length of the answer.
    let Some(Value::Bytes(bytes)) = mode_groups else { return true };
    let row = bytes.len() / ChannelNumber::all().count();
    let mode_group = bytes.chunks(row.max(1)).nth(usize::from(channel.number()) - 1);
    channel == ChannelNumber::FIRST || mode_group.is_some_and(|row| row.iter().any(|byte| *byte != 0))
}

/// The number of elements.
fn count(variable: &Variable) -> u32 {
    match variable {
        Variable::Memory(place) => place.count,
        Variable::Nc(variable) => variable.item.count.into(),
    }
}

/// Whether a text has the form of a symbol: a dot followed by a name in lower case.
fn is_symbol(text: &str) -> bool {
    text.split_once('.').is_some_and(|(_, signal)| signal.starts_with(|c: char| c.is_ascii_lowercase()))
}

/// A value in the syntax of a scenario, in which text has quotes and numbers do not.
fn node(text: &str) -> Result<Node, Problem> {
    let parse = |line: String| Table::parse(&line, "the command line").ok()?.take("value");
    let quoted = || parse(format!("value = {}", serde_json::Value::from(text)));
    // Otherwise TOML would read `16#D0` as 16 and a comment.
    let bare = (!text.contains('#')).then(|| format!("value = {text}"));
    bare.and_then(parse)
        .or_else(quoted)
        .ok_or_else(|| Problem::new(format!("expected a value, found `{text}`"), "write a number, true or false"))
}

/// Any location of this width. The location does not affect the value.
fn anywhere(place: &Place) -> Location {
    let (bit, width) = match place.width {
        Width::Bit(bit) => (bit, 1),
        Width::Bits { first, last } => (first, last - first + 1),
        Width::Byte => (0, 8),
        Width::Word => (0, 16),
        Width::Double => (0, 32),
    };
    Location { part: Part::Flags, offset: 0, bit, width, format: place.format }
}

#[expect(clippy::cast_possible_truncation, reason = "raw values fit the width of their place")]
fn of_bits(place: &Place, bits: u64) -> Value {
    use crate::image::Format;
    match (place.width, place.format) {
        (Width::Bit(_), _) => Value::Bit(bits == 1),
        (Width::Bits { .. } | Width::Byte, _) => Value::Byte(bits as u8),
        (Width::Word, Format::Signed) => Value::Int((bits as u16).cast_signed()),
        (Width::Word, Format::Unsigned | Format::Real) => Value::Word(bits as u16),
        (Width::Double, Format::Signed) => Value::DoubleInt((bits as u32).cast_signed()),
        (Width::Double, Format::Real) => Value::Real(f32::from_bits(bits as u32)),
        (Width::Double, Format::Unsigned) => Value::DoubleWord(bits as u32),
    }
}
