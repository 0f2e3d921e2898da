//! The Rust test that the README shows.

use opennck::plc::program;
use opennck::scenario::{Failure, Session};

#[test]
fn a_pressed_key_waits_for_the_enable() -> Result<(), Failure> {
    let plc = program("enable_from_a_button", (), |(), io| {
        let on = io.inputs.bit(0, 0); // I0.0
        for axis in io.axes() {
            io.to_nck.axis(axis).set_position_measuring_system_1(true); // DBX1.5
            io.to_nck.axis(axis).set_controller_enable(on); // DBX2.1
            io.to_nck.axis(axis).set_pulse_enable(on); // DBX21.7
        }
    });
    let mut machine = Session::open("g1_example")?.with_program(plc.boxed());
    machine.set("X.traversing_key_plus", 1)?;
    machine.hold("X.position == 0", "500ms")?;
    machine.set("I0.0", 1)?;
    machine.wait("X.position > 5", "2s")?;
    machine.expect("X.traverse_command_plus && alarms() == 0")
}
