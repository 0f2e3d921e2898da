//! `shared_reference_cam`: enables every axis, and uses the reference cam of the leading axis for all axes of the gantry grouping.
//!
//! The leading axis is the first axis with gantry leading axis (DBX101.6) = 1. Its deceleration of reference point approach (DBX12.7),
//! from any source, is copied to every other axis with gantry axis (DBX101.7) = 1. Without a leading axis, nothing is copied. A machine
//! with two groupings and two cams needs its own program.

use crate::plc::{ClosureProgram, program};

use super::enable_all::enable;

/// Enables every axis; one reference cam serves the gantry grouping.
#[must_use]
pub fn shared_reference_cam() -> ClosureProgram<()> {
    program("shared_reference_cam", (), |(), io| {
        enable(io);
        let leading = io.from_nck.axes.iter().find(|(_, axis)| axis.gantry_leading_axis());
        let Some((leading, _)) = leading else { return };
        let on_cam = io.to_nck.axis(leading).deceleration_reference_point_approach();
        for (number, axis) in io.from_nck.axes.iter() {
            if number != leading && axis.gantry_axis() {
                io.to_nck.axis(number).set_deceleration_reference_point_approach(on_cam);
            }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::shared_reference_cam;
    use crate::plc::bench::Bench;

    fn cams(bench: &Bench) -> [u64; 3] {
        ["DB31.DBX12.7", "DB32.DBX12.7", "DB33.DBX12.7"].map(|cam| bench.get(cam))
    }

    #[test]
    fn the_cam_of_the_leading_axis_reaches_the_grouping_and_no_other_axis() {
        let mut bench = Bench::with_axes(&["X", "Y", "XF"]);
        bench.set("DB31.DBB101", 0xC0); // leading axis
        bench.set("DB33.DBB101", 0x80); // synchronized axis
        let mut program = shared_reference_cam();
        bench.set("DB31.DBX12.7", 1);
        bench.scan(&mut program).unwrap();
        assert_eq!(cams(&bench), [1, 0, 1]);
        bench.set("DB31.DBX12.7", 0);
        bench.set("DB32.DBX12.7", 1);
        bench.scan(&mut program).unwrap();
        assert_eq!(cams(&bench), [0, 1, 0]);
    }

    #[test]
    fn without_a_leading_axis_every_cam_stays_as_it_is() {
        let mut bench = Bench::with_axes(&["X", "Y", "XF"]);
        bench.set("DB33.DBB101", 0x80);
        bench.set("DB33.DBX12.7", 1);
        bench.scan(&mut shared_reference_cam()).unwrap();
        assert_eq!(cams(&bench), [0, 0, 1]);
    }
}
