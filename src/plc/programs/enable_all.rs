//! `enable_all`: enables every axis of the machine at all times.
//!
//! On each existing axis it sets position measuring system 1 (DBX1.5), controller enable (DBX2.1) and pulse enable (DBX21.7). It writes
//! no other signal. No override is needed: while override active (DBX1.7) is 0, the override is 100 %.

use crate::plc::{ClosureProgram, PlcIo, program};

/// Enables every axis.
#[must_use]
pub fn enable_all() -> ClosureProgram<()> {
    program("enable_all", (), |(), io| enable(io))
}

/// The part that all built-in programs have in common.
pub(super) fn enable(io: &mut PlcIo<'_>) {
    for number in io.axes() {
        let axis = io.to_nck.axis(number);
        axis.set_position_measuring_system_1(true);
        axis.set_controller_enable(true);
        axis.set_pulse_enable(true);
    }
}

#[cfg(test)]
mod tests {
    use super::enable_all;
    use crate::image::Memory;
    use crate::plc::bench::Bench;
    use crate::units::AxisNumber;

    #[test]
    fn existing_axes_get_measuring_system_controller_and_pulses_and_nothing_else() {
        let mut bench = Bench::with_axes(&["X", "Y"]);
        bench.scan(&mut enable_all()).unwrap();
        let mut expected = Memory::new();
        for number in [AxisNumber::new(1).unwrap(), AxisNumber::new(2).unwrap()] {
            for address in ["DBX1.5", "DBX2.1", "DBX21.7"] {
                let address = format!("DB{}.{address}", 30 + u16::from(number.number())).parse().unwrap();
                let bit = expected.locate(&address, bench.names.profile).unwrap();
                expected.write(bit, 1);
            }
        }
        assert_eq!(bench.memory, expected);
    }

    #[test]
    fn a_signal_that_was_reset_is_set_again_in_the_next_scan() {
        let mut bench = Bench::with_axes(&["X"]);
        let mut program = enable_all();
        bench.scan(&mut program).unwrap();
        bench.memory.to_nck_mut().axes[AxisNumber::FIRST].set_pulse_enable(false);
        bench.scan(&mut program).unwrap();
        assert!(bench.memory.to_nck().axes[AxisNumber::FIRST].pulse_enable());
    }
}
