//! What a block names and the channel does not have: couplings, and spindles.

use crate::nc_program::{AxisIndex, Block};
use crate::sinumerik::alarms::programs as alarms;
use crate::sinumerik::program::preparation::{NO_SPINDLE, NOT_ACTIVE, Preparing, alarm, block_parameter};
use crate::sinumerik::program::state::{BlockAlarm, block_name};
use crate::units::AxisNumber;
use crate::variables::{Parameter, short_text};

impl Preparing<'_> {
    /// The axis of a spindle; 0 is the master spindle.
    pub(super) fn known_spindle(&self, block: &Block, number: u16) -> Result<AxisNumber, BlockAlarm> {
        let shown = if number == 0 { 1 } else { number };
        let unknown = || alarm(block, NO_SPINDLE, Parameter::Text(short_text(&shown.to_string())));
        self.own.spindle(number).ok_or_else(unknown)
    }

    /// The gantry chapter forbids couplings with synchronous axes; others are not modelled.
    pub(super) fn coupling(
        &self,
        block: &Block,
        is_on: bool,
        following: AxisIndex,
        leading: Option<AxisIndex>,
    ) -> BlockAlarm {
        let machine_axis = |name: AxisIndex| self.own.axes.machine_axes.get(usize::from(name.0)).copied();
        let follows = |name: AxisIndex| machine_axis(name).filter(|axis| self.parameters.axes[*axis].gantry_follower);
        if !is_on {
            return alarm(block, alarms::NO_COUPLING, Parameter::None);
        }
        if let Some(axis) = follows(following) {
            let groupings = &self.parameters.groupings.groupings;
            let of_axis = groupings.iter().find(|grouping| grouping.coupling.members().any(|member| member == axis));
            let leader = of_axis.map_or(Parameter::None, |grouping| Parameter::Axis(grouping.coupling.leader()));
            let parameters = [block_parameter(block), self.name(following), leader];
            return BlockAlarm { number: alarms::FOLLOWS_ALREADY, parameters, block: block_name(&block.origin.name) };
        }
        if machine_axis(following).is_none() {
            return alarm(block, alarms::FOLLOWING_AXIS_MISSING, self.name(following));
        }
        if let Some(leading) = leading.filter(|name| follows(*name).is_some()) {
            return alarm(block, alarms::WRONG_AXIS_TYPE, self.name(leading));
        }
        alarm(block, NOT_ACTIVE, Parameter::Text(short_text(block.origin.text.trim())))
    }
}
