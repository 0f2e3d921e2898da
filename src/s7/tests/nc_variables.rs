//! Variables of the NCK. The requests are those of data collectors of 828D and 840D sl: `12 08 82`, area and unit, column, line, module,
//! number of lines. Values are little-endian.

use std::collections::BTreeSet;

use super::{Client, hex};
use crate::image::{FromNck, Memory};
use crate::s7::Command;
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber, Position, Time};
use crate::variables::nc::{CATALOGUE, ControlValues, Datum, MachineData, Refused};
use crate::variables::{AlarmNumber, Parameter, Place, RaisedAlarm, ShownProgram};

/// A client of a machine with X at 100 mm, Y at -0.5 mm, and three alarms: first 20000 at 1 s, then 10652 and 10653 at 3 s.
fn client() -> Client {
    let mut client = Client::at_the_nck(960);
    client.memory = Memory::new();
    let mut axes = AxisNumber::all();
    let (x, y) = (axes.next().unwrap(), axes.next().unwrap());
    let values = &mut client.variables.axes;
    values[x].position = Position::from_user(100.0);
    values[x].setpoint = Position::from_user(100.25);
    values[x].distance_to_go = Position::from_user(2.54);
    values[y].position = Position::from_user(-0.5);
    values[y].following_error = Position::from_user(0.25);
    values[y].encoders = [Position::from_user(-0.5), Position::from_user(-0.25)];
    values[y].synchronism_difference = Position::from_user(0.125);
    values[y].velocity = -300.0;
    let first = ChannelNumber::FIRST;
    let alarm = |number, place, third| {
        let parameters = [Parameter::Channel(first), Parameter::Axis(y), third, Parameter::None];
        RaisedAlarm { number: AlarmNumber(number), place, parameters }
    };
    let cam = alarm(20000, Place::Channel(first), Parameter::Direction(-1));
    let [warning, trip] = [10652, 10653].map(|number| alarm(number, Place::Axis(y), Parameter::Number(-7)));
    let alarms = &mut client.variables.alarms;
    alarms.publish([cam].into_iter());
    alarms.date(Time::from_millis(1000));
    alarms.publish([warning, trip, cam].into_iter());
    alarms.date(Time::from_millis(3000));
    client.control = Some(Box::new(Knows { rotary: None, program: ShownProgram::default() }));
    client
}

/// At 4 s: overrides, R parameters, motors; 10652 is cancelled automatically, the others by RESET.
struct Knows {
    rotary: Option<AxisNumber>,
    program: ShownProgram<'static>,
}

impl ControlValues for Knows {
    fn time(&self) -> Time {
        Time::from_millis(4000)
    }

    fn axis_override(&self, axis: AxisNumber) -> f64 {
        f64::from(axis.number()) * 10.0
    }

    fn spindle_override(&self, axis: AxisNumber) -> f64 {
        if axis.number() == 3 { 80.0 } else { 100.0 }
    }

    fn channel_overrides(&self, _: ChannelNumber) -> [f64; 2] {
        [75.0, 50.0]
    }

    fn motor_speed(&self, _: AxisNumber) -> f64 {
        -30.0
    }

    fn is_rotary(&self, axis: AxisNumber) -> bool {
        self.rotary == Some(axis)
    }

    fn shown_program(&self, channel: ChannelNumber) -> ShownProgram<'_> {
        if channel == ChannelNumber::FIRST { self.program } else { ShownProgram::default() }
    }

    /// G54 has 12.5 in the second axis.
    fn zero_offset(&self, _: ChannelNumber, frame: u8, axis: AxisNumber) -> f64 {
        if (frame, axis.number()) == (1, 2) { 12.5 } else { 0.0 }
    }

    fn r_parameter(&self, channel: ChannelNumber, number: u16) -> Option<f64> {
        (channel == ChannelNumber::FIRST && number < 100).then_some(f64::from(number) + 0.5)
    }

    fn clear_info(&self, alarm: AlarmNumber) -> u8 {
        if alarm.0 == 10652 { 4 } else { 2 }
    }
}

/// One item without its `12 08`, and its value after the header of the answer.
fn read(client: &mut Client, item: &str) -> String {
    let answer = client.job(&format!("04 01 12 08 {item}"), "");
    let (head, value) = answer.split_at(24);
    assert!(head.ends_with("04 01 "), "{answer}");
    value.to_owned()
}

fn double(values: &[f64]) -> String {
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    format!("FF 09 {} {}", super::word(bytes.len()), hex(&bytes))
}

#[test]
fn a_position_is_a_little_endian_double_in_a_string_of_octets() {
    let mut client = client();
    // C1, actToolBasePos, axis 1, machine axes: 100.0 is 4059000000000000.
    assert_eq!(read(&mut client, "82 41 00 02 00 01 74 01"), "FF 09 00 08 00 00 00 00 00 00 59 40");
    assert_eq!(read(&mut client, "82 41 00 01 00 01 74 01"), double(&[100.25]));
    assert_eq!(read(&mut client, "82 41 00 02 00 02 74 01"), double(&[-0.5]));
    assert_eq!(read(&mut client, "82 41 00 02 00 01 73 01"), double(&[100.0]));
    assert_eq!(read(&mut client, "82 41 00 19 00 01 70 01"), double(&[100.0]));
    assert_eq!(read(&mut client, "82 41 00 03 00 01 74 01"), double(&[2.54]));
    assert_eq!(read(&mut client, "82 41 00 0A 00 02 71 01"), double(&[0.25]));
}

#[test]
fn several_lines_follow_one_another() {
    let mut client = client();
    assert_eq!(read(&mut client, "82 41 00 02 00 01 74 03"), double(&[100.0, -0.5, 0.0]));
    assert_eq!(read(&mut client, "82 41 00 02 00 02 74 01"), double(&[-0.5]));
    // There is no fourth axis and no line 0, and a count of 0 is invalid.
    for item in
        ["82 41 00 02 00 01 74 04", "82 41 00 02 00 00 74 01", "82 41 00 02 00 01 74 00", "82 41 00 02 FF FF 74 FF"]
    {
        assert_eq!(read(&mut client, item), "05 00 00 00", "{item}");
    }
}

#[test]
fn inches_are_those_of_the_item_or_of_the_control() {
    let mut client = client();
    assert_eq!(read(&mut client, "84 41 00 03 00 01 74 01"), double(&[2.54 / 25.4]));
    assert_eq!(read(&mut client, "83 41 00 03 00 01 74 01"), double(&[2.54]));
    client.memory.from_nck_mut().nck.set_inch_measuring_system_active(true);
    assert_eq!(read(&mut client, "82 41 00 03 00 01 74 01"), double(&[2.54 / 25.4]));
    assert_eq!(read(&mut client, "83 41 00 03 00 01 74 01"), double(&[2.54]));
    assert_eq!(read(&mut client, "82 01 00 02 00 01 10 01"), "FF 09 00 02 01 00");
}

#[test]
fn an_unknown_variable_does_not_exist_and_the_other_items_are_served() {
    let mut client = client();
    let good = "12 08 82 41 00 02 00 01 74 01";
    let answer =
        client.job(&format!("04 03 12 08 82 41 7F FF 00 01 74 01 {good} 12 0A 10 02 00 01 00 63 84 00 00 00"), "");
    assert_eq!(answer, "00 02 00 14 00 00 04 03 0A 00 00 00 FF 09 00 08 00 00 00 00 00 00 59 40 0A 00 00 00");
    for (item, code) in [
        ("82 42 00 02 00 01 74 01", "05"), // channel 2 does not exist
        ("82 40 00 02 00 01 74 01", "05"), // units count from 1
        ("82 20 00 03 00 01 7F 01", "05"), // also for mode groups
        ("82 00 00 07 00 01 7F 01", "FF"), // the unit of the NCK is ignored
        ("82 81 00 03 00 01 26 01", "0A"), // tools
    ] {
        assert!(read(&mut client, item).starts_with(code), "{item}");
    }
}

#[test]
fn mode_function_and_states_come_from_the_interface() {
    let mut client = client();
    let mut all = |mode: &str, function: &str, channel: &str, program: &str| {
        assert_eq!(read(&mut client, "82 21 00 03 00 01 7F 01"), format!("FF 09 00 02 {mode} 00"));
        assert_eq!(read(&mut client, "82 41 00 0C 00 01 7F 01"), format!("FF 09 00 02 {function} 00"));
        assert_eq!(read(&mut client, "82 41 00 0B 00 01 7F 01"), format!("FF 09 00 02 {channel} 00"));
        assert_eq!(read(&mut client, "82 41 00 0D 00 01 7F 01"), format!("FF 09 00 02 {program} 00"));
        let FromNck { mode_groups, channels, .. } = client.memory.from_nck_mut();
        let (group, channel) = (&mut mode_groups[ModeGroupNumber::FIRST], &mut channels[ChannelNumber::FIRST]);
        if mode == "00" {
            group.set_active_mode_automatic(true);
            group.set_active_machine_function_ref(true);
            channel.set_channel_state_active(true);
            channel.set_program_state_running(true);
        }
    };
    all("00", "00", "00", "05");
    all("02", "03", "01", "03");
}

/// Pending are 20000 (4E20), then 10652 (299C) and 10653 (299D). `alarmNo` counts alarms since power on.
#[test]
fn alarms_are_listed_in_three_orders_and_free_places_are_0() {
    let mut client = client();
    assert_eq!(read(&mut client, "82 01 00 07 00 01 7F 01"), "FF 09 00 02 03 00");
    let (cam, warning, trip) = ("20 4E 00 00", "9C 29 00 00", "9D 29 00 00");
    for (module, list, ordinals) in [
        ("77", [cam, warning, trip], [1, 2, 3]), // SALA: oldest first
        ("54", [cam, warning, trip], [1, 2, 3]), // SALAC
        ("75", [trip, warning, cam], [3, 2, 1]), // SALAL: newest first
        ("76", [cam, trip, warning], [1, 3, 2]), // SALAP: automatic cancel last
    ] {
        let numbers = format!("FF 09 00 10 {} 00 00 00 00", list.join(" "));
        assert_eq!(read(&mut client, &format!("82 01 00 01 00 01 {module} 04")), numbers, "{module}");
        let [a, b, c] = ordinals;
        let ordinals = format!("FF 09 00 10 0{a} 00 00 00 0{b} 00 00 00 0{c} 00 00 00 00 00 00 00");
        assert_eq!(read(&mut client, &format!("82 01 00 02 00 01 {module} 04")), ordinals, "{module}");
        assert_eq!(read(&mut client, &format!("82 01 00 01 00 41 {module} 01")), "05 00 00 00"); // row 65
    }
}

/// The clock is at 03:04:05.678 and the control at 4 s: 20000 was raised 3 s ago, 10653 1 s ago.
#[test]
fn an_alarm_has_its_time_its_parameters_and_what_cancels_it() {
    let mut client = client();
    let (date, zeros) = ("26 11 22 03 04", "00 00 00 00 00 00 00 00");
    let times = format!("FF 09 00 20 {date} 02 67 81 {date} 04 67 81 {date} 04 67 81 {zeros}");
    assert_eq!(read(&mut client, "82 01 00 04 00 01 77 04"), times);
    assert_eq!(read(&mut client, "82 01 00 03 00 01 77 04"), "FF 09 00 08 02 00 04 00 02 00 00 00");
    for (column, line, text) in [
        ("05", 1, "KCHAN1"),
        ("06", 1, "AY"),
        ("07", 1, "S-"),
        ("07", 2, "S-7"),
        ("08", 1, "S"), // not used
        ("05", 4, ""),
    ] {
        assert_eq!(
            read(&mut client, &format!("82 01 00 {column} 00 0{line} 77 01")),
            fixed(text, 32),
            "{column} {line}"
        );
    }
}

/// 22 November 2026, 03:04:05: 20779 days since 1970 and 11045 s.
#[test]
fn the_time_is_that_of_the_clock_of_the_cpu() {
    let mut client = client();
    assert_eq!(read(&mut client, "82 01 00 01 00 01 7F 01"), "FF 09 00 08 26 11 22 03 04 05 67 81");
    let seconds: u32 = 20_779 * 86_400 + 11_045;
    assert_eq!(read(&mut client, "82 01 01 21 00 01 7F 01"), format!("FF 09 00 04 {}", hex(&seconds.to_le_bytes())));
}

#[test]
fn overrides_are_per_cent() {
    let mut client = client();
    assert_eq!(read(&mut client, "82 41 00 01 00 01 71 03"), double(&[10.0, 20.0, 30.0]));
    assert_eq!(read(&mut client, "82 41 00 03 00 01 7F 01"), double(&[75.0]));
    assert_eq!(read(&mut client, "82 41 00 04 00 01 7F 01"), double(&[50.0]));
}

/// Encoders, synchronism difference, measuring system, parameter set, drive; velocity in mm/min or degrees per minute.
#[test]
fn what_the_service_display_of_an_axis_shows_is_there() {
    let mut client = client();
    let y = AxisNumber::new(2).unwrap();
    let signals = &mut client.memory.from_nck_mut().axes[y];
    signals.set_active_controller_parameter_set(2);
    signals.set_active_drive_data_set(1);
    signals.set_position_measuring_system_2_activated(true);
    signals.set_drive_ready(true);
    for (column, value) in [("03", -300.0), ("05", -0.5), ("06", -0.25), ("09", 0.0), ("0A", 0.25), ("C1", 0.125)] {
        assert_eq!(read(&mut client, &format!("82 41 00 {column} 00 02 71 01")), double(&[value]), "{column}");
        // Area N has the same axes.
        assert_eq!(read(&mut client, &format!("82 01 00 {column} 00 02 71 01")), double(&[value]), "{column}");
    }
    for (column, value) in [("25", 3), ("27", 1), ("2A", 2), ("2E", 2)] {
        let word = format!("FF 09 00 02 0{value} 00");
        assert_eq!(read(&mut client, &format!("82 41 00 {column} 00 02 71 01")), word, "{column}");
    }
    assert_eq!(read(&mut client, "82 41 00 09 00 02 74 01"), fixed("Y", 32));
    client.control = Some(Box::new(Knows { rotary: Some(y), program: ShownProgram::default() })); // -300 rev/min
    assert_eq!(read(&mut client, "82 41 00 03 00 02 71 01"), double(&[-108_000.0]));
}

#[test]
fn there_are_no_spindles_and_no_tools() {
    let mut client = client();
    assert_eq!(read(&mut client, "82 41 00 04 00 01 10 01"), "FF 09 00 02 00 00");
    for column in ["02", "03", "04", "09", "0D"] {
        assert_eq!(read(&mut client, &format!("82 41 00 {column} 00 01 72 01")), "05 00 00 00");
    }
    assert_eq!(read(&mut client, "82 41 00 17 00 01 7F 01"), "FF 09 00 02 00 00"); // T0
    assert_eq!(read(&mut client, "82 41 00 79 00 01 7F 01"), double(&[0.0])); // parts
    assert_eq!(read(&mut client, "82 81 00 03 00 01 26 01"), "0A 00 00 00");
}

/// A subprogram runs that the selected program has called; names are those of files of the NC.
#[test]
fn the_program_that_runs_is_shown() {
    let mut client = client();
    let program = ShownProgram {
        selected: Some("_N_MPF_DIR/PART.MPF"),
        active: Some("_N_SPF_DIR/HOLE.SPF"),
        line: 7,
        block: "N70 G1 X10",
        message: "drilling",
        velocity: 1500.0,
    };
    client.control = Some(Box::new(Knows { rotary: None, program }));
    for (item, text, length) in [
        ("82 41 00 01 00 01 7D 01", "drilling", 128),
        ("82 41 00 03 00 01 7D 01", "_N_HOLE_SPF", 32),
        ("82 41 00 04 00 01 7D 01", "", 66),
        ("82 41 00 04 00 02 7D 01", "N70 G1 X10", 66),
        ("82 41 00 10 00 01 7D 01", "/_N_SPF_DIR/_N_HOLE_SPF", 160),
        ("82 41 00 23 00 01 7D 01", "/_N_MPF_DIR/_N_PART_MPF", 160),
        ("82 41 00 0C 00 01 7A 01", "/_N_MPF_DIR/_N_PART_MPF", 160),
        ("82 41 00 23 00 01 7F 01", "0", 32),
    ] {
        assert_eq!(read(&mut client, item), fixed(text, length), "{item}");
    }
    assert_eq!(read(&mut client, "82 41 00 09 00 01 7D 01"), "FF 09 00 04 07 00 00 00");
    assert_eq!(read(&mut client, "82 41 00 01 00 01 7F 01"), double(&[1500.0]));
    // Three axes: rows 1 to 3 are G500, rows 4 to 6 G54.
    for (row, offset) in [(1, 0.0), (2, 0.0), (4, 0.0), (5, 12.5), (6, 0.0)] {
        assert_eq!(read(&mut client, &format!("82 41 00 01 00 {row:02X} 12 01")), double(&[offset]), "{row}");
    }
    assert_eq!(read(&mut client, "82 41 00 01 00 00 12 01"), "05 00 00 00");
}

/// Axis 3 is spindle 1 (MD35000) and turns counter-clockwise at 500 rev/min.
#[test]
fn a_spindle_has_the_row_of_its_number() {
    let mut client = client();
    client.machine_data = Some(Box::new(Data));
    let axis = AxisNumber::new(3).unwrap();
    client.variables.axes[axis].velocity = -500.0;
    assert_eq!(read(&mut client, "82 41 00 04 00 01 10 01"), "FF 09 00 02 01 00");
    assert_eq!(read(&mut client, "82 41 00 02 00 01 72 01"), double(&[500.0]));
    assert_eq!(read(&mut client, "82 41 00 04 00 01 72 01"), double(&[80.0]));
    assert_eq!(read(&mut client, "82 41 00 09 00 01 72 01"), "FF 09 00 02 01 00");
    assert_eq!(read(&mut client, "82 41 00 02 00 02 72 01"), "05 00 00 00");
}

/// -30 rev/min is C1F00000 as a float, big-endian.
#[test]
fn the_speed_of_a_motor_is_known_and_nothing_else_of_its_drive() {
    let mut client = client();
    assert_eq!(read(&mut client, "82 A1 00 15 00 01 82 01"), "FF 09 00 04 C1 F0 00 00"); // r21 of drive 1
    assert_eq!(read(&mut client, "82 A1 06 AB 00 01 1A 01"), "FF 09 00 04 C1 F0 00 00"); // MD1707
    for item in
        ["82 A1 00 1A 00 01 82 01", "82 A1 00 1E 00 01 82 01", "82 A1 06 A6 00 01 1A 01", "82 C1 00 15 00 01 82 01"]
    {
        assert_eq!(read(&mut client, item), "0A 00 00 00", "{item}");
    }
    for item in ["82 A4 00 15 00 01 82 01", "82 A1 00 15 00 02 82 01", "82 A1 00 15 00 01 82 02"] {
        assert_eq!(read(&mut client, item), "05 00 00 00", "{item}");
    }
}

/// 29 values of four bytes are 14 + 29 · 8 = 246 bytes; 28 are 238.
#[test]
fn an_answer_with_values_of_drives_has_240_bytes_at_most() {
    let mut client = client();
    let items = |count: usize| format!("04 {count:02X} {}", ["12 08 82 A1 00 15 00 01 82 01"; 29][..count].join(" "));
    assert!(client.job(&items(28), "").ends_with("C1 F0 00 00"));
    assert_eq!(client.job(&items(29), ""), "00 00 00 00 85 00");
    let axes = items(29).replace("A1 00 15", "41 00 02").replace("82 01", "74 01");
    assert!(client.job(&axes, "").starts_with("00 02 "));
}

/// Drive object 3 is the drive of axis 1. 08 is REAL.
#[test]
fn a_drive_object_is_read_and_not_written() {
    let mut client = client();
    let mut ask = |item: &str| client.job(&format!("04 01 12 0A A2 {item}"), "")[18..].to_owned();
    assert_eq!(ask("08 00 01 00 03 00 15 00 00"), "04 01 FF 09 00 04 C1 F0 00 00");
    for (item, code) in [
        ("08 00 01 00 03 00 1E 00 00", "0A"), // r30
        ("08 00 01 00 02 00 15 00 00", "0A"), // the infeed
        ("08 00 01 00 06 00 15 00 00", "0A"), // there is no axis 4
        ("08 00 01 FF FF 00 15 00 00", "0A"),
        ("04 00 01 00 03 00 15 00 00", "07"),
        ("08 00 02 00 03 00 15 00 00", "05"),
        ("08 00 01 00 03 00 15 00 01", "05"),
    ] {
        assert_eq!(ask(item), format!("04 01 {code} 00 00 00"), "{item}");
    }
    let write = client.job("05 01 12 0A A2 08 00 01 00 03 00 15 00 00", "00 09 00 04 00 00 00 00");
    assert_eq!(write, "00 02 00 01 00 00 05 01 03");
}

/// The NCK is at slots 3 and 4. At other slots the whole request is refused with 8104 and without data.
#[test]
fn variables_of_the_nck_are_asked_of_the_nck() {
    let nck = "12 08 82 41 00 02 00 01 74 01";
    let plc = "12 0A 10 02 00 01 03 E8 84 00 00 00";
    let subscribe = format!("00 01 00 01 {nck}");
    for (tsap, is_nck) in [
        ("01 03", true),
        ("03 03", true),
        ("03 04", true),
        ("0D 04", true),
        ("01 24", true),
        ("01 02", false),
        ("02 00", false),
        ("0D 09", false),
    ] {
        let mut client = Client::called(tsap, 480);
        let refused = "00 00 00 00 81 04";
        for job in [format!("04 01 {nck}"), format!("04 02 {plc} {nck}")] {
            assert_eq!(client.job(&job, "") != refused, is_nck, "{tsap} {job}");
        }
        let write = client.job("05 01 12 08 82 41 00 01 00 06 15 01", "00 09 00 08 00 00 00 00 00 00 00 00");
        assert_eq!(write != refused, is_nck, "{tsap}");
        assert_eq!(client.user_data(2, 1, &subscribe).0 != "81 04", is_nck, "{tsap}");
        // Data of the PLC are served at every slot.
        assert!(client.job(&format!("04 01 {plc}"), "").ends_with("FF 04 00 08 A5"), "{tsap}");
    }
}

/// R5 is row 6.
#[test]
fn r_parameters_are_read_and_written() {
    let mut client = client();
    assert_eq!(read(&mut client, "82 41 00 01 00 06 15 01"), double(&[5.5]));
    assert_eq!(read(&mut client, "82 41 00 01 00 01 15 03"), double(&[0.5, 1.5, 2.5]));
    for (item, code) in [
        ("82 41 00 01 00 65 15 01", "05"), // R100
        ("82 41 00 01 00 64 15 02", "05"),
        ("82 42 00 01 00 01 15 01", "05"),
        ("82 41 00 02 00 01 15 01", "0A"),
        ("82 01 00 01 00 01 15 01", "0A"),
    ] {
        assert_eq!(read(&mut client, item), format!("{code} 00 00 00"), "{item}");
    }
    let values = double(&[1.25, -2.0]).replacen("FF", "00", 1);
    assert_eq!(client.job("05 01 12 08 82 41 00 01 00 06 15 02", &values), "00 02 00 01 00 00 05 01 FF");
    let channel = ChannelNumber::FIRST;
    let command = |number, value| Command::RParameter { channel, number, value };
    assert_eq!(client.commands, [command(5, 1.25), command(6, -2.0)]);
    client.commands.clear();
    for (item, value, code) in [
        ("82 41 00 01 00 64 15 02", values.as_str(), "05"), // R99 and R100: neither is written
        ("82 41 00 01 00 06 15 01", "00 09 00 08 00 00 00 00 00 00 F8 7F", "07"), // not a number
        ("82 41 00 01 00 06 15 01", "00 09 00 07 00 00 00 00 00 00 00", "07"),
        ("82 41 00 01 00 06 15 01", "00 09 00 00", "07"),
        ("82 41 00 01 00 06 15 02", "00 09 00 08 00 00 00 00 00 00 00 00", "07"),
    ] {
        assert_eq!(
            client.job(&format!("05 01 12 08 {item}"), value),
            format!("00 02 00 01 00 00 05 01 {code}"),
            "{item}"
        );
    }
    assert!(client.commands.is_empty());
}

fn fixed(text: &str, length: usize) -> String {
    let mut bytes = text.as_bytes().to_vec();
    bytes.resize(length, 0);
    format!("FF 09 {} {}", super::word(length), hex(&bytes))
}

#[test]
fn names_are_texts_of_fixed_length_filled_with_zeros() {
    let mut client = client();
    assert_eq!(read(&mut client, "82 41 4E 70 00 03 1A 01"), fixed("XF", 32)); // MD20080[2]
    assert_eq!(read(&mut client, "82 41 4E 70 00 04 1A 01"), fixed("", 32));
    assert_eq!(read(&mut client, "82 01 27 10 00 01 1A 01"), fixed("X", 32)); // MD10000[0]
    assert_eq!(read(&mut client, "82 41 00 03 00 01 10 01"), "FF 09 00 02 03 00"); // three axes
    assert_eq!(read(&mut client, "82 41 00 03 00 01 7D 01"), fixed("", 32)); // no program
    assert_eq!(read(&mut client, "82 01 46 6E 00 01 1A 01"), fixed("SIMULATED", 32)); // MD18030
    // MD18040, rows 1 to 4.
    let version = concat!("OpenNCK ", env!("CARGO_PKG_VERSION"));
    assert_eq!(read(&mut client, "82 01 46 78 00 01 1A 01"), fixed(version, 20));
    assert_eq!(read(&mut client, "82 01 46 78 00 04 1A 01"), fixed("", 20));
    assert_eq!(read(&mut client, "82 01 46 78 00 05 1A 01"), "05 00 00 00");
}

/// MD34090 of axis 2, MD37100 of axis 1, MD30300: axis 2 is a rotary axis.
struct Data;

impl MachineData for Data {
    fn datum(&self, place: Place, number: u16, index: u16) -> Option<Datum<'_>> {
        let axis = match place {
            // MD10010: channel 2 has no mode group.
            Place::Nck if number == 10010 => return Some(Datum::Whole(i32::from(index == 0))),
            Place::Axis(axis) => axis.number(),
            Place::Nck | Place::ModeGroup(_) | Place::Channel(_) => return None,
        };
        match (axis, number, index) {
            (2, 34090, 0) => Some(Datum::Number(-0.941)),
            (1, 37100, 0) => Some(Datum::Byte(11)),
            (_, 30300, 0) => Some(Datum::Boolean(axis == 2)),
            (1, 30240, 0 | 1) => Some(Datum::Byte(1 + u8::try_from(index).unwrap())),
            (1, 34000, 0) => Some(Datum::Whole(-2)),
            (1, 36310, 0) => Some(Datum::Unsigned(0x8000_0001)),
            (3, 35000, 0) => Some(Datum::Byte(1)),
            _ => None,
        }
    }

    /// MD30240 is 0 to 5, and MD34000 is read-only.
    fn may_store(&self, _: Place, number: u16, _: u16, value: f64) -> Result<(), Refused> {
        match number {
            30240 if value > 5.0 => Err(Refused::OutOfRange),
            34000 => Err(Refused::NotAllowed),
            _ => Ok(()),
        }
    }
}

#[test]
fn machine_data_are_read_by_number_and_index() {
    let mut client = client();
    assert_eq!(read(&mut client, "82 62 85 2A 00 01 1A 01"), "0A 00 00 00");
    client.machine_data = Some(Box::new(Data));
    client.control = Some(Box::new(Knows { rotary: AxisNumber::new(2), program: ShownProgram::default() }));
    assert_eq!(read(&mut client, "82 62 85 2A 00 01 1A 01"), double(&[-0.941]));
    assert_eq!(read(&mut client, "82 61 90 EC 00 01 1A 01"), "FF 09 00 01 0B");
    assert_eq!(read(&mut client, "82 61 76 20 00 01 1A 02"), "FF 09 00 02 01 02");
    assert_eq!(read(&mut client, "82 61 84 D0 00 01 1A 01"), "FF 09 00 04 FE FF FF FF");
    assert_eq!(read(&mut client, "82 61 8D D6 00 01 1A 01"), "FF 09 00 04 01 00 00 80");
    assert_eq!(read(&mut client, "82 61 76 20 00 03 1A 01"), "05 00 00 00");
    assert_eq!(read(&mut client, "82 61 85 2A 00 01 1A 01"), "0A 00 00 00");
    // 05 is out of range. There are no axes 4 and 31, no axis 0 and no channel 2, as in the rows of MachineAxis.
    for unit in ["64", "7F", "60", "42", "40"] {
        assert_eq!(read(&mut client, &format!("82 {unit} 75 FC 00 01 1A 01")), "05 00 00 00", "{unit}");
    }
    assert_eq!(read(&mut client, "82 63 76 5C 00 01 1A 01"), "FF 09 00 01 00"); // MD30300 of the last axis
    // Degrees are not converted to inches.
    assert_eq!(read(&mut client, "84 41 00 02 00 02 74 01"), double(&[-0.5]));
}

#[test]
fn machine_data_are_written_and_what_the_control_shows_is_not() {
    let mut client = client();
    client.machine_data = Some(Box::new(Data));
    client.control = Some(Box::new(Knows { rotary: AxisNumber::new(2), program: ShownProgram::default() }));
    let mut write = |item: &str, value: &str| client.job(&format!("05 01 12 08 {item}"), value);
    // 0.5 is 3FE0000000000000.
    let answer = write("82 62 85 2A 00 01 1A 01", "00 09 00 08 00 00 00 00 00 00 E0 3F");
    assert_eq!(answer, "00 02 00 01 00 00 05 01 FF");
    for (item, value, code) in [
        ("82 62 85 2A 00 01 1A 01", "00 09 00 04 00 00 00 00", "07"),
        ("82 62 85 2A 00 01 1A 01", "00 09 00 08 00 00 00 00 00 00 F0 7F", "07"), // infinite
        ("82 61 85 2A 00 01 1A 01", "00 09 00 08 00 00 00 00 00 00 E0 3F", "0A"),
        ("82 61 76 20 00 03 1A 01", "00 09 00 01 01", "05"),
        ("82 61 76 20 00 01 1A 02", "00 09 00 02 01 06", "05"), // MD30240 is at most 5: neither is written
        ("82 61 76 20 00 01 1A 02", "00 09 00 03 01 02 03", "07"),
        ("82 61 76 20 00 02 1A 02", "00 09 00 02 01 02", "05"),
        ("82 61 84 D0 00 01 1A 01", "00 09 00 04 00 00 00 00", "03"),
        ("82 62 75 FC 00 01 1A 01", "00 09 00 01 02", "0A"), // MD30204
        ("82 64 76 5C 00 01 1A 01", "00 09 00 01 01", "05"), // there is no axis 4
        ("82 40 00 01 00 06 15 01", "00 09 00 08 00 00 00 00 00 00 E0 3F", "05"), // no channel 0
        ("82 62 76 5C 00 01 1A 01", "00 09 00 01 02", "07"), // MD30300 cannot be 2
        ("82 41 00 02 00 01 74 01", "00 09 00 08 00 00 00 00 00 00 E0 3F", "03"),
    ] {
        assert_eq!(write(item, value), format!("00 02 00 01 00 00 05 01 {code}"), "{item} {value}");
    }
    let place = Place::Axis(AxisNumber::new(2).unwrap());
    assert_eq!(client.commands, [Command::MachineDatum { place, number: 34090, index: 0, value: 0.5 }]);
    // Two rows, and two items of which one is refused: the other item is written.
    client.commands.clear();
    let rows = "12 08 82 61 76 20 00 01 1A 02";
    let answer = client.job(&format!("05 02 {rows} 12 08 82 61 76 20 00 01 1A 01"), "00 09 00 02 02 03 00 09 00 01 06");
    assert_eq!(answer, "00 02 00 02 00 00 05 02 FF 05");
    let place = Place::Axis(AxisNumber::new(1).unwrap());
    let command = |index, value| Command::MachineDatum { place, number: 30240, index, value };
    assert_eq!(client.commands, [command(0, 2.0), command(1, 3.0)]);
    client.is_read_only = true;
    let answer = client.job("05 01 12 08 82 62 85 2A 00 01 1A 01", "00 09 00 08 00 00 00 00 00 00 E0 3F");
    assert!(answer.ends_with("05 01 03"));
}

#[test]
fn no_two_variables_of_the_catalogue_have_one_address_or_one_name() {
    let (mut addresses, mut names) = (BTreeSet::new(), BTreeSet::new());
    for variable in CATALOGUE {
        assert!(
            addresses.insert((variable.name.split('/').next(), variable.module, variable.column)),
            "{}",
            variable.name
        );
        assert!(names.insert(variable.name), "{}", variable.name);
    }
}

#[test]
fn every_variable_of_the_catalogue_has_a_first_line() {
    let mut client = client();
    for variable in CATALOGUE {
        let area = match &variable.name[..1] {
            "N" => "01",
            "B" => "21",
            "V" => "A1",
            _ => "41",
        };
        let column = super::word(variable.column.into());
        let answer = read(&mut client, &format!("82 {area} {column} 00 01 {:02X} 01", variable.module));
        let is_there = !variable.name.starts_with("C/Spindle");
        assert_eq!(answer.starts_with("FF 09"), is_there, "{}: {answer}", variable.name);
        assert!(!variable.source.is_empty());
    }
}

/// An alarm list in a cyclic subscription.
#[test]
fn an_nc_variable_comes_in_cycles_too() {
    let mut client = client();
    client.user_data(2, 1, "00 01 00 01 12 08 82 01 00 00 00 01 54 01");
    client.user_data(2, 1, "00 01 00 01 12 08 82 41 00 02 00 01 74 01");
    assert!(client.tick(0).is_empty());
    let pushes = client.tick(100);
    assert!(hex(&pushes[0]).ends_with("00 01 0A 00 00 00"));
    assert!(hex(&pushes[1]).ends_with("00 01 FF 09 00 08 00 00 00 00 00 00 59 40"));
}

/// On change, as alarm displays subscribe: a push when an alarm is raised, none without a change.
#[test]
fn an_alarm_that_comes_is_pushed_to_who_subscribed_to_the_list() {
    let mut client = client();
    let alarms = std::mem::take(&mut client.variables.alarms);
    let (error, first) = client.user_data(2, 5, "00 01 00 00 12 08 82 01 00 01 00 01 54 02");
    assert_eq!((error.as_str(), first.as_str()), ("00 00", "FF 09 00 0E 00 01 FF 09 00 08 00 00 00 00 00 00 00 00"));
    assert!(client.tick(0).is_empty());
    assert!(client.tick(100).is_empty());
    client.variables.alarms = alarms;
    let pushes = client.tick(200);
    assert_eq!(pushes.len(), 1);
    assert!(hex(&pushes[0]).ends_with("00 01 FF 09 00 08 20 4E 00 00 9C 29 00 00"));
    assert!(client.tick(300).is_empty());
}
