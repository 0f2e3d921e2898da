//! The existing channels, with their axes and mode groups (MD10010, MD20070, MD30550).
//!
//! Read at power on. A channel exists if MD10010 gives it a mode group; channel 1 always exists. An axis that no channel names belongs to
//! channel 1. An axis that several channels name belongs to the channel of MD30550, otherwise to the lowest of them.

use crate::sinumerik::machine_data::MachineData;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::units::{AxisSet, ModeGroupNumber, PerAxis, PerChannel};

/// One channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChannelParameters {
    /// MD10010; `None`: the channel does not exist.
    pub mode_group: Option<ModeGroupNumber>,
    /// Its axes after power on.
    pub axes: AxisSet,
    /// The axes that can come into it (MD20070).
    pub known: AxisSet,
    /// The axes that need their reference point for NC start: MD34110 above −1, unless MD20700 is 0.
    pub reference_needed: AxisSet,
    /// MD20700.
    pub start_locked: bool,
    /// MD20700 = 2: for blocks of MDA a restored position suffices.
    pub restored_suffices_in_mda: bool,
}

/// All channels.
#[must_use]
pub(in crate::sinumerik) fn channels(
    data: &MachineData,
    axes: &PerAxis<AxisParameters>,
) -> PerChannel<ChannelParameters> {
    PerChannel::from_fn(|channel| {
        let own = || axes.iter().filter(|(_, axis)| axis.exists && axis.channel == channel);
        let locked = data.channels[channel].refp_nc_start_lock != 0;
        let needed = own().filter(|(_, axis)| locked && axis.reference.cycle_number > -1);
        ChannelParameters {
            mode_group: data.mode_group(channel),
            start_locked: locked,
            restored_suffices_in_mda: data.channels[channel].refp_nc_start_lock == 2,
            axes: own().map(|(number, _)| number).collect(),
            known: axes
                .iter()
                .filter(|(number, axis)| {
                    axis.exists && (axis.channel == channel || data.channel_knows(channel, *number))
                })
                .map(|(number, _)| number)
                .collect(),
            reference_needed: needed.map(|(number, _)| number).collect(),
        }
    })
}
