//! Changes of entries: targets, values, and when they take effect.

use super::{axis, codes, hard_files, read};
use crate::control::Value;
use crate::isg::lists::{Change, Effect, Lists};
use crate::source::{Place, Problem};

fn hard() -> Lists {
    Lists::read(&hard_files("", "", "")).unwrap()
}

fn set(lists: &mut Lists, target: &str, value: i64) -> Result<Effect, Problem> {
    lists.set(target, &Value::Integer(value), &Place::file("s.toml").at_line(7))
}

/// HG-02, B53: an update of P-AXIS-00070 at run time is not adopted; the next start adopts it.
#[test]
fn the_master_of_a_slave_changes_only_with_a_start() {
    let mut lists = hard();
    lists.start();
    assert_eq!(set(&mut lists, "ax6:kenngr.gantry_ax_nr", 5), Ok(Effect::Restart));
    let running = lists.update();
    assert_eq!((axis(&running, 6).master, codes(&running.messages)), (Some(1), vec![]));
    let started = lists.start();
    assert_eq!((axis(&started, 6).master, codes(&started.messages)), (None, vec!["70124 1 6".to_owned()]));
    assert!(started.messages[0].text.ends_with("(s.toml:7)"));
}

/// HG-02: other parameters are in effect with the update, and stay after a start.
#[test]
fn other_parameters_take_effect_with_the_update() {
    let mut lists = hard();
    lists.start();
    assert_eq!(set(&mut lists, "ax5:P-AXIS-00072", 2000), Ok(Effect::Update));
    assert_eq!(set(&mut lists, "Axis_X1:kenngr.gantry_offset", -30), Ok(Effect::Update));
    assert_eq!(set(&mut lists, "channel_1:synchro_data.restore_coupling_after_reset", 1), Ok(Effect::Update));
    for started in [lists.update(), lists.start()] {
        let slave = axis(&started, 5);
        assert_eq!((slave.limits.first, slave.offset), (2000, -30));
        assert!(started.channels[0].restore_after_reset);
    }
}

/// HG-02, HG-04: an update of a parameter that must be equal is taken from the master again.
#[test]
fn an_update_of_a_slave_does_not_separate_it_from_its_master() {
    let mut lists = hard();
    lists.start();
    set(&mut lists, "ax5:getriebe[0].dynamik.a_max", 500).unwrap();
    let running = lists.update();
    assert_eq!((axis(&running, 5).a_max, codes(&running.messages)), (1000, vec!["P-AXIS-00008 1 5".to_owned()]));
    set(&mut lists, "ax1:getriebe[0].dynamik.a_max", 500).unwrap();
    assert_eq!((axis(&lists.update(), 5).a_max, axis(&lists.update(), 6).a_max), (500, 500));
}

/// HG-28: a change that is not possible is an error with its place, and changes nothing.
#[test]
fn a_wrong_change_is_an_error() {
    let mut lists = hard();
    let before = lists.clone();
    for (target, value, what) in [
        ("kenngr.gantry_ax_nr", 1, "expected an axis or channel and a parameter"),
        ("ax7:kenngr.gantry_ax_nr", 1, "expected an axis or channel with a list, found `ax7`"),
        ("channel_2:P-CHAN-00104", 1, "expected an axis or channel with a list"),
        ("ax6:kenngr.gantry_axnr", 1, "expected a parameter of axis 6, found `kenngr.gantry_axnr`"),
        ("ax6:P-CHAN-00104", 1, "expected a parameter of an axis, found P-CHAN-00104"),
        ("channel_1:P-AXIS-00072", 1, "expected a parameter of a channel, found P-AXIS-00072"),
        ("ax6:getriebe[x].dynamik.a_max", 1, "expected a parameter, found a broken index"),
        ("ax6:kenngr.gantry_ax_nr", 65536, "P-AXIS-00070 kenngr.gantry_ax_nr: expected a number from 0 to 65535"),
        ("ax6:kenngr.gantry_on_mode", 1, "P-AXIS-00704 kenngr.gantry_on_mode: expected a word in quotes"),
        ("ax6:kopf.achs_nr", 7, "expected a parameter that can change, found P-AXIS-00016"),
        ("channel_1:gruppe[0].achse[0].log_achs_nr", 9, "P-CHAN-00035: expected an axis that has a list, found axis 9"),
    ] {
        let problem = set(&mut lists, target, value).unwrap_err();
        assert!(problem.what.starts_with(what), "{problem}");
        assert_eq!(problem.place, Some(Place::file("s.toml").at_line(7)));
        assert!(!problem.cure.is_empty());
        assert_eq!(lists, before);
    }
    assert_eq!(set(&mut lists, "ax6:kenngr.gantry_axnr", 1).unwrap_err().cure, "did you mean `kenngr.gantry_ax_nr`?");
}

/// HG-28: changes that are possible only together are made together, or not at all.
#[test]
fn changes_are_made_together() {
    let text = "gruppe[0].achse[0].bezeichnung X\ngruppe[0].achse[0].log_achs_nr 1\n\
        gruppe[0].achse[1].bezeichnung Y\ngruppe[0].achse[1].log_achs_nr 2\n";
    let axis = |number: u16| format!("kopf.achs_nr {number}\nkenngr.achs_mode 1\n");
    let mut lists = read(&[("a.lis", &axis(1)), ("b.lis", &axis(2)), ("c.lis", text)]).unwrap();
    let (place, x, y) = (Place::file("s.toml").at_line(3), Value::Text("X".to_owned()), Value::Text("Y".to_owned()));
    let change = |target, value| Change { target, value, place: &place };
    let [first, second] = ["channel_1:gruppe[0].achse[0].bezeichnung", "channel_1:P-CHAN-00006[1]"];
    let before = lists.clone();
    assert!(lists.set_all(&[change(first, &y)]).is_err());
    assert!(lists.set_all(&[change(first, &y), change(second, &Value::Integer(1))]).is_err());
    assert_eq!(lists, before);
    lists.set_all(&[change(first, &y), change(second, &x)]).unwrap();
    let names =
        |lists: &mut Lists| lists.start().channels[0].axes.iter().map(|axis| axis.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&mut lists), ["Y", "X"]);
}
