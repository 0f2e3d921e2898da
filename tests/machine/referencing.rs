//! Tests of referencing a gantry from many positions: the control must find the real positions of the simulated mechanics.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use opennck::machine::{Machine, OpenOptions};
use opennck::plc::enable_all;
use opennck::scenario::{Failure, Session};
use opennck::source::Table;

/// Start positions of the slides and positions of their zero marks in mm. The spacing is 10 mm, the cams reach from 205 to the end.
struct Mechanics {
    start: [f64; 2],
    mark: [f64; 2],
}

impl Mechanics {
    /// The position of the last zero mark before the cam.
    fn reference(&self, axis: usize) -> f64 {
        self.mark[axis] + ((205.0 - self.mark[axis]) / 10.0).floor() * 10.0
    }

    fn session(&self) -> Session {
        let over: String = ["X", "XF"]
            .iter()
            .enumerate()
            .map(|(axis, name)| {
                let (start, mark) = (self.start[axis], self.mark[axis]);
                format!("[{name}]\nstart = {start:?}\n[{name}.encoder1]\nzero_mark = {mark:?}\n")
            })
            .collect();
        let options = OpenOptions { plant_over: Some(Table::parse(&over, "over").unwrap()), ..OpenOptions::default() };
        let machine = Machine::open_with(Path::new("machine_data/g1_example"), options).unwrap();
        Session::new(machine).with_program(Box::new(enable_all()))
    }
}

/// Sections 1 and 2, until the control waits for the start.
fn reference(session: &mut Session) -> Result<(), Failure> {
    session.set("DB11.DBX0.2", true)?;
    session.set("DB11.DBX1.2", true)?;
    session.pulse("X.traversing_key_plus")?;
    session.wait("DB31.DBX101.4 && alarm(10654) && DB31.DBX60.4 && DB33.DBX60.4", "40s")?;
    session.run("500ms")
}

/// After an interruption, no axis moves. The direction key (if a reference is missing) and 29.4 complete the job.
fn recover(session: &mut Session, after: &str) -> Result<(), Failure> {
    session.expect("!DB31.DBX64.6 && !DB31.DBX64.7 && !DB33.DBX64.6 && !DB33.DBX64.7 && alarms() == alarm(10654)")?;
    if session.value("DB31.DBX101.4")? == 0.0 {
        session.expect("!(DB31.DBX60.4 && DB33.DBX60.4)")?;
        session.pulse("X.traversing_key_plus")?;
        session.wait("DB31.DBX101.4 && alarm(10654)", "20s")?;
    } else {
        session.expect("DB31.DBX60.4 && DB33.DBX60.4")?;
    }
    session.set("X.start_gantry_synchronization", true)?;
    session.wait("DB31.DBX101.5", "5s")?;
    session.run("500ms")?;
    let apart = session.value("XF.slide - X.slide")?;
    assert!((apart - 0.941).abs() < 0.001, "after {after}: {apart}");
    Ok(())
}

/// REF-02, REF-04, REF-06, REF-09, REF-10, REF-31: for every misalignment of scales and slides, with a start on, before or at the edge of
/// the cam, the positions after section 2 are the real ones, and section 3 makes them equal.
#[test]
fn positions_after_referencing_are_the_real_positions() -> Result<(), Failure> {
    let starts = [[120.0, 120.0], [230.0, 230.0], [205.0, 205.0], [204.9, 204.9], [150.0, 147.5], [260.0, 265.25]];
    let marks = [[0.3, 1.241], [0.3, 0.3], [1.241, 0.3], [9.5, 5.5], [4.5, 5.5], [0.0, 9.0], [3.33, -7.77]];
    for start in starts {
        for mark in marks {
            let mechanics = Mechanics { start, mark };
            let skew = start[1] - start[0];
            // XF has moved X from the reference point of X to the position where XF has its reference point.
            let apart = mechanics.reference(1) - skew - mechanics.reference(0);
            let mut session = mechanics.session();
            reference(&mut session)?;
            let context = format!("slides {start:?}, zero marks {mark:?}");
            let near = |session: &Session, what: &str, expected: f64| {
                let found = session.value(what).unwrap();
                assert!((found - expected).abs() < 0.001, "{context}: {what} is {found}, expected {expected}");
            };
            near(&session, "X.position", apart);
            near(&session, "XF.position", 0.0);
            near(&session, "XF.synchronism_difference", -apart);
            session.set("X.start_gantry_synchronization", true)?;
            session.wait("DB31.DBX101.5", "5s")?;
            session.run("500ms")?;
            near(&session, "X.position", 0.0);
            near(&session, "X.slide", mechanics.reference(0));
            near(&session, "XF.slide", mechanics.reference(1));
        }
    }
    Ok(())
}

/// REF-12, REF-13: after RESET at any moment, the grouping can be started again, and it ends at the same position.
#[test]
fn a_reset_at_any_moment_can_be_recovered_from() -> Result<(), Failure> {
    let mechanics = Mechanics { start: [120.0, 120.0], mark: [0.3, 1.241] };
    for tenths in 0..90 {
        let mut session = mechanics.session();
        session.set("DB11.DBX0.2", true)?;
        session.set("DB11.DBX1.2", true)?;
        session.pulse("X.traversing_key_plus")?;
        session.run(&format!("{}ms", 100 * tenths + 37))?;
        session.pulse("DB21.DBX7.7")?;
        session.run("1s")?;
        recover(&mut session, &format!("RESET at {tenths} tenths of a second"))?;
    }
    Ok(())
}

/// REF-12, REF-13: the same holds if an enable is lost at any moment on any axis, or if REF is deselected.
#[test]
fn a_disturbance_at_any_moment_can_be_recovered_from() -> Result<(), Failure> {
    let mechanics = Mechanics { start: [120.0, 120.0], mark: [0.3, 1.241] };
    let lost = ["X.controller_enable", "XF.controller_enable", "X.pulse_enable", "XF.pulse_enable", "DB11.DBX1.2"];
    for signal in lost {
        for step in 0..26 {
            let mut session = mechanics.session();
            session.set("DB11.DBX0.2", true)?;
            session.set("DB11.DBX1.2", true)?;
            session.pulse("X.traversing_key_plus")?;
            session.run(&format!("{}ms", 300 * step + 37))?;
            session.force(signal, false)?;
            session.run("700ms")?;
            session.release(signal)?;
            session.set("DB11.DBX1.2", true)?;
            session.pulse("DB21.DBX7.7")?;
            session.run("300ms")?;
            recover(&mut session, &format!("{signal} = 0 at step {step}"))?;
        }
    }
    Ok(())
}

/// Whether referencing and synchronising over a bridge end in synchronism. Otherwise they end with an alarm.
fn synchronises_over_a_bridge(stiffness: f64, apart: f64) -> Result<bool, Failure> {
    let start = 120.0 + apart;
    let slide = format!("[XF]\nstart = {start:?}\n[XF.encoder1]\nzero_mark = 0.3\n");
    let over = format!("{slide}[bridge.1]\noffset = {{ XF = 0.0 }}\nstiffness = {stiffness:?}\n");
    let options = OpenOptions { plant_over: Some(Table::parse(&over, "over").unwrap()), ..OpenOptions::default() };
    let machine = Machine::open_with(Path::new("machine_data/g1_example"), options).unwrap();
    let mut session = Session::new(machine).with_program(Box::new(enable_all()));
    session.set("DB11.DBX0.2", true)?;
    session.set("DB11.DBX1.2", true)?;
    session.run("100ms")?;
    session.pulse("X.traversing_key_plus")?;
    // Without an alarm, section 3 is reached; then the start ends in synchronism or in an alarm.
    session.wait("DB31.DBX101.4 || DB31.DBX101.5 || alarms() > 0", "30s")?;
    if session.value("DB31.DBX101.4")? > 0.5 {
        session.set("X.start_gantry_synchronization", true)?;
        session.wait("DB31.DBX101.5 || alarms() > alarm(10655) + alarm(10654)", "10s")?;
    }
    let synchronised = session.value("DB31.DBX101.5")? > 0.5;
    if synchronised {
        session.run("1s")?;
        session.expect("X.axis_stationary && XF.axis_stationary")?;
    }
    Ok(synchronised)
}

/// REF-02, REF-12: over every bridge from free to rigid, with every misalignment, referencing ends: synchronised or with an alarm. Without
/// misalignment and with a free bridge it succeeds; with a large misalignment of a stiff bridge it does not.
#[test]
fn over_every_bridge_from_free_to_rigid_referencing_ends() -> Result<(), Failure> {
    for stiffness in [0.0, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0 - 1e-9, 1.0] {
        for apart in [0.0, 0.01, 0.3, 5.0] {
            let synchronised = synchronises_over_a_bridge(stiffness, apart)?;
            let case = format!("stiffness {stiffness}, {apart} mm apart");
            assert!(synchronised || stiffness > 0.0 && apart > 0.0, "{case}");
            assert!(!synchronised || stiffness < 0.9 || apart < 1.0, "{case}");
        }
    }
    Ok(())
}
