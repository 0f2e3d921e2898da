//! Tests of a trace with a few rows in all its forms, against literal text.

use super::*;
use crate::image::{Location, Memory, Names};
use crate::units::{AxisNumber, ChannelNumber, Position, Time};
use crate::variables::{
    AlarmNumber, DatumValue, Event, EventId, FaultName, Happening, Input, Parameter, Place, RaisedAlarm, Rule,
    RuleNumber, SignalBit, Variables,
};

struct Control(Names);

impl Control {
    fn new() -> Self {
        let mut names = Names::default();
        names.axes[AxisNumber::FIRST] = Some("X".to_owned());
        names.axes[AxisNumber::new(3).unwrap()] = Some("XF".to_owned());
        names.channels[ChannelNumber::FIRST] = Some("CHAN1".to_owned());
        Self(names)
    }

    fn location(&self, name: &str) -> Location {
        self.0.resolve(&Memory::new(), name).unwrap()
    }
}

impl Describe for Control {
    fn datum_name(&self, number: u32) -> String {
        format!("MD{number}")
    }

    fn names(&self) -> &Names {
        &self.0
    }
    fn alarm_text(&self, alarm: &RaisedAlarm) -> String {
        format!("text of {}", alarm.number.0)
    }
    fn alarm_name(&self, number: AlarmNumber) -> String {
        if number.0 == AlarmNumber::OWN { "gantry-stage-1".to_owned() } else { number.0.to_string() }
    }
    fn alarm_number(&self, _: &str) -> Option<AlarmNumber> {
        None
    }
    fn rule(&self, rule: RuleNumber) -> Rule {
        match rule.0 {
            0 => Rule { id: "REF-11", text: "" },
            _ => Rule { id: "O-19", text: "mode taken" },
        }
    }
}

/// A changed byte: old and new value.
fn byte(location: Location, cycle: u64, old: u8, new: u8, by: By, cause: EventId) -> Row {
    let (part, offset) = (location.part, location.offset);
    Row { cycle, change: Change::Byte { part, offset, old, new, by: [by; 8], causes: [cause; 8] } }
}

fn recorded(control: &Control) -> Trace {
    let mut trace = Trace::begin(&Memory::new(), Time::from_millis(2), 10, Time::ZERO);
    let watch = Watch::parse(&["X.position"], &control.0, &Memory::new(), &Variables::default()).unwrap();
    let mut variables = Variables::default();
    variables.axes[AxisNumber::FIRST].position = Position::from_user(120.0);
    trace.watch_values(&watch, 10, &variables);
    trace.note(11, "REF");
    let mut recorder = Recorder::default();
    let event = |id, rule, input| Event {
        id: EventId(id),
        cycle: 11,
        place: Place::Axis(AxisNumber::FIRST),
        rule: RuleNumber(rule),
        inputs: [input, Input::None, Input::None],
        parent: EventId::NONE,
    };
    let datum = Input::Datum(37110, AxisNumber::new(3), 0.0);
    recorder.events([event(1, 0, datum), event(2, 1, Input::None)].iter());
    let alarm = RaisedAlarm {
        number: AlarmNumber(10654),
        place: Place::Axis(AxisNumber::FIRST),
        parameters: [Parameter::Channel(ChannelNumber::FIRST), Parameter::Number(1), Parameter::None, Parameter::None],
    };
    // Out of order on purpose: a trace sorts its rows within a cycle.
    recorder.push(Row { cycle: 11, change: Change::Alarm { alarm, raised: true, cause: EventId(1) } });
    let ready = control.location("X.gantry_synchronization_ready_to_start");
    recorder.push(byte(ready, 11, 0, 1 << ready.bit, By::Nck, EventId(1)));
    let key = control.location("X.traversing_key_plus");
    recorder.push(byte(key, 11, 0, 1 << key.bit, By::Outside, EventId::NONE));
    recorder.push(byte(control.location("QB4"), 11, 0, 0b10, By::Plc, EventId::NONE));
    recorder.push(byte(control.location("MB7"), 11, 0, 9, By::Plc, EventId::NONE));
    recorder.push(byte(control.location("X.feed_override"), 12, 0, 13, By::Plc, EventId::NONE));
    let (part, offset) = (key.part, key.offset);
    recorder.push(Row { cycle: 12, change: Change::Overwritten { part, offset, bits: 1 << key.bit } });
    let own = RaisedAlarm { number: AlarmNumber(AlarmNumber::OWN), ..alarm };
    recorder.push(Row { cycle: 12, change: Change::Alarm { alarm: own, raised: false, cause: EventId::NONE } });
    trace.extend(&recorder);
    variables.axes[AxisNumber::FIRST].position = Position::from_user(120.0004);
    trace.end_cycle(12, Time::from_millis(4), &variables);
    trace
}

#[test]
fn the_text_has_one_row_a_change_in_aligned_columns() {
    let control = Control::new();
    let trace = recorded(&control);
    let expected = "
    time  what                                      address           change                    by       because
   0.000  X.position                                                  120.000000
   0.002  # REF
   0.002  Q4.1                                                        0 -> 1                    plc
   0.002  X.traversing_key_plus                     DB31.DBX4.7       0 -> 1                    outside
   0.002  X.gantry_synchronization_ready_to_start   DB31.DBX101.4     0 -> 1                    nck      REF-11: MD37110[XF] = 0
   0.002  alarm 10654                               X                 raised                    nck      text of 10654  (REF-11: MD37110[XF] = 0)
   0.004  # the PLC program overwrote what was set: X.traversing_key_plus (DB31.DBX4.7); force wins over it
   0.004  X.feed_override                           DB31.DBB0         0 -> 13                   plc
   0.004  alarm gantry-stage-1                      X                 cleared                   nck      text of 1000000
   0.004  X.position                                                  120.000000 -> 120.000400
";
    assert_eq!(format!("\n{}", trace.text(&control, &Watch::default(), true)), expected);
    assert!(!trace.text(&control, &Watch::default(), false).contains("REF-11"));
}

/// Power on, machine data, faults and keys, in two cycles.
fn happened() -> Trace {
    let mut trace = Trace::begin(&Memory::new(), Time::from_millis(2), 10, Time::ZERO);
    let mut recorder = Recorder::default();
    let xf = AxisNumber::new(3).unwrap();
    let stored = DatumValue { number: 37110, place: Place::Axis(xf), index: None, value: Some(0.1), word: None };
    let indexed = DatumValue {
        number: 20070,
        place: Place::Channel(ChannelNumber::FIRST),
        index: Some(2),
        value: None,
        word: None,
    };
    let mut push = |cycle, what, by, cause| {
        recorder.push(Row { cycle, change: Change::Happened { what, by, cause: EventId(cause) } });
    };
    push(11, Happening::DatumStored(stored), By::Outside, 0);
    push(11, Happening::PowerOn, By::Outside, 1);
    push(11, Happening::DatumActive(indexed), By::PowerOn, 0);
    push(12, Happening::Fault { axis: xf, name: FaultName::Push, by: Some(0.3), begins: true }, By::Outside, 2);
    push(12, Happening::Fault { axis: xf, name: FaultName::Block, by: None, begins: false }, By::Outside, 0);
    push(12, Happening::HandwheelTurned { number: 1, pulses: -20 }, By::Outside, 0);
    let event = |id, cycle, input| Event {
        id: EventId(id),
        cycle,
        place: Place::Nck,
        rule: RuleNumber(1),
        inputs: [input, Input::None, Input::None],
        parent: EventId::NONE,
    };
    recorder.events([event(1, 11, Input::None), event(2, 12, Input::Fault(FaultName::Push))].iter());
    trace.extend(&recorder);
    trace.note(12, "a note");
    trace
}

#[test]
fn what_happens_besides_changes_of_signals_is_a_row() {
    let (control, trace, watch) = (Control::new(), happened(), Watch::default());
    let expected = "
    time  what                  address   change    by
   0.002  MD37110 = 0.1         XF        stored    outside
   0.002  power                 nck       on        outside
   0.002  MD20070[2]            CHAN1     active    power on
   0.004  # a note
   0.004  fault push = 0.3      XF        set       outside
   0.004  fault block           XF        cleared   outside
   0.004  handwheel 1 = -20     nck       turned    outside
";
    assert_eq!(format!("\n{}", trace.text(&control, &watch, false)), expected);
    let expected = r#"{"t":0.002,"happened":"machine_datum_stored","machine_data":"37110[XF]","value":0.1,"where":"XF","by":"outside"}
{"t":0.002,"happened":"power_on","where":"nck","by":"outside","because":"O-19: mode taken","event":1}
{"t":0.002,"happened":"machine_datum_active","machine_data":"20070[2,CHAN1]","where":"CHAN1","by":"power on"}
{"t":0.002,"event":1,"where":"nck","rule":"O-19","because":"O-19: mode taken","inputs":[]}
{"t":0.004,"note":"a note"}
{"t":0.004,"happened":"fault_set","fault":"push","amount":0.3,"where":"XF","by":"outside","because":"O-19: mode taken, push","event":2}
{"t":0.004,"happened":"fault_cleared","fault":"block","where":"XF","by":"outside"}
{"t":0.004,"happened":"handwheel_turned","handwheel":1,"pulses":-20,"where":"nck","by":"outside"}
{"t":0.004,"event":2,"where":"nck","rule":"O-19","because":"O-19: mode taken, push","inputs":[{"fault":"push"}]}
"#;
    let json = trace.json_lines(&control, &watch);
    assert_eq!(json, expected);
    // Equal traces stay equal, another amount is a difference.
    let read = |text: &str| Reading::read(text).unwrap();
    assert_eq!(read(&json).compare(&read(&json)), Comparison::Same);
    let other = json.replace("\"amount\":0.3", "\"amount\":0.4");
    assert!(matches!(read(&json).compare(&read(&other)), Comparison::Different(_)));
    let head =
        Head { title: "T".into(), machine: "m".into(), profile: None, case: None, cycle_time: Time::from_millis(2) };
    assert!(trace.svg(&control, &watch, Window::default(), &head).contains("XF: fault push = 0.3 set"));
    assert!(trace.vcd(&control, &watch, Window::default()).contains("XF:_fault_push_=_0.3_set"));
}

#[test]
fn the_json_lines_have_the_promised_keys_in_the_promised_order() {
    let control = Control::new();
    let expected = r#"{"t":0.000,"symbol":"X.position","value":120.000000}
{"t":0.002,"note":"REF"}
{"t":0.002,"signal":"Q4.1","value":1,"by":"plc"}
{"t":0.002,"signal":"DB31.DBX4.7","symbol":"X.traversing_key_plus","value":1,"by":"outside"}
{"t":0.002,"event":1,"where":"X","rule":"REF-11","because":"REF-11: MD37110[XF] = 0","inputs":[{"machine_data":"37110[XF]","value":0}]}
{"t":0.002,"signal":"DB31.DBX101.4","symbol":"X.gantry_synchronization_ready_to_start","value":1,"by":"nck","because":"REF-11: MD37110[XF] = 0","event":1}
{"t":0.002,"alarm":10654,"state":"raised","where":"X","parameters":["CHAN1",1],"text":"text of 10654","because":"REF-11: MD37110[XF] = 0","event":1}
{"t":0.004,"note":"the PLC program overwrote what was set: X.traversing_key_plus (DB31.DBX4.7); force wins over it"}
{"t":0.004,"signal":"DB31.DBB0","symbol":"X.feed_override","value":13,"by":"plc"}
{"t":0.004,"alarm":"gantry-stage-1","state":"cleared","where":"X","parameters":["CHAN1",1],"text":"text of 1000000"}
{"t":0.004,"symbol":"X.position","value":120.000400}
"#;
    let json = recorded(&control).json_lines(&control, &Watch::default());
    assert_eq!(json, expected);
    for line in json.lines() {
        serde_json::from_str::<serde_json::Value>(line).unwrap();
    }
}

#[test]
fn a_watch_selects_signals_plain_memory_and_values() {
    let control = Control::new();
    let trace = recorded(&control);
    let rows = |entries: &[&str]| {
        let watch = Watch::parse(entries, &control.0, &Memory::new(), &Variables::default()).unwrap();
        let lines = trace.lines(&control, &watch);
        let address = |line: &Line| match &line.kind {
            LineKind::Signal(signal) => Some(format!("{} {} -> {}", signal.address, signal.old, signal.new)),
            LineKind::Note(_)
            | LineKind::Happening(_)
            | LineKind::Alarm(_)
            | LineKind::Value(..)
            | LineKind::Text(..) => None,
        };
        lines.iter().filter_map(address).collect::<Vec<_>>()
    };
    assert_eq!(rows(&["X.gantry*"]), ["DB31.DBX101.4 0 -> 1"]);
    assert_eq!(rows(&["DB31.DBX101.*", "MB7"]), ["MB7 0 -> 9", "DB31.DBX101.4 0 -> 1"]);
    assert_eq!(rows(&["M7.*"]), ["M7.0 0 -> 1", "M7.3 0 -> 1"]);
    assert_eq!(rows(&["MW6"]), ["MW6 0 -> 9"]);
    assert_eq!(rows(&["MB*"]), ["MB7 0 -> 9"]);
    assert_eq!(rows(&["X.feed_override"]), ["DB31.DBB0 0 -> 13"]);
    assert_eq!(rows(&["DB31.DBX0.2"]), ["DB31.DBX0.2 0 -> 1"]);
    assert_eq!(rows(&["XF.*"]), [""; 0]);
}

#[test]
fn a_watch_without_a_match_is_rejected() {
    let control = Control::new();
    for (entry, cure) in [
        ("Z.*", "did you mean `X`?"),
        ("X.gantri*x", "write a pattern"),
        ("Z.position", "did you mean `X`?"),
        ("X.traversing_key_pls", "traversing_key_plus"),
        ("DB99.DBX0.0", "PLC image"),
    ] {
        let (index, problem) =
            Watch::parse(&["X.*", entry], &control.0, &Memory::new(), &Variables::default()).unwrap_err();
        assert!(index == 1 && problem.cure.contains(cure), "{entry}: {problem}");
    }
}

#[test]
fn causes_name_signals_machine_data_and_lengths() {
    let control = Control::new();
    let x = AxisNumber::FIRST;
    let signal = SignalBit { place: Place::Axis(x), byte: 4, bit: 7 };
    let event = Event {
        id: EventId(1),
        cycle: 1,
        place: Place::Axis(x),
        rule: RuleNumber(0),
        inputs: [
            Input::Bit(signal, true),
            Input::Length(crate::variables::Quantity::SynchronismDifference, x, Position::from_user(-0.941)),
            Input::Alarm(10653),
        ],
        parent: EventId::NONE,
    };
    assert_eq!(
        because(&event, &control),
        "REF-11: X.traversing_key_plus = 1, X.synchronism_difference = -0.941000, alarm 10653"
    );
    let with_text = Event { rule: RuleNumber(1), ..event };
    assert!(because(&with_text, &control).starts_with("O-19: mode taken, X.traversing_key_plus = 1, "));
    let bare = Event { rule: RuleNumber(1), inputs: [Input::None; 3], ..event };
    assert_eq!(because(&bare, &control), "O-19: mode taken");
}

#[test]
fn a_number_among_the_inputs_has_one_name_and_one_value() {
    let control = Control::new();
    let place = Place::Axis(AxisNumber::FIRST);
    let input = Input::Number(SignalBit { place, byte: 9, bit: 0 }, 2);
    let inputs = [input, Input::None, Input::None];
    let event = Event { id: EventId(1), cycle: 11, place, rule: RuleNumber(0), inputs, parent: EventId::NONE };
    let mut recorder = Recorder::default();
    recorder.events([event].iter());
    let selected = control.location("X.controller_parameter_set");
    recorder.push(byte(selected, 11, 0, 2, By::Plc, EventId::NONE));
    let active = control.location("X.active_controller_parameter_set");
    recorder.push(byte(active, 11, 0, 2, By::Nck, EventId(1)));
    let mut trace = Trace::begin(&Memory::new(), Time::from_millis(2), 10, Time::ZERO);
    trace.extend(&recorder);
    assert_eq!(because(&event, &control), "REF-11: X.controller_parameter_set = 2");
    let lines = trace.json_lines(&control, &Watch::default());
    let inputs = r#""inputs":[{"signal":"DB31.DBX9.0..2","symbol":"X.controller_parameter_set","value":2}]"#;
    assert!(lines.contains(inputs), "{lines}");
    for story in [trace.story(&control), Story::read(&lines).unwrap()] {
        let why = story.why("X.active_controller_parameter_set", Time::from_millis(2)).unwrap();
        assert!(why.contains("X.controller_parameter_set (DB31.DBX9.0..2)  "), "{why}");
        assert!(why.contains(" -> 2  by plc"), "{why}");
    }
}

#[test]
fn the_first_difference_is_reported_in_words() {
    assert_eq!(difference("a\nb\n", "a\nb"), None);
    assert_eq!(
        difference("a\nb\n", "a\nc\nd\n").as_deref(),
        Some("first difference in line 2\n  expected  b\n  found     c")
    );
    assert_eq!(
        difference("a", "a\nb").as_deref(),
        Some("first difference in line 2\n  expected  (the end)\n  found     b")
    );
}

#[test]
fn a_sequence_may_be_compared_without_times_or_with_a_tolerance() {
    let (golden, late) = ("  0.002  X.a  0 -> 1\n", "     0.010  X.a    0 -> 1\n");
    assert!(difference(golden, late).is_some());
    assert_eq!(difference_in_sequence(golden, late, None), None);
    assert_eq!(difference_in_sequence(golden, late, Some(Time::from_millis(8))), None);
    assert!(difference_in_sequence(golden, late, Some(Time::from_millis(7))).is_some());
    assert!(difference_in_sequence(golden, "  0.002  X.b  0 -> 1\n", None).is_some());
    assert!(difference_in_sequence(golden, "", None).is_some());
}

#[test]
fn a_waveform_has_scopes_start_values_and_a_unit_that_fits_the_cycle() {
    let control = Control::new();
    let watch = Watch::parse(
        &["X.*", "MB7", "X.position", "XF.feed_override"],
        &control.0,
        &Memory::new(),
        &Variables::default(),
    )
    .unwrap();
    let trace = recorded(&control);
    let text = trace.vcd(&control, &watch, Window::default());
    assert!(!text.contains("$date") && !text.contains("$version"), "{text}");
    assert!(text.contains("$timescale 1 ms $end"), "{text}");
    let changes = text.split_once("$enddefinitions $end\n").unwrap().1;
    let expected = "#0
$dumpvars
b00000000 !
0\"
0#
r120 $
0%
1&
b00000000 '
b00000000 (
s- )
$end
#2
1\"
1#
1%
b00001001 (
sREF )
#4
b00001101 !
r120.0004 $
0&
sthe_PLC_program_overwrote_what_was_set:_X.traversing_key_plus_(DB31.DBX4.7);_force_wins_over_it )
";
    assert_eq!(changes, expected);
    for (cycle, unit) in
        [(Time::from_micros(1500), "100 us"), (Time::from_millis(10), "10 ms"), (Time::from_nanos(7), "1 ns")]
    {
        let trace = Trace::begin(&Memory::new(), cycle, 0, Time::ZERO);
        assert!(trace.vcd(&control, &watch, Window::default()).contains(&format!("$timescale {unit} $end")), "{unit}");
    }
}

/// MB7 becomes 9 and alarm 10654 is raised at 2 ms; the override becomes 13 and the other alarm is cleared at 4 ms.
#[test]
fn a_window_begins_with_the_values_before_it_and_keeps_watched_rows() {
    let control = Control::new();
    let watch = Watch::parse(&["X.feed_override", "MB7"], &control.0, &Memory::new(), &Variables::default()).unwrap();
    let shown = |from, to| {
        let window = Window { from: Some(Time::from_millis(from)), to: Some(Time::from_millis(to)) };
        let text = recorded(&control).vcd(&control, &watch, window);
        text.split_once("$enddefinitions $end\n").unwrap().1.to_owned()
    };
    let first = "#0\n$dumpvars\nb00000000 !\nr120 \"\n0#\n1$\nb00000000 %\ns- &\n$end\n#2\n1#\nb00001001 %\nsREF &\n";
    assert_eq!(shown(0, 3), first);
    let overwritten =
        "sthe_PLC_program_overwrote_what_was_set:_X.traversing_key_plus_(DB31.DBX4.7);_force_wins_over_it &\n";
    let start = "#4\n$dumpvars\nb00000000 !\nr120 \"\n1#\n1$\nb00001001 %\ns- &\n$end\n";
    let changes = "b00001101 !\nr120.0004 \"\n0$\n";
    assert_eq!(shown(3, 9), format!("{start}{changes}{overwritten}"));
    // After the end only what is watched or pending is left.
    assert_eq!(shown(8, 9), "#8\n$dumpvars\nb00001101 !\nr120.0004 \"\n1#\nb00001001 $\n$end\n");
    let from = Some(Time::from_millis(4));
    let (title, machine, cycle_time) = ("t".to_owned(), "m".to_owned(), Time::from_millis(2));
    let head = Head { title, machine, profile: None, case: None, cycle_time };
    let svg = recorded(&control).svg(&control, &watch, Window { from, to: None }, &head);
    assert!(svg.contains(">0.004</text>") && !svg.contains(">0.002</text>"), "{svg}");
}

#[test]
fn watched_signals_are_shown_even_if_they_never_change() {
    let control = Control::new();
    let rows = |entries: &[&str]| {
        let watch = Watch::parse(entries, &control.0, &Memory::new(), &Variables::default()).unwrap();
        let text = recorded(&control).vcd(&control, &watch, Window::default());
        (text.matches(" traversing_key_plus ").count(), text.matches(" traversing_key_minus ").count())
    };
    // Only the key in the plus direction changes. The pattern for the whole axis shows what changes.
    assert_eq!(rows(&["X.traversing_key_*"]), (1, 1));
    assert_eq!(rows(&["DB31.DBX4.*"]), (1, 1));
    assert_eq!(rows(&["X.traversing_key_minus"]), (0, 1));
    assert_eq!(rows(&["X.*"]), (1, 0));
}

#[test]
fn a_diagram_shows_names_extremes_alarms_and_notes() {
    let control = Control::new();
    let watch = Watch::parse(&["X.*", "MB7", "X.position"], &control.0, &Memory::new(), &Variables::default()).unwrap();
    let head = Head {
        title: "a < b".into(),
        machine: "m".into(),
        profile: None,
        case: None,
        cycle_time: Time::from_millis(2),
    };
    let svg = recorded(&control).svg(&control, &watch, Window::default(), &head);
    for words in [
        "<title>a &lt; b</title>",
        ">X.traversing_key_plus</text>",
        ">DB31.DBX4.7</text>",
        ">120.000</text>",
        ">10654</text>",
        ">text of 10654</text>",
        ">REF</text>",
        "0.002 s  X.gantry_synchronization_ready_to_start becomes 1 by nck: REF-11: MD37110[XF] = 0",
        "prefers-color-scheme: dark",
    ] {
        assert!(svg.contains(words), "{words} in {svg}");
    }
    assert!(!svg.contains("NaN") && svg.ends_with("</svg>\n"));
    let empty = Trace::begin(&Memory::new(), Time::from_millis(2), 0, Time::ZERO);
    assert!(
        empty.svg(&control, &Watch::default(), Window::default(), &head).ends_with("</svg>\n"),
        "an empty trace can be drawn"
    );
}

#[test]
fn why_leads_from_an_edge_to_its_event_and_reports_missing_edges() {
    let control = Control::new();
    let trace = recorded(&control);
    let ready = control.location("X.gantry_synchronization_ready_to_start");
    let expected = "    0.002  X.gantry_synchronization_ready_to_start (DB31.DBX101.4)  0 -> 1  by nck
    0.002    because REF-11: MD37110[XF] = 0  [X]
";
    assert_eq!(trace.why(ready, Time::from_millis(2), &control).unwrap(), expected);
    let read = Story::read(&trace.json_lines(&control, &Watch::default())).unwrap();
    assert_eq!(read.why("DB31.DBX101.4", Time::from_millis(9)).unwrap(), expected);
    let early = trace.why(ready, Time::ZERO, &control).unwrap_err();
    assert_eq!(early.cure, "its first edge is at 0.002 s");
}

/// A chain of parents, and a chain of a signal and an event in turn, each longer than the stack of a thread can hold.
#[test]
fn why_follows_a_chain_of_any_length() {
    let last = 40_000;
    let key = "{\"t\":0.002,\"signal\":\"M0.0\",\"value\":1,\"by\":\"plc\"}\n";
    let mut parents = key.to_owned();
    let mut inputs = key.to_owned();
    for number in 1..=last {
        let (time, before) = (f64::from(number), number - 1);
        parents += &format!("{{\"t\":{time},\"event\":{number},\"because\":\"R\",\"parent\":{before}}}\n");
        inputs += &format!(
            "{{\"t\":{time},\"event\":{number},\"because\":\"R\",\"inputs\":[{{\"signal\":\"M{before}.0\",\"value\":1}}]}}\n"
        );
        inputs +=
            &format!("{{\"t\":{time},\"signal\":\"M{number}.0\",\"value\":1,\"by\":\"nck\",\"event\":{number}}}\n");
    }
    let end = format!("{{\"t\":50000,\"signal\":\"M9.9\",\"value\":1,\"by\":\"nck\",\"event\":{last}}}\n");
    let rows = |text: &str| {
        let why = Story::read(text).unwrap().why("M9.9", Time::from_seconds(60_000.0)).unwrap();
        assert!(!why.contains("see above"));
        why.lines().count()
    };
    assert_eq!(rows(&format!("{parents}{end}")), 1 + 40_000);
    assert_eq!(rows(&format!("{inputs}{end}")), 1 + 2 * 40_000);
}

#[test]
fn a_missing_row_is_a_difference_and_a_different_cause_is_not() {
    let control = Control::new();
    let json = recorded(&control).json_lines(&control, &Watch::default());
    let reading = |text: &str| Reading::read(text).unwrap();
    assert_eq!(reading(&json).compare(&reading(&json)), Comparison::Same);
    let Comparison::OtherCauses(words) = reading(&json).compare(&reading(&json.replace("REF-11", "REF-07"))) else {
        panic!("only the causes differ");
    };
    assert!(
        words.starts_with("different cause in line 6, at 0.002 s: X.gantry_synchronization_ready_to_start"),
        "{words}"
    );
    let less: String = json.lines().filter(|line| !line.contains("Q4.1")).map(|line| format!("{line}\n")).collect();
    let Comparison::Different(words) = reading(&json).compare(&reading(&less)) else {
        panic!("a row is missing");
    };
    assert!(words.contains("Q4.1 0 -> 1 is missing"), "{words}");
    let Comparison::Different(words) = reading(&less).compare(&reading(&json)) else {
        panic!("a row is new");
    };
    assert!(words.contains("Q4.1 0 -> 1 is new"), "{words}");
    let table = recorded(&control).text(&control, &Watch::default(), true);
    let wider: String = table.lines().map(|row| format!("  {row}\n")).collect();
    assert_eq!(reading(&table).compare(&reading(&wider)), Comparison::Same, "the width of a column has no meaning");
}
