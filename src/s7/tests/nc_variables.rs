//! Variables of the NCK. Requests as collectors of 828D and 840D sl send them: `12 08 82`, area and unit, column, line, module,
//! number of lines. Values are little-endian.

use std::collections::BTreeSet;

use super::{Client, hex};
use crate::s7::Command;
use crate::s7::nck::{CATALOGUE, Datum, MachineData};
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber, Position};
use crate::variables::{AlarmNumber, Parameter, Place, RaisedAlarm};

/// A client of a machine with X at 100 mm, Y at -0.5 mm, and alarms 10653 and 20000.
fn client() -> Client {
    let mut client = Client::ready(960);
    client.memory = crate::image::Memory::new();
    let mut axes = AxisNumber::all();
    let (x, y) = (axes.next().unwrap(), axes.next().unwrap());
    let values = &mut client.variables.axes;
    values[x].position = Position::from_user(100.0);
    values[x].setpoint = Position::from_user(100.25);
    values[x].distance_to_go = Position::from_user(2.54);
    values[y].position = Position::from_user(-0.5);
    values[y].following_error = Position::from_user(0.25);
    let alarm = |number, place| RaisedAlarm { number: AlarmNumber(number), place, parameters: [Parameter::None; 4] };
    let alarms = [alarm(10653, Place::Axis(y)), alarm(20000, Place::Channel(ChannelNumber::FIRST))];
    client.variables.alarms.publish(alarms.into_iter());
    client
}

/// One item without its `12 08`, and its value behind the head of the answer.
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
    // There is no fourth axis, no line 0, and nothing is none.
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
    client.memory.from_nck.nck.set_inch_measuring_system_active(true);
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
        ("82 40 00 02 00 01 74 01", "FF"), // no channel is the first
        ("82 81 00 03 00 01 26 01", "0A"), // tools
        ("82 A1 00 1A 00 01 82 01", "0A"), // drives
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
        let group = &mut client.memory.from_nck.mode_groups[ModeGroupNumber::FIRST];
        let channel = &mut client.memory.from_nck.channels[ChannelNumber::FIRST];
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

/// Pending are 10653 (299D) and 20000 (4E20).
#[test]
fn alarms_are_listed_and_free_places_are_0() {
    let mut client = client();
    assert_eq!(read(&mut client, "82 01 00 07 00 01 7F 01"), "FF 09 00 02 02 00");
    assert_eq!(read(&mut client, "82 01 00 01 00 01 77 03"), "FF 09 00 0C 9D 29 00 00 20 4E 00 00 00 00 00 00");
    assert_eq!(read(&mut client, "82 01 00 02 00 01 77 03"), "FF 09 00 0C 01 00 00 00 02 00 00 00 00 00 00 00");
    assert_eq!(read(&mut client, "82 01 00 01 00 01 75 01"), "FF 09 00 04 20 4E 00 00");
    assert_eq!(read(&mut client, "82 01 00 01 00 41 77 01"), "05 00 00 00"); // place 65
}

#[test]
fn names_are_texts_of_fixed_length_filled_with_zeros() {
    let mut client = client();
    let text = |text: &str, length: usize| {
        let mut bytes = text.as_bytes().to_vec();
        bytes.resize(length, 0);
        format!("FF 09 {} {}", super::word(length), hex(&bytes))
    };
    assert_eq!(read(&mut client, "82 41 4E 70 00 03 1A 01"), text("XF", 32)); // MD20080[2]
    assert_eq!(read(&mut client, "82 41 4E 70 00 04 1A 01"), text("", 32));
    assert_eq!(read(&mut client, "82 01 27 10 00 01 1A 01"), text("X", 32)); // MD10000[0]
    assert_eq!(read(&mut client, "82 41 00 03 00 01 10 01"), "FF 09 00 02 03 00"); // three axes
    assert_eq!(read(&mut client, "82 41 00 03 00 01 7D 01"), text("", 32)); // no program
}

/// MD34090 of axis 2, MD37100 of axis 1, MD30300: axis 2 turns.
struct Data;

impl MachineData for Data {
    fn datum(&self, place: Place, number: u16, index: u16) -> Option<Datum<'_>> {
        let axis = match place {
            Place::Axis(axis) => axis.number(),
            Place::Nck | Place::ModeGroup(_) | Place::Channel(_) => return None,
        };
        match (axis, number, index) {
            (2, 34090, 0) => Some(Datum::Number(-0.941)),
            (1, 37100, 0) => Some(Datum::Byte(11)),
            (_, 30300, 0) => Some(Datum::Boolean(axis == 2)),
            (1, 30240, 0 | 1) => Some(Datum::Byte(1 + u8::try_from(index).unwrap())),
            (1, 34000, 0) => Some(Datum::Whole(-2)),
            _ => None,
        }
    }
}

#[test]
fn machine_data_are_read_by_number_and_index() {
    let mut client = client();
    assert_eq!(read(&mut client, "82 62 85 2A 00 01 1A 01"), "0A 00 00 00");
    client.machine_data = Some(Box::new(Data));
    assert_eq!(read(&mut client, "82 62 85 2A 00 01 1A 01"), double(&[-0.941]));
    assert_eq!(read(&mut client, "82 61 90 EC 00 01 1A 01"), "FF 09 00 01 0B");
    assert_eq!(read(&mut client, "82 61 76 20 00 01 1A 02"), "FF 09 00 02 01 02");
    assert_eq!(read(&mut client, "82 61 84 D0 00 01 1A 01"), "FF 09 00 04 FE FF FF FF");
    assert_eq!(read(&mut client, "82 61 76 20 00 03 1A 01"), "05 00 00 00");
    assert_eq!(read(&mut client, "82 61 85 2A 00 01 1A 01"), "0A 00 00 00");
    assert_eq!(read(&mut client, "82 7F 85 2A 00 01 1A 01"), "0A 00 00 00");
    // Degrees have no inches.
    assert_eq!(read(&mut client, "84 41 00 02 00 02 74 01"), double(&[-0.5]));
}

#[test]
fn machine_data_are_written_and_what_the_control_shows_is_not() {
    let mut client = client();
    client.machine_data = Some(Box::new(Data));
    let mut write = |item: &str, value: &str| client.job(&format!("05 01 12 08 {item}"), value);
    // 0.5 is 3FE0000000000000.
    let answer = write("82 62 85 2A 00 01 1A 01", "00 09 00 08 00 00 00 00 00 00 E0 3F");
    assert_eq!(answer, "00 02 00 01 00 00 05 01 FF");
    for (item, value, code) in [
        ("82 62 85 2A 00 01 1A 01", "00 09 00 04 00 00 00 00", "07"),
        ("82 62 85 2A 00 01 1A 01", "00 09 00 08 00 00 00 00 00 00 F0 7F", "07"), // infinite
        ("82 61 85 2A 00 01 1A 01", "00 09 00 08 00 00 00 00 00 00 E0 3F", "0A"),
        ("82 61 76 20 00 03 1A 01", "00 09 00 01 01", "05"),
        ("82 61 76 20 00 01 1A 02", "00 09 00 02 01 01", "07"), // two lines
        ("82 62 75 FC 00 01 1A 01", "00 09 00 01 02", "0A"),    // MD30204
        ("82 62 76 5C 00 01 1A 01", "00 09 00 01 02", "07"),    // MD30300 is no 2
        ("82 41 00 02 00 01 74 01", "00 09 00 08 00 00 00 00 00 00 E0 3F", "03"),
    ] {
        assert_eq!(write(item, value), format!("00 02 00 01 00 00 05 01 {code}"), "{item} {value}");
    }
    let place = Place::Axis(AxisNumber::new(2).unwrap());
    assert_eq!(client.commands, [Command::MachineDatum { place, number: 34090, index: 0, value: 0.5 }]);
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
            _ => "41",
        };
        let column = super::word(variable.column.into());
        let answer = read(&mut client, &format!("82 {area} {column} 00 01 {:02X} 01", variable.module));
        assert!(answer.starts_with("FF 09"), "{}: {answer}", variable.name);
    }
}

/// s7.md 5: an alarm list in cycles.
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
