//! One axis: ranges, defaults and values in effect.

use super::{MASTER, axis, codes, hard, read, start, whole};
use crate::isg::lists::{AxisKind, Homing, OnMode};

/// An axis alone, with these entries.
fn alone(entries: &str) -> super::Started {
    start(&[("a.lis", &format!("kopf.achs_nr 1\nkenngr.achs_typ 1\nkenngr.achs_mode 1\n{entries}"))])
}

/// HG-06, B50: the resettable limit must be less than the locked limit, and gives way.
#[test]
fn equal_limits_are_out_of_range() {
    let started = hard("", "kenngr.gantry_max_diff_resetable 5000\n", "");
    assert_eq!(codes(&started.messages), ["P-AXIS-00072 3 5"]);
    let text = "P-AXIS-00072 kenngr.gantry_max_diff_resetable of axis 5: found 5000, allowed 1 … 4999 (P-AXIS-00071 is 5000), \
        used 4999 (x1.lis:10)";
    assert_eq!(started.messages[0].to_string(), text);
    let limits = axis(&started, 5).limits;
    assert_eq!((limits.first, limits.second), (4999, 5000));
    // 4999 is less than 5000.
    assert_eq!(codes(&hard("", "kenngr.gantry_max_diff_resetable 4999\n", "").messages), [""; 0]);
}

/// HG-06, B51: a slave needs its limits and its correction velocity.
#[test]
fn limits_of_0_are_out_of_range_for_a_slave() {
    let first = hard("", "kenngr.gantry_max_diff_resetable 0\n", "");
    assert_eq!((codes(&first.messages), axis(&first, 5).limits.first), (vec!["P-AXIS-00072 3 5".to_owned()], 1));
    // Nothing below 0 is left, so that the locked limit gives way.
    let second = hard("", "kenngr.gantry_max_diff_reset_locked 0\n", "");
    assert_eq!((codes(&second.messages), axis(&second, 5).limits.second), (vec!["P-AXIS-00071 3 5".to_owned()], 1001));
    let velocity = hard("", "kenngr.gantry_vb_korr 0\n", "");
    assert_eq!(codes(&velocity.messages), ["P-AXIS-00075 3 5"]);
    assert_eq!(axis(&velocity, 5).limits.correction_velocity, 1);
    let bare = "kopf.achs_nr 5\nkenngr.achs_mode 0x20001\nkenngr.gantry_ax_nr 1\n";
    let none = start(&[("x.lis", MASTER), ("x1.lis", bare)]);
    assert_eq!(codes(&none.messages), ["P-AXIS-00071 3 5", "P-AXIS-00072 3 5", "P-AXIS-00075 3 5"]);
    assert!(
        none.messages[0].text.contains("found no entry (default 0)") && none.messages[0].text.ends_with("(x1.lis)")
    );
    let limits = axis(&none, 5).limits;
    assert_eq!((limits.first, limits.second, limits.correction_velocity), (1, 2, 1));
}

/// HG-06: the correction velocity is less than the maximum velocity of the axis, and gives way.
#[test]
fn the_correction_velocity_is_less_than_the_maximum_velocity() {
    // The default of P-AXIS-00212 is 200000.
    let started = hard("", "kenngr.gantry_vb_korr 200000\n", "");
    assert_eq!(codes(&started.messages), ["P-AXIS-00075 3 5"]);
    assert_eq!(axis(&started, 5).limits.correction_velocity, 199_999);
    assert_eq!(codes(&hard("", "kenngr.gantry_vb_korr 199999\n", "").messages), [""; 0]);
}

/// HG-06: the largest number of the type is outside the range of the locked limit and of the offset.
#[test]
fn the_largest_number_is_out_of_range() {
    let started = hard("", "kenngr.gantry_max_diff_reset_locked 4294967295\nkenngr.gantry_offset -2147483648\n", "");
    assert_eq!(codes(&started.messages), ["P-AXIS-00073 3 5", "P-AXIS-00071 3 5"]);
    assert_eq!((axis(&started, 5).limits.second, axis(&started, 5).offset), (4_294_967_294, -2_147_483_647));
}

/// HG-06: the limits of an axis that is no slave may be 0; other values are checked.
#[test]
fn limits_of_0_are_silent_on_other_axes() {
    assert_eq!(codes(&alone("").messages), [""; 0]);
    assert_eq!(codes(&alone("kenngr.gantry_max_diff_resetable 100\n").messages), [""; 0]);
    let both = alone("kenngr.gantry_max_diff_resetable 100\nkenngr.gantry_max_diff_reset_locked 100\n");
    assert_eq!(codes(&both.messages), ["P-AXIS-00072 3 1"]);
}

/// HG-06: a pair with gantry monitoring binds the limits of its slave.
#[test]
fn a_gantry_pair_needs_the_limits_of_its_slave() {
    let lists =
        read(&[("a.lis", "kopf.achs_nr 1\nkenngr.achs_mode 1\nkenngr.gantry_max_diff_reset_locked 2500\n")]).unwrap();
    let (limits, messages) = lists.gantry_pair(1).unwrap();
    assert_eq!(codes(&messages), ["P-AXIS-00072 3 1", "P-AXIS-00075 3 1"]);
    assert_eq!((limits.first, limits.second, limits.correction_velocity), (1, 2500, 1));
    assert_eq!(lists.gantry_pair(2), None);
}

/// HG-22, B48: a_emergency 0 is a_max.
#[test]
fn an_emergency_deceleration_of_0_is_the_maximum_acceleration() {
    let started = alone("getriebe[0].dynamik.a_max 1500\n");
    assert_eq!((axis(&started, 1).a_emergency, whole(axis(&started, 1), "P-AXIS-00003")), (1500, 1500));
    let other = alone("getriebe[0].dynamik.a_max 1500\ngetriebe[0].dynamik.a_emergency 500\n");
    assert_eq!((axis(&other, 1).a_emergency, other.messages.len()), (500, 0));
}

/// HG-22, B49: a_emergency is at most two times a_max.
#[test]
fn the_emergency_deceleration_is_at_most_two_times_the_maximum() {
    let started = alone("getriebe[0].dynamik.a_max 1000\ngetriebe[0].dynamik.a_emergency 2001\n");
    let text = "P-AXIS-00003 getriebe[0].dynamik.a_emergency of axis 1: found 2001, allowed 1 … 2000 (P-AXIS-00008 is 1000), \
        used 2000 (a.lis:5)";
    assert_eq!(started.messages[0].text, text);
    assert_eq!((codes(&started.messages), axis(&started, 1).a_emergency), (vec!["P-AXIS-00003 3 1".to_owned()], 2000));
    assert_eq!(
        codes(&alone("getriebe[0].dynamik.a_max 1000\ngetriebe[0].dynamik.a_emergency 2000\n").messages),
        [""; 0]
    );
}

/// HG-06: maximum acceleration and velocity.
#[test]
fn maximum_values_have_ranges() {
    let started = alone("getriebe[0].dynamik.a_max 0\ngetriebe[0].dynamik.vb_max 2000000001\n");
    assert_eq!(codes(&started.messages), ["P-AXIS-00008 3 1", "P-AXIS-00212 3 1"]);
    assert_eq!((axis(&started, 1).a_max, axis(&started, 1).vb_max), (1, 2_000_000_000));
}

/// HG-06: values of homing are within the maximum of the axis; defaults follow it silently.
#[test]
fn values_of_homing_are_within_the_maximum() {
    let small = alone("getriebe[0].dynamik.vb_max 10000\ngetriebe[0].dynamik.a_max 500\n");
    let axis_1 = axis(&small, 1);
    assert_eq!(codes(&small.messages), [""; 0]);
    assert_eq!((axis_1.vb_ref_fast, axis_1.vb_ref_slow, axis_1.a_ref, axis_1.a_step), (10000, 10000, 500, [500, 500]));
    let written = alone("getriebe[0].vb_refmax 300000\ngetriebe[0].vb_reflow 250000\ngetriebe[0].a_ref 1001\n");
    assert_eq!(codes(&written.messages), ["P-AXIS-00285 3 1", "P-AXIS-00219 3 1", "P-AXIS-00218 3 1"]);
    let axis_1 = axis(&written, 1);
    assert_eq!((axis_1.vb_ref_fast, axis_1.vb_ref_slow, axis_1.a_ref), (200_000, 200_000, 1000));
    let steps = alone("getriebe[0].lslope_profil.a_grenz_stufe_1 700\ngetriebe[0].lslope_profil.a_grenz_stufe_2 300\n");
    assert_eq!(axis(&steps, 1).a_ref, 300);
}

/// HG-01: a mode without a basic mode is corrected with a warning.
#[test]
fn a_rotary_axis_without_a_basic_mode_is_corrected() {
    let of = |mode: &str, kind: &str| {
        let text = format!("kopf.achs_nr 1\nkenngr.achs_typ {kind}\nkenngr.achs_mode {mode}\n");
        let started = start(&[("a.lis", &text)]);
        (codes(&started.messages), whole(axis(&started, 1), "kenngr.achs_mode"), axis(&started, 1).is_modulo)
    };
    let told = |code: &str| vec![code.to_owned()];
    assert_eq!(of("0x10000", "2"), (told("110053 1 1"), 0x10001, false));
    assert_eq!(of("0", "2"), (told("110353 1 1"), 0x4, true));
    assert_eq!(of("0", "1"), (told("110353 1 1"), 0x1, false));
    assert_eq!(of("0x10000", "1"), (vec![], 0x10001, false));
    assert_eq!(of("0x10004", "2"), (vec![], 0x10004, true));
    assert_eq!(of("0x10001", "2"), (vec![], 0x10001, false));
    assert_eq!(of("0x401", "1"), (vec![], 0x401, true));
    assert_eq!(of("0x20000001", "1"), (told("P-AXIS-00015 3 1"), 1, false));
}

/// HG-06: the type of an axis is one of three.
#[test]
fn an_unknown_axis_type_is_out_of_range() {
    let of = |kind: &str| {
        let started = start(&[("a.lis", &format!("kopf.achs_nr 1\nkenngr.achs_mode 5\nkenngr.achs_typ {kind}\n"))]);
        (codes(&started.messages), axis(&started, 1).kind)
    };
    assert_eq!(of("1"), (vec![], AxisKind::Linear));
    assert_eq!(of("2"), (vec![], AxisKind::Rotary));
    assert_eq!(of("4"), (vec![], AxisKind::Spindle));
    assert_eq!(of("0"), (vec!["P-AXIS-00018 3 1".to_owned()], AxisKind::Linear));
    assert_eq!(of("3"), (vec!["P-AXIS-00018 3 1".to_owned()], AxisKind::Rotary));
    assert_eq!(of("9"), (vec!["P-AXIS-00018 3 1".to_owned()], AxisKind::Spindle));
}

/// HG-04: a modulo range needs an upper limit above the lower one; otherwise the defaults act.
#[test]
fn a_modulo_range_that_is_none_is_replaced() {
    let of = |kind: &str, range: &str| {
        let text = format!("kopf.achs_nr 1\nkenngr.achs_typ {kind}\nkenngr.achs_mode 5\n{range}");
        let started = start(&[("a.lis", &text)]);
        (codes(&started.messages), axis(&started, 1).modulo_range)
    };
    let none = "getriebe[0].moduloo 100\ngetriebe[0].modulou 100\n";
    assert_eq!(of("2", none), (vec!["110052 1 1".to_owned()], [0, 3_600_000]));
    assert_eq!(of("1", none), (vec![], [100, 100]));
    assert_eq!(of("2", "getriebe[0].moduloo 1800000\n"), (vec![], [0, 1_800_000]));
    let wide = "getriebe[0].moduloo 2147483647\ngetriebe[0].modulou -2147483648\n";
    assert_eq!(of("2", wide), (vec!["110308 1 1".to_owned()], [0, 3_600_000]));
}

/// HG-12, B52, E-22: with P-AXIS-00261, only DEFAULT and EDGE_TRIGGERED are possible.
#[test]
fn edge_detection_corrects_other_modes() {
    let of = |mode: &str, edge: u8| {
        let started = hard("", &format!("kenngr.gantry_on_mode {mode}\nP-AXIS-00261 {edge}\n"), "");
        (codes(&started.messages), axis(&started, 5).on_mode)
    };
    let told = || vec!["110606 1 5".to_owned()];
    assert_eq!(of("ONLY_CONTROL_UNIT", 1), (told(), OnMode::EdgeTriggered));
    assert_eq!(of("CONFIG", 1), (told(), OnMode::EdgeTriggered));
    assert_eq!(of("DEFAULT", 1), (vec![], OnMode::Default));
    assert_eq!(of("EDGE_TRIGGERED", 1), (vec![], OnMode::EdgeTriggered));
    assert_eq!(of("ONLY_CONTROL_UNIT", 0), (vec![], OnMode::OnlyControlUnit));
    assert_eq!(of("CONFIG", 0), (vec![], OnMode::Config));
    assert_eq!(of("config", 0), (vec!["P-AXIS-00704 3 5".to_owned()], OnMode::Default));
}

/// DEFAULT with P-AXIS-00261 acts on the edge, as EDGE_TRIGGERED does.
#[test]
fn two_modes_act_on_the_edge() {
    let of = |mode: &str, edge: u8| {
        let started = hard("", &format!("kenngr.gantry_on_mode {mode}\nP-AXIS-00261 {edge}\n"), "");
        axis(&started, 5).clears_on_edge()
    };
    assert!(of("DEFAULT", 1) && of("EDGE_TRIGGERED", 0) && of("EDGE_TRIGGERED", 1));
    assert!(!of("DEFAULT", 0) && !of("ONLY_CONTROL_UNIT", 0) && !of("CONFIG", 0));
}

/// HG-26: a spindle is no gantry slave, and P-AXIS-00074 does nothing on one.
#[test]
fn a_spindle_has_no_gantry_parameters() {
    let spindle = "kopf.achs_nr 5\nkenngr.achs_typ 4\nkenngr.achs_mode 0x20004\nkenngr.gantry_ax_nr 1\nkenngr.gantry_slave_no_homing 1\n";
    let started = start(&[("x.lis", MASTER), ("s.lis", spindle)]);
    assert_eq!(codes(&started.messages), ["P-AXIS-00015 3 5"]);
    let spindle = axis(&started, 5);
    assert_eq!((spindle.is_slave, spindle.master, spindle.slave_no_homing), (false, None, false));
    let linear = hard("", "kenngr.gantry_slave_no_homing 1\n", "");
    assert!(axis(&linear, 5).slave_no_homing);
}

/// The parameters of homing.
#[test]
fn parameters_of_homing_are_read() {
    let started = alone(
        "kenngr.homing.homing_type DRIVE_CONROLLED\nkenngr.gantry_synchronous_slave_homing 1\ngetriebe[0].pos_refpkt -125000\n\
        kenngr.ref_richt 1\nref_ohne_nocken 1\nkenngr.ref_ohne_rev 1\nhoming_without_zero_pulse 1\nkenngr.gantry_max_homing_dist -500\n\
        kenngr.copy_master_gantry_coupling_to_slave 1\nkenngr.gantry_diff_check_without_homing 1\nP-AXIS-00367 20\n",
    );
    assert_eq!(codes(&started.messages), [""; 0]);
    let axis = axis(&started, 1);
    assert_eq!((axis.homing, axis.is_homing_given, axis.reference_position), (Homing::DriveControlled, true, -125_000));
    assert!(axis.synchronous_homing && axis.is_reference_direction_positive && axis.check_without_homing);
    assert!(axis.has_no_cam && axis.has_no_reversal && axis.has_no_zero_pulse && axis.copies_master_coupling);
    assert_eq!((axis.max_homing_distance, axis.watchdog_delay), (500, 20));
    let plain = alone("");
    let plain = super::axis(&plain, 1);
    assert_eq!((plain.homing, plain.is_homing_given, plain.has_no_cam), (Homing::CncControlled, false, false));
    assert_eq!(codes(&alone("kenngr.homing.homing_type SOMEHOW\n").messages), ["P-AXIS-00299 3 1"]);
}
