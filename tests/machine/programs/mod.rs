//! NC programs on a machine: end positions, times, states, auxiliary functions, alarms. Expected values are computed in the comments.

#![expect(clippy::float_cmp, reason = "setpoints are rounded, and bits and numbers of the interface are exact")]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod auxiliary;
mod control;
mod errors;
mod exchange;
mod motion;
mod random;
mod values;

use opennck::plc::enable_all;
use opennck::scenario::Session;

/// The portal with its axes in position control, AUTOMATIC selected, and this program.
fn automatic(nc: &str) -> Session {
    let mut session = Session::open("machine_data/portal").unwrap().with_program(enable_all().boxed());
    prepare(&mut session, nc);
    session
}

/// Waits for position control, and selects AUTOMATIC and the program.
fn prepare(session: &mut Session, nc: &str) {
    let controlled = ["X", "Y", "A"].map(|axis| format!("{axis}.position_controller_active")).join(" && ");
    session.wait(&controlled, "1s").unwrap();
    session.set("mode_group_1.mode_automatic", 1).unwrap();
    session.nc(nc, 1).unwrap();
    session.run("1cycles").unwrap();
}

/// NC start, until the cycle in which the program begins.
fn start(session: &mut Session) {
    session.set("CHAN1.nc_start", 1).unwrap();
    session.run("1cycles").unwrap();
    session.set("CHAN1.nc_start", 0).unwrap();
}

/// Runs a program to its M30, without an alarm.
fn run(nc: &str) -> Session {
    let mut session = automatic(nc);
    start(&mut session);
    session.wait("CHAN1.m2_m30_active || alarms() > 0", "60s").unwrap();
    session.expect("alarms() == 0").unwrap();
    session
}

/// The setpoints of X, Y and Z, to a thousandth.
fn position(session: &Session) -> [f64; 3] {
    ["X.setpoint", "Y.setpoint", "Z.setpoint"].map(|value| (session.value(value).unwrap() * 1000.0).round() / 1000.0)
}

/// The seconds of a program from its start to its end.
fn duration(nc: &str) -> f64 {
    let mut session = automatic(nc);
    let before = session.time().seconds();
    start(&mut session);
    session.wait("CHAN1.m2_m30_active", "120s").unwrap();
    session.time().seconds() - before
}
