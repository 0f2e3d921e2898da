//! The plant of one machine, with all defaults filled in.

use super::{Cam, EncoderKind, Given, HoldingBrake, Input, Leadscrew, LimitSwitch, PlantDefinition, Switch};
use crate::motion::Encoder;
use crate::units::{AxisNumber, AxisSet, PerAxis, Position, Time};

/// Data that determine defaults.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hints {
    /// The axis exists.
    pub exists: bool,
    /// Direction of the cam search, −1 or +1; 0 for an axis without cam (MD34000).
    pub cam_direction: i8,
    /// The default cam begins midway between two zero marks of encoder 1, wherever the slide starts.
    pub cam_is_fixed: bool,
    /// Distance of the zero marks of both encoders, used if `plant.toml` does not give it.
    pub zero_mark_spacing: [Position; 2],
    /// The types of both encoders, used if `plant.toml` does not give them.
    pub encoders: [EncoderKind; 2],
    /// The code of distance-coded marks: by how much the mark between two fixed ones moves on, and whether the scale counts against the axis.
    pub zero_mark_code: [(Position, bool); 2],
}

/// The simulated mechanics of one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisMechanics {
    /// Position of the slide at first power on.
    pub start: Position,
    /// The speed loop as PT1, in seconds.
    pub time_constant: f64,
    /// Start-up time of the drive after power on.
    pub ready_after: Time,
    /// Both encoders.
    pub encoders: [Encoder; 2],
    /// The drive reacts and homes by itself: with a fault it follows the control as long as the control commands it.
    pub intelligent: bool,
    /// The weight of the slide pulls in minus direction.
    pub gravity: bool,
    /// The holding brake of the motor.
    pub brake: Option<HoldingBrake>,
    /// The leadscrew between motor and slide.
    pub leadscrew: Leadscrew,
    /// Reference cam.
    pub cam: Option<Cam>,
    /// Hardware limit switch plus.
    pub limit_plus: Option<LimitSwitch>,
    /// Hardware limit switch minus.
    pub limit_minus: Option<LimitSwitch>,
}

/// A bridge: the mechanical coupling of slides.
#[derive(Clone, Debug, PartialEq)]
pub struct SlideCoupling {
    /// The first slide, to which the others are offset.
    pub first: AxisNumber,
    /// The others, with their offset to the first when unstrained.
    pub others: Vec<(AxisNumber, Position)>,
    /// Share of a difference that the mechanics remove per second; 1 is rigid.
    pub stiffness: f64,
}

/// All axes and bridges of a machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// The existing axes.
    pub axes: PerAxis<Option<AxisMechanics>>,
    /// The bridges.
    pub bridges: Vec<SlideCoupling>,
    /// Switches that are inputs of the PLC.
    pub wired: Vec<(AxisNumber, Switch, Input)>,
    /// Axes with gravity or a brake: their mechanics can change while the control does nothing.
    pub vertical: AxisSet,
    /// Axes for which the simulator itself sets the signals of cam, plus switch and minus switch.
    pub unwired: [AxisSet; 3],
}

/// Distance of the default cam from the start position, and of a fixed one from position 0.
const DEFAULT_CAM_DISTANCE: f64 = 100.0;
const FIXED_CAM_DISTANCE: f64 = 105.0;
/// Length of the default cam; long enough that no slide starts behind it.
const DEFAULT_CAM_LENGTH: f64 = 100_000.0;

impl Layout {
    /// Fills in defaults. `groupings` contains number and axes of each grouping, the leading axis first.
    #[must_use]
    pub fn new(
        definition: &PlantDefinition,
        names: &PerAxis<Option<String>>,
        hints: &PerAxis<Hints>,
        groupings: &[(u8, Vec<AxisNumber>)],
    ) -> Self {
        let axes = PerAxis::from_fn(|number| {
            let name = names[number].as_deref().filter(|_| hints[number].exists)?;
            Some(axis_mechanics(definition, name, hints[number]))
        });
        let bridges = groupings
            .iter()
            .filter_map(|(number, members)| {
                let bridge = definition.bridges.get(number)?;
                let (&first, others) = members.split_first()?;
                let offset = |axis: AxisNumber| {
                    let name = names[axis].as_deref().unwrap_or_default();
                    // The default offset is the one that the slides have at first power on.
                    bridge.offset.get(name).copied().unwrap_or_else(|| start(&axes, axis) - start(&axes, first))
                };
                let others = others.iter().map(|&axis| (axis, offset(axis))).collect();
                Some(SlideCoupling { first, others, stiffness: bridge.stiffness })
            })
            .collect();
        let (wired, unwired) = wires(&axes);
        let is_vertical = |axis: &AxisMechanics| axis.gravity || axis.brake.is_some();
        let vertical = axes.iter().filter(|(_, axis)| axis.as_ref().is_some_and(is_vertical));
        let vertical = vertical.map(|(number, _)| number).collect();
        Self { axes, bridges, wired, vertical, unwired }
    }

    /// These axes, and all axes that share a bridge with one of them.
    #[must_use]
    pub fn with_bridged(&self, axes: AxisSet) -> AxisSet {
        self.bridges.iter().fold(axes, |all, bridge| {
            let members =
                bridge.others.iter().fold(AxisSet::of(bridge.first), |set, (axis, _)| set.with(AxisSet::of(*axis)));
            if axes.and(members).is_empty() { all } else { all.with(members) }
        })
    }
}

/// The existing switches and their inputs.
fn wires(axes: &PerAxis<Option<AxisMechanics>>) -> (Vec<(AxisNumber, Switch, Input)>, [AxisSet; 3]) {
    let (mut wired, mut unwired) = (Vec::new(), [AxisSet::NONE; 3]);
    for (axis, mechanics) in axes.iter() {
        let Some(mechanics) = mechanics else { continue };
        let switches = [
            (Switch::Cam, mechanics.cam.as_ref().map(|cam| cam.input)),
            (Switch::LimitPlus, mechanics.limit_plus.as_ref().map(|limit| limit.input)),
            (Switch::LimitMinus, mechanics.limit_minus.as_ref().map(|limit| limit.input)),
        ];
        for (switch, input) in switches {
            match input {
                Some(Some(input)) => wired.push((axis, switch, input)),
                Some(None) => unwired[switch as usize].set(axis, true),
                None => {}
            }
        }
    }
    (wired, unwired)
}

fn start(axes: &PerAxis<Option<AxisMechanics>>, axis: AxisNumber) -> Position {
    axes[axis].as_ref().map_or(Position::ZERO, |mechanics| mechanics.start)
}

fn axis_mechanics(definition: &PlantDefinition, name: &str, hints: Hints) -> AxisMechanics {
    let default = super::AxisPlant::new(crate::source::Place::file("defaults"));
    let said = definition.axes.get(name).unwrap_or(&default);
    let encoders = [0, 1].map(|index| {
        let encoder = &said.encoders[index];
        let spacing = encoder.zero_mark_spacing.unwrap_or(hints.zero_mark_spacing[index]);
        let new = Encoder::new(encoder.resolution, encoder.zero_mark, spacing, said.start);
        let (shift, inverted) = hints.zero_mark_code[index];
        let kind = if said.homed && index == 0 { Some(EncoderKind::Absolute) } else { encoder.kind };
        match kind.unwrap_or(hints.encoders[index]) {
            EncoderKind::Incremental => new,
            EncoderKind::Absolute => new.absolute(encoder.zero),
            EncoderKind::DistanceCoded => {
                new.distance_coded(encoder.zero_mark_shift.unwrap_or(shift), encoder.inverted.unwrap_or(inverted))
            }
        }
    });
    let cam = match &said.cam {
        Given::Said(cam) => Some(*cam),
        Given::Removed => None,
        Given::Unsaid => {
            let spacing = said.encoders[0].zero_mark_spacing.unwrap_or(hints.zero_mark_spacing[0]);
            let near = if hints.cam_is_fixed {
                between_marks(said.encoders[0].zero_mark, spacing, hints.cam_direction)
            } else {
                said.start + Position::from_user(f64::from(hints.cam_direction) * DEFAULT_CAM_DISTANCE)
            };
            default_cam(near, hints.cam_direction)
        }
    };
    AxisMechanics {
        start: said.start,
        time_constant: said.drive.time_constant.seconds(),
        ready_after: said.drive.ready_after,
        encoders,
        intelligent: said.drive.intelligent,
        gravity: said.gravity,
        brake: said.brake,
        leadscrew: said.leadscrew.clone(),
        cam,
        limit_plus: switch(&said.limit_plus),
        limit_minus: switch(&said.limit_minus),
    }
}

fn switch(given: &Given<LimitSwitch>) -> Option<LimitSwitch> {
    match given {
        Given::Said(switch) => Some(*switch),
        Given::Removed | Given::Unsaid => None,
    }
}

/// The place midway between two zero marks that is nearest to the usual distance of a cam.
fn between_marks(mark: Position, spacing: Position, direction: i8) -> Position {
    let spacing = spacing.max(Position::new(1)).increments();
    let wanted = Position::from_user(f64::from(direction) * FIXED_CAM_DISTANCE);
    let marks = (wanted - mark).increments().div_euclid(spacing);
    mark + Position::new(marks * spacing + spacing / 2)
}

/// A long cam that begins here and reaches away from the start.
fn default_cam(near: Position, direction: i8) -> Option<Cam> {
    let length = Position::from_user(DEFAULT_CAM_LENGTH);
    match direction {
        0 => None,
        1.. => Some(Cam { from: near, to: near + length, input: None }),
        _ => Some(Cam { from: near - length, to: near, input: None }),
    }
}
