//! One coupling, two policies: the same disturbances through a gantry grouping of a SINUMERIK, a hard gantry and a soft gantry of the ISG
//! kernel. Setpoints and differences are equal up to the first limit; behind it the controls differ by their policy only.
//!
//! `docs/two_controls.md` has the table that this test makes.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use opennck::machine::FaultKind;
use opennck::plc::enable_all;
use opennck::scenario::{Failure, Scenario, Session};
use opennck::units::Position;

/// Both machines have the same mechanics and dynamics: 1 m/s², a loop gain of 16.67/s, drives of 3 ms, a cycle of 2 ms. The first limit is
/// 0.1 mm, the second one 0.5 mm.
const SINUMERIK: &str = r#"
title = "a gantry grouping"
machine = "machine_data/g1_example"
[plant.X]
start = 100.0
encoder1 = { kind = "absolute" }
[plant.XF]
start = 100.0
encoder1 = { kind = "absolute" }
[machine_data]
"30240[0,X]" = 4
"34200[0,X]" = 0
"34210[0,X]" = 2
"34100[0,X]" = 100.0
"30240[0,XF]" = 4
"34200[0,XF]" = 0
"34210[0,XF]" = 2
"34100[0,XF]" = 100.0
"37110[XF]" = 0.1
"37120[XF]" = 0.5
"20700[CHAN1]" = 0
"#;

const HARD: &str = r#"
title = "a hard gantry"
machine = "machine_data/isg_hard_gantry"
[plant.ax1]
start = 100.0
drive = { time_constant = "3ms" }
[plant.ax5]
start = 100.0
drive = { time_constant = "3ms" }
[plant.ax6]
start = 100.0
drive = { time_constant = "3ms" }
"#;

const SOFT: &str = r#"
title = "a soft gantry"
machine = "machine_data/isg_soft_gantry"
[plant.ax2]
start = 100.0
drive = { time_constant = "3ms" }
[plant.ax8]
start = 100.0
drive = { time_constant = "3ms" }
"#;

/// A control with a coupling.
struct Side {
    name: &'static str,
    scenario: &'static str,
    leader: &'static str,
    follower: &'static str,
    program: &'static str,
    start: &'static str,
    reset: &'static str,
    /// The messages of the first and the second limit, and of a drive.
    messages: [&'static str; 3],
}

const SIDES: [Side; 3] = [
    Side {
        name: "SINUMERIK",
        scenario: SINUMERIK,
        leader: "X",
        follower: "XF",
        program: "G91 G1 F6000 X100\nM30",
        start: "DB21.DBX7.1",
        reset: "DB21.DBX7.7",
        messages: ["10652", "10653", "25201"],
    },
    Side {
        name: "ISG, hard gantry",
        scenario: HARD,
        leader: "ax1",
        follower: "ax5",
        program: "G91 G01 F6000 X100\nM30",
        start: "channel_1.start",
        reset: "channel_1.reset",
        messages: ["'gantry-stage-1'", "'gantry-stage-2'", "'drive-fault'"],
    },
    Side {
        name: "ISG, soft gantry",
        scenario: SOFT,
        leader: "Y1",
        follower: "Y2",
        program: "#SET AX LINK[1,[Y2 = Y1,G,0.1,0.5]]\n#ENABLE AX LINK[1]\nG91 G01 F6000 Y1=100\nM30",
        start: "channel_1.start",
        reset: "channel_1.reset",
        messages: ["'gantry-stage-1'", "'gantry-stage-2'", "'drive-fault'"],
    },
];

impl Side {
    /// The machine with a synchronised coupling and a selected program.
    fn open(&self) -> Result<Session, Failure> {
        let text = format!("{}[[step]]\nrun = \"1cycles\"\n", self.scenario);
        let scenario = Scenario::parse(&text, Path::new("two_controls.toml")).unwrap();
        let machine = scenario.machine(scenario.profiles[0]).unwrap();
        let mut session = Session::new(machine);
        if self.leader == "X" {
            session = session.with_program(Box::new(enable_all()));
            session.wait("X.position_controller_active && XF.position_controller_active", "1s")?;
            session.set("DB11.DBX0.2", true)?;
            session.set("DB11.DBX1.2", true)?;
            session.set("X.traversing_key_plus", true)?;
            session.wait("X.gantry_grouping_is_synchronized", "10s")?;
            session.set("DB11.DBX0.2", false)?;
            session.set("DB11.DBX1.2", false)?;
            session.set("X.traversing_key_plus", false)?;
            session.set("DB11.DBX0.0", true)?;
        }
        session.run("500ms")?;
        session.nc(self.program, 1)?;
        Ok(session)
    }

    fn value(&self, session: &Session, axis: &str, what: &str) -> f64 {
        session.value(&format!("{axis}.{what}")).unwrap()
    }

    /// Setpoints of both, and the difference.
    fn sample(&self, session: &Session) -> [f64; 3] {
        [
            self.value(session, self.leader, "setpoint"),
            self.value(session, self.follower, "setpoint"),
            self.value(session, self.follower, "synchronism_difference"),
        ]
    }

    /// Which of the messages are pending.
    fn pending(&self, session: &Session) -> Vec<&'static str> {
        let is_pending = |message: &&&str| session.value(&format!("alarm({message})")).unwrap() != 0.0;
        self.messages.iter().filter(is_pending).copied().collect()
    }
}

/// What a side did.
struct Course {
    /// From the first cycle with a movement on.
    samples: Vec<[f64; 3]>,
    /// The sample in which the first limit was exceeded.
    limit: Option<usize>,
    /// The cell of the table.
    result: String,
}

/// The cycle of the disturbance, in constant motion, and how many are compared.
const DISTURBED: usize = 200;
const COMPARED: usize = 500;

fn run(side: &Side, disturbance: Option<FaultKind>) -> Result<Course, Failure> {
    let mut session = side.open()?;
    let [start, ..] = side.sample(&session);
    session.set(side.start, true)?;
    while (side.sample(&session)[0] - start).abs() <= 0.0 {
        session.run("1cycles")?;
    }
    let mut course = Course { samples: Vec::new(), limit: None, result: String::new() };
    let mut raised = Vec::new();
    for cycle in 0..COMPARED {
        course.samples.push(side.sample(&session));
        for message in side.pending(&session) {
            if !raised.contains(&message) {
                raised.push(message);
            }
        }
        if course.limit.is_none() && raised.iter().any(|message| side.messages[..2].contains(message)) {
            course.limit = Some(cycle);
        }
        if let Some(kind) = disturbance.filter(|_| cycle == DISTURBED) {
            session.fault(side.follower, kind)?;
        }
        session.run("1cycles")?;
    }
    session.run("1500ms")?;
    let end = side.sample(&session)[0];
    let way = end - course.samples[DISTURBED][0];
    let mut text = match raised.as_slice() {
        [] => "no message".to_owned(),
        raised => raised.join(", ").replace('\'', "`"),
    };
    if (end - start - 100.0).abs() < 0.001 {
        text += "; the movement reaches its end";
    } else {
        write!(text, "; the leader stops after {way:.1} mm").unwrap();
    }
    let is_gone = |session: &Session| side.pending(session).is_empty();
    if !raised.is_empty() {
        session.set(side.start, false)?;
        if let Some(kind) = disturbance {
            session.clear_fault(side.follower, kind)?;
        }
        session.run("500ms")?;
        text += if is_gone(&session) {
            "; the message goes with its cause"
        } else {
            session.pulse(side.reset)?;
            session.run("1s")?;
            if is_gone(&session) {
                "; RESET clears it"
            } else {
                session.power_on()?;
                session.run("1s")?;
                if is_gone(&session) {
                    "; only a restart clears it"
                } else {
                    "; it returns after a restart, because the difference is still there"
                }
            }
        };
    }
    course.result = text;
    Ok(course)
}

fn disturbances() -> Vec<(&'static str, Option<FaultKind>)> {
    let by = Position::from_user;
    vec![
        ("none", None),
        ("held 0.05 mm away from its setpoint", Some(FaultKind::Hold { by: by(0.05) })),
        ("held 0.2 mm away: beyond the first limit", Some(FaultKind::Hold { by: by(0.2) })),
        ("held 0.6 mm away: beyond both limits", Some(FaultKind::Hold { by: by(0.6) })),
        ("pushed once by 0.05 mm", Some(FaultKind::Push { by: by(0.05) })),
        ("pushed once by 0.2 mm", Some(FaultKind::Push { by: by(0.2) })),
        ("moved by hand by 0.2 mm", Some(FaultKind::MovedByHand { by: by(0.2) })),
        ("its drive reports a fault", Some(FaultKind::DriveFault)),
    ]
}

/// SG-04, HG-07, MON-02
#[test]
fn both_controls_move_alike_up_to_the_first_limit() -> Result<(), Failure> {
    let mut table = String::from("| the follower is | exceeds a limit | ");
    writeln!(table, "{} |", SIDES.iter().map(|side| side.name).collect::<Vec<_>>().join(" | ")).unwrap();
    table += "|---|---|---|---|---|\n";
    for (name, disturbance) in disturbances() {
        let courses: Vec<Course> = SIDES.iter().map(|side| run(side, disturbance)).collect::<Result<_, _>>()?;
        let first = &courses[0];
        // A drive fault is a limit of its own: the controls stop by their policies.
        let alike = match disturbance {
            Some(FaultKind::DriveFault) => DISTURBED,
            _ => courses.iter().filter_map(|course| course.limit).min().unwrap_or(COMPARED - 1),
        };
        for (course, side) in courses.iter().zip(&SIDES) {
            if disturbance != Some(FaultKind::DriveFault) {
                assert_eq!(course.limit, first.limit, "{name}, {}", side.name);
            }
            for (cycle, (found, expected)) in course.samples.iter().zip(&first.samples).enumerate().take(alike) {
                // Setpoints are equal, differences to one count of the encoders.
                for (index, tolerance) in [1e-6, 1e-6, 0.000_101].into_iter().enumerate() {
                    let (found, expected) = (found[index], expected[index]);
                    assert!(
                        (found - expected).abs() < tolerance,
                        "{name}, {}, cycle {cycle}: {found}, {expected}",
                        side.name
                    );
                }
            }
        }
        let limit = match first.limit {
            Some(cycle) if disturbance != Some(FaultKind::DriveFault) => {
                format!("{} ms after it", 2 * (cycle - DISTURBED))
            }
            _ if matches!(disturbance, Some(FaultKind::DriveFault)) => "–".to_owned(),
            _ => "no".to_owned(),
        };
        let results: Vec<&str> = courses.iter().map(|course| course.result.as_str()).collect();
        writeln!(table, "| {name} | {limit} | {} |", results.join(" | ")).unwrap();
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/two_controls.md");
    let page = fs::read_to_string(&path).unwrap();
    let begin = page.find("| the follower is |").unwrap();
    let end = begin + page[begin..].find("\n\n").unwrap() + 1;
    if std::env::var_os("OPENNCK_ACCEPT").is_some() {
        fs::write(&path, format!("{}{table}{}", &page[..begin], &page[end..])).unwrap();
    } else {
        assert_eq!(page[begin..end], table, "docs/two_controls.md is old: run this test once with OPENNCK_ACCEPT=1");
    }
    Ok(())
}
