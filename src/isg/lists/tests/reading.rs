//! Files: how they are told apart, what is read, and what is an error with file and line.

use super::{CHANNEL, MASTER, SLAVE, axis, codes, hard, read, start, whole};
use crate::source::Place;

/// HG-01, HG-28: the minimal example of the manual's combination reads without a message.
#[test]
fn the_combination_of_the_manual_starts_without_a_message() {
    let started = hard("", "", "");
    assert_eq!(codes(&started.messages), [""; 0]);
    let masters: Vec<_> =
        started.axes.iter().map(|axis| (axis.number, axis.is_master, axis.is_slave, axis.master)).collect();
    assert_eq!(masters, [(1, true, false, None), (5, false, true, Some(1)), (6, false, true, Some(1))]);
    assert_eq!(started.slaves(1).map(|axis| axis.number).collect::<Vec<_>>(), [5, 6]);
    let limits = axis(&started, 5).limits;
    assert_eq!((limits.first, limits.second, limits.correction_velocity), (1000, 5000, 1000));
    let channel = &started.channels[0];
    assert_eq!((channel.axes[0].index, channel.axes[0].name.as_str(), channel.axes[0].number), (0, "X", 1));
}

/// HG-28, B54: comments, hexadecimal numbers and `=` give the same values as the plain form.
#[test]
fn comments_do_not_change_values() {
    let plain = "kopf.achs_nr 5\nkopf.log_achs_name Axis_X1\nkenngr.achs_typ 1\nkenngr.achs_mode 131073\nkenngr.gantry_ax_nr 1\n\
        kenngr.gantry_max_diff_resetable 1000\nkenngr.gantry_max_diff_reset_locked 5000\nkenngr.gantry_offset -50\n\
        kenngr.gantry_vb_korr 1000\nkenngr.gantry_on_mode CONFIG\n";
    let decorated = "# the list of the slave\r\n; kopf.achs_nr 9\r\n( kopf.achs_nr 9\r\n/* kopf.achs_nr 9\r\nkopf.achs_nr 9\r\n*/\r\n\
        kopf.achs_nr 5 the logical number\r\nkopf.log_achs_name   Axis_X1 ( its name\r\n\r\nkenngr.achs_typ\t1\t# linear\r\n\
        kenngr.achs_mode = 0x00020001 ; linear, slave\r\nkenngr.gantry_ax_nr 1 ( the master\r\n\
        kenngr.gantry_max_diff_resetable 1000 /* 0.1 mm */\r\nkenngr.gantry_max_diff_reset_locked=5000\r\n\
        kenngr.gantry_offset -50\r\nkenngr.gantry_vb_korr 0x3E8\r\nkenngr.gantry_on_mode = CONFIG(until commissioned\r\n";
    let of = |list: &str| {
        let started = start(&[("a.lis", MASTER), ("b.lis", list)]);
        assert_eq!(codes(&started.messages), [""; 0]);
        axis(&started, 5).clone()
    };
    assert_eq!(of(plain), of(decorated));
    assert_eq!(of(plain).offset, -50);
}

/// HG-28: lists in Latin-1, in UTF-8 and with a byte order mark.
#[test]
fn latin_1_and_utf_8_are_read() {
    let latin: &[u8] = b"# Ma\xdfe in \xb5m\nkopf.achs_nr 1\nkenngr.achs_typ 1\n";
    let utf: &[u8] = "\u{feff}kopf.achs_nr 2\nkenngr.achs_typ 1 # µm\n".as_bytes();
    let lists = crate::isg::lists::Lists::read(&[("a.lis", latin), ("b.lis", utf)]).unwrap();
    assert_eq!(lists.axis_numbers().collect::<Vec<_>>(), [1, 2]);
    let wide: Vec<u8> = [0xFF, 0xFE].into_iter().chain("kopf.achs_nr 1\n".bytes().flat_map(|byte| [byte, 0])).collect();
    let problem = crate::isg::lists::Lists::read(&[("a.lis", wide)]).unwrap_err();
    assert!(
        problem.to_string().starts_with("a.lis: expected a parameter list in UTF-8 or Latin-1, found a text in UTF-16")
    );
}

/// HG-28, O-33: an entry under its ID has the same meaning as under its list name.
#[test]
fn an_entry_may_stand_under_its_id() {
    let ids = "P-AXIS-00016 5\nP-AXIS-00015 0x00020001\nP-AXIS-00070 1\nP-AXIS-00072 1000\nP-AXIS-00071 5000\nP-AXIS-00075 1000\n\
        P-AXIS-00261 1\n";
    let started = start(&[("x.lis", MASTER), ("x1.lis", ids)]);
    assert_eq!(codes(&started.messages), [""; 0]);
    let slave = axis(&started, 5);
    assert_eq!((slave.master, slave.limits.first, slave.on_edge), (Some(1), 1000, true));
    assert_eq!(whole(slave, "P-AXIS-00072"), whole(slave, "kenngr.gantry_max_diff_resetable"));
}

/// HG-28: files are told apart by their contents; what is neither an axis list nor a channel list is left alone.
#[test]
fn other_lists_are_left_alone() {
    let lists = read(&[
        ("a.txt", MASTER),
        ("b.lis", CHANNEL),
        ("compensation.lis", "kopf.achs_nr 1\nkomp[0].wert X\nbroken[\nempty\n"),
        ("hochlauf.lis", "zahl_mds 2\nachs_mds[0] a.txt\nempty\n"),
        ("channel_2.lis", "synchro_data.restore_coupling_after_reset 1\n"),
        ("empty.lis", ""),
        ("without_number.lis", "kenngr.achs_typ 1\n"),
    ])
    .unwrap();
    assert_eq!(lists.others(), ["compensation.lis", "empty.lis", "hochlauf.lis", "without_number.lis"]);
    assert_eq!((lists.axis_numbers().collect::<Vec<_>>(), lists.channels()), (vec![1], 2));
}

/// HG-28: channels are numbered by the names of their files, in whatever order the files are given.
#[test]
fn channels_are_numbered_by_file_name() {
    let second = "gruppe[0].achse[0].bezeichnung Z\ngruppe[0].achse[0].log_achs_nr 5\n";
    let other = "kopf.achs_nr 5\nkenngr.achs_typ 1\n";
    let started = start(&[("kanal_b.lis", second), ("x.lis", MASTER), ("z.lis", other), ("kanal_a.lis", CHANNEL)]);
    let names: Vec<_> = started
        .channels
        .iter()
        .map(|channel| (channel.number, channel.file.as_str(), channel.axes[0].name.as_str()))
        .collect();
    assert_eq!(names, [(1, "kanal_a.lis", "X"), (2, "kanal_b.lis", "Z")]);
}

/// HG-28: unknown entries are kept and give no message.
#[test]
fn unknown_entries_are_kept_and_silent() {
    let text = format!(
        "{MASTER}kenngr.swe_pos 550000 ( P-AXIS-00178\nlr_hw[0].x A B\nsynchro_data.restore_coupling_after_reset 1\n"
    );
    let mut lists = read(&[("x.lis", &text)]).unwrap();
    let unknown: Vec<_> = lists.unknown().map(|entry| (entry.name.as_str(), entry.place.line)).collect();
    assert_eq!(unknown, [("kenngr.swe_pos", 5), ("lr_hw[0].x", 6), ("synchro_data.restore_coupling_after_reset", 7)]);
    assert_eq!(codes(&lists.start().messages), [""; 0]);
}

/// HG-28: of two equal entries the last one acts.
#[test]
fn the_last_entry_acts() {
    let started = start(&[("x.lis", &format!("{MASTER}getriebe[0].dynamik.a_max 2000\n"))]);
    assert_eq!((axis(&started, 1).a_max, started.messages.len()), (2000, 0));
}

/// HG-06, HG-28: what cannot be read is an error with file and line.
#[test]
fn what_cannot_be_read_is_an_error_with_file_and_line() {
    let line_5 = |line: &str| {
        let problem = read(&[("x.lis", &format!("{MASTER}{line}\n"))]).unwrap_err();
        assert_eq!(problem.place, Some(Place::file("x.lis").at_line(5)), "{problem}");
        assert!(!problem.cure.is_empty());
        problem.what
    };
    let no_value = "P-AXIS-00070 kenngr.gantry_ax_nr: expected a value (UNS16), found none";
    assert_eq!(line_5("kenngr.gantry_ax_nr"), no_value);
    assert_eq!(line_5("kenngr.gantry_ax_nr = ; 5"), no_value);
    assert_eq!(
        line_5("kenngr.gantry_ax_nr one"),
        "P-AXIS-00070 kenngr.gantry_ax_nr: expected a whole number (UNS16), found `one`"
    );
    assert_eq!(
        line_5("kenngr.gantry_ax_nr 1.5"),
        "P-AXIS-00070 kenngr.gantry_ax_nr: expected a whole number (UNS16), found `1.5`"
    );
    assert!(line_5("kenngr.gantry_max_diff_resetable -1").contains("0 to 4294967295"));
    assert!(line_5("getriebe[x].dynamik.a_max 5").contains("broken index"));
    assert!(line_5("getriebe[0.dynamik.a_max 5").contains("broken index"));
    assert!(line_5("getriebe.dynamik.a_max 5").contains("getriebe[i].dynamik.a_max"));
    assert_eq!(line_5("kenngr.unknown"), "expected a value behind `kenngr.unknown`, found none");
    assert!(line_5("/* never closed").contains("*/"));
}

/// HG-28: two lists of one axis, a channel axis without a list, and no axis list are errors.
#[test]
fn lists_that_contradict_each_other_are_an_error() {
    let told = |files: &[(&str, &str)]| read(files).unwrap_err().to_string();
    let two = told(&[("a.lis", MASTER), ("b.lis", MASTER)]);
    assert!(two.starts_with("b.lis:1: expected one list of axis 1, found another one: a.lis:1\n"), "{two}");
    let missing =
        told(&[("a.lis", MASTER), ("c.lis", "gruppe[0].achse[1].bezeichnung Y\ngruppe[0].achse[1].log_achs_nr 2\n")]);
    assert!(
        missing.starts_with("c.lis:2: P-CHAN-00035: expected an axis that has a list, found axis 2\n"),
        "{missing}"
    );
    let none = "expected the list of at least one axis, found none";
    assert!(told(&[("c.lis", CHANNEL)]).starts_with("c.lis:3: ") || told(&[("c.lis", CHANNEL)]).starts_with(none));
    assert!(told(&[]).starts_with(none));
    assert!(told(&[("a.lis", "zahl_mds 2\n")]).starts_with(none));
}

/// HG-28, 110076: a list with the number 0 is not used, and the control starts.
#[test]
fn a_list_with_the_number_0_is_a_message() {
    let zero = "kopf.achs_nr 0\nkenngr.achs_typ 1\n";
    let started = start(&[("a.lis", MASTER), ("b.lis", zero), ("c.lis", zero)]);
    assert_eq!(codes(&started.messages), ["110076 3 -", "110076 3 -"]);
    assert!(started.messages[0].text.contains("P-AXIS-00016") && started.messages[0].text.ends_with("(b.lis:1)"));
    assert_eq!(started.axes.len(), 1);
    assert!(read(&[("b.lis", zero)]).is_err());
}

/// HG-28: SLAVE alone has no number, so that it is no axis list.
#[test]
fn a_list_without_a_number_is_no_axis_list() {
    assert!(read(&[("b.lis", SLAVE)]).is_err());
    assert_eq!(read(&[("a.lis", MASTER), ("b.lis", SLAVE)]).unwrap().others(), ["b.lis"]);
}
