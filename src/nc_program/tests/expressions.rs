//! Variables and expressions.

use super::{Channel, alarm, path, r, run, run_in};

/// R1 after an assignment.
#[track_caller]
fn value(expression: &str) -> f64 {
    r(&format!("R2=2 R3=3 R4=4\nR1={expression}\nM30"), 1)[0]
}

#[test]
fn operators_bind_as_the_table_says() {
    for (expression, expected) in [
        // 1 binds stronger than 2, and so on: each pair of neighbours in the table.
        ("NOT 0 * 5", 5.0),
        ("B_NOT 0 * 2", -2.0),
        ("-2*3", -6.0),
        ("1+2*3", 7.0),
        ("7-6/2", 4.0),
        ("1+7 DIV 2", 4.0),
        ("1+7 MOD 4", 4.0),
        ("6 B_AND 3+1", 4.0),
        ("1 B_XOR 3 B_AND 2", 3.0),
        ("1 B_OR 3 B_XOR 1", 3.0),
        ("0 AND 0 B_OR 1", 0.0),
        ("1 XOR 1 AND 0", 1.0),
        ("1 OR 1 XOR 1", 1.0),
        // Left to right at one rank.
        ("2-3-4", -5.0),
        ("16/4/2", 2.0),
        ("7 DIV 2 * 2", 6.0),
        ("(2-3)*4", -4.0),
    ] {
        assert_eq!(value(expression), expected, "{expression}");
    }
    // `<<` binds stronger than a comparison, and weaker than everything else.
    assert_eq!(value("\"A\"<<1+1==\"A2\""), 1.0);
    assert_eq!(value("1<2==TRUE"), 1.0, "comparisons of one rank from left to right");
}

#[test]
fn comparisons_bind_weakest() {
    // (R2==(2 AND R3))==3: 2 == TRUE is FALSE, and FALSE == 3 is FALSE.
    assert_eq!(value("R2==2 AND R3==3"), 0.0);
    assert_eq!(value("(R2==2) AND (R3==3)"), 1.0);
}

#[test]
fn reals_are_equal_within_a_relative_tolerance() {
    assert_eq!(value("0.1+0.2==0.3"), 1.0);
    assert_eq!(value("0.1+0.2<>0.3"), 0.0);
    assert_eq!(value("0.1+0.2>0.3"), 0.0);
    assert_eq!(value("0.1+0.2<=0.3"), 1.0);
    assert_eq!(value("1.00000000001==1"), 0.0);
    assert_eq!(value("1EX-20==0"), 0.0);
}

#[test]
fn division_has_three_forms() {
    assert_eq!(value("3/4"), 0.75);
    assert_eq!(value("-7 DIV 2"), -3.0);
    assert_eq!(value("7.9 DIV 2"), 3.0);
    assert_eq!(value("-7 MOD 4"), -3.0);
    assert_eq!(alarm("R1=R2 MOD 2\nM30").number, 12150, "MOD takes INT only, R parameters are REAL");
    for zero in ["1/0", "1 DIV 0", "1 MOD 0", "1.5 DIV 0"] {
        assert_eq!(alarm(&format!("R1={zero}\nM30")).number, 14051, "{zero}");
    }
    assert_eq!(alarm("R1=2147483647+1\nM30").number, 14051);
    assert_eq!(alarm("R1=1EX308*10\nM30").number, 14051);
}

#[test]
fn functions_have_their_values() {
    for (expression, expected) in [
        ("SIN(30)", 0.5),
        ("COS(60)", 0.5),
        ("TAN(45)", 1.0),
        ("ASIN(0.5)", 30.0),
        ("ACOS(0)", 90.0),
        ("ATAN2(1,0)", 90.0),
        ("SQRT(2.25)", 1.5),
        ("ABS(-3.5)", 3.5),
        ("POT(3)", 9.0),
        ("TRUNC(-2.9)", -2.0),
        ("ROUND(2.5)", 3.0),
        ("ROUND(-2.5)", -2.0),
        ("ROUNDUP(2.1)", 3.0),
        ("ROUNDUP(-2.1)", -2.0),
        ("LN(1)", 0.0),
        ("EXP(0)", 1.0),
        ("MINVAL(3,2)", 2.0),
        ("MAXVAL(3,2.5)", 3.0),
        ("BOUND(1,5,9)", 5.0),
        ("NUMBER(\" 1.5EX2 \")", 150.0),
        ("ISNUMBER(\"1.5\")", 1.0),
        ("ISNUMBER(\"NAN\")", 0.0),
        ("STRLEN(\"\u{e4}BC\")", 3.0),
        ("TOUPPER(\"abc\")==\"ABC\"", 1.0),
        ("TOLOWER(\"ABC\")==\"abc\"", 1.0),
        ("INDEX(\"ABC\",\"C\")", 2.0),
        ("INDEX(\"ABC\",'Z')", -1.0),
        ("SUBSTR(\"ABCDE\",1,2)==\"BC\"", 1.0),
        ("SUBSTR(\"ABCDE\",3)==\"DE\"", 1.0),
        ("ROUND(7.2) MOD 4", 3.0),
    ] {
        assert_eq!(value(expression), expected, "{expression}");
    }
    for wrong in
        ["SQRT(-1)", "ASIN(2)", "ACOS(-1.1)", "LN(0)", "BOUND(5,1,3)", "NUMBER(\"A\")", "SUBSTR(\"A\",-1)", "ABS()"]
    {
        assert_eq!(alarm(&format!("R1={wrong}\nM30")).number, 14020, "{wrong}");
    }
    assert_eq!(alarm("R1=SIN(\"A\")\nM30").number, 12150);
}

#[test]
fn values_join_to_texts() {
    let text = "DEF STRING[30] TEXT\nDEF BOOL YES=TRUE\nTEXT=\"R=\"<<1.50<<\" \"<<7<<\" \"<<YES<<\" \"<<X<<'H41'\n\
                R1=TEXT==\"R=1.5 7 TRUE X65\"\nM30";
    assert_eq!(r(text, 1), [1.0]);
    // Without a left side, `<<` makes a text; a CHAR compares with a text.
    assert_eq!(r("DEF CHAR AB=\"Z\"\nR1=<<5.0==\"5\" R2=AB==\"Z\" R3=\"z\"==AB\nM30", 3), [1.0, 1.0, 0.0]);
}

#[test]
fn variables_have_types_dimensions_and_initial_values() {
    let text = "DEF INT WHOLE=2.5, OTHER\nDEF REAL FIELD[2,2]=SET(1,2,3),CUBE[2,2,2]=REP(7)\nDEF BOOL YES=5\nDEF CHAR LETTER=\"A\"\n\
                DEF AXIS SLIDE=Y\nDEF INT OLD[3]=(4,5)\n\
                R1=WHOLE R2=OTHER R3=FIELD[1,0] R4=FIELD[1,1] R5=CUBE[1,1,1] R6=YES R7=LETTER R8=OLD[1]\n\
                FIELD[0,R10+1]=42\nR9=FIELD[0,1]\nG0 AX[SLIDE]=5\nM30";
    let mut channel = Channel::new().with("PART.MPF", text);
    let (blocks, alarm) = run_in(&mut channel);
    assert_eq!(alarm, None);
    assert_eq!(channel.r[1..=9], [3.0, 0.0, 3.0, 0.0, 7.0, 1.0, 65.0, 5.0, 42.0]);
    assert_eq!(path(&blocks), "Y5");
}

#[test]
fn types_do_not_mix() {
    for text in [
        "DEF STRING[5] AB\nAB=1",
        "DEF AXIS AB\nAB=1",
        "DEF INT AB\nAB=\"A\"",
        "DEF INT AB\nAB=X",
        "R1=X+1",
        "R1=X<Y",
        "R1=NOT \"A\"",
        "R1=1 B_AND 1.5",
        "IF \"A\"\nENDIF",
    ] {
        assert_eq!(alarm(&format!("{text}\nM30")).number, 12150, "{text}");
    }
    assert_eq!(alarm("DEF STRING[2] AB\nAB=\"ABC\"\nM30").number, 12160);
    assert_eq!(alarm("DEF CHAR AB=256\nM30").number, 12160);
    assert_eq!(r("R1=X<>Y R2=X==X\nM30", 2), [1.0, 1.0]);
}

#[test]
fn r_parameters_have_indices() {
    assert_eq!(r("R1=2 R[R1]=7 R3=R[R1]+R2\nM30", 3), [2.0, 7.0, 14.0]);
    let mut channel = Channel::new().with("PART.MPF", "R99=1\nR0=2\nM30");
    assert_eq!(run_in(&mut channel).1, None);
    assert_eq!((channel.r[99], channel.r[0]), (1.0, 2.0));
    for wrong in ["R100=1", "R[-1]=1", "R1=R[100]"] {
        assert_eq!(alarm(&format!("{wrong}\nM30")).number, 17020, "{wrong}");
    }
}

#[test]
fn system_variables_belong_to_the_channel() {
    let mut channel = Channel::new().with("PART.MPF", "R1=$AA_IM[X]\n$MC_LIMIT=7 R2=$MC_LIMIT\nM30");
    assert_eq!(run_in(&mut channel).1, None);
    assert_eq!(channel.r[1..3], [12.5, 7.0]);
    assert_eq!(r("R5=3\nR1=$R[5]\n$R[2]=9\nM30", 2), [3.0, 9.0]);
}

#[test]
fn expressions_are_possible_in_every_word() {
    let blocks = run("R1=5\nG=R1-5 X=R1*2 Y=-R1 F=100*R1 M=R1+2\nM30");
    assert_eq!((path(&blocks).as_str(), blocks[0].feed, blocks[0].modal.index(1)), ("X10 Y-5", Some(500.0), 1));
}

#[test]
fn long_and_deep_expressions_end_with_an_alarm() {
    let long = format!("R1=1{}\nM30", "+1".repeat(1000));
    let minus = format!("R1={}1\nM30", "-".repeat(10_000));
    let deep = format!("R1={}1\nM30", "(".repeat(10_000));
    for text in [long, minus, deep] {
        assert_eq!(alarm(&text).number, 14050);
    }
    assert_eq!(r(&format!("R1=1{}\nM30", "+1".repeat(90)), 1), [91.0]);
}
