//! `gantry_start`: enables every axis, and starts the synchronization of a gantry grouping that is ready for it.
//!
//! The NCK evaluates the rising edge of start gantry synchronization (DBX29.4), and only while the machine function REF is active (REF-14) or a
//! block with G74 waits. So the program sets 29.4 of an axis with gantry synchronization ready to start (DBX101.4) while DB11.DBX7.2 = 1, and in
//! AUTOMATIC and MDA. If REF becomes active later, 29.4 is 0 for a scan first, so that it rises. The NCK reports 101.4 on the leading axis only,
//! and evaluates the start signal there only. The program reads mode group 1.

use crate::plc::{ClosureProgram, program};
use crate::units::ModeGroupNumber;

use super::enable_all::enable;

/// Enables every axis and synchronizes every gantry grouping that is ready for it and may start.
///
/// Its state is whether REF was active in the last scan.
#[must_use]
pub fn gantry_start() -> ClosureProgram<bool> {
    program("gantry_start", true, |was_ref, io| {
        enable(io);
        let group = io.from_nck.mode_group(ModeGroupNumber::FIRST);
        let is_ref = group.active_machine_function_ref();
        let by_program = group.active_mode_automatic() || group.active_mode_mdi();
        let may_start = by_program || is_ref && *was_ref;
        *was_ref = is_ref;
        for x in io.axes() {
            let ready = io.from_nck.axis(x).gantry_synchronization_ready_to_start();
            io.to_nck.axis(x).set_start_gantry_synchronization(ready && may_start);
        }
    })
}

#[cfg(test)]
mod tests {
    use super::gantry_start;
    use crate::plc::bench::Bench;

    #[test]
    fn the_start_follows_ready_to_start_on_its_axis() {
        let mut bench = Bench::with_axes(&["X", "XF"]);
        let mut program = gantry_start();
        bench.set("DB11.DBX7.2", 1);
        for value in [0, 1, 0] {
            bench.set("DB31.DBX101.4", value);
            bench.scan(&mut program).unwrap();
            assert_eq!((bench.get("DB31.DBX29.4"), bench.get("DB32.DBX29.4")), (value, 0));
        }
        assert_eq!(bench.get("DB31.DBX2.1"), 1, "it enables the axes as well");
    }

    /// REF-14
    #[test]
    fn the_start_rises_when_ref_becomes_active_and_not_before() {
        let mut bench = Bench::with_axes(&["X", "XF"]);
        let mut program = gantry_start();
        bench.set("DB31.DBX101.4", 1);
        // 7.2, 6.0 (AUTOMATIC), and 29.4 behind the scan.
        let scans = [(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 0), (0, 1, 1), (1, 0, 0), (1, 0, 1)];
        for (number, (is_ref, automatic, start)) in scans.into_iter().enumerate() {
            bench.set("DB11.DBX7.2", is_ref);
            bench.set("DB11.DBX6.0", automatic);
            bench.scan(&mut program).unwrap();
            assert_eq!(bench.get("DB31.DBX29.4"), start, "scan {number}");
        }
    }
}
