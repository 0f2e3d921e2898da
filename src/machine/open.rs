//! Reads a machine: its control, `plant.toml` and presets, with all defaults filled in.

use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use super::Machine;
use super::before::Before;
use super::definition::Definition;
use super::delay::MOST_CYCLES;
use super::plc::PlcState;
use super::state::State;
use super::step::first_variables;
use crate::control::{Configuration, Control, CycleTimes, EncoderModel, Finding, Opened, Settings, Site, summary};
use crate::image::{Location, Memory, Names, Preset, Profile, SwitchSignals};
use crate::plant::{EncoderKind, Given, Hints, Layout, Plant, PlantDefinition, Switch};
use crate::source::{Place, Problem, Table};
use crate::trace::Recorder;
use crate::units::{AxisNumber, AxisSet, PerAxis, Time};
use crate::variables::{Alarms, EventId, Variables};

/// Options that override the files of a machine.
#[derive(Debug, Default)]
pub struct OpenOptions {
    /// Tables that are merged over `plant.toml`, like `[plant.XF]` of a scenario; keys are axis names.
    pub plant_over: Option<Table>,
    /// The numbering of the interface blocks.
    pub profile: Profile,
    /// PLC memory beside the interface, and initial values.
    pub preset: Option<Preset>,
    /// The scenario that changes the machine: the line about findings names it, where they come from it.
    pub scenario: Option<PathBuf>,
}

impl Machine {
    /// Opens a machine: a directory, a single archive file, or the name of a built-in machine.
    ///
    /// # Errors
    /// A file contains something unusable; the error gives file and line.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Problem> {
        Self::open_with(path, OpenOptions::default())
    }

    /// Opens a machine with a changed plant, another profile, or presets for its memory.
    ///
    /// # Errors
    /// As [`Machine::open`].
    pub fn open_with(path: impl AsRef<Path>, options: OpenOptions) -> Result<Self, Problem> {
        let (configuration, plant) = crate::controls::read(path.as_ref())?;
        Self::of(&*configuration, plant, options)
    }

    /// A machine with any control, and the plant that `plant.toml` describes.
    ///
    /// # Errors
    /// Something in the plant or the options cannot be used with this control.
    pub fn of(configuration: &dyn Configuration, mut plant: Table, options: OpenOptions) -> Result<Self, Problem> {
        let plant_place = plant.place.clone();
        if let Some(over) = options.plant_over {
            plant.merge(over);
        }
        let mut plant = PlantDefinition::read(plant)?;
        let machine_place = plant.machine.as_ref().map_or_else(|| plant_place.clone(), |table| table.place.clone());
        let mut settings = Settings {
            machine: plant.machine.take().unwrap_or_else(|| Table::empty(plant_place.clone())),
            compatibility: plant.compatibility.take().unwrap_or_else(|| Table::empty(plant_place.clone())),
            control: plant.control.take().unwrap_or_else(|| Table::empty(plant_place.clone())),
        };
        let opened = configuration.open(
            &Site {
                names_axis: &|name| plant.axes.contains_key(name),
                encoders: &|name| encoders(&plant, name),
                intelligent: &|name| plant.axes.get(name).is_some_and(|axis| axis.drive.intelligent),
                cam: &|name| cam_place(&plant, name),
            },
            &mut settings,
            options.profile,
        )?;
        settings.machine.finish()?;
        settings.compatibility.finish()?;
        settings.control.finish()?;
        let Opened { control, names, axes, groupings, findings } = opened;
        plant.rename(|name| {
            let axis = names.axes.iter().all(|(_, other)| other.as_deref() != Some(name)).then(|| names.axis(name));
            axis.flatten().and_then(|axis| names.axes[axis].clone())
        });
        let named_in = names.interface().tables().named_in;
        plant.check(&configuration.axis_names(), named_in, configuration.groupings()).map_err(|problem| {
            match configuration.not_used() {
                Some((reason, cure)) => Problem { what: format!("{}; {reason}", problem.what), cure, ..problem },
                None => problem,
            }
        })?;
        check_cycle_times(control.cycle_times(), control.texts().cycle_data())?;
        let memory = match &options.preset {
            Some(preset) => Memory::from_preset(preset, &names, control.override_coding())?,
            None => Memory::after_power_on(&names, control.override_coding()),
        };
        check_plc_cycle(plant.plc_cycle, &*control, &machine_place)?;
        check_delay("to_nck_delay", plant.to_nck_delay, &*control, &machine_place)?;
        check_delay("from_nck_delay", plant.from_nck_delay, &*control, &machine_place)?;
        let hints = PerAxis::from_fn(|axis| Hints {
            exists: axes[axis].exists,
            cam_direction: axes[axis].cam_direction,
            cam_is_fixed: axes[axis].cam_is_fixed,
            zero_mark_spacing: axes[axis].zero_mark_spacing,
            encoders: axes[axis].encoders.map(|model| match model {
                EncoderModel::Incremental => EncoderKind::Incremental,
                EncoderModel::Absolute => EncoderKind::Absolute,
                EncoderModel::DistanceCoded => EncoderKind::DistanceCoded,
            }),
            zero_mark_code: axes[axis].zero_mark_code,
        });
        let layout = Layout::new(&plant, &names.axes, &hints, &groupings);
        let definition = Definition {
            plc: plant.plc,
            plc_cycle: plant.plc_cycle,
            delays: [plant.to_nck_delay, plant.from_nck_delay],
            unwired: unwired(&layout, &names),
            layout,
            names,
            memory: memory.clone(),
            control: control.clone_box(),
            fingerprints: OnceLock::new(),
            warnings: warning(&findings, &plant_place, options.scenario.as_deref()).into_iter().collect(),
            findings,
        };
        Ok(assemble(definition, control, memory))
    }
}

/// The findings in one line, with the command that lists them. `plant` is the place of `plant.toml`, or of the machine if it has none. The
/// command names the scenario where findings come from it, or where the machine is a built-in one.
fn warning(findings: &[Finding], plant: &Place, scenario: Option<&Path>) -> Option<String> {
    let counts = summary(findings)?;
    let file = Path::new(&*plant.file);
    let machine = if file.ends_with("plant.toml") { file.parent() } else { Some(file) };
    let machine = machine.filter(|machine| machine.exists());
    let is_of_scenario = |scenario: &Path| {
        let mut places = findings.iter().filter_map(|finding| finding.place.as_ref());
        places.any(|place| Path::new(&*place.file) == scenario)
    };
    let scenario = scenario.filter(|scenario| machine.is_none() || is_of_scenario(scenario));
    Some(scenario.or(machine).map(Path::display).map_or_else(
        || format!("machine data: {counts}"),
        |machine| format!("machine data of {machine}: {counts}; `opennck machine-data check {machine}` lists them"),
    ))
}

fn cam_place(plant: &PlantDefinition, axis: &str) -> Option<Place> {
    let axis = plant.axes.get(axis).filter(|axis| matches!(axis.cam, Given::Said(_)))?;
    axis.cam_place.clone()
}

fn encoders(plant: &PlantDefinition, axis: &str) -> [Option<EncoderModel>; 2] {
    let model = |kind| match kind {
        EncoderKind::Incremental => EncoderModel::Incremental,
        EncoderKind::Absolute => EncoderModel::Absolute,
        EncoderKind::DistanceCoded => EncoderModel::DistanceCoded,
    };
    plant.axes.get(axis).map_or([None; 2], |axis| axis.encoders.map(|encoder| encoder.kind.map(model)))
}

fn assemble(definition: Definition, control: Box<dyn Control>, memory: Memory) -> Machine {
    let before = Before::new(&memory);
    let (to_nck, from_nck) = definition.delays(control.cycle_times().interpolation, &memory);
    let state = State {
        cycle: 0,
        time: Time::ZERO,
        memory,
        to_nck,
        from_nck,
        variables: Variables::default(),
        plant: Plant::new(&definition.layout),
        feedback: PerAxis::default(),
        plc: PlcState::default(),
        forces: Vec::new(),
        queue: Vec::new(),
        displaced: Vec::new(),
        recorded: EventId::NONE,
    };
    let mut machine = Machine {
        definition: Arc::new(definition),
        control,
        program: None,
        state,
        before,
        alarms_before: Vec::with_capacity(Alarms::CAPACITY),
        recorder: Recorder::default(),
    };
    machine.sense(AxisSet::ALL);
    machine.state.variables = first_variables(&machine.state.feedback, machine.control.r_parameters());
    machine
}

/// The signals that the simulator itself sets, because their switches are not wired to an input: cams, then limit
/// switches.
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

/// Without a cycle time, simulated time would stand still; without position control, no axis would move.
fn check_cycle_times(times: CycleTimes, cycle_data: &str) -> Result<(), Problem> {
    let CycleTimes { interpolation, position_control } = times;
    if interpolation <= Time::ZERO {
        let what = format!("expected an interpolation cycle of more than 0 s, found {interpolation} s");
        return Err(Problem::new(what, format!("change {cycle_data}")));
    }
    if position_control == 0 {
        let what = "expected at least one position-control cycle in an interpolation cycle, found 0";
        return Err(Problem::new(what, format!("change {cycle_data}")));
    }
    Ok(())
}

fn check_delay(name: &str, delay: Time, control: &dyn Control, place: &Place) -> Result<(), Problem> {
    let cycle = control.cycle_times().interpolation;
    if delay.nanos() % cycle.nanos() != 0 || delay > cycle.times(MOST_CYCLES) {
        return Err(place.problem(
            format!(
                "expected {name} to be whole NC cycles of {cycle} s, at most {MOST_CYCLES} of them, found {delay} s"
            ),
            format!("change [machine] {name}, or {}", control.texts().cycle_data()),
        ));
    }
    Ok(())
}

fn check_plc_cycle(plc_cycle: Option<Time>, control: &dyn Control, place: &Place) -> Result<(), Problem> {
    let cycle = control.cycle_times().interpolation;
    match plc_cycle {
        Some(plc) if plc.nanos() % cycle.nanos() != 0 || plc < cycle => Err(place.problem(
            format!("expected plc_cycle to be a whole multiple of the NC cycle of {cycle} s, found {plc} s"),
            format!("change [machine] plc_cycle, or {}", control.texts().cycle_data()),
        )),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_control_without_a_cycle_or_without_position_control_is_refused() {
        let check = |interpolation, position_control| {
            check_cycle_times(CycleTimes { interpolation, position_control }, "the cycle of the platform")
        };
        let refused = |times: Result<(), Problem>| times.unwrap_err().to_string();
        assert!(check(Time::from_millis(4), 1).is_ok());
        assert!(refused(check(Time::ZERO, 1)).contains("an interpolation cycle of more than 0 s, found 0"));
        let motionless = refused(check(Time::from_millis(4), 0));
        assert!(motionless.contains("at least one position-control cycle"), "{motionless}");
        assert!(motionless.contains("change the cycle of the platform"), "{motionless}");
    }
}
