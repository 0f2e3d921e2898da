//! Each message of the ISG kernel is raised, and its text has what the template says: every parameter in its place, and none cut.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use opennck::plc::Programs;
use opennck::scenario::Scenario;

/// What is changed in the machine, the program, and what the text of its message must be.
type Row = (&'static str, &'static str, &'static str);

/// Of programs, on the machine with X, Y1, Z1, Y2 and Z2 (logical numbers 1, 2, 3, 8 and 9; channel index 0 to 4).
const SOFT: &[Row] = &[
    (
        "",
        "N10 G04 10 X2",
        "20013  channel_1  raised  nck  Channel channel_1 block 10: dwell time both directly and with an axis",
    ),
    (
        "",
        "N10 #SET AX LINK[1, Y2=Y1]\nN20 #ENABLE AX LINK[1]\nN30 G74 X1",
        "20137  channel_1  raised  nck  Channel channel_1 block 30: homing is not possible while coupling group 1 is active",
    ),
    (
        "",
        "N10 #SET AX LINK[7, Y2=Y1]",
        "20461  channel_1  raised  nck  Channel channel_1 block 10: coupling group 7 is out of range",
    ),
    (
        "",
        "N10 #SET AX LINK[1, Y2=Y1]\nN20 G41\nN30 #ENABLE AX LINK[1]",
        "20457  channel_1  raised  nck  Channel channel_1 block 30: a coupling cannot be switched while tool radius compensation is active",
    ),
    (
        "",
        "N10 #SET AX LINK[1, X=Y1]\nN20 #ENABLE AX LINK[1]",
        "20467  channel_1  raised  nck  Channel channel_1 block 20: slave ax1 is a main axis (channel index 0 to 2)",
    ),
    (
        "\"ax8:kenngr.achs_typ\" = 2\n\"ax8:kenngr.achs_mode\" = 4",
        "N10 #SET AX LINK[3, Y2=Y1]\nN20 #ENABLE AX LINK[3]",
        "20468  channel_1  raised  nck  Channel channel_1 block 20: master ax2 of group 3 and slave ax8 have different axis types",
    ),
    (
        "\"ax8:kenngr.achs_mode\" = 65",
        "N10 #SET AX LINK[3, Y2=Y1]\nN20 #ENABLE AX LINK[3]",
        "20469  channel_1  raised  nck  Channel channel_1 block 20: master ax2 of group 3 and slave ax8 have different axis modes",
    ),
    (
        "",
        "N10 #SET AX LINK[1, Y2=Y1]\nN20 G201 #AXIS [Y2]\nN30 #ENABLE AX LINK[1]",
        "20470  channel_1  raised  nck  Channel channel_1 block 30: slave ax8 is in manual mode G201",
    ),
    (
        "",
        "N10 #SET AX LINK[2, Y2=Y1]\nN20 #ENABLE AX LINK[2]\nN30 #SET AX LINK[2, Z2=Z1]",
        "20472  channel_1  raised  nck  Channel channel_1 block 30: coupling group 2 is active and cannot be defined anew",
    ),
    (
        "",
        "N10 #SET AX LINK[4, Y2=Y2]",
        "20475  channel_1  raised  nck  Channel channel_1 block 10: axis ax8 is its own master, group 4",
    ),
    (
        "",
        "N10 #SET AX LINK[5, Y2=Y1, Y2=Z1]",
        "20476  channel_1  raised  nck  Channel channel_1 block 10: axis ax8 is a slave twice, group 5",
    ),
    (
        "",
        "N10 #AX LINK NBR[6,[8 = 2],[9 = 8]]",
        "20477  channel_1  raised  nck  Channel channel_1 block 10: axis ax8 is both master and slave, group 6",
    ),
    (
        "",
        "N10 G04 X0.1 Y1=2",
        "20685  channel_1  raised  nck  Channel channel_1 block 10: dwell time with additional axes",
    ),
    (
        "",
        "N10 $GOTO A",
        "20839  channel_1  raised  nck  Channel channel_1 block 10: character behind $GOTO not permitted",
    ),
    (
        "",
        "N10 #SET AX LINK[1,[Y2 = Y1,0,1]]",
        "21077  channel_1  raised  nck  Channel channel_1 block 10: the numerator of the coupling factor is 0",
    ),
    (
        "",
        "N10 #SET AX LINK[1,[Y2 = Y1,1]]",
        "21110  channel_1  raised  nck  Channel channel_1 block 10: the denominator of the coupling factor is missing",
    ),
    (
        "",
        "N10 #SET AX LINK[1,[Y2 = Y1,1,2]]",
        "21111  channel_1  raised  nck  Channel channel_1 block 10: the coupling factor of axis ax8 is neither 1 nor -1; it is set to 1",
    ),
    (
        "",
        "N10 #SET AX LINK[1, Y2=Y1]\nN20 #ENABLE AX LINK[1]\nN30 #SET AX LINK[2, Y2=Z1]\nN40 #ENABLE AX LINK[2]",
        "21283  channel_1  raised  nck  Channel channel_1 block 40: slave ax8 is a slave in the active group 1 already",
    ),
    (
        "",
        "N10 #SET AX LINK[1, Y2=Z2]\nN20 #ENABLE AX LINK[1]\nN30 #SET AX LINK[2, Z2=Z1]\nN40 #ENABLE AX LINK[2]",
        "21284  channel_1  raised  nck  Channel channel_1 block 40: slave ax9 is a master in the active group 1",
    ),
    (
        "",
        "N10 #SET AX LINK[3, Y2=Y1]\nN20 #ENABLE AX LINK[3]\nN30 #SET AX LINK[2, Z2=Y2]\nN40 #ENABLE AX LINK[2]",
        "21285  channel_1  raised  nck  Channel channel_1 block 40: master ax8 is a slave in the active group 3",
    ),
    (
        "",
        "N10 G02 G03 X1",
        "20108  channel_1  raised  nck  Channel channel_1 block 10: more than one G function for the kind of movement: line 1, column 9: G02 and G03 stand in one block; a block has one G function for the kind of movement",
    ),
    (
        "",
        "$IF 0\nX1\n$ELSE\n$ELSE\n$ENDIF",
        "20214  channel_1  raised  nck  Channel channel_1 block 4: $ELSE does not match the control block: line 4, column 1: the $IF has had its $ELSE already",
    ),
    (
        "",
        "N10 $GOTO N20\nN20: X1\nN20: X2",
        "20836  channel_1  raised  nck  Channel channel_1 block 10: a label is defined more than once: line 1, column 5: the label N20: stands in line 2 and in line 3; labels of a program level differ",
    ),
    (
        "",
        "N10 LL UP X1",
        "21542  channel_1  raised  nck  Channel channel_1 block 10: NC commands behind a subroutine call",
    ),
    (
        "",
        "N10 #AX LINK NBR[3,[18 = 2]]\nN20 #ENABLE AX LINK[3]",
        "link-axis-missing  channel_1  raised  nck  Channel channel_1 block 20: axis 18 of coupling group 3 is not in the channel",
    ),
    (
        "",
        "N10 #ENABLE AX LINK[2]",
        "link-unassigned  channel_1  raised  nck  Channel channel_1 block 10: coupling group 2 is not assigned",
    ),
    (
        "",
        "N10 #SET AX LINK[1, Y2=Y1]\nN20 #ENABLE AX LINK[1]\nN30 G0 Y2=5",
        "link-slave-programmed  channel_1  raised  nck  Channel channel_1 block 30: axis ax8 is the slave of an active coupling group and cannot be programmed",
    ),
    (
        "",
        "N10 G0 X1 #ENABLE AX LINK[1]",
        "link-not-alone  channel_1  raised  nck  Channel channel_1 block 10: this command stands alone in its block",
    ),
    (
        "",
        "N10 #SET AX LINK[1,[Y2 = Y1,1,0]]",
        "link-denominator  channel_1  raised  nck  Channel channel_1 block 10: the denominator of the coupling factor is 0",
    ),
    (
        "",
        "N10 G0 W=5",
        "axis-unknown  channel_1  raised  nck  Channel channel_1 block 10: axis unknown: the channel has no axis W",
    ),
    (
        "",
        "N10 #CALL AX [W, 50, 7]",
        "axis-unknown  channel_1  raised  nck  Channel channel_1 block 10: axis unknown: no axis has the logical number 50",
    ),
    (
        "",
        "N10 G0 X=1 ]",
        "nc-syntax  channel_1  raised  nck  Channel channel_1 block 10: syntax error, line 1, column 12: ",
    ),
    (
        "",
        "N10 LL NOWHERE",
        "nc-call  channel_1  raised  nck  Channel channel_1 block 10: subroutine call: the file has no local subroutine `%L NOWHERE`; a subroutine in a file of its own is called with `L NOWHERE`",
    ),
    (
        "",
        "N10 V.G.AX_LINK.NR = 1",
        "nc-value  channel_1  raised  nck  Channel channel_1 block 10: a value is not possible: V.G.AX_LINK.NR cannot be written",
    ),
    (
        "",
        "N10 #SET AX LINK[1, Y2=Y1]\nN20 #ENABLE AX LINK[1]\nN30 #PUT AX [Y2]",
        "nc-value  channel_1  raised  nck  Channel channel_1 block 30: a value is not possible: axis 8 is coupled in an active coupling group",
    ),
    (
        "",
        "N10 #CALL AX [U, 5, 4]\n",
        "axis-unknown  channel_1  raised  nck  Channel channel_1 block 10: axis unknown: no axis has the logical number 5",
    ),
    (
        "\"channel_1:synchro_data.koppel_gruppe[0].paar[0].log_achs_nr_slave\" = 8\n\
         \"channel_1:synchro_data.koppel_gruppe[0].paar[0].log_achs_nr_master\" = 2\n\
         \"channel_1:synchro_data.koppel_gruppe[0].paar[1].log_achs_nr_slave\" = 9\n\
         \"channel_1:synchro_data.koppel_gruppe[0].paar[1].log_achs_nr_master\" = 8",
        "",
        "20442  ax8  raised  nck  Channel channel_1: axis ax8 is both master and slave; the pair of coupling group 0 is skipped: P-CHAN-00037, P-CHAN-00038 of channel 1: pair 1 of coupling group 0 is 8 → 9: axis 8 is a master and a slave (pair 0); used: no pair (isg_messages.toml:",
    ),
    (
        "\"channel_1:prog_start.feedrate_factor\" = 0",
        "",
        "P-CHAN-00108  channel_1  raised  nck  Channel channel_1, check of the parameter lists: P-CHAN-00108 prog_start.feedrate_factor of channel 1: found 0, allowed 0.1 (F in m/min) or 100 (F in mm/min), used 100 (isg_messages.toml:",
    ),
];

/// On the machine with the gantry master X (1), its slaves 5 and 6, and Y (2).
const HARD: &[Row] = &[
    (
        "\"channel_1:gruppe[0].achse[1].log_achs_nr\" = 5",
        "",
        "21020  ax5  raised  nck  Channel channel_1: ax5 is a gantry slave and cannot be an axis of a channel: P-CHAN-00035 gruppe[0].achse[1].log_achs_nr of channel 1: found 5, a gantry slave, which must not belong to a channel; used: no axis (isg_messages.toml:",
    ),
    (
        "",
        "N10 #CALL AX [Axis_X1, 5, 4]",
        "21020  channel_1  raised  nck  Channel channel_1 block 10: ax5 is a gantry slave and cannot be an axis of a channel: #CALL AX or #AX REQUEST of axis 5",
    ),
    (
        "",
        "N10 #GANTRY OFF [AX=X]",
        "gantry-not-config  channel_1  raised  nck  Channel channel_1 block 10: #GANTRY needs CONFIG (P-AXIS-00704) on every slave of axis ax1",
    ),
    (
        "",
        "N10 #GANTRY OFF [AXNR=2]",
        "gantry-unknown  channel_1  raised  nck  Channel channel_1 block 10: axis 2 is no gantry master that this command reaches",
    ),
    (
        "\"ax5:P-AXIS-00704\" = \"CONFIG\"\n\"ax6:P-AXIS-00704\" = \"CONFIG\"",
        "N10 #GANTRY OFF [AX=X]\nN20 #CALL AX [U, 5, 3][V, 6, 3]",
        "21257  channel_1  raised  nck  Channel channel_1 block 20: channel index 3 is given twice",
    ),
    (
        "\"ax5:P-AXIS-00704\" = \"CONFIG\"\n\"ax6:P-AXIS-00704\" = \"CONFIG\"",
        "N10 #GANTRY OFF [AX=X]\nN20 #CALL AX [U, 5, 1]",
        "21260  channel_1  raised  nck  Channel channel_1 block 20: channel index 1 is occupied",
    ),
    (
        "\"ax5:kenngr.gantry_ax_nr\" = 2",
        "",
        "70124  ax5  raised  nck  Slave ax5 names axis ax2 as its master, which is not configured as one: P-AXIS-00070 kenngr.gantry_ax_nr of axis 5: found 2, but axis 2 is not configured as gantry master (P-AXIS-00015 is 0x1); used: no coupling (isg_messages.toml:",
    ),
    (
        "\"ax1:kenngr.gantry_ax_nr\" = 5",
        "",
        "110342  ax1  raised  nck  Gantry master ax1 has an entry for its own master; it is set to 0: P-AXIS-00070 kenngr.gantry_ax_nr of axis 1: found 5, allowed 0, because the axis is a gantry master, used 0 (isg_messages.toml:",
    ),
    (
        "\"ax5:P-AXIS-00261\" = 1\n\"ax5:P-AXIS-00704\" = \"CONFIG\"",
        "",
        "110606  ax5  raised  nck  Axis ax5: P-AXIS-00704 contradicts P-AXIS-00261: P-AXIS-00704 kenngr.gantry_on_mode of axis 5: found CONFIG with P-AXIS-00261 = 1, allowed DEFAULT or EDGE_TRIGGERED, used EDGE_TRIGGERED (isg_messages.toml:",
    ),
    (
        "\"ax5:P-AXIS-00072\" = 5000",
        "",
        "P-AXIS-00072  ax5  raised  nck  Axis ax5, check of the parameter lists: P-AXIS-00072 kenngr.gantry_max_diff_resetable of axis 5: found 5000, allowed 1 … 4999 (P-AXIS-00071 is 5000), used 4999 (isg_messages.toml:",
    ),
    (
        "\"ax5:P-AXIS-00254\" = 1",
        "",
        "P-AXIS-00254  ax5  raised  nck  Axis ax5, check of the parameter lists: P-AXIS-00254 kenngr.cnc_controlled_stop_after_error of axis 5: found 1, its gantry master axis 1 has 0 (axis_1.lis:",
    ),
];

/// The trace of a program, with blanks between its columns reduced to two.
fn trace(machine: &str, data: &str, program: &str) -> String {
    let text = format!(
        "title = \"a message\"\nmachine = \"{machine}\"\n[machine_data]\n{data}\n\
         [[step]]\nrun = \"50ms\"\n[[step]]\nnc = '''\n{program}\nM30\n'''\n\
         [[step]]\npulse = \"channel_1.start\"\n[[step]]\nrun = \"400ms\"\n"
    );
    let cases = Scenario::parse_cases(&text, Path::new("isg_messages.toml"))
        .unwrap_or_else(|problem| panic!("{text}\n{problem}"));
    let scenario = cases.into_iter().next().unwrap();
    let prepared = scenario.prepare(scenario.profiles[0], &Programs::ready());
    let finished = prepared.unwrap_or_else(|problem| panic!("{text}\n{problem}")).run();
    let words =
        |line: &str| line.split("  ").map(str::trim).filter(|word| !word.is_empty()).collect::<Vec<_>>().join("  ");
    finished.text().lines().map(words).collect::<Vec<_>>().join("\n")
}

#[test]
fn every_message_has_the_text_of_its_template_with_its_parameters() {
    let mut wrong = String::new();
    for (machine, rows) in [("isg_soft_gantry", SOFT), ("isg_hard_gantry", HARD)] {
        for (data, program, expected) in rows {
            let trace = trace(machine, data, program);
            if !trace.contains(&format!("alarm {expected}")) {
                let alarms: Vec<&str> = trace.lines().filter(|line| line.contains("alarm ")).collect();
                wrong += &format!("expected {expected}\nfound {alarms:#?}\n");
            }
            for line in trace.lines().filter(|line| line.contains("alarm ")) {
                let odd = ["axis axis", "(%", " %1", " %2", " %3", " %4", ": :", "()"];
                if odd.iter().any(|odd| line.contains(odd)) || line.ends_with(':') || line.ends_with(": ") {
                    wrong += &format!("odd: {line}\n");
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}
