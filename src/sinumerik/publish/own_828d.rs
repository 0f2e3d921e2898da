//! What only the 828D shows: auxiliary functions in DB2500, functions of a spindle in DB370x, active reactions of user alarms in DB1600.DBB2000,
//! machine data for the PLC in DB4500, actual values and distances to go in DB570x.

use crate::image::{
    ChannelAuxiliary, ChannelAuxiliary828d, UserFromNck, axis_828d, channel_auxiliary as narrow,
    channel_auxiliary_828d as own,
};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::publish::rows::{Rows, Why};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::sinumerik::user::state::UserReaction;
use crate::units::{AxisNumber, ChannelNumber, Position};
use crate::variables::{AxisValues, EventId, Input, Quantity};

/// The number of bytes of the auxiliary functions.
const AUXILIARY: usize = size_of::<ChannelAuxiliary828d>();

impl State {
    /// DB1600.DBB2000 and DB4500.
    pub(super) fn show_user(&self, parameters: &Parameters, rows: &mut impl Rows) {
        let Some(data) = parameters.user.as_deref() else { return };
        for (signal, reaction) in UserFromNck::SIGNALS.iter().zip(UserReaction::ALL) {
            let alarm = self.user.reactions[reaction as usize];
            rows.bit(*signal, alarm.is_some(), || Why::Event(alarm.map_or(self.user.ended, |alarm| alarm.cause)));
        }
        let [integers, bytes, reals, alarms] = UserFromNck::DATA;
        let power_on = || Why::Event(EventId::NONE);
        rows.bytes(integers, data.integers.as_flattened(), power_on);
        rows.bytes(bytes, &data.bytes, power_on);
        rows.bytes(reals, data.reals.as_flattened(), power_on);
        rows.bytes(alarms, &data.alarms, power_on);
    }

    /// DB2500 from byte 2000 on.
    pub(super) fn show_auxiliary_828d(&self, channel: ChannelNumber, parameters: &Parameters, rows: &mut impl Rows) {
        if parameters.user.is_none() {
            return;
        }
        let output = &self.programs[channel].output;
        let wide = output.bytes().map_or([0; AUXILIARY], wide);
        rows.bytes(ChannelAuxiliary828d::FIRST, &wide, || Why::Event(output.cause));
    }

    /// DB370x and DB570x.
    pub(super) fn show_axis_828d(
        &self,
        number: AxisNumber,
        values: &AxisValues,
        parameters: &Parameters,
        rows: &mut impl Rows,
    ) {
        if parameters.user.is_none() {
            return;
        }
        if let Some(spindle) = self.spindles[number].as_deref() {
            let functions = || Why::Event(spindle.function_cause);
            let m = u32::from(spindle.m_function).to_be_bytes();
            rows.bytes(axis_828d::spindle_m_function.byte, &m, functions);
            rows.bytes(axis_828d::spindle_s_function.byte, &spindle.s_function.to_be_bytes(), functions);
        }
        let of_axis = |quantity, length| Input::Length(quantity, number, length);
        let position = [of_axis(Quantity::Position, values.position), Input::None, Input::None];
        let left = [
            of_axis(Quantity::Target, values.setpoint + values.distance_to_go),
            of_axis(Quantity::Setpoint, values.setpoint),
            Input::None,
        ];
        let shown = [
            (axis_828d::axis_actual_value, values.position, position),
            (axis_828d::axis_distance_to_go, values.distance_to_go, left),
        ];
        for ((signal, value, inputs), requested) in shown.into_iter().zip(self.user.requests) {
            if requested {
                let value = real(value, parameters.is_inch && !parameters.axes[number].rotary);
                rows.bytes(signal.byte, &value.to_be_bytes(), || {
                    Why::Tested(Rule::ValueRequested, inputs, self.axes[number].causes.movement())
                });
            }
        }
    }
}

/// A position in the units of the basic system.
#[expect(clippy::cast_possible_truncation, reason = "the interface has REALs of four bytes")]
fn real(position: Position, is_inch: bool) -> f32 {
    let user = position.user();
    (if is_inch { user / 25.4 } else { user }) as f32
}

/// The values of DB21.DBB58 to 206 as DB2500 has them: four bytes each, and one byte for an extension.
fn wide(output: &[u8]) -> [u8; AUXILIARY] {
    let mut wide = [0; AUXILIARY];
    let mut put = |signal: u16, bytes: &[u8]| {
        let at = usize::from(signal - ChannelAuxiliary828d::FIRST);
        wide[at..at + bytes.len()].copy_from_slice(bytes);
    };
    let from = |byte: u16, count: usize| &output[usize::from(byte - ChannelAuxiliary::FIRST)..][..count];
    put(own::t_function_1.byte + 2, from(narrow::t_function_1.byte, 2));
    put(own::d_function_1.byte + 3, from(narrow::d_function_1.byte, 1));
    let kinds = [
        (own::m_function_1, narrow::m_function_1, 5),
        (own::s_function_1, narrow::s_function_1, 3),
        (own::h_function_1, narrow::h_function_1, 3),
    ];
    for (to, of, count) in kinds {
        for place in 0..count {
            put(to.byte + 8 * place, from(of.byte + 6 * place, 4));
            // The extension is a word before the value.
            put(to.byte + 8 * place + 4, from(of.byte + 6 * place - 1, 1));
        }
    }
    wide
}
