//! S5 timers and counters to the cycle.

use super::{Plc, SECOND};
use crate::plc::step7::engine::Fault;

/// The status and the value of T1 after each scan of 100 ms, for a course of M 0.0; M 0.1 resets, M 0.2 is FR.
fn course(operation: &str, value: &str, inputs: &str) -> Vec<(u8, u16)> {
    let text = format!(
        "A M 0.2; FR T 1; A M 0.0; L {value}; {operation} T 1; A M 0.1; R T 1; A T 1; = M 1.0; L T 1; T MW 2; LC T 1; T MW 4;"
    );
    let mut plc = Plc::of_statements(&text);
    inputs
        .chars()
        .map(|letter| {
            plc.set_bit(0, 0, matches!(letter, '1' | 'F')).set_bit(0, 1, letter == 'R').set_bit(0, 2, letter == 'F');
            if letter == 'B' {
                // Input and reset together.
                plc.set_bit(0, 0, true).set_bit(0, 1, true);
            }
            plc.after(SECOND / 10);
            (u8::from(plc.bit(1, 0)), plc.word(2))
        })
        .collect()
}

fn states(course: &[(u8, u16)]) -> String {
    course.iter().map(|(state, _)| char::from(b'0' + state)).collect()
}

#[test]
fn each_kind_of_timer_takes_its_course() {
    // 300 ms, in scans of 100 ms: over in the third scan after the start.
    for (operation, inputs, wanted) in [
        // Pulse: as long as the input, at most 300 ms.
        ("SP", "0111110", "0111000"),
        ("SP", "0110110", "0110110"),
        // Extended pulse: 300 ms, and afresh with each edge.
        ("SE", "0100000", "0111000"),
        ("SE", "0101000", "0111110"),
        // On delay: after 300 ms, while the input is on.
        ("SD", "0111110", "0000110"),
        ("SD", "0110111", "0000000"),
        // Stored on delay: after 300 ms, until reset.
        ("SS", "0100000", "0000111"),
        ("SS", "0101000", "0000001"),
        ("SS", "01000R0", "0000100"),
        // Off delay: with the input, and 300 ms after it.
        ("SF", "0110000", "0111110"),
        ("SF", "0101000", "0111111"),
    ] {
        let found = states(&course(operation, "S5T#300MS", inputs));
        assert_eq!(found, wanted, "{operation} {inputs}");
    }
}

#[test]
fn the_off_delay_ends_after_its_time() {
    assert_eq!(states(&course("SF", "S5T#300MS", "01000000")), "01111000");
}

#[test]
fn the_value_is_the_rest_rounded_up() {
    let values = |base: &str| course("SE", base, "1111111").into_iter().map(|(_, value)| value).collect::<Vec<_>>();
    assert_eq!(values("S5T#500MS"), [50, 40, 30, 20, 10, 0, 0]);
    // The base 1 s: 2 while more than 1 s is left, 1 down to the last instant.
    assert_eq!(values("W#16#2002"), [2; 7]);
    let mut plc = Plc::of_statements("A M 0.0; L S5T#20S; SE T 1; L T 1; T MW 2; LC T 1; T MW 4;");
    plc.set_bit(0, 0, true).scan();
    // 20 s = 200 × 100 ms: base 1.
    assert_eq!((plc.word(2), plc.word(4)), (200, 0x1200));
    assert_eq!(plc.after(SECOND / 20).word(2), 200);
    assert_eq!(plc.after(SECOND / 20 + 1).word(2), 199);
    assert_eq!(plc.after(19 * SECOND + 9 * SECOND / 10 - 2).word(2), 1);
    plc.after(1);
    assert_eq!((plc.word(2), plc.word(4)), (0, 0x1000));
}

#[test]
fn a_reset_timer_starts_again_with_an_edge_or_with_fr() {
    // The standing input does not start it again after R.
    assert_eq!(states(&course("SE", "S5T#300MS", "1B1101")), "100001");
    // FR forgets the edge: the standing input starts it again.
    assert_eq!(states(&course("SE", "S5T#300MS", "11111F1111")), "1110011100");
    // On delay with 0 is over at once.
    assert_eq!(states(&course("SD", "S5T#0MS", "011")), "011");
}

#[test]
fn a_timer_value_with_a_wrong_digit_is_a_fault() {
    let mut plc = Plc::of_statements("A M 0.0; L W#16#00A; SP T 1;");
    plc.scan();
    assert_eq!(plc.set_bit(0, 0, true).fault(), Fault::BcdDigit);
}

#[test]
fn a_pulse_that_stops_keeps_its_rest() {
    let course = course("SP", "S5T#500MS", "1100");
    assert_eq!(course[1], (1, 40));
    assert_eq!(course[2], (0, 30));
    assert_eq!(course[3], (0, 30));
}

#[test]
fn counters_count_edges_between_0_and_999() {
    let text = "A M 0.0; CU C 1; A M 0.1; CD C 1; A M 0.2; L C#998; S C 1; A M 0.3; R C 1; A M 0.4; FR C 1; \
                A C 1; = M 1.0; L C 1; T MW 2; LC C 1; T MW 4;";
    let mut plc = Plc::of_statements(text);
    let mut value = |bits: u8| {
        plc.memory.flags[0] = bits;
        plc.scan();
        (plc.bit(1, 0), plc.word(2), plc.word(4))
    };
    assert_eq!(value(0b00010), (false, 0, 0));
    assert_eq!(value(0b00001), (true, 1, 1));
    // A standing input does not count.
    assert_eq!(value(0b00001), (true, 1, 1));
    assert_eq!(value(0b00100), (true, 998, 0x998));
    assert_eq!(value(0b00101), (true, 999, 0x999));
    assert_eq!(value(0), (true, 999, 0x999));
    assert_eq!(value(0b00001), (true, 999, 0x999));
    assert_eq!(value(0b00010), (true, 998, 0x998));
    // FR forgets the edges: the standing inputs act in the next scan.
    assert_eq!(value(0b10010), (true, 998, 0x998));
    assert_eq!(value(0b00010), (true, 997, 0x997));
    assert_eq!(value(0b01000), (false, 0, 0));
}

#[test]
fn numbers_of_timers_come_from_memory() {
    let mut plc = Plc::of_statements("L 3; T MW 6; SET; L S5T#1S; SE T [MW 6]; A T [MW 6]; = M 1.0; A T 3; = M 1.1;");
    plc.scan();
    assert_eq!(plc.memory.flags[1], 3);
    assert_eq!(plc.cpu.timer(3, 0), Some((100, true)));
    assert_eq!(Plc::of_statements("L 99; T MW 6; A T [MW 6];").fault(), Fault::TimerNumber(99));
    assert_eq!(Plc::of_statements("L 99; T MW 6; A C [MW 6];").fault(), Fault::CounterNumber(99));
}
