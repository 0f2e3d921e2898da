//! The limits ahead of the path of a program. The preparation of a block has checked its way (10720, 10722, 10730); what has changed since then
//! stops the path here: the second software limit switch (12.2, 12.3), an offset by a handwheel, machine data, a working area of a synchronous
//! axis. The path brakes so that it stands before the limit, and the program stops with 10620 or 10630.

use crate::sinumerik::axis::limits::Barrier;
use crate::sinumerik::program::path::Stage;
use crate::sinumerik::program::state::Run;
use crate::sinumerik::state::{State, Unit};
use crate::units::ChannelNumber;
use crate::variables::{Input, Place};

impl State {
    /// Stops the program whose path would pass a limit if it braked later than now.
    pub(super) fn watch_limits_ahead(&mut self, run: &mut Run, stage: &Stage<'_>) {
        let Some((unit, barrier)) = self.limit_ahead(run, stage) else { return };
        let block = run.queue.front().map(|block| block.origin.name.clone()).unwrap_or_default();
        self.report_limit(&unit, &barrier, &block, stage.parameters, stage.to_nck);
        let inputs = self.limit_inputs(&barrier, stage.parameters, stage.to_nck);
        let event = self.log.note(Place::Channel(stage.channel), barrier.rule(), inputs, run.block_cause);
        run.stopping = Some(event);
    }

    fn limit_ahead(&self, run: &Run, stage: &Stage<'_>) -> Option<(Unit, Barrier)> {
        let path = run.returning.as_ref().unwrap_or(&run.path);
        if path.is_empty() || path.stands() {
            return None;
        }
        let now = path.position();
        let places = path.while_braking(stage.parameters.cycle.seconds());
        for (index, &axis) in stage.own.axes.path.iter().enumerate() {
            if run.leaves_alone(axis) || !self.owners.is_program_axis(axis, stage.channel) {
                continue;
            }
            for direction in [-1, 1] {
                let sign = f64::from(direction);
                let farthest = places.iter().map(|place| (place[index] - now[index]) * sign).fold(0.0, f64::max);
                if farthest < 0.5 {
                    continue;
                }
                let Some(unit) = self.unit_of(axis) else { continue };
                let barrier = self.barrier(&unit, direction, stage.parameters, stage.to_nck);
                let passed = |barrier: &Barrier| farthest > barrier.way.increments() as f64 * sign + 0.5;
                if let Some(barrier) = barrier.filter(passed) {
                    return Some((unit, barrier));
                }
            }
        }
        None
    }

    /// 10620 or 10630 of an axis of a channel stops its program.
    pub(super) fn stopped_at_limit(&self, channel: ChannelNumber) -> Option<(Input, crate::variables::EventId)> {
        self.alarm_of_limit(channel).map(|(number, cause)| (Input::Alarm(number.0), cause))
    }
}
