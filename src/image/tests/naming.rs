//! Tests of symbols and of the names of a machine.

use crate::image::{Memory, Names, Part};
use crate::units::{AxisNumber, ChannelNumber};

use super::names;

fn refused(text: &str) -> String {
    names().resolve(&Memory::new(), text).unwrap_err().to_string()
}

#[test]
fn symbol_and_address_are_the_same_location() {
    let (memory, names) = (Memory::new(), names());
    for (symbol, address) in [
        ("X.traversing_key_plus", "DB31.DBX4.7"),
        ("XF.gantry_axis", "DB33.DBX101.7"),
        ("CHAN2.channel_reset", "DB22.DBX7.7"),
        ("mode_group_2.mode_jog", "DB11.DBX20.2"),
        ("nck.emergency_stop", "DB10.DBX56.1"),
        ("X.feed_override", "DB31.DBB0"),
        ("X.positioning_axis_f_function", "DB31.DBD78"),
        ("X.spindle_m_function", "DB31.DBW86"),
        ("X.setpoint_gear_stage", "DB31.DBX82.0..2"),
    ] {
        let location = names.resolve(&memory, symbol).unwrap();
        assert_eq!(names.resolve(&memory, address).unwrap(), location);
        assert_eq!(names.address(location).to_string(), address);
        assert_eq!(names.symbol(location).as_deref(), Some(symbol));
    }
}

#[test]
fn a_byte_with_many_signals_has_a_writer_but_no_symbol() {
    let (memory, names) = (Memory::new(), names());
    let byte = names.resolve(&memory, "DB31.DBB101").unwrap();
    assert_eq!(names.symbol(byte), None);
    assert_eq!(names.writer(byte), Some(crate::image::Writer::Nck));
    let unnamed_axis = names.resolve(&memory, "DB61.DBX2.1").unwrap();
    assert_eq!(names.symbol(unnamed_axis), None);
}

#[test]
fn a_misspelt_symbol_gets_a_suggestion() {
    for (text, near) in [
        ("X.controler_enable", "`X.controller_enable`"),
        ("XG.controller_enable", "`X`"),
        ("CHAN3.channel_reset", "`CHAN1`"),
        ("nckk.emergency_stop", "`nck`"),
        ("mode_group_3.mode_jog", "`mode_group_1`"),
        ("X.Controller_Enable", "`controller_enable`"),
        ("X.CONTROLLER_ENABLE", "`controller_enable`"),
    ] {
        let problem = refused(text);
        assert!(problem.contains(&format!("did you mean {near}?")), "{text}: {problem}");
    }
}

#[test]
fn names_are_case_sensitive_and_other_kinds_of_block_are_not_searched() {
    assert!(refused("x.controller_enable").contains("found `x`"));
    assert!(refused("Z.controller_enable").contains("found `Z`"));
    assert!(refused("X.channel_reset").contains("a signal of `X` (axis 1)"));
    assert!(refused("X").contains("signal name"));
    assert!(refused("nonsense").contains("absolute address"));
}

#[test]
fn an_axis_can_have_the_name_of_a_flag() {
    let mut names = names();
    names.axes[AxisNumber::FIRST] = Some("M10".to_owned());
    assert_eq!(names.check(), Ok(()));
    let memory = Memory::new();
    assert_eq!(names.resolve(&memory, "M10.3").unwrap().part, Part::Flags);
    assert_eq!(names.resolve(&memory, "M10.controller_enable").unwrap().part, Part::ToNck);
}

#[test]
fn duplicate_and_invalid_names_are_rejected() {
    let with = |axis: &str, channel: &str| {
        let mut names = Names::default();
        names.axes[AxisNumber::FIRST] = Some("X".to_owned());
        names.axes[AxisNumber::new(2).unwrap()] = Some(axis.to_owned());
        names.channels[ChannelNumber::FIRST] = Some(channel.to_owned());
        names.check()
    };
    assert_eq!(with("Y", "CHAN1"), Ok(()));
    for (axis, channel, found) in [
        ("X", "CHAN1", "`X` for axis 1 and for axis 2"),
        ("Y", "X", "`X` for channel 1 and for axis 1"),
        ("nck", "CHAN1", "`nck`"),
        ("Y", "mode_group_2", "`mode_group_2`"),
        ("DB31", "CHAN1", "`DB31`"),
        ("", "CHAN1", "``"),
        ("A.B", "CHAN1", "`A.B`"),
        ("A B", "CHAN1", "`A B`"),
    ] {
        let problem = with(axis, channel).unwrap_err().to_string();
        assert!(problem.contains(found), "{problem}");
    }
}
