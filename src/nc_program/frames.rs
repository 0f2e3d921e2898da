//! Frames: only their offsets exist (CTRANS, `$P_PFRAME`, variables of type FRAME, `$P_UIFR`).

use super::alarm::{Fault, Span};
use super::names::AxisIndex;
use super::value::{Type, Value};
use super::variables::Variable;

/// The offset of an axis; 0 without one.
pub(super) fn offset_of(offsets: &[(AxisIndex, f64)], axis: AxisIndex) -> f64 {
    offsets.iter().find(|(other, _)| *other == axis).map_or(0.0, |(_, offset)| *offset)
}

/// Sets the offset of an axis.
pub(super) fn set_offset(offsets: &mut Vec<(AxisIndex, f64)>, axis: AxisIndex, value: f64) {
    offsets.retain(|(other, _)| *other != axis);
    offsets.push((axis, value));
}

/// Two offsets one after the other: their sum.
pub(super) fn chained(left: &[(AxisIndex, f64)], right: &[(AxisIndex, f64)]) -> Vec<(AxisIndex, f64)> {
    let mut sum = left.to_vec();
    for (axis, offset) in right {
        let before = offset_of(&sum, *axis);
        set_offset(&mut sum, *axis, before + offset);
    }
    sum
}

/// CTRANS: pairs of an axis and its offset.
pub(super) fn ctrans(values: &[Value], at: Span) -> Result<Value, Fault> {
    let mut offsets: Vec<(AxisIndex, f64)> = Vec::new();
    for pair in values.chunks(2) {
        let [axis, offset] = pair else {
            return Err(Fault::new(14020, at, "CTRANS has pairs of an axis and an offset"));
        };
        let Value::Axis(axis) = axis else {
            return Err(Fault::new(12040, at, format!("an axis is needed, this is {}", axis.of_type().name())));
        };
        let unfit = || Fault::new(12150, at, format!("an offset is a number, this is {}", offset.of_type().name()));
        if offsets.iter().any(|(other, _)| other == axis) {
            return Err(Fault::new(14020, at, "an axis has two offsets"));
        }
        offsets.push((*axis, offset.number().ok_or_else(unfit)?));
    }
    Ok(Value::Frame(offsets))
}

/// The axis whose offset the last indices of a variable mean: `FRAMES[2,X,TR]`.
pub(super) fn component(variable: &Variable, indices: &[Value], at: Span) -> Result<Option<AxisIndex>, Fault> {
    let count = variable.dimensions.len();
    if variable.kind != Type::Frame || indices.len() != count + 2 {
        return Ok(None);
    }
    axis_of_offset(&indices[count..], at).map(Some)
}

/// `$P_PFRAME`, or the axis of `$P_PFRAME[X,TR]`.
pub(super) fn programmable(indices: &[Value], at: Span) -> Result<Option<AxisIndex>, Fault> {
    if indices.is_empty() { Ok(None) } else { axis_of_offset(indices, at).map(Some) }
}

/// The axis of `X,TR`.
fn axis_of_offset(indices: &[Value], at: Span) -> Result<AxisIndex, Fault> {
    match indices {
        [Value::Axis(axis), Value::Text(part)] if part == "TR" => Ok(*axis),
        [Value::Axis(_), Value::Text(_)] => Err(Fault::refused(at, "a part of a frame other than its offset (TR)")),
        [_, Value::Text(_)] => Err(Fault::new(12040, at, "the axis of the offset is missing")),
        _ => Err(Fault::new(12400, at, "the offset of an axis is `[X,TR]`")),
    }
}
