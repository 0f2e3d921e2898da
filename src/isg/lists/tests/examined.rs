//! What `opennck machine-data check` reports.

use super::{CHANNEL, MASTER, SLAVE, hard_files};
use crate::control::{Class, Examined, summary};
use crate::isg::lists::examine;

/// HG-28: a machine without a fault has a summary and no findings.
#[test]
fn the_combination_of_the_manual_has_a_summary() {
    let Examined { is_refused, is_empty, summary, ignored, findings } = examine(&hard_files("", "", ""));
    assert!(!is_refused && !is_empty && ignored.is_empty());
    assert_eq!(findings, []);
    let expected = [
        "ax1 X: linear, gantry master, x.lis",
        "ax5 Axis_X1: linear, gantry slave of ax1, x1.lis",
        "ax6 Axis_X2: linear, gantry slave of ax1, x2.lis",
        "channel_1: X (ax1) at 0; channel.lis",
    ];
    assert_eq!(summary, expected);
}

/// HG-06, HG-28: messages of the control, misspelt names, ignored words and files, and entries without effect are reported with their places.
#[test]
fn everything_about_the_files_is_reported() {
    let slave = format!(
        "kopf.achs_nr 5\n{SLAVE}kenngr.gantry_max_diff_resettable 500\nkenngr.gantry_on_mode CONFIG # x\nkenngr.gantry_vb_korr 0\n\
        kenngr.swe_pos 5\ngetriebe[1].dynamik.a_max 7\nlr_param.dyn_monitoring_v_err 1\n"
    );
    let files = [("a.lis", MASTER), ("b.lis", &slave), ("c.lis", CHANNEL), ("d.lis", "kenngr.achs_typ 1\n")];
    let examined = examine(&files);
    assert!(!examined.is_refused);
    assert_eq!(examined.summary.last().map(String::as_str), Some("other lists, left alone: d.lis"));
    let shown: Vec<String> = examined.findings.iter().map(ToString::to_string).collect();
    let expected = [
        "b.lis:11: alarm at power on: error P-AXIS-00075 kenngr.gantry_vb_korr of axis 5: found 0, allowed 1 … 199999 \
            (P-AXIS-00212 is 200000), used 1",
        "b.lis:10: implausible: P-AXIS-00704 kenngr.gantry_on_mode = \"CONFIG\", axis 5: behind the word stands `# x`, which is ignored\n  \
            behind a word, begin a comment with `(`",
        "d.lis:1: implausible: has `kenngr.achs_typ`, but no `kopf.achs_nr`: it is not read as the list of an axis\n  \
            write the logical number of the axis: kopf.achs_nr 5",
        "b.lis:11: overlaid: P-AXIS-00075 kenngr.gantry_vb_korr = 0, axis 5: replaces the entry in line 8",
        "b.lis:9: not modelled: kenngr.gantry_max_diff_resettable = 500, axis 5: not known here; it is kept and has no effect\n  \
            did you mean `kenngr.gantry_max_diff_resetable`?",
        "b.lis:12: not modelled: kenngr.swe_pos = 5, axis 5: not known here; it is kept and has no effect",
        "b.lis:13: not modelled: P-AXIS-00008 getriebe[1].dynamik.a_max = 7, axis 5: only the index 0 is modelled; the entry is kept and \
            has no effect",
        "b.lis:14: not modelled: P-AXIS-00407 lr_param.dyn_monitoring_v_err = 1, axis 5: not modelled; it is kept and has no effect",
    ];
    assert_eq!(shown, expected);
    assert!(summary(&examined.findings).unwrap().starts_with("1 alarm at power on, 2 implausible"));
    let groups: Vec<&str> = examined.findings.iter().skip(4).map(|finding| finding.group).collect();
    let [unknown, known] = ["entries that are not known here", "known parameters without an effect"];
    assert_eq!(groups, [unknown, unknown, known, known]);
}

/// HG-28: files that no machine can have are refused, with all reasons.
#[test]
fn all_reasons_of_a_refusal_are_reported() {
    let examined =
        examine(&[("a.lis", format!("{MASTER}kenngr.gantry_ax_nr X\ngetriebe[.x 1\n")), ("b.lis", MASTER.to_owned())]);
    assert!(examined.is_refused && examined.summary.is_empty());
    assert_eq!(examined.findings.iter().filter(|finding| finding.class == Class::Unreadable).count(), 3);
    assert!(examine::<&str, &str>(&[]).is_empty);
    assert!(examine(&[("x.lis", "a 1\n")]).is_empty);
}
