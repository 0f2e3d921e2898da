//! DB31.DBX2.2, delete distance-to-go, of an axis that a program positions.

use crate::image::axis_to_nck;
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::program::path::Stage;
use crate::sinumerik::program::state::Run;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::AxisSet;
use crate::variables::Place;

impl State {
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
