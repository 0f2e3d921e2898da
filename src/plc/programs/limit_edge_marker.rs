//! `limit_edge_marker`: enables every axis, and records short warnings in flags.
//!
//! A warning limit can be exceeded for a moment only (gantry warning limit exceeded, DBX101.3), too short for an operator to notice
//! (G1 2.7.4: the setting of the limits). This program sets a marker and counts each rising edge on a synchronous axis (101.7 = 1,
//! 101.6 = 0). The axis number is the number in the machine:
//! | flag | meaning |
//! | flag | what |
//! |---|---|
//! | M20.0 to M23.6 | marker of axis 1 to 31: M20.0 is axis 1, M20.7 axis 8, M21.0 axis 9 |
//! | M24.0 | a marker of any axis |
//! | M24.1 | reset request from outside: markers and counts are set to 0; the program then resets M24.1 |
//! | MW30 to MW90 | edges of axis 1 to 31: MW(28 + 2 × axis), at most 65535 |
//!
//! A limit that is already exceeded when the program starts counts as an edge. An edge that begins and ends between two scans of the PLC
//! is not detected; `plc_cycle` of the plant sets the scan interval.

use serde::{Deserialize, Serialize};

use crate::plc::{ClosureProgram, RisingEdge, program};
use crate::units::PerAxis;

use super::enable_all::enable;

/// The byte of the marker of axis 1; the other markers follow bit by bit.
const MARKERS: usize = 20;
/// The byte with the summary marker (any axis) and the reset request.
const SUMMARY: usize = 24;
/// The byte of the count of axis 1; the other counts follow word by word.
const COUNTS: usize = 30;

/// The state: DBX101.3 of each axis in the previous scan.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct LimitEdgeMarker {
    edges: PerAxis<RisingEdge>,
}

/// Enables every axis; marks and counts each rising edge of DBX101.3 of a synchronous axis in flags.
#[must_use]
pub fn limit_edge_marker() -> ClosureProgram<LimitEdgeMarker> {
    program("limit_edge_marker", LimitEdgeMarker::default(), |memory, io| {
        enable(io);
        if io.flags.bit(SUMMARY, 1) {
            for byte in (MARKERS..=SUMMARY).chain(COUNTS..COUNTS + 62) {
                io.flags.set_byte(byte, 0);
            }
        }
        for number in io.axes() {
            let axis = io.from_nck.axis(number);
            let synchronous = axis.gantry_axis() && !axis.gantry_leading_axis();
            if memory.edges[number].scan(synchronous && axis.gantry_warning_limit_exceeded()) {
                let index = usize::from(number.number() - 1);
                let count = COUNTS + 2 * index;
                io.flags.set_bit(MARKERS + index / 8, (number.number() - 1) % 8, true);
                io.flags.set_bit(SUMMARY, 0, true);
                io.flags.set_word(count, io.flags.word(count).saturating_add(1));
            }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::limit_edge_marker;
    use crate::plc::bench::Bench;

    #[test]
    fn only_edges_of_synchronous_axes_are_marked_and_counted() {
        let mut bench = Bench::with_axes(&["X", "Y", "XF"]);
        let mut program = limit_edge_marker();
        for value in [0, 1, 1, 0, 1] {
            bench.set("DB31.DBB101", 0b1100_0000 | value << 3); // leading axis
            bench.set("DB32.DBB101", value << 3); // no gantry axis
            bench.set("DB33.DBB101", 0b1000_0000 | value << 3); // synchronous axis
            bench.scan(&mut program).unwrap();
        }
        assert_eq!(bench.get("MB20"), 0b100);
        assert_eq!(bench.get("M24.0"), 1);
        assert_eq!(["MW30", "MW32", "MW34"].map(|word| bench.get(word)), [0, 0, 2]);
    }

    #[test]
    fn markers_and_counts_are_reset_and_a_limit_still_exceeded_is_no_new_edge() {
        let mut bench = Bench::with_axes(&["X", "XF"]);
        let mut program = limit_edge_marker();
        bench.set("DB32.DBB101", 0b1000_1000);
        bench.scan(&mut program).unwrap();
        assert_eq!((bench.get("M20.1"), bench.get("MW32")), (1, 1));
        bench.set("M24.1", 1);
        for _ in 0..2 {
            bench.scan(&mut program).unwrap();
            assert_eq!(["M20.1", "M24.0", "M24.1", "MW32"].map(|flag| bench.get(flag)), [0; 4]);
        }
    }

    #[test]
    fn a_count_stops_at_its_maximum() {
        let mut bench = Bench::with_axes(&["X", "XF"]);
        bench.set("MW32", 65535);
        bench.set("DB32.DBB101", 0b1000_1000);
        bench.scan(&mut limit_edge_marker()).unwrap();
        assert_eq!(bench.get("MW32"), 65535);
    }
}
