//! Built-in blocks.

use super::{Plc, SECOND, ob1, program};

fn plc(blocks: &str, statements: &str) -> Plc {
    Plc::new(&format!("{blocks}\n{}", ob1(statements)))
}

#[test]
fn blkmov_and_fill_copy_the_smaller_length() {
    let mut moved = plc(
        "",
        "CALL SFC 20 ( SRCBLK := P#M 20.0 BYTE 4, RET_VAL := MW 0, DSTBLK := P#DB10.DBX 2.0 BYTE 8 ); A BR; = M 2.0;",
    );
    moved.memory.flags[20..26].copy_from_slice(&[1, 2, 3, 4, 5, 6]);
    moved.scan();
    assert_eq!(&moved.memory.data(10).unwrap()[..8], [0, 0, 1, 2, 3, 4, 0, 0]);
    assert_eq!((moved.word(0), moved.bit(2, 0)), (0, true));
    let mut filled =
        plc("", "L W#16#AB12; T MW 20; CALL SFC 21 ( BVAL := MW 20, RET_VAL := MW 0, BLK := P#M 30.0 BYTE 5 );");
    filled.scan();
    assert_eq!(&filled.memory.flags[29..36], [0, 0xAB, 0x12, 0xAB, 0x12, 0xAB, 0]);
    // Beyond the end of DB10: an error of parameter 3, area length when writing.
    let mut beyond = plc(
        "",
        "CALL SFC 20 ( SRCBLK := P#M 20.0 BYTE 4, RET_VAL := MW 0, DSTBLK := P#DB10.DBX 30.0 BYTE 4 ); A BR; = M 2.0;",
    );
    beyond.scan();
    assert_eq!((beyond.word(0), beyond.bit(2, 0)), (0x8323, false));
    let mut missing = plc("", "CALL SFC 20 ( SRCBLK := P#DB99.DBX 0.0 BYTE 4, RET_VAL := MW 0, DSTBLK := MD 30 );");
    missing.scan();
    assert_eq!(missing.word(0), 0x813A);
}

#[test]
fn consistent_data_are_those_of_the_peripheral_area() {
    let mut plc = plc(
        "",
        "CALL SFC 14 ( LADDR := W#16#10, RET_VAL := MW 0, RECORD := P#M 20.0 BYTE 3 ); \
         CALL SFC 15 ( LADDR := W#16#20, RECORD := P#M 20.0 BYTE 3, RET_VAL := MW 2 ); \
         CALL SFC 14 ( LADDR := W#16#FFF0, RET_VAL := MW 4, RECORD := P#M 20.0 BYTE 3 );",
    );
    plc.memory.inputs[16..19].copy_from_slice(&[7, 8, 9]);
    plc.scan();
    assert_eq!(&plc.memory.flags[20..23], [7, 8, 9]);
    assert_eq!(&plc.memory.outputs[32..35], [7, 8, 9]);
    assert_eq!((plc.word(0), plc.word(2), plc.word(4)), (0, 0, 0x80A0));
}

#[test]
fn the_clock_is_virtual_and_can_be_set() {
    let block = "DATA_BLOCK DB 20\nSTRUCT\nnow : DATE_AND_TIME;\nset : DATE_AND_TIME := DT#2008-2-29-23:59:59.500;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK";
    let mut plc = plc(
        block,
        "A M 0.0; JCN a; CALL SFC 0 ( PDT := DB20.set, RET_VAL := MW 2 ); a: NOP 0; CALL SFC 1 ( RET_VAL := MW 4, CDT := DB20.now ); \
         CALL SFC 64 ( RET_VAL := MD 8 );",
    );
    plc.after(1_500 * 1_000_000);
    // 1 January 2024 was a Monday: 2.
    assert_eq!(&plc.memory.data(20).unwrap()[..8], [0x24, 0x01, 0x01, 0, 0, 0x01, 0x50, 0x02]);
    assert_eq!(plc.double(8), 1500);
    plc.set_bit(0, 0, true).after(SECOND);
    plc.set_bit(0, 0, false).after(SECOND);
    // 1 s after the set time: 1 March 2008, a Saturday: 7.
    assert_eq!(&plc.memory.data(20).unwrap()[..8], [0x08, 0x03, 0x01, 0, 0, 0, 0x50, 0x07]);
    assert_eq!(plc.double(8), 3500);
}

#[test]
fn interrupts_are_delayed_disabled_and_start_information_is_read() {
    let block = "DATA_BLOCK DB 20\nSTRUCT\ntop : ARRAY [1 .. 20] OF BYTE;\nstart : ARRAY [1 .. 20] OF BYTE;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n\
        ORGANIZATION_BLOCK OB 35\nBEGIN\nL MW 20; + 1; T MW 20;\nEND_ORGANIZATION_BLOCK";
    let mut plc = plc(
        block,
        "CALL SFC 41 ( RET_VAL := MW 0 ); CALL SFC 41 ( RET_VAL := MW 2 ); CALL SFC 42 ( RET_VAL := MW 4 ); CALL SFC 42 ( RET_VAL := MW 6 ); \
         CALL SFC 42 ( RET_VAL := MW 8 ); CALL SFC 6 ( RET_VAL := MW 10, TOP_SI := DB20.top, START_UP_SI := DB20.start ); CALL SFC 47 ( WT := 100 ); \
         A M 30.0; JCN a; CALL SFC 39 ( MODE := B#16#0, OB_NR := 0, RET_VAL := MW 12 ); a: A M 30.1; JCN b; \
         CALL SFC 40 ( MODE := B#16#2, OB_NR := 35, RET_VAL := MW 12 ); b: NOP 0;",
    );
    plc.scan();
    assert_eq!([0, 2, 4, 6, 8, 10].map(|byte| plc.word(byte)), [1, 2, 1, 0, 0x8080, 0]);
    let data = plc.memory.data(20).unwrap();
    assert_eq!((&data[..4], &data[20..24]), (&[0x11, 1, 1, 1][..], &[0x13, 0x82, 27, 100][..]));
    plc.after(SECOND / 10);
    assert_eq!(plc.word(20), 1);
    plc.set_bit(30, 0, true).scan();
    plc.set_bit(30, 0, false).after(SECOND / 10);
    assert_eq!(plc.word(20), 1);
    plc.set_bit(30, 1, true).scan();
    plc.after(SECOND / 10);
    assert_eq!(plc.word(20), 2);
}

const TIMERS: &str = "DATA_BLOCK DB 20\nSFB 3\nBEGIN\nEND_DATA_BLOCK\nDATA_BLOCK DB 21\nSFB 4\nBEGIN\nEND_DATA_BLOCK\nDATA_BLOCK DB 22\nSFB 5\nBEGIN\nEND_DATA_BLOCK";

#[test]
fn iec_timers_take_their_courses() {
    let mut plc = plc(
        TIMERS,
        "CALL SFB 3, DB 20 ( IN := M 0.0, PT := T#300MS, Q := M 1.0, ET := MD 4 ); CALL SFB 4, DB 21 ( IN := M 0.0, PT := T#300MS, Q := M 1.1, ET := MD 8 ); \
         CALL SFB 5, DB 22 ( IN := M 0.0, PT := T#300MS, Q := M 1.2, ET := MD 12 );",
    );
    let mut course = |inputs: &str| {
        inputs
            .chars()
            .map(|letter| {
                plc.set_bit(0, 0, letter == '1').after(SECOND / 10);
                (plc.memory.flags[1], plc.double(4), plc.double(8), plc.double(12))
            })
            .collect::<Vec<_>>()
    };
    // TP 1, TON 2, TOF 4.
    let found = course("0111110000");
    let states: Vec<u8> = found.iter().map(|row| row.0).collect();
    assert_eq!(states, [0, 5, 5, 5, 6, 6, 4, 4, 4, 0]);
    let elapsed: Vec<_> = found.iter().map(|row| (row.1, row.2, row.3)).collect();
    assert_eq!(
        elapsed,
        [
            (0, 0, 0),
            (0, 0, 0),
            (100, 100, 0),
            (200, 200, 0),
            (300, 300, 0),
            (300, 300, 0),
            (0, 0, 0),
            (0, 0, 100),
            (0, 0, 200),
            (0, 0, 300)
        ]
    );
    // A short input: the pulse has its full length, the on delay never comes.
    assert_eq!(course("10000").iter().map(|row| row.0).collect::<Vec<_>>(), [5, 5, 5, 4, 0]);
}

#[test]
fn iec_counters_count_edges() {
    let blocks = "DATA_BLOCK DB 20\nSFB 2\nBEGIN\nEND_DATA_BLOCK\nDATA_BLOCK DB 21\nSFB 0\nBEGIN\nEND_DATA_BLOCK\nDATA_BLOCK DB 22\nSFB 1\nBEGIN\nEND_DATA_BLOCK";
    let mut plc = plc(
        blocks,
        "CALL SFB 2, DB 20 ( CU := M 0.0, CD := M 0.1, R := M 0.2, LOAD := M 0.3, PV := 2, QU := M 1.0, QD := M 1.1, CV := MW 2 ); \
         CALL SFB 0, DB 21 ( CU := M 0.0, R := M 0.2, PV := 2, Q := M 1.2, CV := MW 4 ); \
         CALL SFB 1, DB 22 ( CD := M 0.1, LOAD := M 0.3, PV := 2, Q := M 1.3, CV := MW 6 );",
    );
    let mut after = |bits: u8| {
        plc.memory.flags[0] = bits;
        plc.scan();
        (plc.memory.flags[1], plc.word(2), plc.word(4), plc.word(6))
    };
    assert_eq!(after(0), (0b1010, 0, 0, 0));
    assert_eq!(after(1), (0b1000, 1, 1, 0));
    assert_eq!(after(1), (0b1000, 1, 1, 0));
    after(0);
    assert_eq!(after(1), (0b1101, 2, 2, 0));
    // CTD goes below 0.
    assert_eq!(after(2), (0b1100, 1, 2, 0xFFFF));
    assert_eq!(after(8), (0b0101, 2, 2, 2));
    // R wins.
    assert_eq!(after(0b1100), (0b0010, 0, 0, 2));
}

#[test]
fn library_functions_are_found_by_their_names() {
    let library = "FUNCTION FC 133 : TIME\nNAME : S5TI_TIM\nVAR_INPUT\nIN : S5TIME;\nEND_VAR\nBEGIN\nEND_FUNCTION\n\
        FUNCTION FC 140 : S5TIME\nNAME : TIM_S5TI\nVAR_INPUT\nIN : TIME;\nEND_VAR\nBEGIN\nEND_FUNCTION\n\
        FUNCTION FC 105 : WORD\nNAME : SCALE\nVAR_INPUT\nIN : INT;\nHI_LIM : REAL;\nLO_LIM : REAL;\nBIPOLAR : BOOL;\nEND_VAR\nVAR_OUTPUT\nOUT : REAL;\nEND_VAR\nBEGIN\nEND_FUNCTION\n\
        FUNCTION FC 122 : ANY\nNAME : LIMIT\nVAR_INPUT\nMN : ANY;\nIN : ANY;\nMX : ANY;\nEND_VAR\nBEGIN\nEND_FUNCTION\n\
        FUNCTION FC 116 : STRING\nNAME : I_STRNG\nVAR_INPUT\nI : INT;\nEND_VAR\nBEGIN\nEND_FUNCTION\n\
        FUNCTION FC 138 : INT\nNAME : STRNG_I\nVAR_INPUT\nS : STRING;\nEND_VAR\nBEGIN\nEND_FUNCTION\n\
        DATA_BLOCK DB 20\nSTRUCT\na : INT := 1;\nb : INT := 9;\nc : INT := 5;\nd : INT;\ns : STRING [6];\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK";
    let mut plc = plc(
        library,
        "CALL FC 133 ( IN := S5T#12S340MS, RET_VAL := MD 0 ); CALL FC 140 ( IN := T#12S345MS, RET_VAL := MW 4 ); \
         CALL FC 105 ( IN := 13824, HI_LIM := 100.0, LO_LIM := 0.0, BIPOLAR := M 255.0, RET_VAL := MW 6, OUT := MD 8 ); \
         CALL FC 105 ( IN := 30000, HI_LIM := 100.0, LO_LIM := 0.0, BIPOLAR := M 255.0, RET_VAL := MW 12, OUT := MD 14 ); A BR; = M 18.0; \
         CALL FC 122 ( MN := DB20.a, IN := DB20.b, MX := DB20.c, RET_VAL := DB20.d ); \
         CALL FC 116 ( I := -123, RET_VAL := DB20.s ); CALL FC 138 ( S := DB20.s, RET_VAL := MW 20 );",
    );
    plc.scan();
    // 12.3 s: the base of 100 ms cuts the rest.
    assert_eq!((plc.double(0), plc.word(4)), (12_300, 0x1123));
    // Half of 27648.
    assert_eq!((plc.word(6), f32::from_bits(plc.double(8))), (0, 50.0));
    assert_eq!((plc.word(12), f32::from_bits(plc.double(14)), plc.bit(18, 0)), (8, 100.0, false));
    let data = plc.memory.data(20).unwrap();
    assert_eq!((data[7], &data[8..14]), (5, &[6, 4, b'-', b'1', b'2', b'3'][..]));
    assert_eq!(plc.word(20), 0xFF85);
}

/// `FUNCTION FC n : type, NAME : name, VAR_INPUT …` of a library, without statements.
fn declared(number: u16, name: &str, result: &str, inputs: &str) -> String {
    format!("FUNCTION FC {number} : {result}\nNAME : {name}\nVAR_INPUT\n{inputs}\nEND_VAR\nBEGIN\nEND_FUNCTION\n")
}

/// Texts in DB20: a is "ABCDE", b is "CD", r has room for 8 letters. Each call with the text and the BR that it gives.
#[test]
fn functions_on_texts_cut_join_and_find() {
    let two = "IN1 : STRING; IN2 : STRING;";
    let cases: [(&str, &str, &str, &str, &str, bool); 20] = [
        ("LEFT", "IN : STRING; L : INT;", "IN := DB20.a, L := 2", "STRING", "AB", true),
        ("LEFT", "IN : STRING; L : INT;", "IN := DB20.a, L := 9", "STRING", "ABCDE", true),
        ("LEFT", "IN : STRING; L : INT;", "IN := DB20.a, L := -1", "STRING", "", false),
        ("RIGHT", "IN : STRING; L : INT;", "IN := DB20.a, L := 2", "STRING", "DE", true),
        ("MID", "IN : STRING; L : INT; P : INT;", "IN := DB20.a, L := 2, P := 3", "STRING", "CD", true),
        ("MID", "IN : STRING; L : INT; P : INT;", "IN := DB20.a, L := 9, P := 5", "STRING", "E", true),
        ("MID", "IN : STRING; L : INT; P : INT;", "IN := DB20.a, L := 1, P := 6", "STRING", "", false),
        ("MID", "IN : STRING; L : INT; P : INT;", "IN := DB20.a, L := 0, P := 1", "STRING", "", false),
        ("CONCAT", two, "IN1 := DB20.b, IN2 := DB20.a", "STRING", "CDABCDE", true),
        ("CONCAT", two, "IN1 := DB20.a, IN2 := DB20.a", "STRING", "ABCDEABC", false),
        (
            "INSERT",
            "IN1 : STRING; IN2 : STRING; P : INT;",
            "IN1 := DB20.a, IN2 := DB20.b, P := 1",
            "STRING",
            "ACDBCDE",
            true,
        ),
        (
            "INSERT",
            "IN1 : STRING; IN2 : STRING; P : INT;",
            "IN1 := DB20.a, IN2 := DB20.b, P := 0",
            "STRING",
            "CDABCDE",
            true,
        ),
        (
            "INSERT",
            "IN1 : STRING; IN2 : STRING; P : INT;",
            "IN1 := DB20.a, IN2 := DB20.b, P := 9",
            "STRING",
            "ABCDECD",
            true,
        ),
        ("DELETE", "IN : STRING; L : INT; P : INT;", "IN := DB20.a, L := 2, P := 2", "STRING", "ADE", true),
        ("DELETE", "IN : STRING; L : INT; P : INT;", "IN := DB20.a, L := 9, P := 4", "STRING", "ABC", true),
        ("DELETE", "IN : STRING; L : INT; P : INT;", "IN := DB20.a, L := 0, P := 4", "STRING", "ABCDE", true),
        (
            "REPLACE",
            "IN1 : STRING; IN2 : STRING; L : INT; P : INT;",
            "IN1 := DB20.a, IN2 := DB20.b, L := 3, P := 2",
            "STRING",
            "ACDE",
            true,
        ),
        (
            "REPLACE",
            "IN1 : STRING; IN2 : STRING; L : INT; P : INT;",
            "IN1 := DB20.a, IN2 := DB20.b, L := 1, P := 9",
            "STRING",
            "ABCDECD",
            true,
        ),
        (
            "REPLACE",
            "IN1 : STRING; IN2 : STRING; L : INT; P : INT;",
            "IN1 := DB20.a, IN2 := DB20.b, L := -1, P := 1",
            "STRING",
            "",
            false,
        ),
        ("CONCAT", two, "IN1 := DB20.e, IN2 := DB20.e", "STRING", "", true),
    ];
    for (name, inputs, call, result, wanted, br) in cases {
        let blocks = declared(100, name, result, inputs) + TEXTS;
        let mut plc = plc(&blocks, &format!("CALL FC 100 ( {call}, RET_VAL := DB20.r ); A BR; = M 0.0;"));
        plc.scan();
        let data = plc.memory.data(20).unwrap();
        let at = data.len() - 10;
        let length = usize::from(data[at + 1]);
        assert_eq!(std::str::from_utf8(&data[at + 2..at + 2 + length]), Ok(wanted), "{name} {call}");
        assert_eq!(plc.bit(0, 0), br, "{name} {call}");
    }
}

const TEXTS: &str = "DATA_BLOCK DB 20\nSTRUCT\na : STRING [6] := 'ABCDE';\nb : STRING [4] := 'CD';\ne : STRING [4];\n\
    early : DATE_AND_TIME := DT#99-12-31-23:59:59.000;\nlate : DATE_AND_TIME := DT#00-1-1-0:0:1.500;\nd : DATE_AND_TIME;\nr : STRING [8];\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n";

#[test]
fn texts_and_dates_are_compared_and_counted() {
    let two = |name: &str| {
        declared(
            100,
            name,
            "BOOL",
            if name.ends_with("DT") {
                "DT1 : DATE_AND_TIME; DT2 : DATE_AND_TIME;"
            } else {
                "S1 : STRING; S2 : STRING;"
            },
        )
    };
    for (name, less, equal, greater) in [
        ("EQ", false, true, false),
        ("NE", true, false, true),
        ("GT", false, false, true),
        ("GE", false, true, true),
        ("LT", true, false, false),
        ("LE", true, true, false),
    ] {
        for (kind, [one, other], parameters) in
            [("STRNG", ["DB20.a", "DB20.b"], ["S1", "S2"]), ("DT", ["DB20.early", "DB20.late"], ["DT1", "DT2"])]
        {
            let call = |x: &str, y: &str, bit: u8| {
                format!("CALL FC 100 ( {} := {x}, {} := {y}, RET_VAL := M 0.{bit} );", parameters[0], parameters[1])
            };
            let mut plc = plc(
                &(two(&format!("{name}_{kind}")) + TEXTS),
                &[call(one, other, 0), call(one, one, 1), call(other, one, 2)].concat(),
            );
            plc.scan();
            assert_eq!([0, 1, 2].map(|bit| plc.bit(0, bit)), [less, equal, greater], "{name}_{kind}");
        }
    }
    let blocks = declared(100, "LEN", "INT", "S : STRING;")
        + &declared(101, "FIND", "INT", "IN1 : STRING; IN2 : STRING;")
        + &declared(102, "SB_DT_DT", "TIME", "DT1 : DATE_AND_TIME; DT2 : DATE_AND_TIME;")
        + &declared(103, "AD_DT_TM", "DATE_AND_TIME", "T : DATE_AND_TIME; D : TIME;")
        + TEXTS;
    let mut plc = plc(
        &blocks,
        "CALL FC 100 ( S := DB20.a, RET_VAL := MW 0 ); CALL FC 101 ( IN1 := DB20.a, IN2 := DB20.b, RET_VAL := MW 2 ); \
        CALL FC 101 ( IN1 := DB20.b, IN2 := DB20.a, RET_VAL := MW 4 ); CALL FC 102 ( DT1 := DB20.late, DT2 := DB20.early, RET_VAL := MD 8 ); \
        CALL FC 103 ( T := DB20.early, D := T#2S500MS, RET_VAL := DB20.d );",
    );
    plc.scan();
    // From 23:59:59.000 to 0:00:01.500 are 2.5 s.
    assert_eq!((plc.word(0), plc.word(2), plc.word(4), plc.double(8)), (5, 3, 0, 2500));
    let data = plc.memory.data(20).unwrap();
    // r has 10 bytes, before it d, before it late: 2000-1-1 was a Saturday (7).
    let (late, d) = (&data[data.len() - 26..data.len() - 18], &data[data.len() - 18..data.len() - 10]);
    assert_eq!((late, d), (&[0, 1, 1, 0, 0, 1, 0x50, 0x07][..], &[0, 1, 1, 0, 0, 1, 0x50, 0x07][..]));
}

#[test]
fn bits_are_counted_encoded_and_decoded_and_one_of_two_is_selected() {
    let blocks = declared(100, "BITSUM", "INT", "IN : DWORD;")
        + &declared(101, "ENCO", "INT", "IN : DWORD;")
        + &declared(102, "DECO", "DWORD", "IN : WORD;")
        + &declared(103, "SEL", "ANY", "G : BOOL; IN0 : ANY; IN1 : ANY;")
        + "DATA_BLOCK DB 20\nSTRUCT\na : INT := 1; b : INT := 2; c : INT; d : INT;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n";
    let mut plc = plc(
        &blocks,
        "CALL FC 100 ( IN := DW#16#F0000101, RET_VAL := MW 0 ); CALL FC 101 ( IN := DW#16#80000100, RET_VAL := MW 2 ); \
        CALL FC 102 ( IN := W#16#21, RET_VAL := MD 4 ); CALL FC 103 ( G := M 255.0, IN0 := DB20.a, IN1 := DB20.b, RET_VAL := DB20.c ); \
        SET; = M 255.1; CALL FC 103 ( G := M 255.1, IN0 := DB20.a, IN1 := DB20.b, RET_VAL := DB20.d );",
    );
    plc.scan();
    // Bit 33 is bit 1 of 32.
    assert_eq!((plc.word(0), plc.word(2), plc.double(4)), (6, 8, 2));
    assert_eq!(&plc.memory.data(20).unwrap()[4..], [0, 1, 0, 2]);
}

#[test]
fn data_blocks_are_tested_and_modules_do_not_exist() {
    let mut plc = plc(
        "DATA_BLOCK DB 20\nSTRUCT\na : ARRAY [0 .. 2] OF INT;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n",
        "\
        CALL SFC 24 ( DB_NUMBER := W#16#14, RET_VAL := MW 0, DB_LENGTH := MW 2, WRITE_PROT := M 4.0 ); \
        CALL SFC 24 ( DB_NUMBER := W#16#63, RET_VAL := MW 6, DB_LENGTH := MW 8, WRITE_PROT := M 4.1 ); \
        SET; = M 4.2; CALL SFC 59 ( REQ := M 4.2, IOID := B#16#54, LADDR := W#16#100, RECNUM := B#16#1, RET_VAL := MW 10, BUSY := M 4.2, RECORD := P#M 20.0 BYTE 4 ); \
        CALL SFC 18 ( SIG := M 4.0, ID := W#16#EEEE, EV_ID := DW#16#1, SD := P#M 20.0 BYTE 4, RET_VAL := MW 12 );",
    );
    plc.memory.flags[13] = 1;
    plc.scan();
    assert_eq!([0, 2, 6, 8, 10, 12].map(|byte| plc.word(byte)), [0, 6, 0x80B1, 0, 0x8090, 0]);
    assert!(!plc.bit(4, 2));
}

#[test]
fn a_block_of_the_sources_with_statements_stays() {
    let text = "FUNCTION FC 1 : INT\nNAME : LIMIT\nBEGIN\nL 3; T #RET_VAL;\nEND_FUNCTION\n";
    let program = program(&format!("{text}{}", ob1("CALL FC 1 ( RET_VAL := MW 0 );")));
    assert_eq!(program.code_blocks().count(), 2);
}

/// R_STRNG: sign, one digit, seven decimals, two digits of the exponent; STRNG_R reads it again.
#[test]
fn reals_become_texts_and_texts_reals() {
    let blocks = "FUNCTION FC 130 : STRING\nNAME : R_STRNG\nVAR_INPUT\nIN : REAL;\nEND_VAR\nBEGIN\nEND_FUNCTION\n\
        FUNCTION FC 139 : REAL\nNAME : STRNG_R\nVAR_INPUT\nS : STRING;\nEND_VAR\nBEGIN\nEND_FUNCTION\n\
        DATA_BLOCK DB 20\nSTRUCT\nt : STRING [14];\ns : STRING [5];\nbad : STRING [14] := '1.5X';\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK";
    let mut plc = plc(
        blocks,
        "CALL FC 130 ( IN := MD 20, RET_VAL := DB20.t ); A BR; = M 0.0; CALL FC 139 ( S := DB20.t, RET_VAL := MD 24 ); A BR; = M 0.1; \
         CALL FC 130 ( IN := MD 20, RET_VAL := DB20.s ); A BR; = M 0.2; CALL FC 139 ( S := DB20.bad, RET_VAL := MD 28 ); A BR; = M 0.3;",
    );
    for (value, text) in
        [(1.5_f32, "+1.5000000E+00"), (-0.012, "-1.2000000E-02"), (0.0, "+0.0000000E+00"), (65_536.0, "+6.5536000E+04")]
    {
        plc.memory.flags[20..24].copy_from_slice(&value.to_bits().to_be_bytes());
        plc.scan();
        let data = plc.memory.data(20).unwrap();
        assert_eq!((data[1], std::str::from_utf8(&data[2..16]).unwrap()), (14, text));
        // The text of seven decimals is exact for these values.
        assert_eq!(plc.double(24), value.to_bits());
        // Five letters are too few, and `X` is no number.
        assert_eq!((plc.memory.flags[0] & 0xF, data[17], plc.double(28)), (0b0011, 0, 0));
    }
    plc.memory.flags[20..24].copy_from_slice(&f32::NAN.to_bits().to_be_bytes());
    plc.scan();
    assert_eq!((plc.memory.flags[0] & 1, plc.memory.data(20).unwrap()[1]), (0, 0));
}
