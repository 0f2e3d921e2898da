//! `gantry_start`: enables every axis, and starts the synchronization of a gantry grouping as soon as the grouping is ready.
//!
//! On each axis, start gantry synchronization (DBX29.4) follows gantry synchronization ready to start (DBX101.4). The NCK reports this
//! signal on the leading axis only, and evaluates the start signal there only.

use crate::plc::{ClosureProgram, program};

use super::enable_all::enable;

/// Enables every axis and synchronizes every gantry grouping as soon as it is ready.
#[must_use]
pub fn gantry_start() -> ClosureProgram<()> {
    program("gantry_start", (), |(), io| {
        enable(io);
        for x in io.axes() {
            io.to_nck
                .axis(x)
                .set_start_gantry_synchronization(io.from_nck.axis(x).gantry_synchronization_ready_to_start());
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
        for value in [0, 1, 0] {
            bench.set("DB31.DBX101.4", value);
            bench.scan(&mut program).unwrap();
            assert_eq!((bench.get("DB31.DBX29.4"), bench.get("DB32.DBX29.4")), (value, 0));
        }
        assert_eq!(bench.get("DB31.DBX2.1"), 1, "it enables the axes as well");
    }
}
