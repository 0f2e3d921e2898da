//! The definition of gantry groupings by MD37100, and its possible faults (G1 2.2, 2.4).
//!
//! Read at power on only (DEF-09). A grouping with a fault is not formed; its alarm stays until power off.
//!
//! 10651 gives the reason: 10XX to 60XX, 10000 (a synchronous axis is a geometry axis), 13000 (spindle), 14000 (Hirth gear). 11000 is
//! 4300 here (E-21), and 12000 concerns compile cycles, which do not exist here. Choice: MD20050 counts when the archive or an operator
//! gives it. Its default declares machine axes 1 to 3 as geometry axes, and the worked example, which does not mention it, has machine
//! axis 3 as its synchronous axis.

use arrayvec::ArrayVec;

use crate::motion::coupling::{BeforeReference, Coupling, Follower, GroupStop, Policy, Reaction, Release};
use crate::sinumerik::alarms;
use crate::sinumerik::machine_data::{MachineData, unequal_data};
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::units::{AxisNumber, ChannelNumber, PerAxis};
use crate::variables::{AlarmNumber, Parameter, Place};

/// The largest number of groupings (DEF-02).
pub(in crate::sinumerik) const GROUPINGS: usize = 8;

/// The largest number of synchronous axes of a grouping (DEF-03). One more raises 10650.
pub(in crate::sinumerik) const SYNCHRONOUS_AXES: usize = 2;

/// The reactions of a grouping. Its alarms store an exceeded limit and stop its axes (O-04: at the slowest rate). A difference that arose
/// while it was open does not count.
const POLICY: Policy = Policy {
    first: Reaction::Report,
    second: Reaction::Report,
    before_reference: BeforeReference::Relative,
    release: Release::CountAnew,
    stop: GroupStop::AllAtTheSlowest,
};

/// The axes of a grouping.
pub(in crate::sinumerik) type GantryCoupling = Coupling<SYNCHRONOUS_AXES>;

/// A grouping as the machine data define it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Definition {
    /// Its number, 1 to 8.
    pub number: u8,
    /// Its axes: the leading axis leads, the synchronous axes follow, ascending by axis number (O-10).
    pub coupling: GantryCoupling,
}

/// An alarm raised by a definition at power on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The alarm.
    pub alarm: AlarmNumber,
    /// Its place.
    pub place: Place,
    /// Its parameters.
    pub parameters: [Parameter; 4],
}

/// A machine datum that must be equal within a grouping and differs (DYN-03).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unequal {
    /// The number of the grouping.
    pub grouping: u8,
    /// The leading axis.
    pub leader: AxisNumber,
    /// The synchronous axis.
    pub axis: AxisNumber,
    /// The datum.
    pub datum: u32,
    /// The values of the leading axis and of the synchronous axis.
    pub values: [f64; 2],
}

/// The groupings of a machine and the faults found in their definition.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Definitions {
    /// The groupings that were formed.
    pub groupings: ArrayVec<Definition, GROUPINGS>,
    /// The faults.
    pub faults: Vec<Fault>,
    /// Unequal data of the groupings that were formed.
    pub unequal: Vec<Unequal>,
}

/// Reads MD37100 of all axes.
#[must_use]
pub(in crate::sinumerik) fn define(data: &MachineData, axes: &PerAxis<AxisParameters>) -> Definitions {
    let mut found = Definitions::default();
    let kind = |axis: AxisNumber| data.axes[axis].gantry_axis_type;
    for (axis, _) in axes.iter().filter(|(_, parameters)| parameters.exists) {
        // DEF-01: units digit = number of the grouping, tens digit 1 = synchronous axis.
        if !matches!(kind(axis), 0 | 1..=8 | 11..=18) {
            found.faults.push(machine_data_fault(data, axis, 1));
        }
    }
    for number in 1..=8_u8 {
        let of_kind = |wanted: u8| -> Vec<AxisNumber> {
            axes.iter()
                .filter(|(axis, parameters)| parameters.exists && kind(*axis) == wanted)
                .map(|(axis, _)| axis)
                .collect()
        };
        let (leaders, followers) = (of_kind(number), of_kind(number + 10));
        if leaders.is_empty() && followers.is_empty() {
            continue;
        }
        let elsewhere = axes.iter().any(|(axis, parameters)| !parameters.exists && kind(axis) == number + 10);
        let before = found.faults.len();
        check(&mut found.faults, number, &leaders, &followers, elsewhere, data, axes);
        if found.faults.len() > before {
            continue;
        }
        if let Some(coupling) = GantryCoupling::new(leaders[0], POLICY, followers.iter().copied().map(Follower::new)) {
            // At most eight numbers are counted here.
            for &axis in &followers {
                let [leading, own] = [leaders[0], axis].map(|axis| &data.axes[axis]);
                let unequal = |(datum, values)| Unequal { grouping: number, leader: leaders[0], axis, datum, values };
                found.unequal.extend(unequal_data(leading, own).map(unequal));
            }
            found.groupings.push(Definition { number, coupling });
        }
    }
    found
}

fn check(
    faults: &mut Vec<Fault>,
    number: u8,
    leaders: &[AxisNumber],
    followers: &[AxisNumber],
    followers_elsewhere: bool,
    data: &MachineData,
    axes: &PerAxis<AxisParameters>,
) {
    let home = |axis: &AxisNumber| data.home_channel(*axis);
    let channel = leaders.first().or_else(|| followers.first()).map_or(ChannelNumber::FIRST, home);
    // 10650 code 2: leading axis declared more than once (DEF-05); in another channel its number clashes (DEF-07).
    let (here, elsewhere): (Vec<_>, Vec<_>) = leaders.iter().skip(1).partition(|axis| home(axis) == channel);
    faults.extend(here.into_iter().map(|&axis| machine_data_fault(data, axis, 2)));
    // 10650 code 1: wrong designation of a following axis, or more of them than allowed (DEF-03).
    faults.extend(followers.iter().skip(SYNCHRONOUS_AXES).map(|&axis| machine_data_fault(data, axis, 1)));
    let Some(&leader) = leaders.first() else {
        faults.push(configuration_fault(channel, 1_000, number));
        return;
    };
    if followers.is_empty() {
        faults.push(configuration_fault(channel, if followers_elsewhere { 5_000 } else { 2_000 }, number));
    }
    // DEF-08: the synchronous axes must be known in every channel of the leading axis.
    let unknown = |channel: ChannelNumber| {
        data.channel_knows(channel, leader) && followers.iter().any(|&axis| !data.channel_knows(channel, axis))
    };
    let master_channel = |axis: AxisNumber| data.axes[axis].axconf_assign_master_chan;
    let known_in = ChannelNumber::all().filter(|&channel| data.channel_knows(channel, leader)).count();
    if known_in > 1 && ChannelNumber::all().any(unknown) {
        faults.push(configuration_fault(channel, 6_000, number));
    } else if followers.iter().any(|&axis| master_channel(axis) != master_channel(leader)) {
        faults.push(configuration_fault(channel, 3_000, number));
    } else if !elsewhere.is_empty() || followers.iter().any(|axis| home(axis) != channel) {
        faults.push(configuration_fault(channel, 4_000, number));
    }
    let master = &data.axes[leader];
    for &axis in followers {
        if data.axes[axis].is_rot_ax != master.is_rot_ax {
            let parameters = [
                Parameter::Channel(channel),
                Parameter::Axis(axis),
                Parameter::Number(i64::from(number)),
                Parameter::None,
            ];
            faults.push(Fault { alarm: alarms::GANTRY_MIXED_AXIS_TYPES, place: Place::Axis(axis), parameters });
        }
    }
    let members = || leaders.iter().chain(followers);
    if members().any(|&axis| data.axes[axis].spind_assign_to_machax != 0) {
        faults.push(configuration_fault(channel, 13_000, 0));
    }
    if followers.iter().any(|&axis| axes[axis].gantry.geometry_axis) {
        faults.push(configuration_fault(channel, 10_000, 0));
    }
    if members().any(|&axis| axes[axis].gantry.hirth) {
        faults.push(configuration_fault(channel, 14_000, 0));
    }
}

fn machine_data_fault(data: &MachineData, axis: AxisNumber, code: i64) -> Fault {
    let channel = Parameter::Channel(data.home_channel(axis));
    let parameters = [channel, Parameter::Axis(axis), Parameter::Number(code), Parameter::None];
    Fault { alarm: alarms::GANTRY_MACHINE_DATA, place: Place::Axis(axis), parameters }
}

/// 10651 with its reason: the thousands digit gives the reason, the last two digits the grouping.
fn configuration_fault(channel: ChannelNumber, reason: i64, number: u8) -> Fault {
    let reason = Parameter::Number(reason + i64::from(number));
    let parameters = [Parameter::Channel(channel), reason, Parameter::None, Parameter::None];
    Fault { alarm: alarms::GANTRY_CONFIGURATION, place: Place::Channel(channel), parameters }
}
