//! The control of these tests: a platform of 32 drives. A drive with power moves at a common speed while the platform is released.

use std::any::Any;
use std::mem::offset_of;

use serde::{Deserialize, Serialize};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use opennck::control::{
    AlarmRow, AxisHints, Changes, Chart, ClearInfo, Configuration, Control, ControlCommand, ControlSide, CycleTimes,
    Data, Datum, Kind, Log, Opened, Owner, PlcSide, Settings, Site, Taken, Texts, Transition, Value, next, row,
};
use opennck::image::{
    Block, BlockTable, ByteRange, Interface, Layout, Names, Numbering, OverrideCoding, Part, Profile, Tables,
    ValueTerms, View, Window,
};
use opennck::motion::{Feedback, Setpoint, velocity_command};
use opennck::signals;
use opennck::source::Problem;
use opennck::units::{AxisNumber, AxisSet, PerAxis, Position, Time};
use opennck::variables::{
    AlarmNumber, AxisValues, EventId, Events, Input, Parameter, Place, RaisedAlarm, Rule, RuleNumber, SignalBit,
    Variables,
};

signals! {
    /// Byte 0: commands of the PLC to the platform.
    pub struct PlatformToNck, platform_to_nck: Nck, Plc, 0 to 0;

    /// Release: 1 = drives may move.
    bool, release, set_release: 0, 0;
}

signals! {
    /// Bytes 2 to 6: status of the platform.
    pub struct PlatformFromNck, platform_from_nck: Nck, Nck, 2 to 6;

    /// Stopped: 1 = the PLC program is missing.
    bool, stopped, set_stopped: 6, 0;

    numbers {
        /// Cycle counter.
        u32, cycles, set_cycles: 2;
    }
}

signals! {
    /// Byte 4: commands of the PLC to a drive.
    pub struct DriveToNck, drive_to_nck: Axis, Plc, 4 to 4;

    /// Power: 1 = on.
    bool, power, set_power: 4, 7;
}

signals! {
    /// Byte 5: status of a drive.
    pub struct DriveFromNck, drive_from_nck: Axis, Nck, 5 to 5;

    /// Running: 1 = the drive moves its axis.
    bool, running, set_running: 5, 0;
}

#[derive(Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub(super) struct ToNck {
    pub(super) platform: PlatformToNck,
    pub(super) drives: [DriveToNck; 32],
    /// Byte 1 of the platform, and bytes 0 to 3 of each drive.
    plain: [u8; 1 + 4 * 32],
}

#[derive(Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub(super) struct FromNck {
    platform: PlatformFromNck,
    drives: [DriveFromNck; 32],
}

static OWN: Interface = Interface::new(Tables {
    name: "own",
    blocks: &[
        BlockTable {
            block: Block::Nck,
            count: 1,
            names: &["platform"],
            called: "the platform",
            apart: None,
            ranges: &[
                ByteRange::signals(0, 0, Part::ToNck, 0, 0),
                ByteRange::plain(1, 1, offset_of!(ToNck, plain), 0),
                ByteRange::signals(2, 6, Part::FromNck, 0, 0),
            ],
        },
        BlockTable {
            block: Block::Axis,
            count: 32,
            names: &[],
            called: "drive",
            apart: None,
            ranges: &[
                ByteRange::plain(0, 3, offset_of!(ToNck, plain) + 1, 4),
                ByteRange::signals(4, 4, Part::ToNck, offset_of!(ToNck, drives), 1),
                ByteRange::signals(5, 5, Part::FromNck, offset_of!(FromNck, drives), 1),
            ],
        },
    ],
    signals: &[PlatformToNck::SIGNALS, PlatformFromNck::SIGNALS, DriveToNck::SIGNALS, DriveFromNck::SIGNALS],
    to_nck: size_of::<ToNck>(),
    from_nck: size_of::<FromNck>(),
    hmi: 0,
    numberings: &[Numbering {
        name: "own",
        title: "the platform",
        number: 1,
        windows: &[Window::new(500, 0, 6, Block::Nck, 0, 1), Window::new(600, 0, 5, Block::Axis, 0, 32)],
        blocks: "DB500, DB600 to DB631",
        axes: "DB 599 + number of the drive",
    }],
    standard_blocks: &[],
    overrides: &[],
    switches: None,
    units: None,
    named_in: "the list of drives",
    example: "A1.power",
    values: ValueTerms::SINUMERIK,
});

/// The layout of the parts: the structures above.
#[derive(Debug)]
pub(super) struct Own;

impl Layout for Own {
    type ToNck = ToNck;
    type FromNck = FromNck;
    type Hmi = [u8];

    fn is_of(interface: &Interface) -> bool {
        *interface == OWN
    }
}

/// The cycle of the platform.
const CYCLE: Time = Time::from_millis(4);
/// Gain of position control in 1/s.
const GAIN: f64 = 16.0;

/// The state of a drive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
enum Phase {
    #[default]
    Off,
    Running,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Why {
    Started,
    Stopped,
    PlcMissing,
}

impl From<Why> for RuleNumber {
    fn from(why: Why) -> Self {
        Self(why as u16)
    }
}

const STEPS: &[Transition<Phase, Why>] =
    &[row(Phase::Off, Why::Started, Phase::Running), row(Phase::Running, Why::Stopped, Phase::Off)];

/// The state of the platform.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct State {
    log: Log,
    speed: f64,
    plc_missing: EventId,
    phases: PerAxis<Phase>,
    causes: PerAxis<EventId>,
    setpoints: PerAxis<Setpoint>,
    feedback: PerAxis<Feedback>,
}

/// The control.
#[derive(Clone, Debug)]
pub(super) struct Platform(State);

impl Platform {
    fn new(speed: f64, log: Log) -> Self {
        Self(State {
            log,
            speed,
            plc_missing: EventId::NONE,
            phases: PerAxis::default(),
            causes: PerAxis::default(),
            setpoints: PerAxis::default(),
            feedback: PerAxis::default(),
        })
    }

    fn start_or_stop(&mut self, axis: AxisNumber, power: bool, release: bool) {
        let state = &mut self.0;
        let runs = power && release && state.feedback[axis].drive_ready;
        if runs == (state.phases[axis] == Phase::Running) {
            return;
        }
        let why = if runs { Why::Started } else { Why::Stopped };
        state.phases[axis] = next(STEPS, &mut state.log.taken.0[0], state.phases[axis], why);
        let signal = drive_to_nck::power;
        let power = Input::Bit(SignalBit { place: Place::Axis(axis), byte: signal.byte, bit: signal.bit }, power);
        let inputs = [power, Input::Datum(1, None, state.speed), Input::None];
        state.causes[axis] = state.log.note(Place::Axis(axis), why, inputs, EventId::NONE);
    }
}

impl Control for Platform {
    fn check(&self, command: &ControlCommand) -> Result<(), Problem> {
        let ControlCommand::Store { target, value } = command else { return Ok(()) };
        match (target.as_str(), value.number()) {
            ("speed", Some(speed)) if speed >= 0.0 => Ok(()),
            ("speed", _) => {
                Err(Problem::new(format!("expected a speed of at least 0 mm/min, found {value}"), "write a number"))
            }
            _ => Err(Problem::new(format!("expected `speed`, found `{target}`"), "the platform has one parameter")),
        }
    }

    fn begin_cycle(&mut self, cycle: u64) {
        self.0.log.begin(cycle);
    }

    fn command(&mut self, command: &ControlCommand) -> EventId {
        match command {
            ControlCommand::Store { value, .. } => self.0.speed = value.number().unwrap_or(self.0.speed),
            ControlCommand::PlcMissing if !self.0.plc_missing.is_some() => {
                self.0.plc_missing = self.0.log.note_plain(Place::Nck, Why::PlcMissing, EventId::NONE);
            }
            ControlCommand::PlcRestarted => self.0.plc_missing = EventId::NONE,
            _ => {}
        }
        self.0.plc_missing
    }

    fn decide(&mut self, plc: PlcSide<'_>, _: Changes) {
        let to_nck = ToNck::of_bytes(plc.to_nck).unwrap();
        let release = to_nck.platform.release() && !self.0.plc_missing.is_some();
        for axis in AxisNumber::all() {
            self.start_or_stop(axis, to_nck.drives[axis.index()].power(), release);
            let velocity = if self.0.phases[axis] == Phase::Running { self.0.speed * 1e6 / 60.0 } else { 0.0 };
            self.0.setpoints[axis].run(velocity, 1e9, CYCLE.seconds());
        }
    }

    fn velocity_command(&mut self, axis: AxisNumber, counts: [Position; 2], _: u32, _: u32) -> Option<f64> {
        let setpoint = &self.0.setpoints[axis];
        let deviation = (setpoint.position - counts[0]).increments() as f64;
        self.0.feedback[axis].drive_ready.then(|| velocity_command(deviation, GAIN, Position::ZERO, 0.0))
    }

    fn observe(&mut self, feedback: &PerAxis<Feedback>, changed: AxisSet) {
        changed.iter().for_each(|axis| self.0.feedback[axis] = feedback[axis]);
    }

    fn publish(&mut self, out: ControlSide<'_>, variables: &mut Variables, _: AxisSet) {
        let from_nck = FromNck::of_bytes_mut(out.from_nck).unwrap();
        from_nck.platform.set_cycles(u32::try_from(self.0.log.cycle).unwrap());
        from_nck.platform.set_stopped(self.0.plc_missing.is_some());
        for axis in AxisNumber::all() {
            from_nck.drives[axis.index()].set_running(self.0.phases[axis] == Phase::Running);
            let position = self.0.feedback[axis].encoders[0].value;
            let setpoint = self.0.setpoints[axis].position;
            variables.axes[axis] =
                AxisValues { position, setpoint, following_error: setpoint - position, ..AxisValues::default() };
        }
        let missing = RaisedAlarm { number: AlarmNumber(700), place: Place::Nck, parameters: [Parameter::None; 4] };
        variables.alarms.publish(self.0.plc_missing.is_some().then_some(missing).into_iter());
    }

    fn power_on(&mut self) -> EventId {
        *self = Self::new(self.0.speed, self.0.log.clone());
        EventId::NONE
    }

    fn cycle_times(&self) -> CycleTimes {
        CycleTimes { interpolation: CYCLE, position_control: 2 }
    }

    fn measuring_system(&self, _: AxisNumber) -> Option<u8> {
        Some(0)
    }

    fn cause(&mut self, place: Place, _: u16, _: u8) -> EventId {
        match place {
            Place::Axis(axis) => self.0.causes[axis],
            Place::Nck | Place::ModeGroup(_) | Place::Channel(_) => self.0.plc_missing,
        }
    }

    fn alarm_cause(&self, _: AlarmNumber, _: Place) -> EventId {
        self.0.plc_missing
    }

    fn cleared_cause(&self, _: AlarmNumber, _: Place) -> EventId {
        EventId::NONE
    }

    fn events(&self) -> &Events {
        &self.0.log.events
    }

    fn override_coding(&self) -> OverrideCoding {
        OverrideCoding::of(&OWN)
    }

    fn data(&self) -> &dyn Data {
        self
    }

    fn texts(&self) -> &'static dyn Texts {
        &PlatformTexts
    }

    fn is_rotary(&self, _: AxisNumber) -> bool {
        false
    }

    fn taken(&self) -> Taken {
        self.0.log.taken
    }

    fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(&self.0).unwrap()
    }

    fn restore(&mut self, saved: &[u8]) -> Result<(), Problem> {
        self.0 = postcard::from_bytes(saved)
            .map_err(|error| Problem::new(error.to_string(), "restore bytes from `save` of a platform"))?;
        Ok(())
    }

    fn clone_box(&self) -> Box<dyn Control> {
        Box::new(self.clone())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

impl Data for Platform {
    fn stored(&self, number: u32, owner: Owner, index: u8) -> Option<Datum> {
        let value = Value::Real(self.0.speed);
        let exists = (number, owner, index) == (1, Owner::Nck, 0);
        exists.then_some(Datum { kind: Kind::Double, read_only: false, count: 1, value })
    }

    fn text(&self, _: u32, _: Owner, _: u8) -> Option<&str> {
        None
    }
}

/// The texts of the platform.
struct PlatformTexts;

impl Texts for PlatformTexts {
    fn name(&self) -> &'static str {
        "own"
    }

    fn interface(&self) -> &'static Interface {
        &OWN
    }

    fn alarms(&self) -> Vec<AlarmRow> {
        let (name, text) = ("700".to_owned(), "PLC of the platform missing");
        let (cancelled_by, reaction) = ("itself".to_owned(), "stops every drive".to_owned());
        vec![AlarmRow {
            number: AlarmNumber(700),
            name,
            text,
            raised: true,
            cancelled_by,
            reaction,
            clear_info: ClearInfo::ByItself,
        }]
    }

    fn alarm(&self, number: AlarmNumber) -> Option<AlarmRow> {
        self.alarms().into_iter().find(|alarm| alarm.number == number)
    }

    fn alarm_name(&self, number: AlarmNumber) -> String {
        number.0.to_string()
    }

    fn alarm_named(&self, _: &str) -> Option<AlarmNumber> {
        None
    }

    fn rules(&self) -> &'static [Rule] {
        &[
            Rule { id: "P-1", text: "power and release" },
            Rule { id: "P-2", text: "power or release missing" },
            Rule { id: "P-3", text: "no PLC program" },
        ]
    }

    fn datum_name(&self, number: u32) -> String {
        format!("parameter {number}")
    }

    fn cycle_data(&self) -> &'static str {
        "the cycle of the platform"
    }

    fn charts(&self) -> Vec<Chart> {
        let text = |phase| match phase {
            Phase::Off => "off",
            Phase::Running => "running",
        };
        vec![Chart::of("drive", "A drive", STEPS, text, |_| None)]
    }

    fn program_ending(&self) -> &'static str {
        ""
    }
}

/// The configuration of a platform: only the names of its axes, all platforms are alike.
pub(super) struct Platforms {
    /// `A1` to `A32`.
    names: PerAxis<String>,
}

impl Default for Platforms {
    fn default() -> Self {
        Self { names: PerAxis::from_fn(|axis| format!("A{axis}")) }
    }
}

impl Configuration for Platforms {
    fn axis_names(&self) -> Vec<&str> {
        self.names.iter().map(|(_, name)| name.as_str()).collect()
    }

    fn open(&self, _: &Site<'_>, _: &mut Settings, profile: Profile) -> Result<Opened, Problem> {
        let own = Profile::named(&OWN, "own").unwrap();
        if profile != own && profile != Profile::default() {
            return Err(Problem::new(
                format!("expected the profile own, found {}", profile.name()),
                "leave the profile out",
            ));
        }
        let axes = PerAxis::from_fn(|axis| Some(self.names[axis].clone()));
        let names = Names { axes, profile: own, ..Names::default() };
        Ok(Opened {
            control: Box::new(Platform::new(60.0, Log::default())),
            names,
            axes: PerAxis::from_fn(|_| AxisHints { exists: true, ..AxisHints::default() }),
            groupings: Vec::new(),
            findings: Vec::new(),
        })
    }
}
