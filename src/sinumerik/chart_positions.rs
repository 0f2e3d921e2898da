//! Where axes and groupings are in the charts of [`Texts::charts`](crate::control::Texts::charts), for a display of the running machine.

use crate::control::ChartPosition;
use crate::sinumerik::nck::Nck;

impl Nck {
    /// The phase of each grouping, and of the approach of each axis.
    pub(super) fn chart_positions(&self) -> Vec<ChartPosition> {
        let groupings = self.state.groupings.iter().map(|grouping| ChartPosition {
            chart: "gantry",
            axes: grouping.coupling.members().collect(),
            phase: format!("{:?}", grouping.phase),
            aim: "gantry_grouping_is_synchronized",
        });
        let approaches = self.state.axes.iter().map(|(axis, of)| ChartPosition {
            chart: "approach",
            axes: vec![axis],
            phase: format!("{:?}", of.approach.phase()),
            aim: "referenced_synchronized_1",
        });
        groupings.chain(approaches).collect()
    }
}
