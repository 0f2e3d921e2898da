//! What does not change while a machine runs: its signals, axes and flowcharts, the panel of its PLC program, the steps of its scenario.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use super::options::WebOptions;
use crate::image::{Block, Location, Names, Part, Writer};
use crate::live::Handle;
use crate::machine::Machine;
use crate::plc::MACHINE_CONTROL_PANEL_LAYOUT;
use crate::scenario::Stage;
use crate::source::read_text;
use crate::units::{ChannelNumber, ModeGroupNumber};
use crate::variables::Describe;

/// The PLC program whose keys the page shows.
const PANEL: &str = "machine_control_panel";
/// The most steps of a scenario that are listed; generated ones can have 100,000.
const STEPS: usize = 2000;
/// The most lines of a step that are shown.
const LINES: usize = 8;

/// The catalogue, and where its signals are.
#[derive(Debug)]
pub(super) struct Catalogue {
    /// It as JSON.
    pub(super) text: String,
    /// The signals, in its order.
    pub(super) locations: Vec<Location>,
    indices: BTreeMap<(Part, u32, u8, u8), usize>,
}

#[derive(Serialize)]
struct Written<'a> {
    title: &'a str,
    profile: &'a str,
    plc: Option<&'a str>,
    panel: Option<&'a str>,
    read_only: bool,
    cycle: f64,
    axes: Vec<Axis<'a>>,
    channels: Vec<&'a str>,
    signals: Vec<Signal>,
    charts: Vec<Chart>,
    steps: Vec<Step>,
    /// The codes of the feed override of the first channel with their percentages.
    feed_overrides: Vec<(u8, u16)>,
}

#[derive(Serialize)]
struct Axis<'a> {
    name: &'a str,
    number: u8,
    is_rotary: bool,
}

#[derive(Serialize)]
struct Signal {
    address: String,
    symbol: String,
    writer: &'static str,
    bits: u8,
    doc: &'static str,
    is_modelled: bool,
}

#[derive(Serialize)]
struct Chart {
    name: &'static str,
    title: &'static str,
    phases: Vec<(String, &'static str)>,
    edges: Vec<Edge>,
}

/// An edge; without a `from` it leads from every phase.
#[derive(Serialize)]
struct Edge {
    from: Option<String>,
    to: String,
    rule: &'static str,
    text: &'static str,
}

#[derive(Serialize)]
struct Step {
    line: u32,
    note: Option<String>,
    text: String,
}

fn key(location: Location) -> (Part, u32, u8, u8) {
    (location.part, location.offset, location.bit, location.width)
}

impl Catalogue {
    pub(super) fn new(live: &Handle, options: &WebOptions) -> Self {
        let steps = steps(&live.scenario_steps());
        live.look(|seen| Self::of(seen.machine(), options, steps))
    }

    fn of(machine: &Machine, options: &WebOptions, steps: Vec<Step>) -> Self {
        let names = machine.names();
        let (signals, locations): (Vec<_>, Vec<_>) = signals(machine).into_iter().unzip();
        let axes = names.axes.iter().filter_map(|(axis, name)| {
            Some(Axis { name: name.as_deref()?, number: axis.number(), is_rotary: machine.is_rotary(axis) })
        });
        let exists = |channel: &ChannelNumber| machine.has_channel(*channel);
        let channels = ChannelNumber::all().filter(exists).filter_map(|channel| names.channels[channel].as_deref());
        let channels: Vec<_> = channels.collect();
        let feed =
            machine.names().resolve(machine.memory(), &format!("{}.feed_override", channels.first().unwrap_or(&"")));
        let coding = machine.override_coding();
        let share = |location, code| Some((code, coding.percent(location, code)?));
        let feed_overrides = feed.map(|location| (0..=u8::MAX).filter_map(|code| share(location, code)).collect());
        let feed_overrides = feed_overrides.unwrap_or_default();
        let written = Written {
            title: &options.title,
            profile: names.profile.name(),
            plc: options.plc.as_deref(),
            panel: (options.plc.as_deref() == Some(PANEL)).then_some(MACHINE_CONTROL_PANEL_LAYOUT),
            read_only: options.is_read_only,
            cycle: machine.cycle_time().seconds(),
            axes: axes.collect(),
            channels,
            signals,
            charts: charts(machine),
            steps,
            feed_overrides,
        };
        let text = serde_json::to_string(&written).unwrap_or_default();
        let indices = locations.iter().enumerate().map(|(index, location)| (key(*location), index)).collect();
        Self { text, locations, indices }
    }

    /// The index of the signal with exactly this location.
    pub(super) fn index(&self, location: Location) -> Option<usize> {
        self.indices.get(&key(location)).copied()
    }
}

/// All signals of the axes, channels and mode groups that exist.
fn signals(machine: &Machine) -> Vec<(Signal, Location)> {
    let names = machine.names();
    let exists = |(_, block, number): &(&str, Block, u8)| match block {
        Block::Channel => ChannelNumber::new(*number).is_some_and(|channel| machine.has_channel(channel)),
        Block::ModeGroup => ModeGroupNumber::new(*number).is_some_and(|group| machine.has_mode_group(group)),
        Block::Nck | Block::Axis => true,
    };
    let of_owner = |(_, block, number)| {
        let of_block = names.interface().signals().filter(move |signal| signal.block == block);
        of_block.filter_map(move |signal| {
            let location = names.interface().location(signal, number)?;
            Some((row(signal, location, machine, names)?, location))
        })
    };
    names.owners().filter(exists).flat_map(of_owner).collect()
}

/// Nothing for a signal that the profile does not show.
fn row(signal: &'static crate::image::Signal, location: Location, machine: &Machine, names: &Names) -> Option<Signal> {
    let address = names.address(location);
    machine.memory().locate(&address, names.profile).ok()?;
    let writer = match signal.writer {
        Writer::Plc => "plc",
        Writer::Nck => "nck",
        Writer::Hmi => "hmi",
    };
    Some(Signal {
        address: address.to_string(),
        symbol: names.symbol(location)?,
        writer,
        bits: location.width,
        doc: signal.doc,
        is_modelled: machine.control().texts().is_modelled(signal),
    })
}

fn charts(machine: &Machine) -> Vec<Chart> {
    let texts = machine.control().texts();
    let chart = |chart: crate::control::Chart| {
        let edges = chart.edges.into_iter().map(|edge| {
            let rule = texts.rule(edge.rule);
            Edge { from: Some(edge.from), to: edge.to, rule: rule.id, text: edge.tested.unwrap_or(rule.text) }
        });
        let anywhere = chart.from_anywhere.into_iter().map(|(rule, to)| {
            let rule = texts.rule(rule);
            Edge { from: None, to, rule: rule.id, text: rule.text }
        });
        Chart { name: chart.name, title: chart.title, phases: chart.phases, edges: edges.chain(anywhere).collect() }
    };
    texts.charts().into_iter().map(chart).collect()
}

/// The steps of a scenario with their lines in its file.
fn steps(stages: &[Stage]) -> Vec<Step> {
    let mut files: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut steps = Vec::new();
    for Stage { place, note } in stages.iter().take(STEPS) {
        let lines = files.entry(place.file.to_string()).or_insert_with(|| {
            let text = read_text(Path::new(&*place.file)).unwrap_or_default();
            text.lines().map(str::to_owned).collect()
        });
        let from = (place.line as usize).saturating_sub(1).min(lines.len());
        let is_head = |line: &&String| line.trim().is_empty() || line.trim_start().starts_with(['[', '#']);
        let is_own = |line: &&String| !line.trim_start().starts_with("[[step]]") && !line.trim().is_empty();
        let own = lines[from..].iter().skip_while(is_head).take_while(is_own).take(LINES);
        let text = own.filter(|line| !line.trim_start().starts_with("note")).map(String::as_str);
        steps.push(Step { line: place.line, note: note.clone(), text: text.collect::<Vec<_>>().join("\n") });
    }
    steps
}
