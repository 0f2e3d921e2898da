//! Files of any bytes are read or refused, and what is read can start and be examined.

use proptest::prelude::*;

use crate::control::Value;
use crate::isg::lists::{Lists, PARAMETERS, examine};
use crate::source::Place;

fn used(files: &[(&str, Vec<u8>)]) {
    let _ = examine(files);
    if let Ok(mut lists) = Lists::read(files) {
        let started = lists.start();
        for axis in &started.axes {
            assert!(axis.a_max >= 1 && axis.a_emergency >= 1 && axis.vb_max >= 1);
            assert!(axis.name.chars().count() <= 16);
            let limits = axis.limits;
            assert!(
                !axis.is_slave || 0 < limits.first && limits.first < limits.second && limits.correction_velocity > 0
            );
            assert!(lists.gantry_pair(axis.number).is_some());
        }
        assert_eq!(lists.update(), started);
    }
}

/// A line with the name of a parameter, or something similar to it, and a value.
fn line() -> impl Strategy<Value = String> {
    let names = PARAMETERS.iter().map(|parameter| parameter.list_name([0, 1]).unwrap_or_else(|| parameter.id()));
    let name = prop::sample::select(names.collect::<Vec<_>>());
    let number = prop::sample::select(vec![
        "0",
        "1",
        "2",
        "3",
        "4",
        "65535",
        "4294967295",
        "2147483647",
        "-2147483648",
        "0x30005",
        "0x10001",
        "0x20001",
    ]);
    let word = prop::sample::select(vec![
        "X",
        "CONFIG",
        "DEFAULT",
        "X1",
        "D",
        "\"A(\"",
        "",
        "( x",
        "A3",
        "ABCDEFGHIJKLMNOPQRS",
    ]);
    (name, prop_oneof![4 => number, 1 => word]).prop_map(|(name, value)| format!("{name} {value}\n"))
}

fn list(number: u16) -> impl Strategy<Value = Vec<u8>> {
    prop::collection::vec(line(), 0..30).prop_map(move |lines| {
        let lines: String =
            lines.into_iter().filter(|line| !line.contains("achs_nr ") || line.contains("gantry")).collect();
        format!("kopf.achs_nr {number}\nkenngr.achs_typ 1\n{lines}").into_bytes()
    })
}

proptest! {
    /// HG-28
    #[test]
    fn any_bytes_are_read_or_refused(bytes: Vec<u8>, more: Vec<u8>) {
        let with_number = [b"kopf.achs_nr 1\nkenngr.achs_typ 1\n".to_vec(), bytes.clone()].concat();
        used(&[("a.lis", bytes), ("b.lis", more), ("c.lis", with_number)]);
    }

    /// HG-28
    #[test]
    fn any_text_is_read_or_refused(text in "[ -~µ\\n\\[\\]()/*#;=]{0,200}") {
        used(&[("a.lis", format!("kopf.achs_nr 1\nkenngr.achs_typ 1\n{text}").into_bytes())]);
    }

    /// HG-06
    #[test]
    fn any_values_start(one in list(1), other in list(2), channel in prop::collection::vec(line(), 0..20)) {
        used(&[("a.lis", one), ("b.lis", other), ("c.lis", channel.concat().into_bytes())]);
    }

    /// HG-28
    #[test]
    fn any_target_is_changed_or_refused(target: String, number: i64, text: String) {
        let mut lists = Lists::read(&[("a.lis", "kopf.achs_nr 1\nkenngr.achs_typ 1\n")]).unwrap();
        let place = Place::file("s.toml");
        for target in [target.clone(), format!("ax1:{target}"), "ax1:kenngr.achs_mode".to_owned(), "ax1:P-AXIS-00297".to_owned()] {
            let _ = lists.set(&target, &Value::Integer(number), &place);
            let _ = lists.set(&target, &Value::Text(text.clone()), &place);
        }
        let _ = lists.start();
    }
}
