//! Control structures, jumps, repetitions and subprograms.

use super::{Channel, alarm, interpreter, path, r, run, run_in};
use crate::nc_program::{End, Prepared};

#[test]
fn structures_run_as_they_say() {
    for (text, expected) in [
        ("IF R2==0\nR1=1\nELSE\nR1=2\nENDIF", 1.0),
        ("IF R2==1\nR1=1\nELSE\nR1=2\nENDIF", 2.0),
        ("IF R2==1\nR1=1\nENDIF", 0.0),
        ("WHILE R1<5\nR1=R1+1\nENDWHILE", 5.0),
        ("WHILE R1>5\nR1=R1+1\nENDWHILE", 0.0),
        ("REPEAT\nR1=R1+1\nUNTIL R1>=3", 3.0),
        ("LOOP\nR1=R1+1\nIF R1==4 GOTOF OUT\nENDLOOP\nOUT:", 4.0),
        ("FOR R2=1 TO 4\nR1=R1+R2\nENDFOR", 10.0),
        ("FOR R2=5 TO 4\nR1=R1+R2\nENDFOR", 0.0),
        ("FOR R2=1 TO 3\nIF R2==2\nR1=R1+10\nELSE\nR1=R1+1\nENDIF\nENDFOR", 12.0),
        ("CASE(R2) OF 0 GOTOF ZERO 1 GOTOF ONE DEFAULT GOTOF ELSEWHERE\nONE:\nELSEWHERE: R1=9\nZERO: R1=R1+1", 1.0),
        ("CASE R2+7 OF 0 GOTOF ZERO DEFAULT GOTOF OTHER\nZERO: R1=1\nOTHER: R1=R1+5", 5.0),
        ("CASE(R2) OF 7 GOTOF ZERO\nR1=3\nZERO:", 3.0),
    ] {
        assert_eq!(r(&format!("{text}\nM30"), 1), [expected], "{text}");
    }
    assert_eq!(r("DEF INT NR\nFOR NR=0 TO 2\nR1=NR\nENDFOR\nR2=NR\nM30", 2), [2.0, 3.0]);
}

#[test]
fn jumps_search_in_their_direction() {
    for (text, expected) in [
        ("GOTOF AB\nR1=1\nAB: R1=R1+2", 2.0),
        ("GOTOF N50\nR1=1\nN050 R1=R1+2", 2.0),
        ("GOTOF :50\nR1=1\n:50 R1=R1+2", 2.0),
        ("GOTOF \"AB\"\nR1=1\nAB: R1=R1+2", 2.0),
        ("R2=50\nGOTOF \"N\"<<R2\nR1=1\nN50 R1=R1+2", 2.0),
        ("DEF STRING[8] GOAL=\"AB\"\nGOTOF GOAL\nR1=1\nAB: R1=R1+2", 2.0),
        ("BACK: R1=R1+1\nIF R1<3 GOTOB BACK", 3.0),
        // Two equal labels are legal: the nearest in the direction counts.
        ("GOTOF AB\nAB: R1=1\nGOTOF OUT\nAB: R1=2\nOUT:", 1.0),
        ("GOTO AB\nR1=1\nAB: R1=R1+2", 2.0),
        ("GOTOF CD\nAB: R1=5\nGOTOF OUT\nCD: GOTO AB\nOUT:", 5.0),
        ("GOTOC NOWHERE\nR1=7", 7.0),
        ("GOTOS\nR1=1", 1.0),
        ("IF R1==0 GOTOF AB\nR1=1\nAB: R1=R1+2", 2.0),
        ("IF R1==1 GOTOF AB\nR1=1\nAB: R1=R1+2", 3.0),
    ] {
        assert_eq!(r(&format!("{text}\nM30"), 1), [expected], "{text}");
    }
    assert_eq!(alarm("AB: R1=1\nGOTOF AB\nM30").number, 14080);
    assert_eq!(alarm("GOTOB AB\nAB: R1=1\nM30").number, 14080);
}

#[test]
fn gotos_jumps_to_the_start_if_the_plc_wants_it() {
    let mut channel =
        Channel::new().with("PART.MPF", "DEF INT AB=1\nR1=R1+AB AB=5\nIF R1>2 GOTOF OUT\nIF TRUE GOTOS\nOUT: M30");
    channel.is_restarting = true;
    assert_eq!(run_in(&mut channel).1, None);
    assert_eq!(channel.r[1], 3.0);
}

#[test]
fn jumps_leave_structures() {
    // 20 times out of a loop with two levels: nothing stays open.
    let text = "AGAIN: R1=R1+1\nWHILE TRUE\nIF TRUE\nGOTOF OUT\nENDIF\nENDWHILE\nOUT: IF R1<20 GOTOB AGAIN\nM30";
    assert_eq!(r(text, 1), [20.0]);
    // A jump inside a loop keeps it open.
    let text = "WHILE R1<3\nR1=R1+1\nGOTOF AB\nR1=99\nAB: R2=R2+1\nENDWHILE\nM30";
    assert_eq!(r(text, 2), [3.0, 3.0]);
    let text = "FOR R1=1 TO 2\nAB: R2=R2+1\nIF R2==1 GOTOB AB\nENDFOR\nM30";
    assert_eq!(r(text, 2), [3.0, 3.0]);
    // Into a structure: its end has no beginning.
    assert_eq!(alarm("GOTOF AB\nLOOP\nAB: R1=1\nENDLOOP\nM30").number, 12640);
}

#[test]
fn parts_of_a_program_are_repeated() {
    for (text, expected) in [
        ("AB: R1=R1+1\nREPEATB AB P=3\nR2=7", [4.0, 7.0]),
        ("AB: R1=R1+1\nR2=R2+1\nREPEAT AB P=2", [3.0, 3.0]),
        ("AB: R1=R1+1\nREPEAT AB", [2.0, 0.0]),
        ("AB: R1=R1+1\nCD: R2=R2+1\nR2=R2+100\nREPEAT AB CD P2", [3.0, 103.0]),
        ("AB: R1=R1+1\nENDLABEL: R1=R1+1\nR2=R2+1\nREPEAT AB P2", [6.0, 1.0]),
        ("GOTOF CD\nAB: R1=R1+1\nENDLABEL:\nGOTOF OUT\nCD: REPEAT AB P=5\nR2=1\nOUT:", [5.0, 1.0]),
        ("REPEAT AB P=2\nR2=1\nAB: R1=R1+1\nENDLABEL:", [3.0, 1.0]),
        // One repetition inside another one.
        ("AB: R1=R1+1\nCD: R2=R2+1\nREPEATB CD P=1\nREPEAT AB P=1", [2.0, 4.0]),
    ] {
        assert_eq!(r(&format!("{text}\nM30"), 2), expected, "{text}");
    }
    assert_eq!(alarm("AB: R1=1\nREPEAT AB P=0\nM30").number, 14013);
    assert_eq!(alarm("REPEAT AB P=2\nAB: R1=1\nM30").number, 14082, "a part behind REPEAT needs ENDLABEL");
}

/// R parameters after a main program with subprograms.
#[track_caller]
fn with(subs: &[(&str, &str)], main: &str) -> (Vec<f64>, String) {
    let mut channel = Channel::new().with("PART.MPF", main);
    for (name, text) in subs {
        channel = channel.with(name, text);
    }
    let (blocks, alarm) = run_in(&mut channel);
    assert_eq!(alarm, None, "{main}");
    (channel.r[1..=4].to_vec(), path(&blocks))
}

#[test]
fn subprograms_are_called_in_all_forms() {
    let subs = [("L10.SPF", "R1=R1+1\nM17"), ("L010.SPF", "R2=R2+1\nM17"), ("SUB.SPF", "R3=R3+1\nRET")];
    let main = "L10\nL010\nSUB\nN10 SUB P3\nL10 P=R3\nCALL \"SUB\"\nCALL \"S\"<<\"UB\" P2\nEXTCALL(\"SUB.SPF\")\nM30";
    assert_eq!(with(&subs, main).0, [5.0, 1.0, 8.0, 0.0]);
}

#[test]
fn parameters_are_values_or_variables() {
    let sub = "PROC SUB(INT NUMBER, VAR REAL BACK, REAL STANDARD=7, STRING[5] TEXT=\"AB\")\nDEF REAL LOCAL=NUMBER*2\n\
               BACK=LOCAL+STANDARD NUMBER=99\nM17";
    let main = "DEF REAL HERE\nSUB(5.5,HERE)\nR1=HERE\nSUB(1,R2,1)\nSUB(1,R[3],,\"X\")\nSUB(,R4)\nM30";
    assert_eq!(with(&[("SUB.SPF", sub)], main).0, [19.0, 3.0, 9.0, 7.0], "an omitted value is 0");
}

#[test]
fn var_parameters_reach_through_several_levels_and_arrays() {
    let outer = "PROC OUTER(VAR INT ONE, VAR REAL LIST[])\nINNER(ONE,LIST)\nM17";
    let inner = "PROC INNER(VAR INT ONE, VAR REAL LIST[])\nONE=ONE+1 LIST[1]=ONE LIST[0]=LIST[1]*2\nM17";
    let main = "DEF INT COUNT[3]\nDEF REAL VALUES[2]\nCOUNT[2]=4\nOUTER(COUNT[2],VALUES)\nR1=COUNT[2] R2=VALUES[0] R3=VALUES[1]\nM30";
    assert_eq!(with(&[("OUTER.SPF", outer), ("INNER.SPF", inner)], main).0, [5.0, 10.0, 5.0, 0.0]);
    let by_value = "PROC COPY(REAL LIST[2])\nLIST[0]=99 R1=LIST[1]\nM17";
    let main = "DEF REAL VALUES[2]=SET(1,2)\nCOPY(VALUES)\nR2=VALUES[0]\nM30";
    assert_eq!(with(&[("COPY.SPF", by_value)], main).0, [2.0, 1.0, 0.0, 0.0]);
}

#[test]
fn each_pass_has_new_variables() {
    let sub = "PROC SUB(INT GIVEN)\nDEF INT LOCAL\nLOCAL=LOCAL+GIVEN\nR1=R1+LOCAL\nM17";
    assert_eq!(with(&[("SUB.SPF", sub)], "SUB(2) P3\nM30").0[0], 6.0);
}

#[test]
fn save_brings_back_modal_functions_and_offset() {
    let mut channel = Channel::new()
        .with("PART.MPF", "G0 G90 X1\nSUB\nX3\nPLAIN\nX4\nM30")
        .with("SUB.SPF", "PROC SUB SAVE\nG91 TRANS X5\nX2\nM17")
        .with("PLAIN.SPF", "G91\nM17");
    let (blocks, alarm) = run_in(&mut channel);
    assert_eq!(alarm, None);
    let found: Vec<_> = blocks.iter().filter(|block| !block.axes.is_empty()).collect();
    let found: Vec<_> =
        found.iter().map(|block| (block.axes[0].value, block.modal.index(14), block.offset.len())).collect();
    assert_eq!(found, [(1.0, 1, 0), (2.0, 2, 1), (3.0, 1, 0), (4.0, 2, 0)]);
}

#[test]
fn the_end_of_a_subprogram_is_seen_and_the_end_of_the_program_too() {
    for (end, is_block) in [("M17", true), ("M30", true), ("M2", true), ("RET", false)] {
        let mut channel = Channel::new().with("PART.MPF", "SUB\nR1=1\nM30").with("SUB.SPF", end);
        let (blocks, alarm) = run_in(&mut channel);
        let ends: Vec<_> = blocks.iter().map(|block| block.end).collect();
        let expected =
            if is_block { vec![Some(End::Subprogram), Some(End::Program)] } else { vec![Some(End::Program)] };
        assert_eq!((ends, alarm, channel.r[1]), (expected, None, 1.0), "{end}");
    }
    let mut channel = Channel::new().with("PART.MPF", "SUB\nM30").with("SUB.SPF", "R1=1");
    let found = run_in(&mut channel).1.unwrap();
    assert_eq!((found.number, found.program.as_str()), (14000, "SUB.SPF"));
}

#[test]
fn programs_of_an_archive_call_each_other_by_folder() {
    let archive = "%_N_PART_MPF\n;$PATH=/_N_MPF_DIR\nCALL \"/_N_SPF_DIR/_N_SUB_SPF\"\nM30\n%_N_SUB_SPF\n;$PATH=/_N_SPF_DIR\nR1=5\nM17\n";
    let mut channel = Channel::new().with("ALL.ARC", archive);
    let start =
        crate::nc_program::Interpreter::new("/_N_MPF_DIR/PART.MPF", crate::nc_program::Modal::default(), None, false);
    let mut interpreter = start;
    while !matches!(interpreter.next(&mut channel).unwrap(), Prepared::Ended) {}
    assert_eq!(channel.r[1], 5.0);
}

/// MDHELP 20108: behind the folder of the caller, the folders of a control are searched; a program of an archive without a folder is in that
/// of its kind.
#[test]
fn a_call_without_a_folder_searches_the_folders_of_a_control() {
    for path in [";$PATH=/_N_SPF_DIR\n", ";$PATH=/_N_CMA_DIR\n", ""] {
        let archive = format!("%_N_PART_MPF\n;$PATH=/_N_MPF_DIR\nSUB\nM30\n%_N_SUB_SPF\n{path}R1=5\nM17\n");
        let mut channel = Channel::new().with("ALL.ARC", &archive);
        let modal = crate::nc_program::Modal::default();
        let mut interpreter = crate::nc_program::Interpreter::new("/_N_MPF_DIR/PART.MPF", modal, None, false);
        while !matches!(interpreter.next(&mut channel).unwrap(), Prepared::Ended) {}
        assert_eq!(channel.r[1], 5.0, "{path}");
    }
}

#[test]
fn single_block_and_display_are_off_where_the_program_says_so() {
    let mut channel = Channel::new()
        .with("PART.MPF", "M1\nSUB\nM1\nSBLOF\nM1\nSBLON\nM30")
        .with("SUB.SPF", "PROC SUB SBLOF DISPLOF\nM1\nM17");
    let (blocks, _) = run_in(&mut channel);
    let off: Vec<_> = blocks.iter().map(|block| block.origin.is_single_block_off).collect();
    assert_eq!(off, [false, true, true, false, true, false]);
    assert!(blocks[1].origin.is_display_off && blocks[1].origin.level == 1);
}

#[test]
fn the_channel_can_end_passes_and_levels() {
    let mut channel = Channel::new().with("PART.MPF", "L1 P5\nM30").with("L1.SPF", "M1\nM2\nM17");
    let mut interpreter = interpreter();
    interpreter.next(&mut channel).unwrap();
    assert_eq!((interpreter.passes(), interpreter.stack().count()), (5, 2));
    interpreter.delete_passes();
    interpreter.next(&mut channel).unwrap();
    assert_eq!(interpreter.stack().count(), 1);
    assert!(!interpreter.abort_level());
    let mut second = super::interpreter();
    second.next(&mut channel).unwrap();
    assert!(second.abort_level());
    let Prepared::Block(block) = second.next(&mut channel).unwrap() else { panic!("a block") };
    assert_eq!(block.end, Some(End::Program));
}

#[test]
fn an_endless_calculation_returns_to_the_channel() {
    let mut channel = Channel::new().with("PART.MPF", "LOOP\nR1=R1+1\nENDLOOP\nM30");
    let mut interpreter = interpreter();
    for _ in 0..3 {
        assert!(matches!(interpreter.next(&mut channel), Ok(Prepared::Calculated(_))));
    }
    assert!(channel.r[1] > 100.0);
    let mut channel = Channel::new().with("PART.MPF", "AB: GOTOB AB\nM30");
    assert!(matches!(super::interpreter().next(&mut channel), Ok(Prepared::Calculated(_))));
    let mut channel = Channel::new().with("PART.MPF", "AB:\nREPEATB AB P=2000000000\nM30");
    assert!(matches!(super::interpreter().next(&mut channel), Ok(Prepared::Calculated(_))));
    assert_eq!(run("G0 X1\nM30").len(), 2);
}

/// nc_programs.md 3.5: a search finds a block of the main program that only calculates, jumps or calls, before it does so. N20 of the
/// subprogram is another block; a block that is executed is found by the channel.
#[test]
fn preparation_stops_once_before_a_block_that_calculates() {
    let text = "N10 R1=R1+1\nN20 SUB\nN30 IF R1<3 GOTOB N10\nN40 STOPRE\nN50 ; nothing\nN60 G0 X1\nM30";
    for (target, r) in [("N10", 0.0), ("N20", 1.0), ("N30", 11.0), ("N40", 11.0), ("N50", 11.0)] {
        let mut channel = Channel::new().with("PART.MPF", text).with("SUB.SPF", "N20 R1=R1+10\nM17");
        let mut interpreter = interpreter();
        interpreter.stop_before(crate::nc_program::BlockTarget::new(target).unwrap());
        let mut found = 0;
        loop {
            match interpreter.next(&mut channel).unwrap() {
                Prepared::Before(origin) => {
                    assert_eq!((origin.name.as_str(), channel.r[1]), (target, r));
                    found += 1;
                }
                Prepared::Ended => break,
                Prepared::Block(_) | Prepared::Calculated(_) | Prepared::Waits(_) => {}
            }
        }
        assert_eq!(found, 1, "{target}");
    }
    let mut channel = Channel::new().with("PART.MPF", text).with("SUB.SPF", "M17");
    let mut interpreter = interpreter();
    interpreter.stop_before(crate::nc_program::BlockTarget::new("N60").unwrap());
    while !matches!(interpreter.next(&mut channel).unwrap(), Prepared::Block(_)) {}
}

/// P-123: whether the end is missing does not depend on the way that the program takes.
#[test]
fn structures_have_an_end() {
    for begin in
        ["IF TRUE", "IF FALSE", "WHILE TRUE", "WHILE FALSE", "REPEAT", "LOOP", "FOR R1=1 TO 3", "FOR R1=3 TO 1"]
    {
        for behind in ["M30", "GOTOF AB\nAB: M30", "IF TRUE\nENDIF\nM30"] {
            let found = alarm(&format!("R1=1\n{begin}\n{behind}"));
            assert_eq!((found.number, found.block.as_str()), (12640, "2"), "{begin}, {behind}");
        }
    }
    assert_eq!(alarm("IF TRUE\nELSE\nM30").number, 12640);
}
