//! A PLC program synchronises a gantry; then one side is blocked.

use opennck::machine::FaultKind;
use opennck::plc::{OnDelay, program};
use opennck::scenario::{Failure, Session};
use opennck::units::Time;

#[test]
fn the_gantry_synchronises_and_a_jammed_side_stops_it() -> Result<(), Failure> {
    let plc = program("start_after_half_a_second", OnDelay::default(), |delay, io| {
        for axis in io.axes() {
            io.to_nck.axis(axis).set_position_measuring_system_1(true);
            io.to_nck.axis(axis).set_controller_enable(true);
            io.to_nck.axis(axis).set_pulse_enable(true);
        }
        let Some(x) = io.axis("X") else { return };
        let ready = io.from_nck.axis(x).gantry_synchronization_ready_to_start(); // DB31.DBX101.4
        let start = delay.scan(ready, Time::from_millis(500), io.time);
        io.to_nck.axis(x).set_start_gantry_synchronization(start); // DB31.DBX29.4
    });
    let mut gantry = Session::open("g1_example")?.with_program(plc.boxed());
    gantry.watch(&["X.gantry_*", "XF.gantry_*", "X.start_gantry_synchronization"])?;
    gantry.set("DB11.DBX1.2", 1)?; // JOG with machine function REF
    gantry.pulse("X.traversing_key_plus")?;
    gantry.wait("X.gantry_synchronization_ready_to_start", "60s")?;

    let mut jammed = gantry.fork()?;
    gantry.wait("X.gantry_grouping_is_synchronized", "60s")?;

    jammed.fault("XF", FaultKind::Block)?;
    jammed.wait("X.gantry_grouping_is_synchronized", "60s")?; // only X moves
    jammed.set("DB11.DBX1.2", 0)?; // JOG without REF
    jammed.set("X.traversing_key_plus", 1)?;
    jammed.wait("alarm(10653, XF)", "60s")?;
    insta::assert_snapshot!("synchronised", gantry.sequence());
    insta::assert_snapshot!("jammed", jammed.sequence());
    Ok(())
}
