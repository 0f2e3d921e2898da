//! Blocks whose axes go on their own ways: POS and POSA, and the axes of rapid traverse with MD20730 = 0.

use crate::motion::path::{PerPathAxis, Way};
use crate::nc_program::{Action, Block};
use crate::sinumerik::alarms::programs as alarms;
use crate::sinumerik::parameters::programs::ProgramParameters;
use crate::sinumerik::program::environment::Channel;
use crate::sinumerik::program::executable::Executable;
use crate::sinumerik::program::positioning::{AxisPositioning, Handwheel};
use crate::sinumerik::program::preparation::{Preparing, block_parameter};
use crate::sinumerik::program::state::{BlockAlarm, Preparation, Run, block_name, on_path};
use crate::units::{AxisNumber, Position};
use crate::variables::{Parameter, short_text};

impl Preparing<'_> {
    /// POS and POSA of a block.
    pub(super) fn take_positions(
        &self,
        block: &Block,
        run: &mut Run,
        end: &mut PerPathAxis,
        done: &mut Executable,
        channel: &mut Channel<'_>,
    ) -> Result<(), BlockAlarm> {
        // After the feeds of the same block, in whatever order they are written.
        for action in &block.actions {
            let Action::Position { target, waits } = action else { continue };
            let (axis, place) = self.path_axis(block, target.axis)?;
            let programmed = run.axis_feeds.iter().find(|(of, _)| *of == axis).map(|(_, feed)| *feed);
            let by_handwheel = block.actions.iter().find_map(|action| match action {
                Action::HandwheelFeed(of, feed) => {
                    self.path_axis(block, *of).ok().filter(|(of, _)| *of == axis).map(|_| *feed)
                }
                _ => None,
            });
            let handwheel = match by_handwheel {
                None => Handwheel::None,
                Some(feed) if feed > 0.0 => Handwheel::Velocity,
                Some(_) => Handwheel::Way,
            };
            let velocity = match by_handwheel.filter(|feed| *feed > 0.0).or(programmed) {
                Some(feed) => self.parameters.axes[axis].velocity_of_feed(feed),
                None => self.parameters.axes[axis].positioning_velocity,
            };
            if velocity <= 0.0 {
                let parameters = [Parameter::Axis(axis), block_parameter(block), Parameter::None];
                let number = alarms::NO_POSITIONING_VELOCITY;
                return Err(BlockAlarm { number, parameters, block: block_name(&block.origin.name) });
            }
            let start = *end;
            end[place] = self.target(block, target, (axis, place), start[place], run, channel);
            self.check_position(block, target.axis, end[place])?;
            let way = Way::line(start, *end, self.own.axes.counted);
            self.check_limits(block, &way, &start, end)?;
            #[expect(clippy::cast_possible_truncation, reason = "a position fits")]
            let target = Position::new(end[place].round() as i64);
            let velocity = velocity.min(self.parameters.axes[axis].maximum_velocity);
            run.programmed_on_path.set(axis, false);
            done.positions.push(AxisPositioning {
                axis,
                target,
                velocity,
                waits: *waits,
                is_rapid: false,
                handwheel,
                block: block_name(&block.origin.name),
            });
        }
        Ok(())
    }

    /// Rapid traverse with MD20730 = 0: each axis goes alone, with its own velocity; the block ends when all of them are there.
    pub(super) fn go_separately(&self, start: &PerPathAxis, end: &PerPathAxis, done: &mut Executable) {
        for (place, &axis) in self.own.axes.path.iter().enumerate() {
            let moves = (end[place] - start[place]).abs() >= 0.5;
            if moves && !done.positions.iter().any(|one| one.axis == axis) {
                #[expect(clippy::cast_possible_truncation, reason = "a position fits")]
                let target = Position::new(end[place].round() as i64);
                let velocity = self.parameters.axes[axis].maximum_velocity;
                done.positions.push(AxisPositioning {
                    axis,
                    target,
                    velocity,
                    waits: true,
                    is_rapid: true,
                    handwheel: Handwheel::None,
                    block: block_name(&done.origin.name),
                });
            }
        }
    }
}

impl Run {
    /// Everything has been executed: what is prepared now begins where the axes are, because something else may have moved them. From JOG they
    /// return to where the program has left them. What POSA still moves begins at its target.
    pub(super) fn begin_where_axes_are(&mut self, preparing: &Preparing<'_>) {
        let mut end = on_path(&preparing.own.axes.path, |axis| {
            let left = self.left.iter().find(|(of, _)| *of == axis);
            left.map_or(preparing.axes[axis].setpoint.position, |(_, position)| *position)
        });
        self.end_of_ways(preparing.own, &mut end);
        self.end = end;
    }

    /// The next block is not executed: the program stands before it with an alarm.
    pub(super) fn refuse_next(&mut self, alarm: BlockAlarm) {
        let Some(next) = self.queue.pop_front() else { return };
        self.queue.clear();
        self.again.clear();
        let place = (next.origin.program, next.origin.line);
        self.preparation = Preparation::Failed { alarm, reason: String::new(), place, block: next.block };
    }

    /// Whether the program stands before a block with 10610, while its axis still moves.
    pub(in crate::sinumerik) fn stands_before_moving_axis(&self) -> bool {
        let is_named = |alarm: &BlockAlarm| alarm.number == alarms::STILL_POSITIONED;
        matches!(&self.preparation, Preparation::Failed { alarm, .. } if is_named(alarm)) && self.queue.is_empty()
    }

    /// 10610: the next block names an axis that a POSA still moves.
    pub(super) fn still_positioned(&self, own: &ProgramParameters) -> Option<BlockAlarm> {
        let next = self.queue.front()?;
        let words = next.block.as_deref().map_or(&[][..], |read| &read.block.axes);
        let on_path = words.iter().filter_map(|word| own.axes.machine_axes.get(usize::from(word.axis.0)).copied());
        let mut named = next.positions.iter().map(|positioning| positioning.axis).chain(on_path);
        let moves = |axis: &AxisNumber| self.positionings.iter().any(|one| one.axis == *axis);
        let again = named.find(|axis| moves(axis) && !self.commanded.contains(*axis))?;
        let name = &next.origin.name;
        let parameters = [Parameter::Axis(again), Parameter::Text(short_text(name)), Parameter::None];
        Some(BlockAlarm { number: alarms::STILL_POSITIONED, parameters, block: block_name(name) })
    }
}
