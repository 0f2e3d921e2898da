//! Channels: their axes, coupling group 0 and settings.

use super::{CHANNEL, MASTER, Started, codes, start};

/// A channel with these lines, and the axes 1, 2, 8 and 9.
fn channel(text: &str) -> Started {
    let axes =
        [1, 2, 8, 9].map(|number| (format!("ax{number}.lis"), format!("kopf.achs_nr {number}\nkenngr.achs_mode 1\n")));
    let mut files: Vec<(&str, &str)> = axes.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    files.push(("channel.lis", text));
    start(&files)
}

fn pair(j: u16, master: u16, slave: u16) -> String {
    let path = format!("synchro_data.koppel_gruppe[0].paar[{j}]");
    format!("{path}.log_achs_nr_master {master}\n{path}.log_achs_nr_slave {slave}\n")
}

fn pairs(started: &Started) -> Vec<(u16, u16, u16)> {
    started.channels[0].group_0.iter().map(|pair| (pair.index, pair.master, pair.slave)).collect()
}

fn named(j: u16, name: &str, number: u16) -> String {
    format!("gruppe[0].achse[{j}].bezeichnung {name}\ngruppe[0].achse[{j}].log_achs_nr {number}\n")
}

/// SG-21: group 0 of the list, without conflicts.
#[test]
fn group_0_comes_from_the_list() {
    let mode = "synchro_data.koppel_gruppe[0].paar[1].mode 1\n";
    let started = channel(&format!("{}{}{mode}", pair(0, 2, 8), pair(1, 2, 9)));
    assert_eq!((codes(&started.messages), pairs(&started)), (vec![], vec![(0, 2, 8), (1, 2, 9)]));
    assert_eq!(started.channels[0].group_0.iter().map(|pair| pair.is_spindles).collect::<Vec<_>>(), [false, true]);
    let bad = channel(&format!("{}synchro_data.koppel_gruppe[0].paar[0].mode 2\n", pair(0, 2, 8)));
    assert_eq!(
        (codes(&bad.messages), bad.channels[0].group_0[0].is_spindles),
        (vec!["P-CHAN-00061 3 -".to_owned()], true)
    );
}

/// SG-21: a slave that is its own master is skipped with 20440, and the other pairs stay.
#[test]
fn a_pair_of_one_axis_is_skipped() {
    let started = channel(&format!("{}{}", pair(0, 8, 8), pair(1, 2, 9)));
    assert_eq!((codes(&started.messages), pairs(&started)), (vec!["20440 1 8".to_owned()], vec![(1, 2, 9)]));
    assert!(started.messages[0].text.ends_with("(channel.lis:2)"));
}

/// SG-21: an axis that is a master and a slave is skipped with 20442, in either order.
#[test]
fn an_axis_in_both_roles_is_skipped() {
    let started = channel(&format!("{}{}", pair(0, 2, 8), pair(1, 8, 9)));
    assert_eq!((codes(&started.messages), pairs(&started)), (vec!["20442 1 8".to_owned()], vec![(0, 2, 8)]));
    let reverse = channel(&format!("{}{}", pair(0, 8, 9), pair(1, 2, 8)));
    assert_eq!((codes(&reverse.messages), pairs(&reverse)), (vec!["20442 1 8".to_owned()], vec![(0, 8, 9)]));
}

/// SG-21: a slave of two masters and a pair with the number 0 are skipped; a pair without numbers is none.
#[test]
fn other_conflicts_are_skipped() {
    let twice = channel(&format!("{}{}", pair(0, 2, 8), pair(1, 1, 8)));
    assert_eq!((codes(&twice.messages), pairs(&twice)), (vec!["20441 1 8".to_owned()], vec![(0, 2, 8)]));
    let zero = channel(&format!("{}{}", pair(0, 0, 8), pair(1, 0, 0)));
    assert_eq!((codes(&zero.messages), pairs(&zero)), (vec!["20438 1 8".to_owned()], vec![]));
}

/// HG-28: channel axes keep their index; gaps are not counted.
#[test]
fn axes_keep_their_index() {
    let started = channel(&format!("gruppe[0].achs_anzahl 2\n{}{}", named(0, "X", 1), named(3, "Y2", 8)));
    let axes: Vec<_> =
        started.channels[0].axes.iter().map(|axis| (axis.index, axis.name.as_str(), axis.number)).collect();
    assert_eq!((codes(&started.messages), axes), (vec![], vec![(0, "X", 1), (3, "Y2", 8)]));
}

/// HG-28: another number of axes than the list has is an error; the smaller number acts.
#[test]
fn the_number_of_axes_must_be_right() {
    let of = |count: u16| {
        let started = channel(&format!("gruppe[0].achs_anzahl {count}\n{}{}", named(0, "X", 1), named(1, "Y", 2)));
        (codes(&started.messages), started.channels[0].axes.len())
    };
    assert_eq!(of(1), (vec!["P-CHAN-00003 3 -".to_owned()], 1));
    assert_eq!(of(2), (vec![], 2));
    assert_eq!(of(33), (vec!["P-CHAN-00003 3 -".to_owned()], 2));
    let without = channel(&format!("{}{}", named(0, "X", 1), named(1, "Y", 2)));
    assert_eq!((codes(&without.messages), without.channels[0].axes.len()), (vec![], 2));
}

/// HG-28: an axis belongs to a channel once, and to one channel.
#[test]
fn an_axis_belongs_to_one_channel() {
    let twice = channel(&format!("{}{}", named(0, "X", 1), named(1, "Y", 1)));
    assert_eq!((codes(&twice.messages), twice.channels[0].axes.len()), (vec!["P-CHAN-00035 3 1".to_owned()], 1));
    let zero = channel(&format!("{}gruppe[0].achse[1].bezeichnung Y\n", named(0, "X", 1)));
    assert_eq!((codes(&zero.messages), zero.channels[0].axes.len()), (vec!["P-CHAN-00035 3 -".to_owned()], 1));
    let both = start(&[("x.lis", MASTER), ("c1.lis", CHANNEL), ("c2.lis", CHANNEL)]);
    assert_eq!(codes(&both.messages), ["P-CHAN-00035 3 1"]);
    assert_eq!((both.messages[0].channel, both.channels[1].axes.len()), (Some(2), 0));
}

/// The settings of couplings and of feeds.
#[test]
fn settings_of_a_channel_are_read() {
    let plain = channel("grp_anzahl 1\n");
    let of = &plain.channels[0];
    assert!(
        !of.restore_after_reset
            && !of.preserve_after_program_end
            && !of.retain_last_configuration
            && !of.has_alias_names
    );
    assert_eq!((of.is_feed_in_m_per_minute, of.default_feed.to_string()), (false, "0".to_owned()));
    let set = channel(
        "synchro_data.restore_coupling_after_reset 1\nsynchro_data.preserve_coupling_after_prog_end 1\nretain_last_ax_config 1\n\
        prog_start.feedrate_factor 0.1\nprog_start.feedrate 250\n",
    );
    let of = &set.channels[0];
    assert!(of.restore_after_reset && of.preserve_after_program_end && of.retain_last_configuration);
    assert_eq!((of.is_feed_in_m_per_minute, of.default_feed.to_string()), (true, "250".to_owned()));
    assert_eq!(of.value("P-CHAN-00104").and_then(crate::control::Value::whole), Some(1));
    let bad = channel("grp_anzahl 2\nprog_start.feedrate -1\n");
    assert_eq!(codes(&bad.messages), ["P-CHAN-00023 3 -", "P-CHAN-00099 3 -"]);
}

/// P-CHAN-00108 is 0.1 or 100; 0 and less is a warning, -1 is as no entry, and 100 acts.
#[test]
fn the_unit_of_the_feed_is_one_of_two() {
    for (value, code) in [
        ("0.1", None),
        ("100", None),
        ("-1", None),
        ("0", Some("P-CHAN-00108 1 -")),
        ("-2", Some("P-CHAN-00108 1 -")),
        ("1", Some("P-CHAN-00108 3 -")),
        ("1000", Some("P-CHAN-00108 3 -")),
    ] {
        let started = channel(&format!("grp_anzahl 1\nprog_start.feedrate_factor {value}\n"));
        assert_eq!(codes(&started.messages), Vec::from_iter(code), "{value}");
        let of = &started.channels[0];
        let used = of.value("P-CHAN-00108").and_then(crate::control::Value::number);
        let expected = if value == "0.1" { 0.1 } else { 100.0 };
        assert_eq!(used.map(|used| used.to_string()), Some(expected.to_string()), "{value}");
        assert_eq!(of.is_feed_in_m_per_minute, value == "0.1", "{value}");
    }
    let zero = channel("grp_anzahl 1\nprog_start.feedrate_factor 0\n");
    let text = "found 0, allowed 0.1 (F in m/min) or 100 (F in mm/min), used 100 (channel.lis:2)";
    assert!(zero.messages[0].text.ends_with(text), "{}", zero.messages[0].text);
}
