//! Reading a machine: machine data, `plant.toml`, presets; every default filled in.
//!
//! Which axes exist: those that MD20070 of a channel names where the archive says it, those with machine data of their own
//! where it does not, and those of `plant.toml`; without any of these, the default of MD20070.

use std::path::Path;
use std::sync::Arc;

use super::Machine;
use super::before::Before;
use super::definition::{Definition, Strobe, override_coding};
use super::plc::Plc;
use super::step::first_variables;
use crate::image::{Location, Memory, Names, Preset, Profile, SwitchSignals};
use crate::plant::{EncoderKind, Hints, Layout, Plant, PlantDefinition, Switch};
use crate::sinumerik::machine_data::{Archive, Finding, MachineData, Owner, Target, files_of, refusal};
use crate::sinumerik::{AxisPresence, Control, Mechanics};
use crate::source::{Place, Problem, Table, did_you_mean, read_text};
use crate::trace::Recorder;
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber, PerAxis, PerChannel, PerModeGroup, Position, Time};
use crate::variables::EventId;

/// How to open a machine other than as its files say.
#[derive(Debug, Default)]
pub struct OpenOptions {
    /// Tables to merge over `plant.toml`, as a scenario's `[plant.XF]`: keys are axis names.
    pub plant_over: Option<Table>,
    /// Under which numbers the interface blocks are known.
    pub profile: Profile,
    /// Memory of the PLC beside the interface, and starting values.
    pub preset: Option<Preset>,
}

/// A machine in the program itself: file names and contents.
struct BuiltIn {
    name: &'static str,
    archives: &'static [(&'static str, &'static [u8])],
    plant: (&'static str, &'static str),
}

static BUILT_IN: &[BuiltIn] = &[BuiltIn {
    name: "g1_example",
    archives: &[("g1_example.tea", include_bytes!("../../machine_data/g1_example/g1_example.tea"))],
    plant: ("plant.toml", include_str!("../../machine_data/g1_example/plant.toml")),
}];

impl Machine {
    /// Opens a machine: a directory, a single archive file, or the name of a built-in one.
    ///
    /// # Errors
    /// Anything in its files that cannot be used, with file and line.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Problem> {
        Self::open_with(path, OpenOptions::default())
    }

    /// Opens a machine with a changed plant, another profile or presets for its memory.
    ///
    /// # Errors
    /// As [`Machine::open`].
    pub fn open_with(path: impl AsRef<Path>, options: OpenOptions) -> Result<Self, Problem> {
        open(path.as_ref(), options)
    }
}

fn open(path: &Path, options: OpenOptions) -> Result<Machine, Problem> {
    let (archive, mut plant) = read(path)?;
    if let Some(over) = options.plant_over {
        plant.merge(over);
    }
    let plant_place = plant.place.clone();
    let plant = PlantDefinition::read(plant)?;
    let all: Vec<&str> = MachineData::axis_numbers().map(|axis| archive.data.axis_name(axis)).collect();
    plant.check_names(&all)?;
    let presence = presence(&archive, &plant);
    let control = Control::new(archive.data.clone(), presence);
    let names = Names {
        axes: PerAxis::from_fn(|axis| presence[axis].exists.then(|| archive.data.axis_name(axis).to_owned())),
        channels: PerChannel::from_fn(|channel| Some(archive.data.channels[channel].chan_name.clone())),
        profile: options.profile,
    };
    names.check()?;
    let memory = match &options.preset {
        Some(preset) => Memory::from_preset(preset, &names, override_coding(&archive.data))?,
        None => Memory::new(),
    };
    check_plc_cycle(plant.plc_cycle, control.parameters().cycle, &plant_place)?;
    let layout = layout(&plant, &archive, &control, &names);
    let mut warnings: Vec<String> = archive.findings.iter().map(Finding::to_string).collect();
    warnings.extend(not_modelled(&control, &names, &plant));
    let strobe = Strobe { fixed: plant.db11_5_2, bytes: strobe_bytes(&memory) };
    let definition = Definition {
        plc_cycle: plant.plc_cycle,
        unwired: unwired(&layout, &names),
        layout,
        names,
        memory: memory.clone(),
        strobe,
        warnings,
    };
    Ok(assemble(definition, control, memory))
}

fn assemble(definition: Definition, mut control: Control, memory: Memory) -> Machine {
    let plant = Plant::new(&definition.layout);
    definition.strobe.apply(&mut control);
    let before = Before::new(&memory, EventId::NONE);
    let mut machine = Machine {
        plant,
        memory,
        before,
        control,
        definition: Arc::new(definition),
        variables: crate::variables::Variables::default(),
        r_parameters: crate::variables::RParameters::default(),
        plc: Plc::default(),
        forces: Vec::new(),
        queue: Vec::new(),
        displaced: Vec::new(),
        cycle: 0,
        time: Time::ZERO,
        feedback: PerAxis::default(),
        alarms_before: Vec::with_capacity(crate::variables::Alarms::CAPACITY),
        recorder: Recorder::default(),
    };
    machine.sense(crate::units::AxisSet::ALL);
    machine.variables = first_variables(&machine.feedback);
    machine
}

/// Machine data and `plant.toml` as they stand, or those of a built-in machine.
fn read(path: &Path) -> Result<(Archive, Table), Problem> {
    if !path.exists() {
        return read_built_in(path);
    }
    let files = files_of(path)?;
    let plant = if path.is_dir() { path.join("plant.toml") } else { path.with_file_name("plant.toml") };
    let plant = Some(plant).filter(|plant| path.is_dir() && plant.exists());
    if files.is_empty() && plant.is_none() {
        return Err(Place::file(&path.display().to_string()).problem(
            "expected machine data (*.tea, *.ini, *.mpf or one *.arc) or plant.toml, found neither",
            "export the machine data of your control into this directory",
        ));
    }
    let archive = Archive::load(&files).map_err(|findings| refusal(&findings))?;
    let plant = match plant {
        Some(plant) => Table::parse(&read_text(&plant)?, &plant.display().to_string())?,
        None => Table::empty(Place::file(&path.display().to_string())),
    };
    Ok((archive, plant))
}

fn read_built_in(path: &Path) -> Result<(Archive, Table), Problem> {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let names: Vec<&str> = BUILT_IN.iter().map(|machine| machine.name).collect();
    let Some(machine) = BUILT_IN.iter().find(|machine| machine.name == name) else {
        let built_in = format!("name a directory, an archive file, or a built-in machine: {}", names.join(", "));
        return Err(Problem::new(
            format!("expected a machine, found nothing at {}", path.display()),
            did_you_mean(name, names.iter().copied(), &built_in),
        ));
    };
    let archive = Archive::read(machine.archives.iter().copied()).map_err(|findings| refusal(&findings))?;
    let (file, text) = machine.plant;
    Ok((archive, Table::parse(text, file)?))
}

fn presence(archive: &Archive, plant: &PlantDefinition) -> PerAxis<AxisPresence> {
    let data = &archive.data;
    let channels: Vec<ChannelNumber> =
        ChannelNumber::all().filter(|&channel| data.mode_group(channel).is_some()).collect();
    let in_channel = |axis: AxisNumber| channels.iter().any(|&channel| data.channel_knows(channel, axis));
    let in_plant = |axis: AxisNumber| MachineData::is_axis(axis) && plant.axes.contains_key(data.axis_name(axis));
    let said = channels.iter().any(|&channel| archive.is_given_for(20070, Owner::Channel(channel)));
    let named = |axis: AxisNumber| in_plant(axis) || if said { in_channel(axis) } else { archive.given_axis(axis) };
    let any = MachineData::axis_numbers().any(named);
    PerAxis::from_fn(|axis| {
        let simulated = data.axes[axis].ctrlout_type == 0 && !data.axes[axis].simu_ax_vdi_output;
        let says_so = Target::new(30350, Owner::Axis(axis), 0).is_ok_and(|target| archive.is_given(&target));
        AxisPresence {
            exists: if any { named(axis) } else { in_channel(axis) },
            // E-26: an axis is a real one unless the archive itself says that it shows nothing.
            silent: simulated && says_so,
            iron: Mechanics::new(&data.axes[axis]),
        }
    })
}

fn layout(plant: &PlantDefinition, archive: &Archive, control: &Control, names: &Names) -> Layout {
    let parameters = control.parameters();
    let hints = PerAxis::from_fn(|axis| {
        let reference = &parameters.axes[axis].reference;
        Hints {
            exists: parameters.axes[axis].exists,
            cam_direction: match (reference.cam_is_active, reference.cam_direction > 0.0) {
                (false, _) => 0,
                (true, true) => 1,
                (true, false) => -1,
            },
            zero_mark_spacing: archive.data.axes[axis].enc_refp_marker_dist.map(Position::from_user),
        }
    });
    let groupings: Vec<_> = parameters
        .groupings
        .groupings
        .iter()
        .map(|grouping| (grouping.number, grouping.coupling.members().collect()))
        .collect();
    Layout::new(plant, &names.axes, &hints, &groupings)
}

/// The signals that the simulator itself sets because their switches lead to no input: cams, then limit switches.
fn unwired(layout: &Layout, names: &Names) -> Vec<(AxisNumber, Switch, Location)> {
    let Some(SwitchSignals { cam, limit_plus, limit_minus }) = names.interface().tables().switches else {
        return Vec::new();
    };
    let signals = [(Switch::Cam, cam), (Switch::LimitPlus, limit_plus), (Switch::LimitMinus, limit_minus)];
    let each = signals.into_iter().zip(layout.unwired).flat_map(|((switch, signal), axes)| {
        axes.iter().filter_map(move |axis| {
            let location = names.interface().location(&signal, axis.number())?;
            Some((axis, switch, location))
        })
    });
    each.collect()
}

fn check_plc_cycle(plc_cycle: Option<Time>, cycle: Time, place: &Place) -> Result<(), Problem> {
    match plc_cycle {
        Some(plc) if plc.nanos() % cycle.nanos() != 0 || plc < cycle => Err(place.problem(
            format!("expected plc_cycle to be a whole multiple of the NC cycle of {cycle} s, found {plc} s"),
            "change [machine] plc_cycle, or MD10050 and MD10070",
        )),
        _ => Ok(()),
    }
}

fn strobe_bytes(memory: &Memory) -> PerModeGroup<u32> {
    PerModeGroup::new(["DB11.DBB5", "DB11.DBB25"]).map(|address| {
        let address = address.parse().ok();
        let location = address.and_then(|address| memory.locate(&address, Profile::SINUMERIK_840D_SL).ok());
        location.map_or(u32::MAX, |location| location.offset)
    })
}

/// What machine data and plant ask for and this version does not do, so that nobody waits for it in vain.
fn not_modelled(control: &Control, names: &Names, plant: &PlantDefinition) -> Vec<String> {
    let mut warnings = Vec::new();
    for (index, group) in control.active().general.assign_chan_to_mode_group.iter().enumerate() {
        if *group > i32::from(ModeGroupNumber::MAX) {
            let channel = index + 1;
            warnings
                .push(format!("channel {channel}: MD10010 = {group} is not modelled; there are mode groups 1 and 2"));
        }
    }
    for (number, axis) in control.parameters().existing() {
        let name = names.axes[number].as_deref().unwrap_or_default();
        for (index, &mode) in axis.reference.mode.iter().enumerate().take(usize::from(axis.encoders)) {
            if mode != 1 {
                let which = if index == 0 { "MD34200" } else { "MD34200[1]" };
                warnings.push(format!(
                    "axis {name}: {which} = {mode} is not modelled; incremental encoders with zero marks (1) are referenced"
                ));
            }
        }
        for (index, encoder) in plant.axes.get(name).into_iter().flat_map(|axis| axis.encoders.iter().enumerate()) {
            if matches!(encoder.kind, Some(EncoderKind::Absolute | EncoderKind::DistanceCoded)) {
                let number = index + 1;
                warnings.push(format!("axis {name}: the kind of encoder {number} is not modelled; it is incremental"));
            }
        }
        if axis.modulo {
            warnings
                .push(format!("axis {name}: MD30310, modulo, is modelled as no software limits; positions count on"));
        }
        if control.active().axes[number].gantry_function_mask & 1 != 0 {
            warnings.push(format!("axis {name}: MD37150 bit 0, extended monitoring, is not modelled"));
        }
    }
    warnings
}
