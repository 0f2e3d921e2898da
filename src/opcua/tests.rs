//! Values, statuses, writes and the tree on a machine, without a network.

use opcua::nodes::Event;
use opcua::types::{
    AttributeId, DateTime, NodeId, NumericRange, QualifiedName, StatusCode, Variant, VariantScalarTypeId,
};

use super::alarms::{AlarmEvent, Alarms};
use super::attributes::{Found, attribute, find};
use super::node_id::Id;
use super::reading::{Reader, Terms, with_reader};
use super::tree::Tree;
use crate::live::{Live, Order, Seen, Speed};
use crate::machine::{Command, Machine};

/// A machine with two axes, without a PLC program, some steps after these writes.
fn on_machine<T>(writes: &[(&str, u64)], work: impl FnOnce(&Reader<'_>) -> T) -> T {
    after(writes, |seen| with_reader(seen, Terms { speed: 1.0, serial_number: "S1" }, work))
}

fn after<T>(writes: &[(&str, u64)], work: impl FnOnce(&Seen) -> T) -> T {
    let machine = Machine::open("g1_example").unwrap();
    let write = |(address, value): &(&str, u64)| {
        let location = machine.memory().locate(&address.parse().unwrap(), machine.names().profile).unwrap();
        Command::Write { location, value: *value }
    };
    let commands = writes.iter().map(write).collect();
    let live = Live::start(machine, Speed::default());
    let handle = live.handle();
    let step = handle.order(Order { commands, ..Order::default() });
    while handle.look(|seen| seen.step()) < step + 3 {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    handle.look(work)
}

fn read(reader: &Reader<'_>, text: &str) -> Result<Variant, StatusCode> {
    reader.read(&Id::parse(text).ok_or(StatusCode::BadNodeIdUnknown)?)
}

#[test]
fn an_unknown_name_differs_from_a_known_one_that_the_machine_does_not_have() {
    on_machine(&[], |reader| {
        for (text, status) in [
            ("/Plc/nonsense", StatusCode::BadNodeIdUnknown),
            ("/Channel/State/nonsense", StatusCode::BadNodeIdUnknown),
            ("/NC/_N_AX_TEA_ACX/$MA_NONSENSE[u1]", StatusCode::BadNodeIdUnknown),
            ("/Plc/DB999.DBB0", StatusCode::BadAttributeIdInvalid),
            ("/Plc/DB31.DBB4000", StatusCode::BadAttributeIdInvalid),
            ("/Plc/MB", StatusCode::BadAttributeIdInvalid),
            ("/Channel/MachineAxis/actToolBasePos[u1,31]", StatusCode::BadAttributeIdInvalid),
            ("/Channel/MachineAxis/actToolBasePos[u1,0]", StatusCode::BadAttributeIdInvalid),
            ("/Channel/State/chanStatus[u9]", StatusCode::BadAttributeIdInvalid),
            ("/Channel/Parameter/R[65535]", StatusCode::BadAttributeIdInvalid),
            ("/Nck/MachineAxis/vaPower[u1,1]", StatusCode::BadAttributeIdInvalid),
            ("/NC/_N_AX_TEA_ACX/$MA_GANTRY_AXIS_TYPE[u31]", StatusCode::BadAttributeIdInvalid),
        ] {
            assert_eq!(read(reader, text), Err(status), "{text}");
        }
    });
}

/// MB20 to MB27 are 02 05 41 42 FF FE 3F C0.
#[test]
fn addresses_have_the_types_of_a_sinumerik() {
    let bytes = [0x02, 0x05, 0x41, 0x42, 0xFF, 0xFE, 0x3F, 0xC0];
    let names: Vec<_> = (20..28).map(|byte| format!("MB{byte}")).collect();
    let writes: Vec<_> = names.iter().map(String::as_str).zip(bytes).collect();
    on_machine(&writes, |reader| {
        for (text, value) in [
            ("/Plc/M21.0", Variant::from(true)),
            ("/Plc/M21.1", Variant::from(false)),
            ("/Plc/MB21", Variant::from(5_u32)),
            ("/Plc/MW20", Variant::from(0x0205_u32)),
            ("/Plc/MD24", Variant::from(0xFFFE_3FC0_u32)),
            ("/Plc/MW24:INT", Variant::from(-2)),
            ("/Plc/MD24:DINT", Variant::from(-114_752)), // FFFE3FC0 is -(0001C040) = -(65,536 + 49,216)
            ("/Plc/MB22:CHAR", Variant::from("A")),
            // The longest text has 2 characters, so the length of 5 is not believed.
            ("/Plc/MB20:STRING", Variant::from("AB")),
            ("/Plc/MB21:[2]", Variant::from(vec![5_u32, 0x41])),
            ("/Plc/MW24:INT[1]", Variant::from(vec![-2])),
            ("/OpenNCK/Speed", Variant::from(1.0)),
            ("/NC/_N_NC_TEA_ACX/$MN_HW_SERIAL_NUMBER", Variant::from("S1")),
        ] {
            assert_eq!(read(reader, text), Ok(value), "{text}");
        }
    });
    on_machine(&[("MW26", 0x3FC0)], |reader| {
        // 3FC00000 is 1.5.
        assert_eq!(read(reader, "/Plc/MD26:REAL"), Ok(Variant::from(1.5)));
    });
}

#[test]
fn a_write_becomes_commands_of_one_order() {
    on_machine(&[("MB40", 10)], |reader| {
        let write = |text: &str, value: Variant| reader.write(&Id::parse(text).unwrap(), &value);
        let values = |text: &str, value: Variant| -> Vec<u64> {
            let commands = write(text, value).unwrap();
            let value = |command: &Command| match command {
                Command::Write { value, .. } => *value,
                other => panic!("{other:?}"),
            };
            commands.iter().map(value).collect()
        };
        assert_eq!(values("/Plc/M20.3", Variant::from(true)), [1]);
        assert_eq!(values("/Plc/MW20:INT", Variant::from(-2_i64)), [0xFFFE]);
        assert_eq!(values("/Plc/MB30:[3]", Variant::from(vec![1_u32, 2, 3])), [1, 2, 3]);
        // The second length and the characters; the first length stays.
        assert_eq!(values("/Plc/MB40:STRING", Variant::from("Hi")), [2, 0x48, 0x69]);
        let commands = write("/Channel/Parameter/R[u1,5]", Variant::from(7)).unwrap();
        let [Command::RParameter { number: 5, value, .. }] = commands[..] else { panic!("{commands:?}") };
        assert!((value - 7.0).abs() < f64::EPSILON);
        for (text, value, status) in [
            ("/Plc/MB40:STRING", Variant::from("longer than ten"), StatusCode::BadOutOfRange),
            ("/Plc/MB30:[3]", Variant::from(vec![1_u32, 2]), StatusCode::BadOutOfRange),
            ("/Plc/MB30:[3]", Variant::from(1_u32), StatusCode::BadTypeMismatch),
            ("/Plc/MB30", Variant::from(vec![1_u32]), StatusCode::BadTypeMismatch),
            ("/Plc/T5", Variant::from(1_u32), StatusCode::BadNotWritable),
            ("/Plc/DB999.DBB0", Variant::from(1_u32), StatusCode::BadAttributeIdInvalid),
            ("/Channel/State/chanStatus", Variant::from(1_u32), StatusCode::BadNotWritable),
            ("/OpenNCK/Cycle", Variant::from(1_u32), StatusCode::BadNotWritable),
            ("/NC/_N_CH_TEA_ACX/$MC_CHAN_NAME[u1]", Variant::from("A"), StatusCode::BadNotWritable),
        ] {
            assert_eq!(write(text, value.clone()), Err(status), "{text} {value:?}");
        }
    });
}

#[test]
fn all_nodes_of_the_tree_can_be_read() {
    on_machine(&[], |reader| {
        let tree = Tree::of(reader);
        let top: Vec<_> = tree
            .find("Sinumerik")
            .unwrap()
            .children
            .iter()
            .map(|child| tree.node(*child).display_name.as_str())
            .collect();
        assert_eq!(top, ["Plc", "Channel", "Nck", "Bag", "TEA", "OpenNCK"]);
        let mut values = 0;
        for node in tree.nodes() {
            assert!(!node.browse_name.contains('/'), "{}", node.id);
            let Some(found) = find(&tree, &node.id) else { panic!("{} is no id", node.id) };
            let attribute = |id| attribute(&found, &node.id, id, reader, true);
            assert!(attribute(AttributeId::DisplayName).status().is_good(), "{}", node.id);
            if let Found::Value(id, _) = &found {
                let is_pattern = matches!(id, Id::Pattern(..));
                let status = attribute(AttributeId::Value).status();
                let is_unsupported = status == StatusCode::BadNotSupported && matches!(id, Id::Cnc(_));
                assert_eq!(status.is_good(), !is_pattern && !is_unsupported, "{}", node.id);
                values += usize::from(!is_pattern);
            }
        }
        assert!(values > 500, "{values}");
        let signal = tree.find("/Plc/DB31.DBX60.4").unwrap();
        assert!(signal.description.contains("referenced_synchronized_1"), "{}", signal.description);
        assert!(tree.find("/Channel/MachineAxis/actToolBasePos[u1,2]").is_some());
        // X, Y and XF.
        assert!(tree.find("/Channel/MachineAxis/actToolBasePos[u1,3]").is_some());
        assert!(tree.find("/Channel/MachineAxis/actToolBasePos[u1,4]").is_none());
    });
}

#[test]
fn an_array_says_how_many_elements_it_has() {
    on_machine(&[], |reader| {
        let tree = Tree::of(reader);
        let of = |text: &str, id| attribute(&find(&tree, text).unwrap(), text, id, reader, false).value;
        assert_eq!(of("/Plc/MB0:[10]", AttributeId::ValueRank), Some(Variant::from(1)));
        assert_eq!(of("/Plc/MB0:[10]", AttributeId::ArrayDimensions), Some(Variant::from(vec![10_u32])));
        assert_eq!(of("/Plc/MB0", AttributeId::ValueRank), Some(Variant::from(-1)));
        let value = of("/Channel/MachineAxis/actToolBasePos[u1,1,#2]", AttributeId::Value).unwrap();
        assert_eq!(
            (value.scalar_type_id(), value.as_array().map(Vec::len)),
            (Some(VariantScalarTypeId::Double), Some(2))
        );
        // 1 is readable, 2 writable; this client may not write.
        assert_eq!(of("/Plc/MB0", AttributeId::AccessLevel), Some(Variant::from(3_u8)));
        assert_eq!(of("/Plc/MB0", AttributeId::UserAccessLevel), Some(Variant::from(1_u8)));
    });
}

fn field(event: &AlarmEvent, path: &[&str]) -> Variant {
    let path: Vec<_> = path.iter().map(|name| QualifiedName::new(0, *name)).collect();
    let attribute = if path.is_empty() { AttributeId::NodeId } else { AttributeId::Value };
    event.get_field(&NodeId::null(), attribute, &NumericRange::None, &path)
}

/// There is no seventh parameter set (25200). Both axes ask for it in the same cycle.
#[test]
fn an_alarm_is_an_event_with_its_cause() {
    let mut alarms = Alarms::default();
    let raised = after(&[("DB31.DBB9", 6), ("DB32.DBB9", 6)], |seen| alarms.changes(seen, DateTime::now()));
    let is_it = |event: &&AlarmEvent| field(event, &["AlarmIdentifier"]) == Variant::from("25200");
    assert_eq!(raised.iter().filter(is_it).count(), 2, "{raised:?}");
    let event = raised.iter().find(is_it).unwrap();
    for (path, value) in [
        (&["Retain"][..], Variant::from(true)),
        (&["ActiveState", "Id"], Variant::from(true)),
        (&["SourceName"], Variant::from("NCK")),
        (&["ConditionName"], Variant::from("SystemCondition")),
        (&["EventType"], NodeId::new(3, 1006_u32).into()),
        (&["Quality"], StatusCode::Good.into()),
        (&["BranchId"], NodeId::null().into()),
        (&["NoSuchField"], Variant::Empty),
    ] {
        assert_eq!(field(event, path), value, "{path:?}");
    }
    let Variant::LocalizedText(cause) = field(event, &["HelpSource"]) else { panic!("{event:?}") };
    assert!(cause.text.as_ref().contains("X.controller_parameter_set = 6"), "{cause:?}");
    // A machine without them: both are gone.
    let none = after(&[], |seen| alarms.changes(seen, DateTime::now()));
    let gone = none.iter().filter(|event| field(event, &["Retain"]) == Variant::from(false));
    assert_eq!(gone.filter(is_it).count(), 2);
}

/// After power on nothing is referenced, and no measuring system is active: the axes are parked (2), and JOG is manual (0).
#[test]
fn the_objects_of_opc_40502_show_the_same_values() {
    on_machine(&[], |reader| {
        for (text, value) in [
            ("CncInterface/CncAxisList/X/ActStatus", Ok(Variant::from(2))),
            ("CncInterface/CncAxisList/X/IsReferenced", Ok(Variant::from(false))),
            ("CncInterface/CncAxisList/X/IsRotational", Ok(Variant::from(false))),
            ("CncInterface/CncAxisList/X/ActLoad", Err(StatusCode::BadNotSupported)),
            ("CncInterface/CncAxisList/Q/ActStatus", Err(StatusCode::BadAttributeIdInvalid)),
            // Reset, and its program is aborted (5 of the NCK): 2 reset and 4 canceled.
            ("CncInterface/CncChannelList/CHAN1/ActStatus", Ok(Variant::from(2))),
            ("CncInterface/CncChannelList/CHAN1/ActProgramStatus", Ok(Variant::from(4))),
            ("CncInterface/CncChannelList/CHAN1/ActOperationMode", Ok(Variant::from(0))),
            ("CncInterface/VendorName", Ok(Variant::from("OpenNCK"))),
        ] {
            assert_eq!(read(reader, text), value, "{text}");
        }
        let Ok(position) = read(reader, "/Channel/MachineAxis/measPos1[u1,1]") else { panic!("it has a position") };
        assert_eq!(read(reader, "CncInterface/CncAxisList/X/PosIndirect/ActPos"), Ok(position));
    });
}
