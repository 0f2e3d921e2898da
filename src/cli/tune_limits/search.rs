//! Runs a scenario and measures the synchronism differences of all groupings.

use crate::image::Location;
use crate::machine::Machine;
use crate::scenario::{Finished, Prepared};
use crate::trace::{Curves, Detail, LineKind, Watch};
use crate::units::{AxisNumber, Position, Time};
use crate::variables::{AlarmNumber, Place};

/// The warning limit, the trip limit, and the trip limit while the grouping is not synchronised.
const LIMITS: [u32; 3] = [37110, 37120, 37130];
/// The definition of gantry axes.
const DEFINITION: u32 = 37100;
const WARNING: AlarmNumber = AlarmNumber(10652);
const TRIP: AlarmNumber = AlarmNumber(10653);

/// An axis of a grouping.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    pub(super) axis: AxisNumber,
    pub(super) name: String,
    /// Its index among the curves; only of synchronous axes.
    pub(super) curve: usize,
}

/// A gantry grouping.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Grouping {
    /// Its index among the groupings of the machine.
    pub(super) index: usize,
    pub(super) number: u32,
    pub(super) leader: Axis,
    pub(super) followers: Vec<Axis>,
    pub(super) unit: &'static str,
    /// The value of one unit of the machine data in the unit of values of axes.
    pub(super) in_trace: f64,
    /// MD37130 before the search, the smallest of its synchronous axes.
    pub(super) not_synchronised: f64,
    synchronised: Option<Location>,
}

impl Grouping {
    /// The groupings of a machine by number: MD37100 has the grouping in its units digit, and 1 in its tens digit on a synchronous axis.
    pub(super) fn all(machine: &Machine) -> Vec<Self> {
        let names = machine.names();
        let datum = |number, axis| machine.control().active_datum(number, None, Some(axis)).unwrap_or(0.0);
        let axes = || names.axes.iter().filter_map(|(axis, name)| Some((axis, name.clone()?)));
        let mut groupings: Vec<Self> = Vec::new();
        let mut curve = 0;
        for number in 1..=8_u32 {
            let meant = |definition: u32| {
                axes().filter(move |(axis, _)| (datum(DEFINITION, *axis) - f64::from(definition)).abs() < 0.5)
            };
            let Some((axis, name)) = meant(number).next() else {
                continue;
            };
            let synchronised = format!("{name}.gantry_grouping_is_synchronized");
            let leader = Axis { axis, name, curve: 0 };
            let mut followers = Vec::new();
            for (axis, name) in meant(10 + number) {
                followers.push(Axis { axis, name, curve });
                curve += 1;
            }
            if followers.is_empty() {
                continue;
            }
            let in_trace = machine.control().in_causes(LIMITS[0], Some(axis), 1.0);
            let unit = match (machine.control().is_rotary(axis), (in_trace - 1.0).abs() < 1e-9) {
                (true, _) => "deg",
                (false, true) => "mm",
                (false, false) => "inch",
            };
            groupings.push(Self {
                index: groupings.len(),
                number,
                synchronised: names.resolve(machine.memory(), &synchronised).ok(),
                not_synchronised: followers.iter().map(|own| datum(LIMITS[2], own.axis)).fold(f64::INFINITY, f64::min),
                leader,
                followers,
                unit,
                in_trace,
            });
        }
        groupings
    }

    /// The leading axis, then the synchronous axes.
    pub(super) fn axes(&self) -> impl Iterator<Item = &Axis> {
        std::iter::once(&self.leader).chain(&self.followers)
    }

    pub(super) fn title(&self) -> String {
        format!("gantry grouping {} ({})", self.number, self.leader.name)
    }

    /// MD37110, MD37120 and MD37130 of a synchronous axis as the machine has them.
    pub(super) fn now(&self, axis: AxisNumber, machine: &Machine) -> [f64; 3] {
        LIMITS.map(|limit| machine.control().active_datum(limit, None, Some(axis)).unwrap_or(0.0))
    }

    fn is_synchronised(&self, machine: &Machine) -> bool {
        self.synchronised.is_some_and(|signal| machine.memory().read(signal) != 0)
    }

    /// The greatest difference of a synchronous axis now, in the unit of the machine data.
    fn difference(&self, axis: AxisNumber, machine: &Machine) -> f64 {
        machine.variables().axes[axis].synchronism_difference.abs().user() / self.in_trace
    }
}

/// The greatest difference of an axis while its grouping was synchronised.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Greatest {
    pub(super) value: f64,
    pub(super) time: Time,
}

/// What was seen of a grouping in a run.
#[derive(Clone, Debug, Default)]
pub(super) struct Seen {
    /// Of each synchronous axis.
    pub(super) greatest: Vec<Greatest>,
    /// The greatest difference while it was not synchronised.
    pub(super) not_synchronised: f64,
    pub(super) was_synchronised: bool,
    /// The leading axis had different setpoints while it was synchronised.
    pub(super) moved: bool,
    setpoint: Option<Position>,
}

impl Seen {
    fn look(&mut self, grouping: &Grouping, machine: &Machine) {
        let synchronised = grouping.is_synchronised(machine);
        for (follower, greatest) in grouping.followers.iter().zip(&mut self.greatest) {
            let value = grouping.difference(follower.axis, machine);
            if !synchronised {
                self.not_synchronised = self.not_synchronised.max(value);
            } else if value > greatest.value {
                *greatest = Greatest { value, time: machine.time() };
            }
        }
        let setpoint = synchronised.then(|| machine.variables().axes[grouping.leader.axis].setpoint);
        self.was_synchronised |= synchronised;
        self.moved |= setpoint.is_some() && self.setpoint.is_some() && setpoint != self.setpoint;
        self.setpoint = setpoint;
    }

    /// Takes over greater differences of another run; returns whether there are any.
    pub(super) fn grow(&mut self, other: &Self) -> bool {
        let mut any = other.not_synchronised > self.not_synchronised;
        self.not_synchronised = self.not_synchronised.max(other.not_synchronised);
        for (own, new) in self.greatest.iter_mut().zip(&other.greatest) {
            if new.value > own.value {
                (*own, any) = (*new, true);
            }
        }
        any
    }
}

/// A run with its measurements.
pub(super) struct Measured {
    pub(super) finished: Finished,
    /// Of each grouping.
    pub(super) seen: Vec<Seen>,
    pub(super) curves: Curves,
    pub(super) first_synchronised: Option<Time>,
    /// A message 10652 while a grouping was synchronised, or an alarm 10653.
    raised: Option<(AlarmNumber, String, Time)>,
}

/// Runs a scenario that is ready.
pub(super) fn measure(prepared: Prepared, groupings: &[Grouping]) -> Measured {
    let new =
        |grouping: &Grouping| Seen { greatest: vec![Greatest::default(); grouping.followers.len()], ..Seen::default() };
    let mut seen: Vec<_> = groupings.iter().map(new).collect();
    let machine = prepared.machine();
    let followers = || groupings.iter().flat_map(|grouping| &grouping.followers);
    let names: Vec<_> = followers().map(|axis| format!("{}.synchronism_difference", axis.name)).collect();
    let entries: Vec<_> = names.iter().map(String::as_str).collect();
    let curves = Curves::parse(&entries, machine.names(), machine.memory(), machine.variables());
    let mut curves = curves.unwrap_or_default();
    let (mut first_synchronised, mut raised) = (None, None);
    let finished = prepared.run_with(None, &mut |machine| {
        curves.look(machine.cycle(), machine.variables());
        for (grouping, seen) in groupings.iter().zip(&mut seen) {
            seen.look(grouping, machine);
            let synchronised = grouping.is_synchronised(machine);
            if synchronised {
                first_synchronised.get_or_insert_with(|| machine.time());
            }
            for follower in &grouping.followers {
                let place = Some(Place::Axis(follower.axis));
                let mut wrong = vec![TRIP];
                wrong.extend(synchronised.then_some(WARNING));
                let alarms = &machine.variables().alarms;
                if let Some(alarm) = wrong.into_iter().find(|alarm| alarms.find(*alarm, place).is_some()) {
                    raised.get_or_insert_with(|| (alarm, follower.name.clone(), machine.time()));
                }
            }
        }
    });
    Measured { finished, seen, curves, first_synchronised, raised }
}

impl Measured {
    /// The first message or alarm that proper limits do not have.
    pub(super) fn message(&self) -> Option<String> {
        let (alarm, axis, time) = self.raised.as_ref()?;
        Some(format!("{} [{axis}] at {time} s", alarm.0))
    }

    /// A limit that the scenario changes, with its time.
    pub(super) fn own_limit(&self) -> Option<String> {
        let session = self.finished.session();
        let lines = session.trace().lines(session.machine(), &Watch::default());
        lines.into_iter().find_map(|line| {
            let LineKind::Happening(happening) = line.kind else {
                return None;
            };
            let datum = happening.details.iter().find_map(|(key, detail)| match detail {
                Detail::Text(text) if *key == "machine_data" => Some(text.clone()),
                Detail::Text(_) | Detail::Number(_) => None,
            })?;
            let is_limit = LIMITS.iter().any(|limit| datum.starts_with(&format!("{limit}[")));
            is_limit.then(|| format!("{datum} at {} s", line.time))
        })
    }
}
