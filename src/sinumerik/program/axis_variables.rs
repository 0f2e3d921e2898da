//! The system variables of axes and spindles, and settable offsets.
//!
//! Lengths are in the basic system (MD10240), whatever G70 and G71 say; with G700 and G710 in blocks of programs in the programmed one (P-120).

use crate::nc_program::{AxisIndex, INCH, SystemVariable, Value, VariableRefusal};
use crate::sinumerik::exchange::state::Holder;
use crate::sinumerik::parameters::spindle::REVOLUTION_PER_MINUTE;
use crate::sinumerik::program::environment::{Channel, whole_index};
use crate::sinumerik::spindle::state::Mode;
use crate::units::{AxisNumber, Position};

impl Channel<'_> {
    /// The unit of lengths of an axis, in mm; of degrees 1.
    pub(super) fn unit(&self, axis: AxisNumber) -> f64 {
        if self.is_inch && !self.all.axes[axis].rotary { INCH } else { 1.0 }
    }

    /// $AA_S and other variables of a spindle: its number is the index, 0 the master spindle.
    fn spindle_value(&self, variable: &SystemVariable<'_>) -> Result<Value, VariableRefusal> {
        let number = variable.indices.first().and_then(Value::number).unwrap_or(0.0);
        let named = self.parameters.spindles.iter().map(|(number, _)| u16::from(*number));
        let known = named.chain([0]).find(|known| (f64::from(*known) - number).abs() < 1e-9);
        let axis = known.and_then(|known| self.parameters.spindle(known)).ok_or(VariableRefusal::FirstIndex)?;
        let spindle = self.spindles[axis].as_deref().ok_or(VariableRefusal::FirstIndex)?;
        let known = known.filter(|known| *known != 0).unwrap_or_else(|| self.parameters.master_spindle.into());
        let prepared = self.prepared_spindles.iter().find(|(of, ..)| *of == known);
        let actual = self.axes[axis].velocity / REVOLUTION_PER_MINUTE;
        Ok(match variable.name {
            "$AA_S" => Value::Real(actual),
            "$P_S" => Value::Real(prepared.map_or(spindle.speed, |(_, speed, _)| *speed)),
            "$P_SDIR" => {
                Value::Int(prepared.map_or_else(|| spindle.direction_in_words(), |(.., direction)| *direction))
            }
            "$AC_SDIR" => Value::Int(spindle.direction_in_words()),
            "$AC_SMODE" => Value::Int(match spindle.mode {
                Mode::Control => 1,
                Mode::Positioning(_) => 2,
                Mode::Axis => 4,
            }),
            _ => Value::Int(spindle.gear_stage.into()),
        })
    }

    /// `$P_UIFR[1]`: the offsets of all axes that have one.
    fn settable_frame(&self, variable: &SystemVariable<'_>) -> Result<Vec<(AxisIndex, f64)>, VariableRefusal> {
        let index = settable_index(variable.indices.first())?;
        let mut offsets = Vec::new();
        for &axis in &self.parameters.axes.path {
            let offset = self.program.settable_offset(index, axis);
            let name = self.parameters.axes.machine_axes.iter().position(|other| *other == axis);
            if let (Some(name), true) = (name.and_then(|name| u16::try_from(name).ok()), offset != Position::ZERO) {
                offsets.push((AxisIndex(name), offset.user() / self.unit(axis)));
            }
        }
        Ok(offsets)
    }

    /// `$P_UIFR[1]=CTRANS(X,10)`: an axis without an offset gets 0.
    pub(super) fn set_settable_frame(
        &mut self,
        variable: &SystemVariable<'_>,
        value: &Value,
    ) -> Result<(), VariableRefusal> {
        let index = settable_index(variable.indices.first())?;
        let Value::Frame(offsets) = value else { return Err(VariableRefusal::WrongType) };
        let mut axes = Vec::new();
        for (name, offset) in offsets {
            let axis = self.axis(Some(&Value::Axis(*name)))?;
            axes.push((axis, Position::from_user(*offset * self.unit(axis))));
        }
        for &axis in &self.parameters.axes.path {
            let offset = axes.iter().find(|(other, _)| *other == axis).map_or(Position::ZERO, |(_, offset)| *offset);
            self.program.set_settable_offset(index, axis, offset);
        }
        Ok(())
    }

    /// `$P_UIFR[1,X,TR]`: the index in G group 8 and the axis.
    pub(super) fn settable_offset(&self, variable: &SystemVariable<'_>) -> Result<(u8, AxisNumber), VariableRefusal> {
        let [number, axis, part] = variable.indices else { return Err(VariableRefusal::FirstIndex) };
        let index = settable_index(Some(number))?;
        let axis = self.axis(Some(axis))?;
        match part {
            Value::Text(part) if part == "TR" => {}
            // Rotation, scale and mirror image.
            _ => return Err(VariableRefusal::NotModelled),
        }
        Ok((index, axis))
    }

    /// The variables of an axis, which is their index; of a spindle; of settable offsets. `None` for any other name.
    pub(super) fn axis_value(&self, variable: &SystemVariable<'_>) -> Option<Result<Value, VariableRefusal>> {
        let named = self.axis(variable.indices.first());
        let of = |value: &dyn Fn(AxisNumber) -> Value| Some(named.map(value));
        let axes = self.axes;
        let length = |axis: AxisNumber, position: Position| Value::Real(position.user() / self.unit(axis));
        let compensation =
            |axis: AxisNumber, increments: f64| Value::Real(increments / Position::PER_USER_UNIT / self.unit(axis));
        match variable.name {
            "$AA_IM" => of(&|axis| length(axis, axes[axis].setpoint.position + axes[axis].overlay.position())),
            // Without a transformation the basic coordinates are those of the machine.
            "$AA_IB" => of(&|axis| length(axis, axes[axis].setpoint.position)),
            "$AA_IW" => of(&|axis| {
                let offset = self.offset(axis, self.program.modal, &self.program.programmable);
                length(axis, axes[axis].setpoint.position - offset)
            }),
            "$VA_IM" => of(&|axis| {
                let own = &axes[axis];
                if own.signals.disabled_at.is_some() && !self.all.axes[axis].actual_while_disabled {
                    // With axis disable the setpoint, unless MD30455 bit 3 says otherwise.
                    return length(axis, own.setpoint.position + own.overlay.position());
                }
                length(axis, own.actual + own.overlay.position() + own.compensation.setpoint)
            }),
            "$AC_DRF" => of(&|axis| length(axis, axes[axis].overlay.target)),
            "$VA_ENC1_COMP_VAL" => of(&|axis| length(axis, axes[axis].compensation.encoder[0])),
            "$VA_ENC2_COMP_VAL" => of(&|axis| length(axis, axes[axis].compensation.encoder[1])),
            "$VA_CEC_COMP_VAL" => of(&|axis| compensation(axis, axes[axis].compensation.sag)),
            "$VA_TEMP_COMP_VAL" => of(&|axis| compensation(axis, axes[axis].compensation.temperature)),
            "$P_EP" => Some(named.and_then(|axis| self.prepared_end(axis))),
            "$AA_TYP" => of(&|axis| Value::Int(self.owners.axis_type(axis, self.channel, self.coupled.contains(axis)))),
            "$AA_AXCHANGE_TYP" => of(&|axis| {
                let (data, moves) = (self.all.axes[axis].plc_axis, self.single.moving.contains(axis));
                Value::Int(self.owners.exchange_type((axis, data), self.channel, moves))
            }),
            "$AA_SNGLAX_STAT" => of(&|axis| {
                let is_single = matches!(self.owners.of(axis).holder, Holder::Plc | Holder::Command);
                Value::Int(self.single.status(axis, is_single))
            }),
            "$AA_REF" => of(&|axis| Value::Int(i32::from(axes[axis].is_referenced()))),
            "$AA_S" | "$P_S" | "$P_SDIR" | "$AC_SDIR" | "$AC_SMODE" | "$AC_SGEAR" => Some(self.spindle_value(variable)),
            "$P_UIFR" if variable.indices.len() == 1 => Some(self.settable_frame(variable).map(Value::Frame)),
            "$P_UIFR" => {
                let of_axis = self.settable_offset(variable);
                Some(of_axis.map(|(index, axis)| length(axis, self.program.settable_offset(index, axis))))
            }
            _ => None,
        }
    }

    /// $P_EP: where the prepared blocks end, without offsets.
    fn prepared_end(&self, axis: AxisNumber) -> Result<Value, VariableRefusal> {
        let place = self.parameters.axes.place(axis).ok_or(VariableRefusal::Axis)?;
        let offset = self.offset(axis, self.modal, &self.offset);
        let end = (self.end[place] - offset.increments() as f64) / Position::PER_USER_UNIT;
        Ok(Value::Real(end / self.unit(axis)))
    }
}

/// The index in the group of settable offsets: $P_UIFR[1] is G54, index 2 of its group; [5] is G505, index 6.
fn settable_index(number: Option<&Value>) -> Result<u8, VariableRefusal> {
    let number = whole_index(number, 100).filter(|number| *number > 0);
    number.map(|number| number + 1).ok_or(VariableRefusal::FirstIndex)
}
