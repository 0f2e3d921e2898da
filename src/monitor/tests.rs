//! Rules over a flag or two, cycle by cycle.

use super::*;
use crate::expression::{Expression, Moment, Scope, View};
use crate::image::{Location, Memory, Names};
use crate::source::Problem;
use crate::units::{AxisNumber, Time};
use crate::variables::{AlarmNumber, Describe, RaisedAlarm, Rule as ControlRule, RuleNumber, Variables};

/// A machine without a control; the flags M0.0 to M0.7 are enough here.
struct Flags(Names);

impl Describe for Flags {
    fn names(&self) -> &Names {
        &self.0
    }
    fn alarm_text(&self, _: &RaisedAlarm) -> String {
        String::new()
    }
    fn alarm_name(&self, number: AlarmNumber) -> String {
        number.0.to_string()
    }
    fn alarm_number(&self, _: &str) -> Option<AlarmNumber> {
        None
    }
    fn has_alarm(&self, _: AlarmNumber) -> bool {
        false
    }
    fn rule(&self, _: RuleNumber) -> ControlRule {
        ControlRule { id: "", text: "" }
    }
    fn datum_name(&self, number: u32) -> String {
        number.to_string()
    }
    fn is_rotary(&self, _: AxisNumber) -> bool {
        false
    }
}

impl Scope for Flags {
    fn describe(&self) -> &dyn Describe {
        self
    }
    fn signal(&self, name: &str) -> Result<Location, Problem> {
        self.0.resolve(&Memory::new(), name)
    }
}

fn expression(source: &str) -> Expression {
    Expression::parse(source, &Flags(Names::default())).unwrap()
}

/// M0.0 is followed by M0.1.
fn consequence(within: u64, not_before: u64) -> Consequence {
    let (when, then) = (expression("M0.0"), expression("M0.1"));
    let span = |cycles| if cycles == 0 { Span::NONE } else { Span::cycles(cycles) };
    let (within, not_before) = (span(within), span(not_before));
    Consequence { when, then, within, not_before, from_start: false, must_begin: false }
}

fn follows(consequence: Consequence) -> Claim {
    Claim::Follows(Box::new(consequence))
}

/// Shows a monitor one byte of flags per cycle of 2 ms, the first before the first cycle; an `x` is power on before that cycle, after which
/// cycles have 4 ms.
fn watch(claim: Claim, bytes: &str) -> (Monitor, Vec<(Reason, u64, u64)>) {
    let mut monitor = Monitor::default();
    monitor.measure();
    monitor.add(Rule { name: Some("r".to_owned()), place: None, claim, go_on: true });
    let (mut memory, variables) = (Memory::new(), Variables::default());
    let mut breaches = Vec::new();
    let (mut cycle, mut time, mut length) = (0, Time::ZERO, Time::from_millis(2));
    let report = &mut |breach: Breach| breaches.push((breach.reason, breach.began.cycle, breach.failed.cycle));
    for (index, byte) in bytes.chars().enumerate() {
        let Some(byte) = byte.to_digit(10) else {
            let memory = Memory::new();
            monitor.power_on(&View::at(Moment {
                memory: &memory,
                variables: &variables,
                time,
                named_values: &[],
                rules: &[],
            }));
            length = Time::from_millis(4);
            continue;
        };
        memory.flags.set_byte(0, u8::try_from(byte).unwrap());
        if index > 0 {
            (cycle, time) = (cycle + 1, time + length);
        }
        let now = Moment { memory: &memory, variables: &variables, time, named_values: &[], rules: &[] };
        if index == 0 {
            monitor.begin(0, &View::at(now), (cycle, length), report);
        } else {
            monitor.observe(&View::at(now), cycle, report);
        }
    }
    monitor.end(report);
    (monitor, breaches)
}

/// The point after a cycle before power on.
fn at(cycle: u64) -> Point {
    Point { cycle, time: Time::from_millis(2).times(cycle) }
}

fn breaches(claim: Claim, bytes: &str) -> Vec<(Reason, u64, u64)> {
    watch(claim, bytes).1
}

#[test]
fn a_condition_of_every_cycle_is_broken_once_per_violation() {
    use Reason::Condition;
    assert_eq!(breaches(Claim::Never(expression("M0.0")), "000000"), []);
    assert_eq!(breaches(Claim::Never(expression("M0.0")), "1001101"), [(Condition, 3, 3), (Condition, 6, 6)]);
    assert_eq!(breaches(Claim::Always(expression("M0.0")), "011011"), [(Condition, 3, 3)]);
}

#[test]
fn without_within_the_consequence_must_be_true_in_the_cycle_of_the_edge() {
    assert_eq!(breaches(follows(consequence(0, 0)), "0033"), []);
    assert_eq!(breaches(follows(consequence(0, 0)), "0012"), [(Reason::Late, 2, 2)]);
}

#[test]
fn the_last_cycle_of_within_counts_and_the_next_one_is_too_late() {
    assert_eq!(breaches(follows(consequence(3, 0)), "001113"), []);
    assert_eq!(breaches(follows(consequence(3, 0)), "0011113"), [(Reason::Late, 2, 5)]);
    let (monitor, _) = watch(follows(consequence(3, 0)), "00113");
    let summary = monitor.summaries().next().unwrap();
    assert_eq!(
        (summary.begun, summary.met, summary.margin.unwrap()),
        (1, 1, Margin { amount: 1.0, at: at(2), cycle: Time::from_millis(2) })
    );
}

#[test]
fn a_consequence_before_its_time_breaks_the_rule() {
    assert_eq!(breaches(follows(consequence(5, 2)), "00113"), []);
    assert_eq!(breaches(follows(consequence(5, 2)), "0013"), [(Reason::Early, 2, 3)]);
    assert_eq!(breaches(follows(consequence(5, 2)), "003"), [(Reason::Early, 2, 2)]);
    let margin = |bytes| watch(follows(consequence(5, 2)), bytes).0.summaries().next().unwrap().margin.unwrap().amount;
    assert_eq!([margin("001113"), margin("00111113")].map(|margin| margin.to_string()), ["1", "0"]);
}

#[test]
fn every_edge_opens_a_watch_of_its_own() {
    // Edges in cycles 1 and 3; the consequence in cycle 5 is in time for the second one only.
    assert_eq!(breaches(follows(consequence(3, 0)), "010102"), [(Reason::Late, 1, 4)]);
    let (monitor, found) = watch(follows(consequence(9, 0)), "010102");
    let summary = monitor.summaries().next().unwrap();
    assert_eq!((found.len(), summary.begun, summary.met), (0, 2, 2));
}

#[test]
fn true_before_the_first_cycle_is_an_edge_only_from_start() {
    assert_eq!(breaches(follows(consequence(2, 0)), "11111"), []);
    let from_start = || Consequence { from_start: true, ..consequence(2, 0) };
    assert_eq!(breaches(follows(from_start()), "11111"), [(Reason::Late, 0, 2)]);
    assert_eq!(breaches(follows(from_start()), "113"), []);
}

#[test]
fn power_on_closes_open_watches_and_the_end_leaves_them_open() {
    let (monitor, found) = watch(follows(consequence(3, 0)), "01x0000");
    let summary = monitor.summaries().next().unwrap();
    assert_eq!((found.len(), summary.begun, summary.closed, summary.open), (0, 1, 1, None));
    let (monitor, found) = watch(follows(consequence(9, 0)), "0101");
    assert_eq!((found.len(), monitor.summaries().next().unwrap().open), (0, Some((2, at(1)))));
}

#[test]
fn a_signal_that_the_first_cycle_after_power_on_sets_is_an_edge() {
    assert_eq!(breaches(follows(consequence(3, 0)), "01x1111"), [(Reason::Late, 2, 5)]);
    // What is true after power on, before the cycle, is no edge.
    let absence = || Consequence { when: expression("!M0.0"), ..consequence(1, 0) };
    assert_eq!(breaches(follows(absence()), "1x000"), []);
    assert_eq!(breaches(follows(absence()), "1x100"), [(Reason::Late, 2, 3)]);
}

#[test]
fn a_rule_that_must_begin_is_broken_without_an_edge() {
    let must = || Consequence { must_begin: true, ..consequence(3, 0) };
    assert_eq!(breaches(follows(must()), "0000"), [(Reason::NeverBegan, 3, 3)]);
    assert_eq!(breaches(follows(must()), "0013"), []);
    assert_eq!(breaches(follows(consequence(3, 0)), "0000"), []);
}

#[test]
fn the_margin_of_a_condition_is_the_distance_of_its_comparison() {
    let margin = |claim, bytes| watch(claim, bytes).0.summaries().next().unwrap().margin;
    let expected = |amount, cycle| Some(Margin { amount, at: at(cycle), cycle: Time::from_millis(2) });
    assert_eq!(margin(Claim::Always(expression("MB0 < 9")), "03714"), expected(2.0, 2));
    assert_eq!(margin(Claim::Never(expression("MB0 >= 8 || MB0 > 9")), "0371"), expected(1.0, 2));
    assert_eq!(margin(Claim::Always(expression("!(MB0 > 9)")), "0352"), expected(4.0, 2));
    assert_eq!(margin(Claim::Never(expression("M0.0")), "02"), None);
}

#[test]
fn a_time_is_the_time_of_the_machine_when_power_on_makes_its_cycles_longer() {
    let times = |within, not_before| Consequence {
        within: Span::time(Time::from_millis(within)),
        not_before: Span::time(Time::from_millis(not_before)),
        ..consequence(0, 0)
    };
    // 8 ms are four cycles of 2 ms before power on and two of 4 ms after it.
    assert_eq!(breaches(follows(times(8, 1)), "0011111"), [(Reason::Late, 2, 6)]);
    assert_eq!(breaches(follows(times(8, 1)), "0x01111"), [(Reason::Late, 2, 4)]);
    assert_eq!(breaches(follows(times(20, 8)), "0x013"), [(Reason::Early, 2, 3)]);
    let (monitor, found) = watch(follows(times(20, 8)), "0x01113");
    // The consequence comes 12 ms after the edge: one cycle after 8 ms, two before 20 ms.
    let margin = monitor.summaries().next().unwrap().margin.unwrap();
    assert_eq!((found.len(), margin.amount.to_string().as_str()), (0, "1"));
    assert_eq!(margin.cycle, Time::from_millis(4));
    // A margin from before power on keeps the cycle that it was counted in.
    let margin = |bytes| watch(follows(times(8, 1)), bytes).0.summaries().next().unwrap().margin.unwrap().cycle;
    assert_eq!(margin("01112x00"), Time::from_millis(2));
}

#[test]
fn the_margin_of_a_consequence_before_the_first_cycle_is_counted_in_cycles() {
    let within = Span::time(Time::from_millis(8));
    let (monitor, _) = watch(follows(Consequence { within, from_start: true, ..consequence(0, 0) }), "30");
    assert_eq!(
        monitor.summaries().next().unwrap().margin.unwrap(),
        Margin { amount: 4.0, at: at(0), cycle: Time::from_millis(2) }
    );
}
