//! Tables of expressions: values, precedence, names, mistakes.

use super::*;
use crate::image::{Location, Memory, Names};
use crate::units::{AxisNumber, ChannelNumber, Position, Time};
use crate::variables::{AlarmNumber, Parameter, Place, RaisedAlarm, Rule, RuleNumber, Variables};

/// Axes X and X2, channel CHAN1; one alarm without a number.
struct Machine(Names);

impl Machine {
    fn new() -> Self {
        let mut names = Names::default();
        names.axes[AxisNumber::FIRST] = Some("X".to_owned());
        names.axes[AxisNumber::new(2).unwrap()] = Some("X2".to_owned());
        names.channels[ChannelNumber::FIRST] = Some("CHAN1".to_owned());
        Self(names)
    }
}

impl Describe for Machine {
    fn datum_name(&self, number: u32) -> String {
        format!("MD{number}")
    }

    fn names(&self) -> &Names {
        &self.0
    }
    fn alarm_text(&self, _: &RaisedAlarm) -> String {
        String::new()
    }
    fn alarm_name(&self, number: AlarmNumber) -> String {
        number.0.to_string()
    }
    fn alarm_number(&self, name: &str) -> Option<AlarmNumber> {
        (name == "gantry-stage-1").then_some(AlarmNumber(AlarmNumber::OWN))
    }
    fn alarm_names(&self) -> Vec<String> {
        vec!["gantry-stage-1".to_owned()]
    }
    fn has_alarm(&self, number: AlarmNumber) -> bool {
        number != AlarmNumber(1653)
    }
    fn rule(&self, rule: RuleNumber) -> Rule {
        self.rules()[usize::from(rule.0)]
    }
    fn rules(&self) -> &'static [Rule] {
        const { &[rule("REF-02"), rule("REF-31"), rule("JOG"), rule("REF-02"), rule("O-27")] }
    }
}

const fn rule(id: &'static str) -> Rule {
    Rule { id, text: "" }
}

/// The names of the machine, its memory, and one value of the caller.
struct Known {
    machine: Machine,
    memory: Memory,
    named_values: [String; 1],
}

impl Scope for Known {
    fn describe(&self) -> &dyn Describe {
        &self.machine
    }
    fn signal(&self, name: &str) -> Result<Location, Problem> {
        self.machine.0.resolve(&self.memory, name)
    }
    fn named_values(&self) -> &[String] {
        &self.named_values
    }
}

/// A memory and variables in which every name of the tests has a different value.
fn state(machine: &Machine) -> (Memory, Variables) {
    let mut memory = Memory::new();
    let mut write = |name: &str, raw| {
        let location = machine.0.resolve(&memory, name).unwrap();
        memory.write(location, raw);
    };
    write("X.traversing_key_plus", 1);
    write("DB32.DBX101.5", 1);
    write("MB20", 0xFE);
    write("MW22", 0xFFFE);
    write("MD24", u64::from(1.5_f32.to_bits()));
    write("M10.3", 1);
    let mut variables = Variables::default();
    variables.axes[AxisNumber::FIRST].position = Position::from_user(120.5);
    variables.axes[AxisNumber::FIRST].velocity = 600.0;
    variables.axes[AxisNumber::new(2).unwrap()].synchronism_difference = Position::from_user(-0.941);
    let alarm = RaisedAlarm {
        number: AlarmNumber(10651),
        place: Place::Axis(AxisNumber::FIRST),
        parameters: [
            Parameter::Channel(ChannelNumber::FIRST),
            Parameter::Number(4001),
            Parameter::None,
            Parameter::None,
        ],
    };
    let own = RaisedAlarm { number: AlarmNumber(AlarmNumber::OWN), ..alarm };
    variables.alarms.publish([alarm, own].into_iter());
    (memory, variables)
}

fn parsed(source: &str) -> Result<Expression, Problem> {
    let named_values = ["start".to_owned()];
    Expression::parse(source, &Known { machine: Machine::new(), memory: Memory::new(), named_values })
}

fn value(source: &str) -> f64 {
    let machine = Machine::new();
    let (memory, variables) = state(&machine);
    let now = Moment {
        memory: &memory,
        variables: &variables,
        time: Time::from_millis(1_500),
        named_values: &[7.0],
        rules: &[],
    };
    parsed(source).unwrap_or_else(|problem| panic!("{problem}")).value(&View::at(now))
}

#[test]
fn operators_have_the_precedence_of_rust() {
    for (source, expected) in [
        ("1 || 0 && 0", 1.0),
        ("(1 || 0) && 0", 0.0),
        ("0 == 1 || 1 == 1", 1.0),
        ("1 && 2 == 3", 0.0),
        ("1 + 1 == 2", 1.0),
        ("2 < 1 + 2", 1.0),
        ("1 + 2 * 3", 7.0),
        ("(1 + 2) * 3", 9.0),
        ("7 - 2 - 1", 4.0),
        ("8 / 4 / 2", 1.0),
        ("-2 * -3", 6.0),
        ("1 - -1", 2.0),
        ("!0 == 1", 1.0),
        ("!(0 == 0)", 0.0),
        ("!!5", 1.0),
        ("-!0", -1.0),
        ("2 >= 2 && 2 <= 2 && 3 > 2 && 2 != 3", 1.0),
        ("0 / 0 || 0", 0.0),
    ] {
        assert!((value(source) - expected).abs() < 1e-12, "{source} = {}", value(source));
    }
}

#[test]
fn numbers_are_read_with_base_point_and_underscore() {
    for (source, expected) in
        [("1.5", 1.5), ("2#1101_0000", 208.0), ("16#D0", 208.0), ("16#d0", 208.0), ("1_000", 1000.0), ("007", 7.0)]
    {
        assert!((value(source) - expected).abs() < 1e-12, "{source}");
    }
    for misplaced in ["1_.5", "1._5", "1__0", "1_", "16#_D0", "16#D0_", "1_.5_0"] {
        let problem = parsed(misplaced).unwrap_err();
        assert!(problem.to_string().contains(&format!("found `{misplaced}`")), "{problem}");
    }
}

#[test]
fn names_mean_signals_addresses_values_and_named_values() {
    for (source, expected) in [
        ("X.traversing_key_plus", 1.0),
        ("DB31.DBX4.7", 1.0),
        ("DB32.DBX101.5", 1.0),
        ("X2.gantry_grouping_is_synchronized || DB32.DBX101.5", 1.0),
        ("M10.3 && !M10.4", 1.0),
        ("MB20", 254.0),
        ("MW22:INT", -2.0),
        ("MD24:REAL", 1.5),
        ("IB0", 0.0),
        ("X.position", 120.5),
        ("X.velocity", 600.0),
        ("abs(X2.synchronism_difference)", 0.941),
        ("time", 1.5),
        ("start", 7.0),
        ("min(3, start, 5)", 3.0),
        ("max(3, start)", 7.0),
    ] {
        assert!((value(source) - expected).abs() < 1e-6, "{source} = {}", value(source));
    }
}

#[test]
fn alarms_are_found_by_number_place_and_own_name() {
    for (source, expected) in [
        ("alarm(10651)", 1.0),
        ("alarm(10651, X)", 1.0),
        ("alarm(10651, X2)", 0.0),
        ("alarm(10651, CHAN1)", 0.0),
        ("alarm(10652)", 0.0),
        ("alarm('gantry-stage-1')", 1.0),
        ("alarm_parameter(10651, 1)", 1.0),
        ("alarm_parameter(10651, 2)", 4001.0),
        ("alarm_parameter(10652, 2)", 0.0),
        ("alarms()", 2.0),
    ] {
        assert!((value(source) - expected).abs() < 1e-12, "{source}");
    }
}

#[test]
fn an_edge_is_between_the_last_two_cycles_and_not_in_pending_writes() {
    let machine = Machine::new();
    let (memory, variables) = state(&machine);
    let empty = Memory::new();
    let at = |memory| Moment { memory, variables: &variables, time: Time::ZERO, named_values: &[], rules: &[] };
    let rose = parsed("rose(M10.3 && time == 0)").unwrap();
    let fell = parsed("fell(M10.3)").unwrap();
    let up = View { now: at(&empty), last: at(&memory), before: at(&empty), followed: &[] };
    assert!(rose.holds(&up) && !fell.holds(&up));
    let down = View { now: at(&memory), last: at(&empty), before: at(&memory), followed: &[] };
    assert!(!rose.holds(&down) && fell.holds(&down));
    let only_written = View { now: at(&memory), last: at(&empty), before: at(&empty), followed: &[] };
    assert!(!rose.holds(&only_written) && !fell.holds(&only_written));
    assert!(!rose.holds(&View::at(at(&memory))) && !fell.holds(&View::at(at(&empty))));
    assert!(rose.looks_back() && !parsed("M10.3").unwrap().looks_back());
}

#[test]
fn since_and_count_follow_the_rising_edges_of_a_condition() {
    let variables = Variables::default();
    let mut memory = Memory::new();
    let flag = memory.locate(&"M10.3".parse().unwrap(), crate::image::Profile::default()).unwrap();
    let mut followed = Followed::default();
    let [mut since, mut count, mut other] =
        ["since(M10.3 == 1)", "count( M10.3 == 1 ) + 1", "since(M10.4)"].map(|source| parsed(source).unwrap());
    for expression in [&mut since, &mut count, &mut other] {
        expression.follow(&mut followed);
    }
    assert_eq!(followed.conditions.len(), 2, "one condition is followed once");
    memory.write(flag, 1);
    // True at the beginning, then 0, 1, 1, 0, 1 after cycles of 10 ms.
    let mut seen = Vec::new();
    for (cycle, bit) in [1, 0, 1, 1, 0, 1].into_iter().enumerate() {
        memory.write(flag, bit);
        let time = Time::from_millis(10 * i64::try_from(cycle).unwrap());
        let now = Moment { memory: &memory, variables: &variables, time, named_values: &[], rules: &[] };
        if cycle == 0 {
            followed.conditions.begin(0, &View::at(now));
        } else {
            followed.conditions.observe(&View::at(now));
        }
        let view = View { followed: followed.conditions.histories(), ..View::at(now) };
        seen.push((since.value(&view), count.value(&view)));
        assert!(other.value(&view).is_infinite());
    }
    let inf = f64::INFINITY;
    assert_eq!(seen, [(inf, 1.0), (inf, 1.0), (0.0, 2.0), (0.01, 2.0), (0.02, 2.0), (0.0, 3.0)]);
    let now =
        Moment { memory: &memory, variables: &variables, time: Time::from_millis(60), named_values: &[], rules: &[] };
    let view = View { followed: followed.conditions.histories(), ..View::at(now) };
    assert_eq!(count.operands(&view, &Machine::new()), ["count(M10.3 == 1) = 2", "M10.3 = 1"]);
}

/// A signal with edges by rules 1, none, and 3, which has the ID of rule 0.
#[test]
fn a_cause_is_the_rule_of_the_last_edge_whatever_its_number() {
    let (variables, memory) = (Variables::default(), Memory::new());
    let mut followed = Followed::default();
    let mut cause = parsed("cause(X.traverse_command_plus, 'REF-02')").unwrap();
    let mut rose = parsed("rose(cause(DB31.DBX64.7, 'REF-02'))").unwrap();
    let mut count = parsed("count(cause(X.traverse_command_plus, 'REF-02') && !cause(M0.0, 'JOG'))").unwrap();
    for expression in [&mut cause, &mut rose, &mut count] {
        expression.follow(&mut followed);
    }
    assert_eq!((followed.edges.len(), followed.conditions.len()), (2, 1), "one signal is followed once");
    assert!(!cause.holds(&View::at(Moment {
        memory: &memory,
        variables: &variables,
        time: Time::ZERO,
        named_values: &[],
        rules: &[]
    })));
    let flag = memory.locate(&"M0.0".parse().unwrap(), crate::image::Profile::default()).unwrap();
    let mut seen = Vec::new();
    // Of each cycle: the edge of the signal, and its rule.
    let edges = [None, Some(Some(1)), Some(None), Some(Some(3)), None, Some(Some(0)), Some(Some(4))];
    for edge in edges {
        followed.edges.observe(|signal, known| match edge {
            Some(rule) if signal != flag => rule.map(RuleNumber),
            Some(_) | None => known,
        });
        let Followed { conditions, edges } = &mut followed;
        let moment =
            |rules| Moment { memory: &memory, variables: &variables, time: Time::ZERO, named_values: &[], rules };
        let (now, before) = (moment(edges.rules()), moment(edges.rules_before()));
        conditions.observe(&View::at(now));
        let view = View { now, last: now, before, followed: conditions.histories() };
        seen.push((cause.value(&view), rose.value(&view), count.value(&view)));
    }
    let expected = [(0, 0, 0), (0, 0, 0), (0, 0, 0), (1, 1, 1), (1, 0, 1), (1, 0, 1), (0, 0, 1)];
    assert_eq!(seen, expected.map(|(cause, rose, count)| (f64::from(cause), f64::from(rose), f64::from(count))));
    let now = Moment {
        memory: &memory,
        variables: &variables,
        time: Time::ZERO,
        named_values: &[],
        rules: followed.edges.rules(),
    };
    let shown = cause.operands(&View::at(now), &Machine::new());
    assert_eq!(shown, ["cause(X.traverse_command_plus, 'REF-02') = 0, last edge by O-27"]);
}

#[test]
fn an_error_names_the_expectation_the_place_and_the_remedy() {
    for (source, cause, cure) in [
        ("1 < 2 < 3", "one comparison, found `<` at character 7", "do not chain"),
        ("1 == 1 == 1", "one comparison", "do not chain"),
        ("1 +", "found the end at character 4", "operators are"),
        ("(1", "expected `)`, found the end", "operators are"),
        ("1)", "an operator or the end, found `)`", "operators are"),
        ("1 2", "an operator or the end", "operators are"),
        ("", "found the end at character 1", "operators are"),
        ("a & b", "found `&`", "&&"),
        ("a | b", "found `|`", "||"),
        ("1 = 1", "found `=`", "=="),
        ("1 % 2", "found `%`", "operators are"),
        ("12abc", "a number, found `12abc`", "write a number as"),
        ("1__0", "a number", "write a number as"),
        ("2#2", "a number", "write a number as"),
        ("1.", "a number", "write a number as"),
        ("strat", "`strat`", "did you mean `start`?"),
        ("X.positoin", "`X.positoin`", "did you mean `X.position`?"),
        ("X.pos > 1", "a signal or a value of `X`, found `X.pos`", "did you mean `X.position`?"),
        ("X.zzzzzz", "a signal or a value of `X`, found `X.zzzzzz`", "values of an axis are position, setpoint"),
        ("M10.3 == true", "found `true` at character 10", "or `== 1`"),
        ("M10.3 == False", "found `False`", "`!X.controller_enable`, or `== 0`"),
        ("M10.3 and M10.4", "an operator or the end, found `and`", "write `&&`"),
        ("not M10.3", "found `not`", "write `!`"),
        ("unknown_name", "a captured name or `time`, found `unknown_name`", "after its `capture`"),
        ("alarms_of", "found `alarms_of`", "did you mean `alarms(…)`?"),
        ("alarm(\"open\")", "found `\"`", "single quotes"),
        ("X.traversing_key_pls", "`X.traversing_key_pls`", "traversing_key_plus"),
        ("alarm", "`alarm`", "parentheses"),
        ("alram(10653)", "a function, found `alram`", "did you mean `alarm`?"),
        ("alarm(x)", "the number of an alarm", "quotes"),
        ("alarm('nothing')", "the number of an alarm, found 'nothing'", "write a number"),
        ("alarm('gantry-stage-3')", "found 'gantry-stage-3'", "did you mean 'gantry-stage-1'?"),
        ("alarm(1.5)", "the number of an alarm", "`opennck alarms`"),
        ("alarm(1653)", "the number of an alarm", "`opennck alarms`"),
        ("alarm('open)", "a closing quote", "operators are"),
        ("alarm(10653, X3)", "an axis or a channel", "did you mean `X"),
        ("alarm_parameter(10651)", "expected `,`", "operators are"),
        ("alarm_parameter(10651, 5)", "1 to 4", "operators are"),
        ("alarms(1)", "expected `)`", "operators are"),
        ("min(1)", "expected `,`", "operators are"),
        ("rose(fell(M10.3))", "found `fell`", "cannot be nested"),
        ("since(count(M10.3) > 1)", "found `count`", "cannot be nested"),
        ("since", "`since`", "parentheses"),
        ("cause(X.position, 'JOG')", "a signal, found `X.position` at character 7", "cause(X.traverse_command_plus"),
        ("cause(1, 'JOG')", "a signal, found the number 1", "cause(X.traverse_command_plus"),
        ("cause(X.traverse_comand_plus, 'JOG')", "`X.traverse_comand_plus`", "traverse_command_plus"),
        ("cause(M0.0)", "expected `,`", "operators are"),
        ("cause(M0.0, JOG)", "the ID of a rule that causes name, found `JOG`", "in quotes"),
        ("cause(M0.0, 'JGO')", "found 'JGO' at character 13", "did you mean `JOG`?"),
        ("cause(M0.0, 'ref-2')", "found 'ref-2'", "causes name REF-02, REF-31; the trace shows"),
        ("cause(M0.0, 'nothing')", "found 'nothing'", "causes name JOG, O-27, REF-02, REF-31"),
        ("DB99.DBX0.0", "DB99", "PLC image"),
        ("DB31.DBX148.0", "148 bytes", "the last byte is 147"),
    ] {
        let problem = parsed(source).expect_err(source);
        assert!(problem.what.contains(cause), "{source}: {}", problem.what);
        assert!(problem.cure.contains(cure), "{source}: {}", problem.cure);
    }
}

#[test]
fn nesting_is_limited() {
    let deep = |depth: usize| format!("{}1{}", "(".repeat(depth), ")".repeat(depth));
    assert!(parsed(&deep(50)).is_ok());
    assert!(parsed(&deep(100_000)).is_err());
    assert!(parsed(&"!".repeat(100_000)).is_err());
    assert!(parsed(&"-(".repeat(100_000)).is_err());
    assert!(parsed(&vec!["1"; 1_000].join(" + ")).is_ok());
    let long = parsed(&vec!["1"; 1_001].join(" + ")).unwrap_err();
    assert!(long.what.contains("at most 2000 names, numbers and operators"), "{long}");
    let long = parsed(&"!".repeat(1_000_000)).unwrap_err();
    assert!(long.what.contains("at most 50000 bytes, found 1000000"), "{long}");
}

#[test]
fn a_message_shows_only_the_part_of_a_long_expression_around_the_mistake() {
    let problem = parsed(&format!("{} + ? + {}", vec!["1"; 500].join("+"), vec!["1"; 400].join("+"))).unwrap_err();
    assert!(problem.what.contains("found `?` at character 1003 of `…") && problem.what.ends_with("…`"), "{problem}");
    assert!(problem.what.len() < 300, "{problem}");
}

#[test]
fn the_operands_of_a_failed_expression_are_shown_once_each_with_symbol_and_address() {
    let machine = Machine::new();
    let (memory, variables) = state(&machine);
    let now = Moment { memory: &memory, variables: &variables, time: Time::ZERO, named_values: &[7.0], rules: &[] };
    let source = "X.traversing_key_plus && M10.3 && X.position > start && alarm(10651, X) && !X.traversing_key_plus";
    let lines = parsed(source).unwrap().operands(&View::at(now), &machine);
    assert_eq!(
        lines,
        [
            "X.traversing_key_plus (DB31.DBX4.7) = 1",
            "M10.3 = 1",
            "X.position = 120.500000",
            "start = 7",
            "alarm(10651, X) = 1",
        ]
    );
}
