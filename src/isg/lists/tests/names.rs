//! Names of axes: default names, and names in channels.

use super::{CHANNEL, Started, axis, codes, read, start};

fn named(number: u16, name: &str) -> String {
    format!("kopf.achs_nr {number}\nkopf.log_achs_name {name}\nkenngr.achs_mode 1\n")
}

fn one(name: &str) -> Started {
    start(&[("a.lis", &named(1, name))])
}

/// HG-17: correct default names, among them those of the manual.
#[test]
fn correct_names_give_no_message() {
    for name in ["Axis_X1", "X_Achse", "X", "Q9", "ABCDEFGHIJKLMNOP", "Zä"] {
        let started = one(name);
        assert_eq!(codes(&started.messages), [""; 0], "{name}");
        assert_eq!((axis(&started, 1).name.as_str(), axis(&started, 1).has_own_name), (name, true));
    }
    let unnamed =
        start(&[("a.lis", "kopf.achs_nr 1\nkenngr.achs_mode 1\n"), ("b.lis", "kopf.achs_nr 2\nkenngr.achs_mode 1\n")]);
    assert_eq!(codes(&unnamed.messages), [""; 0]);
    assert_eq!((axis(&unnamed, 2).name.as_str(), axis(&unnamed, 2).has_own_name), ("X_Achse", false));
}

/// HG-17: at most 16 characters, the first letter one of ten.
#[test]
fn wrong_names_are_out_of_range() {
    for (name, used, has_own_name) in [
        ("ABCDEFGHIJKLMNOPQ", "ABCDEFGHIJKLMNOP", true),
        ("D1", "X_Achse", false),
        ("x1", "X_Achse", false),
        ("1X", "X_Achse", false),
        ("X-1", "X_Achse", false),
        ("\"\"", "X_Achse", false),
    ] {
        let started = one(name);
        assert_eq!(codes(&started.messages), ["P-AXIS-00297 3 1"], "{name}");
        assert!(started.messages[0].text.ends_with("(a.lis:2)"));
        assert_eq!((axis(&started, 1).name.as_str(), axis(&started, 1).has_own_name), (used, has_own_name));
    }
}

/// HG-17: two axes that have only their default name cannot have the same one.
#[test]
fn names_that_clash_are_an_error() {
    let problem = read(&[("a.lis", &named(1, "X1")), ("b.lis", &named(2, "X1"))]).unwrap_err();
    assert!(
        problem.to_string().starts_with("b.lis:2: P-AXIS-00297: expected a name that no other axis has, found `X1`")
    );
    let in_channel = read(&[("a.lis", &named(1, "A1")), ("b.lis", &named(2, "X")), ("c.lis", CHANNEL)]).unwrap_err();
    assert!(in_channel.what.contains("found `X` for axis 2 and axis 1"), "{in_channel}");
    let twice = "gruppe[0].achse[0].bezeichnung X\ngruppe[0].achse[0].log_achs_nr 1\n\
        gruppe[0].achse[1].bezeichnung X\ngruppe[0].achse[1].log_achs_nr 2\n";
    let problem = read(&[("a.lis", &named(1, "A1")), ("b.lis", &named(2, "A2")), ("c.lis", twice)]).unwrap_err();
    assert!(problem.to_string().starts_with("c.lis:3: P-CHAN-00006: "), "{problem}");
}

/// HG-17, HG-25: in the channel P-CHAN-00006 names the axis; equal default names of channel axes are a message.
#[test]
fn the_channel_names_its_axes() {
    let channel = "gruppe[0].achse[0].bezeichnung X\ngruppe[0].achse[0].log_achs_nr 1\n\
        gruppe[0].achse[1].bezeichnung Y\ngruppe[0].achse[1].log_achs_nr 2\n";
    let started = start(&[("a.lis", &named(1, "X1")), ("b.lis", &named(2, "X1")), ("c.lis", channel)]);
    assert_eq!(codes(&started.messages), ["P-AXIS-00297 3 2"]);
    assert_eq!((started.messages[0].other_axis, axis(&started, 2).has_own_name), (Some(1), false));
    let named = |name| started.axis_named(name);
    assert_eq!(
        [named("X"), named("Y"), named("ax2"), named("X1"), named("ax3")],
        [Some(1), Some(2), Some(2), None, None]
    );
}

/// HG-17: a wrong name in a channel is out of range, and the default name acts.
#[test]
fn a_wrong_name_in_a_channel_is_out_of_range() {
    let of = |name: &str| {
        let channel = format!("gruppe[0].achse[0].log_achs_nr 1\n{name}");
        let started = start(&[("a.lis", &named(1, "A_1")), ("c.lis", &channel)]);
        (codes(&started.messages), started.channels[0].axes[0].name.clone())
    };
    let told = || vec!["P-CHAN-00006 3 -".to_owned()];
    assert_eq!(of("gruppe[0].achse[0].bezeichnung D\n"), (told(), "A_1".to_owned()));
    assert_eq!(of(""), (told(), "A_1".to_owned()));
    assert_eq!(of("gruppe[0].achse[0].bezeichnung XXXXXXXXXXXXXXXXX\n"), (told(), "X".repeat(16)));
}

/// HG-25: with P-CHAN-00253, only A1 … A32 are default names.
#[test]
fn aliases_are_the_only_default_names() {
    let of = |flag: u8, name: &str| {
        let channel = format!("{CHANNEL}use_alias_name_in_ax_list {flag}\n");
        let started = start(&[("a.lis", &named(1, name)), ("c.lis", &channel)]);
        (codes(&started.messages), axis(&started, 1).name.clone(), started.channels[0].has_alias_names)
    };
    assert_eq!(of(0, "Axis_X1"), (vec![], "Axis_X1".to_owned(), false));
    assert_eq!(of(1, "A1"), (vec![], "A1".to_owned(), true));
    assert_eq!(of(1, "A32"), (vec![], "A32".to_owned(), true));
    for wrong in ["A33", "A0", "A01", "Axis_X1"] {
        assert_eq!(of(1, wrong), (vec!["P-AXIS-00297 3 1".to_owned()], "A1".to_owned(), true), "{wrong}");
    }
}
