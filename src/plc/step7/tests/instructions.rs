//! Each operation on the accumulators with the status word before and after.

use super::{registers, trial, trial_with};
use crate::plc::step7::engine::{CpuOptions, Fault, Status};

/// Statements, ACCU2, ACCU1, then ACCU1, and the status word `BR CC1 CC0 OV OS OR STA RLO /FC`: `-` is unchanged.
type Row = (&'static str, u32, u32, u32, &'static str);

/// Runs each row with a status word of zeros and of ones.
#[track_caller]
fn table(rows: &[Row]) {
    for &(statements, accu2, accu1, wanted, pattern) in rows {
        for before in [0_u16, 0x1FF] {
            let (done, after, _) = trial(statements, registers(accu2, accu1, before));
            assert_eq!(done, Ok(()), "{statements}");
            assert_eq!(after.accu[0], wanted, "{statements}: ACCU1 {:08X}, not {wanted:08X}", after.accu[0]);
            let letters: Vec<char> = pattern.chars().filter(|letter| *letter != ' ').collect();
            assert_eq!(letters.len(), 9, "{statements}");
            let status = after.status.word();
            for (place, letter) in letters.into_iter().rev().enumerate() {
                let found = status >> place & 1;
                let wanted = match letter {
                    '0' => 0,
                    '1' => 1,
                    _ => before >> place & 1,
                };
                assert_eq!(found, wanted, "{statements} from {before:09b}: {status:09b}, not {pattern}");
            }
        }
    }
}

fn f(value: f32) -> u32 {
    value.to_bits()
}

#[test]
fn integers_of_16_bits() {
    table(&[
        // The high word of ACCU1 stays.
        ("+I;", 5, 0xABCD_0007, 0xABCD_000C, "- 1 0 0 - - - - -"),
        ("+I;", 0xFFFF, 1, 0, "- 0 0 0 - - - - -"),
        // 32767 + 1 = 32768, as 16 bits −32768: negative, with overflow.
        ("+I;", 0x7FFF, 1, 0x8000, "- 0 1 1 1 - - - -"),
        // −32768 + −1 = −32769, as 16 bits 32767.
        ("+I;", 0x8000, 0xFFFF, 0x7FFF, "- 1 0 1 1 - - - -"),
        ("-I;", 3, 5, 0xFFFE, "- 0 1 0 - - - - -"),
        ("-I;", 0x8000, 1, 0x7FFF, "- 1 0 1 1 - - - -"),
        // 300 × 300 = 90000, beyond 32767.
        ("*I;", 300, 300, 90_000, "- 1 0 1 1 - - - -"),
        ("*I;", 3, 0xFFFE, 0xFFFF_FFFA, "- 0 1 0 - - - - -"),
        ("*I;", 0, 5, 0, "- 0 0 0 - - - - -"),
        // −7 / 2 = −3 rest −1.
        ("/I;", 0xFFF9, 2, 0xFFFF_FFFD, "- 0 1 0 - - - - -"),
        ("/I;", 7, 2, 0x0001_0003, "- 1 0 0 - - - - -"),
        ("/I;", 1, 2, 0x0001_0000, "- 0 0 0 - - - - -"),
        ("/I;", 7, 0xABCD_0000, 0xABCD_0000, "- 1 1 1 1 - - - -"),
        // −32768 / −1 = 32768.
        ("/I;", 0x8000, 0xFFFF, 0x0000_8000, "- 1 0 1 1 - - - -"),
        ("NEGI;", 0, 0xABCD_0005, 0xABCD_FFFB, "- 0 1 0 - - - - -"),
        ("NEGI;", 0, 0x8000, 0x8000, "- 0 1 1 1 - - - -"),
        ("INVI;", 0, 0xABCD_00FF, 0xABCD_FF00, "- - - - - - - - -"),
        ("+ 5;", 9, 0xABCD_FFFF, 0xABCD_0004, "- - - - - - - - -"),
        ("+ -5;", 9, 5, 0, "- - - - - - - - -"),
        ("INC 5;", 0, 0x0000_12FE, 0x0000_1203, "- - - - - - - - -"),
        ("DEC 1;", 0, 0x0000_1200, 0x0000_12FF, "- - - - - - - - -"),
    ]);
}

#[test]
fn integers_of_32_bits() {
    table(&[
        ("+D;", 5, 7, 12, "- 1 0 0 - - - - -"),
        ("+D;", 0x7FFF_FFFF, 1, 0x8000_0000, "- 0 1 1 1 - - - -"),
        ("-D;", 5, 5, 0, "- 0 0 0 - - - - -"),
        ("-D;", 0x8000_0000, 1, 0x7FFF_FFFF, "- 1 0 1 1 - - - -"),
        // 65536 × 65536 = 2^32: the low 32 bits are 0.
        ("*D;", 0x1_0000, 0x1_0000, 0, "- 1 0 1 1 - - - -"),
        ("*D;", 0xFFFF_FFFF, 6, 0xFFFF_FFFA, "- 0 1 0 - - - - -"),
        ("/D;", 0xFFFF_FFF9, 2, 0xFFFF_FFFD, "- 0 1 0 - - - - -"),
        ("/D;", 7, 0, 0, "- 1 1 1 1 - - - -"),
        ("/D;", 0x8000_0000, 0xFFFF_FFFF, 0x8000_0000, "- 1 0 1 1 - - - -"),
        // −7 mod 3 = −1.
        ("MOD;", 0xFFFF_FFF9, 3, 0xFFFF_FFFF, "- 0 1 0 - - - - -"),
        ("MOD;", 6, 3, 0, "- 0 0 0 - - - - -"),
        ("MOD;", 6, 0, 0, "- 1 1 1 1 - - - -"),
        ("NEGD;", 0, 5, 0xFFFF_FFFB, "- 0 1 0 - - - - -"),
        ("NEGD;", 0, 0x8000_0000, 0x8000_0000, "- 0 1 1 1 - - - -"),
        ("INVD;", 0, 0x0000_00FF, 0xFFFF_FF00, "- - - - - - - - -"),
        ("+ L#-1;", 0, 0, 0xFFFF_FFFF, "- - - - - - - - -"),
        ("ITD;", 0, 0xABCD_8000, 0xFFFF_8000, "- - - - - - - - -"),
        ("DTR;", 0, 0xFFFF_FFFE, f(-2.0), "- - - - - - - - -"),
    ]);
}

#[test]
fn reals_keep_infinity_and_denormals() {
    table(&[
        ("+R;", f(1.5), f(2.25), f(3.75), "- 1 0 0 - - - - -"),
        ("-R;", f(1.0), f(1.0), f(0.0), "- 0 0 0 - - - - -"),
        ("-R;", f(1.0), f(3.0), f(-2.0), "- 0 1 0 - - - - -"),
        // Overflow is infinity, not the largest number.
        ("*R;", f(3e38), f(10.0), f(f32::INFINITY), "- 1 0 1 1 - - - -"),
        ("*R;", f(-3e38), f(10.0), f(f32::NEG_INFINITY), "- 0 1 1 1 - - - -"),
        ("/R;", f(1.0), f(0.0), f(f32::INFINITY), "- 1 0 1 1 - - - -"),
        // 2^−126 / 2 is denormal: 0 0 1.
        ("/R;", f(f32::MIN_POSITIVE), f(2.0), f(f32::MIN_POSITIVE / 2.0), "- 0 0 1 1 - - - -"),
        ("ABS;", 0, f(-2.5), f(2.5), "- - - - - - - - -"),
        ("NEGR;", 0, f(2.5), f(-2.5), "- - - - - - - - -"),
        ("SQR;", 0, f(-3.0), f(9.0), "- 1 0 0 - - - - -"),
        ("SQRT;", 0, f(9.0), f(3.0), "- 1 0 0 - - - - -"),
        ("EXP;", 0, f(0.0), f(1.0), "- 1 0 0 - - - - -"),
        ("LN;", 0, f(1.0), f(0.0), "- 0 0 0 - - - - -"),
        ("SIN;", 0, f(0.0), f(0.0), "- 0 0 0 - - - - -"),
        ("COS;", 0, f(0.0), f(1.0), "- 1 0 0 - - - - -"),
        ("TAN;", 0, f(0.0), f(0.0), "- 0 0 0 - - - - -"),
        ("ASIN;", 0, f(0.0), f(0.0), "- 0 0 0 - - - - -"),
        ("ACOS;", 0, f(1.0), f(0.0), "- 0 0 0 - - - - -"),
        ("ATAN;", 0, f(0.0), f(0.0), "- 0 0 0 - - - - -"),
    ]);
    for operation in ["SQRT;", "LN;", "ASIN;", "ACOS;"] {
        let (_, after, _) = trial(operation, registers(0, f(-2.0), 0));
        assert!(f32::from_bits(after.accu[0]).is_nan(), "{operation}");
        assert_eq!(after.status.word(), 0b0_1111_0000, "{operation}");
    }
    let (_, after, _) = trial("/R;", registers(f(0.0), f(0.0), 0));
    assert!(f32::from_bits(after.accu[0]).is_nan());
    assert_eq!(after.status.word(), 0b0_1111_0000);
}

#[test]
fn comparisons_overwrite_the_rlo() {
    let result = |rlo: &str, codes: &str| format!("- {codes} 0 - 0 {rlo} {rlo} 1");
    for (operation, equal, less, greater) in [
        ("==", "1", "0", "0"),
        ("<>", "0", "1", "1"),
        (">", "0", "0", "1"),
        ("<", "0", "1", "0"),
        (">=", "1", "0", "1"),
        ("<=", "1", "1", "0"),
    ] {
        for (letter, small, large) in
            [("I", 0xAAAA_FFFE_u32, 0xBBBB_0003_u32), ("D", 0xFFFF_FFFE, 3), ("R", f(-2.0), f(3.0))]
        {
            for (accu2, accu1, rlo, codes) in
                [(small, small, equal, "0 0"), (small, large, less, "0 1"), (large, small, greater, "1 0")]
            {
                let statement: &'static str = format!("{operation}{letter};").leak();
                let pattern: &'static str = result(rlo, codes).leak();
                table(&[(statement, accu2, accu1, accu1, pattern)]);
            }
        }
        let statement: &'static str = format!("{operation}R;").leak();
        table(&[(statement, f(f32::NAN), f(1.0), f(1.0), "- 1 1 1 1 0 0 0 1")]);
    }
}

#[test]
fn conversions_and_bcd() {
    table(&[
        ("BTI;", 0, 0xABCD_0915, 0xABCD_0393, "- - - - - - - - -"),
        ("BTI;", 0, 0x0000_F123, 0x0000_FF85, "- - - - - - - - -"),
        ("BTD;", 0, 0x0123_4567, 1_234_567, "- - - - - - - - -"),
        ("BTD;", 0, 0xF000_0012, 0xFFFF_FFF4, "- - - - - - - - -"),
        ("ITB;", 0, 0xABCD_018D, 0xABCD_0397, "- - - 0 - - - - -"),
        ("ITB;", 0, 0x0000_FE73, 0x0000_F397, "- - - 0 - - - - -"),
        // 1000 has four digits.
        ("ITB;", 0, 1000, 1000, "- - - 1 1 - - - -"),
        ("DTB;", 0, 9_999_999, 0x0999_9999, "- - - 0 - - - - -"),
        ("DTB;", 0, 0xFFFF_FFFF, 0xF000_0001, "- - - 0 - - - - -"),
        ("DTB;", 0, 10_000_000, 10_000_000, "- - - 1 1 - - - -"),
        ("RND;", 0, f(2.5), 2, "- - - 0 - - - - -"),
        ("RND;", 0, f(3.5), 4, "- - - 0 - - - - -"),
        ("RND;", 0, f(-2.5), 0xFFFF_FFFE, "- - - 0 - - - - -"),
        ("RND+;", 0, f(2.1), 3, "- - - 0 - - - - -"),
        ("RND+;", 0, f(-2.9), 0xFFFF_FFFE, "- - - 0 - - - - -"),
        ("RND-;", 0, f(2.9), 2, "- - - 0 - - - - -"),
        ("RND-;", 0, f(-2.1), 0xFFFF_FFFD, "- - - 0 - - - - -"),
        ("TRUNC;", 0, f(-2.9), 0xFFFF_FFFE, "- - - 0 - - - - -"),
        // 2^31 is one beyond the largest number.
        ("TRUNC;", 0, f(2_147_483_648.0), f(2_147_483_648.0), "- - - 1 1 - - - -"),
        ("RND;", 0, 0x7FC0_0000, 0x7FC0_0000, "- - - 1 1 - - - -"),
        ("CAW;", 0, 0x1122_3344, 0x1122_4433, "- - - - - - - - -"),
        ("CAD;", 0, 0x1122_3344, 0x4433_2211, "- - - - - - - - -"),
    ]);
    for statement in ["BTI;", "BTD;"] {
        let (done, after, _) = trial(statement, registers(0, 0x00A, 0));
        assert_eq!((done, after.accu[0]), (Err(Fault::BcdDigit), 0x00A));
    }
}

#[test]
fn word_logic_sets_cc1_for_a_result_that_is_not_zero() {
    table(&[
        ("AW;", 0x1234_0FF0, 0xABCD_00FF, 0xABCD_00F0, "- 1 0 0 - - - - -"),
        ("AW;", 0x1234_0F00, 0xABCD_00FF, 0xABCD_0000, "- 0 0 0 - - - - -"),
        ("OW;", 0x1234_0F00, 0xABCD_00FF, 0xABCD_0FFF, "- 1 0 0 - - - - -"),
        ("XOW;", 0x1234_00FF, 0xABCD_00FF, 0xABCD_0000, "- 0 0 0 - - - - -"),
        ("AW W#16#F;", 0, 0xABCD_00FF, 0xABCD_000F, "- 1 0 0 - - - - -"),
        ("AD;", 0xFF00_FF00, 0x1234_5678, 0x1200_5600, "- 1 0 0 - - - - -"),
        ("OD DW#16#FF;", 0, 0x1200_0000, 0x1200_00FF, "- 1 0 0 - - - - -"),
        ("XOD;", 5, 5, 0, "- 0 0 0 - - - - -"),
    ]);
}

#[test]
fn shifts_have_the_last_bit_in_cc1_and_counts_beyond_the_width() {
    table(&[
        ("SLW 4;", 0, 0xABCD_1234, 0xABCD_2340, "- 1 0 0 - - - - -"),
        ("SLW 0;", 0, 0x8001, 0x8001, "- - - - - - - - -"),
        ("SLW;", 16, 0xABCD_0001, 0xABCD_0000, "- 1 0 0 - - - - -"),
        ("SLW;", 17, 0xABCD_FFFF, 0xABCD_0000, "- 0 0 0 - - - - -"),
        ("SRW 4;", 0, 0xABCD_1238, 0xABCD_0123, "- 1 0 0 - - - - -"),
        ("SRW;", 16, 0x8000, 0, "- 1 0 0 - - - - -"),
        ("SRW;", 200, 0xFFFF, 0, "- 0 0 0 - - - - -"),
        ("SLD 1;", 0, 0x8000_0001, 2, "- 1 0 0 - - - - -"),
        ("SLD;", 32, 1, 0, "- 1 0 0 - - - - -"),
        ("SLD;", 33, 0xFFFF_FFFF, 0, "- 0 0 0 - - - - -"),
        ("SRD 1;", 0, 3, 1, "- 1 0 0 - - - - -"),
        ("SRD;", 32, 0x8000_0000, 0, "- 1 0 0 - - - - -"),
        ("SRD;", 33, 0xFFFF_FFFF, 0, "- 0 0 0 - - - - -"),
        ("SSI 4;", 0, 0xABCD_8008, 0xABCD_F800, "- 1 0 0 - - - - -"),
        ("SSI;", 99, 0xABCD_8000, 0xABCD_FFFF, "- 1 0 0 - - - - -"),
        ("SSI;", 99, 0x7FFF, 0, "- 0 0 0 - - - - -"),
        ("SSD 4;", 0, 0x8000_0000, 0xF800_0000, "- 0 0 0 - - - - -"),
        ("SSD;", 99, 0x8000_0000, 0xFFFF_FFFF, "- 1 0 0 - - - - -"),
        ("RLD 4;", 0, 0x1000_0000, 1, "- 1 0 0 - - - - -"),
        ("RRD 4;", 0, 8, 0x8000_0000, "- 1 0 0 - - - - -"),
        // ((33 − 1) mod 32) + 1 = 1.
        ("RLD;", 33, 0x8000_0000, 1, "- 1 0 0 - - - - -"),
        ("RRD;", 33, 1, 0x8000_0000, "- 1 0 0 - - - - -"),
        ("RLD;", 32, 5, 5, "- 1 0 0 - - - - -"),
        // Only the low byte of ACCU2 counts.
        ("SLW;", 0x0000_0104, 1, 0x10, "- 0 0 0 - - - - -"),
    ]);
    // RLDA and RRDA turn through CC1.
    let (_, after, _) = trial("RLDA;", registers(0, 0x8000_0000, 0));
    assert_eq!((after.accu[0], after.status.cc1), (0, true));
    let (_, after, _) = trial("RRDA;", registers(0, 2, 1 << 7));
    assert_eq!((after.accu[0], after.status.cc1), (0x8000_0001, false));
}

#[test]
fn loads_and_accumulators() {
    let (_, after, memory) = trial("L MB 10; L 2#101; T MW 4;", registers(0x22, 0x11, 0x1FF));
    assert_eq!(after.accu[..2], [5, 0]);
    assert_eq!((after.status.word(), memory.flags[5]), (0x1FF, 5));
    for (statements, two, four) in [
        ("TAK;", [2, 1, 3, 4], [2, 1, 3, 4]),
        ("PUSH;", [1, 1, 3, 4], [1, 1, 2, 3]),
        ("POP;", [2, 2, 3, 4], [2, 3, 4, 4]),
        ("+I;", [3, 2, 3, 4], [3, 3, 4, 4]),
        ("L 7;", [7, 1, 3, 4], [7, 1, 3, 4]),
        ("ENT;", [1, 2, 2, 3], [1, 2, 2, 3]),
        ("LEAVE;", [1, 3, 4, 4], [1, 3, 4, 4]),
    ] {
        let mut before = registers(2, 1, 0);
        before.accu = [1, 2, 3, 4];
        let (_, after, _) = trial(statements, before);
        assert_eq!(after.accu, two, "{statements}");
        let options = CpuOptions { has_four_accumulators: true, ..CpuOptions::default() };
        let (_, after, _) = trial_with(statements, before, options);
        assert_eq!(after.accu, four, "{statements} with four accumulators");
    }
    // An S7-300 loads neither /FC, STA nor OR.
    let (_, after, _) = trial("L STW;", registers(0, 0, 0x1FF));
    assert_eq!(after.accu[0], 0b1_1111_0010);
    let (_, after, _) = trial("T STW;", registers(0, 0xFFFF_FE55, 0));
    assert_eq!(after.status, Status::from_word(0x055));
}

#[test]
fn address_registers() {
    let mut before = registers(0, 0xFFFF, 0);
    before.ar = [0x8300_0010, 0x8400_0020];
    for (statements, wanted) in [
        ("+AR1;", [0x8300_000F, 0x8400_0020]),
        ("+AR2 P#1.1;", [0x8300_0010, 0x8400_0029]),
        ("CAR;", [0x8400_0020, 0x8300_0010]),
        ("LAR1 AR2;", [0x8400_0020, 0x8400_0020]),
        ("TAR1 AR2;", [0x8300_0010, 0x8300_0010]),
        ("LAR1;", [0x0000_FFFF, 0x8400_0020]),
        ("LAR2 P#M 12.5;", [0x8300_0010, 0x8300_0065]),
        ("L DW#16#12; T MD 0; LAR1 MD 0;", [0x12, 0x8400_0020]),
        ("TAR2 MD 0; LAR1 MD 0;", [0x8400_0020, 0x8400_0020]),
        // Only 24 bits are added: the area stays.
        ("L 0; LAR1; L -1; +AR1;", [0x00FF_FFFF, 0x8400_0020]),
    ] {
        assert_eq!(trial(statements, before).1.ar, wanted, "{statements}");
    }
    assert_eq!(trial("TAR1;", before).1.accu[0], 0x8300_0010);
}
