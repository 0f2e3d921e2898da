//! From parameter lists to a control: the places of axes, their names, and the values in effect.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use super::channel::{Channel, Member};
use super::cnc::Cnc;
use super::hli::HLI;
use super::language::{AxisReference, Form, Pair};
use super::lists::{self, AxisKind, Code, Lists, Message, OnMode, Started};
use super::parameters::{AxisParameters, Clearing, Homing, Modulo, acceleration, length, velocity};
use super::state::{Axis, Cycle, State};
use crate::control::{
    AxisHints, Configuration, EncoderModel, Examined, Finding, Log, Opened, Settings, Site, StoredDatum, Value,
};
use crate::image::{Names, Profile};
use crate::motion::coupling::TwoStage;
use crate::source::{INPUT_MIB, Problem, read_bytes};
use crate::units::{AxisNumber, AxisSet, ChannelNumber, PerAxis, PerChannel, Position, Time};
use crate::variables::{EventId, ParameterValue, Place, short_text};

/// The parameter lists of a machine.
#[derive(Clone, Debug)]
pub struct ParameterLists {
    lists: Lists,
    started: Started,
    /// What is read, but not as it seems.
    remarks: Vec<Finding>,
    /// All names that axes can have in `plant.toml`.
    names: Vec<String>,
}

impl ParameterLists {
    /// Reads lists: names and contents of files.
    ///
    /// # Errors
    /// Something cannot be read, with file and line, or there are more axes than places for them.
    pub fn read(files: &[(&str, &[u8])]) -> Result<Self, Problem> {
        let (lists, remarks) = Lists::read_with_remarks(files)?;
        Self::of(lists, remarks)
    }

    /// Reads the lists of a folder, or one list.
    ///
    /// # Errors
    /// As [`ParameterLists::read`].
    pub fn load(path: &Path) -> Result<Self, Problem> {
        let contents = contents(path)?;
        let files: Vec<(&str, &[u8])> =
            contents.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice())).collect();
        Self::read(&files)
    }

    fn of(mut lists: Lists, remarks: Vec<Finding>) -> Result<Self, Problem> {
        let started = lists.start();
        let most = usize::from(AxisNumber::MAX);
        if started.axes.len() > most {
            return Err(Problem::new(
                format!("expected at most {most} axes, found {}", started.axes.len()),
                "remove axis lists",
            ));
        }
        let mut names = Vec::new();
        for axis in &started.axes {
            names.push(format!("ax{}", axis.number));
            names.extend(started.names(axis).into_iter().map(str::to_owned));
        }
        Ok(Self { lists, started, remarks, names })
    }
}

/// The contents of the lists of a folder, in the order of their names, or of one list.
fn contents(path: &Path) -> Result<Vec<(String, Vec<u8>)>, Problem> {
    let mut files: Vec<PathBuf> = Vec::new();
    if path.is_dir() {
        let entries = fs::read_dir(path).and_then(Iterator::collect::<Result<Vec<_>, _>>);
        for entry in entries.map_err(|error| crate::source::unreadable(path, &error))? {
            if is_list(&entry.path()) && entry.path().is_file() {
                files.push(entry.path());
            }
        }
        files.sort();
    } else {
        files.push(path.to_owned());
    }
    files.iter().map(|file| Ok((file.display().to_string(), read_bytes(file, INPUT_MIB)?))).collect()
}

/// Whether a file is a parameter list, by its name.
#[must_use]
pub fn is_list(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("lis"))
}

/// The contents of the lists of a machine, whether or not they define a usable machine.
///
/// # Errors
/// A file cannot be read.
pub fn examine(path: &Path) -> Result<Examined, Problem> {
    let contents = contents(path)?;
    let files: Vec<(&str, &[u8])> = contents.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice())).collect();
    Ok(lists::examine(&files))
}

/// The place of each axis: its logical number where that is free, in the order of the numbers.
fn places(started: &Started) -> BTreeMap<u16, AxisNumber> {
    let mut places = BTreeMap::new();
    let mut taken = AxisSet::NONE;
    let own = |number: u16| u8::try_from(number).ok().and_then(AxisNumber::new);
    for axis in &started.axes {
        if let Some(place) = own(axis.number) {
            taken.set(place, true);
            places.insert(axis.number, place);
        }
    }
    for axis in &started.axes {
        if own(axis.number).is_none()
            && let Some(place) = AxisNumber::all().find(|place| !taken.contains(*place))
        {
            taken.set(place, true);
            places.insert(axis.number, place);
        }
    }
    places
}

impl Configuration for ParameterLists {
    fn axis_names(&self) -> Vec<&str> {
        self.names.iter().map(String::as_str).collect()
    }

    fn store(&mut self, data: &[StoredDatum]) -> Result<(), Problem> {
        for StoredDatum { target, place, value } in data {
            self.lists.set(target, value, place).map_err(|problem| problem.at(place))?;
        }
        *self = Self::of(self.lists.clone(), self.remarks.clone())?;
        Ok(())
    }

    fn not_used(&self) -> Option<(String, String)> {
        let is_left_out = |message: &&Message| message.code == Code::Number(super::messages::NUMBER_0.0);
        let texts: Vec<&str> = self.started.messages.iter().filter(is_left_out).map(|message| &*message.text).collect();
        (!texts.is_empty()).then(|| {
            let reason = format!("the machine has an axis list with the number 0 (110076): {}", texts.join("; "));
            (reason, "write the logical number of the axis into kopf.achs_nr of this list".to_owned())
        })
    }

    fn groupings(&self) -> u8 {
        u8::MAX
    }

    fn open(&self, site: &Site<'_>, settings: &mut Settings, profile: Profile) -> Result<Opened, Problem> {
        let own = Profile::named(&HLI, "isg").unwrap_or_default();
        if profile != own && profile != Profile::default() {
            return Err(Problem::new(
                format!("expected the profile isg, found {}", profile.name()),
                "leave the profile out: a machine of the ISG kernel has one interface",
            ));
        }
        let cycle = match settings.machine.take("cycle") {
            None => Cycle::default().0,
            Some(node) => {
                let text = node.text("the cycle of the CNC, as \"2ms\"")?.to_owned();
                let cycle = Time::parse(&text)
                    .filter(|cycle| *cycle >= Time::from_micros(100) && *cycle <= Time::from_millis(100));
                cycle.ok_or_else(|| node.expected("a cycle from 0.1ms to 100ms", "write cycle = \"2ms\""))?
            }
        };
        let lenient = match settings.control.take("lenient") {
            None => false,
            Some(node) => node.boolean("whether NC programs are read as the manuals print them")?,
        };
        if let Some(node) = settings.control.take("dialect") {
            node.one_of(&[("isg", ()), ("twincat", ())])?;
        }
        let places = places(&self.started);
        let names_of = |axis: &lists::Axis| -> Vec<String> {
            let all = [format!("ax{}", axis.number)];
            all.into_iter().chain(self.started.names(axis).into_iter().map(str::to_owned)).collect()
        };
        let is_intelligent = |axis: &lists::Axis| names_of(axis).iter().any(|name| (site.intelligent)(name));
        let intelligent: AxisSet = self
            .started
            .axes
            .iter()
            .filter(|axis| is_intelligent(axis))
            .filter_map(|axis| places.get(&axis.number).copied())
            .collect();
        let control = Cnc::new(self.lists.clone(), cycle, lenient, intelligent);
        let mut names = Names { profile: own, ..Names::default() };
        for axis in &self.started.axes {
            let Some(place) = places.get(&axis.number).copied() else { continue };
            let mut all = names_of(axis).into_iter();
            names.axes[place] = all.next();
            names.aliases.extend(all.map(|alias| (alias, place)));
        }
        names.aliases.sort();
        names.aliases.dedup();
        names.channels = PerChannel::from_fn(|channel| {
            control.0.channels.iter().any(|one| one.number == channel).then(|| format!("channel_{channel}"))
        });
        names.check()?;
        let groupings = control.0.combinations.iter().filter_map(|one| {
            let master = control.0.axes[one.coupling.leader()].parameters.number;
            Some((u8::try_from(master).ok()?, one.coupling.members().collect()))
        });
        let groupings = groupings.collect();
        let axes = PerAxis::from_fn(|axis| {
            let axis = &control.0.axes[axis];
            AxisHints {
                exists: axis.exists,
                cam_direction: match axis.parameters.homing {
                    Homing { with_cam: false, .. } => 0,
                    Homing { direction, .. } if direction < 0.0 => -1,
                    Homing { .. } => 1,
                },
                // A master and its slaves that start a little apart home at the same zero mark.
                cam_is_fixed: true,
                zero_mark_spacing: [Position::from_user(10.0); 2],
                encoders: [EncoderModel::Incremental; 2],
                ..AxisHints::default()
            }
        });
        let findings = lists::findings(&self.lists, &self.started.messages, self.remarks.clone());
        Ok(Opened { control: Box::new(control), names, axes, groupings, findings })
    }
}

impl State {
    /// A control that has not started.
    pub(super) fn new(lists: Lists, cycle: Time, lenient: bool, intelligent: AxisSet) -> Self {
        Self {
            log: Log::default(),
            lists,
            cycle: Cycle(cycle),
            lenient,
            intelligent,
            axes: PerAxis::default(),
            combinations: Vec::new(),
            programs: BTreeMap::new(),
            channels: Vec::new(),
            pending: super::pending::Pending::default(),
            in_effect: std::sync::Arc::default(),
            power_on: EventId::NONE,
            as_after_start: EventId::NONE,
            activated: Vec::new(),
            plc_missing: EventId::NONE,
            starts: false,
        }
    }

    /// Takes the values in effect. At a start the channels begin anew; an update at run time changes parameters alone.
    pub(super) fn adopt(&mut self, started: &Started, starts: bool, cause: EventId) {
        let places = places(started);
        for axis in &started.axes {
            let Some(place) = places.get(&axis.number).copied() else { continue };
            let master = axis.master.and_then(|master| places.get(&master).copied());
            let state: &mut Axis = &mut self.axes[place];
            state.exists = true;
            state.parameters = parameters(axis, master);
        }
        let now = in_effect(started, &places);
        let is_other = |value: &&ParameterValue| {
            let key = (value.number, value.index, value.place);
            let before = self.in_effect.iter().find(|before| (before.number, before.index, before.place) == key);
            before.is_some_and(|before| before != *value)
        };
        let activated: Vec<ParameterValue> = now.iter().filter(is_other).copied().collect();
        for value in activated {
            let axis = match value.place {
                Place::Axis(axis) => Some(axis),
                Place::Nck | Place::ModeGroup(_) | Place::Channel(_) => None,
            };
            self.log.activated(value.number, axis, cause);
            self.activated.push((value, cause));
        }
        self.in_effect = std::sync::Arc::new(now);
        if starts {
            let selected: Vec<Option<String>> = self.channels.iter().map(|channel| channel.selected.clone()).collect();
            self.channels = started.channels.iter().filter_map(|channel| made(channel, &places)).collect();
            for (channel, selected) in self.channels.iter_mut().zip(selected) {
                channel.selected = selected;
            }
        }
        for (channel, list) in self.channels.iter_mut().zip(&started.channels) {
            channel.restores_after_reset = list.restore_after_reset;
            channel.restores_after_end = list.preserve_after_program_end;
            channel.retains_axes = list.retain_last_configuration;
            channel.always_shortest_way = list.always_shortest_way;
            channel.first_feed = list.default_feed;
            channel.feed_unit = if list.is_feed_in_m_per_minute { 1000.0 } else { 1.0 };
        }
    }

    /// A parameter in effect, as a number in the unit of the list.
    pub(super) fn parameter_in_effect(&self, number: u32, axis: Option<AxisNumber>) -> Option<f64> {
        let started = self.lists.update();
        let name = lists::id(number);
        let value = match axis {
            Some(axis) => started.axis(self.axes[axis].parameters.number)?.value(&name).cloned(),
            None => started.channels.first()?.value(&name).cloned(),
        };
        match value? {
            Value::Integer(number) => Some(number as f64),
            Value::Real(number) => Some(number),
            Value::Boolean(is) => Some(f64::from(u8::from(is))),
            Value::Text(_) => None,
        }
    }

    /// The combinations, as lines of text.
    pub(super) fn configuration(&self, names: &Names) -> Vec<String> {
        let name = |axis: AxisNumber| names.axes[axis].clone().unwrap_or_default();
        let line = |one: &super::combination::Combination| {
            let slaves: Vec<String> = one.coupling.followers().map(name).collect();
            format!("gantry combination: master {}, slaves {}", name(one.coupling.leader()), slaves.join(", "))
        };
        self.combinations.iter().map(line).collect()
    }
}

/// A channel after a start.
fn made(list: &lists::Channel, places: &BTreeMap<u16, AxisNumber>) -> Option<Channel> {
    let number = ChannelNumber::new(u8::try_from(list.number).ok()?)?;
    let mut channel = Channel::new(number);
    let member = |axis: &lists::ChannelAxis| {
        Some(Member { index: axis.index, name: axis.name.clone(), axis: places.get(&axis.number).copied()? })
    };
    channel.configured = list.axes.iter().filter_map(member).collect();
    channel.axes.clone_from(&channel.configured);
    let pairs: Vec<Pair> = list
        .group_0
        .iter()
        .filter(|pair| !pair.is_spindles)
        .map(|pair| Pair {
            slave: AxisReference::Number(pair.slave.into()),
            master: AxisReference::Number(pair.master.into()),
            form: Form::Bare,
        })
        .collect();
    if !pairs.is_empty() {
        channel.definitions.insert(0, pairs);
    }
    Some(channel)
}

/// The parameters of an axis in the units of the model.
fn parameters(axis: &lists::Axis, master: Option<AxisNumber>) -> AxisParameters {
    let limits = axis.limits;
    let number = |name: &str| match axis.value(name) {
        Some(Value::Integer(number)) => u32::try_from(*number).unwrap_or(0),
        _ => 0,
    };
    let with_limits = limits.first > 0 && limits.second > 0;
    AxisParameters {
        number: axis.number,
        kind: u16::try_from(number("P-AXIS-00018")).unwrap_or(0),
        mode: number("P-AXIS-00015"),
        is_rotary: axis.kind != AxisKind::Linear,
        modulo: axis.is_modulo.then(|| {
            let [lower, upper] = axis.modulo_range.map(|limit| length(limit.into()));
            Modulo { lower, upper }
        }),
        is_master: axis.is_master,
        is_slave: axis.is_slave,
        master,
        limits: with_limits.then(|| TwoStage::new(Some(length(limits.first.into())), length(limits.second.into()))),
        offset: length(axis.offset.into()),
        takes_masters_homing: axis.slave_no_homing,
        checks_without_homing: axis.check_without_homing,
        homes_at_once: axis.synchronous_homing,
        stops_controlled: axis.cnc_controlled_stop,
        clearing: match axis.on_mode {
            _ if axis.clears_on_edge() => Clearing::Edge,
            OnMode::Default => Clearing::ResetOrUnit,
            OnMode::OnlyControlUnit => Clearing::Unit,
            OnMode::EdgeTriggered => Clearing::Edge,
            OnMode::Config => Clearing::Never,
        },
        correction_velocity: velocity(limits.correction_velocity),
        acceleration: acceleration(axis.a_max),
        emergency: acceleration(axis.a_emergency),
        velocity: velocity(axis.vb_max),
        homing: Homing {
            disabled: axis.homing == lists::Homing::Disabled,
            by_the_cnc: axis.is_homing_given && axis.homing == lists::Homing::CncControlled,
            ignores_absolute: axis.homing == lists::Homing::IgnoreAbsolutePosition,
            direction: if axis.is_reference_direction_positive { 1.0 } else { -1.0 },
            fast: velocity(axis.vb_ref_fast),
            slow: velocity(axis.vb_ref_slow),
            acceleration: acceleration(axis.a_ref),
            position: length(axis.reference_position.into()),
            with_cam: !axis.has_no_cam,
            reverses: !axis.has_no_reversal,
            with_zero_pulse: !axis.has_no_zero_pulse,
            farthest: (axis.max_homing_distance > 0).then(|| length(axis.max_homing_distance.into())),
        },
    }
}

/// The parameters in effect.
fn in_effect(started: &Started, places: &BTreeMap<u16, AxisNumber>) -> Vec<ParameterValue> {
    let value = |key: &lists::Key, place: Place, value: &Value| {
        let (number, word) = match value {
            Value::Integer(number) => (*number as f64, None),
            Value::Real(number) => (*number, None),
            Value::Boolean(is) => (f64::from(u8::from(*is)), None),
            Value::Text(text) => (f64::NAN, Some(short_text(text))),
        };
        ParameterValue { number: key.number, index: key.index, place, value: number, word }
    };
    let mut all = Vec::new();
    for axis in &started.axes {
        let Some(place) = places.get(&axis.number) else { continue };
        all.extend(axis.values().map(|(key, of)| value(key, Place::Axis(*place), of)));
    }
    for channel in &started.channels {
        let Some(number) = u8::try_from(channel.number).ok().and_then(ChannelNumber::new) else { continue };
        all.extend(channel.values().map(|(key, of)| value(key, Place::Channel(number), of)));
    }
    all
}
