//! `cause(SIGNAL, 'ID')`: in every kind of condition, from the start of the scenario, and always what the trace shows.

use super::{Session, State, held, missed, prepared};
use crate::plc::enable_all;
use crate::trace::{LineKind, Watch};
use crate::units::Time;

const ENABLED: &str = "plc = \"enable_all\"\n";
/// The key of Y is pressed in JOG and released; the control sets and resets the traverse command with the rule JOG.
const JOG: &str = "[[step]]\nwait = \"Y.position_controller_active\"\n[[step]]\npulse = \"Y.traversing_key_plus\"\n";

#[test]
fn a_cause_works_in_every_kind_of_condition() {
    let command = "cause(Y.traverse_command_plus, 'JOG')";
    let head = format!(
        "{ENABLED}always = \"!{command} || count(Y.traversing_key_plus) == 1\"\nnever = \"cause(Y.traverse_command_plus, 'REF-02')\"\n"
    );
    let rule =
        format!("[[rule]]\nname = \"r\"\nwhen = \"{command}\"\nthen = \"Y.traversing_key_plus\"\nmust_begin = true\n");
    let steps = format!(
        "[[step]]\nexpect = \"!{command}\"\n{JOG}[[step]]\nexpect = [\"{command}\", \"count({command}) == 1\", \"since({command}) > 0.05\"]\n[[step]]\nhold = \"{command}\"\nduring = \"100ms\"\n[[step]]\nwait = \"Y.axis_stationary && cause(DB32.DBX61.4, 'standstill')\"\n"
    );
    held(&format!("{head}{rule}{steps}"));
    let waits = "[[step]]\nset = { \"Y.traversing_key_plus\" = 1 }\n[[step]]\nwait = \"rose(cause(Y.traverse_command_plus, 'JOG'))\"\n[[step]]\nexpect = \"rose(Y.traverse_command_plus)\"\n";
    held(&format!("{ENABLED}{waits}"));
    let text = missed(&format!("{ENABLED}never = \"{command}\"\n{JOG}"));
    assert!(text.contains("`never` is violated: `cause(Y.traverse_command_plus, 'JOG')` is true"), "{text}");
}

#[test]
fn a_failure_names_the_rule_that_made_the_last_edge() {
    let expect = "[[step]]\nexpect = \"cause(DB32.DBX64.7, 'O-26')\"\n";
    let text = missed(&format!("{ENABLED}{JOG}{expect}"));
    assert!(text.contains("  cause(Y.traverse_command_plus, 'O-26') = 0, last edge by JOG\n"), "{text}");
    let text = missed(&format!("{ENABLED}{expect}"));
    assert!(text.contains("cause(Y.traverse_command_plus, 'O-26') = 0, no edge with a cause"), "{text}");
}

/// Only the control gives reasons: the last edge of the key is that of the scenario.
#[test]
fn an_edge_that_another_side_writes_has_no_rule() {
    held(&format!("{ENABLED}{JOG}[[step]]\nexpect = \"!cause(Y.traversing_key_plus, 'JOG')\"\n"));
    let write = "[[step]]\nwrite = { \"DB32.DBB130\" = 1 }\n[[step]]\nrun = \"1cycle\"\n";
    held(&format!("{ENABLED}{write}[[step]]\nexpect = [\"DB32.DBB130 == 1\", \"!cause(DB32.DBB130, 'JOG')\"]\n"));
}

#[test]
fn an_unknown_rule_names_those_that_exist() {
    let cure = |expression: &str| {
        let problem = prepared(&format!("[[step]]\nexpect = \"{expression}\"\n")).err().expect(expression);
        assert_eq!(problem.place.as_ref().map(|place| place.line), Some(4), "{problem}");
        (problem.what, problem.cure)
    };
    let (what, near) = cure("cause(X.traverse_command_plus, 'REF-99')");
    assert!(what.contains("the ID of a rule that causes name, found 'REF-99' at character 32"), "{what}");
    assert!(near.starts_with("causes name REF-02, REF-03, REF-04") && !near.contains("O-"), "{near}");
    let (_, near) = cure("cause(X.traverse_command_plus, 'JGO')");
    assert_eq!(near, "did you mean `JOG`?");
    let (_, all) = cure("cause(X.traverse_command_plus, 'a rule of mine')");
    assert!(all.contains("exact stop") && all.contains("SYN-06"), "{all}");
}

/// The worked example, cycle by cycle: for every signal and rule, the last line of the trace decides.
#[test]
fn a_cause_is_what_the_trace_shows_in_every_cycle() {
    let signals = ["X.traverse_command_plus", "XF.traverse_command_minus", "DB31.DBX101.4", "DB31.DBB101"];
    let ids = ["REF-02", "REF-31", "REF-11", "REF-10", "DEF-10", "O-26"];
    let mut session = Session::open("g1_example").unwrap().with_program(enable_all().boxed());
    // The first two signals are followed from the start; what the others did is looked up in the trace.
    session.never("cause(X.traverse_command_plus, 'O-26') || cause(XF.traverse_command_minus, 'O-26')").unwrap();
    session.set("DB11.DBX1.2", 1).unwrap();
    session.run("100ms").unwrap();
    session.set("X.traversing_key_plus", 1).unwrap();
    let mut found: Vec<(Time, Vec<&str>)> = Vec::new();
    while session.value("X.gantry_grouping_is_synchronized").unwrap() == 0.0 {
        if session.value("rose(X.gantry_synchronization_ready_to_start)").unwrap() != 0.0 {
            session.set("X.start_gantry_synchronization", 1).unwrap();
        }
        session.run("1cycle").unwrap();
        let all = signals.iter().flat_map(|signal| ids.iter().map(move |id| (signal, id)));
        let holds = |(signal, id): &(&&str, &&str)| session.value(&format!("cause({signal}, '{id}')")).unwrap() != 0.0;
        // `signal id`, in the order of the signals.
        found.push((session.time(), all.filter(holds).map(|(_, id)| *id).collect()));
    }
    let machine = session.machine();
    let watch = Watch::parse(&signals, machine.names(), machine.memory(), machine.variables()).unwrap();
    let lines = session.trace().lines(machine, &watch);
    let mut last = [""; 4];
    let mut lines = lines.iter().peekable();
    let mut different = 0;
    for (time, found) in found {
        while let Some(line) = lines.next_if(|line| line.time <= time) {
            let LineKind::Signal(line) = &line.kind else { continue };
            let because = line.because.as_deref().expect("it has a cause");
            let id = ids.iter().find(|id| because.starts_with(&format!("{id}:"))).copied().unwrap_or_default();
            let names = |signal: &&str| line.symbol.as_deref() == Some(signal) || line.address == **signal;
            let index = signals.iter().position(names).expect("it is watched");
            different += usize::from(last[index] != id);
            last[index] = id;
        }
        let expected: Vec<_> = last.iter().copied().filter(|id| !id.is_empty()).collect();
        assert_eq!(found, expected, "at {time} s");
    }
    assert_eq!(different, 8, "changes of a rule");
}

/// A served scenario reads the record before its server drains it.
#[test]
fn an_operator_follows_causes_on_a_machine_that_another_one_steps() {
    let expect = "[[step]]\nexpect = \"cause(Y.traverse_command_plus, 'JOG')\"\n";
    let prepared = prepared(&format!("{ENABLED}{JOG}{expect}")).unwrap();
    let (mut machine, mut operator, _) = prepared.into_operator();
    while *operator.state() == State::Acting {
        operator.act(&mut machine);
        machine.step();
        operator.look(&machine);
        machine.drain();
    }
    assert_eq!(*operator.state(), State::Done);
}
