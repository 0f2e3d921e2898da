//! Which signals have a row: the control writes these and no others.

use std::sync::OnceLock;

use super::rows::{Rows, Why, mask};
use crate::image::{Block, Signal};
use crate::sinumerik::machine_data::MachineData;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::AxisPresence;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber, PerAxis};
use crate::variables::AxisValues;

/// The bits of a byte of a block that rows give.
type Bits = (Block, u16, u8);

/// Collects the bits of the rows of a block.
struct Collected<'a> {
    block: Block,
    bits: &'a mut Vec<Bits>,
}

impl Rows for Collected<'_> {
    fn group(&mut self, first: Signal, last: Signal, _: u8, _: impl FnOnce() -> Why) {
        self.bits.push((self.block, first.byte, mask(first, last)));
    }

    fn bytes(&mut self, first: u16, values: &[u8], _: impl FnOnce() -> Why) {
        self.bits.extend((first..).take(values.len()).map(|byte| (self.block, byte, 0xFF)));
    }
}

/// Whether a row of publication gives this signal, also in the bytes of the HMI that the control mirrors.
pub(in crate::sinumerik) fn has_row(signal: &Signal) -> bool {
    static BITS: OnceLock<Vec<Bits>> = OnceLock::new();
    let all = BITS.get_or_init(collect);
    all.iter().any(|&(block, byte, mask)| (block, byte) == (signal.block, signal.byte) && mask >> signal.bit & 1 == 1)
}

/// The rows of a machine with a gantry grouping and a spindle: each kind of block occurs in it.
fn collect() -> Vec<Bits> {
    let mut data = MachineData::default();
    let mut presence = PerAxis::<AxisPresence>::default();
    // The fourth axis follows: the first three are geometry axes.
    let axis = |index| AxisNumber::all().nth(index).unwrap_or(AxisNumber::FIRST);
    let kinds = [(0, 1), (3, 11), (4, 0)].map(|(index, code)| (axis(index), code));
    for (axis, code) in kinds {
        data.axes[axis].gantry_axis_type = code;
        presence[axis].exists = true;
    }
    let spindle = &mut data.axes[axis(4)];
    (spindle.spind_assign_to_machax, spindle.is_rot_ax, spindle.rot_is_modulo) = (1, true, true);
    let parameters = Parameters::new(&data, &presence);
    let of_828d = Parameters::new(&data, &presence).on_828d(&data);
    let state = State::new(&parameters);
    let mut requested = state.clone();
    requested.user.requests = [true; 2];
    let mut bits = Vec::new();
    let mut of = |block, show: &dyn Fn(&mut Collected<'_>)| show(&mut Collected { block, bits: &mut bits });
    of(Block::Nck, &|rows| {
        state.show_nck(&parameters, rows);
        state.show_user(&of_828d, rows);
    });
    of(Block::ModeGroup, &|rows| {
        state.show_mode_group(ModeGroupNumber::FIRST, &parameters, rows);
        state.show_selection(ModeGroupNumber::FIRST, rows);
    });
    of(Block::Channel, &|rows| {
        state.show_channel(ChannelNumber::FIRST, &parameters, rows);
        state.show_auxiliary(ChannelNumber::FIRST, &parameters, rows);
        state.show_search(ChannelNumber::FIRST, rows);
        state.show_auxiliary_828d(ChannelNumber::FIRST, &of_828d, rows);
    });
    for (axis, _) in kinds {
        of(Block::Axis, &|rows| {
            let own = &parameters.axes[axis];
            state.show_axis(axis, &parameters, rows);
            state.show_movement(axis, own, &parameters, rows);
            state.show_gantry_axis(axis, rows);
            state.show_spindle(axis, &parameters, rows);
            requested.show_axis_828d(axis, &AxisValues::default(), &of_828d, rows);
        });
    }
    bits
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::{axis_from_nck, channel_from_nck, mode_group_from_nck, nck_from_nck};

    #[test]
    fn rows_are_found_bit_by_bit() {
        let written = [
            axis_from_nck::gantry_trip_limit_exceeded,
            axis_from_nck::gantry_leading_axis,
            axis_from_nck::axis_stationary,
            axis_from_nck::active_machine_function_increment_100,
            channel_from_nck::referencing_active,
            mode_group_from_nck::mode_group_ready,
            nck_from_nck::nc_ready,
        ];
        assert_eq!(written.iter().find(|signal| !has_row(signal)), None);
        let named_only = [axis_from_nck::measurement_active, channel_from_nck::transformation_active];
        assert_eq!(named_only.iter().find(|signal| has_row(signal)), None);
    }
}
