//! Archives as controls write them: binary files with values that no range of the catalogue allows (O-30). They open, run, and reference
//! what can be referenced.

use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

use opennck::control::{Class, Kind, Owner};
use opennck::machine::Machine;
use opennck::plc::program;
use opennck::scenario::Session;
use opennck::sinumerik::machine_data::{Datum, Scope, catalogue};
use opennck::units::AxisNumber;
use proptest::prelude::*;

/// A member of a binary archive: a header of 512 bytes, and the data with their padding.
fn member(internal: &str, shown: &str, folder: &str, data: &[u8]) -> Vec<u8> {
    let mut header = [0_u8; 512];
    let mut put = |at: usize, text: &str| header[at..at + text.len()].copy_from_slice(text.as_bytes());
    put(0, internal);
    put(50, shown);
    put(100, "77777");
    put(124, &data.len().to_string());
    put(257, "/");
    put(384, folder);
    let sum: u64 = header.iter().map(|&byte| u64::from(byte)).sum();
    header[148..148 + sum.to_string().len()].copy_from_slice(sum.to_string().as_bytes());
    let mut bytes = header.to_vec();
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(512), 0);
    bytes
}

/// A whole archive with these machine data.
fn archive(text: &str) -> Vec<u8> {
    let mut bytes = member("@@MMCIBN.002", "", "", b";---creation stamp---\n;---components---\nNCKComp\n");
    let text = format!("\nMETRIC\n\nCHANDATA(1)\n{text}M17\n");
    bytes.extend(member("_N_INITIAL_INI", "INITIAL.INI", r"\_NC_ACT.DIR\", text.as_bytes()));
    bytes.extend(member("_N_PS000001_TEA", "PS000001.TEA", r"\ADRV.DIR\", b"p10=1\n"));
    bytes
}

fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let directory = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("archives");
    fs::create_dir_all(&directory).expect("a directory of the build");
    let path = directory.join(name);
    fs::write(&path, bytes).expect("a file of the build");
    path
}

const AXES: &str = "N10000 $MN_AXCONF_MACHAX_NAME_TAB[0]=\"X1\"\nN10000 $MN_AXCONF_MACHAX_NAME_TAB[1]=\"Y1\"\n\
    N10000 $MN_AXCONF_MACHAX_NAME_TAB[2]=\"SP\"\nN10000 $MN_AXCONF_MACHAX_NAME_TAB[3]=\"\"\n\
    N10050 $MN_SYSCLOCK_CYCLE_TIME=0.002\nN10070 $MN_IPO_SYSCLOCK_TIME_RATIO=2\nN11300 $MN_JOG_INC_MODE_LEVELTRIGGRD=0\n\
    N20000 $MC_CHAN_NAME=\"MILL\"\nN20070 $MC_AXCONF_MACHAX_USED[0]=1\nN20070 $MC_AXCONF_MACHAX_USED[1]=2\n\
    N20070 $MC_AXCONF_MACHAX_USED[2]=3\nN20070 $MC_AXCONF_MACHAX_USED[3]=0\n";

#[test]
fn an_archive_with_search_velocities_and_mark_distances_of_0_references_the_other_axes() {
    let data = "N34000 $MA_REFP_CAM_IS_ACTIVE[AX1]=0\nN34300 $MA_ENC_REFP_MARKER_DIST[0,AX1]=0\nN34310 $MA_ENC_MARKER_INC[1,AX1]=0\n\
        N34020 $MA_REFP_VELO_SEARCH_CAM[AX2]=0\nN34040 $MA_REFP_VELO_SEARCH_MARKER[0,AX2]=0\nN34070 $MA_REFP_VELO_POS[AX2]=0\n\
        N34100 $MA_REFP_SET_POS[4,AX2]=1\nN52000 $MCS_ANY=1\n$TC_DP1[1,1]=120\nsomething else\n";
    let path = file("zeros.arc", &archive(&format!("{AXES}{data}")));
    let machine = Machine::open(&path).unwrap();
    let count = |class| machine.findings().iter().filter(|finding| finding.class == class).count();
    assert_eq!((count(Class::Unreadable), count(Class::Implausible)), (0, 6), "{:#?}", machine.findings());
    let enables = program("enables", (), |(), io| {
        for axis in io.axes() {
            io.to_nck.axis(axis).set_position_measuring_system_1(true);
            io.to_nck.axis(axis).set_controller_enable(true);
            io.to_nck.axis(axis).set_pulse_enable(true);
        }
    });
    let mut session = Session::open(&path).unwrap().with_program(enables.boxed());
    session.set("DB11.DBX1.2", 1).unwrap();
    session.wait("X1.position_controller_active", "1s").unwrap();
    session.pulse("X1.traversing_key_plus").unwrap();
    session.wait("X1.referenced_synchronized_1", "60s").unwrap();
    session.pulse("Y1.traversing_key_plus").unwrap();
    session.wait("alarm(20005, Y1) && !Y1.referenced_synchronized_1", "1s").unwrap();
}

/// `machine-data check` finds an alarm at power on exactly if power on raises it.
#[test]
fn power_on_raises_the_alarms_that_the_check_finds() {
    for (data, found) in [
        ("", &[][..]),
        (
            "N20070 $MC_AXCONF_MACHAX_USED[4]=5\n",
            &[
                "MD20070 $MC_AXCONF_MACHAX_USED[3] = 0, channel MILL: 4000: channel MILL machine datum 20070[3] has a gap",
            ],
        ),
        ("N20070 $MC_AXCONF_MACHAX_USED[4]=5\nN11640 $MN_ENABLE_CHAN_AX_GAP='H1'\n", &[]),
        (
            "N10060 $MN_POSCTRL_SYSCLOCK_TIME_RATIO=3\n",
            &["MD10070 $MN_IPO_SYSCLOCK_TIME_RATIO = 2: 4110: interpolation cycle changed to 6 ms"],
        ),
        ("N10060 $MN_POSCTRL_SYSCLOCK_TIME_RATIO=2\n", &[]),
        (
            "N10010 $MN_ASSIGN_CHAN_TO_MODE_GROUP[1]=1\nCHANDATA(2)\nN20070 $MC_AXCONF_MACHAX_USED[0]=2\n",
            &[
                "MD20070 $MC_AXCONF_MACHAX_USED[0] = 2, channel CHAN2: 4001: channel CHAN2 axis Y1 defined for more than",
            ],
        ),
        (
            "N30550 $MA_AXCONF_ASSIGN_MASTER_CHAN[AX2]=2\nN10010 $MN_ASSIGN_CHAN_TO_MODE_GROUP[1]=1\nCHANDATA(2)\n\
                N20070 $MC_AXCONF_MACHAX_USED[0]=2\n",
            &[],
        ),
        (
            "N37100 $MA_GANTRY_AXIS_TYPE[AX1]=9\n",
            &["MD37100 $MA_GANTRY_AXIS_TYPE[AX1] = 9, axis X1: 10650: channel MILL axis X1"],
        ),
    ] {
        let mut machine = Machine::open(file("power_on.arc", &archive(&format!("{AXES}{data}")))).unwrap();
        let alarms = machine.findings().iter().filter(|finding| finding.class == Class::AlarmAtPowerOn);
        let listed: Vec<String> = alarms.map(ToString::to_string).collect();
        assert_eq!(listed.len(), found.len(), "{listed:?}");
        for (listed, found) in listed.iter().zip(found) {
            assert!(listed.contains(found), "{listed}");
        }
        machine.step();
        let raised = machine.variables().alarms.iter();
        let raised: Vec<String> = raised.map(|alarm| format!(": {}: ", alarm.number.0)).collect();
        assert_eq!(raised.len(), found.len(), "{data}: {raised:?}");
        assert!(listed.iter().zip(&raised).all(|(listed, raised)| listed.contains(raised)), "{listed:?}, {raised:?}");
    }
}

/// O-30: MD10250 = 0 is kept, but no length becomes 0.
#[test]
fn an_inch_has_25_4_mm_where_md10250_is_0() {
    for (inch, expected) in [("0", 2_540.0), ("25", 2_500.0)] {
        let text = format!("INCH\nN10250 $MN_SCALING_VALUE_INCH={inch}\nN32020 $MA_JOG_VELO[AX1]=100\n");
        let machine = Machine::open(file("inch.tea", text.as_bytes())).unwrap();
        let stored = machine.control().data().stored(32020, Owner::Axis(AxisNumber::FIRST), 0).unwrap();
        assert_eq!(stored.value.number(), Some(expected), "{inch}");
    }
}

/// Names without a prefix are no machine data: they are reported, and the machine opens.
#[test]
fn names_without_a_prefix_are_reported_and_refuse_no_archive() {
    let text = "N37100 $MA_GANTRY_AXIS_TYPE[AX1]=0\nTOOL_COUNT=3\n_PARKED[2]=1\n2ND=1\n";
    let refused = Machine::open(file("variables.tea", text.as_bytes())).unwrap_err().to_string();
    assert!(
        refused.contains("variables.tea:4: ") && !refused.contains(".tea:2") && !refused.contains(".tea:3"),
        "{refused}"
    );
    let machine = Machine::open(file("variables.tea", text.replace("2ND=1\n", "").as_bytes())).unwrap();
    let kept: Vec<_> = machine.findings().iter().map(|finding| (finding.class, finding.datum.as_str())).collect();
    assert_eq!(kept, [(Class::Mistyped, "TOOL_COUNT"), (Class::Mistyped, "_PARKED[2]")]);
}

#[test]
fn a_damaged_archive_gives_one_clear_error() {
    let mut bytes = archive(AXES);
    bytes[1_024 + 148] = b'1';
    let problem = Machine::open(file("damaged.arc", &bytes)).unwrap_err().to_string();
    assert!(
        problem.contains("damaged.arc: expected the header checksum ") && problem.contains("at offset 1024"),
        "{problem}"
    );
    assert!(problem.contains("copy it again from the control, in binary mode"), "{problem}");
}

/// A value of a datum, inside or outside its range.
fn value(datum: &Datum, pick: u8, any: f64) -> String {
    let limits = [datum.range.minimum, datum.range.maximum].map(|limit| limit.unwrap_or_default());
    let number = match pick % 6 {
        0 => 0.0,
        1 => -1.0,
        2 => limits[0] - 1.0,
        3 => limits[1] * 10.0 + 1.0,
        _ => any,
    };
    let number = if datum.kind == Kind::Double { number } else { number.round().clamp(0.0, 255.0) };
    match datum.kind {
        Kind::Boolean => u8::from(pick.is_multiple_of(2)).to_string(),
        Kind::String => format!("\"N{pick}\""),
        Kind::Byte | Kind::Dword | Kind::Udword | Kind::Double => number.to_string(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn any_values_that_a_control_exports_open_and_run(
        values in prop::collection::vec((any::<prop::sample::Index>(), 1..4_u8, any::<u8>(), any::<u8>(), -1e12..1e12_f64), 1..120)
    ) {
        let data: Vec<_> = catalogue().filter(|datum| datum.kind != Kind::String && datum.number != 10010).collect();
        let mut text = AXES.to_owned();
        for (datum, axis, index, pick, any) in values {
            let datum = datum.get(&data);
            let index = u8::try_from(u16::from(index) % datum.count).unwrap();
            let index = match (datum.scope, datum.count) {
                (Scope::Axis | Scope::AxisSetting, 1) => format!("[AX{axis}]"),
                (Scope::Axis | Scope::AxisSetting, _) => format!("[{index},AX{axis}]"),
                (_, 1) => String::new(),
                _ => format!("[{index}]"),
            };
            let _ = writeln!(text, "N{} {}{index}={}", datum.number, datum.full_identifier(), value(datum, pick, any));
        }
        let path = file("any.arc", &archive(&text));
        let mut session = Session::open(&path).unwrap();
        for axis in ["DB31", "DB32", "DB33"] {
            for bit in ["DBX1.5", "DBX2.1", "DBX21.7", "DBX4.7"] {
                // Fails if the data take the axis away.
                let _ = session.set(&format!("{axis}.{bit}"), 1);
            }
        }
        session.set("DB11.DBX1.2", 1).unwrap();
        session.run("20cycles").unwrap();
        session.set("DB11.DBX1.2", 0).unwrap();
        session.run("20cycles").unwrap();
    }
}
