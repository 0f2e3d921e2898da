//! Tests of every signal at its byte and bit.

use std::collections::BTreeSet;
use std::fmt::Debug;

use zerocopy::{FromBytes, Immutable, IntoBytes};

use crate::image::table::Accessors;
use crate::image::{
    Axis828d, AxisFromNck, AxisToNck, Block, ChannelAuxiliary, ChannelAuxiliary828d, ChannelFromNck, ChannelHmi,
    ChannelJumpToNck, ChannelProgramToNck, ChannelSearchFromNck, ChannelToNck, FromNck, Kind, Memory, ModeGroupFromNck,
    ModeGroupHmi, ModeGroupToNck, NckFromNck, NckHmi, NckToNck, SINUMERIK, Signal, ToNck, Writer, axis_from_nck,
    axis_to_nck,
};

use super::{PARTS, all_names, data_block, full_of, location, names, signals};

/// The bits of a run, so that a stray write is visible.
fn bits(bytes: &[u8]) -> Vec<bool> {
    bytes.iter().flat_map(|byte| (0..8).map(move |bit| byte >> bit & 1 == 1)).collect()
}

/// The position in its run of the bit with weight 2^`index` of a signal.
fn position(signal: &Signal, first: u16, index: u8) -> usize {
    let bytes = u16::from(signal.kind.width().div_ceil(8));
    let byte = signal.byte - first + (bytes - 1) - u16::from(index / 8);
    usize::from(byte) * 8 + usize::from(signal.bit + index % 8)
}

fn every_accessor_moves_only_its_own_bits<T>(catalogue: &[Signal], first: u16)
where
    T: Accessors + FromBytes + IntoBytes + Immutable + Copy + PartialEq + Debug,
{
    let accessors = T::accessors();
    assert_eq!(accessors.len(), catalogue.len());
    for ((name, get, set), signal) in accessors.into_iter().zip(catalogue) {
        assert_eq!(name, signal.name);
        let most = (1_u64 << signal.kind.width()) - 1;
        for background in [0x00, 0xFF, 0xA5, 0x5A] {
            for value in [0, 1, most, most & 0xA5A5_A5A5, most & 0x5A5A_5A5A] {
                let before = T::read_from_bytes(&vec![background; size_of::<T>()]).unwrap();
                let mut after = before;
                set(&mut after, value);
                let mut expected = bits(before.as_bytes());
                for index in 0..signal.kind.width() {
                    expected[position(signal, first, index)] = value >> index & 1 == 1;
                }
                assert_eq!(bits(after.as_bytes()), expected, "{name} = {value:#x} over {background:#x}");
                assert_eq!(get(&after), value, "{name}");
            }
        }
    }
}

/// SIG-11
#[test]
fn every_typed_accessor_reads_and_writes_exactly_the_bits_of_its_row() {
    every_accessor_moves_only_its_own_bits::<NckToNck>(NckToNck::SIGNALS, 56);
    every_accessor_moves_only_its_own_bits::<NckFromNck>(NckFromNck::SIGNALS, 68);
    every_accessor_moves_only_its_own_bits::<NckHmi>(NckHmi::SIGNALS, 97);
    every_accessor_moves_only_its_own_bits::<ModeGroupToNck>(ModeGroupToNck::SIGNALS, 0);
    every_accessor_moves_only_its_own_bits::<ModeGroupHmi>(ModeGroupHmi::SIGNALS, 4);
    every_accessor_moves_only_its_own_bits::<ModeGroupFromNck>(ModeGroupFromNck::SIGNALS, 6);
    every_accessor_moves_only_its_own_bits::<ChannelToNck>(ChannelToNck::SIGNALS, 0);
    every_accessor_moves_only_its_own_bits::<ChannelHmi>(ChannelHmi::SIGNALS, 24);
    every_accessor_moves_only_its_own_bits::<ChannelFromNck>(ChannelFromNck::SIGNALS, 32);
    every_accessor_moves_only_its_own_bits::<ChannelAuxiliary>(ChannelAuxiliary::SIGNALS, 58);
    every_accessor_moves_only_its_own_bits::<ChannelProgramToNck>(ChannelProgramToNck::SIGNALS, 28);
    every_accessor_moves_only_its_own_bits::<ChannelJumpToNck>(ChannelJumpToNck::SIGNALS, 384);
    every_accessor_moves_only_its_own_bits::<ChannelSearchFromNck>(ChannelSearchFromNck::SIGNALS, 318);
    every_accessor_moves_only_its_own_bits::<AxisToNck>(AxisToNck::SIGNALS, 0);
    every_accessor_moves_only_its_own_bits::<AxisFromNck>(AxisFromNck::SIGNALS, 60);
    every_accessor_moves_only_its_own_bits::<ChannelAuxiliary828d>(ChannelAuxiliary828d::SIGNALS, 416);
    every_accessor_moves_only_its_own_bits::<Axis828d>(Axis828d::SIGNALS, 148);
}

#[test]
fn a_value_too_large_for_its_group_is_cut_off() {
    let mut axis = AxisToNck::read_from_bytes(&[0; size_of::<AxisToNck>()]).unwrap();
    axis.set_drive_data_set_selection(0xFF);
    assert_eq!(axis.drive_data_set_selection(), 0x1F);
    assert!(!axis.motor_has_been_selected());
}

/// SIG-11
#[test]
fn no_signal_overlaps_another_in_any_block() {
    for block in [Block::Nck, Block::ModeGroup, Block::Channel, Block::Axis] {
        let of_block: Vec<&Signal> = signals().filter(|signal| signal.block == block).collect();
        for pair in of_block.windows(2) {
            let end = pair[0].byte * 8 + u16::from(pair[0].bit) + u16::from(pair[0].kind.width());
            let next = pair[1].byte * 8 + u16::from(pair[1].bit);
            assert!(end <= next, "{} and {} of {block:?}", pair[0].name, pair[1].name);
        }
    }
}

#[test]
fn names_are_unique_in_their_block_and_every_signal_is_documented() {
    for block in [Block::Nck, Block::ModeGroup, Block::Channel, Block::Axis] {
        let mut seen = BTreeSet::new();
        for signal in signals().filter(|signal| signal.block == block) {
            // The 828D shows some signals with a width of its own.
            let is_own = !super::SL.shows(location(signal, 1));
            assert!(seen.insert((signal.name, is_own)), "{} twice", signal.name);
            assert!(signal.doc.len() > 10 && signal.doc.ends_with('.'), "{}: {}", signal.name, signal.doc);
            assert!(signal.name.bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'_'));
        }
    }
    assert!(signals().count() > 350);
}

/// SIG-11
#[test]
fn writing_a_signal_of_any_block_changes_no_other_bit_of_the_whole_memory() {
    let empty = full_of(0xA5);
    for signal in signals() {
        for number in 1..=SINUMERIK.count(signal.block) {
            let location = location(signal, number);
            let old = empty.read(location);
            let new = !old & location.mask();
            let mut memory = empty.clone();
            memory.write(location, new);
            assert_eq!(memory.read(location), new, "{} {number}", signal.name);
            let mut moved = 0;
            for part in PARTS {
                let pairs = empty.part(part).iter().zip(memory.part(part));
                moved += pairs.map(|(before, after)| (before ^ after).count_ones()).sum::<u32>();
            }
            assert_eq!(moved, u32::from(signal.kind.width()), "{} {number}", signal.name);
            memory.write(location, old);
            assert_eq!(memory, empty, "{} {number}", signal.name);
        }
    }
}

/// SIG-11
#[test]
fn every_signal_of_every_block_is_found_by_its_symbol_and_by_its_address() {
    let (memory, names) = (Memory::new(), all_names());
    for signal in signals() {
        for number in 1..=SINUMERIK.count(signal.block) {
            let location = location(signal, number);
            if !super::SL.shows(location) {
                continue; // Only the 828D has it.
            }
            let symbol = names.symbol(location).unwrap();
            assert_eq!(names.resolve(&memory, &symbol).unwrap(), location, "{symbol}");
            let address = names.address(location).to_string();
            assert_eq!(names.resolve(&memory, &address).unwrap(), location, "{symbol} {address}");
            assert_eq!(names.writer(location), Some(signal.writer), "{symbol}");
            let data_block = match signal.block {
                Block::Nck => 10,
                Block::ModeGroup => 11,
                Block::Channel => 20 + u16::from(number),
                Block::Axis => 30 + u16::from(number),
            };
            assert!(address.starts_with(&format!("DB{data_block}.")), "{symbol} {address}");
        }
    }
}

#[test]
fn every_byte_of_the_parts_knows_its_data_block() {
    let memory = Memory::new();
    for part in PARTS {
        for offset in 0..memory.part(part).len() {
            let offset = u32::try_from(offset).unwrap();
            let Some(byte) = SINUMERIK.signals_at(part, offset) else {
                continue;
            };
            let Some((data_block, byte)) = super::SL.shown(byte.block, byte.number, byte.byte) else {
                continue; // Only the 828D has it.
            };
            let address = format!("DB{data_block}.DBB{byte}").parse().unwrap();
            let location = memory.locate(&address, super::SL).unwrap();
            assert_eq!((location.part, location.offset), (part, offset), "{address}");
        }
    }
    let referenced = names().resolve(&memory, "XF.referenced_synchronized_1").unwrap();
    let referenced = SINUMERIK.signals_at(referenced.part, referenced.offset);
    let names: Vec<_> = referenced.unwrap().signals.iter().map(|signal| signal.name).collect();
    assert_eq!(names[4..6], ["referenced_synchronized_1", "referenced_synchronized_2"]);
}

/// Symbol, data block, byte, bit and writer, copied from the manuals by hand.
#[rustfmt::skip]
const MANUAL: &[(&str, u16, usize, u8, Writer)] = &[
    ("nck.emergency_stop", 10, 56, 1, Writer::Plc),
    ("nck.acknowledge_emergency_stop", 10, 56, 2, Writer::Plc),
    ("nck.key_operated_switch_position_0", 10, 56, 4, Writer::Plc),
    ("nck.key_operated_switch_position_3", 10, 56, 7, Writer::Plc),
    ("nck.handwheel_1_machine_axis", 10, 100, 7, Writer::Hmi),
    ("nck.handwheel_3_selected", 10, 102, 6, Writer::Hmi),
    ("nck.remote_diagnosis_active", 10, 103, 0, Writer::Hmi),
    ("nck.nc_cpu_ready", 10, 104, 7, Writer::Nck),
    ("nck.emergency_stop_active", 10, 106, 1, Writer::Nck),
    ("nck.probe_2_actuated", 10, 107, 1, Writer::Nck),
    ("nck.drives_ready", 10, 108, 6, Writer::Nck),
    ("nck.nc_ready", 10, 108, 7, Writer::Nck),
    ("nck.nc_alarm_active", 10, 109, 0, Writer::Nck),
    ("mode_group_1.mode_automatic", 11, 0, 0, Writer::Plc),
    ("mode_group_1.mode_mdi", 11, 0, 1, Writer::Plc),
    ("mode_group_1.mode_jog", 11, 0, 2, Writer::Plc),
    ("mode_group_1.mode_group_reset", 11, 0, 7, Writer::Plc),
    ("mode_group_1.machine_function_ref", 11, 1, 2, Writer::Plc),
    ("mode_group_1.ref_selected", 11, 5, 2, Writer::Hmi),
    ("mode_group_1.active_mode_jog", 11, 6, 2, Writer::Nck),
    ("mode_group_1.mode_group_ready", 11, 6, 3, Writer::Nck),
    ("mode_group_1.active_machine_function_ref", 11, 7, 2, Writer::Nck),
    ("mode_group_2.mode_jog", 11, 20, 2, Writer::Plc),
    ("mode_group_2.ref_selected", 11, 25, 2, Writer::Hmi),
    ("mode_group_2.active_machine_function_ref", 11, 27, 2, Writer::Nck),
    ("CHAN1.activate_referencing", 21, 1, 0, Writer::Plc),
    ("CHAN1.feed_disable", 21, 6, 0, Writer::Plc),
    ("CHAN1.feed_override_active", 21, 6, 7, Writer::Plc),
    ("CHAN1.nc_start", 21, 7, 1, Writer::Plc),
    ("CHAN1.nc_stop", 21, 7, 3, Writer::Plc),
    ("CHAN1.channel_reset", 21, 7, 7, Writer::Plc),
    ("CHAN1.geometry_axis_1_traversing_key_minus", 21, 12, 6, Writer::Plc),
    ("CHAN1.geometry_axis_3_traversing_key_plus", 21, 20, 7, Writer::Plc),
    ("CHAN1.dry_run_feedrate_selected", 21, 24, 6, Writer::Hmi),
    ("CHAN1.feed_override_for_rapid_traverse_selected", 21, 25, 3, Writer::Hmi),
    ("CHAN1.referencing_active", 21, 33, 0, Writer::Nck),
    ("CHAN1.program_state_aborted", 21, 35, 4, Writer::Nck),
    ("CHAN1.channel_state_reset", 21, 35, 7, Writer::Nck),
    ("CHAN1.all_axes_requiring_reference_point_are_referenced", 21, 36, 2, Writer::Nck),
    ("CHAN1.nck_alarm_with_machining_stop_active", 21, 36, 7, Writer::Nck),
    ("CHAN2.referencing_active", 22, 33, 0, Writer::Nck),
    ("CHAN2.geometry_axis_2_traverse_command_plus", 22, 46, 7, Writer::Nck),
    ("X.axis_spindle_disable", 31, 1, 3, Writer::Plc),
    ("X.follow_up_mode", 31, 1, 4, Writer::Plc),
    ("X.position_measuring_system_1", 31, 1, 5, Writer::Plc),
    ("X.position_measuring_system_2", 31, 1, 6, Writer::Plc),
    ("X.override_active", 31, 1, 7, Writer::Plc),
    ("X.controller_enable", 31, 2, 1, Writer::Plc),
    ("X.reference_point_value_1", 31, 2, 4, Writer::Plc),
    ("X.reference_point_value_4", 31, 2, 7, Writer::Plc),
    ("X.feed_stop", 31, 4, 3, Writer::Plc),
    ("X.traversing_key_disable", 31, 4, 4, Writer::Plc),
    ("X.traversing_key_minus", 31, 4, 6, Writer::Plc),
    ("X.traversing_key_plus", 31, 4, 7, Writer::Plc),
    ("X.machine_function_continuous", 31, 5, 6, Writer::Plc),
    ("X.hardware_limit_switch_minus", 31, 12, 0, Writer::Plc),
    ("X.hardware_limit_switch_plus", 31, 12, 1, Writer::Plc),
    ("X.second_software_limit_switch_minus", 31, 12, 2, Writer::Plc),
    ("X.deceleration_reference_point_approach", 31, 12, 7, Writer::Plc),
    ("X.pulse_enable", 31, 21, 7, Writer::Plc),
    ("X.start_gantry_synchronization", 31, 29, 4, Writer::Plc),
    ("X.no_automatic_synchronization", 31, 29, 5, Writer::Plc),
    ("XF.referenced_synchronized_1", 33, 60, 4, Writer::Nck),
    ("XF.referenced_synchronized_2", 33, 60, 5, Writer::Nck),
    ("XF.position_reached_exact_stop_coarse", 33, 60, 6, Writer::Nck),
    ("XF.position_reached_exact_stop_fine", 33, 60, 7, Writer::Nck),
    ("XF.follow_up_active", 33, 61, 3, Writer::Nck),
    ("XF.axis_stationary", 33, 61, 4, Writer::Nck),
    ("XF.position_controller_active", 33, 61, 5, Writer::Nck),
    ("XF.speed_controller_active", 33, 61, 6, Writer::Nck),
    ("XF.current_controller_active", 33, 61, 7, Writer::Nck),
    ("XF.traverse_request_minus", 33, 64, 4, Writer::Nck),
    ("XF.traverse_request_plus", 33, 64, 5, Writer::Nck),
    ("XF.traverse_command_minus", 33, 64, 6, Writer::Nck),
    ("XF.traverse_command_plus", 33, 64, 7, Writer::Nck),
    ("XF.position_restored_2", 33, 71, 5, Writer::Nck),
    ("XF.spindle_in_setpoint_range", 33, 83, 5, Writer::Nck),
    ("XF.drive_ready", 33, 93, 5, Writer::Nck),
    ("XF.pulses_enabled", 33, 93, 7, Writer::Nck),
    ("XF.gantry_trip_limit_exceeded", 33, 101, 2, Writer::Nck),
    ("XF.gantry_warning_limit_exceeded", 33, 101, 3, Writer::Nck),
    ("X.gantry_synchronization_ready_to_start", 31, 101, 4, Writer::Nck),
    ("X.gantry_grouping_is_synchronized", 31, 101, 5, Writer::Nck),
    ("X.gantry_leading_axis", 31, 101, 6, Writer::Nck),
    ("X.gantry_axis", 31, 101, 7, Writer::Nck),
    ("X.position_measuring_system_1_activated", 31, 102, 5, Writer::Nck),
    ("X.position_measuring_system_2_activated", 31, 102, 6, Writer::Nck),
];

/// SIG-11
#[test]
fn signals_have_the_position_and_the_writer_of_the_manuals() {
    let names = names();
    for &(symbol, db, byte, bit, writer) in MANUAL {
        let mut memory = Memory::new();
        let location = names.resolve(&memory, symbol).unwrap();
        memory.write(location, 1);
        let length = match db {
            10 => 272,
            11 => 64,
            21..=30 => 416,
            _ => 148,
        };
        let mut expected = vec![0; length];
        expected[byte] = 1 << bit;
        assert_eq!(data_block(&memory, db, length), expected, "{symbol}");
        assert_eq!(names.writer(location), Some(writer), "{symbol}");
    }
}

/// SIG-11
#[test]
fn numbers_have_the_position_of_the_manuals_and_are_big_endian() {
    let mut axis = AxisFromNck::read_from_bytes(&[0xA5; 48]).unwrap();
    axis.set_positioning_axis_f_function(1.5);
    axis.set_spindle_m_function(0x1234);
    axis.set_spindle_s_function(-2.0);
    axis.set_axis_replacement_channel(8);
    axis.set_axis_replacement_requested(false);
    axis.set_axis_replacement_possible(true);
    axis.set_neutral_axis(true);
    axis.set_plc_axis(false);
    let bytes = axis.as_bytes();
    assert_eq!(bytes[78 - 60..82 - 60], [0x3F, 0xC0, 0, 0]);
    assert_eq!(bytes[86 - 60..92 - 60], [0x12, 0x34, 0xC0, 0, 0, 0]);
    assert_eq!(bytes[68 - 60], 0x68);
    let untouched = bytes
        .iter()
        .enumerate()
        .filter(|(index, _)| ![68, 78, 79, 80, 81, 86, 87, 88, 89, 90, 91].contains(&(index + 60)));
    assert!(untouched.map(|(_, byte)| byte).all(|byte| *byte == 0xA5));
    // Besides the two of an axis, and position and feed of FC 18: S 1 to 3, DL, H 1 to 3, F 1 to 6 of a channel.
    let reals = signals().filter(|signal| signal.kind == Kind::Real && super::SL.shows(location(signal, 1)));
    assert_eq!(reals.count(), 2 + 2 + 3 + 1 + 3 + 6);
}

#[test]
fn a_program_writes_its_own_side_from_the_signals_of_the_other_side() {
    let mut memory = Memory::new();
    let x = crate::units::AxisNumber::FIRST;
    memory.from_nck_mut().axes[x].set_gantry_synchronization_ready_to_start(true);
    let Memory { to_nck, from_nck, .. } = &mut memory;
    let (to_nck, from_nck) = (ToNck::of_mut(to_nck), FromNck::of(from_nck));
    to_nck.axis(x).set_start_gantry_synchronization(from_nck.axis(x).gantry_synchronization_ready_to_start());
    assert_eq!(data_block(&memory, 31, 148)[29], 0b0001_0000);
}

/// A constant is the row of the table, and can be used in constants.
#[test]
fn a_row_is_a_constant_by_the_name_of_its_getter() {
    const ENABLE: Signal = axis_to_nck::controller_enable;
    const READY: (u16, u8) = (axis_from_nck::gantry_synchronization_ready_to_start.byte, 4);
    assert_eq!((ENABLE.name, ENABLE.block, ENABLE.writer), ("controller_enable", Block::Axis, Writer::Plc));
    assert_eq!((ENABLE.byte, ENABLE.bit, ENABLE.kind.width()), (2, 1, 1));
    assert_eq!(READY, (101, 4));
    assert!(signals().any(|signal| *signal == ENABLE));
}
