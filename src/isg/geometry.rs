//! From a block with axes to a piece of the path: lines, arcs and full circles, in the unit of the path.

use super::channel::Modal;
use super::language::Block;
use super::messages;
use super::program::Outcome;
use super::refused::Refused;
use super::refused::{unknown, value};
use super::state::State;
use crate::motion::path::{Circle, Feed, PATH_AXES, PathBlock, Refused as PathRefused, Turn, Way};
use crate::units::{AxisNumber, Position};

/// How far the radii at start and end of an arc may differ: 0.01 mm.
const RADII: f64 = 10_000.0;
/// The farthest position of a block, in increments: ten kilometres.
const FARTHEST: f64 = 1e13;

impl State {
    /// Appends the movement of a block to the path.
    pub(super) fn append_motion(&mut self, index: usize, block: &Block, modal: &Modal) -> Outcome {
        if self.channels[index].has_moved() {
            let named: Vec<AxisNumber> =
                block.axes.iter().filter_map(|(name, _)| self.channels[index].axis_named(name)).collect();
            self.place_path(index, &named);
            let position = self.channels[index].path.as_ref().map(|path| path.position());
            self.channels[index].end = position.unwrap_or_default();
        }
        let channel = &self.channels[index];
        let start = channel.end;
        let mut end = start;
        for (name, word) in &block.axes {
            let axis = channel.axis_named(name).ok_or_else(|| unknown(name))?;
            if channel.is_slave(axis) {
                return Err(Refused::axis(messages::LINK_SLAVE_PROGRAMMED, axis));
            }
            let is_modulo = self.axes[axis].parameters.modulo.is_some();
            if let Some((_, fault)) = block.two_signs.iter().find(|(other, _)| other == name && !is_modulo) {
                return Err(self.refused_by(index, fault));
            }
            // A block whose axes the path does not have waits until it stands, and is then placed anew.
            let place = channel.path_axes.iter().position(|other| *other == axis);
            let place = place.ok_or_else(|| value(&format!("more than {PATH_AXES} axes")))?;
            let way = word * Position::PER_USER_UNIT;
            let sign = block.signs.iter().find(|(other, _)| other == name).map(|(_, sign)| *sign);
            end[place] = match (modal.absolute, self.axes[axis].parameters.modulo) {
                (false, _) => start[place] + way,
                (true, None) => way,
                // P-CHAN-00346: the sign belongs to the position.
                (true, Some(modulo)) if channel.always_shortest_way => modulo.target(start[place], way, None),
                (true, Some(modulo)) => modulo.target(start[place], way, sign),
            };
            if !end[place].is_finite() || end[place].abs() > FARTHEST {
                return Err(value(&format!("{name} is too far")));
            }
            end[place] = end[place].round();
        }
        let counted = std::array::from_fn(|place| {
            channel.path_axes.get(place).is_some_and(|axis| !self.axes[*axis].parameters.is_rotary)
        });
        let feed = if modal.motion == 0 {
            Feed::Rapid
        } else {
            let feed = modal.feed * Position::PER_USER_UNIT / 60.0;
            if feed <= 0.0 {
                return Err(value("no feed: neither an F word nor P-CHAN-00099 gives one"));
            }
            Feed::Programmed(feed)
        };
        let way = match modal.motion {
            0 | 1 => Way::line(start, end, counted),
            _ => {
                let circle = self.circle(index, block, modal, start, end)?;
                let arc = Way::arc(start, end, circle, RADII, counted);
                arc.map_err(|_| value("the circle does not close"))?
            }
        };
        let channel = &mut self.channels[index];
        channel.next_block += 1;
        let number = channel.next_block;
        let exact_stop = channel.inputs.single_block;
        let Some(path) = &mut channel.path else { return Ok(()) };
        match path.append(PathBlock { way, feed, exact_stop, number }, self.cycle.0.seconds()) {
            Ok(()) => channel.blocks.push_back((number, block.origin.block())),
            Err(PathRefused::NoWay | PathRefused::Full) => {}
        }
        channel.end = end;
        Ok(())
    }

    /// The circle of G02 or G03: its centre counts from the start (G162), or is a position (G161).
    fn circle(
        &self,
        index: usize,
        block: &Block,
        modal: &Modal,
        start: [f64; PATH_AXES],
        end: [f64; PATH_AXES],
    ) -> Result<Circle, Refused> {
        let channel = &self.channels[index];
        let is_absolute = modal.centre_absolute;
        let (first, second) = match modal.plane {
            18 => (2, 0),
            19 => (1, 2),
            _ => (0, 1),
        };
        let place = |main: u16| {
            let member = channel.member_at(main)?;
            channel.path_axes.iter().position(|axis| *axis == member.axis)
        };
        let plane = place(first).zip(place(second)).ok_or_else(|| value("no axes of the plane"))?;
        let plane = [plane.0, plane.1];
        let clockwise = modal.motion == 2;
        let turn = if clockwise { Turn::Clockwise } else { Turn::Counterclockwise };
        let centre = match block.radius {
            Some(radius) => {
                let [dx, dy] = plane.map(|axis| end[axis] - start[axis]);
                let chord = (dx * dx + dy * dy).sqrt();
                let radius_in_increments = radius.abs() * Position::PER_USER_UNIT;
                let square = radius_in_increments * radius_in_increments - 0.25 * chord * chord;
                if chord < 0.5 || square < -RADII * radius_in_increments {
                    return Err(value("the circle does not close"));
                }
                let height = square.max(0.0).sqrt() / chord;
                // The centre is left of the chord on a counterclockwise arc of less than half a turn.
                let side = if clockwise == (radius < 0.0) { height } else { -height };
                let [x, y] = plane.map(|axis| 0.5 * (start[axis] + end[axis]));
                [x - side * dy, y + side * dx]
            }
            None => {
                let word = |main: u16| block.centre[usize::from(main)].map(|word| word * Position::PER_USER_UNIT);
                let place = |axis: usize, word: Option<f64>| match word {
                    Some(word) if is_absolute => word,
                    word => start[axis] + word.unwrap_or(0.0),
                };
                [place(plane[0], word(first)), place(plane[1], word(second))]
            }
        };
        Ok(Circle { plane, centre, turn, turns: 0 })
    }
}
