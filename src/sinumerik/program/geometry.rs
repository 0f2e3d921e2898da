//! Geometry of a block: units, offsets, targets in machine coordinates, circles.

use crate::motion::path::{Circle, PATH_AXES, PerPathAxis, Turn, Way};
use crate::nc_program::{self, AxisIndex, Block, Dimension, INCH, Modal, g, groups};
use crate::sinumerik::parameters::programs::{ProgramAxes, ProgramParameters};
use crate::units::{AxisNumber, Position};

/// A whole turn of a modulo axis, in increments.
const TURN: f64 = 360.0 * Position::PER_USER_UNIT;

/// G53, SUPA, G153: the block has no settable and no programmable offset.
pub(in crate::sinumerik) fn suppresses_offsets(block: &Block) -> bool {
    block.once.iter().any(|function| function.group == groups::SUPPRESSION)
}

/// SUPA: the block has no DRF offset either.
pub(in crate::sinumerik) fn suppresses_overlays(block: &Block) -> bool {
    block.once.contains(&g::SUPA)
}

/// G9, or G60 until G64.
pub(in crate::sinumerik) fn is_exact_stop(block: &Block) -> bool {
    block.once.contains(&g::G9) || block.modal.is(g::G60)
}

/// Whether feeds and system variables are in inches. G70 and G71 leave them in the basic system, G700 and G710 do not.
pub(in crate::sinumerik) fn is_inch(modal: Modal, basic_is_inch: bool) -> bool {
    modal.is(g::G700) || basic_is_inch && !modal.is(g::G710)
}

/// The unit of feeds in millimetres.
pub(in crate::sinumerik) fn feed_unit(block: &Block, basic_is_inch: bool) -> f64 {
    if is_inch(block.modal, basic_is_inch) { INCH } else { 1.0 }
}

/// The path feed in increments per second.
pub(in crate::sinumerik) fn feed(per_minute: f64, block: &Block, basic_is_inch: bool) -> f64 {
    per_minute * feed_unit(block, basic_is_inch) * Position::PER_USER_UNIT / 60.0
}

/// G95: the feed is in mm per revolution of the master spindle.
pub(in crate::sinumerik) fn is_per_revolution(block: &Block) -> bool {
    block.modal.is(g::G95)
}

/// A programmed length in increments.
pub(in crate::sinumerik) fn length(value: f64, block: &Block, is_rotary: bool) -> f64 {
    let factor = if block.modal.is_inch() && !is_rotary { INCH } else { 1.0 };
    Position::from_user(value * factor).increments() as f64
}

/// The target of an axis in machine coordinates, in increments: `value` is programmed, `from` is where the axis is before.
pub(in crate::sinumerik) fn target(value: f64, dimension: Dimension, from: f64, offset: f64, is_modulo: bool) -> f64 {
    let absolute = value + offset;
    match dimension {
        Dimension::Incremental => from + value,
        Dimension::Absolute if is_modulo => {
            // Within the turn in which the axis is.
            (from / TURN).floor() * TURN + absolute.rem_euclid(TURN)
        }
        Dimension::Absolute => absolute,
        Dimension::Shortest => {
            let ahead = (absolute - from).rem_euclid(TURN);
            from + if ahead > TURN / 2.0 { ahead - TURN } else { ahead }
        }
        Dimension::FromPlus => from + (absolute - from).rem_euclid(TURN),
        Dimension::FromMinus => from - (from - absolute).rem_euclid(TURN),
    }
}

/// Why a circle cannot be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sinumerik) enum BadCircle {
    /// 14040.
    EndPoint,
    /// 14095.
    Radius,
    /// 10800: the plane has an axis that the channel does not have.
    NoPlane,
}

/// The plane of a block as places in the path, and the letters of its centre: I, J, K as 0 to 2.
fn plane(block: &Block, axes: &ProgramAxes) -> Option<([usize; 2], [usize; 2])> {
    let letters = if block.modal.is(g::G18) {
        [2, 0]
    } else if block.modal.is(g::G19) {
        [1, 2]
    } else {
        [0, 1]
    };
    Some(([axes.geometry[letters[0]]?, axes.geometry[letters[1]]?], letters))
}

/// The arc of a block with G2 or G3, from `start` to `end` in increments. `offset` is that of a path axis. With an opening angle and a centre the
/// end of the arc follows from them. `counted` are the axes that the feed refers to.
pub(in crate::sinumerik) fn arc(
    block: &Block,
    (parameters, counted): (&ProgramParameters, [bool; PATH_AXES]),
    start: PerPathAxis,
    mut end: PerPathAxis,
    offset: impl Fn(usize) -> f64,
) -> Result<Way, BadCircle> {
    let axes = &parameters.axes;
    let (plane, letters) = plane(block, axes).ok_or(BadCircle::NoPlane)?;
    let programmed = &block.circle;
    let clockwise = block.modal.is(g::G2);
    let turn = if clockwise { Turn::Clockwise } else { Turn::Counterclockwise };
    let from = plane.map(|place| start[place]);
    let to = plane.map(|place| end[place]);
    let has_centre = programmed.centre.iter().any(Option::is_some);
    let chord = ((to[0] - from[0]) * (to[0] - from[0]) + (to[1] - from[1]) * (to[1] - from[1])).sqrt();
    if has_centre && letters.iter().all(|letter| programmed.centre[*letter].is_none()) {
        // The centre is given beside the plane only.
        return Err(BadCircle::EndPoint);
    }
    let centre = if has_centre {
        std::array::from_fn(|index| {
            let (place, letter) = (plane[index], letters[index]);
            programmed.centre[letter].map_or(start[place], |centre| {
                let value = length(centre.value, block, false);
                if centre.is_absolute { value + offset(place) } else { start[place] + value }
            })
        })
    } else {
        let radius = match (programmed.radius, programmed.opening_angle) {
            (Some(radius), _) => length(radius, block, false),
            (None, Some(angle)) => {
                // The chord is 2·r·sin(angle / 2); more than 180° is the greater arc.
                let sine = nc_program::sin(angle / 2.0);
                if sine.abs() < 1e-12 {
                    return Err(BadCircle::Radius);
                }
                let radius = chord / (2.0 * sine);
                if angle > 180.0 { -radius } else { radius }
            }
            (None, None) => return Err(BadCircle::EndPoint),
        };
        centre_by_radius(from, to, chord, radius, clockwise)?
    };
    if let (Some(angle), true) = (programmed.opening_angle, has_centre) {
        let angle = if clockwise { -angle } else { angle };
        let (sine, cosine) = (nc_program::sin(angle), nc_program::cos(angle));
        let [x, y] = [from[0] - centre[0], from[1] - centre[1]];
        end[plane[0]] = (centre[0] + x * cosine - y * sine).round();
        end[plane[1]] = (centre[1] + x * sine + y * cosine).round();
    }
    let radius = ((from[0] - centre[0]) * (from[0] - centre[0]) + (from[1] - centre[1]) * (from[1] - centre[1])).sqrt();
    if radius < 1.0 {
        return Err(BadCircle::Radius);
    }
    let tolerance = parameters.circle_tolerance.max(parameters.circle_tolerance_share * radius);
    let circle = Circle { plane, centre, turn, turns: programmed.turns.unwrap_or(0).into() };
    Way::arc(start, end, circle, tolerance, counted).map_err(|_| BadCircle::EndPoint)
}

/// The centre of an arc with a radius; a negative one means the arc of more than 180°.
fn centre_by_radius(
    from: [f64; 2],
    to: [f64; 2],
    chord: f64,
    radius: f64,
    clockwise: bool,
) -> Result<[f64; 2], BadCircle> {
    if chord < 1.0 {
        return Err(BadCircle::EndPoint);
    }
    let half = chord / 2.0;
    let height = radius * radius - half * half;
    // A half circle whose end is rounded to an increment has no height.
    if radius.abs() + 1.0 < half {
        return Err(BadCircle::Radius);
    }
    let height = height.max(0.0).sqrt();
    let middle = [from[0] + (to[0] - from[0]) / 2.0, from[1] + (to[1] - from[1]) / 2.0];
    // To the right of the way from start to end.
    let right = [(to[1] - from[1]) / chord, -(to[0] - from[0]) / chord];
    let side = if clockwise == (radius > 0.0) { height } else { -height };
    Ok([middle[0] + right[0] * side, middle[1] + right[1] * side])
}

/// The programmable offset of an axis in increments.
pub(in crate::sinumerik) fn programmable_offset(block: &Block, axes: &ProgramAxes, axis: AxisNumber) -> f64 {
    offset_of(&block.offset, axes, axis).increments() as f64
}

/// The programmable offset of an axis among those of a block or of the preparation.
pub(in crate::sinumerik) fn offset_of(offsets: &[(AxisIndex, f64)], axes: &ProgramAxes, axis: AxisNumber) -> Position {
    let of_axis = |(name, _): &&(AxisIndex, f64)| axes.machine_axes.get(usize::from(name.0)) == Some(&axis);
    let found = offsets.iter().rev().find(of_axis);
    found.map_or(Position::ZERO, |(_, value)| Position::from_user(*value))
}

/// G0.
pub(in crate::sinumerik) fn is_rapid(block: &Block) -> bool {
    block.modal.is(g::G0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_modulo_axis_takes_the_way_that_is_programmed() {
        let degrees = |value: f64| value * Position::PER_USER_UNIT;
        let to = |value, dimension, from| target(degrees(value), dimension, degrees(from), 0.0, true) / degrees(1.0);
        // From 350°: the shortest way to 10° is plus 20°, from minus it is minus 340°.
        assert!((to(10.0, Dimension::Shortest, 350.0) - 370.0).abs() < 1e-9);
        assert!((to(10.0, Dimension::FromPlus, 350.0) - 370.0).abs() < 1e-9);
        assert!((to(10.0, Dimension::FromMinus, 350.0) - 10.0).abs() < 1e-9);
        assert!((to(10.0, Dimension::Absolute, 350.0) - 10.0).abs() < 1e-9);
        assert!((to(10.0, Dimension::Absolute, 710.0) - 370.0).abs() < 1e-9);
        assert!((to(10.0, Dimension::Incremental, 350.0) - 360.0).abs() < 1e-9);
        // MD30455 bit 0: 400° is 40°, and -15° is 345°.
        assert!((to(400.0, Dimension::Absolute, 350.0) - 40.0).abs() < 1e-9);
        assert!((to(-15.0, Dimension::Absolute, 350.0) - 345.0).abs() < 1e-9);
    }

    #[test]
    fn a_radius_puts_the_centre_on_the_side_of_the_shorter_arc() {
        // From (0, 0) to (10, 0) with r = 5: the centre is in the middle; with √50 it is 5 below (clockwise) or above.
        let root = 50.0_f64.sqrt();
        let centre = |radius, clockwise| centre_by_radius([0.0, 0.0], [10.0, 0.0], 10.0, radius, clockwise).unwrap();
        let near = |found: [f64; 2], wanted: [f64; 2]| (0..2).all(|index| (found[index] - wanted[index]).abs() < 1e-9);
        assert!(near(centre(5.0, true), [5.0, 0.0]));
        assert!(near(centre(root, true), [5.0, -5.0]) && near(centre(root, false), [5.0, 5.0]));
        assert!(near(centre(-root, true), [5.0, 5.0]) && near(centre(-root, false), [5.0, -5.0]));
        assert_eq!(centre_by_radius([0.0; 2], [10.0, 0.0], 10.0, 3.0, true), Err(BadCircle::Radius));
        assert_eq!(centre_by_radius([0.0; 2], [0.0; 2], 0.0, 3.0, true), Err(BadCircle::EndPoint));
    }
}
