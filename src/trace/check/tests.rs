//! Tests of the check of causes, with small records: correct, wrong, late, empty and missing causes.

use super::*;
use crate::image::Names;
use crate::trace::{Recorder, Row};
use crate::units::AxisNumber;
use crate::variables::{
    AlarmNumber, AxisValues, DatumValue, EventId, Parameter, Place, RaisedAlarm, Rule, RuleNumber, Variables,
};

struct Control(Names);

impl Describe for Control {
    fn datum_name(&self, number: u32) -> String {
        format!("MD{number}")
    }
    fn names(&self) -> &Names {
        &self.0
    }
    fn alarm_text(&self, alarm: &RaisedAlarm) -> String {
        alarm.number.0.to_string()
    }
    fn alarm_name(&self, number: AlarmNumber) -> String {
        number.0.to_string()
    }
    fn alarm_number(&self, _: &str) -> Option<AlarmNumber> {
        None
    }
    fn half_count(&self, _: AxisNumber) -> Position {
        Position::from_user(0.002)
    }
    fn active_datum(&self, number: u32, index: Option<u8>, axis: Option<AxisNumber>) -> Option<f64> {
        // From the start: MD36030[X] = 0.1 and MD36012[0,X] = 2.
        let first = axis == Some(AxisNumber::FIRST);
        [((36030, None), 0.1), ((36012, Some(0)), 2.0)]
            .into_iter()
            .find_map(|(datum, value)| (first && datum == (number, index)).then_some(value))
    }
    fn rule(&self, _: RuleNumber) -> Rule {
        Rule { id: "JOG", text: "key" }
    }
}

/// DB31.DBX4.7 = 1 in cycle 12; in cycle 13 the control sets DB31.DBX64.7 and resets DBX61.5.
struct Run {
    control: Control,
    recorder: Recorder,
}

fn bit(byte: u16, bit: u8, value: bool) -> Input {
    Input::Bit(SignalBit { place: Place::Axis(AxisNumber::FIRST), byte, bit }, value)
}

impl Run {
    fn new() -> Self {
        let mut names = Names::default();
        names.axes[AxisNumber::FIRST] = Some("X".to_owned());
        let mut run = Self { control: Control(names), recorder: Recorder::default() };
        run.write(12, "DB31.DBX4.7", true, By::Plc, 0);
        run.write(12, "DB31.DBX61.5", true, By::Nck, 0);
        run.write(13, "DB31.DBX61.5", false, By::Nck, 0);
        run.write(13, "DB31.DBX64.7", true, By::Nck, 1);
        run
    }

    fn write(&mut self, cycle: u64, address: &str, value: bool, by: By, cause: u32) {
        let location = self.control.0.resolve(&Memory::new(), address).unwrap();
        let (old, new) = (u8::from(!value) << location.bit, u8::from(value) << location.bit);
        let (by, causes) = ([by; 8], [EventId(cause); 8]);
        let change = Change::Byte { part: location.part, offset: location.offset, old, new, by, causes };
        self.recorder.push(Row { cycle, change });
    }

    /// The findings for 64.7 if its event is of this cycle, with this input and this parent.
    fn findings(mut self, cycle: u64, input: Input, parent: u32) -> Vec<CauseFault> {
        let (place, rule, inputs) = (Place::Nck, RuleNumber(0), [input, Input::None, Input::None]);
        let event = Event { id: EventId(1), cycle, place, rule, inputs, parent: EventId(parent) };
        self.recorder.events([event].iter());
        let mut trace = Trace::begin(&Memory::new(), Time::from_millis(2), 10, Time::ZERO);
        trace.extend(&self.recorder);
        let watch =
            Watch::parse(&["X.traverse_command_plus"], &self.control.0, &Memory::new(), &Variables::default()).unwrap();
        let findings = trace.check_causes(&self.control, &watch);
        findings.into_iter().map(|finding| finding.fault).collect()
    }
}

#[test]
fn a_cause_with_correct_values_is_correct() {
    assert_eq!(Run::new().findings(13, bit(4, 7, true), 0), []);
    // A bit of the control: as decided in this cycle, or as published in the cycle before.
    assert_eq!(Run::new().findings(13, bit(61, 5, true), 0), []);
    assert_eq!(Run::new().findings(13, bit(61, 5, false), 0), []);
    assert_eq!(Run::new().findings(13, bit(64, 7, true), 0), []);
    // Data that have not become active in the trace and lengths are not compared; a parent event is sufficient.
    assert_eq!(Run::new().findings(13, Input::Datum(11300, None, 1.0), 0), []);
    assert_eq!(Run::new().findings(13, Input::None, 7), []);
}

#[test]
fn a_signal_with_another_value_is_found() {
    let untrue =
        |signal: &str, value: bool| [CauseFault::Untrue(signal.to_owned(), u64::from(value), u64::from(!value))];
    assert_eq!(Run::new().findings(13, bit(4, 7, false), 0), untrue("X.traversing_key_plus", false));
    assert_eq!(Run::new().findings(13, bit(4, 6, true), 0), untrue("X.traversing_key_minus", true));
    assert_eq!(Run::new().findings(13, bit(93, 5, true), 0), untrue("X.drive_ready", true));
    // For a bit of the PLC, the present value counts, not the previous one.
    let mut run = Run::new();
    run.write(13, "DB31.DBX4.7", false, By::Plc, 0);
    assert_eq!(run.findings(13, bit(4, 7, true), 0), untrue("X.traversing_key_plus", true));
}

#[test]
fn a_number_is_compared_as_a_whole_and_a_bit_inside_it_is_no_signal() {
    let set = |value| Input::Number(SignalBit { place: Place::Axis(AxisNumber::FIRST), byte: 9, bit: 0 }, value);
    let run = || {
        let mut run = Run::new();
        run.write(13, "DB31.DBX9.1", true, By::Plc, 0);
        run
    };
    assert_eq!(run().findings(13, set(2), 0), []);
    let untrue = CauseFault::Untrue("X.controller_parameter_set".to_owned(), 1, 2);
    assert_eq!(run().findings(13, set(1), 0), [untrue]);
    assert_eq!(run().findings(13, bit(9, 1, true), 0), [CauseFault::Unknown("X byte 9 bit 1".to_owned())]);
}

#[test]
fn an_event_of_another_cycle_is_found() {
    let late = [CauseFault::AnotherCycle(Time::from_millis(4))];
    assert_eq!(Run::new().findings(12, bit(4, 7, true), 0), late);
}

#[test]
fn an_empty_or_missing_cause_is_found() {
    assert_eq!(Run::new().findings(13, Input::None, 0), [CauseFault::Empty]);
    let mut run = Run::new();
    run.write(14, "DB31.DBX64.7", false, By::Nck, 0);
    assert_eq!(run.findings(13, bit(4, 7, true), 0), [CauseFault::Missing]);
}

#[test]
fn other_signals_and_writes_from_outside_are_not_checked() {
    let mut run = Run::new();
    run.write(14, "DB31.DBX93.5", true, By::Nck, 0);
    run.write(14, "DB31.DBX64.7", false, By::Outside, 0);
    assert_eq!(run.findings(13, bit(4, 7, true), 0), []);
}

#[test]
fn an_alarm_that_is_not_pending_is_found() {
    let run = |number| {
        let mut run = Run::new();
        let alarm = RaisedAlarm { number: AlarmNumber(10654), place: Place::Nck, parameters: [Parameter::None; 4] };
        run.recorder.push(Row { cycle: 13, change: Change::Alarm { alarm, raised: true, cause: EventId(1) } });
        run.findings(13, Input::Alarm(number), 0)
    };
    assert_eq!(run(10654), []);
    // Twice: for the signal and for the alarm, which has the same cause.
    assert_eq!(run(10655), [CauseFault::NotPending("10655".to_owned()), CauseFault::NotPending("10655".to_owned())]);
}

#[test]
fn an_alarm_without_a_cause_is_found() {
    let mut run = Run::new();
    let alarm = RaisedAlarm { number: AlarmNumber(10654), place: Place::Nck, parameters: [Parameter::None; 4] };
    run.recorder.push(Row { cycle: 14, change: Change::Alarm { alarm, raised: false, cause: EventId::NONE } });
    assert_eq!(run.findings(13, bit(4, 7, true), 0), [CauseFault::Missing]);
}

#[test]
fn another_value_of_a_machine_datum_than_the_active_one_is_found() {
    let run = |value| {
        let mut run = Run::new();
        let datum = DatumValue {
            number: 36060,
            place: Place::Axis(AxisNumber::FIRST),
            index: None,
            value: Some(5.0),
            word: None,
        };
        let change = Change::Happened { what: Happening::DatumActive(datum), by: By::Nck, cause: EventId::NONE };
        run.recorder.push(Row { cycle: 13, change });
        run.findings(13, Input::Datum(36060, Some(AxisNumber::FIRST), value), 0)
    };
    assert_eq!(run(5.0), []);
    assert_eq!(run(4.0), [CauseFault::OtherDatum("MD36060".to_owned(), 4.0, 5.0)]);
}

#[test]
fn another_value_of_a_machine_datum_than_from_the_start_is_found() {
    let found = |input| Run::new().findings(13, input, 0);
    let axis = AxisNumber::FIRST;
    assert_eq!(found(Input::Datum(36030, Some(axis), 0.1)), []);
    assert_eq!(found(Input::Element(36012, 0, axis, 2.0)), []);
    // The product of both is neither.
    let wrong = |number: &str, active| CauseFault::OtherDatum(number.to_owned(), 0.2, active);
    assert_eq!(found(Input::Datum(36030, Some(axis), 0.2)), [wrong("MD36030", 0.1)]);
    assert_eq!(found(Input::Element(36012, 0, axis, 0.2)), [wrong("MD36012", 2.0)]);
}

#[test]
fn a_machine_datum_that_becomes_active_later_is_not_compared_before() {
    let mut run = Run::new();
    let datum =
        DatumValue { number: 36030, place: Place::Axis(AxisNumber::FIRST), index: None, value: Some(0.1), word: None };
    let change = Change::Happened { what: Happening::DatumActive(datum), by: By::Nck, cause: EventId::NONE };
    run.recorder.push(Row { cycle: 14, change });
    assert_eq!(run.findings(13, Input::Datum(36030, Some(AxisNumber::FIRST), 0.2), 0), []);
}

/// The lengths and velocities of an axis in cycle 12 and in cycle 13, whose event names `input`.
fn lengths(input: Input, values: [AxisValues; 2]) -> Vec<CauseFault> {
    let [before, now] = values.map(|values| {
        let mut variables = Variables::default();
        variables.axes[AxisNumber::FIRST] = values;
        variables
    });
    let mut run = Run::new();
    let event = Event {
        id: EventId(1),
        cycle: 13,
        place: Place::Nck,
        rule: RuleNumber(0),
        inputs: [input, Input::None, Input::None],
        parent: EventId::NONE,
    };
    run.recorder.events([event].iter());
    let mut trace = Trace::begin(&Memory::new(), Time::from_millis(2), 12, Time::ZERO);
    trace.measure_causes(&before, None);
    trace.extend(&run.recorder);
    trace.end_cycle(13, Time::from_millis(2), &now);
    trace.measure(13, &now, None);
    let watch =
        Watch::parse(&["X.traverse_command_plus"], &run.control.0, &Memory::new(), &Variables::default()).unwrap();
    trace.check_causes(&run.control, &watch).into_iter().map(|finding| finding.fault).collect()
}

#[test]
fn a_length_that_the_axis_did_not_have_is_found_to_the_last_digit() {
    let length = |quantity, value| Input::Length(quantity, AxisNumber::FIRST, Position::from_user(value));
    let [position, setpoint, distance_to_go] = [2.0, 3.0, 4.0].map(Position::from_user);
    let mut before = AxisValues { position, setpoint, distance_to_go, ..AxisValues::default() };
    let mut now = before;
    (before.synchronism_difference, now.synchronism_difference) =
        (Position::from_user(0.049), Position::from_user(0.052));
    // MD37120 compares with 0.05 mm.
    let found = |quantity, value| lengths(length(quantity, value), [before, now]);
    assert_eq!(found(Quantity::SynchronismDifference, 0.052), []);
    assert_eq!(found(Quantity::SynchronismDifference, 0.049), []);
    let wrong = CauseFault::OtherLength("X.synchronism_difference".to_owned(), 0.052_001, 0.052);
    assert_eq!(found(Quantity::SynchronismDifference, 0.052_001), [wrong]);
    assert_eq!(found(Quantity::Position, 2.0), []);
    assert_eq!(found(Quantity::Position, 2.1), [CauseFault::OtherLength("X.position".to_owned(), 2.1, 2.0)]);
    assert_eq!(found(Quantity::Setpoint, 3.0), []);
    assert_eq!(found(Quantity::Target, 3.0 + 4.0), []);
    // Neither the setpoint nor the target is the actual value, and the reverse.
    let other = |name: &str, named, is| [CauseFault::OtherLength(format!("X.{name}"), named, is)];
    assert_eq!(found(Quantity::Position, 3.0), other("position", 3.0, 2.0));
    assert_eq!(found(Quantity::Position, 7.0), other("position", 7.0, 2.0));
    assert_eq!(found(Quantity::Setpoint, 2.0), other("setpoint", 2.0, 3.0));
    assert_eq!(found(Quantity::Target, 3.0), other("target", 3.0, 7.0));
    // The axis shows no distance since the cam.
    assert_eq!(found(Quantity::Distance, 17.0), []);
}

/// The mark can be one way before or behind that of the cycle: 5.284 ± 1.5 · 0.008. A resolution of 0.004 adds two of it.
#[test]
fn a_zero_mark_is_compared_to_the_resolution_of_the_encoder() {
    let at = |position| AxisValues { position: Position::from_user(position), ..AxisValues::default() };
    let found = |mark| {
        let input = Input::Length(Quantity::ZeroMark, AxisNumber::FIRST, Position::from_user(mark));
        lengths(input, [at(5.280), at(5.288)])
    };
    assert_eq!(found(5.284 + 0.012 + 0.008), []);
    assert_eq!(found(5.305).len(), 1);
}

#[test]
fn a_velocity_that_the_axis_did_not_have_is_found() {
    // MD36060 in mm/min; causes contain whole increments per second, and show mm/min: 50,000 of them are 3 mm/min.
    let velocity = |increments| Input::Length(Quantity::Velocity, AxisNumber::FIRST, Position::new(increments));
    let now = AxisValues { velocity: 3.000_04, ..AxisValues::default() };
    assert_eq!(lengths(velocity(50_000), [AxisValues::default(), now]), []);
    assert_eq!(lengths(velocity(0), [AxisValues::default(), now]), []);
    let [CauseFault::OtherLength(name, named, found)] = &lengths(velocity(-50_000), [now, now])[..] else {
        panic!("one finding")
    };
    assert_eq!((name.as_str(), *named, *found), ("X.velocity", -3.0, 3.000_04));
}

#[test]
fn a_finding_names_time_signal_and_fault() {
    let finding = CauseFinding {
        time: Time::from_millis(6),
        signal: "X.traverse_command_plus (DB31.DBX64.7)".to_owned(),
        because: Some("JOG: key, X.traversing_key_plus = 0".to_owned()),
        fault: CauseFault::Untrue("X.traversing_key_plus".to_owned(), 0, 1),
    };
    assert_eq!(
        finding.to_string(),
        "0.006 X.traverse_command_plus (DB31.DBX64.7): the cause names X.traversing_key_plus = 0, found 1 (JOG: key, \
         X.traversing_key_plus = 0)"
    );
}
