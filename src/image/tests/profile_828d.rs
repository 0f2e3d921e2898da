//! Tests of the 828D, which shows the same memory under its own numbers.

use crate::image::{Block, Memory};

use super::{all_names, location, names, names_828d, signals};

/// Address on the 840D sl, address on the 828D, copied from the manuals by hand; axis XF is axis 3.
const EQUIVALENT: &[(&str, &str)] = &[
    ("DB10.DBB57", "DB2600.DBB1"),
    ("DB10.DBX100.6", "DB1900.DBX1003.6"),
    ("DB10.DBX102.7", "DB1900.DBX1005.7"),
    ("DB21.DBX24.6", "DB1700.DBX0.6"),
    ("DB21.DBX25.3", "DB1700.DBX1.3"),
    ("DB21.DBB26", "DB1700.DBB2"),
    ("DB21.DBX30.5", "DB3200.DBX14.5"),
    ("DB21.DBX31.6", "DB3200.DBX15.6"),
    ("DB21.DBX384.0", "DB3200.DBX16.0"),
    ("DB21.DBX318.5", "DB3300.DBX4002.5"),
    ("DB21.DBX58.0", "DB2500.DBX4.0"),
    ("DB21.DBX60.0", "DB2500.DBX6.0"),
    ("DB21.DBX61.0", "DB2500.DBX8.0"),
    ("DB21.DBX62.0", "DB2500.DBX10.0"),
    ("DB21.DBX64.2", "DB2500.DBX12.2"),
    ("DB21.DBX194.3", "DB2500.DBX1000.3"),
    ("DB21.DBX206.3", "DB2500.DBX1012.3"),
    ("DB21.DBB208", "DB3500.DBB0"),
    ("DB21.DBB271", "DB3500.DBB63"),
    ("DB10.DBX56.1", "DB2600.DBX0.1"),
    ("DB10.DBX56.2", "DB2600.DBX0.2"),
    ("DB10.DBX106.1", "DB2700.DBX0.1"),
    ("DB10.DBX108.6", "DB2700.DBX2.6"),
    ("DB10.DBX109.0", "DB2700.DBX3.0"),
    ("DB11.DBX0.0", "DB3000.DBX0.0"),
    ("DB11.DBX0.2", "DB3000.DBX0.2"),
    ("DB11.DBX0.7", "DB3000.DBX0.7"),
    ("DB11.DBX1.2", "DB3000.DBX1.2"),
    ("DB11.DBX5.2", "DB1800.DBX1.2"),
    ("DB11.DBX6.2", "DB3100.DBX0.2"),
    ("DB11.DBX6.3", "DB3100.DBX0.3"),
    ("DB11.DBX7.2", "DB3100.DBX1.2"),
    ("DB21.DBX1.0", "DB3200.DBX1.0"),
    ("DB21.DBB4", "DB3200.DBB4"),
    ("DB21.DBB5", "DB3200.DBB5"),
    ("DB21.DBX6.0", "DB3200.DBX6.0"),
    ("DB21.DBX7.1", "DB3200.DBX7.1"),
    ("DB21.DBX12.7", "DB3200.DBX1000.7"),
    ("DB21.DBX16.6", "DB3200.DBX1004.6"),
    ("DB21.DBX33.0", "DB3300.DBX1.0"),
    ("DB21.DBX35.7", "DB3300.DBX3.7"),
    ("DB21.DBX36.2", "DB3300.DBX4.2"),
    ("DB21.DBX36.6", "DB3300.DBX4.6"),
    ("DB21.DBX46.6", "DB3300.DBX1004.6"),
    ("DB31.DBB0", "DB3800.DBB0"),
    ("DB31.DBX1.5", "DB3800.DBX1.5"),
    ("DB31.DBX2.1", "DB3800.DBX2.1"),
    ("DB33.DBX4.7", "DB3802.DBX4.7"),
    ("DB33.DBX12.0", "DB3802.DBX1000.0"),
    ("DB33.DBX12.7", "DB3802.DBX1000.7"),
    ("DB33.DBX20.1", "DB3802.DBX4000.1"),
    ("DB33.DBX21.7", "DB3802.DBX4001.7"),
    ("DB38.DBX29.4", "DB3807.DBX5005.4"),
    ("DB31.DBX60.4", "DB3900.DBX0.4"),
    ("DB31.DBX60.5", "DB3900.DBX0.5"),
    ("DB31.DBX61.4", "DB3900.DBX1.4"),
    ("DB31.DBX64.7", "DB3900.DBX4.7"),
    ("DB31.DBX76.4", "DB3900.DBX1002.4"),
    ("DB31.DBX93.5", "DB3900.DBX4001.5"),
    ("DB31.DBX93.7", "DB3900.DBX4001.7"),
    ("DB31.DBX102.5", "DB3900.DBX5006.5"),
    ("DB38.DBX102.6", "DB3907.DBX5006.6"),
];

/// P828-03
#[test]
fn both_addresses_are_one_location_and_each_profile_prints_its_own() {
    let memory = Memory::new();
    for (sl, d828) in EQUIVALENT {
        let location = names().resolve(&memory, sl).unwrap();
        assert_eq!(names_828d().resolve(&memory, d828).unwrap(), location, "{sl} {d828}");
        assert_eq!(names().address(location).to_string(), *sl);
        assert_eq!(names_828d().address(location).to_string(), *d828);
    }
}

/// P828-01
#[test]
fn gantry_signals_lie_in_byte_5005_of_the_axis() {
    let (memory, names) = (Memory::new(), names_828d());
    for (symbol, address) in [
        ("X.start_gantry_synchronization", "DB3800.DBX5005.4"),
        ("X.no_automatic_synchronization", "DB3800.DBX5005.5"),
        ("XF.gantry_trip_limit_exceeded", "DB3902.DBX5005.2"),
        ("XF.gantry_warning_limit_exceeded", "DB3902.DBX5005.3"),
        ("X.gantry_synchronization_ready_to_start", "DB3900.DBX5005.4"),
        ("X.gantry_grouping_is_synchronized", "DB3900.DBX5005.5"),
        ("X.gantry_leading_axis", "DB3900.DBX5005.6"),
        ("X.gantry_axis", "DB3900.DBX5005.7"),
    ] {
        assert_eq!(names.resolve(&memory, symbol), names.resolve(&memory, address), "{symbol}");
    }
}

/// P828-02
#[test]
fn the_four_digit_spelling_finds_ref_referencing_and_referenced() {
    let (memory, names) = (Memory::new(), names_828d());
    for (symbol, address) in [
        ("mode_group_1.active_machine_function_ref", "DB3100.DBX0001.2"),
        ("CHAN1.referencing_active", "DB3300.DBX0001.0"),
        ("XF.referenced_synchronized_1", "DB3902.DBX0000.4"),
        ("XF.referenced_synchronized_2", "DB3902.DBX0000.5"),
    ] {
        assert_eq!(names.resolve(&memory, symbol), names.resolve(&memory, address), "{symbol}");
    }
}

#[test]
fn every_signal_has_an_address_that_leads_back_or_keeps_its_840d_sl_address() {
    let memory = Memory::new();
    let names = crate::image::Names { profile: super::D828, ..all_names() };
    let mut shown = 0;
    for signal in signals() {
        let count = if signal.block == Block::Axis { 8 } else { 1 };
        for number in 1..=count {
            let location = location(signal, number);
            let address = names.address(location);
            match memory.locate(&address, super::D828) {
                Ok(back) => {
                    assert_eq!(back, location, "{address}");
                    shown += 1;
                }
                Err(_) => assert_eq!(address, all_names().address(location)),
            }
        }
    }
    assert!(shown > 8 * 100);
}

/// The signals that only the 828D has, or has with another width: symbol and address.
const OWN: &[(&str, &str)] = &[
    ("nck.user_alarm_700000", "DB1600.DBX0.0"),
    ("nck.user_alarm_700016", "DB1600.DBX2.0"),
    ("nck.user_alarm_700247", "DB1600.DBX30.7"),
    ("nck.user_alarm_disables_nc_start", "DB1600.DBX2000.0"),
    ("nck.user_alarm_plc_stop", "DB1600.DBX2000.4"),
    ("nck.acknowledge_user_alarms", "DB1600.DBX3000.0"),
    ("nck.user_data_integer_0", "DB4500.DBW0"),
    ("nck.user_data_integer_31", "DB4500.DBW62"),
    ("nck.user_data_byte_31", "DB4500.DBB1031"),
    ("nck.user_data_real_7", "DB4500.DBD2028"),
    ("CHAN1.t_function_1", "DB2500.DBD2000"),
    ("CHAN1.m_function_1", "DB2500.DBD3000"),
    ("CHAN1.m_function_1_extension", "DB2500.DBB3004"),
    ("CHAN1.m_function_5", "DB2500.DBD3032"),
    ("CHAN1.s_function_1", "DB2500.DBD4000"),
    ("CHAN1.s_function_3_extension", "DB2500.DBB4020"),
    ("CHAN1.d_function_1", "DB2500.DBD5000"),
    ("CHAN1.h_function_3", "DB2500.DBD6016"),
    ("X.spindle_m_function", "DB3700.DBD0"),
    ("XF.spindle_s_function", "DB3702.DBD4"),
    ("X.axis_actual_value", "DB5700.DBD0"),
    ("XF.axis_distance_to_go", "DB5702.DBD4"),
];

/// P828-03
#[test]
fn signals_of_its_own_are_at_its_addresses_and_only_there() {
    let (memory, names_828d) = (Memory::new(), names_828d());
    for (symbol, address) in OWN {
        let location = names_828d.resolve(&memory, symbol).unwrap();
        assert_eq!(names_828d.resolve(&memory, address).unwrap(), location, "{symbol}");
        assert_eq!(names_828d.address(location).to_string(), *address, "{symbol}");
        assert_eq!(names_828d.symbol(location).as_deref(), Some(*symbol));
        match names().resolve(&memory, symbol) {
            // The 840D sl has it elsewhere, with another width.
            Ok(other) => assert_ne!(other, location, "{symbol}"),
            Err(problem) => assert!(problem.to_string().contains("the 840D sl shows"), "{symbol}: {problem}"),
        }
    }
}

/// P828-03: no source gives these an address on the 828D. A scenario for both controls can name them, and they keep the other address.
#[test]
fn a_symbol_that_only_the_840d_sl_shows_keeps_its_address() {
    let memory = Memory::new();
    for (symbol, address) in [("CHAN1.f_function_1", "DB21.DBD160"), ("X.repos_delay", "DB31.DBX72.0")] {
        let location = names_828d().resolve(&memory, symbol).unwrap();
        assert_eq!(names_828d().address(location).to_string(), address);
        assert!(!super::D828.shows(location));
    }
}

#[test]
fn blocks_that_the_828d_does_not_have_are_rejected() {
    let refused = |text: &str| names_828d().resolve(&Memory::new(), text).unwrap_err().to_string();
    assert!(refused("DB31.DBX101.5").contains("840D sl"));
    assert!(refused("DB1600.DBX31.0").contains("0 to 30, 1000 to 1991, 2000 to 2000, 3000 to 3000"));
    assert!(refused("DB5708.DBD0").contains("DB5700 to DB5707"));
    assert!(refused("DB3808.DBB0").contains("DB3800 to DB3807"));
    assert!(refused("DB3900.DBB12").contains("0 to 11, 1000 to 1003"));
    assert!(refused("DB3900.DBD9").contains("found byte 12"));
    assert!(refused("DB2700.DBB4").contains("0 to 3"));
}
