//! `gear_change`: enables every axis, and changes the gear stages of spindles: the dialogue of 82.x and 16.x with oscillation.
//!
//! | signal of the spindle | what the program does |
//! |---|---|
//! | change gear stage (DBX82.3) while the spindle stands (DBX61.4) | oscillation enable (DBX18.5) = 1, the gearbox moves for 500 ms |
//! | the gearbox has moved | oscillation enable = 0, actual gear stage (DBX16.0 to 16.2) = setpoint gear stage (DBX82.0 to 82.2), gear stage changed (DBX16.3) = 1 |
//! | change gear stage = 0 | gear stage changed = 0 |
//!
//! At power on stage 1 is engaged. The program writes these signals of every spindle in every scan, and nothing for axes.

use serde::{Deserialize, Serialize};

use crate::plc::{ClosureProgram, program};
use crate::units::{PerAxis, Time};

use super::enable_all::enable;

/// How long the gearbox moves.
const GEARBOX_TIME: Time = Time::from_millis(500);

/// One gearbox.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct Gearbox {
    /// The engaged stage, from 1; 0 before the first scan.
    stage: u8,
    moves_until: Option<Time>,
    /// It has moved, and the control has not taken the stage.
    reports: bool,
}

/// The state: the gearbox of each spindle.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct GearChange {
    gearboxes: PerAxis<Gearbox>,
}

/// Enables every axis, and changes the gear stages that programs want.
#[must_use]
pub fn gear_change() -> ClosureProgram<GearChange> {
    program("gear_change", GearChange::default(), |state, io| {
        enable(io);
        for number in io.axes() {
            let shown = io.from_nck.axis(number);
            if !shown.spindle_no_axis() {
                continue;
            }
            let gearbox = &mut state.gearboxes[number];
            gearbox.stage = gearbox.stage.max(1);
            let wanted = shown.change_gear_stage();
            if wanted && shown.axis_stationary() && gearbox.moves_until.is_none() && !gearbox.reports {
                gearbox.moves_until = Some(io.time + GEARBOX_TIME);
            }
            if gearbox.moves_until.is_some_and(|until| io.time >= until) {
                (gearbox.moves_until, gearbox.reports) = (None, true);
                gearbox.stage = shown.setpoint_gear_stage();
            }
            gearbox.reports &= wanted;
            let axis = io.to_nck.axis(number);
            axis.set_oscillation_enable(gearbox.moves_until.is_some());
            axis.set_actual_gear_stage(gearbox.stage);
            axis.set_gear_stage_changed(gearbox.reports);
        }
    })
}

#[cfg(test)]
mod tests {
    use super::gear_change;
    use crate::plc::bench::Bench;

    /// A scan of the bench takes 10 ms: the gearbox moves in 50 scans.
    #[test]
    fn the_gearbox_moves_while_the_spindle_stands_and_then_reports_the_wanted_stage() {
        let mut bench = Bench::with_axes(&["SP"]);
        let mut program = gear_change();
        bench.set("DB31.DBX60.0", 1);
        bench.scan(&mut program).unwrap();
        assert_eq!((bench.get("DB31.DBB16"), bench.get("DB31.DBX18.5")), (1, 0), "stage 1 at power on");
        bench.set("DB31.DBB82", 0b1010);
        bench.scan(&mut program).unwrap();
        assert_eq!((bench.get("DB31.DBB16"), bench.get("DB31.DBX18.5")), (1, 0), "the spindle turns");
        bench.set("DB31.DBX61.4", 1);
        for _ in 0..50 {
            bench.scan(&mut program).unwrap();
            assert_eq!((bench.get("DB31.DBB16"), bench.get("DB31.DBX18.5")), (1, 1));
        }
        bench.scan(&mut program).unwrap();
        assert_eq!((bench.get("DB31.DBB16"), bench.get("DB31.DBX18.5")), (0b1010, 0), "stage 2, changed");
        bench.set("DB31.DBB82", 0b0010);
        bench.scan(&mut program).unwrap();
        assert_eq!(bench.get("DB31.DBB16"), 2);
    }

    #[test]
    fn an_axis_has_no_gearbox() {
        let mut bench = Bench::with_axes(&["X"]);
        bench.set("DB31.DBB82", 0b1010);
        bench.set("DB31.DBX61.4", 1);
        bench.scan(&mut gear_change()).unwrap();
        assert_eq!((bench.get("DB31.DBB16"), bench.get("DB31.DBX18.5"), bench.get("DB31.DBX2.1")), (0, 0, 1));
    }
}
