//! What a block does besides moving and output, while it is prepared: its axes, spindles and channels are tested, and what counts for the blocks
//! that follow is applied. What acts when the block runs is in `actions.rs`.

use crate::control::{Owner, Value};
use crate::motion::path::{PATH_AXES, PerPathAxis};
use crate::nc_program::{Action, AxisIndex, Block, INCH};
use crate::sinumerik::alarms::programs as alarms;
use crate::sinumerik::machine_data::Target;
use crate::sinumerik::program::environment::Channel;
use crate::sinumerik::program::executable::Executable;
use crate::sinumerik::program::geometry;
use crate::sinumerik::program::preparation::{Preparing, alarm};
use crate::sinumerik::program::state::{BlockAlarm, Run};
use crate::units::{AxisNumber, Position, Time};
use crate::variables::Parameter;

impl Preparing<'_> {
    /// The actions of a block: tests their axes, spindles and channels, and applies what counts for the blocks that follow.
    pub(super) fn take_actions(
        &self,
        block: &Block,
        run: &mut Run,
        end: &mut PerPathAxis,
        done: &mut Executable,
        channel: &mut Channel<'_>,
    ) -> Result<(), BlockAlarm> {
        for action in &block.actions {
            match action {
                Action::DwellSeconds(seconds) => {
                    done.dwell = Time::from_seconds(*seconds).in_cycles(self.parameters.cycle).max(1);
                }
                Action::AxisFeed(name, feed) => {
                    let (axis, _) = self.path_axis(block, *name)?;
                    let is_rotary = self.parameters.axes[axis].rotary;
                    let unit = if is_rotary { 1.0 } else { geometry::feed_unit(block, self.parameters.is_inch) };
                    run.axis_feeds.retain(|(of, _)| *of != axis);
                    run.axis_feeds.push((axis, feed * unit));
                }
                Action::Reference(names) => {
                    for name in names {
                        done.references.push(self.referenced_axis(block, *name)?);
                    }
                }
                Action::Message(_) | Action::CycleAlarm { .. } | Action::NewConfiguration | Action::EndOverlays => {
                    done.actions.push(action.clone());
                }
                Action::SetMarks(_) | Action::ClearMarks(_) => done.actions.push(action.clone()),
                Action::WaitMark { channels, .. } | Action::Start(channels) | Action::WaitEnd(channels) => {
                    self.check_channels(block, channels)?;
                    done.actions.push(action.clone());
                }
                Action::Initialise { channel, .. } => {
                    self.check_channels(block, std::slice::from_ref(channel))?;
                    done.actions.push(action.clone());
                }
                Action::Preset(axes) => {
                    for (name, _) in axes {
                        self.path_axis(block, *name)?;
                    }
                    done.actions.push(action.clone());
                }
                Action::Coupling { is_on, following, leading, .. } => {
                    return Err(self.coupling(block, *is_on, *following, *leading));
                }
                Action::Limit { is_upper, axes, spindles } => {
                    for (spindle, _) in spindles {
                        self.known_spindle(block, spindle.unwrap_or(0))?;
                    }
                    if !spindles.is_empty() {
                        done.actions.push(action.clone());
                    }
                    for (name, value) in axes {
                        self.set_working_area(block, (*name, *value), *is_upper, channel)?;
                    }
                    // The limits act on the next block.
                    run.pauses = true;
                }
                Action::Position { .. } | Action::HandwheelFeed(..) => {}
                Action::PathHandwheelFeed(_) => done.by_handwheel = true,
                Action::WaitForPosition(names) => {
                    for name in names {
                        self.check_positioning_axis(block, *name, run)?;
                    }
                    done.actions.push(action.clone());
                }
                Action::Release(names) | Action::Get { axes: names, .. } => {
                    for name in names {
                        self.path_axis(block, *name)?;
                    }
                    done.actions.push(action.clone());
                }
                Action::DwellRevolutions { spindle, revolutions } => {
                    let axis = self.known_spindle(block, spindle.unwrap_or(0))?;
                    done.dwell_turns = Some((axis, revolutions * 360.0 * Position::PER_USER_UNIT));
                }
                Action::SpindlePosition { spindle, value, dimension, .. } => {
                    let axis = self.known_spindle(block, spindle.unwrap_or(0))?;
                    if !self.parameters.axes[axis].is_within_modulo(*value, *dimension) {
                        return Err(alarm(block, alarms::OUTSIDE_MODULO_RANGE, Parameter::Axis(axis)));
                    }
                    done.actions.push(action.clone());
                }
                Action::WaitForSpindle(spindles) => {
                    for spindle in spindles.iter().copied().chain(spindles.is_empty().then_some(0)) {
                        self.known_spindle(block, spindle)?;
                    }
                    done.actions.push(action.clone());
                }
                Action::Acceleration(name, _) => {
                    self.path_axis(block, *name)?;
                    done.actions.push(action.clone());
                }
                Action::FeedGroup(names) => run.counted = self.feed_group(block, names)?,
                Action::Override(percent) => run.path_override = percent / 100.0,
                Action::Synchronised(_) | Action::Cancel(_) => done.actions.push(action.clone()),
            }
        }
        self.take_positions(block, run, end, done, channel)
    }

    /// 14020: a channel that does not exist.
    fn check_channels(&self, block: &Block, channels: &[u16]) -> Result<(), BlockAlarm> {
        let exists = |number: &u16| {
            self.parameters.existing_channels().any(|(channel, _)| u16::from(channel.number()) == *number)
        };
        if channels.iter().all(exists) {
            return Ok(());
        }
        Err(alarm(block, alarms::WRONG_PARAMETER, Parameter::None))
    }

    /// G25, G26: SD43430 and SD43420, in the basic system.
    fn set_working_area(
        &self,
        block: &Block,
        (name, value): (AxisIndex, f64),
        is_upper: bool,
        channel: &mut Channel<'_>,
    ) -> Result<(), BlockAlarm> {
        let (axis, _) = self.path_axis(block, name)?;
        let limit = geometry::length(value, block, self.parameters.axes[axis].rotary);
        let inches = self.parameters.is_inch && !self.parameters.axes[axis].rotary;
        let value = limit / Position::PER_USER_UNIT / if inches { INCH } else { 1.0 };
        let number = if is_upper { 43420 } else { 43430 };
        if let Ok(target) = Target::new(number, Owner::Axis(axis), 0) {
            channel.written.push((target, Value::Real(value)));
        }
        Ok(())
    }

    /// An axis of G74: no spindle, and no axis of an open grouping, neither its leading axis (E-15, P-60).
    fn referenced_axis(&self, block: &Block, name: AxisIndex) -> Result<AxisNumber, BlockAlarm> {
        let named = self.own.axes.machine_axes.get(usize::from(name.0));
        if named.is_some_and(|axis| self.parameters.axes[*axis].spindle.is_some()) {
            return Err(alarm(block, alarms::WRONG_AXIS_TYPE, self.name(name)));
        }
        let axis = self.path_axis(block, name).ok().filter(|(axis, _)| !self.open.contains(*axis));
        axis.map(|(axis, _)| axis).ok_or_else(|| alarm(block, alarms::REFERENCING_COUPLED, self.name(name)))
    }

    /// The axes of FGROUP, as places in the path; without one the geometry axes.
    fn feed_group(&self, block: &Block, names: &[AxisIndex]) -> Result<[bool; PATH_AXES], BlockAlarm> {
        if names.is_empty() {
            return Ok(self.own.axes.counted);
        }
        let mut counted = [false; PATH_AXES];
        for name in names {
            counted[self.path_axis(block, *name)?.1] = true;
        }
        Ok(counted)
    }

    /// 14092 for WAITP of an axis that the program moves on the path: it is no positioning axis.
    fn check_positioning_axis(&self, block: &Block, name: AxisIndex, run: &Run) -> Result<(), BlockAlarm> {
        let (axis, _) = self.path_axis(block, name)?;
        if run.programmed_on_path.contains(axis) {
            return Err(alarm(block, alarms::WRONG_AXIS_TYPE, self.name(name)));
        }
        Ok(())
    }
}
