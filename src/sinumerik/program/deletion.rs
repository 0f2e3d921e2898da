//! Delete distance-to-go: DB21.DBX6.2 for the path, DB31.DBX2.2 of an axis that a program positions.

use crate::image::axis_to_nck;
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::program::path::Stage;
use crate::sinumerik::program::state::Run;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, AxisSet};
use crate::variables::Place;

impl State {
    /// DB21.DBX6.2: the path brakes, and the rest of its block is dropped.
    pub(super) fn delete_distance_to_go_of_path(&mut self, run: &mut Run, stage: &Stage<'_>) {
        let delete = stage.to_nck.channels[stage.channel].delete_distance_to_go();
        let was = std::mem::replace(&mut run.delete_was, delete);
        if delete && !was && !run.path.is_empty() && run.returning.is_none() {
            run.deleting = true;
        }
        let rests = |axis: &AxisNumber| {
            let is_on_path = self.owners.is_program_axis(*axis, stage.channel) && !run.leaves_alone(*axis);
            !is_on_path || self.axes[*axis].setpoint.is_at_rest()
        };
        if run.deleting && run.path.velocity() <= 0.0 && stage.own.axes.path.iter().all(rests) {
            run.deleting = false;
            run.path.clear();
            run.on_path = 0;
            run.reorganise(run.path.position());
            if let Some(block) = run.queue.front_mut() {
                block.way = None;
            }
        }
    }

    /// An axis that POS, POSA or a synchronised action positions brakes and drops the rest of its way.
    pub(super) fn delete_distance_to_go_of_axes(&mut self, run: &mut Run, stage: &Stage<'_>) {
        let path = stage.own.axes.path.iter().copied();
        let now: AxisSet = path.filter(|axis| stage.to_nck.axes[*axis].delete_distance_to_go_spindle_reset()).collect();
        let positioned = run.positionings.iter().filter(|one| !one.is_rapid).map(|one| one.axis).collect();
        let rising = now.without(std::mem::replace(&mut run.axial_delete_were, now)).and(positioned);
        for axis in rising.iter() {
            let delete = axis_signal(axis, axis_to_nck::delete_distance_to_go_spindle_reset, true);
            run.axial_delete_causes[axis] =
                self.log.note_one(Place::Axis(axis), Rule::DistanceDeleted, delete, run.block_cause);
        }
        run.axial_deleting = run.axial_deleting.with(rising).and(positioned);
    }
}
