//! The contents of `plant.toml`: the simulated mechanics. The machine reads the file once, before anything runs. A
//! scenario may first merge its own `[plant.XF]` tables over it.
//!
//! Lengths are in millimetres, angles in degrees, times have a unit. Positions are machine-frame coordinates: they
//! belong to the mechanics and do not change when an axis is referenced. A value that depends on machine data stays
//! undefined here if the file does not give it ([`Given::Unsaid`], `None`). All other values have a default.

use std::collections::BTreeMap;

use super::hold::{HoldingBrake, holding_brake};
use super::leadscrew::{Leadscrew, leadscrew};
use super::reading::{distance, position, time};
use crate::source::{Node, Place, Problem, Table, Value, did_you_mean};
use crate::units::{Position, Time};

/// The simulated mechanics of a machine.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlantDefinition {
    /// Time between two PLC scans; `None` means the NC cycle.
    pub plc_cycle: Option<Time>,
    /// The PLC program of the machine: a registered name, or with a `/` a folder beside the file; and where this is written.
    pub plc: Option<(String, Place)>,
    /// How late the PLC's half of the interface reaches the control (O-28).
    pub to_nck_delay: Time,
    /// How late the control's half reaches the PLC program (O-28).
    pub from_nck_delay: Time,
    /// The other keys of `[machine]`: they belong to the control.
    pub machine: Option<Table>,
    /// The keys of `[compatibility]`: they belong to the control.
    pub compatibility: Option<Table>,
    /// The keys of `[control]`: they belong to the control.
    pub control: Option<Table>,
    /// The axes by machine axis name.
    pub axes: BTreeMap<String, AxisPlant>,
    /// The bridges by gantry grouping.
    pub bridges: BTreeMap<u8, Bridge>,
}

/// A value that a file may give, remove with `false`, or omit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Given<T> {
    /// Omitted; machine data decide.
    #[default]
    Unsaid,
    /// Removed with `cam = false`.
    Removed,
    /// This value.
    Said(T),
}

/// The simulated mechanics of one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisPlant {
    /// Place of its table in the file.
    pub place: Place,
    /// Position of the slide at power on.
    pub start: Position,
    /// It is homed at power on, as with an adjusted absolute encoder.
    pub homed: bool,
    /// The drive.
    pub drive: Drive,
    /// Encoder 1 and encoder 2.
    pub encoders: [EncoderPlant; 2],
    /// The weight of the slide pulls in minus direction.
    pub gravity: bool,
    /// The holding brake of the motor.
    pub brake: Option<HoldingBrake>,
    /// The leadscrew between motor and slide.
    pub leadscrew: Leadscrew,
    /// The reference cam.
    pub cam: Given<Cam>,
    /// Place of the reference cam in the file, if the file gives it.
    pub cam_place: Option<Place>,
    /// The hardware limit switch in plus direction.
    pub limit_plus: Given<LimitSwitch>,
    /// The hardware limit switch in minus direction.
    pub limit_minus: Given<LimitSwitch>,
}

/// A drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Drive {
    /// Time constant of the real speed loop; default 3 ms.
    pub time_constant: Time,
    /// Delay of each step of the start-up chain (O-20); default 20 ms.
    pub ready_after: Time,
    /// A drive on a bus that reports a status of its own (E-23).
    pub intelligent: bool,
}

impl Default for Drive {
    fn default() -> Self {
        Self { time_constant: Time::from_millis(3), ready_after: Time::from_millis(20), intelligent: false }
    }
}

/// An encoder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EncoderPlant {
    /// Its type; `None`: as defined by MD30240 and MD34200.
    pub kind: Option<EncoderKind>,
    /// Machine-frame position at which an absolute encoder reads zero.
    pub zero: Position,
    /// Machine-frame position of one zero mark; of distance-coded marks, the first.
    pub zero_mark: Position,
    /// Distance between two zero marks; of distance-coded marks, between two fixed ones. `None`: as defined by machine data.
    pub zero_mark_spacing: Option<Position>,
    /// By this distance the mark between two fixed ones moves on; `None`: as defined by machine data.
    pub zero_mark_shift: Option<Position>,
    /// Whether distance-coded marks count against the axis; `None`: as defined by machine data.
    pub inverted: Option<bool>,
    /// The smallest step that it detects; default 0.0001 mm or degrees.
    pub resolution: Position,
}

impl Default for EncoderPlant {
    fn default() -> Self {
        Self {
            kind: None,
            zero: Position::ZERO,
            zero_mark: Position::ZERO,
            zero_mark_spacing: None,
            zero_mark_shift: None,
            inverted: None,
            resolution: Position::new(100),
        }
    }
}

/// The type of an encoder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EncoderKind {
    /// Incremental with equidistant zero marks; the position is lost without power.
    #[default]
    Incremental,
    /// Absolute: its position is always known.
    Absolute,
    /// Distance-coded: the distances of the zero marks give the position.
    DistanceCoded,
}

/// A reference cam: a closed interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cam {
    /// Its lower end.
    pub from: Position,
    /// Its upper end.
    pub to: Position,
    /// The input to which its switch is wired; without it DBX12.7 is set after the PLC scan.
    pub input: Option<Input>,
}

/// A hardware limit switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LimitSwitch {
    /// Switching position.
    pub at: Position,
    /// The input to which it is wired; without it DBX12.1 or DBX12.0 is set after the PLC scan.
    pub input: Option<Input>,
}

/// An input of the PLC, `I3.4`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Input {
    /// The byte.
    pub byte: u16,
    /// The bit, 0 to 7.
    pub bit: u8,
}

/// The mechanical coupling of the slides of a grouping.
#[derive(Clone, Debug, PartialEq)]
pub struct Bridge {
    /// Place of its table in the file.
    pub place: Place,
    /// Position of a synchronous slide minus position of the leading slide, when unstrained.
    pub offset: BTreeMap<String, Position>,
    /// 0: the slides move freely; 1: rigid; between: share of a difference that the mechanics remove per second.
    pub stiffness: f64,
}

impl AxisPlant {
    /// An axis with all values at their defaults.
    #[must_use]
    pub fn new(place: Place) -> Self {
        Self {
            place,
            start: Position::ZERO,
            homed: false,
            drive: Drive::default(),
            encoders: [EncoderPlant::default(); 2],
            gravity: false,
            brake: None,
            leadscrew: Leadscrew::default(),
            cam: Given::Unsaid,
            cam_place: None,
            limit_plus: Given::Unsaid,
            limit_minus: Given::Unsaid,
        }
    }
}

impl PlantDefinition {
    /// Reads the text of a `plant.toml`.
    ///
    /// # Errors
    /// The first part that cannot be read, with file and line.
    pub fn parse(text: &str, file: &str) -> Result<Self, Problem> {
        Self::read(Table::parse(text, file)?)
    }

    /// Reads a tree into which a scenario may have merged its own tables.
    ///
    /// # Errors
    /// The first part that cannot be read, with file and line.
    pub fn read(mut table: Table) -> Result<Self, Problem> {
        let mut plant = Self::default();
        if let Some(node) = table.take("machine") {
            let mut machine = node.into_table("the table [machine]")?;
            plant.plc_cycle = machine.take("plc_cycle").map(|node| plc_cycle(&node)).transpose()?;
            if let Some(node) = machine.take("plc") {
                plant.plc = Some((node.text("the name of a PLC program")?.to_owned(), node.place.clone()));
            }
            for (key, delay) in
                [("to_nck_delay", &mut plant.to_nck_delay), ("from_nck_delay", &mut plant.from_nck_delay)]
            {
                if let Some(node) = machine.take(key) {
                    *delay = time(&node)?;
                }
            }
            plant.machine = Some(machine);
        }
        if let Some(node) = table.take("compatibility") {
            plant.compatibility = Some(node.into_table("the table [compatibility]")?);
        }
        if let Some(node) = table.take("control") {
            plant.control = Some(node.into_table("the table [control]")?);
        }
        if let Some(node) = table.take("bridge") {
            for (grouping, place, node) in node.into_table("tables such as [bridge.1]")?.take_rest() {
                let number = grouping.parse().ok().filter(|number| *number >= 1).ok_or_else(|| {
                    place.problem(
                        format!("expected the number of a gantry grouping, from 1, found `{grouping}`"),
                        "write [bridge.1]",
                    )
                })?;
                plant.bridges.insert(number, bridge(node)?);
            }
        }
        for (name, place, node) in table.take_rest() {
            let what = format!("a table [{name}] for the machine axis `{name}`");
            let known = ["machine", "bridge", "compatibility", "control"];
            let table = node
                .into_table(&what)
                .map_err(|problem| Problem { cure: did_you_mean(&name, known, &problem.cure), ..problem })?;
            plant.axes.insert(name, axis(table, place)?);
        }
        Ok(plant)
    }

    /// Gives axes another name where there is one.
    pub fn rename(&mut self, other: impl Fn(&str) -> Option<String>) {
        let axes = std::mem::take(&mut self.axes);
        self.axes = axes.into_iter().map(|(name, axis)| (other(&name).unwrap_or(name), axis)).collect();
        for bridge in self.bridges.values_mut() {
            let offsets = std::mem::take(&mut bridge.offset);
            bridge.offset = offsets.into_iter().map(|(name, offset)| (other(&name).unwrap_or(name), offset)).collect();
        }
    }

    /// Checks every axis name against the names of the machine axes (exact case), and every bridge against the largest number of a gantry
    /// grouping. `named_in` are the data of the control that name its axes, for the error.
    ///
    /// # Errors
    /// The first name that is not a machine axis, with its place and the nearest name, or the first bridge without a possible grouping.
    pub fn check(&self, names: &[&str], named_in: &str, groupings: u8) -> Result<(), Problem> {
        let axes = self.axes.iter().map(|(name, axis)| (name, &axis.place));
        let bridges = self.bridges.values().flat_map(|bridge| bridge.offset.keys().map(|name| (name, &bridge.place)));
        for (name, place) in axes.chain(bridges) {
            if !names.contains(&name.as_str()) {
                let fallback = format!("the machine axes are `{}`", names.join("`, `"));
                return Err(place.problem(
                    format!("expected the name of a machine axis ({named_in}), found `{name}`"),
                    did_you_mean(name, names.iter().copied(), &fallback),
                ));
            }
        }
        match self.bridges.iter().find(|(number, _)| **number > groupings) {
            None => Ok(()),
            Some((number, bridge)) if groupings == 0 => Err(bridge.place.problem(
                format!("expected no [bridge.{number}], because this control has no gantry groupings"),
                "remove it",
            )),
            Some((number, bridge)) => Err(bridge.place.problem(
                format!("expected the number of a gantry grouping, 1 to {groupings}, found `{number}`"),
                "write [bridge.1]",
            )),
        }
    }
}

fn axis(mut table: Table, place: Place) -> Result<AxisPlant, Problem> {
    let mut plant = AxisPlant::new(place);
    if let Some(node) = table.take("start") {
        plant.start = position(&node, "the position of the slide in mm or degrees")?;
    }
    if let Some(node) = table.take("homed") {
        plant.homed = node.boolean("whether the axis is homed at power on")?;
    }
    if let Some(node) = table.take("drive") {
        plant.drive = drive(node)?;
    }
    for (key, encoder) in ["encoder1", "encoder2"].into_iter().zip(&mut plant.encoders) {
        if let Some(node) = table.take(key) {
            *encoder = read_encoder(node)?;
        }
    }
    if let Some(node) = table.take("gravity") {
        plant.gravity = node.boolean("whether the weight of the slide pulls in minus direction")?;
    }
    if let Some(node) = table.take("brake") {
        plant.brake = holding_brake(node)?;
    }
    if let Some(node) = table.take("leadscrew") {
        plant.leadscrew = leadscrew(node.into_table("a leadscrew")?)?;
    }
    let node = table.take("cam");
    plant.cam_place = node.as_ref().map(|node| node.place.clone());
    plant.cam = given(node, "a reference cam", cam)?;
    plant.limit_plus = given(table.take("limit_plus"), "a limit switch", limit_switch)?;
    plant.limit_minus = given(table.take("limit_minus"), "a limit switch", limit_switch)?;
    table.finish()?;
    if let (Given::Said(minus), Given::Said(plus)) = (plant.limit_minus, plant.limit_plus)
        && minus.at >= plus.at
    {
        return Err(plant.place.problem(
            format!("expected limit_plus above limit_minus = {}, found {}", minus.at, plus.at),
            "exchange the two values",
        ));
    }
    Ok(plant)
}

fn drive(node: Node) -> Result<Drive, Problem> {
    let mut table = node.into_table("a drive")?;
    let mut drive = Drive::default();
    if let Some(node) = table.take("time_constant") {
        drive.time_constant = time(&node)?;
    }
    if let Some(node) = table.take("ready_after") {
        drive.ready_after = time(&node)?;
    }
    if let Some(node) = table.take("intelligent") {
        drive.intelligent = node.boolean("whether the drive is intelligent")?;
    }
    table.finish()?;
    Ok(drive)
}

fn read_encoder(node: Node) -> Result<EncoderPlant, Problem> {
    let mut table = node.into_table("an encoder")?;
    let mut encoder = EncoderPlant::default();
    if let Some(node) = table.take("kind") {
        let kinds = [
            ("incremental", EncoderKind::Incremental),
            ("absolute", EncoderKind::Absolute),
            ("distance_coded", EncoderKind::DistanceCoded),
        ];
        encoder.kind = Some(node.one_of(&kinds)?);
    }
    if let Some(node) = table.take("zero") {
        encoder.zero = position(&node, "the position of the zero of an absolute encoder in mm or degrees")?;
    }
    if let Some(node) = table.take("zero_mark") {
        encoder.zero_mark = position(&node, "the position of a zero mark in mm or degrees")?;
    }
    if let Some(node) = table.take("zero_mark_spacing") {
        encoder.zero_mark_spacing = Some(distance(&node, "a spacing of more than 0 mm or degrees")?);
    }
    if let Some(node) = table.take("zero_mark_shift") {
        encoder.zero_mark_shift = Some(distance(&node, "a shift of more than 0 mm or degrees")?);
    }
    if let Some(node) = table.take("inverted") {
        encoder.inverted = Some(node.boolean("whether the scale counts against the axis")?);
    }
    if let Some(node) = table.take("resolution") {
        encoder.resolution = distance(&node, "a resolution of at least 0.000001 mm or degrees")?;
    }
    table.finish()?;
    Ok(encoder)
}

fn cam(mut table: Table) -> Result<Cam, Problem> {
    let from = required(&mut table, "from", "a cam")?;
    let to = required(&mut table, "to", "a cam")?;
    let input = table.take("input").map(|node| input(&node)).transpose()?;
    table.finish()?;
    if from > to {
        return Err(table.place.problem(
            format!("expected a cam with `from` at most `to`, found {from} and {to}"),
            "exchange the two values",
        ));
    }
    Ok(Cam { from, to, input })
}

fn limit_switch(mut table: Table) -> Result<LimitSwitch, Problem> {
    let at = required(&mut table, "at", "a limit switch")?;
    let input = table.take("input").map(|node| input(&node)).transpose()?;
    table.finish()?;
    Ok(LimitSwitch { at, input })
}

fn bridge(node: Node) -> Result<Bridge, Problem> {
    let mut table = node.into_table("a bridge")?;
    let mut bridge = Bridge { place: table.place.clone(), offset: BTreeMap::new(), stiffness: 0.0 };
    if let Some(node) = table.take("offset") {
        for (name, _, node) in node.into_table("offsets such as { XF = 0.0 }")?.take_rest() {
            bridge.offset.insert(name, position(&node, "an offset in mm or degrees")?);
        }
    }
    if let Some(node) = table.take("stiffness") {
        bridge.stiffness = node.number("a stiffness from 0 to 1")?;
        if !(0.0..=1.0).contains(&bridge.stiffness) {
            return Err(node.expected("a stiffness from 0 to 1", "0 moves freely, 1 is rigid"));
        }
    }
    table.finish()?;
    Ok(bridge)
}

/// A part that `false` removes.
fn given<T>(
    node: Option<Node>,
    what: &str,
    read: impl FnOnce(Table) -> Result<T, Problem>,
) -> Result<Given<T>, Problem> {
    match node {
        None => Ok(Given::Unsaid),
        Some(Node { value: Value::Boolean(false), .. }) => Ok(Given::Removed),
        Some(node) => node.into_table(&format!("{what}, or false")).and_then(read).map(Given::Said),
    }
}

fn required(table: &mut Table, key: &'static str, of: &str) -> Result<Position, Problem> {
    let node = table.take(key).ok_or_else(|| {
        table.place.problem(format!("expected `{key}` of {of}, found none"), format!("write {key} = 200.0"))
    })?;
    position(&node, "a position in mm or degrees")
}

fn plc_cycle(node: &Node) -> Result<Time, Problem> {
    let cycle = time(node)?;
    if cycle == Time::ZERO {
        return Err(node.expected("a PLC cycle of more than 0", "a whole multiple of the NC cycle"));
    }
    Ok(cycle)
}

fn input(node: &Node) -> Result<Input, Problem> {
    let what = "an input such as \"I3.4\"";
    let input = node.text(what)?.strip_prefix('I').and_then(|rest| {
        let (byte, bit) = rest.split_once('.')?;
        let digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
        let input = Input { byte: byte.parse().ok()?, bit: bit.parse().ok()? };
        (digits(byte) && digits(bit) && input.bit < 8).then_some(input)
    });
    input.ok_or_else(|| node.expected(what, "the letter I, the byte, a point, a bit from 0 to 7"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXAMPLE: &str = r#"
[machine]
plc_cycle = "10ms"
to_nck_delay = "4ms"
from_nck_delay = "2ms"
db11_5_2 = "mirror"
[X]
start = 120.0
[X.drive]
time_constant = "3ms"
ready_after = "20ms"
[X.encoder1]
kind = "incremental"
zero_mark = 0.300
zero_mark_spacing = 10.0
resolution = 0.0001
[X.cam]
from = 200.0
to = 260.0
input = "I3.4"
[X.limit_plus]
at = 980.0
[bridge.1]
offset = { XF = 0.5 }
stiffness = 0.25
"#;

    fn refused(text: &str) -> String {
        PlantDefinition::parse(text, "plant.toml").unwrap_err().to_string()
    }

    #[test]
    fn a_plant_is_read_as_written() {
        let plant = PlantDefinition::parse(EXAMPLE, "plant.toml").unwrap();
        assert_eq!(plant.plc_cycle, Some(Time::from_millis(10)));
        assert_eq!([plant.to_nck_delay, plant.from_nck_delay], [4, 2].map(Time::from_millis));
        // The key belongs to the control.
        assert_eq!(plant.machine.unwrap().keys().collect::<Vec<_>>(), ["db11_5_2"]);
        let x = &plant.axes["X"];
        assert_eq!((x.start, x.drive), (Position::from_user(120.0), Drive::default()));
        assert_eq!(x.encoders[0].kind, Some(EncoderKind::Incremental));
        assert_eq!(x.encoders[0].zero_mark, Position::new(300_000));
        assert_eq!(x.encoders[1], EncoderPlant::default());
        let Given::Said(cam) = x.cam else { panic!("{x:?}") };
        assert_eq!((cam.to, cam.input), (Position::from_user(260.0), Some(Input { byte: 3, bit: 4 })));
        assert_eq!(x.limit_minus, Given::Unsaid);
        assert_eq!(plant.bridges[&1].offset["XF"], Position::from_user(0.5));
    }

    #[test]
    fn a_scenario_replaces_values_and_removes_a_cam() {
        let mut table = Table::parse(EXAMPLE, "plant.toml").unwrap();
        table.merge(Table::parse("[X]\nstart = 1\ncam = false\n", "scenario.toml").unwrap());
        let plant = PlantDefinition::read(table).unwrap();
        assert_eq!((plant.axes["X"].start, plant.axes["X"].cam), (Position::from_user(1.0), Given::Removed));
        assert_eq!(plant.axes["X"].encoders[0].zero_mark, Position::new(300_000));
    }

    #[test]
    fn an_unknown_key_is_refused_with_its_line_and_the_nearest_name() {
        let message = refused("[X]\n[X.encoder1]\nzero_marc = 1\n");
        assert!(message.starts_with("plant.toml:3: ") && message.contains("did you mean `zero_mark`?"), "{message}");
        assert!(refused("machin = 1\n").contains("did you mean `machine`?"));
    }

    #[test]
    fn values_out_of_range_are_refused_with_their_line() {
        for text in [
            "[X.encoder1]\nresolution = 0",
            "[X.encoder1]\nzero_mark_spacing = -1",
            "[X.encoder1]\nkind = \"abs\"",
            "[X.drive]\ntime_constant = 3",
            "[X.drive]\ntime_constant = \"3\"",
            "[X.drive]\nready_after = \"2h\"",
            "[machine]\nplc_cycle = \"0ms\"",
            "[X.limit_plus]\nat = inf",
            "[X.limit_plus]\nat = 1e12",
            "[bridge.1]\nstiffness = 2",
            "[bridge]\n0 = { stiffness = 0 }",
            "[bridge]\n256 = { stiffness = 0 }",
            "[X.cam]\ninput = \"I3.8\"\nfrom = 1\nto = 2",
        ] {
            let message = refused(text);
            assert!(message.starts_with("plant.toml:2: expected "), "{message}");
        }
        assert!(refused("[X.cam]\nfrom = 3\nto = 2").contains("found 3.000 and 2.000"));
        assert!(refused("[X.cam]\nto = 2").contains("expected `from` of a cam"));
    }

    #[test]
    fn a_name_that_no_machine_axis_has_is_refused() {
        let plant = PlantDefinition::parse(EXAMPLE, "plant.toml").unwrap();
        assert!(plant.check(&["X", "Y", "XF"], "MD10000", 8).is_ok());
        let message = plant.check(&["Y", "XF"], "the list of drives", 8).unwrap_err().to_string();
        assert!(message.contains("(the list of drives), found `X`") && message.contains("plant.toml:7"), "{message}");
    }

    #[test]
    fn a_bridge_of_a_grouping_that_the_control_cannot_have_is_refused() {
        let plant = PlantDefinition::parse("[X]\n[bridge.9]\nstiffness = 0\n", "plant.toml").unwrap();
        assert!(plant.check(&["X"], "MD10000", 9).is_ok());
        let message = plant.check(&["X"], "MD10000", 8).unwrap_err().to_string();
        assert!(
            message.starts_with("plant.toml:2: expected the number of a gantry grouping, 1 to 8, found `9`"),
            "{message}"
        );
        let message = plant.check(&["X"], "the list of drives", 0).unwrap_err().to_string();
        assert!(message.contains("this control has no gantry groupings"), "{message}");
    }

    #[test]
    fn the_worked_examples_zero_marks_differ_by_its_misalignment() {
        let text = include_str!("../../machine_data/g1_example/plant.toml");
        let plant = PlantDefinition::parse(text, "plant.toml").unwrap();
        plant.check(&["X", "Y", "XF"], "MD10000", 8).unwrap();
        let (x, xf) = (&plant.axes["X"], &plant.axes["XF"]);
        let difference = xf.encoders[0].zero_mark - x.encoders[0].zero_mark;
        assert_eq!((difference, x.start - xf.start), (Position::from_user(0.941), Position::ZERO));
        assert_eq!(x.cam, xf.cam);
    }
}
