//! Gantry combinations: masters, and what slaves take from them.

use super::{CHANNEL, MASTER, SLAVE, axis, codes, hard, start, whole};
use crate::isg::lists::AxisKind;

/// HG-01: the slave bit, the master bit and P-AXIS-00070 together make a combination; each of them alone does not.
#[test]
fn a_combination_needs_both_bits_and_the_number() {
    let without_slave_bit = hard("", "kenngr.achs_mode 1\n", "");
    assert_eq!(codes(&without_slave_bit.messages), ["P-AXIS-00015 3 5"]);
    assert_eq!((axis(&without_slave_bit, 5).is_slave, axis(&without_slave_bit, 5).master), (false, None));
    let without_number = hard("", "kenngr.gantry_ax_nr 0\n", "");
    assert_eq!(codes(&without_number.messages), ["P-AXIS-00070 3 5"]);
    assert_eq!((axis(&without_number, 5).is_slave, axis(&without_number, 5).master), (true, None));
    let both_bits = hard("", "kenngr.achs_mode 0x30001\nkenngr.gantry_ax_nr 0\n", "");
    assert_eq!(codes(&both_bits.messages), ["P-AXIS-00015 3 5"]);
    assert_eq!((axis(&both_bits, 5).is_master, axis(&both_bits, 5).is_slave), (true, false));
}

/// HG-01: a slave that names itself or an axis without a list is not coupled.
#[test]
fn a_slave_that_names_no_axis_is_not_coupled() {
    for named in ["5", "9"] {
        let started = hard("", &format!("kenngr.gantry_ax_nr {named}\n"), "");
        assert_eq!(codes(&started.messages), ["P-AXIS-00070 3 5"]);
        assert_eq!(axis(&started, 5).master, None);
        assert_eq!(axis(&started, 6).master, Some(1));
    }
}

/// HG-01, B44: a master with a master is an error, and its entry is set to 0.
#[test]
fn a_master_has_no_master() {
    let started = hard("kenngr.gantry_ax_nr 5\n", "", "");
    assert_eq!(codes(&started.messages), ["110342 3 1"]);
    let text = "P-AXIS-00070 kenngr.gantry_ax_nr of axis 1: found 5, allowed 0, because the axis is a gantry master, used 0 (x.lis:5)";
    assert_eq!(started.messages[0].text, text);
    assert_eq!((whole(axis(&started, 1), "P-AXIS-00070"), axis(&started, 1).master), (0, None));
}

/// HG-01, B45: a slave that names an axis without the master bit gives a warning and is not coupled.
#[test]
fn an_axis_without_the_master_bit_is_no_master() {
    let other = "kopf.achs_nr 2\nkenngr.achs_typ 1\nkenngr.achs_mode 1\n";
    let slave = format!("kopf.achs_nr 5\n{SLAVE}kenngr.gantry_ax_nr 2\n");
    let started = start(&[("x.lis", MASTER), ("y.lis", other), ("x1.lis", &slave)]);
    assert_eq!(codes(&started.messages), ["70124 1 5"]);
    assert!(started.messages[0].is_warning());
    assert_eq!((started.messages[0].other_axis, axis(&started, 5).master), (Some(2), None));
    // A slave is no master either.
    let chain = format!("kopf.achs_nr 7\n{SLAVE}kenngr.gantry_ax_nr 5\n");
    let started = start(&[("x.lis", MASTER), ("x1.lis", &format!("kopf.achs_nr 5\n{SLAVE}")), ("x2.lis", &chain)]);
    assert_eq!(codes(&started.messages), ["70124 1 7"]);
}

/// HG-03, B43: a slave in a channel is an error, and does not belong to the channel.
#[test]
fn a_slave_in_a_channel_is_an_error() {
    let channel = "gruppe[0].achs_anzahl 2\ngruppe[0].achse[1].bezeichnung X1\ngruppe[0].achse[1].log_achs_nr 5\n";
    let started = hard("", "", channel);
    assert_eq!(codes(&started.messages), ["21020 3 5"]);
    assert!(started.messages[0].text.contains("P-CHAN-00035 gruppe[0].achse[1].log_achs_nr"));
    assert!(started.messages[0].text.ends_with("(channel.lis:6)"));
    assert_eq!(started.messages[0].channel, Some(1));
    assert_eq!(started.channels[0].axes.len(), 1);
    let beyond = hard("", "", "gruppe[0].achse[1].bezeichnung X1\ngruppe[0].achse[1].log_achs_nr 5\n");
    assert_eq!(codes(&beyond.messages), ["P-CHAN-00003 3 -", "21020 3 5"]);
}

/// Only a master has a name in a channel; a slave has its default name.
#[test]
fn only_the_master_is_in_the_channel() {
    let started = hard("", "", "");
    assert_eq!(started.channels[0].axes.iter().map(|axis| axis.number).collect::<Vec<_>>(), [1]);
    assert_eq!(started.names(axis(&started, 5)), ["Axis_X1"]);
}

/// HG-04, B46: the modulo range is taken from the master, each limit with a warning.
#[test]
fn the_modulo_range_is_taken_from_the_master() {
    let rotary = "kenngr.achs_typ 2\nkenngr.achs_mode 0x10004\n";
    let slave = "kenngr.achs_typ 2\nkenngr.achs_mode 0x20004\ngetriebe[0].moduloo 1800000\n";
    let files = [
        ("a.lis", format!("{MASTER}{rotary}getriebe[0].moduloo 3600000\n")),
        ("b.lis", format!("kopf.achs_nr 5\n{SLAVE}{slave}")),
    ];
    let of = |files: &[(&str, String)]| {
        let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (*name, text.as_str())).collect();
        start(&files)
    };
    let started = of(&files);
    assert_eq!(codes(&started.messages), ["70202 1 5"]);
    let text = "P-AXIS-00126 getriebe[0].moduloo of axis 5: found 1800000, its gantry master axis 1 has 3600000 (a.lis:7); \
        used: the value of the master (b.lis:11)";
    assert_eq!(started.messages[0].text, text);
    assert_eq!(axis(&started, 5).modulo_range, [0, 3_600_000]);
    let mut files = files;
    files[1].1 =
        format!("kopf.achs_nr 5\n{SLAVE}kenngr.achs_typ 2\nkenngr.achs_mode 0x20004\ngetriebe[0].modulou 100\n");
    let started = of(&files);
    assert_eq!(
        (codes(&started.messages), axis(&started, 5).modulo_range),
        (vec!["70202 1 5".to_owned()], [0, 3_600_000])
    );
}

/// HG-04: the modulo mode, axis type and bit 0x4, is taken from the master.
#[test]
fn the_modulo_mode_is_taken_from_the_master() {
    let kind = hard("", "kenngr.achs_typ 2\n", "");
    assert_eq!((codes(&kind.messages), axis(&kind, 5).kind), (vec!["P-AXIS-00018 1 5".to_owned()], AxisKind::Linear));
    let bit = hard("", "kenngr.achs_mode 0x20005\n", "");
    assert_eq!(codes(&bit.messages), ["P-AXIS-00015 1 5"]);
    assert_eq!(whole(axis(&bit, 5), "kenngr.achs_mode"), 0x20001);
    // Other bits of the mode may differ.
    let other = hard("", "kenngr.achs_mode 0x28001\n", "");
    assert_eq!((codes(&other.messages), whole(axis(&other, 5), "kenngr.achs_mode")), (vec![], 0x28001));
}

/// HG-04: the maximum acceleration is taken from the master.
#[test]
fn the_maximum_acceleration_is_taken_from_the_master() {
    let started = hard("", "getriebe[0].dynamik.a_max 500\n", "");
    assert_eq!((codes(&started.messages), axis(&started, 5).a_max), (vec!["P-AXIS-00008 1 5".to_owned()], 1000));
    assert_eq!(axis(&started, 6).a_max, 1000);
}

/// HG-04: the emergency deceleration is taken from the master.
#[test]
fn the_emergency_deceleration_is_taken_from_the_master() {
    let started = hard("getriebe[0].dynamik.a_emergency 500\n", "getriebe[0].dynamik.a_emergency 800\n", "");
    assert_eq!(codes(&started.messages), ["P-AXIS-00003 1 5", "P-AXIS-00003 1 6"]);
    assert_eq!((axis(&started, 5).a_emergency, axis(&started, 6).a_emergency), (500, 500));
}

/// HG-04, HG-13, B47: the CNC-controlled error reaction is corrected in the slave.
#[test]
fn the_error_reaction_is_taken_from_the_master() {
    let started = hard("kenngr.cnc_controlled_stop_after_error 1\n", "kenngr.cnc_controlled_stop_after_error 0\n", "");
    assert_eq!(codes(&started.messages), ["P-AXIS-00254 1 5", "P-AXIS-00254 1 6"]);
    assert!(started.messages.iter().all(|message| message.is_warning() && message.other_axis == Some(1)));
    assert!(axis(&started, 5).cnc_controlled_stop && axis(&started, 6).cnc_controlled_stop);
    assert_eq!(whole(axis(&started, 5), "kenngr.cnc_controlled_stop_after_error"), 1);
}

/// HG-04: the homing type is taken from the master.
#[test]
fn the_homing_type_is_taken_from_the_master() {
    let started = hard("", "kenngr.homing.homing_type DISABLED\n", "");
    assert_eq!(codes(&started.messages), ["P-AXIS-00299 1 5"]);
    assert_eq!((axis(&started, 5).homing, axis(&started, 5).is_homing_given), (axis(&started, 1).homing, false));
}

/// HG-04: the delay after an error of the PLC watchdog is taken from the master.
#[test]
fn the_watchdog_delay_is_taken_from_the_master() {
    let started = hard("P-AXIS-00367 100\n", "P-AXIS-00367 50\n", "");
    assert_eq!(codes(&started.messages), ["P-AXIS-00367 1 5", "P-AXIS-00367 1 6"]);
    assert_eq!((axis(&started, 5).watchdog_delay, axis(&started, 6).watchdog_delay), (100, 100));
}

/// HG-18: every other parameter may differ, and the slave's own value acts.
#[test]
fn other_parameters_may_differ() {
    let own = "getriebe[0].dynamik.vb_max 100000\ngetriebe[0].pos_refpkt 125000\nkenngr.ref_richt 1\ngetriebe[0].vb_refmax 50000\n\
        getriebe[0].a_ref 300\nkenngr.gantry_slave_no_homing 1\nkenngr.gantry_diff_check_without_homing 1\n\
        kenngr.gantry_synchronous_slave_homing 1\nkenngr.gantry_on_mode CONFIG\nkenngr.gantry_offset 7\n\
        kenngr.copy_master_gantry_coupling_to_slave 1\nkenngr.gantry_max_homing_dist 9\nref_ohne_nocken 1\n";
    let started = hard("", own, "");
    assert_eq!(codes(&started.messages), [""; 0]);
    let slave = axis(&started, 5);
    assert_eq!(
        (slave.vb_max, slave.reference_position, slave.vb_ref_fast, slave.a_ref),
        (100_000, 125_000, 50_000, 300)
    );
    assert_eq!((slave.offset, slave.max_homing_distance, slave.slave_no_homing), (7, 9, true));
}

/// A master need not be a channel axis.
#[test]
fn a_master_without_a_channel_has_its_slaves() {
    let slave = format!("kopf.achs_nr 5\n{SLAVE}");
    let started = start(&[("x.lis", MASTER), ("x1.lis", &slave)]);
    assert_eq!((codes(&started.messages), axis(&started, 5).master), (vec![], Some(1)));
}

/// HG-27: several combinations stand side by side.
#[test]
fn combinations_stand_side_by_side() {
    let second = "kopf.achs_nr 2\nkenngr.achs_mode 0x10001\ngetriebe[0].dynamik.a_max 700\n";
    let own = format!("kopf.achs_nr 8\n{SLAVE}kenngr.gantry_ax_nr 2\ngetriebe[0].dynamik.a_max 700\n");
    let started = start(&[
        ("a.lis", MASTER),
        ("b.lis", second),
        ("c.lis", &format!("kopf.achs_nr 5\n{SLAVE}")),
        ("d.lis", &own),
        ("e.lis", CHANNEL),
    ]);
    assert_eq!(codes(&started.messages), [""; 0]);
    assert_eq!((axis(&started, 5).master, axis(&started, 8).master), (Some(1), Some(2)));
    assert_eq!((axis(&started, 5).a_max, axis(&started, 8).a_max), (1000, 700));
}
