//! The state is data: saved, restored and copied interpreters continue the same. A long program needs little memory.

use super::{Channel, interpreter};
use crate::nc_program::{Interpreter, Prepared};

const PROGRAM: &str = "DEF INT COUNT\nDEF REAL LIST[2]\nFOR COUNT=1 TO 3\nSUB(COUNT,LIST[1]) P2\nAB: G1 F100 X=COUNT\nENDFOR\n\
                       REPEATB AB P=2\nID=1 WHEN $AA_IM[X]>5 DO M20\nTRANS X5\nG4 F1\nM30";
const SUB: &str =
    "PROC SUB(INT GIVEN, VAR REAL BACK) SAVE\nG91\nWHILE BACK<GIVEN\nBACK=BACK+1\nX=BACK F5\nENDWHILE\nM17";

fn channel() -> Channel {
    Channel::new().with("PART.MPF", PROGRAM).with("SUB.SPF", SUB)
}

fn rest(interpreter: &mut Interpreter, channel: &mut Channel) -> Vec<Prepared> {
    let mut rest = Vec::new();
    while !interpreter.has_ended() {
        rest.push(interpreter.step(channel).unwrap());
    }
    rest
}

#[test]
fn a_saved_and_a_copied_interpreter_continue_the_same() {
    let all = rest(&mut interpreter(), &mut channel());
    assert!(all.len() > 40, "{}", all.len());
    let (mut original, mut at) = (interpreter(), channel());
    for step in 0..all.len() {
        let mut copy = original.clone();
        let bytes = postcard::to_stdvec(&original).unwrap();
        let mut restored: Interpreter = postcard::from_bytes(&bytes).unwrap();
        assert_eq!(restored, copy);
        assert_eq!(rest(&mut copy, &mut channel()), all[step..], "copied after {step}");
        assert_eq!(rest(&mut restored, &mut channel()), all[step..], "restored after {step}");
        let prepared = original.step(&mut at).unwrap();
        assert_eq!(prepared, all[step]);
        let bytes = postcard::to_stdvec(&prepared).unwrap();
        assert_eq!(postcard::from_bytes::<Prepared>(&bytes).unwrap(), prepared);
    }
}

#[test]
fn a_long_program_is_read_block_by_block() {
    let mut text = String::from("G1 F100\n");
    for line in 0..200_000 {
        text += &format!("N{line} X{}.5 Y-{line}\n", line % 7);
    }
    text += "M30\n";
    let mut channel = Channel::new().with("PART.MPF", &text);
    let (mut interpreter, mut blocks) = (interpreter(), 0);
    while let Prepared::Block(_) = interpreter.next(&mut channel).unwrap() {
        blocks += 1;
        assert!(blocks % 1000 != 0 || postcard::to_stdvec(&interpreter).unwrap().len() < 200);
    }
    assert_eq!(blocks, 200_002);
}
