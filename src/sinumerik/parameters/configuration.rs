//! Faults of the channels and their axes: 4000, 4001 (MD20070, MD11640, MD30550).
//!
//! Read at power on only; their alarms stay until power off. Choice: an axis may be named by several channels if MD30550 says which of them
//! is its master after power on. Without it an axis of the model belongs to the lowest of them, and the NC is not ready.

use crate::sinumerik::alarms;
use crate::sinumerik::machine_data::MachineData;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::parameters::groupings::Fault;
use crate::sinumerik::rules::Rule;
use crate::units::{AxisNumber, ChannelNumber, PerAxis};
use crate::variables::{Input, Parameter, Place};

/// A fault, and what was tested.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChannelFault {
    /// The alarm.
    pub fault: Fault,
    /// The rule of its cause.
    pub(in crate::sinumerik) rule: Rule,
    /// The datum that would allow it.
    pub tested: Input,
}

/// All faults.
#[must_use]
pub(in crate::sinumerik) fn faults(data: &MachineData, axes: &PerAxis<AxisParameters>) -> Vec<ChannelFault> {
    let channels = || ChannelNumber::all().filter(|&channel| data.mode_group(channel).is_some());
    let gaps = channels().filter_map(|channel| {
        let index = gap(data, channel)?;
        let index = Parameter::Number(index.try_into().unwrap_or(0));
        let parameters = [Parameter::Channel(channel), Parameter::Number(20070), index, Parameter::None];
        let fault = Fault { alarm: alarms::CHANNEL_AXIS_GAP, place: Place::Channel(channel), parameters };
        let tested = Input::Datum(11640, None, f64::from(data.general.enable_chan_ax_gap));
        Some(ChannelFault { fault, rule: Rule::ChannelAxisGap, tested })
    });
    let shared = axes.iter().filter(|(_, parameters)| parameters.exists).filter_map(|(axis, _)| {
        let channel = without_master(data, axis)?;
        let parameters = [Parameter::Channel(channel), Parameter::Axis(axis), Parameter::None, Parameter::None];
        let fault = Fault { alarm: alarms::AXIS_IN_SEVERAL_CHANNELS, place: Place::Channel(channel), parameters };
        let tested = Input::Datum(30550, Some(axis), f64::from(data.axes[axis].axconf_assign_master_chan));
        Some(ChannelFault { fault, rule: Rule::NoMasterChannel, tested })
    });
    gaps.chain(shared).collect()
}

/// The first index of MD20070 without an axis before one with an axis.
fn gap(data: &MachineData, channel: ChannelNumber) -> Option<usize> {
    let used = &data.channels[channel].axconf_machax_used;
    let first = used.iter().position(|&axis| axis == 0)?;
    let is_gap = used[first..].iter().any(|&axis| axis != 0) && data.general.enable_chan_ax_gap & 1 == 0;
    is_gap.then_some(first)
}

/// The second channel that names an axis, if none of those that name it is its master.
fn without_master(data: &MachineData, axis: AxisNumber) -> Option<ChannelNumber> {
    let knows = |channel: &ChannelNumber| data.channel_knows(*channel, axis);
    let master = ChannelNumber::new(data.axes[axis].axconf_assign_master_chan).filter(knows);
    if master.is_some() { None } else { ChannelNumber::all().filter(knows).nth(1) }
}
