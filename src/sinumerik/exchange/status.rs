//! What the interface and programs see of the holder of an axis: DBB68, 36.3, `$AA_TYP`, `$AA_AXCHANGE_TYP`, `$AA_AXCHANGE_STAT`.

use crate::sinumerik::exchange::state::{Holder, Owners};
use crate::sinumerik::jog::state::Movement;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::PlcAxis;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, AxisSet, ChannelNumber};

/// What the interface shows of an axis: DBB68.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sinumerik) struct Status {
    /// 68.0 to 68.3.
    pub channel: u8,
    /// 68.4.
    pub requested: bool,
    /// 68.5.
    pub possible: bool,
    /// 68.6.
    pub neutral: bool,
    /// 68.7.
    pub plc: bool,
}

impl Owners {
    /// `$AA_TYP` of an axis as a program of this channel sees it. A program runs in AUTOMATIC or MDA, so the values of JOG do not occur. A synchronous
    /// axis of a closed grouping is a coupled axis (P-103).
    pub(in crate::sinumerik) fn axis_type(&self, axis: AxisNumber, channel: ChannelNumber, is_coupled: bool) -> i32 {
        let of = self.of(axis);
        match of.holder {
            _ if of.channel != channel => 0,
            _ if is_coupled => 7,
            Holder::Program => 1,
            Holder::Neutral => 2,
            Holder::Plc => 3,
            Holder::Command => 8,
        }
    }

    /// `$AA_AXCHANGE_TYP` of an axis as a program of this channel sees it; `moves` is whether the PLC positions it.
    pub(in crate::sinumerik) fn exchange_type(
        &self,
        (axis, data): (AxisNumber, PlcAxis),
        channel: ChannelNumber,
        moves: bool,
    ) -> i32 {
        let of = self.of(axis);
        let asked = of.request.is_some();
        match of.holder {
            Holder::Plc if data.exclusive && !moves => 10,
            Holder::Plc if data.permanent && !moves => 9,
            Holder::Plc | Holder::Command => 1 + 6 * i32::from(asked),
            Holder::Neutral if of.request.is_some_and(|request| request.by.is_by_plc()) => 4,
            Holder::Neutral => 3,
            Holder::Program if of.channel != channel => 2 + 3 * i32::from(asked),
            Holder::Program => 0,
        }
    }
}

impl State {
    /// DBB68. A synchronous axis of a closed grouping is what its leading axis is.
    pub(in crate::sinumerik) fn exchange_status(&self, axis: AxisNumber) -> Status {
        let of = self.owners.of(axis);
        let unit = self.units.iter().find(|unit| unit.set.contains(axis));
        Status {
            // An axis that does not exist is in no channel.
            channel: if unit.is_some() { of.channel.number() } else { 0 },
            requested: of.request.is_some_and(|request| request.by.is_by_plc()),
            possible: unit.is_some() && !self.owners.used.contains(axis),
            neutral: of.holder == Holder::Neutral,
            plc: of.holder == Holder::Plc,
        }
    }

    /// The axes whose standstill 36.3 shows: a PLC axis only with MD30460 bit 7 = 0.
    pub(in crate::sinumerik) fn stationary_axes(&self, channel: ChannelNumber, parameters: &Parameters) -> AxisSet {
        let left_out = |axis: &AxisNumber| {
            parameters.axes[*axis].plc_axis.ignored_by_stationary && self.owners.of(*axis).holder == Holder::Plc
        };
        let axes = self.owners.of_channel(channel);
        axes.without(axes.iter().filter(left_out).collect())
    }

    /// The axes whose movement makes a channel active. The PLC and synchronised actions move theirs beside it; a PLC axis that is jogged or
    /// referenced counts.
    pub(in crate::sinumerik) fn active_axes(&self, channel: ChannelNumber) -> AxisSet {
        let synchronising = self.synchronising();
        let alone = |axis: &AxisNumber| {
            let of = &self.axes[*axis];
            let by_operator = of.jogging.movement != Movement::None || of.approach.is_running();
            let is_alone = matches!(self.owners.of(*axis).holder, Holder::Plc | Holder::Command);
            is_alone && !by_operator && !synchronising.contains(*axis)
        };
        let axes = self.owners.of_channel(channel);
        axes.without(axes.iter().filter(alone).collect())
    }
}
